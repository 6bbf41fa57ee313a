"""The residual of root gauges by mode over the face: a tilt that fades with torque says more than four gauges."""

from typing import Any

import numpy as np

from rigdesign.diagnosis.document.outcome import Outcome
from rigdesign.diagnosis.residual.gauge_modes import gauge_rows

LEAST_GAUGES = 2
"""Gauges of a gear from which there is more than one mode."""


def gauge_mode_rows(outcome: Outcome) -> list[dict[str, Any]]:
    """By gear, window, point and mode: measured less simulated, and over what a healthy rig leaves.

    ``residual_um_per_m`` is the root mean square over the gauges of that mode, positive for tilt where the gauges to
    the rear read more than simulated; ``deviations`` is it over its standard deviation in a healthy rig.
    """
    found = outcome.result.diagnosis
    residuals = outcome.result.problem.residuals
    features = [residuals.features[row] for row in found.kept]
    matrix = found.covariance.matrix
    rows = []
    for one in gauge_rows(features, residuals.channels):
        at = np.array(one.rows, dtype=np.intp)
        if len(at) < LEAST_GAUGES:
            continue
        for mode, shape in one.shapes.items():
            size = float(shape @ found.residual[at])
            spread = float(np.sqrt(shape @ matrix[np.ix_(at, at)] @ shape))
            rows.append(
                {
                    "gear": one.gear, "window": one.window, "point": one.point, "mode": mode,
                    "residual_um_per_m": 1e6 * size / float(np.sqrt(len(at))), "deviations": size / spread,
                }
            )  # fmt: skip
    return rows
