"""Orders of a rig whose change only oscillates: mean torques, losses and temperatures stay those of the base."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from dynamics.orders.deviation_response import linearised
from dynamics.orders.hill_system import MeshPeriodic
from rigdesign.coupling.braced_loop import shifted_laws
from rigdesign.prediction.converged_point import ConvergedPoint
from rigdesign.prediction.memoisation import Memoisation
from rigdesign.prediction.model import Channel, Feature
from rigdesign.prediction.order_motion import ideal_response, is_ideal
from rigdesign.prediction.orders import shaft_orders
from rigdesign.rig.model import Rig
from thermal.fe.mesh import FloatArray

CORRECTIONS = 1
"""Corrections for what contacts do beyond first order: the first is most of it."""


class OscillatingPart:
    """Orders of changed rigs about the ideal motion of one converged point.

    features : of that operating point
    """

    def __init__(
        self,
        converged: ConvergedPoint,
        channels: Sequence[Channel],
        features: Sequence[Feature],
        memoisation: Memoisation,
    ) -> None:
        self._converged, self._memoisation = converged, memoisation
        self._channels, self._features = channels, features
        self._ideal: MeshPeriodic | None = None
        self._base: FloatArray | None = None

    def base(self) -> FloatArray:
        """(f,) numbers of the point itself."""
        if self._base is None:
            self._base = self.numbers(self._converged.problem.rig)
        return self._base

    def numbers(self, rig: Rig) -> FloatArray:
        """(f,) numbers of the channels of orders of a changed rig; zeros for the others."""
        last = self._converged.last
        models = self._memoisation.models(rig, last.point, last.coupling_state)
        system = self._memoisation.system(rig, last.point, last.coupling_state, last.bearings)
        loop = replace(last.loop, models=models, system=system)
        orders = shaft_orders(rig, loop, self._channels, base=self._ideal_motion(), steps=CORRECTIONS)
        read = []
        for feature in self._features:
            value = orders.get((feature.channel, feature.order), 0.0)
            read.append(value.imag if feature.part == "imaginary" else value.real)
        return np.array(read)

    def _ideal_motion(self) -> MeshPeriodic:
        """The loop about the motion of the point with all teeth alike and no oscillating torque: what only oscillates
        leaves it as it is."""
        if self._ideal is None:
            rig, loop = self._converged.problem.rig, self._converged.last.loop
            own = self._converged.last.response if is_ideal(rig, loop) else None
            laws = shifted_laws(rig, loop.models, loop.bracing)
            held = loop.bracing.mode != "torque_controlled"
            self._ideal = linearised(loop.system, laws, own or ideal_response(rig, loop), held)
        return self._ideal
