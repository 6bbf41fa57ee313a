"""Many predictions of one rig at the same operating points: base, changed cases, derivatives.

A `Predictor` settles all operating points once with the reduced thermal model and keeps what neighbouring cases can
use. A changed case is settled anew from there with the same iterations; what a change leaves alone is not computed
twice.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from dynamics.response.speed_sweep import CurvePoint
from rigdesign.base.errors import UsageError
from rigdesign.base.fidelity import Fidelity
from rigdesign.base.parallel import BackgroundTasks
from rigdesign.case.model import Case
from rigdesign.coupling.initial_state import initial_state
from rigdesign.coupling.iteration import IterationParts, next_state, run_iteration
from rigdesign.coupling.loads import BracingState as Bracing
from rigdesign.coupling.loads import brace_initial
from rigdesign.coupling.state import OperatingPoint
from rigdesign.prediction.changes import Changes, changed_case
from rigdesign.prediction.fixed_point import CLOSE, SettledPoint, solve_fixed_point
from rigdesign.prediction.full import check_names, standing_values
from rigdesign.prediction.housings import ReducedHousings
from rigdesign.prediction.memoisation import Memoisation
from rigdesign.prediction.model import ORDER_QUANTITIES, Channel, OperatingCondition, features_of
from rigdesign.prediction.operating import like, operating_point, rig_at
from rigdesign.prediction.orders import ideal_response, is_ideal, shaft_orders
from rigdesign.prediction.places import Weights, place_weights
from rigdesign.prediction.readings import readings
from rigdesign.prediction.sensitivities import (
    Directions,
    Named,
    PointSensitivities,
    SensitivityNumbers,
    directions_of,
)
from rigdesign.prediction.static_tests import standing_modes
from rigdesign.rig.model import Rig, build_rig
from rigdesign.run.solver_errors import solver_errors
from thermal.conduction.condition_checks import Condition
from thermal.fe.kernels import one_thread
from thermal.fe.mesh import FloatArray

NEAR = 0.1
"""Last step of the loop, in sizes of `fixed_point.SCALES`, that is answered to first order: 0.1 K, 0.1 um, 1 W."""
STEP_SHARE = 2e-3
"""Share of a speed, torque or flow by which it is moved for a derivative."""
STEP_KELVIN = 0.2
"""Temperature by which an inlet or the room is moved for a derivative [K]."""
SWING_STEPS = 1
"""Corrections for what contacts do beyond first order where a change only swings: the first is most of it."""
STATES = 2
"""Operating points whose conditions shape the reduced model."""


class Predictor:
    """Predictions at fixed operating points and channels, for many cases near one.

    Parameters
    ----------
    case, settings, channels : as `predict`
    fidelity : size of the models

    Attributes
    ----------
    features : the numbers in their order
    base : (n_features,) prediction for the case as it stands
    error : largest error of a temperature of the reduced model against the full one [K], found on changed
        conditions that did not shape it

    Raises
    ------
    UsageError, CaseError, NotConvergedError, MissingLibraryError
        As `predict`.
    """

    def __init__(
        self,
        case: Case,
        settings: Iterable[OperatingCondition],
        channels: Iterable[Channel],
        *,
        fidelity: Fidelity = "quick",
    ) -> None:
        self.case, self.settings, self.channels = case, tuple(settings), tuple(channels)
        self.fidelity: Fidelity = fidelity
        check_names(self.settings, self.channels)
        self.features = features_of(self.settings, self.channels)
        if not self.settings:
            raise UsageError("no operating points; give one setting at least")
        self._made_slopes: list[PointSensitivities] | None = None
        self._known_swings: dict[int, FloatArray] = {}
        self._ideal: dict[int, CurvePoint] = {}
        with self._calm():
            self._rig = build_rig(case, fidelity)
            self._reads = readings(self._rig, self.channels)
            self._housings = ReducedHousings(self._rig, self._states(), self._sensors())
            self._memory = Memoisation()
            self._parts = self._housings.parts(self._memory.parts)
            self._rigs = [rig_at(self._rig, setting) for setting in self.settings]
            self._points = self._settled_base()
            self.base = self._values(self._rig, self._points)
        self.error = self._housings.error

    def values(self, changes: Changes | Sequence[Changes]) -> FloatArray:
        """(n_features,) prediction for a changed case.

        changes : dotted path -> value as the file would hold it (bare numbers in SI, kelvin) for all operating
            points, or one such mapping per operating point; standing quantities follow the first

        Raises
        ------
        CaseError
            A path that does not exist, a value the case refuses.
        NotConvergedError
            A point that does not converge.
        """
        made = self._changed_rigs(changes)
        with self._calm():
            known = self._made_slopes
            points = [
                solve_fixed_point(
                    rig_at(rig, setting),
                    operating_point(setting),
                    self._parts,
                    near,
                    None if known is None else known[number].inverse,
                    close=CLOSE if known is None else NEAR,
                )
                for number, (rig, setting, near) in enumerate(zip(made, self.settings, self._points))
            ]
            found = self._values(made[0], points, made)
            if known is not None:
                last = np.concatenate([slopes.corrected(point) for slopes, point in zip(known, points)])
                found[: len(last)] += last
            return found

    def response(self, changes: Changes | Sequence[Changes]) -> FloatArray:
        """(n_features,) first-order prediction for a changed case: one iteration a point, the loop followed linearly.

        changes : as `values`

        Raises
        ------
        CaseError
            As `values`.
        NotConvergedError
            An iteration that does not converge, or teeth so unlike that their contacts have to be followed exactly, as
            `values` does.
        """
        made = self._changed_rigs(changes)
        with self._calm():
            answers = [
                slopes.changed(*self._posed(rig, setting))
                for slopes, rig, setting in zip(self._slopes(), made, self.settings)
            ]
            numbers = [answer.readings for answer in answers]
            rest = sum(map(len, numbers))
            if all(answer.same_loop for answer in answers):
                return np.concatenate([*numbers, self.base[rest:]])
            return np.concatenate([*numbers, standing_values(made[0], self.channels)])

    def swinging(self, changes: Changes) -> FloatArray:
        """(n_features,) linear prediction for a case whose change only swings: waves over the teeth, torques.

        Such a change has no mean over a turn, so that losses, temperatures and means stay; orders alone are solved.

        changes : as `values`, for all operating points
        """
        made = self._changed_rigs(changes)
        found = self.base.copy()
        start = 0
        with self._calm():
            for number, (rig, setting) in enumerate(zip(made, self.settings)):
                moved = self._swings(number, rig_at(rig, setting)) - self._still_swings(number)
                found[start : start + len(moved)] += moved
                start += len(moved)
        return found

    def _still_swings(self, number: int) -> FloatArray:
        if number not in self._known_swings:
            self._known_swings[number] = self._swings(number, self._rigs[number])
        return self._known_swings[number]

    def _swings(self, number: int, rig: Rig) -> FloatArray:
        """(f,) numbers of the channels of orders at a point, linear about its ideal motion; zeros for the others."""
        point = self._points[number]
        last = point.last
        if number not in self._ideal:
            ideal = last.response if is_ideal(self._rigs[number]) else None
            assert point.bracing is not None
            self._ideal[number] = ideal or ideal_response(
                self._rigs[number], last.point, last.models, last.drags, point.bracing
            )
        models = self._memory.models(rig, last.point, last.coupling_state)
        assert point.bracing is not None
        orders = shaft_orders(
            rig,
            last.point,
            models,
            last.drags,
            point.bracing,
            self.channels,
            base=self._ideal[number],
            steps=SWING_STEPS,
        )
        read = []
        for feature in features_of((self.settings[number],), self.channels):
            value = orders.get((feature.channel, feature.order), 0.0) if feature.setting else None
            if value is not None:
                read.append(value.imag if feature.part == "imaginary" else value.real)
        return np.array(read)

    def prepare(self) -> None:
        """Make what first-order answers of all points need; on all cores."""
        with self._calm():
            self._slopes()
            if any(channel.quantity in ORDER_QUANTITIES for channel in self.channels):
                for number in range(len(self.settings)):
                    self._still_swings(number)

    def natural_frequencies(self) -> FloatArray:
        """(k,) of the rig at rest, all of them, rising [rad/s]; none without a drivetrain."""
        if self._rig.drivetrain is None:
            return np.zeros(0)
        with self._calm():
            return np.array([2.0 * np.pi * mode.frequency for mode in standing_modes(self._rig)])

    def links(self) -> dict[str, FloatArray]:
        """Name -> (n_features,) derivative by the logarithm of every local conductance of the housings.

        Names: ``film:``, ``bearing_film:``, ``radiation:`` gearbox.surface; ``exchange:``, ``contact:``
        gearbox.surface|surface. The conductance changes at all operating points together.
        """
        if not self._housings.bases:
            return {}
        with self._calm():
            return self._joined([slopes.links() for slopes in self._slopes()])

    def sources(self) -> dict[str, FloatArray]:
        """Name -> (n_features,) answer per watt [1/W] put in at all operating points.

        Names: ``body:`` gearbox.body, ``rim:`` gearbox.gear, ``bore:`` and ``film:`` gearbox.bearing, ``oil:``
        stream, ``near:`` thermocouple by its coordinates. Nothing says where the watt comes from; where the motor
        gives it, `motor_watt` comes on top.
        """
        with self._calm():
            return self._joined([slopes.sources() for slopes in self._slopes()])

    def inputs(self) -> dict[tuple[str, str], FloatArray]:
        """(kind, place) -> (n_features,) derivative by each value of the settings, SI.

        A number follows the value of its own operating point only: by the value of one point alone the column is
        this one where ``feature.setting`` is that point and zero elsewhere. Kinds: ``speed``, ``torque``,
        ``inlet_temperature``, ``flow``, ``ambient_temperature``; place is the oil stream or empty.
        """
        found: dict[tuple[str, str], list[FloatArray]] = {}
        with self._calm():
            for slopes, setting in zip(self._slopes(), self.settings):
                for key, (moved, step) in _moved_settings(self.case, setting).items():
                    there = slopes.changed(*self._posed(self._rig, moved)).readings
                    found.setdefault(key, []).append((there - slopes.readings) / step)
        standing = np.zeros(len(self.base) - sum(len(part) for part in next(iter(found.values()), [])))
        return {key: np.concatenate([*parts, standing]) for key, parts in found.items()}

    def motor_watt(self) -> FloatArray:
        """(n_features,) what one watt more of the motor changes: its power and torque."""
        speeds = {
            s.name: rig.drive_speed(s.speed)
            for s, rig in zip(self.settings, self._rigs)
            if self.case.drivetrain
        }
        quantity = {channel.name: channel.quantity for channel in self.channels}
        numbers = []
        for feature in self.features:
            of = quantity[feature.channel]
            per_watt = 1.0 if of == "motor_power" else 0.0
            if of == "drive_torque":
                per_watt = 1.0 / speeds[feature.setting]
            numbers.append(per_watt)
        return np.array(numbers)

    def _joined(self, parts: Sequence[Mapping[str, FloatArray]]) -> dict[str, FloatArray]:
        """Numbers of all operating points behind each other, zeros for a name one of them lacks and at rest."""
        names = dict.fromkeys(name for part in parts for name in part)
        sizes = [len(slopes.readings) for slopes in self._slopes()]
        standing = np.zeros(len(self.base) - sum(sizes))
        return {
            name: np.concatenate(
                [*(part.get(name, np.zeros(size)) for part, size in zip(parts, sizes)), standing]
            )
            for name in names
        }

    def _slopes(self) -> list[PointSensitivities]:
        """First-order answers of all points, made when they are first asked for."""
        if self._made_slopes is None:
            directions = (
                directions_of(self._rigs[0], self._points[0], self._housings, self._parts, self._reads)
                if self._points
                else {}
            )
            made = partial(_slopes_at, self._housings, self._parts, self._reads, directions)
            works = [partial(_numbers_at, made, rig, point) for rig, point in zip(self._rigs, self._points)]
            with BackgroundTasks(works) as beside:
                numbers = beside.results()
            self._made_slopes = [
                made(rig, point, known) for rig, point, known in zip(self._rigs, self._points, numbers)
            ]
        return self._made_slopes

    def _posed(self, rig: Rig, setting: OperatingCondition) -> tuple[Rig, OperatingPoint, Bracing | None]:
        """A rig at a setting, braced."""
        here, point = rig_at(rig, setting), operating_point(setting)
        return here, point, self._memory.bracing(here, point)

    def __getstate__(self) -> dict[str, object]:
        """What a worker needs to make the same predictor again: laws of films cannot be sent, numbers can."""
        return {
            "case": self.case,
            "settings": self.settings,
            "channels": self.channels,
            "fidelity": self.fidelity,
            "base": self.base,
            "housings": self._housings.numbers(),
            "feedbacks": [point.last.coupling_state for point in self._points],
        }

    def __setstate__(self, state: Mapping[str, Any]) -> None:
        """Make rig and points again; the numbers of the base are those that were sent."""
        self.case, self.settings, self.channels = state["case"], state["settings"], state["channels"]
        self.fidelity, self.base = state["fidelity"], state["base"]
        self.features = features_of(self.settings, self.channels)
        self._made_slopes = None
        self._known_swings, self._ideal = {}, {}
        self._memory = Memoisation()
        with self._calm():
            self._rig = build_rig(self.case, self.fidelity)
            self._reads = readings(self._rig, self.channels)
            self._housings = ReducedHousings.of_numbers(self._rig, state["housings"])
            self._parts = self._housings.parts(self._memory.parts)
            self._rigs = [rig_at(self._rig, setting) for setting in self.settings]
            self._points = [
                solve_fixed_point(rig, operating_point(setting), self._parts, start=coupling_state)
                for rig, setting, coupling_state in zip(self._rigs, self.settings, state["feedbacks"])
            ]
        self.error = self._housings.error

    def _changed_rigs(self, changes: Changes | Sequence[Changes]) -> list[Rig]:
        """The rig of every operating point under changes."""
        given = [changes] * len(self.settings) if isinstance(changes, Mapping) else list(changes)
        if len(given) != len(self.settings):
            raise UsageError(
                f"{len(given)} changes for {len(self.settings)} operating points; give one for each"
            )
        rigs: dict[int, Rig] = {}
        with self._calm():
            for change in given:
                if id(change) not in rigs:
                    rigs[id(change)] = like(self._rig, changed_case(self.case, change))
        return [rigs[id(change)] for change in given]

    @contextmanager
    def _calm(self) -> Iterator[None]:
        """Errors of the tool, linear algebra on one thread."""
        with solver_errors(self.case), threadpool_limits(limits=1), one_thread():
            yield

    def _sensors(self) -> dict[str, list[Weights]]:
        """Temperature channels by gearbox."""
        found: dict[str, list[Weights]] = {}
        for channel in self.channels:
            if channel.quantity == "temperature":
                name, weights = place_weights(self._rig, channel.place, channel.at)
                found.setdefault(name, []).append(weights)
        return found

    def _states(self) -> dict[str, list[Sequence[Condition]]]:
        """Conditions of every housing after an iteration at the operating points that lie furthest apart."""
        found: dict[str, list[Sequence[Condition]]] = {name: [] for name in self._rig.models}
        for setting in _apart(self.settings, STATES) if found else ():
            rig, point = rig_at(self._rig, setting), operating_point(setting)
            coupling_state = initial_state(rig, point)
            bracing = None if rig.case.drivetrain is None else brace_initial(rig, point, coupling_state)
            done = run_iteration(rig, point, coupling_state, bracing)
            done = run_iteration(rig, point, next_state(rig, done), bracing, done, fine=False)
            for name, field in done.fields.items():
                found[name].append(field.conditions)
        return found

    def _settled_base(self) -> list[SettledPoint]:
        """All operating points, each from the nearest one that is settled."""
        points: list[SettledPoint] = []
        for index, setting in enumerate(self.settings):
            near = min(range(index), key=lambda i: _distance(self.settings[i], setting), default=None)
            start = None if near is None else points[near]
            points.append(solve_fixed_point(self._rigs[index], operating_point(setting), self._parts, start))
        return points

    def _values(
        self, rig: Rig, points: Sequence[SettledPoint], rigs: Sequence[Rig] | None = None
    ) -> FloatArray:
        """(n_features,) numbers of settled points; standing quantities of ``rig``."""
        numbers: list[float] = []
        for index, (setting, point) in enumerate(zip(self.settings, points)):
            here = self._rigs[index] if rigs is None else rig_at(rigs[index], setting)
            for _, read in self._reads:
                numbers += read(here, point)
        return np.array([*numbers, *standing_values(rig, self.channels)])


def _slopes_at(
    housings: ReducedHousings,
    parts: IterationParts,
    reads: Named,
    directions: Mapping[str, Directions],
    rig: Rig,
    point: SettledPoint,
    known: SensitivityNumbers | None = None,
) -> PointSensitivities:
    return PointSensitivities(rig, point, housings, parts, reads, directions, known)


def _numbers_at(
    made: Callable[[Rig, SettledPoint], PointSensitivities], rig: Rig, point: SettledPoint
) -> SensitivityNumbers:
    return made(rig, point).numbers


def _moved_settings(
    case: Case, setting: OperatingCondition
) -> dict[tuple[str, str], tuple[OperatingCondition, float]]:
    """(kind, place) -> the setting with that value moved a little, and by how much."""
    moved: dict[tuple[str, str], tuple[OperatingCondition, float]] = {}
    for kind in ("speed", "torque"):
        step = STEP_SHARE * max(abs(getattr(setting, kind)), 1.0)
        moved[kind, ""] = replace(setting, **{kind: getattr(setting, kind) + step}), step
    for name, box in case.gearboxes.items():
        for stream, feed in ((f"{name}.gear_oil", box.oil), (f"{name}.bearing_oil", box.bearing_oil)):
            inlet = setting.inlet_temperature.get(stream, feed.inlet_temperature)
            inlets = {**setting.inlet_temperature, stream: inlet + STEP_KELVIN}
            moved["inlet_temperature", stream] = replace(setting, inlet_temperature=inlets), STEP_KELVIN
            flow = setting.flow.get(stream, feed.flow)
            flows = {**setting.flow, stream: flow * (1.0 + STEP_SHARE)}
            moved["flow", stream] = replace(setting, flow=flows), flow * STEP_SHARE
    room = case.ambient.temperature if setting.ambient_temperature is None else setting.ambient_temperature
    warmer = replace(setting, ambient_temperature=room + STEP_KELVIN)
    moved["ambient_temperature", ""] = warmer, STEP_KELVIN
    return moved


def _distance(first: OperatingCondition, second: OperatingCondition) -> float:
    """How far two operating points lie apart, for a choice among neighbours."""
    speed = abs(first.speed - second.speed) / max(first.speed, second.speed, 1e-9)
    torque = abs(first.torque - second.torque) / max(abs(first.torque), abs(second.torque), 1e-9)
    feeds = [(first.inlet_temperature, second.inlet_temperature), (first.flow, second.flow)]
    oil = sum(
        abs(one.get(key, other[key]) - other[key]) / abs(other[key]) for one, other in feeds for key in other
    )
    return float(speed + 0.5 * torque + 3.0 * oil)


def _apart(settings: Sequence[OperatingCondition], count: int) -> list[OperatingCondition]:
    """The most severe operating point and those that lie furthest from all chosen before."""
    if not settings:
        return []
    chosen = [max(settings, key=lambda s: (s.speed * abs(s.torque), s.speed))]
    while len(chosen) < min(count, len(settings)):
        chosen.append(max(settings, key=lambda s: min(_distance(c, s) for c in chosen)))
    return chosen
