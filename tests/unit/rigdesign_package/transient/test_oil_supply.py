"""An oil circuit and a body in turn, each over all times: the same as both in one set of equations."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from rigdesign.coupling.state import OperatingPoint
from rigdesign.oil_circuit.circuit import Circuit, Heater, Tank
from rigdesign.oil_circuit.state import CircuitState
from rigdesign.properties.oil import FVA_3
from rigdesign.transient.oil_supply import (
    SWEEP_TOLERANCE,
    Secants,
    StreamHeats,
    SupplyHistory,
    WallAnswer,
    circuits_over,
    in_parts,
)
from rigdesign.transient.phases import Knot, Phase
from tests.builders.oil_circuit import ZERO, circuit, line

ROOM = ZERO + 20.0
LIMIT, SETPOINT = 3000.0, ZERO + 60.0
BODY, WALL, LOST = 60e3, 90.0, 12.0
"""Heat capacity of the body [J/K], its film to the oil and its loss to the room [W/K]."""
OIL = replace(FVA_3, density_slope=0.0, heat_capacity_slope=0.0)
TANK = Tank(volume=0.1, fill=0.04, wall_conductance=4.0, body_heat_capacity=10e3)
POINT = OperatingPoint(stage="warm_up", speed=0.0, torque=0.0)
DURATION = 3.0 * 3600.0
TIMES = np.unique(np.concatenate([np.linspace(0.0, 900.0, 181), np.linspace(900.0, DURATION, 331)]))
PROMPT, NONE = WallAnswer(prompt=WALL), WallAnswer(prompt=0.0)
PHASE = Phase(name="warm_up", duration=DURATION, knots=(Knot(time=0.0, point=POINT),))


def plant(limit: float = LIMIT) -> Circuit:
    return circuit(
        line(), oil=OIL, tank=TANK, heater=Heater(power_limit=limit, setpoint=SETPOINT), room_temperature=ROOM
    )


def body(supply: NDArray[np.float64], times: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) temperature of the body that oil of a supply temperature over time warms [K]."""

    def rate(time: float, y: NDArray[np.float64]) -> list[float]:
        fed = float(np.interp(time, times, supply))
        return [(WALL * (fed - y[0]) - LOST * (y[0] - ROOM)) / BODY]

    found = solve_ivp(rate, (0.0, DURATION), [ROOM], t_eval=TIMES, rtol=1e-8, atol=1e-8, max_step=120.0)
    return np.asarray(found.y[0])


def sweeps(
    count: int, answer: WallAnswer, limit: float = LIMIT, *, accelerated: bool = True
) -> list[SupplyHistory]:
    start: Mapping[str, CircuitState] = {"test": CircuitState.uniform(plant(limit), ROOM)}
    times, supply = np.zeros(1), np.full(1, SETPOINT)
    found: list[SupplyHistory] = []
    secants = Secants()
    for _ in range(count):
        heat = WALL * (body(supply, times) - np.interp(TIMES, times, supply))
        given = StreamHeats(
            times=TIMES, phases=(PHASE,), phase=np.zeros(len(TIMES), dtype=np.int32), heats={"gears": heat},
            leaked={}, supplies={"gears": np.interp(TIMES, times, supply)},
        )  # fmt: skip
        found.append(circuits_over(start, given, {"gears": answer}))
        fed = replace(found[-1], times=times, supplies={"gears": supply})
        following = secants.following(fed, found[-1]) if accelerated else found[-1]
        times, supply = following.times, following.supplies["gears"]
    return found


def together(limit: float = LIMIT) -> tuple[NDArray[np.float64], float]:
    """(n,) temperature of the tank with the body in one set of equations [K], and when it is at its setpoint [s]."""
    oil, tank = OIL, TANK
    stored = oil.density(ROOM) * tank.fill * oil.heat_capacity(ROOM) + tank.body_heat_capacity

    def rate(time: float, y: NDArray[np.float64]) -> list[float]:
        drawn = WALL * (y[0] - y[1]) + tank.wall_conductance * (y[0] - ROOM)
        heater = limit if y[0] < SETPOINT else min(limit, drawn)
        return [(heater - drawn) / stored, (WALL * (y[0] - y[1]) - LOST * (y[1] - ROOM)) / BODY]

    found = solve_ivp(rate, (0.0, DURATION), [ROOM, ROOM], t_eval=TIMES, rtol=1e-9, atol=1e-9, max_step=2.0)
    tank_temperature = np.asarray(found.y[0])
    return tank_temperature, float(TIMES[np.argmax(tank_temperature > SETPOINT - 0.05)])


def test_in_turn_they_come_to_where_they_are_together() -> None:
    """3 kW warm tank and body to 60 degC in 26 minutes; a heater without limit would feed 60 degC at once."""
    reference, reached = together()
    last = sweeps(6, PROMPT)[-1]
    assert np.max(np.abs(last.supplies["gears"] - reference)) < 0.1
    assert np.max(last.circuits["test"].heater) <= LIMIT * (1.0 + 1e-9)
    own = float(TIMES[np.argmax(last.supplies["gears"] > SETPOINT - 0.05)])
    assert own == pytest.approx(reached, abs=30.0)
    assert reached > 1000.0


def test_plain_sweeps_come_closer_each_time_and_need_to_know_the_walls() -> None:
    found = sweeps(5, PROMPT, accelerated=False)
    changes = [after.change(before) for before, after in pairwise(found)]
    assert all(later < 0.6 * earlier for earlier, later in pairwise(changes))
    without = sweeps(5, NONE, accelerated=False)
    assert without[-1].change(without[-2]) > 3.0 * changes[-1]


def test_a_heater_too_small_never_comes_to_its_setpoint() -> None:
    """0.5 kW at 4 W/K of the tank and 1/(1/90 + 1/12) = 10.6 W/K of the body end at 20 + 500/14.6 = 54 degC; plain
    sweeps are far off, since body and tank answer each other for hours."""
    reference, _ = together(500.0)
    final = ROOM + 500.0 / (4.0 + 1.0 / (1.0 / WALL + 1.0 / LOST))
    about = WallAnswer(prompt=WALL, lasting=15.0, capacity=0.5 * BODY)
    found = sweeps(5, about, limit=500.0)
    last = found[-1].supplies["gears"]
    assert last[-1] < final < SETPOINT
    assert found[-1].change(found[-2]) < 0.5
    assert np.max(np.abs(last - reference)) < 0.3
    plain = sweeps(5, PROMPT, limit=500.0, accelerated=False)[-1].supplies["gears"]
    assert np.max(np.abs(plain - reference)) > 3.0


def test_walls_that_are_one_body_are_known_at_once() -> None:
    """The second sweep is the answer, where the answer of the walls is exact."""
    exact = WallAnswer(prompt=WALL, lasting=WALL * LOST / (WALL + LOST), capacity=BODY)
    reference, _ = together(500.0)
    last = sweeps(2, exact, limit=500.0)[-1].supplies["gears"]
    assert np.max(np.abs(last - reference)) < 0.3


def test_time_steps_of_housings_that_change_from_sweep_to_sweep_do_not_keep_them_apart() -> None:
    """Supply temperatures are curved over the long steps of a housing: straight lines between the ends of its steps
    would differ by more than the sweeps may, whenever the steps change."""
    given = np.linspace(0.0, 1.0, 13) ** 2 * DURATION, np.linspace(0.0, 1.0, 10) ** 2 * DURATION

    def last_change(cut: Callable[[NDArray[np.float64]], NDArray[np.float64]]) -> float:
        start: Mapping[str, CircuitState] = {"test": CircuitState.uniform(plant(), ROOM)}
        fed = SupplyHistory(
            times=np.zeros(1), supplies={"gears": np.full(1, SETPOINT)}, circuits={}, states=()
        )
        secants, change = Secants(), 0.0
        for sweep in range(8):
            times = cut(given[sweep % 2])
            supply = np.interp(TIMES, fed.times, fed.supplies["gears"])
            warm = np.interp(times, TIMES, body(supply, TIMES))
            heats = StreamHeats(
                times=times, phases=(PHASE,), phase=np.zeros(len(times), dtype=np.int32),
                heats={"gears": WALL * (warm - fed.sampled(times)["gears"])}, leaked={}, supplies=fed.sampled(times),
            )  # fmt: skip
            found = circuits_over(start, heats, {"gears": PROMPT})
            change = found.change(fed)
            fed = secants.following(fed, found)
        return change

    assert last_change(in_parts) < SWEEP_TOLERANCE < last_change(lambda times: times)


def test_the_circuit_keeps_its_heat() -> None:
    curve = sweeps(2, PROMPT)[-1].circuits["test"]
    assert abs(curve.energies.imbalance) < 1e-6 * curve.energies.heater
    each = np.diff(TIMES)
    assert float(np.sum(curve.heater[1:] * each)) == pytest.approx(curve.energies.heater)
