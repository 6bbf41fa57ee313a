"""The loop of the prototype with shafts that bend, bearings loaded with a share of the torque of the held point."""

from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rigdesign.case.loader import load_case
from rigdesign.case.schedule import StageValues
from rigdesign.coupling.bearing_loads import solve_bearings
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.loop_over_speed import loop_over_speed
from rigdesign.coupling.mesh_models import mesh_models
from rigdesign.coupling.preloaded_loop import signed_torque
from rigdesign.coupling.time_run import held_points
from rigdesign.postprocessing import curves
from rigdesign.postprocessing.curves import dwell_speeds, dwell_stages, held_modes, modes_at, state_at
from rigdesign.postprocessing.start_torque import response_under
from rigdesign.rig.model import Rig, build_rig
from tests.builders.paths import CASES


@cache
def held() -> tuple[Rig, Any]:
    """The rig before any iteration at its test stage."""
    values = {"drivetrain.mesh_stiffness": "iso_6336_scaled"}
    rig = build_rig(load_case(CASES / "uhcf_prototype").with_values(values), "standard")
    (point, *_) = held_points(rig)
    state = initial_state(rig, point)
    last = SimpleNamespace(
        point=point, coupling_state=state, bearings=solve_bearings(rig, point, state), system=None,
        drags={}, models=(),
    )  # fmt: skip
    return rig, SimpleNamespace(point=point, last=last)


def test_bearings_of_a_state_carry_the_torque_of_the_curve_it_serves() -> None:
    """The state at a tenth of the torque is the band of the curve at that torque, with softer films than under all of
    it."""
    rig, point = held()
    speed = point.point.speed
    band: Any = loop_over_speed(rig, point.last, (0.9 * speed, speed), lambda _: 0.1)
    own = state_at(rig, point, speed, 0.1).system
    assert np.allclose(own.stiffness, band.systems[-1].stiffness, rtol=1e-12)
    part, full = (state_at(rig, point, speed, share).state for share in (0.1, 1.0))
    assert part is not None and full is not None
    for name, film in full.bearings.items():
        assert np.trace(film.stiffness) > np.trace(part.bearings[name].stiffness), name


def test_a_response_under_another_torque_has_its_own_bearings(monkeypatch: pytest.MonkeyPatch) -> None:
    """A twentieth of the test torque: the loop at the highest speed is that of bearings under a twentieth."""
    rig, point = held()
    asked: list[Any] = []
    monkeypatch.setattr(curves, "periodic_response", lambda *args, **kwargs: asked.append((args[0], kwargs)))
    monkeypatch.setattr(curves, "laws_of", lambda models: ())
    monkeypatch.setattr(curves, "periodic_laws", lambda rig, laws: ())
    top = rig.pinion_speed(point.point.speed)
    run: Any = SimpleNamespace(test=point)
    response_under(rig, run, 0.05 * point.point.torque, [0.9 * top, top])
    ((loop, kwargs),) = asked
    assert kwargs["load"].torque == pytest.approx(0.05 * signed_torque(rig, point.point))
    assert kwargs["settings"].methods == ("harmonic_balance",) and not kwargs["settings"].branches
    own = state_at(rig, point, point.point.speed, 0.05).system
    assert np.allclose(loop.at(top).stiffness, own.stiffness, rtol=1e-9)


def stage(name: str, kind: Any, speeds: tuple[float, float], *, held: bool = False) -> StageValues:
    return StageValues(
        name=name, kind=kind, speed_start=speeds[0], speed_end=speeds[1], torque_start=10.0, torque_end=10.0,
        duration=1.0, drive_torque=None, held=held,
    )  # fmt: skip


def test_the_rig_dwells_where_it_turns_at_one_speed_and_at_the_end_of_a_held_run_up() -> None:
    """Loading at one speed is a dwell, a run-up and bracing at rest are none; the test speed is always one."""
    stages = (
        stage("bracing", "load", (0.0, 0.0)),
        stage("up", "run_up", (0.0, 80.0)),
        stage("half", "load", (80.0, 80.0)),
        stage("test", "run_up", (80.0, 900.0), held=True),
        stage("down", "run_down", (900.0, 0.0)),
    )
    schedule = SimpleNamespace(
        resolved=lambda: stages, held=lambda: tuple(one for one in stages if one.held), test_speed=1000.0
    )
    rig: Any = SimpleNamespace(case=SimpleNamespace(schedule=schedule))
    assert [one.name for one in dwell_stages(rig)] == ["half", "test"]
    assert dwell_speeds(rig) == (900.0, 1000.0, 80.0)


def test_modes_of_a_slow_dwell_are_those_of_its_own_films() -> None:
    """Films at a sixteenth of the test speed are stiffer: the shafts in them bend at other frequencies."""
    rig, point = held()
    models = mesh_models(rig, point.point, point.last.coupling_state)
    warm: Any = SimpleNamespace(
        point=point.point, last=SimpleNamespace(**vars(point.last) | {"models": models})
    )
    fast = held_modes(rig, warm)
    assert [one.frequency for one in modes_at(rig, warm, point.point.speed)] == [
        one.frequency for one in fast
    ]
    slow = modes_at(rig, warm, point.point.speed / 16.0)
    own, other = ([mode.frequency for mode in modes if mode.frequency > 1.0][:20] for modes in (slow, fast))
    assert not np.allclose(own, other, rtol=1e-3)
