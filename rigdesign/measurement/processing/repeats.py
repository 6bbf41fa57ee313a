"""Noise from repeats: pooled over the operating points of a series, and the declared uncertainty."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from rigdesign.measurement.reading.measurement_set import DataFinding, MeasuredChannel
from rigdesign.prediction.model import Feature

Readings = Mapping[Feature, NDArray[np.float64]]

DECLARED_WEIGHT = 4.0
"""Degrees of freedom the declared uncertainty counts for in addition to repeats."""
OUTLIER = 8.0
"""Distance from the median of its repeats, in standard deviations, from which a reading is thrown out."""
LEAST_PAIRS = 3
"""Operating points with two repeats from which their scatter is known, even if one of them is wrong."""
MAD_TO_SD = 1.4826
"""Standard deviation of a normal distribution over its median absolute deviation."""


def pooled_noise(readings: Readings, channels: Mapping[str, MeasuredChannel]) -> dict[Feature, float]:
    """Standard deviation of one reading by feature; of readings without outliers (`without_outliers`).

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
) -> tuple[dict[Feature, NDArray[np.float64]], list[DataFinding]]:
    """The readings without those far off their repeats.

    Of three or more repeats the one that is far off goes. Of two that are far apart either may be wrong: neither is
    used. Two repeats at fewer than ``LEAST_PAIRS`` operating points do not tell how far repeats lie apart; they stay,
    suspected.
    """
    scatters = _scatters(readings)
    clean, findings = {}, []
    for feature, values in readings.items():
        clean[feature] = values
        channel = channels[feature.channel]
        finite = np.isfinite(values)
        count = np.count_nonzero(finite)
        if count < 2:
            continue
        scatter, known = scatters[feature.channel, feature.order]
        scale = max(scatter if known else 0.0, channel.noise)
        far = np.zeros(len(values), dtype=bool)
        far[finite] = _deviations(values[finite]) > OUTLIER * scale
        if not (scale > 0.0 and far.any()):
            continue
        order = f", order {feature.order:g}" if feature.part != "value" else ""
        where = f"{feature.channel} at {feature.setting or 'static tests'}{order}"
        points = (feature.setting,) if feature.setting else ()
        numbers = ", ".join(str(i + 1) for i in np.flatnonzero(far))
        if known:
            clean[feature] = np.where(far, np.nan, values)
            what = f"repeat {numbers} lies more than {OUTLIER:g} standard deviations off the others and is not used"
            if count == 2:
                what = (
                    f"repeats {numbers} lie more than {OUTLIER:g} standard deviations apart; neither is used"
                )
            findings.append(
                DataFinding(id="repeat_outlier", weight="dropped", channels=(feature.channel,), points=points,
                        text=f"{where}: {what}; measure again")
            )  # fmt: skip
        else:
            findings.append(
                DataFinding(id="repeats_apart", weight="suspect", channels=(feature.channel,), points=points,
                        text=f"{where}: repeats {numbers} lie more than {OUTLIER:g} declared standard deviations "
                        "apart; measure a third time")
            )  # fmt: skip
    return clean, findings


def _deviations(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) distance of repeats from their median, as large as if the true value were known instead."""
    return np.asarray(np.abs(values - np.median(values)) * np.sqrt(len(values) / (len(values) - 1)))


def _scatters(readings: Readings) -> dict[tuple[str, float], tuple[float, bool]]:
    """Series -> standard deviation of one reading by the median over all its repeats, and whether that is known.

    Known where points with three repeats are among them, or enough with two: then half of them may be wrong.
    """
    deviations: dict[tuple[str, float], list[NDArray[np.float64]]] = {}
    for feature, values in readings.items():
        finite = values[np.isfinite(values)]
        if finite.size > 1:
            deviations.setdefault((feature.channel, feature.order), []).append(_deviations(finite))
    return {
        series: (
            MAD_TO_SD * float(np.median(np.concatenate(found))),
            len(found) >= LEAST_PAIRS or any(len(one) > 2 for one in found),
        )
        for series, found in deviations.items()
    }


def _pooled(declared: float, squares: float, freedom: float) -> float:
    weight = DECLARED_WEIGHT if declared > 0.0 else 0.0
    whole = weight + freedom
    return float(np.sqrt((weight * declared**2 + squares) / whole)) if whole else 0.0
