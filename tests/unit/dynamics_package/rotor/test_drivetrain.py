from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from dynamics.rotor.graph import Drivetrain, assemble, joints
from dynamics.rotor.parts import Coupling, DragPlace, GearBody, MeshConnection, Motor, speed_ratios
from dynamics.rotor.shaft import DrivetrainError, Section, Shaft
from tests.builders.rig import CENTRE_DISTANCE, mesh, prototype


def short(name: str) -> Shaft:
    return Shaft(name=name, sections=(Section(length=0.2, outer_diameter=0.04),), element_length=0.05)


def body(name: str, shaft: str, position: float) -> GearBody:
    return GearBody(name=name, shaft=shaft, position=position, inertia=1e-3, stiffness=1e6, damping=1e3)


def joined(
    name: str, pinion: str, wheel: str, teeth: tuple[int, int], distance: float = 0.1
) -> MeshConnection:
    radius = 0.45e-3 * teeth[0]
    return MeshConnection(
        name=name,
        pinion=pinion,
        wheel=wheel,
        base_radii=(radius, radius * teeth[1] / teeth[0]),
        teeth=teeth,
        centre_distance=distance,
    )


def idler_loop(**changes: object) -> Drivetrain:
    """Pinion shaft as idler between two wheel shafts, closed by a second gearbox of the same ratios."""
    parts: dict[str, object] = {
        "shafts": (short("left"), short("idler"), short("right")),
        "gears": tuple(
            body(f"{s} {box}", s, x)
            for s in ("left", "idler", "right")
            for box, x in (("a", 0.05), ("b", 0.15))
        ),
        "meshes": (
            joined("a1", "idler a", "left a", (90, 100)),
            joined("a2", "idler a", "right a", (90, 110), 0.105),
            joined("b1", "idler b", "left b", (81, 90)),
            joined("b2", "idler b", "right b", (72, 88), 0.105),
        ),
        "motor": Motor(shaft="idler", position=0.0),
    }
    return Drivetrain(**{**parts, **changes})  # type: ignore[arg-type]


def test_four_shafts_with_two_meshes_make_two_free_lines() -> None:
    system = assemble(prototype())
    assert system.inertia.shape == (len(system.dofs),) * 2
    assert system.rigid.shape[1] == 2
    for turned in system.rigid.T:
        assert np.abs(system.stiffness @ turned).max() < 1e-6
        assert np.abs(system.damping @ turned).max() < 1e-9
    assert np.linalg.matrix_rank(system.stiffness, tol=1.0) == len(system.dofs) - 2
    assert [system.dofs[i] for i in system.mesh_ports.ravel()] == [
        "test_pinion/test_pinion_gear",
        "test_wheel/test_wheel_gear",
        "reference_pinion/reference_pinion_gear",
        "reference_wheel/reference_wheel_gear",
    ]


def test_inertia_is_that_of_all_parts() -> None:
    rig = prototype()
    parts = sum(s.inertia for s in rig.shafts) + sum(g.inertia for g in rig.gears) + rig.motor.inertia
    assert assemble(rig).inertia.sum() == pytest.approx(parts, rel=1e-12)


def test_matrices_are_the_sum_of_the_joints() -> None:
    rig = prototype()
    system = assemble(rig)
    stiffness = np.zeros_like(system.stiffness)
    for joint in joints(rig):
        difference = np.zeros(len(system.dofs))
        difference[joint.dof_a], difference[joint.dof_b] = 1.0, -1.0
        stiffness += joint.stiffness * np.outer(difference, difference)
    assert np.allclose(stiffness, system.stiffness, rtol=1e-12, atol=1e-3)


def test_twist_load_is_that_of_the_bracing_coupling() -> None:
    system = assemble(prototype())
    assert sorted(system.twist_load[system.twist_load != 0.0]) == [-138e3, 138e3]
    assert not assemble(replace(prototype(), bracing_coupling=None)).twist_load.any()


def test_linear_drag_and_named_drag_loads() -> None:
    rig = replace(
        prototype(linear_drag=7e-4), drag_places=(DragPlace(name="seal", shaft="test_wheel", position=0.1),)
    )
    system = assemble(rig)
    assert np.ones(len(system.dofs)) @ system.damping @ np.ones(len(system.dofs)) == pytest.approx(8 * 7e-4)
    assert len(system.drag_loads) == 8 + 4 + 1
    assert all(load.sum() == -1.0 for load in system.drag_loads.values())
    where = int(np.flatnonzero(system.drag_loads["seal"])[0])
    assert system.dofs[where] == "test_wheel/100.00 mm"


def test_motor_on_a_joint_of_its_own_is_a_freedom() -> None:
    rig = replace(
        prototype(), motor=Motor(shaft="test_wheel", position=0.0, inertia=0.02, stiffness=5e3, damping=1.0)
    )
    system = assemble(rig)
    assert system.dofs[system.drive_dof] == "test_wheel/motor"
    assert system.inertia[system.drive_dof, system.drive_dof] == 0.02


def test_loop_over_three_shafts_with_an_idler() -> None:
    rig = idler_loop()
    assert speed_ratios(rig) == pytest.approx({"left": 0.9, "idler": 1.0, "right": 9.0 / 11.0}, rel=1e-15)
    system = assemble(rig)
    assert system.mesh_ports.shape == (4, 2)
    assert system.rigid.shape[1] == 3


@pytest.mark.parametrize(
    ("build", "says"),
    [
        (
            lambda: replace(
                prototype(), meshes=(prototype().meshes[0], mesh("reference", 0.0461, (99, 103)))
            ),
            ["mesh 'reference'", "99/103", "not 1", "change tooth numbers"],
        ),
        (
            lambda: replace(
                prototype(),
                meshes=(
                    prototype().meshes[0],
                    replace(prototype().meshes[1], centre_distance=CENTRE_DISTANCE + 1e-4),
                ),
            ),
            ["centre distance = 0.0996 m", "0.0995 m", "make the two equal"],
        ),
        (
            lambda: Drivetrain(
                shafts=(short("a"), short("b"), short("c")),
                gears=(body("1", "a", 0.1), body("2", "b", 0.1), body("3", "c", 0.1)),
                meshes=(
                    joined("12", "1", "2", (60, 60)),
                    joined("23", "2", "3", (60, 60)),
                    joined("31", "3", "1", (60, 60)),
                ),
                motor=Motor(shaft="a", position=0.0),
            ),
            ["the loop locks", "odd number of external meshes", "add or remove an idler"],
        ),
        (
            lambda: idler_loop(
                shafts=(short("left"), short("idler"), short("right"), short("far")),
                gears=(
                    body("l", "left", 0.1),
                    body("i", "idler", 0.1),
                    body("r", "right", 0.1),
                    body("f", "far", 0.1),
                ),
                meshes=(
                    joined("1", "l", "i", (60, 60)),
                    joined("2", "i", "r", (60, 60)),
                    joined("3", "r", "f", (60, 60)),
                    joined("4", "f", "l", (60, 60), 0.4),
                ),
            ),
            ["'left' and 'far' = 0.4 m", "0.3 m long", "shorten this"],
        ),
        (
            lambda: idler_loop(meshes=idler_loop().meshes[:1] + idler_loop().meshes[2:3]),
            ["shaft 'right' is not connected to the motor's shaft 'idler'"],
        ),
        (
            lambda: idler_loop(meshes=(joined("own", "left a", "left b", (60, 60)),)),
            ["mesh 'own'", "same shaft line"],
        ),
        (
            lambda: idler_loop(
                meshes=(replace(joined("m", "left a", "idler a", (60, 60)), base_radii=(0.03, 0.031)),)
            ),
            ["ratio of base radii = 1.03333333", "60/60"],
        ),
        (
            lambda: replace(
                prototype(),
                couplings=(Coupling(name="c", shafts=("test_pinion", "nobody"), stiffness=1e5),),
            ),
            ["shaft 'nobody' does not exist", "test_pinion"],
        ),
        (
            lambda: replace(prototype(), gears=(*prototype().gears, prototype().gears[0])),
            ["'test_pinion_gear' is given 2 times"],
        ),
        (
            lambda: replace(prototype(), motor=Motor(shaft="test_pinion", position=1.0)),
            ["motor on shaft 'test_pinion'", "position = 1.0 m"],
        ),
        (
            lambda: replace(
                prototype(), gears=(replace(prototype().gears[0], damping=-1.0), *prototype().gears[1:])
            ),
            ["damping = -1.0", "must not be negative"],
        ),
        (lambda: replace(prototype(), bracing_coupling="x"), ["bracing coupling 'x' does not exist"]),
    ],
)
def test_drivetrains_that_cannot_be_are_refused(build: Callable[[], object], says: list[str]) -> None:
    with pytest.raises(DrivetrainError) as caught:
        build()
    assert [part for part in says if part not in str(caught.value)] == []
