"""Gears and small models for the tests of influence numbers."""

from math import cos, radians

import numpy as np

from dynamics.gear.cylindrical_gear import CylindricalGear, Rack
from dynamics.gear.tooth_form import ToothForm
from dynamics.tooth.compliance import InterpolatedCompliance
from dynamics.tooth.elastic_segment import Elastic, GearModel
from dynamics.tooth.influence_numbers import GearBody, InfluenceNumbers, RootFillet, SectionDivision

STEEL = Elastic(young=206e9, poisson=0.3)
COARSE = SectionDivision(profile=3, thickness=2, fillet=4, depth=2, neighbours=(2, 2, 4))


def drawn_gear(
    teeth: int,
    *,
    module: float = 1e-3,
    helix: float = 0.0,
    shift: float = 0.0,
    pressure_angle: float = 20.0,
    addendum: float = 1.0,
    tool_radius: float = 0.38,
) -> CylindricalGear:
    """Gear with full tips; helix and pressure angle [deg], module [m]."""
    beta = radians(helix)
    return CylindricalGear(
        normal_module=module,
        pressure_angle=radians(pressure_angle),
        helix_angle=beta,
        teeth=teeth,
        profile_shift=shift,
        tip_diameter=module * (teeth / cos(beta) + 2.0 * (addendum + shift)),
        rack=Rack(tip_radius=tool_radius),
    )


def small_model(helix: float = 0.0, n_face: int = 4, **fields: object) -> GearModel:
    """28 teeth of module 4 mm, 20 mm wide, in large elements."""
    form = ToothForm(gear=drawn_gear(28, module=4e-3, helix=helix))
    given = {"body": GearBody(bore_radius=15e-3), "division": COARSE, "n_face": n_face} | fields
    return GearModel(form=form, material=STEEL, face_width=20e-3, **given)  # type: ignore[arg-type]


def invented_numbers(n_profile: int = 4, n_face: int = 2, seed: int = 0) -> InfluenceNumbers:
    """Numbers of the right shapes that keep reciprocity and are nothing else."""
    draw, n = np.random.default_rng(seed), n_profile * n_face
    deflection = {k: draw.random((n, n)) for k in range(4)}
    deflection[0] = deflection[0] + deflection[0].T
    deflection |= {-k: deflection[k].T.copy() for k in (1, 2, 3)}
    return InfluenceNumbers(
        profile=np.linspace(1e-3, 2e-3, n_profile),
        face=np.linspace(-5e-3, 5e-3, n_face),
        axis_depth=draw.random(n_profile),
        local_excess=draw.random(n_profile),
        deflection=deflection,
        body=draw.random((n, n)),
        fillet=RootFillet(point=draw.random((3, 2)), arc=np.arange(3.0), tangent=np.arange(3.0)[::-1]),
        stress={(k, side): draw.random((3 * n_face, n)) for k in (-1, 0, 1) for side in (1, -1)},
        asymmetry=0.03,
        n_nodes=5,
    )


def hat_weights(face: np.ndarray, n: int = 8) -> tuple[np.ndarray, np.ndarray]:
    """Weights (n_f, m) of the means under the hats of positions, at places (m,) between them."""
    nodes, weights = np.polynomial.legendre.leggauss(n)
    steps, share = np.diff(face), 0.5 * (1.0 + nodes)
    places = face[:-1, None] + steps[:, None] * share
    found = np.zeros((len(face), len(steps), n))
    for cell, step in enumerate(steps):
        found[cell, cell] = 0.5 * step * weights * (1.0 - share)
        found[cell + 1, cell] = 0.5 * step * weights * share
    flat = found.reshape(len(face), -1)
    return flat / flat.sum(axis=1, keepdims=True), places.ravel()


def hat_means(table: InterpolatedCompliance, offset: int) -> np.ndarray:
    """Means of a compliance under the hats of its face positions, at its profile positions: as `deflection`."""
    weights, places = hat_weights(table.face) if len(table.face) > 1 else (np.ones((1, 1)), np.zeros(1))
    roll = np.repeat(table.profile, len(places))
    tooth = np.repeat([0, offset], len(roll)) if offset else np.zeros(len(roll), np.int64)
    face = np.tile(places, len(table.profile))
    times = len(tooth) // len(roll)
    matrix = table.matrix(np.tile(roll, times), np.tile(face, times), tooth)
    block = matrix[-len(roll) :, : len(roll)].reshape(len(table.profile), len(places), len(table.profile), -1)
    means = np.einsum("am,imjn,bn->iajb", weights, block, weights)
    return means.reshape(len(table.profile) * len(weights), -1)
