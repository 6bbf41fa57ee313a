"""Hammer blows on the rig at rest: natural frequencies from the peaks of the frequency response to the force.

The response function is H1 = S_fx / S_ff, averaged over the blows, each from a little before it to the next one. Peaks
are fitted as those of a sweep (`resonance_peak`). Source: Ewins, Modal Testing, 2nd edition, section 3.8 and 4.3.
"""

import math
from collections.abc import Iterator, MutableSequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import find_peaks

from rigdesign.base.errors import MeasurementError
from rigdesign.case.faults import unknown
from rigdesign.measurement.processing.recorded import SetPlan
from rigdesign.measurement.quality.checks import signal_findings, usable_signal
from rigdesign.measurement.reading.measurement_set import DataFinding, Impact, MeasuredChannel, Weight
from rigdesign.measurement.reading.signals import Signal, read_signals
from rigdesign.prediction.model import Feature

Array = NDArray[np.float64]


Complex = NDArray[np.complex128]

BLOW = 0.3
"""Share of the hardest blow from which a peak of the force is a blow of its own."""
BEFORE = 0.02
"""Share of the time between blows that counts before one."""
APART = 0.05
"""Least time between two blows [s]: what comes sooner is a rebound."""
LEAST_SAMPLES = 64
"""Samples of a blow below which it says nothing."""
LEAST_COHERENCE = 0.8
"""Coherence at a peak below which its frequency is suspected."""


@dataclass(frozen=True, kw_only=True)
class FrequencyResponse:
    """Response per force over frequency.

    frequency : (n,) [Hz]; response : (n,) complex; coherence : (n,) 0 to 1, NaN of a single blow; blows : averaged
    """

    frequency: Array
    response: Complex
    coherence: Array
    blows: int


def frequency_response(force: Signal, response: Signal, length: float | None = None) -> FrequencyResponse:
    """Averaged over the blows of a record whose two signals have the same samples.

    length : time after a blow that counts [s]; to the next blow when left out

    Raises
    ------
    ValueError
        No blow, signals of other samples, missing samples, blows that follow each other too fast.
    """
    if force.time.shape != response.time.shape or not np.array_equal(force.time, response.time):
        raise ValueError("force and response have other samples; record both with one clock")
    if not (np.all(np.isfinite(force.values)) and np.all(np.isfinite(response.values))):
        raise ValueError("samples are missing; look at the cables")
    step = float(np.median(np.diff(force.time)))
    blows = _blows(force.values - float(np.median(force.values)), step)
    size = _samples(blows, force.values.size, step, length)
    before = int(BEFORE * size)
    parts = [slice(start - before, start - before + size) for start in blows if start >= before]
    parts = [part for part in parts if part.stop <= force.values.size]
    if not parts or size < LEAST_SAMPLES:
        raise ValueError(
            f"{size} samples a blow, {LEAST_SAMPLES} are needed; leave more time before, between and after blows"
        )
    pushes, moves = (
        np.fft.rfft([signal.values[part] - np.mean(signal.values[part]) for part in parts])
        for signal in (force, response)
    )
    of_force = np.mean(np.abs(pushes) ** 2, axis=0)
    across = np.mean(np.conj(pushes) * moves, axis=0)
    whole = np.maximum(of_force * np.mean(np.abs(moves) ** 2, axis=0), 1e-300)
    several = len(parts) > 1
    return FrequencyResponse(
        frequency=np.asarray(np.fft.rfftfreq(size, step), np.float64),
        response=across / np.maximum(of_force, 1e-300),
        coherence=np.abs(across) ** 2 / whole if several else np.full(of_force.size, math.nan),
        blows=len(parts),
    )


def read_impacts(plan: SetPlan, findings: MutableSequence[DataFinding]) -> dict[Feature, NDArray[np.float64]]:
    """Natural frequencies [Hz] of the channels whose signals the records of blows hold.

    Raises
    ------
    MeasurementError
        A file that cannot be read, a record without the signal of the hammer.
    """
    frequencies: dict[str, list[float]] = {}
    for number, impact in enumerate(plan.document.data.impacts):
        asked = {n: c for n, c in plan.channels.items() if c.channel.quantity == "natural_frequency"}
        wanted = (impact.force, *(channel.signal for channel in asked.values()))
        signals = read_signals(plan.folder, impact.file, plan.document.data, wanted)
        if impact.force not in signals:
            key = f"data.impacts.{number}.force"
            raise MeasurementError([unknown(key, impact.force, signals.names, f"signal in {impact.file}")])
        for name, channel in asked.items():
            if channel.signal in signals:
                force, response = signals[impact.force], signals[channel.signal]
                frequencies.setdefault(name, []).extend(
                    _frequency(name, channel, impact, (force, response), findings)
                )
    return {Feature(name, ""): np.array(values) for name, values in frequencies.items() if values}


def _frequency(
    name: str,
    channel: MeasuredChannel,
    impact: Impact,
    signals: tuple[Signal, Signal],
    findings: MutableSequence[DataFinding],
) -> Iterator[float]:
    """The frequency of a channel in one record; nothing, with a finding, where it does not show."""

    def say(identity: str, weight: Weight, text: str) -> None:
        said = f"{impact.file}: {name}: {text}"
        findings.append(DataFinding(id=identity, weight=weight, text=said, channels=(name,)))

    # the hammer rests at zero for most of a record, which looks like a clipped signal
    response = signals[1]
    for identity, weight, text in signal_findings(response):
        say(identity, weight, text)
    if not usable_signal(response):
        return
    if channel.search_range is None:
        say("no_resonance", "dropped", "a response has many peaks; write the search_range of this one")
        return
    try:
        measured = frequency_response(*signals, impact.length)
        if channel.search_range[0] > measured.frequency[-1]:
            raise ValueError(
                f"its samples show frequencies up to {measured.frequency[-1]:.4g} Hz, search_range begins at "
                f"{channel.search_range[0]:.4g} Hz; sample faster, or correct the unit of its time"
            )
        peak = resonance_peak(measured.frequency, np.abs(measured.response), channel.search_range)
    except ValueError as error:
        say("no_resonance", "dropped", str(error))
        return
    near = measured.coherence[int(np.argmin(np.abs(measured.frequency - peak.place)))]
    damping = peak.half_width / peak.place
    said = f"peak at {peak.place:.6g} Hz, damping ratio {damping:.2g}, known to {peak.uncertainty:.2g} Hz"
    if near < LEAST_COHERENCE:
        say(
            "low_coherence",
            "suspect",
            f"{said}: coherence {near:.2g} there, at least {LEAST_COHERENCE:g}; strike again",
        )
    else:
        say("resonance", "note", f"{said}, mean of {measured.blows} blows")
    yield peak.place


def _blows(force: Array, step: float) -> NDArray[np.int64]:
    """Samples at which the hammer strikes."""
    size = np.abs(force)
    hardest = float(size.max())
    if not hardest > 0.0:
        raise ValueError("the hammer gives no force; look at its cable")
    places, _ = find_peaks(size, height=BLOW * hardest, distance=max(int(APART / step), 1))
    if not places.size:
        raise ValueError("no blow is in the record; look at the trigger level")
    return np.asarray(places, np.int64)


def _samples(blows: NDArray[np.int64], count: int, step: float, length: float | None) -> int:
    """Samples of one blow: as asked for, at most to the next one or the end."""
    ends = np.append(blows[1:], count)
    free = int(np.min(ends - blows)) if blows.size > 1 else int(count - blows[0])
    return free if length is None else min(free, int(length / step))


# Peak of an amplitude over speed or frequency: place, half-power width, and how well both are known.
#
# Near a resonance of one mode 1/|X|^2 is a parabola, ((x - x0)^2 + h^2) / c^2 with h = damping ratio times x0, whose
# least squares are linear. It is fitted to the points above the half power, weighted for a constant error of |X|.

HALF_POWER = math.sqrt(0.5)
"""Share of the peak at which the power is half."""
LEAST_POINTS = 4
"""Points a parabola is fitted to."""
ABOVE = 3.0
"""Least height of a peak over the median of what is searched."""


@dataclass(frozen=True, kw_only=True)
class Peak:
    """A peak in the unit of its axis.

    place : x0; half_width : h of the half power, so that h / x0 is the damping ratio; uncertainty : one sigma of the
    place by the scatter about the parabola, at least the spacing of points over the root of 12 times their number
    """

    place: float
    half_width: float
    uncertainty: float


def resonance_peak(x: Array, amplitude: Array, search: tuple[float, float] | None = None) -> Peak:
    """The highest peak of |X| (n,) over x (n,), both in any order, NaN left out.

    search : least and greatest x

    Raises
    ------
    ValueError
        No peak: too few points, the largest one at an end, not above what is around it, or not round.
    """
    known = np.isfinite(x) & np.isfinite(amplitude)
    if search is not None:
        known &= (x >= search[0]) & (x <= search[1])
    order = np.argsort(x[known], kind="stable")
    x, amplitude = x[known][order], amplitude[known][order]
    if x.size < LEAST_POINTS:
        raise ValueError(
            f"{x.size} points there, {LEAST_POINTS} are needed; record slower or widen the search_range"
        )
    top = int(np.argmax(amplitude))
    if top in (0, x.size - 1):
        raise ValueError(
            "the largest amplitude stands at the end of what is searched; widen or shift the search_range"
        )
    height, around = float(amplitude[top]), float(np.median(amplitude))
    if not height > ABOVE * around:
        raise ValueError(
            f"the largest amplitude is {height / max(around, 1e-300):.2g} times the median, {ABOVE:g} is a peak; look "
            "at another order or signal"
        )
    first, last = _flanks(amplitude, top)
    return _fitted(x[first:last], amplitude[first:last])


def _flanks(amplitude: Array, top: int) -> tuple[int, int]:
    """Points of the peak above the half power, and as many more as a fit needs, from the higher neighbour on."""
    first, last = top, top + 1
    level = HALF_POWER * amplitude[top]
    while first > 0 and amplitude[first - 1] >= level:
        first -= 1
    while last < amplitude.size and amplitude[last] >= level:
        last += 1
    while last - first < LEAST_POINTS:
        left = amplitude[first - 1] if first > 0 else -math.inf
        right = amplitude[last] if last < amplitude.size else -math.inf
        first, last = (first - 1, last) if left >= right else (first, last + 1)
    return first, last


def _fitted(x: Array, amplitude: Array) -> Peak:
    centre, scale = float(np.mean(x)), max(float(np.ptp(x)), 1e-300)
    t, y = (x - centre) / scale, (amplitude.max() / amplitude) ** 2
    weight = y**-1.5
    columns = np.stack([t**2, t, np.ones_like(t)], axis=1) * weight[:, None]
    (a, b, c), residual, rank, _ = np.linalg.lstsq(columns, y * weight, rcond=None)
    if rank < 3 or not a > 0.0 or not c > b**2 / (4.0 * a):
        raise ValueError(
            "the largest amplitudes are no resonance of one mode; narrow the search_range or record slower"
        )
    place = -b / (2.0 * a)
    if not t.min() <= place <= t.max():
        raise ValueError("the parabola has its top beside the largest amplitudes; narrow the search_range")
    variance = float(residual[0]) / (x.size - 3) if residual.size and x.size > 3 else 0.0
    gradient = np.array([b / (2.0 * a**2), -1.0 / (2.0 * a), 0.0])
    scatter = math.sqrt(variance * float(gradient @ np.linalg.inv(columns.T @ columns) @ gradient))
    spacing = 1.0 / (x.size - 1) / math.sqrt(12.0 * x.size)
    return Peak(
        place=centre + scale * place,
        half_width=scale * math.sqrt(c / a - place**2),
        uncertainty=scale * math.hypot(scatter, spacing),
    )
