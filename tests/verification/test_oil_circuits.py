"""Oil circuits over time against closed forms and against an integration written by hand.

The example is a warm-up that needs 6.7 kW at its setpoint and has a heater of 3 kW.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from rigdesign.oil_circuit.circuit import Circuit, Cooler, Heater, Pipe, Pump
from rigdesign.oil_circuit.line_balance import consumer_return
from rigdesign.oil_circuit.state import CircuitState
from rigdesign.properties.oil import FVA_3
from tests.builders.circuit_history import circuit_history
from tests.builders.oil_circuit import LITRE_A_MINUTE, TANK, WATER, ZERO, circuit, line

ROOM = 293.15
SETPOINT = ZERO + 90.0
HOUSING = 6700.0 / 70.0 - TANK.wall_conductance
"""Conductance of the cold housing [W/K]: with the walls of the tank 6.7 kW at 90 degC."""
CAPACITY = FVA_3.density(ROOM) * TANK.fill * 2000.0
LOSS = HOUSING + TANK.wall_conductance
TIME_CONSTANT = CAPACITY / LOSS


def warm_up(power: float) -> Circuit:
    return circuit(line(setpoint=SETPOINT), oil=FVA_3, heater=Heater(power_limit=power, setpoint=SETPOINT))


def housing_cold(supply: float) -> float:
    return -HOUSING * (supply - ROOM)


@pytest.mark.parametrize("start", [ROOM, SETPOINT], ids=["from cold", "from the setpoint"])
def test_heater_at_its_limit_follows_the_exponential(start: float) -> None:
    """T = T_end + (T_start - T_end) exp(-t / tau), T_end = 51.3 degC: from 90 degC the supply falls to it."""
    times = np.linspace(0.0, 4.0 * TIME_CONSTANT, 161)
    history = circuit_history(CircuitState.uniform(warm_up(3e3), start), times, {"gears": housing_cold})
    end = ROOM + 3e3 / LOSS
    exact = end + (start - end) * np.exp(-times / TIME_CONSTANT)
    assert end - ZERO == pytest.approx(51.34, abs=5e-3)
    np.testing.assert_allclose(history.tank, exact, atol=2e-3)
    np.testing.assert_allclose(history.supplies["gears"], exact, atol=2e-3)
    np.testing.assert_allclose(history.heater, 3e3, rtol=1e-12)
    assert history.held_from(warm_up(3e3).lines[0]) is None
    (text,) = history.warnings
    assert "with 3 of 3 kW of the heaters: not held at 90 degC within 1 K" in text
    energies = history.energies
    assert abs(energies.imbalance) < 1e-9 * energies.heater
    assert energies.stored == pytest.approx(CAPACITY * (history.tank[-1] - start), rel=1e-9)


def test_heater_that_is_large_enough_holds_with_6_7_kw() -> None:
    times = np.linspace(0.0, 3600.0, 61)
    history = circuit_history(CircuitState.uniform(warm_up(8e3), SETPOINT), times, {"gears": housing_cold})
    np.testing.assert_allclose(history.tank, SETPOINT, atol=1e-9)
    np.testing.assert_allclose(history.heater, 6700.0, rtol=1e-9)
    assert history.time_below("gears", SETPOINT - 1.0) == 0.0
    assert history.held_from(warm_up(8e3).lines[0]) == 0.0
    assert history.warnings == ()


def test_time_to_the_setpoint_is_that_of_the_exponential() -> None:
    """With 8 kW the setpoint is reached after tau ln(1 / (1 - 6.7/8)), and held from then on."""
    history = circuit_history(
        CircuitState.uniform(warm_up(8e3), ROOM),
        np.linspace(0.0, 6.0 * TIME_CONSTANT, 1201),
        {"gears": housing_cold},
    )
    reached = TIME_CONSTANT * math.log(1.0 / (1.0 - 6.7 / 8.0))
    assert history.time_below("gears", SETPOINT - 1e-6) == pytest.approx(reached, rel=5e-3)
    assert history.tank.max() <= SETPOINT + 1e-9
    within = TIME_CONSTANT * math.log(1.0 / (1.0 - 6.7 / 8.0 * 69.0 / 70.0))
    assert history.held_from(warm_up(8e3).lines[0]) == pytest.approx(
        within, abs=6.0 * TIME_CONSTANT / 1200 + 1.0
    )


def test_second_order_in_time() -> None:
    errors = []
    for steps in (10, 20, 40, 80):
        times = np.linspace(0.0, TIME_CONSTANT, steps + 1)
        history = circuit_history(CircuitState.uniform(warm_up(3e3), ROOM), times, {"gears": housing_cold})
        errors.append(abs(history.tank[-1] - ROOM - 3e3 / LOSS * (1.0 - math.exp(-1.0))))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(orders, 2.0, atol=0.1)


def test_coupled_to_a_housing_by_return_temperatures() -> None:
    """Tank and housing as two masses against the matrix exponential; the lag of one step is of first order."""
    mass, conductance = 4e5, 300.0
    state_matrix = np.array(
        [
            [-(LOSS - HOUSING + conductance) / CAPACITY, conductance / CAPACITY],
            [conductance / mass, -conductance / mass],
        ]
    )
    drive = np.array([3e3 / CAPACITY, 0.0])
    duration = 7200.0
    augmented = np.zeros((3, 3))
    augmented[:2, :2], augmented[:2, 2] = state_matrix, drive
    exact = ROOM + (expm(augmented * duration) @ np.array([0.0, 0.0, 1.0]))[:2]
    errors = []
    for steps in (60, 120, 240):
        state, housing = CircuitState.uniform(warm_up(3e3), ROOM), ROOM
        length = duration / steps
        for _ in range(steps):
            fed = state.supplies["gears"]
            heat = conductance * (housing - fed.temperature)
            back = consumer_return(FVA_3, fed.temperature, fed.mass_flow, heat)
            state = state.step(length, {"gears": back}).state
            housing -= length * heat / mass
        errors.append(max(abs(state.tank_temperature - exact[0]), abs(housing - exact[1])))
        kept = CAPACITY * (state.tank_temperature - ROOM) + mass * (housing - ROOM)
        assert kept < 3e3 * duration
    np.testing.assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 1.0, atol=0.15)
    assert errors[-1] < 0.15


def test_cooler_line_and_pipes_against_an_integration_by_hand() -> None:
    """Pump, counterflow cooler with bypass, two pipes: right-hand side written here, Runge-Kutta 8(5,3)."""
    volume, conductance, heat, setpoint = 4e-3, 5.0, 6e3, ZERO + 45.0
    cooler = Cooler(conductance=150.0, coolant=WATER)
    pipe = Pipe(volume=volume, wall_conductance=conductance)
    pump = Pump(flow=20 * LITRE_A_MINUTE, pressure=1e6, efficiency=0.75)
    given = circuit(
        line(setpoint=setpoint, cooler=cooler, supply_pipe=pipe, return_pipe=pipe), oil=FVA_3, pump=pump
    )
    pumped, density = 20e-3 / 60 * 1e6 / 0.75, FVA_3.density(ROOM)
    pipe_mass, tank_mass = density * volume, density * (TANK.fill - 2 * volume)

    def slopes(_: float, temperatures: np.ndarray) -> list[float]:
        tank, supply, back = temperatures
        rate = FVA_3.density(supply) * 15e-3 / 60 * 2000.0
        inlet = tank + 0.75 * pumped / rate
        least, most = sorted((rate, WATER.capacity_rate))
        ratio, units = least / most, 150.0 / least
        grown = math.exp(-units * (1.0 - ratio))
        most_heat = (1.0 - grown) / (1.0 - ratio * grown) * least * (inlet - WATER.inlet_temperature)
        cooled = inlet - min(max(rate * (inlet - setpoint), 0.0), most_heat) / rate
        wall = rate * math.expm1(conductance / rate)
        return [
            (rate * (back - tank) + 0.25 * pumped - 10.0 * (tank - ROOM)) / (tank_mass * 2000.0),
            (rate * (cooled - supply) - wall * (supply - ROOM)) / (pipe_mass * 2000.0),
            (rate * (supply + heat / rate - back) - wall * (back - ROOM)) / (pipe_mass * 2000.0),
        ]

    times = np.linspace(0.0, 3600.0, 721)
    found = circuit_history(CircuitState.uniform(given, ROOM), times, {"gears": heat})
    by_hand = solve_ivp(
        slopes, (0.0, 3600.0), [ROOM] * 3, "DOP853", t_eval=times, rtol=1e-9, atol=1e-9, max_step=5.0
    )
    assert found.tank[-1] > ZERO + 55.0
    assert found.cooler[0] == 0.0
    assert found.cooler[-1] > 0.0
    np.testing.assert_allclose(found.tank, by_hand.y[0], atol=0.02)
    np.testing.assert_allclose(found.supplies["gears"], by_hand.y[1], atol=0.05)
