"""How far each number of an order may be from the answer of a right cause, by itself.

A model has natural frequencies a little off, and mesh orders worse than that. And a cause that changes the circuit
(stiffness, inertia, damping) changes how all passes through it that the teeth excite: where it alters the mesh orders
of a channel by some share, the orders that pitch errors and run-out of the healthy teeth leave there follow by as
much, and no model knows those errors.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rigdesign.diagnosis.columns import Array
from rigdesign.prediction.model import Feature


@dataclass(frozen=True, kw_only=True)
class OwnError:
    """Error by itself of every number.

    share : (n,) of its answer; twin : (n,) place of the other part of the same order, of what has none its own
    mesh : (n,) whether it is of a mesh order; group : (n,) number of its channel and point
    read : (n,) amplitude of the order as measured, zero for other numbers
    """

    share: Array
    twin: NDArray[np.intp]
    mesh: NDArray[np.bool_]
    group: NDArray[np.intp]
    read: Array

    @classmethod
    def of(
        cls, features: Sequence[Feature], share: Array, mesh_orders: frozenset[float], read: Array
    ) -> "OwnError":
        """Of the numbers of a comparison."""
        names = [(one.channel, one.setting) for one in features]
        groups = {name: number for number, name in enumerate(dict.fromkeys(names))}
        return cls(
            share=share,
            twin=_twins(features),
            mesh=np.array([one.order in mesh_orders for one in features], dtype=bool),
            group=np.array([groups[name] for name in names], dtype=np.intp),
            read=read,
        )

    def at(self, answer: Array, circuit: bool) -> Array:
        """(n,) standard deviations beside an answer (n,); ``circuit``: whether its cause changes the circuit."""
        own = self.share * np.hypot(answer, answer[self.twin])
        if not circuit:
            return np.asarray(own)
        excited = np.where(self.mesh, 0.0, self.read)
        return np.asarray(np.hypot(own, self._passed_on(answer)[self.group] * excited))

    def _passed_on(self, answer: Array) -> Array:
        """Relative change of the mesh orders of every channel and point, one at most."""
        count = int(self.group.max(initial=-1)) + 1
        changed = np.bincount(self.group, weights=self.mesh * answer**2, minlength=count)
        # an order has two numbers, and both know its amplitude
        before = np.bincount(self.group, weights=0.5 * self.mesh * self.read**2, minlength=count)
        return np.minimum(np.sqrt(changed / np.maximum(before, 1e-300)), 1.0)


def _twins(features: Sequence[Feature]) -> NDArray[np.intp]:
    places = {feature: place for place, feature in enumerate(features)}
    other = [replace(one, part="imaginary" if one.part == "real" else "real") for one in features]
    return np.array([places.get(one, place) for place, one in enumerate(other)], dtype=np.intp)
