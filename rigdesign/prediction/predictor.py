"""Many predictions of one rig at the same operating points: base, changed cases, derivatives.

A `Predictor` settles all operating points once with the reduced thermal model and keeps what neighbouring cases can
use. A changed case is settled anew from there with the same passes; what a change leaves alone is not computed
twice.
"""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from threadpoolctl import threadpool_limits

from rigdesign.case.model import Case
from rigdesign.cold import cold_feedback
from rigdesign.errors import UsageError
from rigdesign.loads import brace_cold
from rigdesign.passes import Parts, feedback_of, one_pass
from rigdesign.prediction.changes import Changes, changed_case
from rigdesign.prediction.full import check_names, standing_values
from rigdesign.prediction.housings import ReducedHousings
from rigdesign.prediction.model import Channel, Setting, features_of
from rigdesign.prediction.operating import like, operating_point, rig_at
from rigdesign.prediction.readings import readings
from rigdesign.prediction.settle import SettledPoint, settle
from rigdesign.results import Fidelity
from rigdesign.rig.model import Rig, build_rig
from rigdesign.run import solver_errors
from thermal.condition_checks import Condition
from thermal.fe.kernels import one_thread
from thermal.fe.mesh import FloatArray

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
        settings: Iterable[Setting],
        channels: Iterable[Channel],
        *,
        fidelity: Fidelity = "quick",
    ) -> None:
        self.case, self.settings, self.channels = case, tuple(settings), tuple(channels)
        self.fidelity: Fidelity = fidelity
        check_names(self.settings, self.channels)
        self.features = features_of(self.settings, self.channels)
        with solver_errors(case), threadpool_limits(limits=1), one_thread():
            self._rig = build_rig(case, fidelity)
            self._reads = readings(self._rig, self.channels)
            self._housings = ReducedHousings(self._rig, self._states())
            self._parts = self._housings.parts(Parts())
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
            A point that does not settle.
        """
        given = [changes] * len(self.settings) if isinstance(changes, Mapping) else list(changes)
        if len(given) != len(self.settings):
            raise UsageError(
                f"{len(given)} changes for {len(self.settings)} operating points; give one for each"
            )
        with solver_errors(self.case), threadpool_limits(limits=1), one_thread():
            rigs: dict[int, Rig] = {}
            made: list[Rig] = []
            for change in given:
                if id(change) not in rigs:
                    rigs[id(change)] = like(self._rig, changed_case(self.case, change))
                made.append(rigs[id(change)])
            points = [
                settle(rig_at(rig, setting), operating_point(setting), self._parts, near)
                for rig, setting, near in zip(made, self.settings, self._points)
            ]
            return self._values(made[0] if made else self._rig, points, made)

    def _states(self) -> dict[str, list[Sequence[Condition]]]:
        """Conditions of every housing after a pass at the operating points that lie furthest apart."""
        found: dict[str, list[Sequence[Condition]]] = {name: [] for name in self._rig.models}
        for setting in _apart(self.settings, STATES) if found else ():
            rig, point = rig_at(self._rig, setting), operating_point(setting)
            feedback = cold_feedback(rig, point)
            bracing = None if rig.case.drivetrain is None else brace_cold(rig, point, feedback)
            done = one_pass(rig, point, feedback, bracing)
            done = one_pass(rig, point, feedback_of(rig, done), bracing, done, fine=False)
            for name, field in done.fields.items():
                found[name].append(field.conditions)
        return found

    def _settled_base(self) -> list[SettledPoint]:
        """All operating points, each from the nearest one that is settled."""
        points: list[SettledPoint] = []
        for index, setting in enumerate(self.settings):
            near = min(range(index), key=lambda i: _distance(self.settings[i], setting), default=None)
            start = None if near is None else points[near]
            points.append(settle(rig_at(self._rig, setting), operating_point(setting), self._parts, start))
        return points

    def _values(
        self, rig: Rig, points: Sequence[SettledPoint], rigs: Sequence[Rig] | None = None
    ) -> FloatArray:
        """(n_features,) numbers of settled points; standing quantities of ``rig``."""
        numbers: list[float] = []
        for index, (setting, point) in enumerate(zip(self.settings, points)):
            here = rig_at(rig if rigs is None else rigs[index], setting)
            for _, read in self._reads:
                numbers += read(here, point)
        return np.array([*numbers, *standing_values(rig, self.channels)])


def _distance(first: Setting, second: Setting) -> float:
    """How far two operating points lie apart, for a choice among neighbours."""
    speed = abs(first.speed - second.speed) / max(first.speed, second.speed, 1e-9)
    torque = abs(first.torque - second.torque) / max(abs(first.torque), abs(second.torque), 1e-9)
    feeds = [(first.inlet_temperature, second.inlet_temperature), (first.flow, second.flow)]
    oil = sum(
        abs(one.get(key, other[key]) - other[key]) / abs(other[key]) for one, other in feeds for key in other
    )
    return float(speed + 0.5 * torque + 3.0 * oil)


def _apart(settings: Sequence[Setting], count: int) -> list[Setting]:
    """The most severe operating point and those that lie furthest from all chosen before."""
    if not settings:
        return []
    chosen = [max(settings, key=lambda s: (s.speed * abs(s.torque), s.speed))]
    while len(chosen) < min(count, len(settings)):
        chosen.append(max(settings, key=lambda s: min(_distance(c, s) for c in chosen)))
    return chosen
