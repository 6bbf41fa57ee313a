"""Checks of gear seats: slip of press fits, stresses of splines, at the largest torque of stages, run and events."""

import math
from types import SimpleNamespace
from typing import Any

import pytest

from dynamics.rotor.graph import TorqueSection
from rigdesign.checks.assumptions import depends
from rigdesign.checks.seats import checks
from rigdesign.coupling.loop import PointResult
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.report.sections.vibration import least_safe
from rigdesign.results.check import Check
from rigdesign.results.loads import EventPeak, EventRecord
from tests.builders.checks import check as check_of
from tests.builders.made_run import made_ramp, made_run
from tests.builders.twisting import twisting_rig
from tests.builders.warm_prototype import base

FIT = "gearboxes.test.gears.pinion.shaft_interference"


def solved(*changes: tuple[str, object], seat: tuple[float, float] | None = None, **more: Any) -> SolvedRig:
    """The settled prototype with changes that its loop does not feel.

    seat : least and greatest torque [N m] of the seat of the test pinion in the stage run_up of a made-up time run
    """
    rig, point = base()
    if changes:
        rig = twisting_rig(rig.case.with_values(dict(changes))).with_models(rig.models)
    sections = (
        TorqueSection(kind="spline", part="test.pinion"),
        TorqueSection(kind="spline", part="test.wheel"),
    )
    ramp = made_ramp(rig, sections, {(0, "run_up"): seat} if seat else {})
    return SolvedRig(rig=rig, points=(point,), run=made_run(rig, [point], ramp), loads=LOADS, **more)


LOADS: Any = SimpleNamespace()
"""Something there: no check of seats reads the loads of the meshes."""


def slip(found: SolvedRig) -> Check:
    return next(check for check in checks(found) if check.id == "strength.press_fit_slip")


def peak_of(point: PointResult, mesh: int) -> float:
    assert point.last.response is not None
    return float(point.last.response.maximum[mesh])


def held_seat(found: SolvedRig) -> float:
    """Torque of the seat of the test pinion at the held stage [N m]."""
    return next(
        one.torque for one in found.seat_torques if (one.part, one.where) == ("test.pinion", "stage test")
    )


def test_the_seat_of_a_gear_carries_the_torque_of_its_mesh() -> None:
    """Drag of the gear takes less than a hundredth; inertia at 12,000 rpm, away from resonances, a twentieth at most.
    The wheel carries z2/z1 of the pinion."""
    rig, point = base()
    held = {one.part: one for one in solved().seat_torques if one.where == "stage test"}
    assert set(held) == {"test.pinion", "test.wheel", "reference.pinion", "reference.wheel"}
    for mesh, box in enumerate(("test", "reference")):
        mean = abs(float(point.last.response.mean[mesh]))  # type: ignore[union-attr]
        assert 0.99 * mean < held[f"{box}.pinion"].torque < 1.05 * peak_of(point, mesh)
    first, second = rig.pairs["test.main"].teeth
    ratio = held["test.wheel"].torque / held["test.pinion"].torque
    assert ratio == pytest.approx(second / first, rel=5e-3)


def test_time_run_and_events_give_the_torque_of_the_seat_itself() -> None:
    """Not what a mesh peaks at: each seat its own, with speed and temperatures of the stage or the event."""
    rig, point = base()
    event = EventRecord(
        name="broken", kind="tooth_loss", speed=1000.0, torque=180.0, what="",
        peaks=(
            EventPeak(
                place="test.main", part="test.main", quantity="mesh torque", before=180.0, peak=900.0, time=0.0
            ),
            EventPeak(
                place="test.pinion", part="test.pinion", quantity="seat torque", before=182.0, peak=480.0, time=0.0
            ),
        ),
    )  # fmt: skip
    found = solved(seat=(-130.0, 240.0), events=[event]).seat_torques
    run = {(one.part, one.where): one for one in found if one.where.startswith("time run")}
    pinion = run["test.pinion", "time run, stage run_up"]
    assert (pinion.torque, pinion.event) == (240.0, None)
    assert pinion.speed == pytest.approx(rig.case.schedule.test_speed) and pinion.point is point
    assert run["test.wheel", "time run, stage run_up"].torque == 1.0
    assert {where for _, where in run} == {f"time run, stage {s.name}" for s in rig.case.schedule.resolved()}
    (of_event,) = (one for one in found if one.event == "broken")
    assert (of_event.part, of_event.torque, of_event.speed) == ("test.pinion", 480.0, 1000.0)


def test_the_table_of_the_report_is_what_the_check_holds() -> None:
    """The least safety of all rows is the value of the check, its row where the check says."""
    found = solved((FIT, "150 um"), seat=(50.0, 240.0))
    fits = found.press_fits
    check = slip(found)
    worst = least_safe(fits, "gear")[0]
    assert worst.safety == min(fit.safety or math.inf for fit in fits) == pytest.approx(check.value)
    assert worst.where == "time run, stage run_up" and f"test.pinion, {worst.where}" in check.reason
    assert worst.peak_torque == 240.0


def test_without_a_press_fit_nothing_can_slip() -> None:
    check = slip(solved())
    assert check.verdict == "not applicable" and "shaft_interference" in check.reason
    # a default limit of what the rig does not have is no limit that nothing answers
    assert check.limit is None
    stated = slip(solved(("limits.strength.press_fit_safety_minimum", 1.5)))
    assert stated.verdict == "not applicable" and stated.limit == 1.5


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
    torque = held_seat(narrow)
    assert 0.3 * slips / torque < check.value < slips / torque
    assert f"{1e6 * left:.3g} um of 120 um" in check.reason


def test_a_higher_torque_of_the_time_run_governs() -> None:
    quiet = solved((FIT, "150 um"))
    twice = 2.0 * held_seat(quiet)
    loud = slip(solved((FIT, "150 um"), seat=(-twice, 10.0)))
    value = slip(quiet).value
    assert value is not None and loud.value == pytest.approx(0.5 * value, rel=1e-3)
    assert "time run, stage run_up" in loud.reason


def test_a_least_interference_above_the_effective_one_is_refused() -> None:
    case = base()[0].case
    with pytest.raises(
        Exception, match="shaft_interference_minimum = 30 um is above shaft_interference = 20 um"
    ):
        case.with_values({FIT: "20 um", f"{FIT}_minimum": "30 um"})


SPLINE = "gearboxes.test.gears.pinion.spline.toothing"
TEETH: tuple[tuple[str, object], ...] = (
    (f"{SPLINE}.teeth", 24), (f"{SPLINE}.module", "2 mm"), (f"{SPLINE}.length", "25 mm"),
)  # fmt: skip
"""W 50 x 2 x 24 to DIN 5480, 25 mm long."""


def found(solved_rig: SolvedRig) -> dict[str, Check]:
    return {check.id: check for check in checks(solved_rig)}


def test_a_spline_without_toothing_or_allowable_stress_is_not_held() -> None:
    for changes in ((), TEETH):
        for name in ("pressure", "shear", "hub"):
            check = found(solved(*changes))[f"strength.spline_{name}"]
            assert check.verdict == "not applicable" and "states spline.toothing" in check.reason


def test_a_spline_is_held_at_the_torque_of_its_seat() -> None:
    """Dudley by hand with D 48 mm, contact 1.8 mm high: p = 2 T/(D N F h), tau = 4 T/(D N F pi D/48), of the shaft
    16 T/(pi d^3) under teeth of 45 mm; the shaft has no bore there."""
    rig = solved(
        *TEETH,
        (f"{SPLINE}.shaft_root_diameter", "45 mm"),
        (f"{SPLINE}.allowable_pressure", "35 MPa"),
        (f"{SPLINE}.allowable_shear", "100 MPa"),
    )
    torque = held_seat(rig)
    pressure = 2.0 * torque / (0.048 * 24 * 0.025 * 0.0018)
    shear = max(4.0 * torque / (0.048 * 24 * 0.025 * math.pi * 0.001), 16.0 * torque / (math.pi * 0.045**3))
    checked = found(rig)
    assert checked["strength.spline_pressure"].value == pytest.approx(35e6 / pressure)
    assert checked["strength.spline_shear"].value == pytest.approx(100e6 / shear)
    assert checked["strength.spline_pressure"].limit == 1.0
    assert "test.pinion, stage test: flank pressure" in checked["strength.spline_pressure"].reason
    assert checked["strength.spline_hub"].verdict == "not applicable"


def test_a_hub_bursts_by_teeth_rotation_and_a_press_fit() -> None:
    """S_1 + S_3 + S_2 by hand; a press fit on the teeth adds its pressure, most of it cold and at rest: p of a solid
    shaft of one steel E (1 - Q^2) U/(2 D) times (1 + Q^2)/(1 - Q^2)."""
    hub = (
        *TEETH, (f"{SPLINE}.hub_root_diameter", "51.6 mm"), (f"{SPLINE}.hub_diameter", "80 mm"),
        (f"{SPLINE}.allowable_tension", "300 MPa"),
    )  # fmt: skip
    rig = solved(*hub)
    gear = rig.case.gearboxes["test"].gears["pinion"]
    material = rig.rig.materials[gear.material]
    torque = held_seat(rig)
    radial = torque * math.tan(math.radians(30.0)) / (math.pi * 0.048 * 0.0142 * 0.025)
    bending = 4.0 * torque / (0.048**2 * 0.025 * 1.5)
    nu, omega = material.poisson_ratio, rig.case.schedule.test_speed
    turning = (3.0 + nu) / 4.0 * material.density * omega**2 * (0.04**2 + (1 - nu) / (3 + nu) * 0.0258**2)
    check = found(rig)["strength.spline_hub"]
    assert check.value == pytest.approx(300e6 / (radial + bending + turning))
    pressed = found(solved(*hub, (FIT, "150 um")))
    assert pressed["strength.press_fit_slip"].verdict == "not applicable"
    share = (0.5 * gear.bore_diameter / rig.rig.pairs["test.main"].root_radii[0]) ** 2
    cold = material.elastic_modulus * (1.0 + share) * 150e-6 / (2.0 * gear.bore_diameter)
    check = pressed["strength.spline_hub"]
    assert check.value == pytest.approx(300e6 / cold, rel=1e-6) and "at rest, 20 degC" in check.reason


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"module": "2 mm", "pitch_diameter": "48 mm"}, "both of module and pitch_diameter"),
        ({}, "neither of module and pitch_diameter"),
        (
            {"module": "2 mm", "hub_diameter": "60 mm"},
            "hub_diameter = 60 mm needs a hub_root_diameter inside",
        ),
    ],
)
def test_a_toothing_that_contradicts_itself_is_refused(changes: dict[str, str], said: str) -> None:
    keys = {"teeth": 24, "length": "25 mm", **changes}
    with pytest.raises(Exception, match=said):
        base()[0].case.with_values({f"{SPLINE}.{key}": value for key, value in keys.items()})


def test_the_teeth_of_a_spline_move_the_checks_of_seats_alone() -> None:
    rig = solved(*TEETH).rig
    path = f"{SPLINE}.length"
    moved = {check.id for check in checks(solved(*TEETH)) if depends(rig.case, check, path)}
    assert "strength.spline_pressure" in moved
    other = check_of("dynamics.dynamic_factor.test")
    assert not depends(rig.case, other, path) and depends(
        rig.case, other, f"{SPLINE.removesuffix('.toothing')}.loss_factor"
    )
