"""Run-ups and run-downs of a set: resonance speeds of tracked orders, and orders at some speeds of every sweep.

A resonance speed is where a tracked order meets a mode: the peak of its amplitude over speed. A response lags by
1/(damping ratio times natural frequency) behind a speed that changes, so that its peak stands later: by the rate over
the order and the half width of the peak. That much is taken off and half of it counts as uncertain; a run-up and a
run-down at the same rate cancel it. Orders at given speeds become operating points of the set, one reading for each
sweep that passes them, as if the rig stood there.
"""

import math
from collections.abc import Iterator, Mapping, MutableSequence, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.base import units
from rigdesign.base.errors import Fault, MeasurementError
from rigdesign.case.faults import written
from rigdesign.measurement.processing.impacts import Peak, resonance_peak
from rigdesign.measurement.processing.recorded import FRACTION, SAMPLES_PER_PERIOD, SetPlan, unit_faults
from rigdesign.measurement.quality.checks import signal_findings, usable_signal
from rigdesign.measurement.quantities import CHANNELS, accepted_unit, to_si
from rigdesign.measurement.reading.measurement_set import (
    DataFinding,
    MeasuredChannel,
    MeasuredPoint,
    Sweep,
    Weight,
)
from rigdesign.measurement.reading.signals import (
    Signal,
    Signals,
    TachError,
    TurnAngle,
    read_signals,
    turn_angle,
)
from rigdesign.prediction.model import ORDER_QUANTITIES, Feature, OperatingCondition

# Orders over speed: the angle known, each window of whole turns is projected on every order with a Hann weight.
#
# As in `averaging` the integral is taken over the samples as they stand, so that speed may change within a window; the
# weight keeps orders between two lines and the mean out of each other. Windows overlap by half.
# Source: Fyfe and Munck (1997), Mech. Syst. Signal Process. 11, 187.

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

OVERLAP = 0.5
"""Share of a window that the next one has, too."""
LEAST_WINDOWS = 5
"""Windows below which a recording is no sweep."""


@dataclass(frozen=True, kw_only=True)
class OrderCurves:
    """Orders of one signal over the windows of a sweep, in the order of time.

    speed : (m,) of the reference gear [rad/s], signed as it turns; rate : (m,) its derivative [rad/s2]
    amplitude : order -> (m,) complex, one-sided, NaN where samples are missing or too few per period
    """

    speed: Array
    rate: Array
    amplitude: dict[float, Complex]

    def at(self, order: float, speed: float) -> complex:
        """Amplitude at a speed [rad/s], between the windows by straight lines; NaN outside."""
        curve = self.amplitude[order]
        known = np.flatnonzero(np.isfinite(curve.real))
        rising = known[np.argsort(self.speed[known])]
        places = self.speed[rising]
        if not rising.size or not places[0] <= speed <= places[-1]:
            return complex(math.nan, math.nan)
        return complex(
            np.interp(speed, places, curve[rising].real), np.interp(speed, places, curve[rising].imag)
        )


def order_curves(signal: Signal, turn: TurnAngle, orders: Sequence[float], turns: int) -> OrderCurves:
    """Orders of a signal over the speed of a sweep.

    Parameters
    ----------
    orders : per turn of the reference gear; turns : of it in one window

    Raises
    ------
    ValueError
        Fewer than `LEAST_WINDOWS` windows.
    """
    angle = turn.at(signal.time)
    inside = np.isfinite(angle)
    time, angle, values = signal.time[inside], angle[inside], signal.values[inside]
    length = 2.0 * math.pi * turns
    covered = float(angle[-1] - angle[0]) if angle.size > 1 else 0.0
    count = int((covered / length - 1.0) / (1.0 - OVERLAP)) + 1
    if count < LEAST_WINDOWS:
        raise ValueError(
            f"{covered / (2.0 * math.pi):.3g} turns, {LEAST_WINDOWS} windows of {turns} turns are needed; record "
            "longer or take fewer turns a window"
        )
    starts = angle[0] + (1.0 - OVERLAP) * length * np.arange(count)
    wanted = np.asarray(orders, dtype=float)
    amplitudes = np.full((count, wanted.size), complex(math.nan, math.nan))
    for row, start in enumerate(starts):
        first, last = np.searchsorted(angle, (start, start + length))
        amplitudes[row] = _projected(angle[first:last], values[first:last], start, turns, wanted)
    speed, rate = _speeds(time, angle, starts + 0.5 * length, length)
    return OrderCurves(speed=speed, rate=rate, amplitude=dict(zip(wanted.tolist(), amplitudes.T)))


def _projected(angle: Array, values: Array, start: float, turns: int, orders: Array) -> Complex:
    """(k,) orders of one window; NaN where they cannot be known."""
    unknown = np.full(orders.size, complex(math.nan, math.nan))
    if angle.size < 3 or not np.all(np.isfinite(values)):
        return unknown
    weight = np.sin(0.5 * (angle - start) / turns) ** 2 * np.gradient(angle)
    waves = np.exp(-1j * np.outer(orders, angle))
    projected = waves @ (weight * values) / weight.sum() * np.where(orders > 0.0, 2.0, 1.0)
    enough = orders * SAMPLES_PER_PERIOD <= angle.size / turns
    return np.where(enough, projected, unknown)


def _speeds(time: Array, angle: Array, middles: Array, length: float) -> tuple[Array, Array]:
    """Speed over the middle half of every window, and how fast it changes."""
    before, here, after = (np.interp(middles + share * length, angle, time) for share in (-0.25, 0.0, 0.25))
    speed = 0.5 * length / (after - before)
    return speed, np.gradient(speed, here)


Readings = dict[Feature, NDArray[np.float64]]

SAME_TORQUE = 0.02
"""Relative difference of torques that are the same."""
LAG_UNCERTAIN = 0.5
"""Share of the lag of a peak that counts as uncertain after it is taken off."""
TOO_FAST = 0.5
"""Lag of a peak over its half width from which a sweep is too fast to tell."""
DOUBTED = 2.0
"""Uncertainty found over the one declared from which a resonance speed is suspected."""


@dataclass(frozen=True, kw_only=True)
class Swept:
    """What the sweeps of a set say: readings by feature [SI], and the operating points that they stand for."""

    readings: Readings
    points: tuple[MeasuredPoint, ...]


def read_sweeps(plan: SetPlan, findings: MutableSequence[DataFinding]) -> Swept:
    """Resonance speeds and orders at given speeds of all sweeps.

    Raises
    ------
    MeasurementError
        No tach, a file that cannot be read, a tach that gives no angle, a direction that the tach contradicts, a
        signal in another unit than its channel.
    """
    document = plan.document
    if document.data.tach is None:
        raise MeasurementError(
            [Fault("data.tach", "", "sweeps need the angle of the reference gear",
                   'add [data.tach] with kind = "pulses" or "angle" and the name of its signal')]
        )  # fmt: skip
    resonances: dict[str, list[float]] = {}
    settings: dict[str, OperatingCondition] = {}
    orders: dict[Feature, list[float]] = {}
    for number, sweep in enumerate(document.data.sweeps):
        measured = _Sweep(plan, sweep, f"data.sweeps.{number}", findings)
        for name, speed in measured.resonances():
            resonances.setdefault(name, []).append(speed)
        for setting, numbers in measured.points():
            settings.setdefault(setting.name, setting)
            for feature, value in numbers.items():
                orders.setdefault(feature, []).append(value)
    readings = {Feature(name, ""): np.array(speeds) for name, speeds in resonances.items()}
    readings |= {feature: np.array(values) for feature, values in orders.items()}
    return Swept(readings=readings, points=tuple(_point(plan, setting) for setting in settings.values()))


def _point(plan: SetPlan, setting: OperatingCondition) -> MeasuredPoint:
    """An operating point that sweeps passed: speed and torque are known, nothing is warm."""
    known = {"speed": setting.speed, "torque": setting.torque}
    return MeasuredPoint(
        setting=setting,
        readings={
            column: np.array([known.get(entry.quantity, math.nan)])
            for column, entry in plan.document.settings.items()
        },
        steady=False,
    )


class _Sweep:
    """One sweep: its angle, its channels, and what is to be said of them."""

    def __init__(self, plan: SetPlan, sweep: Sweep, key: str, findings: MutableSequence[DataFinding]) -> None:
        self._plan, self._sweep, self._key, self._findings = plan, sweep, key, findings
        tach = plan.document.data.tach
        wanted = [channel.signal for channel in plan.channels.values()] + [*(tach.signals if tach else ())]
        self._signals: Signals = read_signals(plan.folder, sweep.file, plan.document.data, wanted)
        self._turn = self._angle()
        self._channels: Mapping[str, MeasuredChannel] = {
            name: channel for name, channel in plan.channels.items() if channel.signal in self._signals
        }

    def resonances(self) -> Iterator[tuple[str, float]]:
        """Channels of a resonance speed at the torque of this sweep, each with what it read [rad/s]."""
        for name, channel in self._channels.items():
            asked = channel.channel
            if asked.quantity != "resonance_speed" or not self._same_torque(asked.torque):
                continue
            (order,) = asked.orders
            curves = self._curves(name, channel, (order,))
            if curves is None:
                continue
            try:
                peak = resonance_peak(curves.speed, np.abs(curves.amplitude[order]), channel.search_range)
            except ValueError as error:
                self._say("no_resonance", "dropped", f"{name}: order {order:g}: {error}", name)
                continue
            yield name, self._resonance(name, channel, curves, peak)

    def points(self) -> Iterator[tuple[OperatingCondition, dict[Feature, float]]]:
        """Operating points at the speeds of this sweep, with the orders of all channels there."""
        read = {n: c for n, c in self._channels.items() if c.channel.quantity in ORDER_QUANTITIES}
        if not self._sweep.speeds or not read:
            return
        faults = list(unit_faults(self._sweep.file, read, self._signals))
        if faults:
            raise MeasurementError(faults)
        curves = {
            name: self._curves(name, channel, self._known(name, channel)) for name, channel in read.items()
        }
        for speed in self._sweep.speeds:
            setting = self._setting(speed)
            numbers: dict[Feature, float] = {}
            for name, curve in curves.items():
                if curve is not None:
                    numbers |= self._orders(name, curve, setting)
            if numbers:
                yield setting, numbers

    def _orders(self, name: str, curves: OrderCurves, setting: OperatingCondition) -> dict[Feature, float]:
        channel = self._channels[name]
        kind = CHANNELS[channel.channel.quantity].kind
        scale = to_si(1.0, kind, accepted_unit(self._signals[channel.signal].unit, kind) or channel.unit)
        numbers: dict[Feature, float] = {}
        for order in curves.amplitude:
            value = scale * curves.at(order, setting.speed)
            if not math.isfinite(value.real):
                continue
            if order == 0.0:
                numbers[Feature(name, setting.name)] = value.real
            else:
                numbers[Feature(name, setting.name, order, "real")] = value.real
                numbers[Feature(name, setting.name, order, "imaginary")] = value.imag
        if not numbers:
            span = " to ".join(units.show(end, "speed", digits=4) for end in self._span(curves))
            self._say(
                "outside_sweep", "dropped",
                f"{name}: no order at {units.show(setting.speed, 'speed', digits=4)}, the sweep goes from {span} and "
                "may have too few samples per period; correct data.sweeps.speeds", name,
            )  # fmt: skip
        return numbers

    def _known(self, name: str, channel: MeasuredChannel) -> tuple[float, ...]:
        """Orders of a channel whose phase is known."""
        orders = channel.channel.orders
        known = tuple(k for k in orders if self._turn.absolute or abs(k - round(k)) < FRACTION)
        if len(known) < len(orders):
            lost = ", ".join(f"{order:.4g}" for order in orders if order not in known)
            self._say(
                "without_phase", "dropped",
                f"{name}: orders {lost} are not used: full turns are not counted from where both teeth 0 met; state "
                "start_turn of the sweep", name,
            )  # fmt: skip
        return known

    def _resonance(self, name: str, channel: MeasuredChannel, curves: OrderCurves, peak: Peak) -> float:
        """Speed of a peak less the lag of the response, with what makes it doubtful."""
        (order,) = channel.channel.orders
        rising = np.argsort(curves.speed)
        rate = float(np.interp(peak.place, curves.speed[rising], curves.rate[rising]))
        lag = rate / (order * peak.half_width)
        uncertainty = math.hypot(peak.uncertainty, LAG_UNCERTAIN * lag)
        said = f"{name}: order {order:g} has its peak at {_rpm(peak.place)} rpm, half width {_rpm(peak.half_width)} rpm"
        if abs(lag) > TOO_FAST * peak.half_width:
            said += f"; at {_rpm(abs(rate))} rpm/s it lags by {_rpm(abs(lag))} rpm; sweep slower"
            self._say("fast_sweep", "suspect", said, name)
        elif channel.noise > 0.0 and uncertainty > DOUBTED * channel.noise:
            said += f", known to {_rpm(uncertainty)} rpm, declared are {_rpm(channel.noise)} rpm"
            said += "; sweep slower, take fewer turns a window, or declare more"
            self._say("uncertain_resonance", "suspect", said, name)
        else:
            self._say("resonance", "note", f"{said}, known to {_rpm(uncertainty)} rpm", name)
        return peak.place - lag

    def _angle(self) -> TurnAngle:
        tach = self._plan.document.data.tach
        assert tach is not None
        try:
            turn = turn_angle(tach, self._signals, self._sweep.start_turn)
        except TachError as error:
            raise MeasurementError(
                [Fault(f"{self._key}.file", written(self._sweep.file), str(error), "correct it")]
            ) from None
        half = len(turn.time) // 2
        first, last = (_mean_speed(turn, part) for part in (slice(0, half + 1), slice(half, None)))
        if (last > first) != (self._sweep.direction == "up"):
            raise MeasurementError(
                [Fault(f"{self._key}.direction", written(self._sweep.direction),
                       f"the tach goes from {_rpm(first)} to {_rpm(last)} rpm, means of both halves",
                       "correct the key, or look at the file")]
            )  # fmt: skip
        return turn

    def _curves(self, name: str, channel: MeasuredChannel, orders: tuple[float, ...]) -> OrderCurves | None:
        """Orders of a channel over speed; None, with a finding, where its signal does not serve."""
        signal = self._signals[channel.signal]
        for identity, weight, text in signal_findings(signal):
            self._say(identity, weight, f"{name}: {text}", name)
        if not orders or not usable_signal(signal):
            return None
        try:
            return order_curves(signal, self._turn, orders, self._sweep.turns)
        except ValueError as error:
            self._say("sweep", "dropped", f"{name}: {error}", name)
            return None

    def _setting(self, speed: float) -> OperatingCondition:
        name = f"{units.show(speed, 'speed', digits=6)}, {units.show(self._sweep.torque, 'torque', digits=6)} in sweeps"
        return OperatingCondition(name=name, speed=speed, torque=self._sweep.torque)

    def _same_torque(self, torque: float | None) -> bool:
        stated = self._sweep.torque
        return torque is not None and abs(torque - stated) <= SAME_TORQUE * max(abs(stated), abs(torque))

    def _span(self, curves: OrderCurves) -> tuple[float, float]:
        return float(curves.speed.min()), float(curves.speed.max())

    def _say(self, identity: str, weight: Weight, text: str, *channels: str) -> None:
        self._findings.append(
            DataFinding(id=identity, weight=weight, text=f"{self._sweep.file}: {text}", channels=channels)
        )


def _mean_speed(turn: TurnAngle, part: slice) -> float:
    angle, time = turn.angle[part], turn.time[part]
    return float((angle[-1] - angle[0]) / (time[-1] - time[0]))


def _rpm(speed: float) -> str:
    return f"{speed * 30.0 / math.pi:.5g}"
