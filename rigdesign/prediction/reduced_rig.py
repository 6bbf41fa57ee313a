"""A rig with reduced housings at its operating conditions: the model behind a `Predictor`."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, partial
from itertools import islice

import numpy as np
from scipy.linalg import block_diag

from rigdesign.base.errors import UsageError
from rigdesign.base.fidelity import Fidelity
from rigdesign.base.parallel import BackgroundTasks
from rigdesign.base.units import show
from rigdesign.case.model import Case
from rigdesign.coupling.fixed_point import CaseTolerances, PlainRelaxation, iterations
from rigdesign.coupling.iteration import PointProblem, initial_state
from rigdesign.coupling.state import CouplingState
from rigdesign.prediction.converged_point import ConvergedPoint, converge_point
from rigdesign.prediction.full import modelled_rig, operating_point, rig_at, standing_values
from rigdesign.prediction.housing_sensitivities import (
    HousingSensitivities,
    field_derivatives,
    stream_sources,
)
from rigdesign.prediction.housings import HousingNumbers, ReducedField, ReducedHousings
from rigdesign.prediction.memoisation import AT_ANY_SPEED, Memoisation
from rigdesign.prediction.model import Channel, OperatingCondition, PredictionModel
from rigdesign.prediction.places import Weights, place_weights
from rigdesign.prediction.readings import rate_rows, readings
from rigdesign.prediction.sensitivities import PointSensitivities, SensitivityNumbers
from rigdesign.rig.model import Rig
from thermal.conduction.setup import Condition
from thermal.fe.mesh import FloatArray

STATES = 2
"""Operating conditions whose boundary conditions the reduced basis is made from."""
STATE_ITERATIONS = 2
"""Iterations of the full model after which those boundary conditions are taken."""


class ReducedRig:
    """A rig at fixed operating conditions and channels, its housings in the reduced thermal model.

    housings : numbers of the reduced housings, where they are known

    Attributes
    ----------
    stated : the rig of the case as it stands; rigs : it at every operating condition
    reads : readings of the channels that are read at operating points
    """

    def __init__(
        self,
        case: Case,
        conditions: Sequence[OperatingCondition],
        channels: Sequence[Channel],
        circuit: PredictionModel,
        fidelity: Fidelity,
        housings: Mapping[str, HousingNumbers] | None = None,
    ) -> None:
        self.conditions, self.channels = conditions, channels
        self.stated = modelled_rig(case, fidelity, circuit)
        self.reads = readings(self.stated, channels)
        if housings is None:
            self.housings = ReducedHousings(self.stated, self._boundary_conditions(), self._sensors())
        else:
            self.housings = ReducedHousings.of_numbers(self.stated, housings)
        self.memoisation = Memoisation()
        self._parts = self.housings.parts(self.memoisation.parts)
        self._initial: dict[str, CouplingState] = {}
        self.rigs = [rig_at(self.stated, condition) for condition in conditions]

    def converged_base(self, starts: Sequence[CouplingState] = ()) -> list[ConvergedPoint]:
        """All operating points of the stated rig, each from the nearest one that has converged.

        starts : their coupling states, where they are known
        """
        points: list[ConvergedPoint] = []
        for index, condition in enumerate(self.conditions):
            problem = self.problem(self.rigs[index], condition)
            if starts:
                points.append(converge_point(problem, start=starts[index]))
                continue
            near = min(range(index), key=lambda i: distance(self.conditions[i], condition), default=None)
            points.append(converge_point(problem, None if near is None else points[near]))
        self.memoisation.start_from(point.last for point in points)
        self._initial |= {point.last.point.stage: point.problem.initial for point in points}
        return points

    def problem(self, rig: Rig, condition: OperatingCondition) -> PointProblem:
        """The coupled problem of a rig at an operating condition it is already set to."""
        return PointProblem.braced(rig, operating_point(condition), self._parts)

    def changed_problem(self, rig: Rig, condition: OperatingCondition) -> PointProblem:
        """The coupled problem of a changed rig at an operating condition; its bracing is looked up where it was met.

        Its initial state is that of the stated rig where nothing is braced in it.
        """
        here, point = rig_at(rig, condition), operating_point(condition)
        held = rig.case.power_circuit.bracing.mode != "torque_controlled"
        known = None if held else self._initial.get(condition.name)
        initial = known or initial_state(here, point, self.memoisation.bearings)
        return PointProblem(
            rig=here,
            point=point,
            initial=initial,
            bracing=self.memoisation.bracing(here, point, initial),
            parts=self._parts,
        )

    def values(self, rig: Rig, rigs: Sequence[Rig], points: Sequence[ConvergedPoint]) -> FloatArray:
        """(n_features,) numbers of converged points of ``rigs``; standing quantities of ``rig``."""
        numbers: list[float] = []
        for here, point in zip(rigs, points, strict=True):
            for _, read in self.reads:
                numbers += read(here, point.last)
        return np.array([*numbers, *self.standing_values(rig)])

    def standing_values(self, rig: Rig) -> list[float]:
        """Numbers of the channels of a rig at rest, in their order."""
        return standing_values(rig, self.channels, self.memoisation.standing_modes)

    def _sensors(self) -> dict[str, list[Weights]]:
        """Temperature channels by gearbox."""
        found: dict[str, list[Weights]] = {}
        for channel in self.channels:
            if channel.quantity == "temperature":
                name, weights = place_weights(self.stated, channel.place, channel.at)
                found.setdefault(name, []).append(weights)
        return found

    def _boundary_conditions(self) -> dict[str, list[Sequence[Condition]]]:
        """Those of every housing near the operating points that lie furthest apart."""
        found: dict[str, list[Sequence[Condition]]] = {name: [] for name in self.stated.models}
        for condition in furthest_apart(self.conditions, STATES) if found else ():
            rig = rig_at(self.stated, condition)
            problem = PointProblem.braced(rig, operating_point(condition), AT_ANY_SPEED)
            steps = iterations(problem, PlainRelaxation(), CaseTolerances(rig.case.numerics), problem.initial)
            *_, last = islice(steps, STATE_ITERATIONS)
            for name, field in last.done.fields.items():
                found[name].append(field.conditions)
        return found


# Distances between operating conditions, and small steps of their values for derivatives.

STEP_SHARE = 2e-3
"""Share of a speed, torque or flow by which it is moved for a derivative."""
STEP_KELVIN = 0.2
"""Temperature by which an inlet or the room is moved for a derivative [K]."""


def moved_conditions(
    case: Case, setting: OperatingCondition
) -> dict[tuple[str, str], tuple[OperatingCondition, float]]:
    """(kind, place) -> the setting with that value moved a little, and by how much."""
    moved: dict[tuple[str, str], tuple[OperatingCondition, float]] = {}
    for kind in ("speed", "torque"):
        step = STEP_SHARE * max(abs(getattr(setting, kind)), 1.0)
        moved[kind, ""] = replace(setting, **{kind: getattr(setting, kind) + step}), step
    for name, box in case.gearboxes.items():
        for kind, (feed, _) in box.feeds.items():
            stream = f"{name}.{kind}"
            inlet = setting.inlet_temperature.get(stream, feed.inlet_temperature)
            inlets = {**setting.inlet_temperature, stream: inlet + STEP_KELVIN}
            moved["inlet_temperature", stream] = replace(setting, inlet_temperature=inlets), STEP_KELVIN
            flow = setting.flow.get(stream, feed.flow)
            flows = {**setting.flow, stream: flow * (1.0 + STEP_SHARE)}
            moved["flow", stream] = replace(setting, flow=flows), flow * STEP_SHARE
        if box.sump is not None and box.sump.sump_temperature is not None:
            stream = f"{name}.gear_oil"
            held = setting.inlet_temperature.get(stream, box.sump.sump_temperature)
            inlets = {**setting.inlet_temperature, stream: held + STEP_KELVIN}
            moved["inlet_temperature", stream] = replace(setting, inlet_temperature=inlets), STEP_KELVIN
    room = case.ambient.temperature if setting.ambient_temperature is None else setting.ambient_temperature
    warmer = replace(setting, ambient_temperature=room + STEP_KELVIN)
    moved["ambient_temperature", ""] = warmer, STEP_KELVIN
    return moved


def distance(first: OperatingCondition, second: OperatingCondition) -> float:
    """How far two operating points lie apart, for a choice among neighbours."""
    speed = abs(first.speed - second.speed) / max(first.speed, second.speed, 1e-9)
    torque = abs(first.torque - second.torque) / max(abs(first.torque), abs(second.torque), 1e-9)
    feeds = [(first.inlet_temperature, second.inlet_temperature), (first.flow, second.flow)]
    oil = sum(
        abs(one.get(key, other[key]) - other[key]) / abs(other[key]) for one, other in feeds for key in other
    )
    return float(speed + 0.5 * torque + 3.0 * oil)


def furthest_apart(settings: Sequence[OperatingCondition], count: int) -> list[OperatingCondition]:
    """The most severe operating point and those that lie furthest from all chosen before."""
    if not settings:
        return []
    chosen = [max(settings, key=lambda s: (s.speed * abs(s.torque), s.speed))]
    while len(chosen) < min(count, len(settings)):
        chosen.append(max(settings, key=lambda s: min(distance(c, s) for c in chosen)))
    return chosen


# First-order response of all operating points of a reduced rig: to its housings, to heat sources, to what is set.

# Readings of a point that was not steady: the linearised rig marched exactly over the time it had run.
#
# Close to a steady point the fields of all housings, with oils, films and losses following at once, obey
#
#     C da/dt = -K (a - a_steady),    a(0) = room temperature,
#
# with C the heat capacities on the reduced basis and 1/K the response of the coefficients to heat, the loop followed
# (`rigdesign.prediction.sensitivities`). Its solution is a sum of exponentials, one a mode; the heat -C da/dt that
# still goes into the bodies acts on the readings like any other heat. `rigdesign.coupling.loop` marches the model
# itself in time steps, laws of films and losses as they are on the way.

AT_ONCE = 1e-5
"""Time constant over the longest one below which a mode has settled at once."""


class WarmUpResponse:
    """Warm-up of one converged steady point.

    point : its sensitivities; housings : those of all its housings, in the order of its fields
    room : temperature of all bodies at the start [K]
    rates : number of a reading that is a rate of change -> that of the temperature which changes
    """

    def __init__(
        self,
        point: PointSensitivities,
        housings: Sequence[HousingSensitivities],
        room: float,
        rates: Mapping[int, int],
    ) -> None:
        self._point, self._housings, self._room = point, housings, room
        self._of_rates, self._of_temperatures = list(rates), list(rates.values())

    @cached_property
    def _capacity(self) -> FloatArray:
        """(m, m) [J/K]"""
        return np.asarray(block_diag(*(housing.capacity() for housing in self._housings)))

    @cached_property
    def _answers(self) -> tuple[FloatArray, FloatArray]:
        """(m, m) of the coefficients and (f, m) of the readings per heat on each vector of the basis, loop followed."""
        parts = [housing.heat_responses() for housing in self._housings]
        unrelaxed = np.hstack([part.unrelaxed for part in parts])
        read = np.hstack([part.readings for part in parts])
        still = block_diag(*(part.coefficients for part in parts))
        coefficients = still + self._point.fields @ (self._point.inverse @ unrelaxed)
        return coefficients, self._point.followed(unrelaxed, read)

    def rise(self, time: float, derivative: int = 0) -> FloatArray:
        """(m,) coefficients less those of the steady point after ``time`` [s] from room temperature, or their first or
        second derivative by time."""
        times, vectors, shares = self._modes
        return np.asarray((vectors @ (shares * (-1.0 / times) ** derivative * np.exp(-time / times))).real)

    def change(self, time: float) -> FloatArray:
        """(f,) readings after ``time`` [s] from room temperature, less those of the steady point."""
        _, readings = self._answers
        found = -readings @ (self._capacity @ self.rise(time, 1))
        found[self._of_rates] = -(readings @ (self._capacity @ self.rise(time, 2)))[self._of_temperatures]
        return np.asarray(found)

    @cached_property
    def _modes(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Time constants (k,) [s] of C/K, their vectors (m, k), and what each has of the rise at the start (k,).

        A vector of the basis that stores next to no heat follows at once: its time constant is rounding, of either
        sign.
        """
        steady = np.concatenate([housing.coefficients for housing in self._housings])
        start = np.concatenate([housing.uniform(self._room) for housing in self._housings])
        coefficients, _ = self._answers
        times, vectors = np.linalg.eig(coefficients @ self._capacity)
        lasting = times.real > AT_ONCE * times.real.max()
        shares = np.linalg.solve(vectors, start - steady)
        return times[lasting], vectors[:, lasting], shares[lasting]


class FirstOrderModel:
    """Sensitivities of converged points, made when they are first asked for.

    converged : the points of all operating conditions of ``reduced``, one at least
    """

    def __init__(self, reduced: ReducedRig, converged: Sequence[ConvergedPoint]) -> None:
        self._reduced, self._converged = reduced, tuple(converged)
        self.known: list[PointSensitivities] | None = None
        """Sensitivities of the points once they have been made."""

    @property
    def points(self) -> list[PointSensitivities]:
        """Sensitivities of every point, made when they are first asked for.

        Raises
        ------
        UsageError
            A case whose points are not steady: their sensitivities depend on the whole warm-up.
        """
        if self.known is None:
            self.known = self._made()
        return self.known

    def _made(self) -> list[PointSensitivities]:
        """Sensitivities of every point, found on all cores."""
        time = self._reduced.stated.case.ambient.warming_time
        if time is not None:
            raise UsageError(
                f"ambient.warming_time = {show(time, 'time')}: first-order predictions start from steady points; leave "
                "it out, a diagnosis finds the time itself (not_steady)"
            )
        made = partial(PointSensitivities, reads=self._reduced.reads)
        with BackgroundTasks([partial(_numbers_at, made, point) for point in self._converged]) as tasks:
            numbers = tasks.results()
        return [made(point, known=known) for point, known in zip(self._converged, numbers)]

    @cached_property
    def _housings(self) -> list[list[HousingSensitivities]]:
        """Of every point, one for each of its housings."""
        housings, reads = self._reduced.housings, self._reduced.reads
        derivatives = field_derivatives(self._converged[0], housings, reads)
        return [
            [
                HousingSensitivities(point, field, housings.bases[name].reduced, derivatives[name])
                for name, field in point.last.fields.items()
                if isinstance(field, ReducedField)
            ]
            for point in self.points
        ]

    @cached_property
    def _warm_ups(self) -> list[WarmUpResponse]:
        """Of every point."""
        return [
            WarmUpResponse(
                point, housings, point.problem.rig.case.ambient.temperature, rate_rows(self._reduced.channels)
            )
            for point, housings in zip(self.points, self._housings)
        ]

    def warming(self, times: Sequence[float | None]) -> list[FloatArray]:
        """By point: (f,) readings after a time [s] from room temperature; None for a steady point."""
        return [
            point.readings if time is None else point.readings + warm_up.change(time)
            for point, warm_up, time in zip(self.points, self._warm_ups, times)
        ]

    def links(self) -> list[dict[str, FloatArray]]:
        """By point: name -> (f,) derivative by the logarithm of a conductance."""
        return [_merged(part.links() for part in housings) for housings in self._housings]

    def sources(self) -> list[dict[str, FloatArray]]:
        """By point: name -> (f,) response per watt [1/W]."""
        return [
            _merged(part.sources(self._reduced.reads) for part in housings) | stream_sources(point)
            for point, housings in zip(self.points, self._housings)
        ]

    def inputs(self, case: Case) -> list[dict[tuple[str, str], FloatArray]]:
        """By point: (kind, place) -> (f,) derivative by a value of its operating condition."""
        return [
            {
                key: (point.changed(self._reduced.changed_problem(self._reduced.stated, moved)).readings
                      - point.readings) / step
                for key, (moved, step) in moved_conditions(case, condition).items()
            }
            for point, condition in zip(self.points, self._reduced.conditions)
        ]  # fmt: skip


def _numbers_at(
    made: Callable[[ConvergedPoint], PointSensitivities], point: ConvergedPoint
) -> SensitivityNumbers:
    return made(point).numbers


def _merged(parts: Iterable[dict[str, FloatArray]]) -> dict[str, FloatArray]:
    """The entries of all housings of a point."""
    return {name: values for part in parts for name, values in part.items()}
