"""Films of a converged point that differ a little: what each bearing differs by, as shares of a few changes of it.

Shafts that bend feel stiffness and damping of their bearings. What leaves the parts of the circuit alone (losses, oil,
flows) moves these by a per cent or less, and along few ways: the oil gets warmer, the clearance wider, the load larger.
The coefficients of a bearing near the point are written as a sum of these; the response to each is found once
(`rigdesign.prediction.sensitivities`).
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cached_property

import numpy as np

from dynamics.rotor.bearing import BearingState
from dynamics.rotor.bearing_state import BearingCoefficients, RunningState
from dynamics.rotor.linear_system import LinearSystem
from rigdesign.coupling.iteration import IterationResult, PointProblem
from rigdesign.coupling.loop_system import running_state
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.rig.model import Rig
from thermal.fe.mesh import FloatArray

Film = tuple[str, str]
"""Bearing and what of it changes."""

WAYS = ("film 1", "film 2", "film 3")
"""Orthogonal combinations of warmer oil, wider clearance and larger load, the largest first."""
HEAT_STEP, CLEARANCE_STEP, LOAD_STEP = 10.0, 0.3e-6, 0.01
"""Heat from the bodies [W], clearance [m] and share of the mesh torques that show these ways."""
DISTINCT = 0.03
"""Singular value over the largest below which a combination is left out."""
STEP = 0.02
"""Relative change of the coefficients of a bearing in one step of a way."""
LARGEST = 0.03
"""Relative change of the coefficients of a bearing beyond which the loop is solved again."""
UNEXPLAINED = 0.1
"""Share of the change of a bearing that the three ways may leave; of what changes by less than `ALIKE`, all."""
ALIKE = 1e-6


class LinearisedFilms:
    """Bearings near those of the last iteration of a point; of shafts that bend only."""

    def __init__(self, problem: PointProblem, last: IterationResult) -> None:
        self._problem, self._last = problem, last
        self.rig = problem.rig
        self.base = self._state(last.coupling_state, last.bearings)

    def shares(
        self,
        rig: Rig,
        point: OperatingPoint,
        coupling_state: CouplingState,
        bearings: Mapping[str, BearingState],
    ) -> dict[Film, float] | None:
        """How much of each way the bearings of a neighbour differ by; None where more than films differ, or much."""
        if rig.shaft_model == "torsional" or rig.elastic is not self.rig.elastic:
            return None
        state = running_state(rig, point, coupling_state, bearings)
        if state.speed != self.base.speed or dict(state.torques) != dict(self.base.torques):
            return None
        found: dict[Film, float] = {}
        for name, coefficients in state.bearings.items():
            own = self._scaled(name, coefficients) - self._scaled(name, self.base.bearings[name])
            size = float(np.linalg.norm(own))
            if size > LARGEST:
                return None
            if size == 0.0:
                continue
            ways = self._ways[name]
            parts = ways @ own / STEP**2
            if size > ALIKE and np.linalg.norm(own - parts @ ways) > UNEXPLAINED * size:
                return None
            found |= {(name, way): float(part) for way, part in zip(WAYS, parts)}
        return found

    def system(self, film: Film, share: float) -> LinearSystem:
        """Matrices with one bearing changed by a share of a step of one way."""
        name, way = film
        own, moved = self.base.bearings[name], share * self._ways[name][WAYS.index(way)]
        parts = np.split(moved, 2)
        changed = BearingCoefficients(
            stiffness=own.stiffness + _size(own.stiffness) * parts[0].reshape(own.stiffness.shape),
            damping=own.damping + _size(own.damping) * parts[1].reshape(own.damping.shape),
        )
        bearings = {**self.base.bearings, name: changed}
        return self.rig.elastic.seen.system(replace(self.base, bearings=bearings))

    @cached_property
    def _ways(self) -> dict[str, FloatArray]:
        """By bearing (k, n): orthogonal changes of its scaled coefficients, each of size `STEP`."""
        state = self._last.coupling_state
        warmer = replace(state, bearing_heat={k: v + HEAT_STEP for k, v in state.bearing_heat.items()})
        wider = replace(
            state, bearing_clearance={k: v + CLEARANCE_STEP for k, v in state.bearing_clearance.items()}
        )
        solve: Callable[..., dict[str, BearingState]] = self._problem.parts.bearings
        point = self._last.point
        stepped = [
            self._state(there, solve(self.rig, point, there))
            for there in (warmer, wider, state.with_torque_share(1.0 + LOAD_STEP))
        ]
        found = {}
        for name, own in self.base.bearings.items():
            base = self._scaled(name, own)
            moved = np.array([self._scaled(name, there.bearings[name]) - base for there in stepped])
            moved /= np.maximum(np.linalg.norm(moved, axis=1, keepdims=True), 1e-30)
            _, weights, ways = np.linalg.svd(moved, full_matrices=False)
            found[name] = STEP * ways[weights > DISTINCT * max(weights[0], 1e-30)]
        return found

    def _scaled(self, name: str, coefficients: BearingCoefficients) -> FloatArray:
        """(n,) stiffness and damping over the size of those of the point."""
        own = self.base.bearings[name]
        pairs = (coefficients.stiffness, own.stiffness), (coefficients.damping, own.damping)
        return np.concatenate([(one / _size(of)).ravel() for one, of in pairs])

    def _state(self, coupling_state: CouplingState, bearings: Mapping[str, BearingState]) -> RunningState:
        return running_state(self.rig, self._last.point, coupling_state, bearings)


def _size(matrix: FloatArray) -> float:
    return max(float(np.linalg.norm(matrix)), 1e-30)
