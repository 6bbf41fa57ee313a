"""What effects at given sizes do on the points held out: by the stored runs, and by the full model run again.

The stored runs of a library answer to first order and by a reduced thermal model. What is reported is the answer of the
full model: the case as it is and the case with the effects in it, both solved as a check solves them, at the points and
for the sensors in question; the difference is what the effects add.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.parallel import BackgroundTasks
from rigdesign.case.model import Case
from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.decision.defaults import Calibration
from rigdesign.diagnosis.decision.naming import Names
from rigdesign.diagnosis.decision.patch import Fitted, patched_case
from rigdesign.diagnosis.residual.baseline import Change, differenced
from rigdesign.diagnosis.residual.hypotheses import physical, sensor
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem, plain
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.covariance import Covariance, Whitened
from rigdesign.diagnosis.statistics.detectability import SEEN
from rigdesign.diagnosis.statistics.heldout import Gap, gap
from rigdesign.prediction.model import Channel, Feature, OperatingCondition, measured_against
from rigdesign.prediction.predict import predict

# A set to be explained and its residual where a healthy rig is white noise.

Tier = Literal["heat", "rotation", "rotation_and_meshes", "all"]
"""Numbers of a search: temperatures, powers and mean torques; what oscillates and the rig at rest, without the orders
of the meshes, whose amplitudes no model knows well, or with them; all."""


def of_tier(residuals: ResidualProblem, tier: Tier) -> NDArray[np.bool_]:
    """(n,) whether a number belongs to a tier."""
    match tier:
        case "heat":
            return residuals.of_heat
        case "rotation":
            return ~residuals.of_heat & ~residuals.of_mesh
        case "rotation_and_meshes":
            return ~residuals.of_heat
        case "all":
            return np.ones(len(residuals.features), dtype=bool)


@dataclass(frozen=True, kw_only=True)
class Problem:
    """A set to be explained, with a healthy one of the same rig if there is one.

    seed : fixes the held-out points, the hash of the measurement
    repeated : the noise is known from repeats
    """

    residuals: ResidualProblem
    baseline: ResidualProblem | None
    seed: str
    repeated: bool

    def space(self, calibration: Calibration) -> Whitened:
        """Of all its numbers: against the model, or given the baseline."""
        if self.baseline is None:
            return plain(self.residuals, calibration.alone, calibration.inflation)
        return differenced(self.residuals, self.baseline, calibration.amplitudes, calibration.drift)

    def healthy(self, residuals: ResidualProblem, calibration: Calibration) -> tuple[Array, Array]:
        """Mean (n,) and covariance (n, n) of the residual of numbers of this rig while it is healthy."""
        if self.baseline is None:
            covariance = residuals.covariance(calibration.alone, calibration.inflation)
            return np.zeros(len(residuals.features)), covariance.matrix
        change = Change.of(residuals, self.baseline, calibration.amplitudes)
        return change.expected, change.covariance(calibration.drift)

    def cut(
        self, space: Whitened, residuals: ResidualProblem, rows: Sequence[int], calibration: Calibration
    ) -> Whitened:
        """The space of some of the numbers of ``space``: ``rows`` of it, which are ``residuals``.

        What a baseline foretells of a number does not depend on the others of the set; where constants are bent to the
        data it does.
        """
        if self.baseline is None:
            return plain(residuals, calibration.alone, calibration.inflation)
        return space.rows(rows)


Sizes = Mapping[str, tuple[float, ...]]
"""Explanation, with tooth or order -> coordinates."""


class Rerun(Protocol):
    """The model once more, with effects of the catalogue at their sizes in it."""

    def __call__(self, features: Sequence[Feature], sizes: Sizes) -> Array:
        """(n,) what the effects add to these numbers [SI].

        Raises RigdesignError where the case with the effects is refused or does not converge.
        """


@dataclass(frozen=True, kw_only=True)
class FullRun:
    """The full model of a case at the operating points and for the sensors of a set; ``say`` is called before a run."""

    case: Case
    settings: tuple[OperatingCondition, ...]
    channels: tuple[Channel, ...]
    effects: tuple[Effect, ...]
    say: Callable[[str], None] = lambda message: None

    def __call__(self, features: Sequence[Feature], sizes: Sizes) -> Array:
        """(n,) prediction of the case with the effects less that of the case as it is; sizes as a patch writes them.

        Raises RigdesignError as `predict`.
        """
        names = Names(self.effects, ())
        sized = [names.sized(name, size, [(value, value) for value in size]) for name, size in sizes.items()]
        fitted = [
            Fitted(effect=estimate.entry, values=estimate.values, tooth=estimate.tooth)
            for estimate in sized
            if isinstance(estimate.entry, Effect)
        ]
        points = {feature.setting for feature in features}
        sensors = {feature.channel for feature in features}
        settings = [setting for setting in self.settings if setting.name in points]
        channels = [channel for channel in self.channels if channel.name in sensors]
        cases = (self.case, patched_case(self.case, fitted))
        self.say(
            f"full model at {', '.join(setting.name for setting in settings)}, without and with {' and '.join(sizes)}"
        )
        with BackgroundTasks(
            [partial(predict, case, settings, channels, circuit=measured_against(channels)) for case in cases]
        ) as tasks:
            before, after = tasks.results()
        place = {feature: row for row, feature in enumerate(before.features)}
        rows = np.array([place[feature] for feature in features], dtype=np.intp)
        return np.asarray((after.values - before.values)[rows])


@dataclass(frozen=True, kw_only=True)
class Proof:
    """What effects are held against: numbers of points that no fit has seen.

    residuals, whole : all numbers that were kept, and their residual where a healthy rig is white noise; points : kept
        aside; tier : numbers that count there; rerun : None leaves it at the stored runs
    """

    residuals: ResidualProblem
    whole: Whitened
    points: tuple[str, ...]
    tier: Tier = "all"
    rerun: Rerun | None = None
    _covariances: dict[tuple[int, ...], Covariance] = field(default_factory=dict, repr=False)

    @cached_property
    def rows(self) -> NDArray[np.intp]:
        """Places of the numbers at the points held out."""
        aside = set(self.points)
        rows = [row for row, feature in enumerate(self.residuals.features) if feature.setting in aside]
        return np.array(rows, dtype=np.intp)

    def stored(self, sizes: Sizes) -> Array:
        """(n,) what effects and sensors at these sizes add to all kept numbers, by the stored runs."""
        residuals = self.residuals
        entries = {Names(residuals.effects, residuals.errors).plain(name) for name in sizes}
        known = [effect for effect in residuals.effects if effect.name in entries]
        errors = [error for error in residuals.errors if error.name in entries]
        effects = physical(
            None, residuals.features, known, residuals.library.responses, residuals.teeth_a_turn, 0.0
        )
        answer = np.zeros(len(residuals.features))
        for hypothesis in (*effects, *sensor(None, errors)):
            if hypothesis.name not in sizes:
                continue
            size = np.array(sizes[hypothesis.name])
            if hypothesis.curve is not None:
                answer += hypothesis.curve.at(size)[0]
            elif hypothesis.columns.size:
                answer += hypothesis.columns @ size
        return answer

    def again(self, sizes: Sizes) -> Array:
        """(n,) the same with the full model run again at the points held out; sensors have no other answer.

        Raises RigdesignError as `Rerun`.
        """
        answer = self.stored(sizes)
        effects = {effect.name for effect in self.residuals.effects}
        names = Names(self.residuals.effects, ())
        of_case = {name: size for name, size in sizes.items() if names.plain(name) in effects}
        if of_case and self.rerun is not None:
            of_sensors = {name: size for name, size in sizes.items() if name not in of_case}
            features = [self.residuals.features[row] for row in self.rows]
            answer[self.rows] = self.rerun(features, of_case) + self.stored(of_sensors)[self.rows]
        return answer

    def gap(self, answer: Array, given: Array | None = None) -> Gap:
        """The gap without and with an answer (n,); ``given`` (n,) is in the model both times.

        Where the numbers that decide hardly show the answer, orders of the meshes are asked as well.
        """
        residual = self.whole.raw if given is None else self.whole.raw - given
        rows = self._deciding
        if not len(rows) or self.seen(answer, rows) < SEEN:
            rows = self.rows
        quantities = [self.residuals.channels[self.residuals.features[row].channel].quantity for row in rows]
        covariance = self._covariance(tuple(rows.tolist()))
        return gap(
            covariance, residual[rows], answer[rows], self.residuals.noise[rows], quantities, self.points
        )

    def seen(self, answer: Array, rows: NDArray[np.intp] | None = None) -> float:
        """Whitened length of an answer (n,) at the points held out."""
        rows = self.rows if rows is None else rows
        return float(np.linalg.norm(self._covariance(tuple(rows.tolist())).whiten(answer[rows])))

    @cached_property
    def _deciding(self) -> NDArray[np.intp]:
        return self.rows[of_tier(self.residuals, self.tier)[self.rows]]

    def _covariance(self, rows: tuple[int, ...]) -> Covariance:
        if rows not in self._covariances:
            matrix = self.whole.covariance.matrix[np.ix_(rows, rows)]
            self._covariances[rows] = Covariance(base=matrix, columns=(), amplitudes={})
        return self._covariances[rows]
