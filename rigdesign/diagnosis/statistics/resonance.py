"""How orders follow the speed, or a natural frequency, where they are read near one.

What excites an order passes through the circuit, H ~ 1 / (1 - f/f_i + i zeta) near the natural frequency f_i; a
relative change of the speed, or of f_i, changes it by 1 / |1 - f/f_i + i zeta| times as much. Where the model has its
natural frequencies is known to a per cent or so, hence the root mean square over that error (a Voigt profile).

Angles follow more: nothing but its inertia holds a loop that turns as a whole, by 1e-4 of the torque in the meshes, and
that part of the torque comes from the sidebands of the meshes and follows their resonances.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import wofz

from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.prediction.model import Feature, OperatingCondition

FREQUENCY_ERROR = 0.017
"""Relative standard error of a natural frequency over which the mean square is taken: that of the fitted amplitudes,
constant so that the change is in proportion to them."""
DAMPING_RATIO = 0.005
"""Of the modes of a power circuit."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Resonances:
    """Natural frequencies that orders of one set lie near.

    features, settings : numbers and their points; modes : natural frequencies [rad/s]
    of_angle : (n,) whether a number is of an angle, which sees the loop turn as a whole
    teeth : of the reference gear
    """

    features: Sequence[Feature]
    settings: Sequence[OperatingCondition]
    modes: Array
    of_angle: NDArray[np.bool_]
    teeth: int

    @property
    def steepness(self) -> Array:
        """(n,) relative change of an order by the logarithm of its frequency; zero for means and all other numbers."""
        return self._factor_at(self._orders)

    def change(self, amplitude: Array) -> Array:
        """(n,) change of orders of an amplitude by the logarithm of the speed.

        Of an angle at a shaft order, what exceeds the least amplitude over the points is the loop as a whole, which
        follows the sidebands of the mesh of the reference gear: what winds up the shafts is there at any speed.
        """
        return self._with_sidebands(amplitude)

    def shift(self, amplitude: Array) -> Array:
        """(n,) the same by the logarithm of the natural frequencies, which orders far below them hardly notice."""
        return self._with_sidebands(amplitude, power=2)

    def _with_sidebands(self, amplitude: Array, power: int = 0) -> Array:
        orders = self._orders
        whole = self.of_angle & (orders > 0.0) & (orders < 0.5 * self.teeth)
        beside = np.maximum(
            self._factor_at(self.teeth - orders, power), self._factor_at(self.teeth + orders, power)
        )
        common = np.where(whole, amplitude - self._windup(amplitude), 0.0)
        return np.asarray(np.hypot(self._factor_at(orders, power) * amplitude, beside * common))

    @property
    def _orders(self) -> Array:
        return np.array([feature.order for feature in self.features], dtype=np.float64)

    def _windup(self, amplitude: Array) -> Array:
        """(n,) least amplitude over the points of each channel and order; zero where it was read at one point alone."""
        read: dict[tuple[str, float], dict[str, float]] = {}
        for feature, value in zip(self.features, amplitude.tolist(), strict=True):
            if value > 0.0:
                read.setdefault((feature.channel, feature.order), {})[feature.setting] = value
        least = {series: min(values.values()) for series, values in read.items() if len(values) > 1}
        return np.array([least.get((feature.channel, feature.order), 0.0) for feature in self.features])

    def _factor_at(self, orders: Array, power: int = 0) -> Array:
        """(n,) relative change of these orders at the points of the numbers, times a power of their frequency over the
        natural frequency nearest to it; zero where no order is read."""
        ratio = self._nearest(orders)
        profile = wofz((np.abs(1.0 - ratio) + 1j * DAMPING_RATIO) / (FREQUENCY_ERROR * np.sqrt(2.0))).real
        square = np.sqrt(0.5 * np.pi) / (FREQUENCY_ERROR * DAMPING_RATIO) * profile
        return np.where(ratio > 0.0, ratio**power * np.sqrt(square), 0.0)

    def _nearest(self, orders: Array) -> Array:
        """(n,) frequency over the natural frequency nearest to it; zero where no order is read."""
        speeds = {setting.name: setting.speed for setting in self.settings}
        read = np.array(
            [speeds.get(feature.setting, 0.0) if feature.order else 0.0 for feature in self.features]
        )
        if not self.modes.size:
            return np.zeros(len(read))
        ratios = (orders * read)[:, None] / self.modes
        return np.asarray(ratios[np.arange(len(read)), np.abs(1.0 - ratios).argmin(axis=1)])


# How natural frequencies that lie close together divide a change between them.
#
# The modes of a model are mixed a little differently from those of the rig: two of them are turned into each other by
# an angle t with tan 2t = 2 d / g, where g is the relative distance of their frequencies and d how far the model has
# each of them off. Changes a of the eigenvalues by one local stiffness or inertia then become
#
#     a1 + e, a2 - e  with  e = sin 2t (a1 a2)^(1/2) + sin^2 t (a2 - a1)
#
# since the change is of rank one; their sum stays (first-order perturbation of a pair of modes).


@dataclass(frozen=True, kw_only=True)
class CloseModes:
    """Pairs of natural frequencies among n numbers.

    first, second : (m,) places of the two; frequencies : (n,) of the model, zero for other numbers
    mixed, turned : (m,) sine of twice the angle t, and squared sine of t
    """

    first: NDArray[np.intp]
    second: NDArray[np.intp]
    frequencies: Array
    mixed: Array
    turned: Array

    @classmethod
    def of(cls, frequencies: Array, off: float) -> "CloseModes":
        """All pairs of natural frequencies (n,), zero for other numbers, of which the model has each off by a share.

        Two readings of one mode, whose frequency the model has once, are no pair.
        """
        places = np.flatnonzero(frequencies)
        former, latter = np.triu_indices(len(places), 1)
        apart = frequencies[places[former]] != frequencies[places[latter]]
        first, second = places[former[apart]], places[latter[apart]]
        distance = np.abs(np.log(frequencies[first] / frequencies[second]))
        twice_the_angle = np.arctan2(2.0 * off, distance)
        return cls(
            first=first,
            second=second,
            frequencies=frequencies,
            mixed=np.sin(twice_the_angle),
            turned=np.sin(0.5 * twice_the_angle) ** 2,
        )

    def errors(self, answer: Array) -> tuple[Array, Array]:
        """What an answer (n,) may have at the first of each pair (m,) in place of the second (m,), in its own units."""
        frequency, beside = (self.frequencies[place] for place in (self.first, self.second))
        share, another = answer[self.first] / frequency, answer[self.second] / beside
        moved = self.mixed * np.sqrt(np.abs(share * another)) + self.turned * np.abs(share - another)
        return frequency * moved, -beside * moved
