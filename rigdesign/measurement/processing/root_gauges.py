"""Recorded root gauges: bridge output over time to the mean curve of the gauged tooth, and that to a few numbers."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import pi
from pathlib import Path

import numpy as np

from rigdesign.base.errors import MeasurementError
from rigdesign.case.model import Case
from rigdesign.measurement.places import Places
from rigdesign.measurement.processing.strain_record import (
    ConstantSpeed,
    GaugeChannel,
    StrainRecording,
    read_strain_records,
)
from rigdesign.measurement.reading.document import DataSection, Recording
from rigdesign.measurement.reading.measurement_set import DataFinding, MeasuredChannel, MeasuredPoint, Weight
from rigdesign.prediction.model import Feature
from rigdesign.rig.model import build_rig
from rigdesign.rig.strain_gauges import RootGauge
from rigdesign.strain_gauge.curve_windows import curve_windows
from rigdesign.strain_gauge.measuring_point import StrainRecord
from rigdesign.strain_gauge.rolling_angle import RollingAngle, turns_until_same_teeth
from rigdesign.strain_gauge.turn_average import AngleGrid, TurnCurve, turn_average

MOST_POINTS = 1440
"""Points of the mean curve over a turn at most; the samples of a turn where they are fewer."""
LEAST_POINTS = 12
"""Points per tooth of the gear below which the sampling is too coarse for the curve."""


@dataclass(frozen=True, kw_only=True)
class RecordedGauges:
    """Reads the root gauges of the recordings of a set.

    folder : of the set; data : how its files are written; places : of the case
    """

    folder: Path
    data: DataSection
    places: Places
    gauges: Mapping[str, RootGauge]

    @classmethod
    def of(cls, case: Case, folder: Path, data: DataSection) -> "RecordedGauges":
        """For a case."""
        gauges = build_rig(case, "quick").strain_gauges
        return cls(folder=folder, data=data, places=Places(case), gauges=gauges)

    def numbers(
        self, entry: Recording, point: MeasuredPoint, channels: Mapping[str, MeasuredChannel]
    ) -> Iterator[tuple[Feature, float] | DataFinding]:
        """Numbers of all gauges of a recording, and what is to be said of them.

        Raises
        ------
        MeasurementError
            As `read_strain_records`.
        """
        recording = StrainRecording(
            file=entry.file,
            gauges={
                name: GaugeChannel(signal=one.signal, bridge=self.gauges[one.channel.place].point.bridge)
                for name, one in channels.items()
            },
            angle=self.data.tach or ConstantSpeed(point.setting.speed),
            data=self.data,
        )
        found = read_strain_records(self.folder, recording)
        if self.data.tach is None:
            yield _finding(
                entry, point, "no_tach", "note",
                "no tach: the rolling angle follows from the speed in the table; speed ripple smears the curves",
            )  # fmt: skip
        for name, channel in channels.items():
            for text in found.notes[name]:
                yield _finding(entry, point, "gauge_signal", "suspect", f"{name}: {text}", name)
            try:
                curve = self._mean_curve(channel.channel.place, found.records[name], found.angle)
            except MeasurementError as error:
                yield _finding(entry, point, "recording", "dropped", f"{name}: {error.faults[0]}", name)
                continue
            if np.isnan(curve.by_mating_tooth).any():
                met, all_of_them = np.isfinite(curve.by_mating_tooth[:, 0]).sum(), len(curve.by_mating_tooth)
                yield _finding(
                    entry, point, "hunting_cycle", "note",
                    f"{name}: {met} of the {all_of_them} mating teeth of a hunting cycle met; record longer", name,
                )  # fmt: skip
            numbers = self._windows(channel.channel.place, curve)
            for window in channel.channel.windows:
                yield Feature(name, point.name, part=window), numbers[window]

    def _mean_curve(self, place: str, record: StrainRecord, angle: RollingAngle) -> TurnCurve:
        """Indicated strain over a turn of the gear, mean over its turns and by mating tooth."""
        gauge = self.gauges[place]
        turned = np.asarray(angle(record.time)) * float(self.places.gear_orders[gauge.gear])
        strain = gauge.point.bridge.strain(record.ratio, None)
        known = turned[np.isfinite(turned)]
        a_turn = int(0.9 * known.size / max(float(np.ptp(known)) / (2.0 * pi), 1e-9)) if known.size else 0
        teeth, mating = self.places.teeth_of(gauge.gear)
        grid = AngleGrid(
            points=max(1, min(MOST_POINTS, max(a_turn, LEAST_POINTS * teeth))),
            same_teeth_after=turns_until_same_teeth(teeth, mating),
        )
        return turn_average(turned, strain, grid)

    def _windows(self, place: str, curve: TurnCurve) -> Mapping[str, float]:
        """Of the mean over the hunting cycle, every mating tooth with the same weight, the peak in the middle."""
        strain = np.nanmean(curve.by_mating_tooth, axis=0)
        swing = np.abs(strain - np.median(strain))
        strain = np.roll(strain, len(strain) // 2 - int(np.argmax(swing)))
        teeth, _ = self.places.teeth_of(self.gauges[place].gear)
        return curve_windows(curve.angle, strain, 2.0 * pi / teeth)


def _finding(
    entry: Recording, point: MeasuredPoint, identity: str, weight: Weight, text: str, *channels: str
) -> DataFinding:
    return DataFinding(
        id=identity, weight=weight, text=f"{entry.file}: {text}", channels=channels, points=(point.name,)
    )
