"""What the logger records of a stress over the rolling angle: bridge, slip ring, low-pass, drift, noise, converter."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.units import refuse, require_above, require_at_least
from rigdesign.strain_gauge.low_pass import LowPass
from rigdesign.strain_gauge.measuring_point import MeasuringPoint, StrainRecord
from rigdesign.strain_gauge.turn_average import RollingAngle

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Amplifier:
    """Slip ring, amplifier and converter of one channel.

    Parameters
    ----------
    sample_rate : [Hz]
    low_pass : anti-aliasing filter; None: none
    input_range : largest U_B / U_E either way [V/V]
    bits : of the converter; None: not quantised
    slip_ring_noise : one-sided density before the low-pass [V/V/sqrt(Hz)]
    converter_noise : 1 sigma of a sample, white [V/V]
    offset : zero of the chain at t = 0 [V/V]; drift : its change [V/V/s]
    oversampling : steps to a sample in which the low-pass is followed
    """

    sample_rate: float
    low_pass: LowPass | None = None
    input_range: float = 4e-3
    bits: int | None = None
    slip_ring_noise: float = 0.0
    converter_noise: float = 0.0
    offset: float = 0.0
    drift: float = 0.0
    oversampling: int = 8

    def __post_init__(self) -> None:
        require_above("sample_rate", self.sample_rate, "Hz", "write that of the logger")
        require_above("input_range", self.input_range, "V/V", "write that of the amplifier, e.g. 4e-3")
        for key in ("slip_ring_noise", "converter_noise"):
            require_at_least(key, getattr(self, key), "", "write 0 for none")
        if self.bits is not None and not 4 <= self.bits <= 32:
            refuse("bits", str(self.bits), "must lie within 4 to 32", "write that of the converter")
        if self.oversampling < 1:
            refuse("oversampling", str(self.oversampling), "must be at least 1", "8 follows a low-pass well")

    @property
    def step(self) -> float:
        """Of the converter [V/V]; 0 where not quantised."""
        return 0.0 if self.bits is None else 2.0 * self.input_range / 2**self.bits

    def record(self, output: Callable[[Array], Array], duration: float, seed: int = 0) -> StrainRecord:
        """Record a bridge output.

        Parameters
        ----------
        output : U_B / U_E [V/V] at (n,) points in time [s]; the chain has settled on its value at t = 0
        duration : [s]
        seed : of the noise
        """
        require_above("duration", duration, "s", "write how long is recorded")
        count = int(np.floor(duration * self.sample_rate)) + 1
        factor = self.oversampling if self.low_pass is not None or self.slip_ring_noise else 1
        step = 1.0 / (factor * self.sample_rate)
        fine = np.arange(factor * (count - 1) + 1, dtype=float) * step
        values: Array = np.asarray(output(fine), dtype=float)
        random = np.random.default_rng(seed)
        if self.slip_ring_noise:
            values = values + self.slip_ring_noise * np.sqrt(0.5 / step) * random.standard_normal(len(fine))
        if self.low_pass is not None:
            values = self.low_pass.passed(values, step)
        time, values = fine[::factor], values[::factor] + self.offset + self.drift * fine[::factor]
        if self.converter_noise:
            values = values + self.converter_noise * random.standard_normal(count)
        overloaded = np.abs(values) >= self.input_range
        if self.step:
            values = np.asarray(self.step * np.rint(values / self.step), dtype=float)
        clipped: Array = np.clip(values, -self.input_range, self.input_range)
        return StrainRecord(time, clipped, int(np.count_nonzero(overloaded)))


@dataclass(frozen=True, kw_only=True)
class RootStressHistory:
    """Root stress at a gauge over time.

    stress : along the fillet, mean over the grid [Pa], at (n,) rolling angles [rad], any number of turns
    angle : rolling angle over time, constant or varying speed
    temperature : of gauge and root [K] at (n,) points in time [s]; None: without thermal output
    """

    stress: Callable[[Array], Array]
    angle: RollingAngle
    temperature: Callable[[Array], Array] | None = None


def logged(
    point: MeasuringPoint, history: RootStressHistory, amplifier: Amplifier, duration: float, seed: int = 0
) -> StrainRecord:
    """What the logger records at a measuring point over ``duration`` [s]; ``seed`` of the noise."""

    def output(time: Array) -> Array:
        heat = None if history.temperature is None else history.temperature(time)
        return point.ratio(history.stress(history.angle(time)), heat)

    return amplifier.record(output, duration, seed)
