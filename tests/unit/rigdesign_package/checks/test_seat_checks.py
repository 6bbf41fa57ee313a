"""Checks of gear seats: slip of press fits at the largest torque of stages, time run and events."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from rigdesign.checks.seats import checks
from rigdesign.coupling.loop import PointResult
from rigdesign.records.seat_torques import held_seat_torques, seat_torques
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.results.check import Check
from rigdesign.results.events import EventPeak, EventRecord
from tests.builders.warm_prototype import base, settled

FIT = "gearboxes.test.gears.pinion.shaft_interference"


def solved(*changes: tuple[str, object], peaks: dict[str, float] | None = None, **more: Any) -> SolvedRig:
    """The settled prototype, with peaks [N m] of its meshes by gearbox in the stage run_up of a made-up time run."""
    rig, last = settled(*changes)
    point = replace(base()[1], last=last)
    loads: Any = SimpleNamespace(meshes={label: run_up(peaks, label) for label in ("test", "reference")})
    return SolvedRig(rig=rig, points=(point,), loads=loads, **more)


def run_up(peaks: dict[str, float] | None, label: str) -> Any:
    loads = [SimpleNamespace(stage="run_up", peak=peaks[label])] if peaks else []
    return SimpleNamespace(stage_loads=loads)


def slip(found: SolvedRig) -> Check:
    return next(check for check in checks(found) if check.id == "strength.press_fit_slip")


def peak_of(point: PointResult, mesh: int) -> float:
    assert point.last.response is not None
    return float(point.last.response.maximum[mesh])


def test_the_seat_of_a_gear_carries_the_torque_of_its_mesh() -> None:
    """Drag of the gear takes less than a hundredth; inertia at 12,000 rpm, away from resonances, a twentieth at most.
    The wheel carries z2/z1 of the pinion."""
    rig, point = base()
    held = {one.gear: one for one in held_seat_torques(rig, [point])}
    assert set(held) == {"test.pinion", "test.wheel", "reference.pinion", "reference.wheel"}
    for mesh, box in enumerate(("test", "reference")):
        mean = abs(float(point.last.response.mean[mesh]))  # type: ignore[union-attr]
        assert 0.99 * mean < held[f"{box}.pinion"].torque < 1.05 * peak_of(point, mesh)
    first, second = rig.pairs["test.main"].teeth
    ratio = held["test.wheel"].torque / held["test.pinion"].torque
    assert ratio == pytest.approx(second / first, rel=5e-3)


def test_time_run_and_events_scale_the_seat_by_their_meshes() -> None:
    rig, point = base()
    peaks = {"test": 2.0 * peak_of(point, 0), "reference": 3.0 * peak_of(point, 1)}
    event = EventRecord(
        name="broken", kind="tooth_loss", speed=1000.0, torque=180.0, what="",
        peaks=(
            EventPeak(place="test.main", quantity="mesh torque", before=180.0, peak=4.0 * peak_of(point, 0), time=0.0),
            EventPeak(place="wheel_side", quantity="coupling torque", before=180.0, peak=1e6, time=0.0),
        ),
    )  # fmt: skip
    loads: Any = solved(peaks=peaks).loads
    found = seat_torques(rig, [point], loads, [event])
    held = {one.gear: one.torque for one in found if one.where == "stage test"}
    run = {one.gear: one for one in found if one.where == "time run, stage run_up"}
    assert run["test.wheel"].torque == pytest.approx(2.0 * held["test.wheel"])
    assert run["reference.pinion"].torque == pytest.approx(3.0 * held["reference.pinion"])
    assert run["test.wheel"].speed == pytest.approx(rig.case.schedule.test_speed)
    of_event = {one.gear: one for one in found if one.where == "event broken"}
    assert set(of_event) == {"test.pinion", "test.wheel"}
    assert of_event["test.pinion"].torque == pytest.approx(4.0 * held["test.pinion"])
    assert of_event["test.pinion"].speed == 1000.0


def test_without_a_press_fit_nothing_can_slip() -> None:
    check = slip(solved())
    assert check.verdict == "not applicable" and "shaft_interference" in check.reason


def test_a_press_fit_is_held_hot_at_speed_and_at_its_least_interference() -> None:
    """By hand: interference less D alpha (T_gear - T_shaft), Lame's rings of one steel with a solid shaft,
    p = E (1 - Q^2) U / (2 D) at rest; what the speed takes lies between that and 0. Slip torque over peak torque."""
    wide, narrow = solved((FIT, "150 um")), solved((FIT, "150 um"), (f"{FIT}_minimum", "120 um"))
    check, tighter = slip(narrow), slip(wide)
    assert check.limit == 1.2 and check.source.startswith("limits.strength.press_fit_safety_minimum")
    assert check.value is not None and tighter.value is not None and 0.0 < check.value < tighter.value
    rig = narrow.rig
    gear = rig.case.gearboxes["test"].gears["pinion"]
    state = narrow.points[0].last.coupling_state
    warm = state.gear_temperature["test.pinion"] - state.oil_outlet["test.bearing_oil"]
    assert warm > 10.0
    material = rig.materials[gear.material]
    left = 120e-6 - gear.bore_diameter * material.expansion_coefficient * warm
    share = (0.5 * gear.bore_diameter / rig.pairs["test.main"].root_radii[0]) ** 2
    still = material.elastic_modulus * (1.0 - share) * left / (2.0 * gear.bore_diameter)
    width = rig.case.gearboxes["test"].body_width("pinion")
    slips = 0.12 * still * 3.14159265 * gear.bore_diameter**2 * width / 2.0
    (torque,) = (one.torque for one in narrow.seat_torques if one.gear == "test.pinion")
    assert 0.3 * slips / torque < check.value < slips / torque
    assert f"{1e6 * left:.3g} um of 120 um" in check.reason


def test_a_higher_torque_of_the_time_run_governs() -> None:
    peaks = {"test": 2.0 * peak_of(base()[1], 0), "reference": 1.0}
    quiet, loud = slip(solved((FIT, "150 um"))), slip(solved((FIT, "150 um"), peaks=peaks))
    assert quiet.value is not None and loud.value == pytest.approx(0.5 * quiet.value, rel=1e-3)
    assert "time run, stage run_up" in loud.reason


def test_a_least_interference_above_the_effective_one_is_refused() -> None:
    case = base()[0].case
    with pytest.raises(
        Exception, match="shaft_interference_minimum = 30 um is above shaft_interference = 20 um"
    ):
        case.with_values({FIT: "20 um", f"{FIT}_minimum": "30 um"})
