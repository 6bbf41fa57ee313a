"""First-order response of a converged point: what a small change anywhere does once the loop has followed.

With the coupling state x of a point, the iterations x -> g(x) and the readings y(x), a change that moves g by dg and
the readings by dy at a fixed x moves the converged readings by dy + Y (1 - G)^-1 dg, G and Y the derivatives of g and
y by x. These come from one iteration per number of the coupling state; what is changed in the housings (conductances,
sources) is solved in the reduced basis (`housing_sensitivities`).
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from dynamics.bearing.protocol import BearingState
from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.response.response_curve import CurvePoint
from rigdesign.coupling.braced_loop import LoadedCircuit
from rigdesign.coupling.iteration import IterationResult, PointProblem, run_iteration
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.coupling.state_vector import SCALES, numbering, scaled, unscaled
from rigdesign.prediction.converged_point import ConvergedPoint, unrelaxed_vector
from rigdesign.prediction.housings import ReducedField
from rigdesign.prediction.linearised_drag import Cause, LinearisedDrag
from rigdesign.prediction.linearised_films import Film
from rigdesign.prediction.model import ORDER_QUANTITIES
from rigdesign.prediction.order_motion import is_ideal
from rigdesign.prediction.orders import Orders, shaft_orders
from rigdesign.prediction.orders import numbers as order_numbers
from rigdesign.prediction.readings import Readings, count_of
from rigdesign.rig.model import Rig
from thermal.fe.mesh import FloatArray

STEP = 0.3
"""Step of a difference in units of `state_vector.SCALES`: 0.3 K, 0.3 um, 3 W, 0.3 N m."""


@dataclass(frozen=True)
class SensitivityNumbers:
    """What the iterations of a point found out: plain numbers, so that another process can send them.

    loop : (n, n) derivative of an iteration by its coupling state; readings : (f, n) of the readings; fields : (m, n)
    of the coefficients of all reduced fields; drag : those of `LinearisedDrag`
    """

    loop: FloatArray
    readings: FloatArray
    fields: FloatArray
    drag: Mapping[Cause, FloatArray]


@dataclass(frozen=True)
class FirstOrder:
    """What an iteration near a converged point gives.

    readings : (f,); unrelaxed : (n,) what it hands on, in units of `state_vector.SCALES`
    coefficients : (m,) of all reduced fields, behind each other
    same_loop : whether the loop is that of the point but for its drag torques and the friction of its teeth
    """

    readings: FloatArray
    unrelaxed: FloatArray
    coefficients: FloatArray
    same_loop: bool


class PointSensitivities:
    """First-order response of one converged point.

    reads : readings of the channels; known : the derivatives, where they were found before

    Attributes
    ----------
    readings : (f,) of the converged point
    index : (field of the coupling state, name) -> number n
    loop : (n, n) derivative of an iteration by its coupling state
    by_state : (f, n) derivative of the readings by the coupling state
    fields : (m, n) derivative of the coefficients of all reduced fields by the coupling state
    inverse : (n, n) how far the coupling state moves until the loop has converged, per change of what an iteration
        hands on
    """

    def __init__(
        self, converged: ConvergedPoint, reads: Readings, known: SensitivityNumbers | None = None
    ) -> None:
        self.converged, self._reads = converged, reads
        self.problem, self.last = converged.problem, converged.last
        self.coupling_state = self.last.coupling_state
        self.drag = LinearisedDrag(self.problem, self.last, reads, None if known is None else known.drag)
        self._unrelaxed = self._handed_on(self.problem, self.last)
        self.readings = np.array(
            [number for _, reading in reads for number in reading(self.problem.rig, self.last)]
        )
        self.index = numbering(self.coupling_state)
        self._fields = [name for name, _ in self.index]
        numbers = known or self._found()
        self.loop, self.by_state, self.fields = numbers.loop, numbers.readings, numbers.fields
        self.inverse = np.linalg.inv(np.eye(len(self._unrelaxed)) - self.loop)
        self._closed = self.by_state @ self.inverse
        """(f, n) converged readings per change of what an iteration hands on."""

    @property
    def numbers(self) -> SensitivityNumbers:
        """The derivatives."""
        return SensitivityNumbers(self.loop, self.by_state, self.fields, self.drag.sensitivities)

    def _found(self) -> SensitivityNumbers:
        """The derivatives, from one iteration per number of the coupling state."""
        x = scaled(self.coupling_state)
        here = _coefficients(self.last)
        loop, readings, fields = [], [], []
        for number in self.index.values():
            moved = x.copy()
            moved[number] += STEP
            there = self._iteration(self.problem, unscaled(moved, self.coupling_state))
            loop.append((there.unrelaxed - self._unrelaxed) / STEP)
            readings.append((there.readings - self.readings) / STEP)
            fields.append((there.coefficients - here) / STEP)
        by_state = np.array(loop).T, np.array(readings).T, np.array(fields).T
        return SensitivityNumbers(*by_state, self.drag.sensitivities)

    def scale(self, number: int) -> float:
        """Unit of a number of the coupling state [K, m, W or N m]."""
        return SCALES[self._fields[number]]

    def followed(self, unrelaxed: FloatArray, read: FloatArray) -> FloatArray:
        """(f, ...) change of the converged readings.

        unrelaxed : (n, ...) change of what an iteration hands on; read : (f, ...) of the readings, both at a fixed
        coupling state
        """
        return np.asarray(read + self._closed @ unrelaxed)

    def corrected(self, point: ConvergedPoint) -> FloatArray:
        """(f,) what the readings of a point nearby lack: its residual, beyond that of the point here."""
        return np.asarray(self._closed @ (point.residual - self.converged.residual))

    def changed(self, problem: PointProblem) -> FirstOrder:
        """Converged readings of a rig or operating condition nearby, from one iteration of it."""
        done = self._iteration(problem, self.coupling_state)
        followed = self.followed(done.unrelaxed - self._unrelaxed, done.readings - self.readings)
        return replace(done, readings=self.readings + followed)

    def _handed_on(self, problem: PointProblem, done: IterationResult) -> FloatArray:
        return unrelaxed_vector(problem.rig, done, self.problem.parts, self.coupling_state)

    def _iteration(self, problem: PointProblem, coupling_state: CouplingState) -> FirstOrder:
        """An iteration with what it hands on and what is read of it; the periodic response is linearised where the
        loop is nearly the same."""
        loop = _LinearisedResponse(self.drag, problem, coupling_state)
        parts = replace(problem.parts, system=loop.system, response=loop.response)
        done = run_iteration(replace(problem, parts=parts), coupling_state, self.last)
        if loop.solved_system is not None:
            done = replace(done, system=loop.solved_system)
        return FirstOrder(
            readings=self._read(problem.rig, done, loop.causes),
            unrelaxed=self._handed_on(problem, done),
            coefficients=_coefficients(done),
            same_loop=loop.causes is not None,
        )

    def _read(self, rig: Rig, done: IterationResult, causes: Mapping[Cause, float] | None) -> FloatArray:
        """(f,) readings of an iteration; orders linearised where it differs by some causes only."""
        linear = None if causes is None else iter(self.drag.orders(causes).tolist())
        orders = {} if linear is not None else self._orders(rig, done)
        read: list[float] = []
        for channel, reading in self._reads:
            if channel.quantity not in ORDER_QUANTITIES:
                read += reading(rig, done)
            elif linear is not None:
                read += islice(linear, count_of(channel))
            else:
                read += order_numbers(channel, orders)
        return np.array(read)

    def _orders(self, rig: Rig, done: IterationResult) -> Orders:
        """Orders after an iteration. Raises NotConverged where contacts would have to be followed exactly."""
        read = [channel for channel, _ in self._reads if channel.quantity in ORDER_QUANTITIES]
        if not read:
            return {}
        ideal = done.response if is_ideal(rig, done.loop) else None
        return shaft_orders(rig, done.loop, read, base=ideal, exact=False)


def _coefficients(done: IterationResult) -> FloatArray:
    """(m,) of all reduced fields of an iteration, behind each other."""
    fields = [field.coefficients for field in done.fields.values() if isinstance(field, ReducedField)]
    return np.concatenate(fields) if fields else np.zeros(0)


class _LinearisedResponse:
    """The periodic response of one iteration: linearised where drag torques, friction and films alone differ."""

    def __init__(self, drag: LinearisedDrag, problem: PointProblem, coupling_state: CouplingState) -> None:
        self._drag, self._problem, self._state = drag, problem, coupling_state
        self.causes: dict[Cause, float] | None = None
        """By how much they differ; None where the response was solved."""
        self.solved_system: LinearSystem | None = None
        """Of the circuit, where `system` gave that of the point and the response was solved all the same."""
        self._films: dict[Film, float] | None = None
        self._bearings: Mapping[str, BearingState] = {}

    def system(
        self,
        rig: Rig,
        point: OperatingPoint,
        coupling_state: CouplingState,
        bearings: Mapping[str, BearingState],
    ) -> LinearSystem:
        """As `rigdesign.coupling.loop_system.loop_system`; that of the point where its films alone differ a little."""
        near, own = self._drag.films, self._drag.last.system
        self._bearings = bearings
        self._films = None if near is None else near.shares(rig, point, coupling_state, bearings)
        if self._films is None or own is None:
            return self._problem.parts.system(rig, point, coupling_state, bearings)
        return own

    def response(self, rig: Rig, circuit: LoadedCircuit) -> CurvePoint:
        """As `rigdesign.coupling.braced_loop.respond`."""
        self.causes = self._drag.causes(rig, circuit, self._films)
        if self.causes is not None:
            return self._drag.response(self.causes)
        if self._films:
            self.solved_system = self._problem.parts.system(rig, circuit.point, self._state, self._bearings)
            circuit = replace(circuit, system=self.solved_system)
        return self._problem.parts.response(rig, circuit)
