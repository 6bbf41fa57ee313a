"""Orders from raw recordings against signals whose orders are known in closed form.

The signal is written as x = sum Re(X_k exp(i k phi)) over a known angle phi(t), sampled in time, and the tach
sees the same angle. McFadden (1987): what turns with the gears stays, noise falls with the root of the cycles.
"""

import math
from fractions import Fraction

import numpy as np
import pytest

from rigdesign.measurement.processing.features import gain
from rigdesign.measurement.processing.recorded import signal_orders
from rigdesign.measurement.reading.measurement_set import Tach, Transfer
from rigdesign.measurement.reading.signals import Signal, TachError, pulse_counts, rising_edges, turn_angle

RATE = 20_000.0
CYCLE = 25
LINES = {
    0.0: 12.0 + 0j,
    0.64: 0.3 - 0.2j,
    1.0: 0.5 + 0.4j,
    2.0: -0.1j,
    15.36: 0.05 + 0j,
    16.0: -1.1 + 0.7j,
    32.0: 0.2j,
}
"""A hunting pair 16/25: the wheel turns 0.64 times."""


def angle_of(time: np.ndarray, *, swing: float = 0.0, ramp: float = 0.0) -> np.ndarray:
    """40 turns a second, with a slow swing of the speed and a ramp."""
    return 2 * math.pi * (40.0 * time + 0.5 * ramp * time**2) + swing * np.sin(2 * math.pi * 1.5 * time) + 0.3


def recorded(
    swing: float = 0.0, ramp: float = 0.0, noise: float = 0.0, seconds: float = 4.0
) -> dict[str, Signal]:
    time = np.arange(int(RATE * seconds)) / RATE
    phi = angle_of(time, swing=swing, ramp=ramp)
    values = sum((amplitude * np.exp(1j * k * phi)).real for k, amplitude in LINES.items())
    values = values + noise * np.random.default_rng(3).standard_normal(len(time))
    return {
        "torque": Signal(time, np.asarray(values), "N m"),
        "once": Signal(time, np.tanh(40.0 * np.sin(phi))),
        "pulses": Signal(time, np.cos(30 * phi)),
        "encoder": Signal(time, np.degrees(np.mod(phi, 2 * math.pi)), "deg"),
        "counted": Signal(time, np.degrees(phi), "deg"),
    }


COUNTED = Tach(kind="angle", signal="counted", wraps=False)


@pytest.mark.parametrize(("swing", "ramp"), [(0.0, 0.0), (0.8, 0.0), (0.0, 3.0), (0.5, 1.0)])
def test_orders_come_back_with_size_and_phase(swing: float, ramp: float) -> None:
    signals = recorded(swing, ramp)
    turn = turn_angle(COUNTED, signals, None)
    found = signal_orders(signals["torque"], turn, tuple(LINES), CYCLE)
    assert found.cycles == int(turn.turns / CYCLE) and not found.too_fast and not found.without_phase
    for order, amplitude in LINES.items():
        assert abs(found.values[order] - amplitude) < 2e-3 * 1.3, order


def test_a_line_that_does_not_turn_with_the_gears_averages_out() -> None:
    signals = recorded()
    time = signals["torque"].time
    hum = Signal(time, signals["torque"].values + 2.0 * np.cos(2 * math.pi * 50.3 * time))
    turn = turn_angle(COUNTED, signals, None)
    clean = signal_orders(signals["torque"], turn, (1.0, 16.0), CYCLE).values
    heard = signal_orders(hum, turn, (1.0, 16.0), CYCLE).values
    assert max(abs(heard[k] - clean[k]) for k in clean) < 0.06


def test_noise_falls_with_the_root_of_the_samples() -> None:
    signals = recorded(noise=1.0)
    found = signal_orders(signals["torque"], turn_angle(COUNTED, signals, None), (1.0, 2.0, 16.0), CYCLE)
    samples = found.cycles * CYCLE * RATE / 40.0
    for order in (1.0, 2.0, 16.0):
        assert abs(found.values[order] - LINES[order]) < 4.0 * math.sqrt(2.0 / samples)


def test_without_counted_turns_fractional_orders_have_no_phase() -> None:
    signals = recorded()
    turn = turn_angle(Tach(kind="pulses", signal="once"), signals, None)
    found = signal_orders(signals["torque"], turn, tuple(LINES), CYCLE)
    assert found.without_phase == (0.64, 15.36)
    assert abs(found.values[16.0] - LINES[16.0]) < 0.06


def test_a_start_turn_gives_fractional_orders_their_phase() -> None:
    signals = recorded()
    turn = turn_angle(Tach(kind="pulses", signal="once"), signals, 1.0)
    found = signal_orders(signals["torque"], turn, (0.64,), CYCLE)
    assert abs(found.values[0.64] - LINES[0.64]) < 0.02


def test_several_pulses_a_turn_take_their_zero_from_the_index() -> None:
    signals = recorded()
    tach = Tach(kind="pulses", signal="pulses", pulses_per_turn=30, index="once")
    found = signal_orders(signals["torque"], turn_angle(tach, signals, None), (1.0, 2.0), 1)
    assert abs(found.values[1.0] - LINES[1.0]) < 5e-3
    with pytest.raises(TachError, match="index"):
        turn_angle(Tach(kind="pulses", signal="pulses", pulses_per_turn=30), signals, None)


def test_a_short_recording_gives_whole_orders_only() -> None:
    signals = recorded(seconds=0.4)
    found = signal_orders(signals["torque"], turn_angle(COUNTED, signals, None), tuple(LINES), CYCLE)
    assert found.cycle == 1 and found.without_phase == (0.64, 15.36)


def test_cycles_with_missing_samples_are_left_out() -> None:
    signals = recorded()
    values = signals["torque"].values.copy()
    values[1000:1100] = np.nan
    found = signal_orders(
        Signal(signals["torque"].time, values), turn_angle(COUNTED, signals, None), (16.0,), CYCLE
    )
    assert found.left_out == 1
    assert abs(found.values[16.0] - LINES[16.0]) < 5e-3
    with pytest.raises(ValueError, match="every cycle"):
        signal_orders(
            Signal(signals["torque"].time, np.full_like(values, np.nan)),
            turn_angle(COUNTED, signals, None),
            (1.0,),
            1,
        )


def test_orders_beyond_the_sampling_are_refused() -> None:
    signals = recorded()
    found = signal_orders(signals["torque"], turn_angle(COUNTED, signals, None), (1.0, 240.0), CYCLE)
    assert found.too_fast == (240.0,)


def test_lost_and_surplus_pulses_are_found() -> None:
    true = np.cumsum(np.full(400, 0.01) * (1 + 0.02 * np.sin(np.arange(400) / 20)))
    given = np.sort(np.append(np.delete(true, [50, 51, 200]), true[300] + 0.002))
    counts, kept, lost, surplus = pulse_counts(given)
    assert (lost, surplus) == (3, 1)
    assert counts[-1] == 399
    np.testing.assert_allclose(kept, np.delete(true, [50, 51, 200]))


def test_noise_on_a_slope_is_no_second_edge() -> None:
    time = np.linspace(0, 1, 20_001)
    wave = np.sin(2 * math.pi * 20 * time) + 0.1 * np.random.default_rng(1).standard_normal(len(time))
    edges = rising_edges(Signal(time, wave))
    assert len(edges) in (19, 20)
    np.testing.assert_allclose(np.diff(edges), 0.05, atol=2e-3)


@pytest.mark.parametrize("poles", [1, 2, 3, 4, 8])
def test_butterworth_gain(poles: int) -> None:
    """|H|^2 = 1 / (1 + (f / fc)^(2n)); the phase at the corner is -n pi / 4."""
    low = Transfer(kind="low_pass", frequency="1000 Hz", poles=poles)  # type: ignore[arg-type]
    for ratio in (0.0, 0.3, 1.0, 2.5):
        response = gain(low, 2 * math.pi * 1000.0 * ratio)
        assert abs(response) ** 2 == pytest.approx(1.0 / (1.0 + ratio ** (2 * poles)), rel=1e-12)
    corner = gain(low, 2 * math.pi * 1000.0)
    expected = np.exp(-1j * math.pi * poles / 4)
    assert corner / abs(corner) == pytest.approx(expected, abs=1e-12)
    assert gain(low, 0.0) == pytest.approx(1.0, abs=1e-12)


def test_a_delay_turns_the_phase() -> None:
    late = Transfer(kind="low_pass", frequency="1000 kHz", delay="1 ms")  # type: ignore[arg-type]
    assert np.angle(gain(late, 100.0)) == pytest.approx(-0.1, abs=1e-4)


def test_the_cycle_of_the_test_pair() -> None:
    assert Fraction(16, 25).denominator == CYCLE
