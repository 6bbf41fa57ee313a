"""A set to be explained and its residual where a healthy rig is white noise."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rigdesign.diagnosis.decision.defaults import Calibration
from rigdesign.diagnosis.residual.baseline import Change, differenced
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem, plain
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.covariance import Whitened

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
