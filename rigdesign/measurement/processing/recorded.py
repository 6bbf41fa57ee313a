"""Raw recordings of a set: every channel they hold becomes a mean, those of torque and angle become orders."""

import math
from collections.abc import Iterator, Mapping, MutableSequence, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.errors import Fault, MeasurementError
from rigdesign.case.faults import unknown, written
from rigdesign.measurement.places import Places
from rigdesign.measurement.processing.root_gauges import RecordedGauges
from rigdesign.measurement.quality.checks import (
    lines_off_the_mesh,
    signal_findings,
    usable_signal,
    without_wrong_samples,
)
from rigdesign.measurement.quantities import CHANNELS, accepted_unit, same_worth, to_si
from rigdesign.measurement.reading.columns import sensors_of
from rigdesign.measurement.reading.measurement_set import (
    DataFinding,
    MeasuredChannel,
    MeasuredPoint,
    MeasurementFile,
    Recording,
    Weight,
)
from rigdesign.measurement.reading.rows import Rows
from rigdesign.measurement.reading.signals import (
    Signal,
    Signals,
    TachError,
    TurnAngle,
    read_signals,
    turn_angle,
)
from rigdesign.prediction.model import ORDER_QUANTITIES, STANDING_QUANTITIES, Feature

# Time-synchronous averaging: complex orders of a signal over whole hunting cycles.
#
# With the angle known, an order is the projection X_k = 2 / Theta * integral of x exp(-i k phi) dphi over whole
# cycles, which averages out what does not turn with the gears. The integral is taken over the samples as they
# stand (trapezoidal rule in the angle): nothing is resampled, speed may vary.
# Sources: McFadden (1987), Mech. Syst. Signal Process. 1, 83; Fyfe and Munck (1997), ibid. 11, 187.

SAMPLES_PER_PERIOD = 2.5
"""Least number of samples per period of an order."""
FRACTION = 1e-9
"""An order this near a whole number turns with the reference gear."""


@dataclass(frozen=True)
class MeasuredOrders:
    """Complex orders of one signal in one recording.

    values : by order, one-sided: x = sum Re(X exp(i k phi)); the mean at 0
    cycles : cycles averaged; cycle : turns of one; left_out : cycles with missing samples
    too_fast : orders with too few samples per period; without_phase : fractional orders whose zero is not known
    """

    values: dict[float, complex]
    cycles: int
    cycle: int
    left_out: int
    too_fast: tuple[float, ...] = ()
    without_phase: tuple[float, ...] = ()


def signal_orders(signal: Signal, turn: TurnAngle, orders: Sequence[float], cycle: int) -> MeasuredOrders:
    """MeasuredOrders of a signal, averaged over whole hunting cycles.

    A recording shorter than one cycle is averaged over whole turns and gives whole orders only.

    Parameters
    ----------
    orders : per turn of the reference gear
    cycle : turns of that gear until the same teeth meet everywhere

    Raises
    ------
    ValueError
        Less than one turn, or missing samples in every cycle.
    """
    angle = turn.at(signal.time)
    inside = np.isfinite(angle)
    time, angle, values = signal.time[inside], angle[inside], signal.values[inside]
    if angle.size < 2:
        raise ValueError("the signal does not overlap the tach; record both together")
    turns = (angle[-1] - angle[0]) / (2.0 * math.pi)
    span = cycle if turns >= cycle else 1
    if turns < 1.0:
        raise ValueError(f"{turns:.2g} turns, at least one is needed; record longer")
    rate = (len(time) - 1) / (angle[-1] - angle[0]) * 2.0 * math.pi
    known = [k for k in orders if turn.absolute or abs(k - round(k)) < FRACTION]
    known = [k for k in known if span == cycle or abs(k - round(k)) < FRACTION]
    fast = [k for k in known if k * SAMPLES_PER_PERIOD > rate]
    wanted = np.array([k for k in known if k not in fast], dtype=float)
    sums, used, left_out = np.zeros(len(wanted), dtype=complex), 0, 0
    for start in np.arange(int(turns / span)) * (2.0 * math.pi * span) + angle[0]:
        part = _part(angle, values, start, start + 2.0 * math.pi * span)
        if not np.all(np.isfinite(part[1])):
            left_out += 1
            continue
        sums += _projections(*part, wanted)
        used += 1
    if not used:
        raise ValueError("samples are missing in every cycle; look at the cable or record longer")
    scale = np.where(wanted > 0.0, 2.0, 1.0) / (used * 2.0 * math.pi * span)
    return MeasuredOrders(
        values=dict(zip(wanted.tolist(), (scale * sums).tolist())),
        cycles=used,
        cycle=span,
        left_out=left_out,
        too_fast=tuple(fast),
        without_phase=tuple(k for k in orders if k not in known),
    )


def _part(
    angle: NDArray[np.float64], values: NDArray[np.float64], start: float, end: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Samples from ``start`` to ``end`` with the signal at both ends between its neighbours."""
    first, last = np.searchsorted(angle, start, "right"), np.searchsorted(angle, end, "left")
    ends = np.interp([start, end], angle, values)
    return (
        np.concatenate([[start], angle[first:last], [end]]),
        np.concatenate([ends[:1], values[first:last], ends[1:]]),
    )


def _projections(
    angle: NDArray[np.float64], values: NDArray[np.float64], orders: NDArray[np.float64]
) -> NDArray[np.complex128]:
    """Integral of x exp(-i k phi) over the angle for every order."""
    weights = np.empty_like(angle)
    weights[1:-1] = 0.5 * (angle[2:] - angle[:-2])
    weights[0], weights[-1] = 0.5 * (angle[1] - angle[0]), 0.5 * (angle[-1] - angle[-2])
    weighted = weights * values
    return np.array([np.sum(weighted * np.exp(-1j * k * angle)) for k in orders], dtype=complex)


Readings = dict[Feature, NDArray[np.float64]]
SPEED_OFF = 0.02
"""Relative difference between the speed of the tach and that of the table from which no angle is taken."""
SURE, LEAST_OFF = 5.0, 1e-3
"""Standard deviations of the speed of the table, and share of it, above which their difference is suspected."""
TIME_RATIOS = {"ms": 1e-3, "us": 1e-6, "min": 1.0 / 60.0, "h": 1.0 / 3600.0}
"""Unit of time that was taken for seconds -> speed over the true one."""
NO_ORDERS = "nothing that depends on the angle is read from this recording"
SHOWN = 10
"""Signals of a file that are named."""
SHORTER = 0.1
"""Part of its length that a recording may lack of the longest one of its point."""


@dataclass(frozen=True, kw_only=True)
class SetPlan:
    """What a set says it holds: its channels and operating points, and the rows of its table.

    folder : the recordings lie in; places : of the case
    """

    folder: Path
    document: MeasurementFile
    places: Places
    channels: Mapping[str, MeasuredChannel]
    points: Sequence[MeasuredPoint]
    rows: Rows


def read_recordings(
    plan: SetPlan,
    known: Mapping[Feature, NDArray[np.float64]],
    findings: MutableSequence[DataFinding],
) -> Readings:
    """Readings of all recordings by feature [SI]; what the tables hold already (``known``) is left to them.

    Raises
    ------
    MeasurementError
        A file that cannot be read, an unknown point or repeat, a signal in another unit than its channel.
    """
    document, rows = plan.document, plan.rows
    faults = list(_faults(document, rows))
    if faults:
        raise MeasurementError(faults)
    readings: Readings = {}
    lasting: dict[str, dict[str, float]] = {}
    by_name = {point.name: point for point in plan.points}
    channels = {n: c for n, c in plan.channels.items() if c.channel.quantity not in STANDING_QUANTITIES}
    of_angle = ORDER_QUANTITIES | {"root_strain"}
    timed = [channel.signal for channel in channels.values() if channel.channel.quantity in of_angle]
    timed += document.data.tach.signals if document.data.tach and timed else ()
    wanted = [*(channel.signal for channel in channels.values()), *timed]
    for entry in document.data.recordings:
        if entry.point not in by_name:
            continue
        try:
            signals = read_signals(plan.folder, entry.file, document.data, wanted, timed)
        except MeasurementError as error:
            faults += error.faults
            continue
        recorded = {name: channel for name, channel in channels.items() if channel.signal in signals}
        if not recorded:
            findings.append(_unused(entry, channels, signals))
            continue
        lasting.setdefault(entry.point, {})[entry.file] = max(float(np.ptp(s.time)) for s in signals.values())
        roots = {
            name: channel for name, channel in recorded.items() if channel.channel.quantity == "root_strain"
        }
        here = {name: channel for name, channel in recorded.items() if name not in roots}
        faults += unit_faults(entry.file, here, signals)
        if faults:
            continue
        place = rows.place(entry.point, entry.repeat)
        assert place is not None
        count = len(rows.rows_of(entry.point))
        read = _Recording(entry, document, plan.places, by_name[entry.point], findings)
        turning = [name for name, channel in recorded.items() if channel.channel.quantity in of_angle]
        turn = read.turn(signals, turning) if turning else None
        numbers = [*read.numbers(here, signals, turn)]
        if turn is not None or document.data.tach is None:
            numbers += _of_gauges(plan, entry, by_name[entry.point], roots, findings)
        for feature, value in numbers:
            if feature not in known:
                readings.setdefault(feature, np.full(count, np.nan))[place] = value
    if faults:
        raise MeasurementError(faults)
    findings.extend(_shorter(lasting))
    return readings


def _unused(entry: Recording, channels: Mapping[str, MeasuredChannel], signals: Signals) -> DataFinding:
    """A recording without a signal of the set."""
    wanted = ", ".join(dict.fromkeys(channel.signal for channel in channels.values()))
    return DataFinding(
        id="recording", weight="dropped", points=(entry.point,), channels=tuple(channels),
        text=f"{entry.file}: holds none of {wanted}; it has {', '.join(signals.names[:SHOWN])}"
        + (f" and {len(signals.names) - SHOWN} more" if signals.names[SHOWN:] else "")
        + "; correct the names (signal of the channels)",
    )  # fmt: skip


def _of_gauges(
    plan: SetPlan,
    entry: Recording,
    point: MeasuredPoint,
    channels: Mapping[str, MeasuredChannel],
    findings: MutableSequence[DataFinding],
) -> Iterator[tuple[Feature, float]]:
    """Numbers of the root gauges of a recording."""
    if not channels:
        return
    gauges = RecordedGauges.of(plan.places.case, plan.folder, plan.document.data)
    for number in gauges.numbers(entry, point, channels):
        if isinstance(number, DataFinding):
            findings.append(number)
        else:
            yield number


def _shorter(lasting: Mapping[str, Mapping[str, float]]) -> Iterator[DataFinding]:
    """Recordings that last much less than another one of their point; ``lasting``: point -> file -> seconds."""
    for point, files in lasting.items():
        longest = max(files.values())
        for file, length in files.items():
            if length < (1.0 - SHORTER) * longest:
                yield DataFinding(
                    id="shorter_recording", weight="suspect", points=(point,),
                    text=f"{file}: lasts {length:.4g} s, another recording of {point} {longest:.4g} s; look whether it "
                    "was cut off",
                )  # fmt: skip


class _Recording:
    """One file: its angle, its channels, and what is to be said of them."""

    def __init__(
        self,
        entry: Recording,
        document: MeasurementFile,
        places: Places,
        point: MeasuredPoint,
        findings: MutableSequence[DataFinding],
    ) -> None:
        self._entry = entry
        self._document = document
        self._places = places
        self._point = point
        self._findings = findings

    def numbers(
        self, channels: Mapping[str, MeasuredChannel], signals: Signals, turn: TurnAngle | None
    ) -> Iterator[tuple[Feature, float]]:
        """Features with their numbers [SI]; orders where the angle is known."""
        for name, channel in channels.items():
            measured = CHANNELS[channel.channel.quantity]
            kind = measured.kind
            unit = accepted_unit(signals[channel.signal].unit, kind) or channel.unit
            signal, said = without_wrong_samples(signals[channel.signal], measured, unit)
            if not self._looks_right(name, signal, said):
                continue
            if channel.channel.quantity in ORDER_QUANTITIES:
                if turn is not None:
                    yield from self._orders(name, channel, signal, turn, to_si(1.0, kind, unit))
            else:
                yield Feature(name, self._point.name), to_si(float(np.nanmean(signal.values)), kind, unit)

    def turn(self, signals: Signals, channels: Sequence[str]) -> TurnAngle | None:
        """Angle of the reference gear; None without a tach, and, with a finding, where it cannot be right."""
        tach = self._document.data.tach
        if tach is None:
            return None
        try:
            turn = turn_angle(tach, signals, self._entry.start_turn)
        except TachError as error:
            self._say("tach", "dropped", f"{error}; {NO_ORDERS}", *channels)
            return None
        if turn.lost or turn.surplus:
            self._say(
                "tach", "note", f"{turn.lost} tach pulses lost and filled, {turn.surplus} too many left out"
            )
        stated = self._point.setting.speed
        off = abs(turn.speed - stated)
        if off <= max(SURE * self._speed_error(stated), LEAST_OFF * stated):
            return turn
        wrong = off > SPEED_OFF * stated
        self._say(
            "tach_speed", "dropped" if wrong else "suspect",
            f"the tach gives {turn.speed * 30 / math.pi:.5g} rpm, the table {stated * 30 / math.pi:.5g} rpm"
            + (f"; {NO_ORDERS}" if wrong else "")
            + f"; look at {_cause(turn.speed / stated)}",
            *channels,
        )  # fmt: skip
        return None if wrong else turn

    def _speed_error(self, speed: float) -> float:
        """1 sigma of the speed of the table [rad/s]."""
        (sensor,) = (
            setting for setting in sensors_of(self._document).values() if setting.quantity == "speed"
        )
        return math.hypot(sensor.noise, sensor.offset_sd, sensor.scale_sd * speed)

    def _looks_right(self, name: str, signal: Signal, said: Sequence[tuple[str, Weight, str]]) -> bool:
        for identity, weight, text in (*said, *signal_findings(signal)):
            self._say(identity, weight, f"{name}: {text}", name)
        return usable_signal(signal)

    def _orders(
        self, name: str, channel: MeasuredChannel, signal: Signal, turn: TurnAngle, scale: float
    ) -> Iterator[tuple[Feature, float]]:
        wanted = channel.channel.orders
        try:
            measured = signal_orders(signal, turn, wanted, self._places.cycle)
        except ValueError as error:
            self._say("recording", "dropped", f"{name}: {error}", name)
            return
        self._say_orders(name, measured, signal, turn)
        for order, value in measured.values.items():
            if order == 0.0:
                yield Feature(name, self._point.name), scale * value.real
            else:
                yield Feature(name, self._point.name, order, "real"), scale * value.real
                yield Feature(name, self._point.name, order, "imaginary"), scale * value.imag

    def _say_orders(self, name: str, measured: MeasuredOrders, signal: Signal, turn: TurnAngle) -> None:
        if measured.left_out:
            self._say(
                "missing_samples",
                "note",
                f"{name}: {measured.left_out} cycles with missing samples left out",
                name,
            )
        if measured.too_fast:
            self._say(
                "too_fast", "dropped",
                f"{name}: orders from {min(measured.too_fast):g} on have too few samples per period; sample faster",
                name,
            )  # fmt: skip
        if measured.without_phase:
            shown = ", ".join(f"{order:.4g}" for order in measured.without_phase[:4])
            why = (
                f"the recording is shorter than the {self._places.cycle} turns of a hunting cycle"
                if turn.absolute or measured.cycle != self._places.cycle
                else "full turns are not counted from where both teeth 0 met; state start_turn of the recording"
            )
            self._say("without_phase", "dropped", f"{name}: orders {shown}, … are not used: {why}", name)
        for mesh, line in lines_off_the_mesh(signal, turn, self._places.mesh_orders):
            self._say(
                "mesh_order", "suspect",
                f"{name}: a line at order {line:.4g} stands where {mesh} should have "
                f"{float(self._places.mesh_orders[mesh]):g}; look at tooth numbers, pulses per turn and speed", name,
            )  # fmt: skip

    def _say(self, identity: str, weight: Weight, text: str, *channels: str) -> None:
        self._findings.append(
            DataFinding(
                id=identity, weight=weight,
                text=f"{self._entry.file}: {text}", channels=channels, points=(self._point.name,),
            )
        )  # fmt: skip


def _cause(ratio: float) -> str:
    """What may be wrong where the speed of the tach is so many times that of the table."""
    for unit, off in TIME_RATIOS.items():
        if abs(ratio / off - 1.0) < SPEED_OFF:
            return f'the unit of its time, which would fit as "{unit}" (data.time_unit)'
    return "data.tach.pulses_per_turn, at the unit of its time and at the speed column"


def _faults(document: MeasurementFile, rows: Rows) -> Iterator[Fault]:
    order_channels = [n for n, entry in document.channels.items() if entry.quantity in ORDER_QUANTITIES]
    if order_channels and document.data.tach is None and document.data.orders is None:
        yield Fault(
            "data.tach", "", f"recordings of {', '.join(order_channels)} need the angle of the reference gear",
            'add [data.tach] with kind = "pulses" or "angle" and the name of its signal',
        )  # fmt: skip
    seen: set[tuple[str, int]] = set()
    for index, entry in enumerate(document.data.recordings):
        key = f"data.recordings.{index}"
        if entry.point not in rows.names:
            yield unknown(f"{key}.point", entry.point, rows.names, f"point in {rows.table.file}")
        elif rows.place(entry.point, entry.repeat) is None:
            yield Fault(f"{key}.repeat", str(entry.repeat), f"{entry.point} has no such repeat", "correct it")
        elif (entry.point, entry.repeat) in seen:
            yield Fault(
                f"{key}.repeat", str(entry.repeat), f"{entry.point} has two recordings of it", "keep one"
            )
        seen.add((entry.point, entry.repeat))


def unit_faults(file: str, channels: Mapping[str, MeasuredChannel], signals: Signals) -> Iterator[Fault]:
    """Signals of a file in another unit than their channels state."""
    for name, channel in channels.items():
        unit = signals[channel.signal].unit
        kind = CHANNELS[channel.channel.quantity].kind
        if unit and not same_worth(unit, channel.unit, kind):
            yield Fault(
                f"{file}, {channel.signal}", written(unit), f'channels.{name}.unit says "{channel.unit}"',
                "correct what is wrong; nothing is converted",
            )  # fmt: skip
