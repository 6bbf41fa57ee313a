"""How far each number of an order may be from the answer of a right cause, by itself.

A model has natural frequencies a little off, and mesh orders worse than that. And a cause that changes the circuit
(stiffness, inertia, damping) changes how all passes through it that the teeth excite: where it alters the mesh orders
of a channel by some share, the orders that pitch errors and run-out of the healthy teeth leave there follow by as
much, and no model knows those errors.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.diagnosis.statistics.columns import Array, numbered, order_numbers, together
from rigdesign.prediction.model import Feature


@dataclass(frozen=True, kw_only=True)
class ModelError:
    """Error by itself of every number.

    share : (n,) of its answer, zero for what is of no order; mesh : (n,) whether it is of a mesh order
    values : (n,) as measured; orders, places : (n,) number of its order, and of its channel and point
    """

    share: Array
    mesh: NDArray[np.bool_]
    values: Array
    orders: NDArray[np.intp]
    places: NDArray[np.intp]

    @classmethod
    def of(
        cls, features: Sequence[Feature], share: Array, mesh: NDArray[np.bool_], values: Array
    ) -> "ModelError":
        """Of the numbers of a comparison."""
        return cls(
            share=share,
            mesh=mesh,
            values=np.where([one.order != 0.0 for one in features], values, 0.0),
            orders=order_numbers(features),
            places=numbered([(one.channel, one.setting) for one in features]),
        )

    def at(self, answer: Array, circuit: bool) -> Array:
        """(n,) standard deviations of an answer (n,); ``circuit``: whether its cause changes the circuit."""
        own = self.share * together(answer, self.orders)
        if not circuit:
            return np.asarray(own)
        changed, before = (together(self.mesh * one, self.places) for one in (answer, self.values))
        passed_on = np.minimum(changed / np.maximum(before, 1e-150), 1.0)
        excited = np.where(self.mesh, 0.0, together(self.values, self.orders))
        return np.asarray(np.hypot(own, passed_on * excited))
