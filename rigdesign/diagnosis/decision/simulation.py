"""Readings that do not exist yet, simulated with an explanation as the truth, and what a diagnosis makes of them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rigdesign.diagnosis.decision.competing_causes import Leading
from rigdesign.diagnosis.decision.defaults import Calibration
from rigdesign.diagnosis.decision.problem import Problem
from rigdesign.diagnosis.decision.workflow import diagnose
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.next_measurement import Foreseen

SEED = 20
"""Of the noise that is drawn."""


@dataclass(frozen=True, kw_only=True)
class Simulation:
    """A set with further measurements, read as each rival foresees.

    whole : numbers of the set, then all that could be read; measured : how many are the set's
    mean : (n + m,) residual of a healthy rig; rows : of the candidates (m,) that are read
    """

    problem: Problem
    whole: ResidualProblem
    measured: int
    mean: Array
    foreseen: Foreseen
    rows: tuple[int, ...]

    def verified(
        self, explanations: Sequence[Leading], calibration: Calibration
    ) -> tuple[tuple[str, bool], ...]:
        """Explanation -> whether the diagnosis of its simulated readings names it, or locates what has no name."""
        return tuple(
            (one.name, one.ends(diagnose(replace(self.problem, residuals=self._read(number)), calibration)))
            for number, one in enumerate(explanations)
        )

    def _read(self, number: int) -> ResidualProblem:
        """The set with the further readings as one rival foresees them, with their scatter."""
        at = np.array(self.rows, dtype=np.intp)
        scatter = np.linalg.cholesky(self.foreseen.left[np.ix_(at, at)])
        drawn = scatter @ np.random.default_rng(SEED + number).normal(size=len(at))
        places = [*range(self.measured), *(self.measured + at)]
        cut = self.whole.rows(places)
        new = (
            (self.whole.library.base + self.mean)[self.measured + at]
            + self.foreseen.values[number][at]
            + drawn
        )
        points = {feature.setting for feature in cut.features}
        run = tuple(one for one in cut.library.settings if one.name in points)
        inputs = {key: column for key, column in cut.library.inputs.items() if key[2] in points}
        return replace(
            cut,
            values=np.concatenate([self.whole.values[: self.measured], new]),
            library=replace(cut.library, settings=run, inputs=inputs),
        )
