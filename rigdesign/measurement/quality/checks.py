"""Data checks: what readings say about themselves before any model is evaluated."""

from collections.abc import Iterator

import numpy as np

from rigdesign.measurement.quality.still_warming import still_warming
from rigdesign.measurement.reading.measurement_set import DataFinding, MeasurementSet
from rigdesign.prediction.model import STANDING_QUANTITIES

LEAST_POINTS = 3
"""Operating points from which a reading that never moves is a dead sensor."""


def data_findings(measurement: MeasurementSet) -> tuple[frozenset[str], tuple[DataFinding, ...]]:
    """Channels that cannot be used, and everything the checks have to say."""
    findings = [
        *_dead(measurement),
        *_without_uncertainty(measurement),
        *_without_support(measurement),
        *still_warming(measurement),
    ]
    dropped = {name for finding in findings if finding.weight == "dropped" for name in finding.channels}
    return frozenset(dropped), tuple(findings)


def _dead(measurement: MeasurementSet) -> Iterator[DataFinding]:
    """A sensor whose reading is the same number over different operating points."""
    for name, entry in measurement.channels.items():
        if entry.channel.quantity in STANDING_QUANTITIES:
            continue
        own = measurement.by_channel[name]
        levels = np.concatenate([values[np.isfinite(values)] for values in own.values()] or [np.empty(0)])
        moving = bool(levels.size and np.ptp(levels) > 0.0)
        points = {feature.setting for feature, values in own.items() if np.isfinite(values).any()}
        if not points:
            yield DataFinding(
                id="dead_channel", weight="dropped", channels=(name,),
                text=f"{name}: has no reading at any operating point and is left out",
            )  # fmt: skip
        elif len(points) >= LEAST_POINTS and not moving:
            yield DataFinding(
                id="dead_channel", weight="dropped", channels=(name,),
                text=f"{name}: reads the same number at all {len(points)} operating points and is left out; look at "
                "sensor and cable",
            )  # fmt: skip


def _without_uncertainty(measurement: MeasurementSet) -> Iterator[DataFinding]:
    """A declared uncertainty of zero: repeats stand in, without them the channel has no weight."""
    for name, entry in measurement.channels.items():
        if entry.noise > 0.0:
            continue
        scatter = any(
            np.count_nonzero(np.isfinite(values)) > 1 and np.nanstd(values) > 0.0
            for values in measurement.by_channel[name].values()
        )  # fmt: skip
        if scatter:
            text = f"{name}: the declared uncertainty is zero; the scatter of its repeats is taken"
            yield DataFinding(id="zero_uncertainty", weight="note", channels=(name,), text=text)
        else:
            text = (
                f"{name}: the declared uncertainty is zero and no repeats say otherwise, so it has no weight and "
                "is left out; state the uncertainty of one reading"
            )
            yield DataFinding(id="zero_uncertainty", weight="dropped", channels=(name,), text=text)


def _without_support(measurement: MeasurementSet) -> Iterator[DataFinding]:
    """An accelerometer on a housing that stands still in the model: compared is the shaft in the bearing."""
    for name, entry in measurement.channels.items():
        if entry.channel.quantity != "acceleration":
            continue
        box, bearing = entry.channel.place.split(".")
        gearbox = measurement.case.gearboxes[box]
        seated = gearbox.housing is not None and gearbox.housing.bearing_seats == "elastic"
        if gearbox.bearings[bearing].support_stiffness is None and not seated:
            yield DataFinding(
                id="acceleration_of_shaft", weight="note", channels=(name,),
                text=f"{name}: the case has no support under {entry.channel.place}, so that the acceleration of "
                f"the shaft in it is predicted; state the support_stiffness of gearboxes.{box}.bearings.{bearing}",
            )  # fmt: skip
