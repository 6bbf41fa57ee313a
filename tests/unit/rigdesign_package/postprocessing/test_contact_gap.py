"""Axes of the warm housing over the face of a mesh: flank that carries, end of the face that comes into mesh last."""

from dataclasses import replace
from math import cos, sin, tan
from types import SimpleNamespace
from typing import Any, Literal

import numpy as np
import pytest

from dynamics.gear.flank import PARALLEL
from rigdesign.case import load_case
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.rotation import helix_hands, last_end, pinion_sense
from rigdesign.coupling.alignment import AxisAngles, axis_deviation, misalignment
from rigdesign.coupling.loop import PointResult
from rigdesign.postprocessing import loaded_contact
from rigdesign.postprocessing.loaded_contact import held_flanks, warm_axes
from rigdesign.rig.model import Rig
from tests.builders.warm_prototype import base

Rotation = Literal["clockwise", "anticlockwise"]
Hand = Literal["right", "left"]
FRONT_TO_REAR = np.array([1.0, 0.0, 0.0])


def box_with(name: str = "reference", rotation: Rotation = "clockwise", hand: Hand | None = None) -> Gearbox:
    """A gearbox of the prototype: its reference gears are helical, its test gears spur."""
    box = load_case("cases/uhcf_prototype").gearboxes[name]
    entry = next(iter(box.meshes.values()))
    gears = dict(box.gears) | {entry.pinion: box.gears[entry.pinion].model_copy(update={"helix_hand": hand})}
    single = {own: mesh.model_copy(update={"double_helical": False}) for own, mesh in box.meshes.items()}
    return box.model_copy(update={"rotation": rotation, "gears": gears, "meshes": single})


def axes(inclination: float = 0.0, skew: float = 0.0) -> AxisAngles:
    return AxisAngles(inclination=inclination, skew=skew)


@pytest.mark.parametrize("rotation", ["clockwise", "anticlockwise"])
@pytest.mark.parametrize("hand", ["right", "left"])
@pytest.mark.parametrize("towards", [1.0, -1.0])
@pytest.mark.parametrize("flank", [0, 1])
def test_gap_over_the_face_is_that_of_moved_bodies(
    rotation: Rotation, hand: Hand, towards: float, flank: int
) -> None:
    """In space: axes, rotation and helix as vectors. A pinion at y = 0, its wheel towards +y or -y."""
    box, pair = box_with(rotation=rotation, hand=hand), base()[0].pairs["reference.main"]
    to_wheel, up = np.array([0.0, towards, 0.0]), np.array([0.0, 0.0, 1.0])
    tilt = np.array([0.0, 2e-4, 5e-4])  # slope of the wheel's axis along x, against the pinion's
    # as thermal.expansion reads them: skew along the right-hand turn of the direction between the axes about x
    hot = axes(inclination=float(tilt @ to_wheel), skew=float(tilt @ np.cross(FRONT_TO_REAR, to_wheel)))
    slope = misalignment(box, "main", hot).gap_slope(pair)[flank]

    spin = FRONT_TO_REAR if rotation == "clockwise" else -FRONT_TO_REAR  # clockwise looking along x
    passing = np.cross(spin, to_wheel)
    assert abs(passing @ up) == 1.0
    angle = pair.working_pressure_angle
    # force of the pinion on the wheel: away from it, and with the motion on the front flanks, against it on the back
    push = sin(angle) * to_wheel + (cos(angle) if flank == 0 else -cos(angle)) * passing
    # tooth of the pinion at the ends of the face: a right-hand helix turns about +x with growing x
    turned = (1.0 if hand == "right" else -1.0) * tan(pair.helix_angle)
    ahead_at_rear = turned * float(spin @ FRONT_TO_REAR) > 0.0
    rear = -1.0 if ahead_at_rear else 1.0  # z of the rear end: it comes into mesh last unless it is ahead
    assert last_end(box, "main") == rear
    assert slope * rear == pytest.approx(float(tilt @ push), rel=1e-12)


def test_spur_gears_and_unstated_hands_count_from_front_to_rear() -> None:
    pair = base()[0].pairs["test.main"]
    for rotation, sense in (("clockwise", 1.0), ("anticlockwise", -1.0)):
        box = box_with("test", rotation)  # type: ignore[arg-type]
        assert last_end(box, "main") == 1.0
        found = misalignment(box, "main", axes(inclination=1e-4, skew=3e-4))
        assert (found.inclination, found.skew) == (1e-4, sense * 3e-4)
        front, back = found.gap_slope(pair)
        assert (front - back) * sense > 0.0
    assert last_end(box_with(rotation="anticlockwise"), "main") == 1.0


def test_the_hand_of_either_gear_says_which_end_comes_last() -> None:
    box = box_with(hand="right")
    entry = box.meshes["main"]
    gears = dict(box.gears) | {
        entry.pinion: box.gears[entry.pinion].model_copy(update={"helix_hand": None}),
        entry.wheel: box.gears[entry.wheel].model_copy(update={"helix_hand": "left"}),
    }
    assert last_end(box.model_copy(update={"gears": gears}), "main") == last_end(box, "main") == -1.0


def idler_train(**hands: Hand) -> Gearbox:
    """Helical p-i-w: pinion p drives idler i, and i the wheel w."""
    box = box_with()
    first = box.meshes["main"]
    like = box.gears[first.pinion]
    gears = {name: like.model_copy(update={"shaft": name, "helix_hand": hands.get(name)}) for name in "piw"}
    meshes = {
        "first": box.meshes["main"].model_copy(update={"pinion": "p", "wheel": "i"}),
        "second": box.meshes["main"].model_copy(update={"pinion": "i", "wheel": "w"}),
    }
    return box.model_copy(update={"gears": gears, "meshes": meshes})


@pytest.mark.parametrize(("gear", "hand"), [("p", "right"), ("i", "left"), ("w", "right")])
def test_one_stated_hand_goes_through_the_train(gear: str, hand: Hand) -> None:
    box = idler_train(**{gear: hand})
    assert {name: found.hand for name, found in helix_hands(box).items()} == {
        "p": "right",
        "i": "left",
        "w": "right",
    }
    # the idler turns the other way and has the other hand: one end of its face comes last in both of its meshes
    assert last_end(box, "first") == last_end(box, "second") == -1.0


def test_gears_of_one_gearbox_turn_as_they_mesh() -> None:
    """The main rig: one pinion between two wheels. A wheel that were a pinion further on turns the other way."""
    box = load_case("cases/uhcf_main").gearboxes["test"]
    first, *others = box.meshes
    assert all(pinion_sense(box, name) == 1.0 for name in box.meshes)
    entry = box.meshes[first]
    turned = box.meshes[others[0]].model_copy(update={"pinion": entry.wheel, "wheel": "further"})
    gears = dict(box.gears) | {"further": box.gears[entry.pinion].model_copy(update={"shaft": "further"})}
    chain = box.model_copy(update={"gears": gears, "meshes": {first: entry, others[0]: turned}})
    assert pinion_sense(chain, others[0]) == -1.0


@pytest.mark.whole_run
def test_held_mesh_takes_the_axes_of_its_warm_housing_and_the_flanks_that_carry() -> None:
    rig, result = base()
    held = held_flanks(rig, result, 0)
    shape = result.last.expansion["test"].deformed.centre_distances[0]
    assert held.flank == "front" and held.face_sense == 1.0
    warm = AxisAngles(inclination=shape.inclination, skew=shape.skew)
    assert held.axes == misalignment(rig.case.gearboxes["test"], "main", warm)
    assert held.axes != PARALLEL and abs(held.axes.skew) < 1e-3
    # the loop closes through both: in the reference gearbox the wheel drives
    assert held_flanks(rig, result, 1).flank == "back"
    cold = replace(result, last=replace(result.last, expansion={}))
    assert warm_axes(rig, cold, 0) == PARALLEL


def gap_at_ends(rig: Rig, result: PointResult, mesh: int) -> tuple[float, float]:
    """Gap of the loaded flanks at the pitch point, at z = -b/2 and b/2 [m]."""
    held = held_flanks(rig, result, mesh)
    face = held.face_sense * np.array([-0.5, 0.5]) * held.pair.face_width
    path, rolls = np.zeros(2), tuple(np.full(2, roll) for roll in held.pair.rolling_radii)
    gap: Any = held.gap
    first, last = gap(np.zeros(2, dtype=np.int64), face, path, rolls)
    return float(first), float(last)


@pytest.mark.whole_run
def test_gap_holds_the_misalignment_and_the_modifications_of_the_loaded_flanks() -> None:
    rig, result = base()
    for mesh in (0, 1):
        held = held_flanks(rig, result, mesh)
        slope = held.axes.gap_slope(held.pair)[0 if held.flank == "front" else 1]
        first, last = gap_at_ends(rig, result, mesh)
        modified = sum(micro.helix_slope for micro in held.micro)
        assert last - first == pytest.approx(slope * held.pair.face_width + modified, abs=1e-12)


@pytest.mark.whole_run
def test_axes_as_made_add_to_those_of_the_warm_housing() -> None:
    rig, result = base()
    case = rig.case.with_values(
        {
            "gearboxes.test.meshes.main.axis_inclination": "4 um",
            "gearboxes.test.meshes.main.axis_skew": "-3 um",
            "gearboxes.reference.meshes.main.axis_skew": "2 um",
        }
    )
    made = replace(rig, case=case).with_models(rig.models)
    width = rig.pairs["test.main"].face_width
    before, after = warm_axes(rig, result, 0), warm_axes(made, result, 0)
    assert after.inclination - before.inclination == pytest.approx(4e-6 / width)
    assert after.skew - before.skew == pytest.approx(-3e-6 / width)
    # no housing: as made alone
    assert warm_axes(made, result, 1).skew == pytest.approx(2e-6 / rig.pairs["reference.main"].face_width)
    shape = result.last.expansion["test"].deformed
    deviations = [axis_deviation(entry, "test", "main", shape) for entry in (rig, made)]
    assert deviations[1].skew - deviations[0].skew == pytest.approx(-3e-6)


@pytest.mark.parametrize(("mean", "flank"), [(180.0, "front"), (-180.0, "back")])
def test_torque_of_a_loaded_contact_is_positive_on_either_flank(
    monkeypatch: pytest.MonkeyPatch, mean: float, flank: str
) -> None:
    flanks = SimpleNamespace(flank=flank, axes=PARALLEL)
    held = SimpleNamespace(
        flanks=flanks, cycle=None, gears=(), unloaded_contact_ratio=1.0, roots=(), at_tangent=None
    )
    monkeypatch.setattr(loaded_contact, "held_contact", lambda *of: held)
    monkeypatch.setattr(loaded_contact, "gauge_stresses", lambda *of: ())
    rig: Any = SimpleNamespace(mesh_names=("test.main",))
    response = SimpleNamespace(mean=np.array([mean]))
    point: Any = SimpleNamespace(point=SimpleNamespace(stage="test"), last=SimpleNamespace(response=response))
    found = loaded_contact.loaded_contact(rig, point, 0)
    assert found is not None
    assert (found.torque, found.flank) == (180.0, flank)
