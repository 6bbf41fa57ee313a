"""Oil circuits over time: heat is kept, limits hold, thermostats switch, the steady balance is where it ends."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rigdesign.base.errors import CaseError, NotConvergedError
from rigdesign.oil_circuit.circuit import Heater, Pipe, Pump, TankCooler, enthalpy
from rigdesign.oil_circuit.line_balance import consumer_return
from rigdesign.oil_circuit.state import CircuitState, Energies
from rigdesign.oil_circuit.steady import steady_circuit
from tests.builders.circuit_history import CircuitHistory, circuit_history
from tests.builders.oil_circuit import LITRE_A_MINUTE, ZERO, circuit, cooler, line

PIPE = Pipe(volume=3e-3, wall_conductance=4.0)
PUMP = Pump(flow=35 * LITRE_A_MINUTE, pressure=1e6, efficiency=0.8)
FULL = circuit(
    line("warm", setpoint=ZERO + 80.0, supply_pipe=PIPE, return_pipe=PIPE, trim_power_limit=1e3),
    line("cold", setpoint=ZERO + 40.0, cooler=cooler(), return_pipe=PIPE),
    pump=PUMP,
    heater=Heater(power_limit=4e3, setpoint=ZERO + 75.0),
    tank_cooler=TankCooler(cooler=cooler(), setpoint=ZERO + 82.0),
)
HEATS = {"warm": 800.0, "cold": 600.0}


def largest(energies: Energies) -> float:
    return max(abs(value) for value in vars(energies).values())


@settings(max_examples=20, deadline=None)
@given(
    start=st.floats(ZERO - 5.0, ZERO + 95.0),
    duration=st.floats(0.1, 2e4),
    heats=st.tuples(st.floats(-1e3, 2e4), st.floats(-1e3, 2e4)),
    running=st.booleans(),
)
def test_heat_is_kept_in_every_step(
    start: float, duration: float, heats: tuple[float, float], running: bool
) -> None:
    state = CircuitState.uniform(FULL, start)
    given_heats = dict(zip(("warm", "cold"), heats if running else (0.0, 0.0)))
    step = state.step_with_heats(duration, given_heats, running=running)
    assert abs(step.energies.imbalance) <= 1e-9 * max(largest(step.energies), 1.0)
    change = step.state.contents.total - state.contents.total
    assert change == pytest.approx(step.energies.stored, abs=1e-9 * max(abs(state.contents.total), 1e3))
    assert 0.0 <= step.energies.heater <= 4e3 * duration * (1.0 + 1e-12)


def test_the_end_is_the_steady_balance() -> None:
    steady = steady_circuit(FULL, HEATS)
    history = circuit_history(CircuitState.uniform(FULL, 293.15), np.linspace(0.0, 8e4, 200), HEATS)
    assert history.tank[-1] == pytest.approx(steady.tank_temperature, abs=1e-6)
    assert history.heater[-1] == pytest.approx(steady.heater_power, rel=1e-6)
    assert history.cooler[-1] == pytest.approx(steady.cooler_heat, rel=1e-6)
    for name, supplies in history.supplies.items():
        assert supplies[-1] == pytest.approx(steady.consumers[name].supply, abs=1e-6)


@pytest.mark.parametrize("duration", [1.0, 600.0, 1e5])
def test_a_steady_circuit_stays(duration: float) -> None:
    found = steady_circuit(FULL, HEATS)
    step = CircuitState.steady(found).step_with_heats(duration, HEATS)
    assert step.state.tank_temperature == pytest.approx(found.tank_temperature, abs=1e-7)
    assert step.supplies["warm"] == pytest.approx(found.lines["warm"].supply, abs=1e-7)
    assert step.energies.heater == pytest.approx(
        found.heater_power * duration - step.energies.trim_heaters, abs=1e-3 * duration
    )


def test_a_step_leaves_its_state_as_it_was() -> None:
    state = CircuitState.uniform(FULL, 293.15)
    first, second = (state.step_with_heats(60.0, HEATS) for _ in range(2))
    assert state.tank_temperature == pytest.approx(293.15)
    assert first == second


def test_return_temperatures_are_heat_against_the_supplies_of_the_state() -> None:
    state = CircuitState.uniform(FULL, ZERO + 50.0).step_with_heats(60.0, HEATS).state
    oil = FULL.oil
    returns = {
        name: consumer_return(oil, fed.temperature, fed.mass_flow, HEATS[name])
        for name, fed in state.supplies.items()
    }
    driven, known = state.step(60.0, returns), state.step_with_heats(60.0, HEATS)
    assert driven.state.tank_temperature == pytest.approx(known.state.tank_temperature, abs=1e-9)
    assert driven.energies.consumers == pytest.approx(60.0 * sum(HEATS.values()), rel=1e-9)
    fed = state.supplies["warm"]
    taken = fed.mass_flow * (enthalpy(oil, returns["warm"]) - enthalpy(oil, fed.temperature))
    assert taken == pytest.approx(800.0)


def test_long_steps_stay_within_the_limits() -> None:
    step = CircuitState.uniform(FULL, 293.15).step_with_heats(1e7, HEATS)
    assert step.state.tank_temperature == pytest.approx(steady_circuit(FULL, HEATS).tank_temperature, abs=0.5)


def test_with_the_pump_at_rest_pipes_cool_and_the_tank_keeps_warm() -> None:
    state = CircuitState.steady(steady_circuit(FULL, HEATS))
    step = state.step(4 * 3600.0, {}, running=False)
    assert step.energies.pump == step.energies.consumers == step.energies.line_coolers == 0.0
    assert step.state.tank_temperature == pytest.approx(ZERO + 75.0)
    assert step.supplies["warm"] < ZERO + 30.0
    assert abs(step.energies.imbalance) < 1e-9 * largest(step.energies)
    again = step.state.step_with_heats(60.0, HEATS)
    assert again.energies.pump == pytest.approx(60.0 * PUMP.heat_into_oil)


def test_a_tank_cooler_in_the_return_rests_with_the_pump_and_one_with_its_own_does_not() -> None:
    for flow, works in ((None, False), (2e-4, True)):
        given_circuit = circuit(tank_cooler=TankCooler(cooler=cooler(), setpoint=ZERO + 40.0, flow=flow))
        step = CircuitState.uniform(given_circuit, ZERO + 80.0).step(60.0, {}, running=False)
        assert (step.energies.tank_cooler > 0.0) is works


def on_off(power: float = 6e3, band: float = 4.0) -> CircuitState:
    return CircuitState.uniform(
        circuit(heater=Heater(power_limit=power, setpoint=ZERO + 60.0, band=band)), 293.15
    )


def test_on_off_heater_keeps_within_its_band() -> None:
    history = circuit_history(on_off(), np.arange(0.0, 9e3, 30.0), {"gears": -1e3})
    kept = history.tank[100:] - ZERO
    assert kept.min() >= 58.0 - 1e-5
    assert kept.max() <= 62.0 + 1e-5
    assert kept.max() - kept.min() > 3.8
    assert abs(history.energies.imbalance) < 1e-9 * largest(history.energies)
    assert history.heater.max() <= 6e3 * (1 + 1e-9)


def test_on_off_heater_switches_at_the_same_times_whatever_the_step() -> None:
    """Steps of half an hour against steps of a minute; what is left is the error of the method between switchings."""
    ends = [
        circuit_history(on_off(), np.arange(0.0, 7201.0, length), {"gears": -1e3})
        for length in (60.0, 1800.0)
    ]
    assert ends[1].energies.heater == pytest.approx(ends[0].energies.heater, rel=2e-3)
    whole = on_off().step_with_heats(7200.0, {"gears": -1e3})
    assert whole.switchings >= 5


def test_on_off_heater_gives_the_mean_of_the_steady_balance() -> None:
    state = on_off(band=1.0)
    warm = replace(state, contents=CircuitState.uniform(state.circuit, ZERO + 60.0).contents)
    history = circuit_history(warm, np.linspace(0.0, 1.5e4, 100), {"gears": -1e3})
    steady = steady_circuit(state.circuit, {"gears": -1e3})
    assert np.mean(history.heater) == pytest.approx(steady.heater_power, rel=2e-2)


def test_heater_and_tank_cooler_switch_in_turn() -> None:
    both = circuit(
        heater=Heater(power_limit=6e3, setpoint=ZERO + 50.0, band=6.0),
        tank_cooler=TankCooler(cooler=cooler(), setpoint=ZERO + 60.0, band=6.0),
    )
    times = np.arange(0.0, 6001.0, 200.0)
    cold, warm = (
        circuit_history(CircuitState.uniform(both, ZERO + 40.0), times, {"gears": heat})
        for heat in (-1e3, 3e3)
    )
    assert cold.cooler.max() == 0.0
    assert 47.0 - 1e-5 <= cold.tank[-1] - ZERO <= 53.0 + 1e-5
    assert warm.heater[0] == pytest.approx(6e3)
    assert warm.heater[-1] == 0.0
    assert warm.cooler[-10:].max() > 0.0
    assert 57.0 - 1e-5 <= warm.tank[-1] - ZERO <= 63.0 + 1e-5


def test_a_thermostat_that_never_rests_is_an_error() -> None:
    with pytest.raises(NotConvergedError, match=r"widen heater\.band"):
        on_off(power=50e3, band=1e-2).step_with_heats(1e4, {"gears": -1e3})


@pytest.mark.parametrize(
    ("duration", "returns", "words"),
    [(0.0, {"gears": 300.0}, "step.duration = 0 s"), (1.0, {}, "gears: has no value")],
)
def test_refuses_steps_that_cannot_be(duration: float, returns: dict[str, float], words: str) -> None:
    with pytest.raises(CaseError, match=words):
        CircuitState.uniform(circuit(), 293.15).step(duration, returns)


def test_times_must_rise() -> None:
    with pytest.raises(CaseError, match="each above the one before"):
        circuit_history(on_off(), [0.0, 5.0, 5.0], {"gears": 0.0})


def test_time_below_a_temperature_is_straight_between_the_times() -> None:
    state = on_off()
    history = CircuitHistory(
        times=np.array([0.0, 10.0, 20.0, 30.0, 40.0]),
        tank=np.zeros(5),
        supplies={"gears": np.array([300.0, 310.0, 320.0, 320.0, 300.0])},
        heater=np.zeros(4),
        cooler=np.zeros(4),
        energies=Energies(),
        last=state,
    )
    assert history.time_below("gears", 315.0) == pytest.approx(10.0 + 5.0 + 0.0 + 7.5)
    assert history.time_below("gears", 330.0) == pytest.approx(40.0)
    assert history.time_below("gears", 300.0) == 0.0
