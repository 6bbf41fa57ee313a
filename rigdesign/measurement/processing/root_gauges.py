"""Recorded root gauges: bridge output over time to the mean curve of the gauged tooth, and that to a few numbers."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from math import pi
from pathlib import Path

import numpy as np

from rigdesign.base.errors import Fault, MeasurementError
from rigdesign.base.units import KINDS
from rigdesign.case.model import Case
from rigdesign.measurement.places import Places
from rigdesign.measurement.quality.checks import signal_findings
from rigdesign.measurement.quantities import accepted_unit, same_worth, to_si, unit_problem
from rigdesign.measurement.reading.measurement_set import (
    DataFinding,
    DataSection,
    MeasuredChannel,
    MeasuredPoint,
    Recording,
    Tach,
    Weight,
)
from rigdesign.measurement.reading.signals import Signal, Signals, TachError, read_signals, turn_angle
from rigdesign.prediction.model import Feature
from rigdesign.rig.model import build_rig
from rigdesign.rig.strain_gauges import RootGauge
from rigdesign.strain_gauge.gauge import Bridge
from rigdesign.strain_gauge.measuring_point import StrainRecord
from rigdesign.strain_gauge.turn_average import (
    AngleGrid,
    RollingAngle,
    TurnCurve,
    at_constant_speed,
    curve_windows,
    from_speed,
    turn_average,
    turns_until_same_teeth,
)

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
                name: GaugeChannel(
                    signal=channel.signal, bridge=self.gauges[channel.channel.place].point.bridge
                )
                for name, channel in channels.items()
            },
            angle=self.data.tach or ConstantSpeed(point.setting.speed),
            data=self.data,
        )
        strain = read_strain_records(self.folder, recording)
        if self.data.tach is None:
            yield _finding(
                entry, point, "no_tach", "note",
                "no tach: the rolling angle follows from the speed in the table; speed ripple smears the curves",
            )  # fmt: skip
        for name, channel in channels.items():
            for text in strain.notes[name]:
                yield _finding(entry, point, "gauge_signal", "suspect", f"{name}: {text}", name)
            try:
                curve = self._mean_curve(channel.channel.place, strain.records[name], strain.angle)
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


# Recorded bridge outputs of strain gauges with speed or tach: TDMS, HDF5, MDF4 or CSV, each channel with its unit.

OUTPUT_KINDS = ("voltage", "voltage_ratio")
"""Kinds of quantity a logger stores of a bridge."""


@dataclass(frozen=True)
class SpeedSignal:
    """A recorded speed, whose integral is the rolling angle.

    signal : its channel; unit : of its numbers, e.g. "rpm"; empty: as in the file
    zero : rolling angle at its first sample [rad]
    """

    signal: str
    unit: str = ""
    zero: float = 0.0


@dataclass(frozen=True)
class ConstantSpeed:
    """A speed that is only stated.

    speed : [rad/s]; zero : rolling angle at t = 0 [rad]
    """

    speed: float
    zero: float = 0.0


@dataclass(frozen=True, kw_only=True)
class GaugeChannel:
    """Channel in which a bridge output is stored.

    signal : its name in the file
    unit : "V", "mV", "mV/V", ...; empty: as in the file, where all channels of the file must then have the same
    supply : channel of the recorded supply voltage; None: that of the bridge
    """

    signal: str
    bridge: Bridge
    unit: str = ""
    supply: str | None = None


@dataclass(frozen=True, kw_only=True)
class StrainRecording:
    """A file with bridge outputs and what says the rolling angle.

    file : .tdms, .h5, .hdf5, .mf4 or .csv in the folder of the set
    gauges : channels by measuring point
    angle : index, tooth-passing or other pulses and encoders (`Tach`; a gauge itself passes as one pulse a turn),
        a recorded or a stated speed
    data : how a CSV is written, and the largest file
    """

    file: str
    gauges: Mapping[str, GaugeChannel]
    angle: Tach | SpeedSignal | ConstantSpeed
    data: DataSection = field(default_factory=DataSection)


@dataclass(frozen=True)
class StrainRecords:
    """Content of one file.

    records : bridge outputs by measuring point; angle : rolling angle over time
    notes : by measuring point, what its signal says of its chain: missing samples, clipped
    """

    records: Mapping[str, StrainRecord]
    angle: RollingAngle
    notes: Mapping[str, tuple[str, ...]]


def read_strain_records(folder: Path, recording: StrainRecording) -> StrainRecords:
    """Bridge outputs U_B / U_E by measuring point, and the rolling angle.

    Raises
    ------
    MeasurementError
        A file that cannot be read or was cut off (`read_signals`); all channels that are missing or have no unit, the
        wrong one or different ones; a dead channel; a tach or speed that gives no angle.
    """
    wanted = _wanted(recording)
    signals = read_signals(folder, recording.file, recording.data, wanted.values())
    faults = [
        Fault(
            f"{recording.file}, {key}", signal, f"no such channel; the file has {', '.join(signals.names)}",
            "correct the name or export the channel",
        )
        for key, signal in wanted.items() if signal not in signals
    ]  # fmt: skip
    if not faults:
        faults = [*_wrong_units(recording, signals), *_dead(recording, signals)]
    if faults:
        raise MeasurementError(faults)
    records = {name: _record(channel, signals) for name, channel in recording.gauges.items()}
    notes = {
        name: tuple(text for _, _, text in signal_findings(signals[channel.signal]))
        for name, channel in recording.gauges.items()
    }
    return StrainRecords(records, _angle(recording, signals), notes)


def _wanted(recording: StrainRecording) -> dict[str, str]:
    """Signals that a recording needs, by key."""
    wanted = {f"gauges.{name}.signal": channel.signal for name, channel in recording.gauges.items()}
    wanted |= {
        f"gauges.{name}.supply": channel.supply
        for name, channel in recording.gauges.items()
        if channel.supply
    }
    if isinstance(recording.angle, SpeedSignal):
        wanted["angle.signal"] = recording.angle.signal
    elif isinstance(recording.angle, Tach):
        wanted |= dict(zip(("angle.signal", "angle.index"), recording.angle.signals))
    return wanted


def _wrong_units(recording: StrainRecording, signals: Signals) -> Iterator[Fault]:
    by_unit: dict[str, list[str]] = {}
    for name, channel in recording.gauges.items():
        place = f"{recording.file}, gauges.{name}"
        faults = [*_wrong_unit(place, channel.unit, signals[channel.signal], OUTPUT_KINDS)]
        yield from faults
        if not faults and not channel.unit:
            by_unit.setdefault(_output_unit(channel, signals)[1], []).append(name)
        if channel.supply:
            yield from _wrong_unit(f"{place}.supply", "", signals[channel.supply], ("voltage",))
    if len(by_unit) > 1:
        shown = "; ".join(f"{', '.join(names)} in {unit}" for unit, names in by_unit.items())
        yield Fault(
            f"{recording.file}, gauges", shown, "the bridges of one file are stored in different units",
            "if that is meant, state the unit of each channel",
        )  # fmt: skip
    if isinstance(recording.angle, SpeedSignal):
        speed = recording.angle
        yield from _wrong_unit(
            f"{recording.file}, angle.{speed.signal}", speed.unit, signals[speed.signal], ("speed",)
        )


def _dead(recording: StrainRecording, signals: Signals) -> Iterator[Fault]:
    """Gauges that give no number or always the same."""
    for name, channel in recording.gauges.items():
        values = signals[channel.signal].values
        if not np.nanmax(values, initial=-np.inf) > np.nanmin(values, initial=np.inf):
            yield Fault(
                f"{recording.file}, gauges.{name}", channel.signal, "reads the same throughout, or nothing",
                "look at gauge, cable and slip ring, or leave the measuring point out",
            )  # fmt: skip


def _wrong_unit(place: str, stated: str, signal: Signal, kinds: tuple[str, ...]) -> Iterator[Fault]:
    """The fault of a channel without a unit of these kinds, or with another one in the file than stated."""
    choices = ", ".join(unit for kind in kinds for unit in KINDS[kind].units)
    unit = stated or signal.unit
    if not unit:
        yield Fault(place, "", "neither the file nor the channel has a unit", f"write one of {choices}")
        return
    kind = next((kind for kind in kinds if accepted_unit(unit, kind)), None)
    if kind is None:
        yield Fault(place, unit, unit_problem(unit, kinds[0]), f"write one of {choices}")
    elif stated and signal.unit and not same_worth(stated, signal.unit, kind):
        yield Fault(
            place, stated, f'the file says "{signal.unit}"', "correct what is wrong; nothing is converted"
        )


def _output_unit(channel: GaugeChannel, signals: Signals) -> tuple[str, str]:
    """Kind and spelling of the unit of a bridge output that has no fault."""
    unit = channel.unit or signals[channel.signal].unit
    for kind in OUTPUT_KINDS:
        spelled = accepted_unit(unit, kind)
        if spelled:
            return kind, spelled
    raise AssertionError(unit)


def _record(channel: GaugeChannel, signals: Signals) -> StrainRecord:
    signal = signals[channel.signal]
    kind, unit = _output_unit(channel, signals)
    values = to_si(signal.values, kind, unit)
    if kind == "voltage":
        values = values / _supply(channel, signals, signal)
    return StrainRecord(signal.time, values)


def _supply(channel: GaugeChannel, signals: Signals, signal: Signal) -> "float | np.ndarray":
    """Supply voltage [V] at the samples of a bridge output."""
    if channel.supply is None:
        return channel.bridge.supply_voltage
    recorded = signals[channel.supply]
    unit = accepted_unit(recorded.unit, "voltage")
    assert unit is not None
    voltage = to_si(np.interp(signal.time, recorded.time, recorded.values), "voltage", unit)
    if not np.nanmin(voltage) > 0.0:
        raise MeasurementError([Fault(
            channel.supply, f"{np.nanmin(voltage):.6g} V", "the supply must be above 0 V",
            "look at its cable and sign, or use that of the bridge",
        )])  # fmt: skip
    return voltage


def _angle(recording: StrainRecording, signals: Signals) -> RollingAngle:
    source = recording.angle
    if isinstance(source, ConstantSpeed):
        return at_constant_speed(source.speed, source.zero)
    if isinstance(source, SpeedSignal):
        signal = signals[source.signal]
        unit = accepted_unit(source.unit or signal.unit, "speed")
        assert unit is not None
        return from_speed(signal.time, to_si(signal.values, "speed", unit), source.zero)
    try:
        return turn_angle(source, signals, None).at
    except TachError as error:
        raise MeasurementError(str(error), recording.file) from None
