"""The same answer some teeth later: complex orders turned by the angle that has passed."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi

import numpy as np
from numpy.typing import NDArray

from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.prediction.model import Feature


@dataclass(frozen=True)
class Turning:
    """Where the complex orders stand among features.

    real, imaginary : (p,) places of their parts; orders : (p,)
    """

    real: NDArray[np.intp]
    imaginary: NDArray[np.intp]
    orders: Array

    @classmethod
    def of(cls, features: Sequence[Feature]) -> "Turning":
        """Of features; means, quantities without orders and parts that stand alone do not turn."""
        place = {feature: row for row, feature in enumerate(features) if feature.part == "imaginary"}
        found = [
            (row, place.get(replace(feature, part="imaginary")), feature.order)
            for row, feature in enumerate(features)
            if feature.part == "real"
        ]
        pairs = [(real, imaginary, order) for real, imaginary, order in found if imaginary is not None]
        return cls(
            real=np.array([pair[0] for pair in pairs], dtype=np.intp),
            imaginary=np.array([pair[1] for pair in pairs], dtype=np.intp),
            orders=np.array([pair[2] for pair in pairs], dtype=np.float64),
        )

    def turned(self, answers: Array, teeth: int, teeth_a_turn: int) -> Array:
        """(m, n) answers of a cause that sits ``teeth`` teeth further on its gear.

        teeth_a_turn : of the reference gear; each tooth that passes turns order k by 2 pi k over them
        """
        angle = -2.0 * pi * self.orders * teeth / teeth_a_turn
        found = answers.copy()
        real, imaginary = answers[:, self.real], answers[:, self.imaginary]
        found[:, self.real] = np.cos(angle) * real - np.sin(angle) * imaginary
        found[:, self.imaginary] = np.sin(angle) * real + np.cos(angle) * imaginary
        return np.asarray(found)

    def ahead(self, values: Array) -> Array:
        """(n,) every complex order of values (n,) turned by a right angle, times i; zero for what does not turn."""
        found = np.zeros(len(values))
        found[self.real], found[self.imaginary] = -values[self.imaginary], values[self.real]
        return found

    def order_of(self, count: int) -> Array:
        """(count,) order of every number that turns, zero for the others."""
        found = np.zeros(count)
        found[self.real] = found[self.imaginary] = self.orders
        return found
