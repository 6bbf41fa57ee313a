"""The recommended ramp: what the start torque does, limits of the rig, what the reasons say."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rigdesign.case import load_case
from rigdesign.postprocessing import start_torque as module
from rigdesign.postprocessing.dwell_speeds import RampLimits, SpeedLimit, ramp_steps, speed_limit
from rigdesign.postprocessing.nearest_resonance import NearDwell
from rigdesign.postprocessing.resonances import bands, safe_windows
from rigdesign.postprocessing.start_torque import (
    StagePeak,
    StartResponse,
    first_speed,
    start_torque,
    worst_start,
)
from rigdesign.results.vibration import AvoidedResonance, RampStep
from rigdesign.rig.model import Rig, build_rig
from tests.builders.paths import CASES

RAD = np.pi / 30.0
TEST = 12000.0 * RAD


@cache
def rig() -> Rig:
    return build_rig(load_case(CASES / "uhcf_prototype"), "quick")


def peak(rpm: float) -> AvoidedResonance:
    return AvoidedResonance(
        kind="shaft torque",
        where="test_pinion",
        speed=rpm * RAD,
        share=0.7,
        low=rpm * RAD / 1.1,
        high=rpm * RAD / 0.9,
    )


def response(lost: Sequence[tuple[float, float]]) -> StartResponse:
    """Under the start torque at 525 to 1200 rpm, every 25; contact is lost in these ranges [rpm]."""
    speed = np.arange(525.0, 1201.0, 25.0)
    parts = np.zeros(speed.size, bool)
    for low, high in lost:
        parts |= (speed >= low) & (speed <= high)
    return StartResponse(speed * RAD, np.where(parts, 2.5, 1.3), parts)


def steps(
    peaks: Sequence[float] = (),
    start: StartResponse | None = None,
    limit: SpeedLimit | None = None,
    up: StagePeak | None = None,
    own: Rig | None = None,
) -> dict[str, RampStep]:
    found = [peak(rpm) for rpm in peaks]
    avoided = bands(found)
    points = [
        SimpleNamespace(speed=rpm * RAD, dynamic_factor=np.array([1.1, 1.4])) for rpm in (1000.0, 5000.0)
    ]
    run: Any = SimpleNamespace(
        curves=SimpleNamespace(named={"180 Nm": (180.0, SimpleNamespace(points=points))})
    )
    near = NearDwell(TEST, 0.1, tuple(found)).nearest
    high = 13500.0 * RAD if limit is None else min(13500.0 * RAD, limit.speed)
    limits = RampLimits(
        run=run, bands=avoided, safe=safe_windows(avoided, 500.0 * RAD, high), near={rig().pinion_speed(TEST): near},
        limit=limit, start=start, up=up, down=None,
    )  # fmt: skip
    return {step.action: step for step in ramp_steps(own or rig(), limits)}


def test_the_torque_is_raised_at_the_transition_speed_where_contact_holds_there() -> None:
    assert first_speed(rig()) == pytest.approx(750.0 * RAD)
    assert start_torque(rig()) == 10.0
    for start in (None, response([]), response([(1100.0, 1200.0)])):
        assert steps(start=start)["run up"].speed == pytest.approx(750.0 * RAD)
    assert "the bearings float from here on" in steps()["run up"].reason


def test_the_torque_is_raised_above_the_speeds_at_which_the_start_torque_loses_contact() -> None:
    found = steps(start=response([(725.0, 775.0), (900.0, 900.0)]))
    assert found["run up"].speed == found["raise the torque in part"].speed == pytest.approx(800.0 * RAD)
    assert "725 to 775 rpm, near 900 rpm" in found["run up"].reason
    everywhere = steps(start=response([(525.0, 1200.0)]))["run up"]
    assert everywhere.speed == pytest.approx(750.0 * RAD) and "contact is lost here" in everywhere.reason


def test_the_time_run_under_the_start_torque_is_in_the_reason() -> None:
    reason = steps(up=StagePeak("to_transition_speed", 2.78, 736.0 * RAD, lost=True))["run up"].reason
    assert "K_V 2.78 at 736 rpm in stage to transition speed, contact is lost" in reason


def test_peaks_of_the_time_run_are_those_of_stages_under_the_start_torque_in_their_sense() -> None:
    def load(stage: str, factor: float, least: float) -> Any:
        return SimpleNamespace(stage=stage, dynamic_factor=factor, speed=736.0 * RAD, least_share=least)

    own = [
        load("to_transition_speed", 2.8, 0.0),
        load("run_up", 9.0, -0.1),
        load("to_standstill", 3.1, 0.2),
    ]
    loads: Any = SimpleNamespace(
        meshes={name: SimpleNamespace(stage_loads=own) for name in ("test", "reference")}
    )
    up, down = worst_start(rig(), loads, 1), worst_start(rig(), loads, -1)
    assert up is not None and (up.stage, up.factor, up.lost) == ("to_transition_speed", 2.8, True)
    assert down is not None and (down.stage, down.factor, down.lost) == ("to_standstill", 3.1, False)


def test_no_safe_speed_is_advised_beyond_the_limit_of_the_rig() -> None:
    """A peak at 11,100 rpm: safe are 10,090 rpm and below, and 12,334 rpm that the rig may not turn."""
    limit = speed_limit(rig())
    assert limit is not None and limit.speed == pytest.approx(TEST)
    assert limit.source == "limits.bought_parts.rig_speed"
    inside, beyond = steps([11100.0], limit=limit), steps([11100.0])
    assert (
        "nearest safe speed 10090 rpm, none above it up to the limit of the rig, 12000 rpm"
        in inside["dwell"].reason
    )
    assert "7.5 % away" in inside["dwell"].reason
    assert "nearest safe speed 12334 rpm" in beyond["dwell"].reason
    for found, rpm in ((inside, 10090.0), (beyond, 12334.0)):
        for action in ("run up without a stop", "raise to the test torque", "dwell", "relieve"):
            assert found[action].speed == pytest.approx(rpm * RAD)
    slower = steps(limit=SpeedLimit(11000.0 * RAD, "limits.bought_parts.motor"))["dwell"].reason
    assert "above the limit of the rig, 11000 rpm (limits.bought_parts.motor)" in slower


def test_part_of_the_torque_stays_below_the_test_torque_at_the_peaks_passed() -> None:
    found = steps()
    assert found["raise the torque in part"].torque == pytest.approx(90.0)
    assert "K_V reaches 1.40" in found["raise the torque in part"].reason
    assert found["raise to the test torque"].torque == 180.0
    assert found["relieve and stop"].speed == 0.0


def test_a_speed_raised_to_where_contact_holds_is_not_moved_back_to_where_it_parts() -> None:
    """Flanks part at 725 to 775 rpm, so that the torque is raised at 800, in a band of 745 to 911: its lower end lies
    where they part, its upper end is free, or is not where they part again up to 950."""
    case = load_case(CASES / "uhcf_prototype").with_value("limits.ramp.transition_speed", None)
    film_less = build_rig(case, "quick")
    for own in (film_less, rig()):
        found = steps([820.0], start=response([(725.0, 775.0)]), own=own)["run up"]
        assert found.speed == pytest.approx(820.0 / 0.9 * RAD)
        assert "moved from 800 rpm" in found.reason
        again = steps([820.0], start=response([(725.0, 775.0), (900.0, 950.0)]), own=own)["run up"]
        assert again.speed == pytest.approx(975.0 * RAD)


def test_windows_without_the_speeds_at_which_flanks_part() -> None:
    found = response([(725.0, 775.0), (825.0, 825.0), (1200.0, 1200.0)])
    windows = found.held([(600.0 * RAD, 710.0 * RAD), (760.0 * RAD, 1400.0 * RAD)])
    assert [(round(low / RAD, 3), round(high / RAD, 3)) for low, high in windows] == [
        (600.0, 700.0), (850.0, 1175.0), (1200.0, 1400.0)
    ]  # fmt: skip
    assert found.holds_at(800.0 * RAD) and not found.holds_at(790.0 * RAD) and not found.holds_at(825.0 * RAD)


def test_a_stage_that_relieves_while_it_turns_is_none_under_the_start_torque(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It ends under the start torque, but its resonances are passed under more."""
    stage = SimpleNamespace(name="down", torque_start=180.0, torque_end=10.0, speed_start=TEST, speed_end=0.0)
    monkeypatch.setattr(module, "start_torque", lambda rig: 10.0)
    case: Any = SimpleNamespace(schedule=SimpleNamespace(resolved=lambda: (stage,)))
    load = SimpleNamespace(stage="down", dynamic_factor=3.0, speed=TEST, least_share=0.5)
    loads: Any = SimpleNamespace(
        meshes={label: SimpleNamespace(stage_loads=[load]) for label in rig().mesh_labels.values()}
    )
    own = replace(rig(), case=case)
    assert worst_start(own, loads, -1) is None
