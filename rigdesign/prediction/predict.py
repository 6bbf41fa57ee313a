"""What the sensors of a rig would read, by the full thermal model or the reduced one."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import Any, Literal, TypeVar

import numpy as np
from threadpoolctl import threadpool_limits

from dynamics.rotor.damped_modes import NamedMode
from dynamics.rotor.torsional_modes import SEEN_GAIN
from dynamics.vibration.deviation_response import linearised
from dynamics.vibration.hill_system import MeshPeriodic
from rigdesign.base.errors import UsageError
from rigdesign.base.fidelity import Fidelity
from rigdesign.case.model import Case
from rigdesign.coupling.preloaded_loop import shifted_laws
from rigdesign.prediction.converged_point import TOLERANCE, ConvergedPoint, converge_point
from rigdesign.prediction.full import check_names, like, predict_full, rig_at
from rigdesign.prediction.memoisation import Memoisation
from rigdesign.prediction.model import (
    ORDER_QUANTITIES,
    OWN_MODEL,
    Changes,
    Channel,
    Feature,
    OperatingCondition,
    Prediction,
    PredictionModel,
    changed_case,
    features_of,
    only_warming,
)
from rigdesign.prediction.order_motion import ideal_response, is_ideal, shaft_orders
from rigdesign.prediction.reduced_rig import FirstOrderModel, ReducedRig
from rigdesign.prediction.static_tests import loaded_modes, standing_modes
from rigdesign.rig.model import Rig
from rigdesign.run.solver_errors import solver_errors
from thermal.fe.kernels import one_thread
from thermal.fe.mesh import FloatArray

Thermal = Literal["full", "reduced"]
"""Temperature fields by the finite-element model of a check, or by its projection on a reduced basis."""


def predict(
    case: Case,
    settings: Iterable[OperatingCondition],
    channels: Iterable[Channel],
    *,
    model: Thermal = "full",
    circuit: PredictionModel = OWN_MODEL,
    fidelity: Fidelity = "quick",
) -> Prediction:
    """What the channels would read at the operating points of a measurement.

    The solve of a point is that of ``run_case``: the full model at a dwell of the schedule gives what a check with the
    same shafts and teeth gives. Every point starts from the one before, as in a check.

    Parameters
    ----------
    case : from `load_case`
    settings, channels : operating points as run, sensors as the model sees them; see `rigdesign.prediction.model`
    model : the full thermal model, or the reduced one of `Predictor` with its stated error
    circuit : shafts and teeth of the power circuit; left out, the shafts of the case
    fidelity : size of the models

    Raises
    ------
    UsageError
        A place, stream or quantity the case does not have; two settings or channels of one name.
    CaseError, NotConvergedError, MissingLibraryError
        As ``run_case``.
    """
    settings, channels = tuple(settings), tuple(channels)
    if model == "full":
        return predict_full(case, settings, channels, fidelity, circuit)
    predictor = Predictor(case, settings, channels, circuit=circuit, fidelity=fidelity)
    return Prediction(features=predictor.features, values=predictor.base, error=predictor.error)


# Many predictions of one rig at the same operating points: base, changed cases, derivatives.
#
# A `Predictor` converges all operating points once with the reduced thermal model and keeps what neighbouring cases can
# use. A changed case starts from there with the same iterations; what a change leaves alone is not computed twice.

K = TypeVar("K")

NEAR = 0.1
"""Last step of the loop, in units of `state_vector.SCALES`, that is corrected to first order: 0.1 K, 0.1 um, 1 W."""


class Predictor:
    """Predictions at fixed operating points and channels, for many cases near one.

    Parameters
    ----------
    case, settings, channels : as `predict`
    circuit : shafts and teeth of the power circuit; left out, the shafts of the case
    fidelity : size of the models

    Attributes
    ----------
    features : the numbers in their order
    base : (n_features,) prediction for the case as it stands
    error : largest error of a temperature of the reduced model against the full one [K], found on changed
        conditions that did not enter its basis

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
        circuit: PredictionModel = OWN_MODEL,
        fidelity: Fidelity = "quick",
    ) -> None:
        self.case, self.settings, self.channels = case, tuple(settings), tuple(channels)
        self.circuit, self.fidelity = circuit, fidelity
        check_names(self.settings, self.channels)
        self.features = features_of(self.settings, self.channels)
        if not self.settings:
            raise UsageError("no operating points; give one setting at least")
        _require_held_sumps(case)
        _require_no_own_fluids(case)
        with self._solving():
            self._reduced = ReducedRig(case, self.settings, self.channels, circuit, fidelity)
            self._points = self._reduced.converged_base()
            self.base = self._reduced.values(self._reduced.stated, self._reduced.rigs, self._points)
        self._start()

    def _start(self) -> None:
        """What is made when it is first asked for."""
        self.error = self._reduced.housings.error
        self._first_order = FirstOrderModel(self._reduced, self._points)
        self._oscillating = [
            OscillatingPart(
                point,
                self.channels,
                [feature for feature in features_of((setting,), self.channels) if feature.setting],
                self._reduced.memoisation,
            )
            for point, setting in zip(self._points, self.settings)
        ]

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
        with self._solving():
            known = self._first_order.known
            problems = [
                self._reduced.problem(rig_at(rig, setting), setting)
                for rig, setting in zip(made, self.settings)
            ]
            points = [
                converge_point(
                    problem,
                    near,
                    None if known is None else known[number].inverse,
                    tolerance=TOLERANCE if known is None else NEAR,
                )
                for number, (problem, near) in enumerate(zip(problems, self._points))
            ]
            found = self._reduced.values(made[0], [problem.rig for problem in problems], points)
            if known is not None:
                last = np.concatenate([own.corrected(point) for own, point in zip(known, points)])
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
        if only_warming(changes) and self._reduced.housings.bases:
            with self._solving():
                warm = self._first_order.warming([rig.case.ambient.warming_time for rig in made])
                return np.concatenate([*warm, self.base[sum(map(len, warm)) :]])
        with self._solving():
            changed = [
                point.changed(self._reduced.changed_problem(rig, setting))
                for point, rig, setting in zip(self._first_order.points, made, self.settings)
            ]
            numbers = [found.readings for found in changed]
            rest = sum(map(len, numbers))
            if all(found.same_loop for found in changed):
                return np.concatenate([*numbers, self.base[rest:]])
            return np.concatenate([*numbers, self._reduced.standing_values(made[0])])

    def oscillating(self, changes: Changes) -> FloatArray:
        """(n_features,) linear prediction for a case whose change only oscillates: waves over the teeth, torques.

        Such a change has no mean over a turn, so that losses, temperatures and means stay; orders alone are solved.

        Root gauges follow their own tooth through the turn: with them the response is that of any change.

        changes : as `values`, for all operating points
        """
        if any(channel.quantity == "root_strain" for channel in self.channels):
            return self.response(changes)
        made = self._changed_rigs(changes)
        found = self.base.copy()
        start = 0
        with self._solving():
            for part, rig, setting in zip(self._oscillating, made, self.settings):
                moved = part.numbers(rig_at(rig, setting)) - part.base()
                found[start : start + len(moved)] += moved
                start += len(moved)
        return found

    def prepare(self) -> None:
        """Make what first-order predictions of all points need; on all cores."""
        with self._solving():
            _ = self._first_order.points
            if any(channel.quantity in ORDER_QUANTITIES for channel in self.channels):
                for part in self._oscillating:
                    part.base()

    def natural_frequencies(self) -> FloatArray:
        """(k,) near which the orders of a torque are steep, rising [rad/s]; none without a drivetrain.

        Of shafts that only twist all of the rig at rest; of shafts that bend those of the loop under the most torque of
        all operating points, torsional ones and any other that a mesh excites by `SEEN_GAIN` or more.
        """
        stated = self._reduced.stated
        if stated.case.drivetrain is None:
            return np.zeros(0)
        with self._solving():
            if stated.shaft_model == "torsional":
                modes = list(standing_modes(stated))
            else:
                point = max(self._points, key=lambda one: (abs(one.last.point.torque), one.last.point.speed))
                modes = [one for one in loaded_modes(point.problem.rig, point.last.loop) if _excited(one)]
            return np.array([2.0 * np.pi * mode.frequency for mode in modes])

    def links(self) -> dict[str, FloatArray]:
        """Name -> (n_features,) derivative by the logarithm of every local conductance of the housings.

        Names: ``film:``, ``bearing_film:``, ``radiation:`` gearbox.surface; ``exchange:``, ``contact:``
        gearbox.surface|surface; ``enclosure:`` gearbox.enclosure. The conductance changes at all operating points
        together.
        """
        if not self._reduced.housings.bases:
            return {}
        with self._solving():
            return self._joined(self._first_order.links())

    def sources(self) -> dict[str, FloatArray]:
        """Name -> (n_features,) response per watt [1/W] put in at all operating points.

        Names: ``body:`` gearbox.body, ``rim:`` gearbox.gear, ``bore:`` and ``film:`` gearbox.bearing, ``oil:``
        stream, ``near:`` thermocouple by its coordinates. Nothing says where the watt comes from; where the motor
        gives it, `motor_watt` comes on top.
        """
        with self._solving():
            return self._joined(self._first_order.sources())

    def inputs(self) -> dict[tuple[str, str], FloatArray]:
        """(kind, place) -> (n_features,) derivative by each value of the settings, SI.

        A number follows the value of its own operating point only: by the value of one point alone the column is
        this one where ``feature.setting`` is that point and zero elsewhere. Kinds: ``speed``, ``torque``,
        ``inlet_temperature``, ``flow``, ``ambient_temperature``; place is the oil stream or empty.
        """
        with self._solving():
            return self._joined(self._first_order.inputs(self.case))

    def motor_watt(self) -> FloatArray:
        """(n_features,) what one watt more of the motor changes: its power and torque."""
        speeds = {
            s.name: rig.drive_speed(s.speed)
            for s, rig in zip(self.settings, self._reduced.rigs)
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

    def _joined(self, parts: Sequence[Mapping[K, FloatArray]]) -> dict[K, FloatArray]:
        """Numbers of all operating points behind each other, zeros for a name one of them lacks and at rest."""
        names = dict.fromkeys(name for part in parts for name in part)
        sizes = [len(point.readings) for point in self._first_order.points]
        standing = np.zeros(len(self.base) - sum(sizes))
        return {
            name: np.concatenate(
                [*(part.get(name, np.zeros(size)) for part, size in zip(parts, sizes)), standing]
            )
            for name in names
        }

    def __getstate__(self) -> dict[str, object]:
        """What a worker needs to make the same predictor again: laws of films cannot be sent, numbers can."""
        return {
            "case": self.case,
            "settings": self.settings,
            "channels": self.channels,
            "circuit": self.circuit,
            "fidelity": self.fidelity,
            "base": self.base,
            "housings": self._reduced.housings.numbers(),
            "coupling_states": [point.last.coupling_state for point in self._points],
        }

    def __setstate__(self, state: Mapping[str, Any]) -> None:
        """Make rig and points again; the numbers of the base are those that were sent."""
        self.case, self.settings, self.channels = state["case"], state["settings"], state["channels"]
        self.circuit, self.fidelity, self.base = state["circuit"], state["fidelity"], state["base"]
        self.features = features_of(self.settings, self.channels)
        with self._solving():
            self._reduced = ReducedRig(
                self.case, self.settings, self.channels, self.circuit, self.fidelity, state["housings"]
            )
            self._points = self._reduced.converged_base(state["coupling_states"])
        self._start()

    def _changed_rigs(self, changes: Changes | Sequence[Changes]) -> list[Rig]:
        """The rig of every operating point under changes."""
        given = [changes] * len(self.settings) if isinstance(changes, Mapping) else list(changes)
        if len(given) != len(self.settings):
            raise UsageError(
                f"{len(given)} changes for {len(self.settings)} operating points; give one for each"
            )
        rigs: dict[int, Rig] = {}
        with self._solving():
            for change in given:
                if id(change) not in rigs:
                    rigs[id(change)] = like(self._reduced.stated, changed_case(self.case, change))
        return [rigs[id(change)] for change in given]

    @contextmanager
    def _solving(self) -> Iterator[None]:
        """Errors of the tool, linear algebra on one thread."""
        with solver_errors(self.case), threadpool_limits(limits=1), one_thread():
            yield


def _excited(mode: NamedMode) -> bool:
    """Whether orders of torque rise near a mode."""
    return mode.name.startswith("torsional ") or mode.mesh_gain >= SEEN_GAIN


def _require_no_own_fluids(case: Case) -> None:
    """Volumes and streams of a housing are unknowns that the reduced model does not have."""
    for name, box in case.gearboxes.items():
        for kind in ("volumes", "streams") if box.housing is not None else ():
            if fluids := getattr(box.housing, kind):
                raise UsageError(
                    f"gearboxes.{name}.housing.{kind} = {', '.join(fluids)}: the model that measured data are held "
                    "against takes films to room air and oils only; for it give the films of these surfaces a measured "
                    'fluid_temperature with fluid = "ambient", and leave the table out'
                )


def _require_held_sumps(case: Case) -> None:
    """The reduced model knows the temperature of every oil that wets a housing."""
    for name, box in case.gearboxes.items():
        if box.housing is not None and box.gear_oil_temperature is None:
            raise UsageError(
                f"gearboxes.{name}.oil.sump_temperature is left out: the model that measured data are held against "
                'needs it; state the measured one, e.g. sump_temperature = "90 degC"'
            )


# Orders of a rig whose change only oscillates: mean torques, losses and temperatures stay those of the base.

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
