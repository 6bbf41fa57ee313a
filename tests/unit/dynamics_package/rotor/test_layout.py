from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from dynamics.rotor.assembly import assemble_rig
from dynamics.rotor.parts import JointStiffness
from dynamics.rotor.rotor_model import (
    AxialLocation,
    AxialMeshSpring,
    ElasticRig,
    HousingSupport,
    ProbeStation,
    ShaftPlacement,
    double_helical_stiffness,
    isotropic_support,
)
from dynamics.rotor.shaft import Disc, DrivetrainError, Section
from tests.builders.elastic_rig import prototype_rig, single_shaft

BAR = (Section(length=0.4, outer_diameter=0.04),)


def moved(shaft: str, **changes: object) -> ElasticRig:
    rig = prototype_rig(0.05)
    return replace(
        rig,
        placements=tuple(replace(p, **changes) if p.shaft == shaft else p for p in rig.placements),  # type: ignore[arg-type]
    )


def without_coupling_stiffness(**given: float) -> ElasticRig:
    rig = prototype_rig(0.05)
    couplings = tuple(replace(c, flexibility=JointStiffness(**given)) for c in rig.drivetrain.couplings)
    return replace(rig, drivetrain=replace(rig.drivetrain, couplings=couplings))


def with_bearings(*names: str) -> ElasticRig:
    """Couplings that hold nothing sideways, and only some bearings."""
    rig = without_coupling_stiffness(axial=2e5)
    kept = tuple(b for b in rig.drivetrain.bearings if b.shaft != "test_pinion" or b.name in names)
    return replace(rig, drivetrain=replace(rig.drivetrain, bearings=kept))


@pytest.mark.parametrize(
    ("build", "says"),
    [
        (
            lambda: replace(prototype_rig(0.05), placements=prototype_rig(0.05).placements[1:]),
            ["shaft 'test_pinion'", "0 placements", "must have 1"],
        ),
        (
            lambda: moved("reference_wheel", z=0.001),
            ["coupling 'wheel side'", "0.001 m apart", "one axis"],
        ),
        (lambda: moved("reference_wheel", sense=1), ["coupling 'wheel side'", "must be equal"]),
        (
            lambda: replace(
                prototype_rig(0.05),
                placements=tuple(replace(p, sense=1) for p in prototype_rig(0.05).placements),
            ),
            ["mesh 'test'", "sense 1", "must be opposite"],
        ),
        (
            lambda: replace(
                prototype_rig(0.05), placements=tuple(replace(p, y=1.01 * p.y) for p in prototype_rig(0.05).placements)
            ),
            ["mesh 'test'", "0.100495 m apart", "0.0995 m", "correct the placements"],
        ),
        (
            lambda: moved("reference_wheel", start=0.25),
            ["mesh 'reference'", "apart along x", "0.04 m"],
        ),
        (
            lambda: replace(
                prototype_rig(0.05), stations=(ProbeStation(name="gauge", shaft="test_wheel", position=0.3),)
            ),
            ["station 'gauge'", "position = 0.3 m", "0.27 m"],
        ),
        (
            lambda: replace(
                prototype_rig(0.05), stations=(ProbeStation(name="motor", shaft="test_wheel", position=0.1),)
            ),
            ["station 'motor'", "taken", "rename"],
        ),
        (
            lambda: replace(prototype_rig(0.05), axially_locating=("no bearing",)),
            ["axially_locating 'no bearing'", "known are", "test_pinion front"],
        ),
        (
            lambda: replace(
                prototype_rig(0.05),
                supports=(isotropic_support("test_wheel front", 5e8, 1.0),) * 2,
            ),
            ["housing support 'test_wheel front'", "2 times"],
        ),
        (lambda: isotropic_support("b0", 1e8, 0.0), ["mass = 0", "must be above 0", "mass that moves"]),
        (
            lambda: HousingSupport(name="h", bearings=("a", "b"), stiffness=np.eye(3), mass=np.eye(3)),
            ["'h'", "stiffness has shape (3, 3)", "(4, 4), (6, 6) or (10, 10)"],
        ),
        (
            lambda: HousingSupport(
                name="h", bearings=("a",), stiffness=np.array([[1e8, 1e7], [0.0, 1e8]]), mass=np.eye(2)
            ),
            ["'h'", "not symmetric"],
        ),
        (lambda: AxialLocation(bearing="b0", stiffness=0.0), ["'b0'", "stiffness = 0.0 N/m", "above 0"]),
        (lambda: JointStiffness(lateral=-1.0), ["lateral = -1.0", "not be negative"]),
        (
            lambda: assemble_rig(replace(prototype_rig(0.05), axial_locations=())),
            ["'test_pinion'", "no axial location", "test_pinion, reference_pinion", "axial location"],
        ),
        (
            lambda: assemble_rig(without_coupling_stiffness()),
            ["'test_pinion'", "0 of its bearings", "must be 1"],
        ),
        (
            lambda: assemble_rig(with_bearings("test_pinion front")),
            ["shaft 'test_pinion' with 1 bearing:", "not held", "add or move a bearing"],
        ),
        (
            lambda: assemble_rig(single_shaft(BAR, (0.1, 0.1), 0.1)),
            ["shaft 'rotor' with 2 bearings 0 m apart, must be above 0 m:", "not held", "add or move a bearing"],
        ),
        (
            lambda: assemble_rig(with_bearings()),
            ["shaft 'test_pinion' with 0 bearings:", "two bearings"],
        ),
        (
            lambda: assemble_rig(
                single_shaft(
                    BAR, (0.0, 0.4), 0.1,
                    discs=(Disc(name="d", position=0.1, inertia=2.0, diametral_inertia=0.9),),
                )
            ),
            ["disc 'd'", "0.9 kg m2", "at least half", "1 kg m2"],
        ),
    ],
)  # fmt: skip
def test_impossible_rigs(build: Callable[[], object], says: list[str]) -> None:
    with pytest.raises(DrivetrainError) as error:
        build()
    for words in says:
        assert words in str(error.value)


def test_a_shaft_may_hang_on_one_bearing_and_a_stiff_coupling() -> None:
    rig = prototype_rig(0.05)
    kept = tuple(b for b in rig.drivetrain.bearings if b.name != "test_pinion rear")
    assemble_rig(replace(rig, drivetrain=replace(rig.drivetrain, bearings=kept)))


def test_one_bearing_that_carries_moments_holds_a_shaft() -> None:
    rig = single_shaft(BAR, (0.2,), 0.1)
    with pytest.raises(DrivetrainError, match="with 1 bearing"):
        assemble_rig(rig)
    assemble_rig(replace(rig, moment_carrying=("b0",)))


ONE_LOCATED = (AxialLocation(bearing="reference_wheel rear", stiffness=1e8),)
"""The pinion line floats."""


def with_hands(*hands: float, second: bool = False) -> ElasticRig:
    """Test and reference mesh, and a second reference mesh beside the first, with base helix angles [rad]."""
    rig = prototype_rig(0.05)
    train = rig.drivetrain
    gears, meshes = train.gears, train.meshes
    if second:
        twins = {g.name: replace(g, name=f"{g.name}_2") for g in gears if g.name.startswith("reference")}
        gears = (*gears, *twins.values())
        pinion, wheel = (twin.name for twin in twins.values())
        meshes = (*meshes, replace(meshes[1], name="second", pinion=pinion, wheel=wheel))
    meshes = tuple(replace(m, base_helix_angle=hand) for m, hand in zip(meshes, hands, strict=True))
    return replace(rig, drivetrain=replace(train, gears=gears, meshes=meshes), axial_locations=ONE_LOCATED)


@pytest.mark.parametrize(
    ("hands", "second"),
    [
        ((0.0, 0.0), False),  # spur: the line shifts freely
        (
            (0.0, 0.3),
            False,
        ),  # torque of the loop has nothing to lean on: the line screws until the flanks part
        ((0.3, -0.3), False),  # the same
        ((0.3, 0.3), False),
        ((0.0, 0.3, 0.3), True),  # one lead, two meshes: the shaft screws through both
    ],
)
def test_a_helical_mesh_that_a_shaft_can_screw_along_does_not_locate_it(
    hands: tuple[float, ...], second: bool
) -> None:
    with pytest.raises(DrivetrainError) as error:
        assemble_rig(with_hands(*hands, second=second))
    assert "'test_pinion' has no axial location: 0 of its bearings" in str(error.value)
    assert ("single-helical" in str(error.value)) == any(hands)


def test_two_meshes_of_opposite_hands_hold_a_line_and_leave_the_float_in_the_matrices() -> None:
    """A double-helical gear as the two gears that it is."""
    model = assemble_rig(with_hands(0.0, 0.3, -0.3, second=True))
    assert [(m.kind, m.bodies) for m in model.rigid] == [
        ("turn", ("test_pinion", "reference_pinion")),
        ("turn", ("test_wheel", "reference_wheel")),
        ("axial", ("test_pinion", "reference_pinion")),
    ]
    for motion in model.rigid:
        assert np.abs(model.stiffness @ motion.shape).max() < 1e-14 * abs(model.stiffness).max()
        assert np.abs(model.damping @ motion.shape).max() < 1e-9
        assert set(motion.shape) == {0.0, 1.0}


def test_a_gear_that_slides_on_its_seat_is_held_by_its_mesh_only_with_a_partner_of_other_hand() -> None:
    rig = with_hands(0.0, 0.3)
    free = JointStiffness(axial=0.0, lateral=5e8, angular=2e5)
    gears = tuple(
        replace(g, seat=free) if g.name == "reference_wheel_gear" else g for g in rig.drivetrain.gears
    )
    rig = replace(
        rig,
        drivetrain=replace(rig.drivetrain, gears=gears),
        axial_locations=prototype_rig(0.05).axial_locations,
    )
    with pytest.raises(DrivetrainError, match="'reference_wheel_gear' has no axial location"):
        assemble_rig(rig)


def test_an_axial_mesh_spring_ties_the_floating_line_to_the_located_one() -> None:
    stiffness = double_helical_stiffness(7e8, 0.3)
    rig = replace(
        prototype_rig(0.05),
        axial_locations=(AxialLocation(bearing="reference_wheel rear", stiffness=1e8),),
        axial_mesh_springs=(AxialMeshSpring(mesh="reference", stiffness=stiffness),),
    )
    assert stiffness == pytest.approx(7e8 * np.tan(0.3) ** 2)
    model = assemble_rig(rig)
    assert [motion.kind for motion in model.rigid] == ["turn", "turn"]
    joint = model.joint("reference", "axial mesh spring")
    pinion, wheel = (
        model.freedoms.place("reference_pinion_gear"),
        model.freedoms.place("reference_wheel_gear"),
    )
    assert joint.rows[0, [pinion.base, wheel.base]].tolist() == [1.0, -1.0]
    # both gears tilt about z as one body, their pitch point stays common
    tilt = np.zeros(model.size)
    for place, y in ((pinion, -0.04975), (wheel, 0.04975)):
        tilt[[place.base, place.base + 5]] = -y, 1.0
    assert joint.rows[0] @ tilt == pytest.approx(0.0, abs=1e-15)


def test_placement_of_a_shaft_drawn_backwards() -> None:
    rig = single_shaft(BAR, (0.1, 0.4), 0.1)
    rig = replace(
        rig, placements=(ShaftPlacement(shaft="rotor", y=0.0, z=0.0, sense=1, start=1.0, direction=-1),)
    )
    assert rig.x("rotor", 0.1) == pytest.approx(0.9)
