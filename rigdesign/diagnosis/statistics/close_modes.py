"""How natural frequencies that lie close together divide a change between them.

The modes of a model are mixed a little differently from those of the rig: two of them are turned into each other by an
angle t with
tan 2t = 2 d / g, where g is the relative distance of their frequencies and d how far the model has each of them off.
Changes a of the eigenvalues by one local stiffness or inertia then become

    a1 + e, a2 - e  with  e = sin 2t (a1 a2)^(1/2) + sin^2 t (a2 - a1)

since the change is of rank one; their sum stays (first-order perturbation of a pair of modes).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.diagnosis.statistics.columns import Array


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
        one, other = np.triu_indices(len(places), 1)
        apart = frequencies[places[one]] != frequencies[places[other]]
        first, second = places[one[apart]], places[other[apart]]
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
        one, other = (self.frequencies[place] for place in (self.first, self.second))
        share, another = answer[self.first] / one, answer[self.second] / other
        moved = self.mixed * np.sqrt(np.abs(share * another)) + self.turned * np.abs(share - another)
        return one * moved, -other * moved
