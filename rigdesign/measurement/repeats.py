"""Noise from repeats: pooled over the operating points of a series, beside what the set declares."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from rigdesign.measurement.model import Finding, MeasuredChannel
from rigdesign.prediction.model import Feature

Readings = Mapping[Feature, NDArray[np.float64]]

DECLARED_WEIGHT = 4.0
"""Degrees of freedom the declared uncertainty counts for beside repeats."""
OUTLIER = 8.0
"""Distance from the median of its repeats, in standard deviations, from which a reading is thrown out."""
MAD_TO_SD = 1.4826
"""Standard deviation of a normal distribution over its median absolute deviation."""


def pooled_noise(readings: Readings, channels: Mapping[str, MeasuredChannel]) -> dict[Feature, float]:
    """Standard deviation of one reading by feature.

    A series is a channel, of orders one order with both its parts. Its variance is that of the repeats about
    their means, pooled over all operating points, with the declared one as ``DECLARED_WEIGHT`` further
    degrees of freedom (a conjugate prior); a declared zero counts for nothing.
    """
    squares: dict[tuple[str, float], float] = {}
    freedom: dict[tuple[str, float], float] = {}
    for feature, values in readings.items():
        finite = values[np.isfinite(values)]
        series = (feature.channel, feature.order)
        if finite.size > 1:
            squares[series] = squares.get(series, 0.0) + float(np.sum((finite - finite.mean()) ** 2))
            freedom[series] = freedom.get(series, 0.0) + finite.size - 1
    return {
        feature: _pooled(
            channels[feature.channel].noise,
            squares.get((feature.channel, feature.order), 0.0),
            freedom.get((feature.channel, feature.order), 0.0),
        )
        for feature in readings
    }


def without_outliers(
    readings: Readings, channels: Mapping[str, MeasuredChannel]
) -> tuple[dict[Feature, NDArray[np.float64]], list[Finding]]:
    """The readings with those far off the median of three or more repeats taken out."""
    deviations: dict[tuple[str, float], list[NDArray[np.float64]]] = {}
    for feature, values in readings.items():
        finite = values[np.isfinite(values)]
        if finite.size >= 3:
            deviations.setdefault((feature.channel, feature.order), []).append(
                np.abs(finite - np.median(finite))
            )
    clean, findings = {}, []
    for feature, values in readings.items():
        clean[feature] = values
        found = deviations.get((feature.channel, feature.order))
        if found is None or np.count_nonzero(np.isfinite(values)) < 3:
            continue
        scatter = max(MAD_TO_SD * float(np.median(np.concatenate(found))), channels[feature.channel].noise)
        far = np.abs(values - np.nanmedian(values)) > OUTLIER * scatter
        if scatter > 0.0 and far.any():
            clean[feature] = np.where(far, np.nan, values)
            order = f", order {feature.order:g}" if feature.part != "value" else ""
            findings.append(
                Finding(
                    id="repeat_outlier", weight="dropped", channels=(feature.channel,),
                    points=(feature.setting,) if feature.setting else (),
                    text=f"{feature.channel} at {feature.setting or 'standstill'}{order}: repeat "
                    f"{', '.join(str(i + 1) for i in np.flatnonzero(far))} lies more than {OUTLIER:g} standard "
                    "deviations off the others and is not used",
                )
            )  # fmt: skip
    return clean, findings


def _pooled(declared: float, squares: float, freedom: float) -> float:
    weight = DECLARED_WEIGHT if declared > 0.0 else 0.0
    whole = weight + freedom
    return float(np.sqrt((weight * declared**2 + squares) / whole)) if whole else 0.0
