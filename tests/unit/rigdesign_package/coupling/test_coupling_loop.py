"""The coupling loop ends when temperatures, lengths and torques have all converged, on iterations made up here."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from rigdesign.base.errors import NotConvergedError
from rigdesign.coupling import fixed_point, iteration, loop
from rigdesign.coupling import fixed_point as acceleration
from rigdesign.coupling.fixed_point import next_state
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.rig.oil_supply import gear_oil
from tests.builders.warm_prototype import base

pytestmark = pytest.mark.whole_run

POINT = OperatingPoint(stage="x", speed=1.0, torque=1.0)
TOLERANCE = {"temperature": 0.05, "length": 0.5e-6, "torque": 1e-3}
SIZE = {"temperature": 4.0, "length": 300e-6, "torque": 0.5}
"""How far each is from its end at first [K, m, relative]; every iteration halves it."""


def state(open_at: dict[str, float]) -> CouplingState:
    """A coupling state that far from its end."""
    rest: Any = {}
    return CouplingState(
        gear_temperature={"g": 400.0 + open_at["temperature"]}, centre_distance={"m": 0.1 + open_at["length"]},
        bearing_clearance=rest, bearing_heat=rest, wall_heat=rest, oil_outlet=rest, oil_supply={},
        mesh_torque={"m": 100.0 / (1.0 + open_at["torque"])}, axial_expansion=rest,
    )  # fmt: skip


def solved(monkeypatch: pytest.MonkeyPatch, slow: str, most: int = 40) -> loop.PointResult:
    """Solve a point where only one quantity is still on its way."""

    def after(count: int) -> dict[str, float]:
        return {name: SIZE[name] * 0.5**count if name == slow else 0.0 for name in SIZE}

    numerics = SimpleNamespace(
        coupling_passes=most, temperature_tolerance=TOLERANCE["temperature"], growth_tolerance=TOLERANCE["length"],
        torque_tolerance=TOLERANCE["torque"],
    )  # fmt: skip
    steady = SimpleNamespace(warming_time=None)
    case = SimpleNamespace(numerics=numerics, drivetrain=None, ambient=steady)
    rig: Any = SimpleNamespace(case=case, oil_circuits={})
    done: list[int] = []

    def run_iteration(*_: object, **__: object) -> int:
        done.append(len(done) + 1)
        return done[-1]

    monkeypatch.setattr(iteration, "initial_state", lambda *_: state(after(0)))
    monkeypatch.setattr(fixed_point, "run_iteration", run_iteration)
    monkeypatch.setattr(acceleration, "next_state", lambda _, count, __: state(after(count)))
    monkeypatch.setattr(fixed_point, "heat_residual", lambda *_: 0.0)
    monkeypatch.setattr(loop, "demand_loss_maps", lambda *_: None)
    return loop.solve_point(rig, POINT)


@pytest.mark.parametrize(("slow", "count"), [("temperature", 7), ("length", 10), ("torque", 9)])
def test_the_loop_goes_on_until_the_slowest_has_converged(
    slow: str, count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The n-th iteration moves by size / 2^n: 4 K fall below 0.05 K in the 7th, 300 um below 0.5 um in the 10th, half
    of the torque below 1e-3 in the 9th."""
    assert SIZE[slow] * 0.5**count <= TOLERANCE[slow] < SIZE[slow] * 0.5 ** (count - 1)
    assert len(solved(monkeypatch, slow).residuals) == count


@pytest.mark.parametrize("slow", ["temperature", "length", "torque"])
def test_a_loop_that_runs_out_of_iterations_says_so(slow: str, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(NotConvergedError, match="did not converge in 5 iterations"):
        solved(monkeypatch, slow, most=5)


def test_gears_without_a_housing_are_no_colder_than_the_oil_that_leaves_them() -> None:
    """Heat balance of the reference gear oil: it enters at 40 degC and takes its losses, sum P = rho c Q (T - 40)."""
    rig, result = base()
    box = rig.case.gearboxes["reference"]
    oil, inlet = gear_oil(rig, "reference"), box.oil.inlet_temperature
    into_oil = sum(
        placed.into_oil - placed.into_bearing_oil
        for placed in result.last.losses
        if placed.gearbox == "reference"
    )
    capacity = oil.density(inlet) * oil.heat_capacity(inlet) * box.oil.flow * len(box.meshes)
    rise = into_oil / capacity
    assert rise > 5.0
    found = next_state(rig, result.last).gear_temperature
    for gear in box.gears:
        assert inlet + 0.95 * rise < found[f"reference.{gear}"] < inlet + rise + 60.0


@pytest.mark.parametrize(("stream", "follow"), [("gear_oil", True), ("bearing_oil", False)])
def test_gears_without_a_housing_follow_the_oil_of_their_mesh(stream: str, follow: bool) -> None:
    """30 K more in the gear oil reach the gears; what the bearings warm never meets them."""
    rig, result = base()
    hotter = tuple(
        replace(entry, outlet=entry.outlet + 30.0, chamber=entry.chamber + 30.0)
        if entry.name == f"reference.{stream}"
        else entry
        for entry in result.last.streams
    )
    before = next_state(rig, result.last).gear_temperature
    after = next_state(rig, replace(result.last, streams=hotter)).gear_temperature
    for gear in rig.case.gearboxes["reference"].gears:
        rise = after[f"reference.{gear}"] - before[f"reference.{gear}"]
        assert rise > 15.0 if follow else abs(rise) < 5.0
