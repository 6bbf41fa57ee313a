"""The analogue low-pass of slip ring, amplifier and logger: gain, delay, and its answer in time."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.units import refuse, require_above

Array = NDArray[np.float64]
LowPassKind = Literal["butterworth", "bessel"]
HIGHEST_ORDER = 8


@dataclass(frozen=True)
class LowPass:
    """Low-pass of unit gain at rest.

    Parameters
    ----------
    kind : butterworth: flat gain; bessel: flat delay, which keeps the form of a pulse
    order : number of poles, 1 to 8
    cut_off : frequency at which the gain has fallen to 1/sqrt(2) (-3 dB) [Hz]

    Sources: Butterworth (1930), Wireless Engineer 7, 536; Thomson (1949), Proc. IEE 96, 487.
    """

    kind: LowPassKind
    order: int
    cut_off: float

    def __post_init__(self) -> None:
        if self.kind not in ("butterworth", "bessel"):
            refuse("low_pass.kind", str(self.kind), "no such low-pass", "write butterworth or bessel")
        if not 1 <= self.order <= HIGHEST_ORDER:
            refuse(
                "low_pass.order",
                str(self.order),
                f"must lie within 1 to {HIGHEST_ORDER}",
                "see the data sheet",
            )
        require_above("low_pass.cut_off", self.cut_off, "Hz", "write the -3 dB frequency of the data sheet")

    @property
    def poles(self) -> NDArray[np.complex128]:
        """(order,) poles of the transfer function [rad/s], all distinct and with negative real part."""
        corner = 2.0 * np.pi * self.cut_off
        if self.kind == "bessel":
            from scipy.signal import besselap

            return np.asarray(corner * besselap(self.order, norm="mag")[1], dtype=complex)
        k = np.arange(1, self.order + 1)
        return np.asarray(corner * np.exp(1j * np.pi * (2 * k + self.order - 1) / (2 * self.order)))

    def gain(self, frequency: float | Array) -> NDArray[np.complex128]:
        """(n,) complex gain at frequencies [Hz], for signals as Re(X exp(i omega t))."""
        s = 2j * np.pi * np.asarray(frequency, dtype=float)
        factors = 1.0 - s[..., np.newaxis] / self.poles
        return np.asarray(1.0 / np.prod(factors, axis=-1))

    def group_delay(self, frequency: float | Array = 0.0) -> Array:
        """(n,) -d(phase)/d(omega) at frequencies [Hz], [s]; at rest the delay of slow signals."""
        omega = 2.0 * np.pi * np.asarray(frequency, dtype=float)[..., np.newaxis]
        poles = self.poles
        return np.asarray(np.sum(-poles.real / ((omega - poles.imag) ** 2 + poles.real**2), axis=-1))

    @property
    def delay(self) -> float:
        """Group delay at rest [s], by which samples are moved back."""
        return float(self.group_delay(0.0))

    def passed(self, values: Array, step: float) -> Array:
        """Answer to a signal that runs straight from sample to sample and stood at its first value before.

        Exact for such a signal: partial fractions, each integrated over every step.

        Parameters
        ----------
        values : (n,) samples
        step : time from sample to sample [s]

        Returns
        -------
        (n,) output at the samples
        """
        from scipy.signal import lfilter

        poles = self.poles
        output = np.zeros(len(values))
        for index, pole in enumerate(poles):
            others = np.delete(poles, index)
            residue = -pole / np.prod(1.0 - pole / others)
            # x' = p x + u: x1 = E x0 + step ((f1 - f2) u0 + f2 u1) for u straight over a step
            x = pole * step
            first = np.expm1(x) / x
            second = (np.expm1(x) - x) / x**2 if abs(x) > 1e-3 else 0.5 + x / 6.0 + x**2 / 24.0
            numerator = step * np.array([second, first - second])
            state = -values[0] / pole
            start = [state - numerator[0] * values[0]]
            part, _ = lfilter(numerator, [1.0, -np.exp(x)], values.astype(complex), zi=start)
            output += (residue * part).real
        return output
