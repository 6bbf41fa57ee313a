"""First-order response of a converged point: what a small change anywhere does once the loop has followed.

With the coupling state x of a point, the iterations x -> g(x) and the readings y(x), a change that moves g by dg and
the readings by dy at a fixed x moves the converged readings by dy + Y (1 - G)^-1 dg, G and Y the derivatives of g and
y by x. These come from one iteration per number of the coupling state; what is changed in the housings (conductances,
sources) is solved in the reduced basis (`housing_sensitivities`).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice
from typing import Any

import numpy as np

from dynamics.rotor.bearing import BearingState
from dynamics.rotor.bearing_state import BearingCoefficients, RunningState
from dynamics.rotor.linear_system import LinearSystem
from dynamics.tooth.law import MeshLaw
from dynamics.vibration.response_curve import CurvePoint
from rigdesign.coupling.fixed_point import SCALES, numbering, scaled, unscaled
from rigdesign.coupling.iteration import IterationResult, PointProblem, run_iteration
from rigdesign.coupling.loop_system import running_state
from rigdesign.coupling.mesh_models import MeshModel
from rigdesign.coupling.preloaded_loop import BracingState, LoadedCircuit, signed_torque
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.prediction.converged_point import ConvergedPoint, unrelaxed_vector
from rigdesign.prediction.housings import ReducedField
from rigdesign.prediction.model import ORDER_QUANTITIES
from rigdesign.prediction.order_motion import Orders, is_ideal, shaft_orders
from rigdesign.prediction.order_motion import numbers as order_numbers
from rigdesign.prediction.readings import Readings, count_of
from rigdesign.rig.model import Rig
from thermal.fe.mesh import FloatArray

# Films of a converged point that differ a little: what each bearing differs by, as shares of a few changes of it.
#
# Shafts that bend feel stiffness and damping of their bearings. What leaves the parts of the circuit alone (losses,
# oil, flows) moves these by a per cent or less, and along few ways: the oil gets warmer, the clearance wider, the load
# larger. The coefficients of a bearing near the point are written as a sum of these; the response to each is computed
# once.

Film = tuple[str, str]
"""Bearing and what of it changes."""

WAYS = ("film 1", "film 2", "film 3")
"""Orthogonal combinations of warmer oil, wider clearance and larger load, the largest first."""
HEAT_STEP, CLEARANCE_STEP, LOAD_STEP = 10.0, 0.3e-6, 0.01
"""Heat from the bodies [W], clearance [m] and share of the mesh torques that show these ways."""
DISTINCT = 0.03
"""Singular value over the largest below which a combination is left out."""
COEFFICIENT_STEP = 0.02
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
            parts = ways @ own / COEFFICIENT_STEP**2
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
        """By bearing (k, n): orthogonal changes of its scaled coefficients, each of size `COEFFICIENT_STEP`."""
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
            found[name] = COEFFICIENT_STEP * ways[weights > DISTINCT * max(weights[0], 1e-30)]
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


# A converged point whose loop changes in nothing but what brakes it: drags and the friction of its teeth.
#
# Those move torques by a per cent or less, so that the changes of the periodic response with each of them, found once,
# add up. Of shafts that bend the same holds for small changes of their films (`LinearisedFilms`) and for what these do
# to the twist of the bracing. What leaves loop and flanks alone (losses, oil, flows, films) then needs no response of
# its own.

DRAG_STEP = 1.0
"""Drag torque over which a difference is taken [N m]."""
FRICTION_STEP = 0.4
"""Share of a friction coefficient over which differences are taken, to both sides, for both derivatives."""
SAME_BRACING = 1e-9
"""Relative difference of twists or shifts that are the same."""
LEAST_FRICTION = 0.01
"""Friction coefficient of which that share is taken at least."""

Cause = tuple[str, str]
"""``drag`` and a place of the drivetrain, ``friction`` and a mesh, ``bracing`` and its ``twist`` or ``shift``, or one
of `WAYS` and a bearing."""
BRACING_STEP = 1e-3
"""Share of a twist or shift over which a difference is taken."""
MOST_BRACING = 1e-2
"""Share of it up to which the difference serves."""


class LinearisedDrag:
    """Torques, losses and orders of a converged point under other drag torques and frictions.

    last : iteration of the point; reads : readings of the channels; sensitivities : by cause, those that are known
    already, (2, n) per size and per its square
    """

    def __init__(
        self,
        problem: PointProblem,
        last: IterationResult,
        reads: Readings,
        sensitivities: Mapping[Cause, FloatArray] | None = None,
    ) -> None:
        self.problem, self.last = problem, last
        self._orders = [reading for channel, reading in reads if channel.quantity in ORDER_QUANTITIES]
        self.sensitivities = dict(sensitivities or {})

    @cached_property
    def films(self) -> LinearisedFilms | None:
        """Bearings near those of the point; None for shafts that only twist, or without a power circuit."""
        if self.problem.bracing is None or self.problem.rig.shaft_model == "torsional":
            return None
        return LinearisedFilms(self.problem, self.last)

    def causes(
        self, rig: Rig, circuit: LoadedCircuit, films: Mapping[Film, float] | None = None
    ) -> dict[Cause, float] | None:
        """By how much drags [N m], frictions, films and bracing differ; None where more than they do.

        films : changes of the bearings that the system of the circuit leaves out
        """
        own_rig, last = self.problem.rig, self.last
        point, models, drags = circuit.point, circuit.models, circuit.drags
        if (
            circuit.system is not last.system
            or not self._near_bracing(circuit.bracing)
            or rig.pinion_speed(point.speed) != own_rig.pinion_speed(last.point.speed)
            or signed_torque(rig, point) != signed_torque(own_rig, last.point)
            or not all(_alike(model.law, own.law) for model, own in zip(models, last.models))
        ):
            return None
        found: dict[Cause, float] = {}
        for place in {**last.drags, **drags}:
            found["drag", place] = drags.get(place, 0.0) - last.drags.get(place, 0.0)
        for model, own in zip(models, last.models):
            found["friction", model.name] = model.law.friction - own.law.friction
        found |= {(way, bearing): size for (bearing, way), size in (films or {}).items()}
        if self.films is not None and self.problem.bracing is not None:
            own_bracing = self.problem.bracing
            found["bracing", "twist"] = circuit.bracing.twist - own_bracing.twist
            found["bracing", "shift"] = circuit.bracing.shift - own_bracing.shift
        return {cause: size for cause, size in found.items() if size != 0.0}

    def response(self, causes: Mapping[Cause, float]) -> CurvePoint:
        """The response with causes; its motion is that without."""
        base = self.last.response
        assert base is not None
        if not causes:
            return base
        moved = self._moved(causes)
        n = base.mean.size
        return replace(
            base,
            mean=base.mean + moved[:n],
            friction_power=base.friction_power + moved[n : 2 * n],
            damping_power=base.damping_power + moved[2 * n : 3 * n],
            drive_torque=base.drive_torque + float(moved[3 * n]),
        )

    def orders(self, causes: Mapping[Cause, float]) -> FloatArray:
        """(n,) numbers of all channels of orders, behind each other."""
        return np.asarray((self._base + self._moved(causes))[self._first :])

    @cached_property
    def _base(self) -> FloatArray:
        return self._numbers(self.last)

    @property
    def _first(self) -> int:
        """Place of the first number of orders, behind those of the response."""
        return 3 * len(self.last.models) + 1

    def _moved(self, causes: Mapping[Cause, float]) -> FloatArray:
        moved = np.zeros(self._base.size)
        for cause, size in causes.items():
            if cause not in self.sensitivities:
                self.sensitivities[cause] = self._sensitivity(*cause)
            first, second = self.sensitivities[cause]
            moved += size * (first + size * second)
        return moved

    def _sensitivity(self, kind: str, place: str) -> FloatArray:
        """(2, n) first derivative by a drag [N m] or a friction coefficient, and half the second."""
        last = self.last
        if kind == "bracing":
            return self._one_sided(*self._braced(place))
        if kind in WAYS:
            return self._of_film(place, kind)
        if kind == "drag":
            more = {**last.drags, place: last.drags.get(place, 0.0) + DRAG_STEP}
            return self._one_sided(self._solved(last.models, more), DRAG_STEP)
        number = next(index for index, model in enumerate(last.models) if model.name == place)
        stated = last.models[number].law.friction
        step = FRICTION_STEP * max(stated, LEAST_FRICTION)
        sizes = np.array([-step if stated > step else 2.0 * step, step])
        moved = [
            self._solved(_rubbed(last.models, number, stated + size), last.drags) - self._base
            for size in sizes.tolist()
        ]
        return np.linalg.solve(np.stack([sizes, sizes**2], axis=1), np.array(moved))

    def _of_film(self, bearing: str, way: str) -> FloatArray:
        """(2, n) derivatives by the share of a step of a bearing, from both sides."""
        assert self.films is not None
        less, more = (
            self._in_loop(system=self.films.system((bearing, way), share)) - self._base
            for share in (-1.0, 1.0)
        )
        return np.stack([0.5 * (more - less), 0.5 * (more + less)])

    def _one_sided(self, moved: FloatArray, step: float) -> FloatArray:
        """(2, n) first derivative by one difference."""
        first = (moved - self._base) / step
        return np.stack([first, np.zeros_like(first)])

    def _braced(self, kind: str) -> tuple[FloatArray, float]:
        """Numbers with another twist [rad] or shift [m], and by how much it differs."""
        own = self.problem.bracing
        assert own is not None
        if kind == "twist":
            step = BRACING_STEP * own.twist
            return self._in_loop(bracing=replace(own, twist=own.twist + step)), step
        step = BRACING_STEP * own.shift
        return self._in_loop(bracing=replace(own, shift=own.shift + step)), step

    def _near_bracing(self, setting: BracingState) -> bool:
        """Whether a bracing is that of the point; of shafts that bend, or nearly."""
        near = SAME_BRACING if self.films is None else MOST_BRACING
        return _same_bracing(setting, self.problem.bracing, near)

    def _solved(self, models: tuple[MeshModel, ...], drags: Mapping[str, float]) -> FloatArray:
        return self._in_loop(models=models, drags=drags)

    def _in_loop(self, **changed: Any) -> FloatArray:
        """Numbers of the loop of the point with some fields of its `IterationResult` changed."""
        problem = self.problem
        last = replace(self.last, **{"bracing": problem.bracing, **changed})
        response = problem.parts.response(problem.rig, last.loop)
        return self._numbers(replace(last, response=response))

    def _numbers(self, done: IterationResult) -> FloatArray:
        """Mean torques, losses, drive torque and orders."""
        response = done.response
        assert response is not None
        read = [number for reading in self._orders for number in reading(self.problem.rig, done)]
        loop = (response.mean, response.friction_power, response.damping_power, [response.drive_torque])
        return np.concatenate([*loop, read])


def _rubbed(models: tuple[MeshModel, ...], number: int, friction: float) -> tuple[MeshModel, ...]:
    """Models with another friction coefficient in one law."""
    model = models[number]
    changed = replace(model, law=model.law._replace(friction=friction))
    return (*models[:number], changed, *models[number + 1 :])


def _same_bracing(setting: BracingState, own: BracingState | None, near: float) -> bool:
    """Whether two bracings are the same but for a share."""
    if own is None or setting.mode != own.mode:
        return False
    pairs = (setting.twist, own.twist), (setting.shift, own.shift)
    return all(abs(one - other) <= near * abs(other) for one, other in pairs)


def _alike(law: MeshLaw, own: MeshLaw) -> bool:
    """Whether laws of a `Memoisation` differ in friction alone: arrays that are alike are the same ones."""
    return all(
        one is other or (not isinstance(one, np.ndarray) and one == other)
        for one, other in zip(law, own._replace(friction=law.friction))
    )


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
        """As `rigdesign.coupling.preloaded_loop.respond`."""
        self.causes = self._drag.causes(rig, circuit, self._films)
        if self.causes is not None:
            return self._drag.response(self.causes)
        if self._films:
            self.solved_system = self._problem.parts.system(rig, circuit.point, self._state, self._bearings)
            circuit = replace(circuit, system=self.solved_system)
        return self._problem.parts.response(rig, circuit)
