"""Low-pass that keeps torques of internal steps at a lower rate."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


FLAT = 0.4
"""Share of the new rate up to which a low-pass keeps what it gets."""


class LowPass:
    """Linear-phase low-pass before decimation by ``factor``: flat to `FLAT`, below -60 dB from 0.6 of the new rate on.

    Source: Kaiser window design, Oppenheim and Schafer, Discrete-Time Signal Processing, section 7.5.
    """

    def __init__(self, channels: int, factor: int) -> None:
        half = 18 * factor
        at = np.arange(-half, half + 1)
        self._factor = factor
        self._taps = np.sinc(at / factor) * np.kaiser(2 * half + 1, 5.65)
        self._taps /= self._taps.sum()
        self._half = half
        self._held = np.empty((channels, 0))
        self._started = False

    def decimate(self, values: Array) -> Array:
        """Return the samples that are known after ``values`` (channels, steps); they lag by the filter length."""
        if not self._started:
            # as if the first value had always been there; samples sit at the last step of each group
            ahead = self._half - self._factor + 1
            self._held = np.repeat(values[:, :1], ahead, axis=1)
            self._started = True
        self._held = np.hstack((self._held, values))
        n_taps = len(self._taps)
        if self._held.shape[1] < n_taps:
            return np.empty((len(values), 0))
        count = max(0, (self._held.shape[1] - n_taps) // self._factor + 1)
        windows = np.lib.stride_tricks.sliding_window_view(self._held, n_taps, axis=1)[:, :: self._factor]
        result: Array = windows[:, :count] @ self._taps
        self._held = self._held[:, count * self._factor :].copy()
        return result

    def finish(self) -> Array:
        """Return the samples that were still held back, the last value going on."""
        return self.decimate(np.repeat(self._held[:, -1:], self._half, axis=1))
