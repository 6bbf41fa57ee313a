"""The thermo-elastic benchmarks of NAFEMS, T1 and LE11, each computed on a small mesh of either cell.

The Standard NAFEMS Benchmarks (1990): T1 membrane with a hot spot, 50 MPa next to it; LE11 cylinder, taper and
sphere under a linear temperature, -105 MPa at A. The converged axisymmetric value of LE11 is -106.0 MPa. At the
edge of the spot a plate of finite thickness is no membrane, so the stress next to it is read from Lame's field
a / r^2 + b fitted a few thicknesses away; the finite plate adds about (1/10)^2 of 50 MPa.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from rigdesign.validation.mapped_mesh import mapped, piecewise
from thermal.expansion.elastic import ElasticSetup
from thermal.expansion.stress import stress_at_nodes
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import CellName, FloatArray, NamedMesh

HOLE, EDGE, THICKNESS = 0.02, 10.0, 0.05
"""Radius of the hole that stands for the middle of the spot, half edge and thickness of the membrane of T1 [mm]."""


def t1_stress(cell: CellName = "tetra10") -> float:
    """T1: hoop stress next to the spot [Pa]; E 100 GPa, nu 0.3, alpha 1e-3 in the spot, 1 K. Analytic: 50 MPa."""
    mesh = _hot_spot(cell)
    elements = FiniteElements(mesh)
    materials = {"spot": (100e9, 0.3, 1e-3), "rest": (100e9, 0.3, 0.0)}
    setup = ElasticSetup(elements, materials, _symmetric(elements, {"y_min": 1, "y_max": 0, "z_min": 2}))
    warm = np.ones(len(mesh.points))
    stress = stress_at_nodes(setup, setup.solve(warm, 0.0).values, warm, 0.0)
    places = mesh.points[mesh.cells]
    radius, angle = np.hypot(places[..., 0], places[..., 1]), np.arctan2(places[..., 1], places[..., 0])
    around = np.stack([-np.sin(angle), np.cos(angle)], axis=-1)
    hoop = np.einsum("eai,eaij,eaj->ea", around, stress[..., :2, :2], around)
    ring = (radius > 1.0 + 6.0 * THICKNESS) & (radius < 3.0)
    basis = np.column_stack([radius[ring] ** -2.0, np.ones(np.count_nonzero(ring))])
    return float(np.linalg.lstsq(basis, hoop[ring])[0].sum())


def le11_stress(cell: CellName = "tetra10") -> float:
    """LE11: axial stress at A, r = 1 m and z = 0 [Pa]; E 210 GPa, nu 0.3, alpha 2.3e-4, T = r + z."""
    mesh = _cylinder_taper_sphere(cell)
    elements = FiniteElements(mesh)
    fixed = _symmetric(elements, {"y_min": 1, "y_max": 0, "z_min": 2, "z_max": 2})
    setup = ElasticSetup(elements, {"box": (210e9, 0.3, 2.3e-4)}, fixed)
    warm = np.hypot(*mesh.points[:, :2].T) + mesh.points[:, 2]
    stress = stress_at_nodes(setup, setup.solve(warm, 0.0).values, warm, 0.0)
    on_a = (np.abs(np.hypot(*mesh.points[:, :2].T) - 1.0) < 1e-4) & (mesh.points[:, 2] == 0.0)
    return float(stress[on_a[mesh.cells], 2, 2].mean())


def _symmetric(elements: FiniteElements, held: Mapping[str, int]) -> NDArray[np.bool_]:
    """(n_nodes, 3) directions held by planes of symmetry, surface -> axis."""
    fixed = np.zeros((len(elements.mesh.points), 3), dtype=bool)
    for surface, axis in held.items():
        fixed[elements.surfaces[surface].nodes, axis] = True
    return fixed


def _hot_spot(cell: CellName) -> NamedMesh:
    """Quarter of the membrane in millimetres: x from a small hole over r = 1 to the edge, y round."""

    def place(s: FloatArray, turn: FloatArray, z: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        angle = 0.5 * np.pi * turn
        edge = EDGE / np.maximum(np.cos(angle), np.sin(angle))
        inside = HOLE * (1.0 / HOLE) ** np.minimum(2.0 * s, 1.0)
        radius = np.where(s <= 0.5, inside, edge ** np.maximum(2.0 * s - 1.0, 0.0))
        return radius * np.cos(angle), radius * np.sin(angle), THICKNESS * z

    mesh = mapped((40, 12, 1), place, cell)
    corners = mesh.points[mesh.cells[:, : mesh.shape.n_corners], :2]
    spot = np.hypot(*corners.mean(axis=1).T) < 1.0
    mesh.bodies.clear()
    mesh.bodies.update(
        spot=np.flatnonzero(spot).astype(np.int32), rest=np.flatnonzero(~spot).astype(np.int32)
    )
    return mesh


def _cylinder_taper_sphere(cell: CellName) -> NamedMesh:
    """90 degrees of the body: x across the wall, y round, z along sphere, taper and cylinder."""
    parts = (8, 6, 4) if cell != "tetra10" else (14, 10, 6)
    top = 1.7971

    def place(
        across: FloatArray, turn: FloatArray, along: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        inner_angle = 0.25 * np.pi * np.minimum(along * sum(parts) / parts[0], 1.0)
        outer_angle = inner_angle / (0.25 * np.pi) * np.arcsin(0.7071 / 1.4)
        on_sphere = along <= parts[0] / sum(parts)
        height = piecewise(along, parts, np.array([0.0, 0.7071, 1.3971, top]))
        r_in = np.where(on_sphere, np.cos(inner_angle), 0.7071)
        z_in = np.where(on_sphere, np.sin(inner_angle), height)
        r_out = np.where(
            on_sphere, 1.4 * np.cos(outer_angle), piecewise(along, parts, np.array([1.4, 1.2083, 1.0, 1.0]))
        )
        z_out = np.where(on_sphere, 1.4 * np.sin(outer_angle), height)
        r, z = r_in + across * (r_out - r_in), z_in + across * (z_out - z_in)
        angle = 0.5 * np.pi * turn
        return r * np.cos(angle), r * np.sin(angle), z

    return mapped((parts[0] - 2, parts[0] - 4, sum(parts)), place, cell)
