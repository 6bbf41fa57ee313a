"""A double-helical mesh whose halves both carry: one half with its mirror image is the whole in symmetric motion.

Three models of two shafts that are equal on both sides of the middle of their gears: the whole with a row of springs
for either half, of opposite hands and beside each other; the whole as the rig has it, the springs of both halves in one
row at mid-face and an axial spring for their helices; and one half of it, half of the gear bodies on shafts cut at
mid-face, where the mirror holds what is odd: axial motion and tilts. Even motions have equal frequencies in all three.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg

from dynamics.rotor.assembly import ElasticModel, assemble_rig
from dynamics.rotor.bearing_state import RowSpring, RunningState, isotropic_bearing
from dynamics.rotor.craig_bampton import approach_row
from dynamics.rotor.graph import Drivetrain, assemble
from dynamics.rotor.parts import BearingPlace, GearBody, MeshConnection, Motor
from dynamics.rotor.rotor_model import (
    AxialLocation,
    AxialMeshSpring,
    ElasticRig,
    ShaftPlacement,
    double_helical_stiffness,
)
from dynamics.rotor.shaft import Section, Shaft
from dynamics.rotor.static_loop import LoopLoad
from dynamics.tooth.law import in_parallel
from dynamics.vibration.response_curve import CurvePoint
from dynamics.vibration.speed_sweep import SweepSettings, periodic_response
from rigdesign import load_case
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.mesh_models import laws_of, mesh_models
from rigdesign.coupling.state import OperatingPoint
from rigdesign.rig.model import Rig, build_rig
from tests.builders.full_matrices import full_matrices
from tests.builders.paths import CASES
from tests.builders.rig import prototype, prototype_laws

HALF_LENGTH, DISTANCE, RADII = 0.2, 0.0995, (0.045, 0.045 * 102 / 99)
HELIX, STIFFNESS, LOCATION = 0.3, 4e8, 5e7
"""Base helix angle [rad], of one half [N/m], axial of a bearing [N/m]."""
BESIDE = 0.02
"""Distance of the middle of a half from mid-face [m]."""
PLACES = (0.03, 0.12)
"""Of the bearings of one side [m]."""


def rig(whole: bool, helix: float) -> ElasticRig:
    """Shafts of both sides or of one, gears at their middle or their end."""
    share, length = (2.0, 2.0 * HALF_LENGTH) if whole else (1.0, HALF_LENGTH)
    places = [*PLACES, *(length - place for place in PLACES)] if whole else list(PLACES)
    names = ("pinion", "wheel")
    drivetrain = Drivetrain(
        shafts=tuple(
            Shaft(name=name, sections=(Section(length=length, outer_diameter=d),), element_length=0.02)
            for name, d in zip(names, (0.04, 0.05))
        ),
        gears=tuple(
            GearBody(
                name=f"{name} gear", shaft=name, position=HALF_LENGTH, inertia=share * inertia, mass=share * mass,
                width=0.04, stiffness=share * 1e6,
            )
            for name, inertia, mass in zip(names, (1.3e-3, 1.5e-3), (1.1, 1.2))
        ),
        couplings=(),
        bearings=tuple(
            BearingPlace(name=f"{name} {i}", shaft=name, position=place)
            for name in names
            for i, place in enumerate(places)
        ),
        meshes=(
            MeshConnection(
                name="mesh", pinion="pinion gear", wheel="wheel gear", base_radii=RADII, teeth=(99, 102),
                centre_distance=DISTANCE, base_helix_angle=helix,
            ),
        ),
        motor=Motor(shaft="wheel", position=HALF_LENGTH),
    )  # fmt: skip
    return ElasticRig(
        drivetrain=drivetrain,
        placements=(
            ShaftPlacement(shaft="pinion", y=-0.5 * DISTANCE, z=0.0, sense=1),
            ShaftPlacement(shaft="wheel", y=0.5 * DISTANCE, z=0.0, sense=-1),
        ),
        axial_locations=tuple(
            AxialLocation(bearing=f"{name} {i}", stiffness=LOCATION)
            for name in names
            for i in ((0, 2) if whole else (0,))
        ),
    )


def frequencies(
    model: ElasticModel, springs: tuple[RowSpring, ...], fixed: tuple[int, ...] = ()
) -> np.ndarray:
    """Natural frequencies [Hz], those of rigid motions left out; freedoms that are fixed stand still."""
    bearings = {bearing.name: isotropic_bearing(1e8) for bearing in model.rig.drivetrain.bearings}
    full = full_matrices(model, RunningState(bearings=bearings, springs=springs))
    free = np.setdiff1d(np.arange(model.size), fixed)
    square = scipy.linalg.eigh(
        full.stiffness.toarray()[np.ix_(free, free)],
        full.mass.toarray()[np.ix_(free, free)],
        eigvals_only=True,
    )
    found = np.sqrt(np.maximum(square, 0.0)) / (2.0 * math.pi)
    return np.asarray(found[found > 1.0])


def one_half() -> np.ndarray:
    """Of one half with its mirror: at the cut no axial motion and no tilt, of shaft or gear."""
    model = assemble_rig(rig(False, HELIX))
    held = []
    for name in ("pinion", "wheel"):
        base = model.freedoms.place(f"{name} gear").base
        held += [base, base + 4, base + 5]
    row = approach_row(model, "mesh", position=BESIDE, half=1)
    return frequencies(model, (RowSpring(row=row, stiffness=STIFFNESS),), tuple(held))


def test_even_motions_of_the_whole_are_those_of_one_half() -> None:
    half = one_half()
    explicit = assemble_rig(rig(True, HELIX))
    rows = [approach_row(explicit, "mesh", position=side * BESIDE, half=side) for side in (1, -1)]
    both = frequencies(explicit, tuple(RowSpring(row=row, stiffness=STIFFNESS) for row in rows))
    axial = double_helical_stiffness(2.0 * STIFFNESS, HELIX)
    lumped = assemble_rig(
        replace(rig(True, 0.0), axial_mesh_springs=(AxialMeshSpring(mesh="mesh", stiffness=axial),))
    )
    product = frequencies(lumped, (RowSpring(row=approach_row(lumped, "mesh"), stiffness=2.0 * STIFFNESS),))
    for name, whole in (("a row for either half", both), ("one row and an axial spring", product)):
        nearest = np.abs(whole[:, None] / half - 1.0).min(axis=0)
        assert nearest[half < 2e4].max() < 1e-9, name
    assert np.count_nonzero(half < 2e4) > 8
    # both halves on the springs of one, as a rig has it that forgets the other half, are lower
    one = frequencies(lumped, (RowSpring(row=approach_row(lumped, "mesh"), stiffness=STIFFNESS),))
    assert np.abs(one[:, None] / half - 1.0).min(axis=0)[half < 2e4].max() > 0.01


def halved(drivetrain: Drivetrain) -> Drivetrain:
    """The same with half of every inertia, spring and damper."""
    return replace(
        drivetrain,
        shafts=tuple(
            replace(
                s, density=0.5 * s.density, shear_modulus=0.5 * s.shear_modulus,
                discs=tuple(replace(d, inertia=0.5 * d.inertia) for d in s.discs),
            )
            for s in drivetrain.shafts
        ),
        gears=tuple(
            replace(g, inertia=0.5 * g.inertia, stiffness=0.5 * g.stiffness, damping=0.5 * g.damping)
            for g in drivetrain.gears
        ),
        couplings=tuple(
            replace(c, stiffness=0.5 * c.stiffness, damping=0.5 * c.damping) for c in drivetrain.couplings
        ),
        motor=replace(drivetrain.motor, inertia=0.5 * drivetrain.motor.inertia),
    )  # fmt: skip


def test_both_halves_under_the_torque_have_the_dynamic_factor_of_one_under_half_of_it() -> None:
    """At 1800 rpm, where the mesh frequency meets a mode of the loop."""
    whole, laws = prototype(), prototype_laws()

    def factors(drivetrain: Drivetrain, count: int, torque: float) -> np.ndarray:
        curve = periodic_response(
            assemble(drivetrain), [in_parallel(law, count) for law in laws], [1800.0 * math.pi / 30.0],
            LoopLoad(torque=torque), settings=SweepSettings(methods=("harmonic_balance",)),
        )  # fmt: skip
        (point,) = curve.points
        assert isinstance(point, CurvePoint)
        return point.dynamic_factor

    one, both = factors(halved(whole), 1, 90.0), factors(whole, 2, 180.0)
    assert both == pytest.approx(one, rel=1e-9)
    assert one.max() > 1.05
    # the whole torque on one half bends its teeth more, and its gears swing at another speed
    assert factors(whole, 1, 180.0) != pytest.approx(one, rel=1e-3)


POINT = OperatingPoint(stage="test", speed=1200.0, torque=180.0)
MESH = "reference.main"


def built(halves: int) -> Rig:
    case = load_case(CASES / "uhcf_prototype" / "table_1_bearings.toml")
    return build_rig(case.with_value("gearboxes.reference.meshes.main.carrying_halves", halves))


def test_the_case_gives_the_loop_what_carries() -> None:
    """Springs, dampers and axial spring of two halves, each under half of the torque; inertia as the case states it."""
    one, both = built(1), built(2)
    (single, shared) = (
        mesh_models(rig, POINT, initial_state(rig, POINT), "analytic")[1] for rig in (one, both)
    )
    assert (single.halves, shared.halves) == (1, 2)
    assert single.whole is single.law
    assert shared.whole.mean_stiffness == pytest.approx(2.0 * shared.law.mean_stiffness)
    # teeth under half of the load are a little softer where they touch
    assert 0.9 < shared.law.mean_stiffness / single.law.mean_stiffness < 1.0
    law = laws_of([single, shared])[1]
    assert law.damping == pytest.approx(2.0 * single.law.damping)
    axial = [rig.elastic.rig.axial_mesh_springs[0].stiffness for rig in (one, both)]
    # ISO 6336-1 makes teeth below 100 N/mm softer by the fourth root of the load
    assert axial[1] / axial[0] == pytest.approx(2.0 * 0.5**0.25, rel=1e-9)


def test_bodies_of_a_case_without_inertias_are_as_wide_as_what_carries() -> None:
    case = load_case(CASES / "uhcf_prototype" / "table_1_bearings.toml")
    gear = "gearboxes.reference.gears.pinion"
    found = []
    for halves in (1, 2):
        own = case.with_value("gearboxes.reference.meshes.main.carrying_halves", halves)
        own = own.model_copy(
            update={
                "gearboxes": {
                    **own.gearboxes,
                    "reference": own.gearboxes["reference"].model_copy(
                        update={
                            "gears": {
                                name: entry.model_copy(update={"inertia": None})
                                for name, entry in own.gearboxes["reference"].gears.items()
                            }
                        }
                    ),
                }
            }
        )
        drivetrain = build_rig(own).drivetrain
        assert drivetrain is not None
        found.append(drivetrain.gear(gear.removeprefix("gearboxes.").replace(".gears", "")))
    assert found[1].inertia == pytest.approx(2.0 * found[0].inertia)
    assert (found[1].mass, found[1].width) == pytest.approx((2.0 * found[0].mass, 2.0 * found[0].width))
