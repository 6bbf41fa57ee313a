"""Spectra of the mesh torque: over run-up and run-down as waterfalls, at the held stages with orders and sidebands.

From the torque that acts in the time run, low-passed over the path and kept as far as three mesh orders of the highest
speed: the law at full resolution, seen at the ends of the steps, would show its harmonics beyond half the step rate as
orders that no rig has. Blocks of a waterfall are as long as the sweep allows: in T the mesh frequency moves by 1 / T.
"""

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from dynamics.vibration.response_curve import CurvePoint
from dynamics.vibration.schedule import Stage
from dynamics.vibration.time_response import TimeResponse
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.time_run import schedule_of
from rigdesign.postprocessing.curves import own_ratio
from rigdesign.postprocessing.dynamics import DynamicRun
from rigdesign.results.vibration import HeldSpectrum, Waterfall
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]
SHORTEST, LONGEST = 256, 32768
"""Samples of a block of a waterfall."""
DIGITS = 4
"""Significant digits of the amplitudes of a waterfall: it is looked at, not computed with."""
OVERLAP = 0.5
MOST_SPEEDS, MOST_FREQUENCIES = 72, 160
"""Cells of a waterfall; each keeps its largest amplitude."""
MESH_ORDERS = 1.25
"""Highest frequency of a waterfall over the mesh frequency at its highest speed; modes go as far."""
ORDERS = 1600
"""Points of the spectrum of a held stage, each the largest around it."""
SHOWN_ORDERS = 3.1
"""Mesh orders up to which it is shown: three with their sidebands. Above, the tables of the march leave traces of
orders beyond the step rate, 1e-4 of the first mesh order."""
LEAST_SAMPLES = 4096
"""Of a held stage, below which it has no spectrum."""
HIGHEST_HARMONIC = 4
"""Mesh order up to which the periodic response is shown."""
MOST_LINES, LEAST_LINE = 240, 1e-5
"""Lines of its spectrum, and the least amplitude of one over the highest."""
SETTLED = 0.25
"""Share of a held stage left out at its beginning: what its start has set off dies down."""


def waterfalls(rig: Rig, run: DynamicRun) -> Iterator[Waterfall]:
    """Of every mesh in the run-up and in the run-down over the widest range of speed; none without torques kept."""
    if not run.ramp.torque.size:
        return
    sweeps = [span for span in _spans(rig) if span[0].kind == "speed"]
    for sign in (1.0, -1.0):
        own = [span for span in sweeps if sign * _change(span[0]) > 0.0]
        if own:
            widest = max(own, key=lambda span: abs(_change(span[0])))
            for mesh in range(len(rig.mesh_names)):
                yield from _waterfall(rig, run.ramp, mesh, widest)


def _change(stage: Stage) -> float:
    return stage.speed[1] - stage.speed[0]


def _waterfall(
    rig: Rig, ramp: TimeResponse, mesh: int, span: tuple[Stage, float, float]
) -> Iterator[Waterfall]:
    """That of one mesh in a stage; none if the stage is too short for two blocks."""
    stage, start, end = span
    name = rig.mesh_names[mesh]
    ratio, teeth, rate = own_ratio(rig, mesh), rig.pairs[name].teeth[0], 1.0 / ramp.torque_step
    sweep = teeth * ratio * abs(_change(stage)) / (2.0 * math.pi) / (end - start)
    size = int(np.clip(2 ** round(math.log2(rate / math.sqrt(sweep))), SHORTEST, LONGEST))
    torque, speed = _part(ramp, mesh, start, end)
    if torque.size < 2 * size:
        return
    highest = MESH_ORDERS * teeth * ratio * max(stage.speed) / (2.0 * math.pi)
    middles, frequency, amplitude = _blocks(torque, size, rate, min(highest, ramp.torque_band))
    places = _pooled_speeds(speed[middles], amplitude)
    bins = _pooled_frequencies(frequency, places[1])
    yield Waterfall(
        mesh=rig.mesh_labels[name],
        stage=stage.name,
        speed=tuple((ratio * places[0]).tolist()),
        frequency=tuple(bins[0].tolist()),
        amplitude=tuple(tuple(float(f"{value:.{DIGITS}g}") for value in row) for row in bins[1].tolist()),
        per_turn=float(teeth),
    )


def _part(ramp: TimeResponse, mesh: int, start: float, end: float) -> tuple[Array, Array]:
    """Torque of a mesh between two times (n,) [N m], and the speed of the first pinion then [rad/s]."""
    begin = float(ramp.time[0]) - float(ramp.time[1] - ramp.time[0])
    first, last = (round((at - begin) / ramp.torque_step) for at in (start, end))
    torque = np.asarray(ramp.torque[mesh, first:last], float)
    time = begin + ramp.torque_step * (first + 1.0 + np.arange(torque.size))
    return torque, np.interp(time, ramp.time, ramp.speed)


def held_spectra(rig: Rig, run: DynamicRun) -> Iterator[HeldSpectrum]:
    """Of every mesh at every held point."""
    for point in run.points:
        for mesh in range(len(rig.mesh_names)):
            yield _held(rig, run, point, mesh)


def _held(rig: Rig, run: DynamicRun, point: PointResult, mesh: int) -> HeldSpectrum:
    response = point.last.response
    assert response is not None
    name = rig.mesh_names[mesh]
    teeth = rig.pairs[name].teeth[0]
    speed = own_ratio(rig, mesh) * response.speed
    order, amplitude = _orders_of_run(rig, run, point.point.stage, mesh)
    harmonic_order, harmonic_amplitude = _orders_of_wave(response, mesh, teeth, speed)
    return HeldSpectrum(
        mesh=rig.mesh_labels[name],
        stage=point.point.stage,
        speed=speed,
        mean=abs(float(response.mean[mesh])),
        order=tuple(order.tolist()),
        amplitude=tuple(amplitude.tolist()),
        harmonic_order=tuple(harmonic_order.tolist()),
        harmonic_amplitude=tuple(harmonic_amplitude.tolist()),
        teeth=teeth,
    )


def _orders_of_wave(point: CurvePoint, mesh: int, teeth: int, speed: float) -> tuple[Array, Array]:
    """Orders of the pinion and amplitudes of the periodic response; speed : of the pinion [rad/s].

    Up to the fourth mesh order and some; of more than `MOST_LINES` lines those that are highest.
    """
    wave = point.wave
    count = wave.time.size
    base = 2.0 * math.pi / (count * float(wave.time[1] - wave.time[0]))
    top = min(count // 4, int((HIGHEST_HARMONIC + 0.5) * teeth * speed / base))
    amplitude = 2.0 * np.abs(np.fft.rfft(wave.torque[mesh]))[1 : top + 1] / count
    lines = np.sort(np.argsort(-amplitude, kind="stable")[:MOST_LINES])
    lines = lines[amplitude[lines] > LEAST_LINE * amplitude.max(initial=0.0)]
    return base / speed * (lines + 1.0), amplitude[lines]


def _orders_of_run(rig: Rig, run: DynamicRun, stage: str, mesh: int) -> tuple[Array, Array]:
    """Orders of the pinion and amplitudes in the settled part of a stage of the time run; none without torques."""
    nothing = np.zeros(0)
    found = next(((start, end) for own, start, end in _spans(rig) if own.name == stage), None)
    if not run.ramp.torque.size or found is None:
        return nothing, nothing
    start, end = found
    torque, speed = _part(run.ramp, mesh, start + SETTLED * (end - start), end)
    if torque.size < LEAST_SAMPLES or not speed.mean() > 0.0:
        return nothing, nothing
    turn = own_ratio(rig, mesh) * float(speed.mean()) / (2.0 * math.pi)
    order, amplitude = order_spectrum(torque, turn * run.ramp.torque_step)
    last = SHOWN_ORDERS * rig.pairs[rig.mesh_names[mesh]].teeth[0]
    kept = (order * turn <= run.ramp.torque_band) & (order <= last)
    return _pooled(order[kept], amplitude[kept], ORDERS)


def order_spectrum(torque: Array, turned: float) -> tuple[Array, Array]:
    """Orders (n,) and amplitudes of samples at a steady speed, over the last whole turns: orders are then lines of the
    transform, and their amplitudes those of the window's middle.

    turned : turns from sample to sample [-]; less than one turn in all is taken as it is
    """
    whole = math.floor(torque.size * turned)
    size = round(whole / turned) if whole else torque.size
    frequency, amplitude = spectrum(torque[None, torque.size - size :], 1.0 / turned)
    return frequency, amplitude[0]


def _spans(rig: Rig) -> Iterator[tuple[Stage, float, float]]:
    """Every stage with its start and end in the time run [s]."""
    schedule = schedule_of(rig)
    yield from (
        (stage, float(start), float(end))
        for stage, start, end in zip(schedule.stages, schedule.starts[:-1], schedule.starts[1:])
    )


def spectrum(blocks: Array, rate: float) -> tuple[Array, Array]:
    """Frequencies (f,) [Hz] and amplitudes (b, f) of blocks (b, n) under a Hann window, means taken out."""
    size = blocks.shape[1]
    window = np.hanning(size + 1)[:-1]
    values = (blocks - blocks.mean(axis=1, keepdims=True)) * window
    amplitude = 2.0 * np.abs(np.fft.rfft(values, axis=1)) / window.sum()
    return np.asarray(np.fft.rfftfreq(size, 1.0 / rate), float), np.asarray(amplitude, float)


def _blocks(torque: Array, size: int, rate: float, highest: float) -> tuple[NDArray[np.int64], Array, Array]:
    """Middle sample of every block, frequencies up to the highest [Hz], amplitudes (blocks, f)."""
    step = int(size * (1.0 - OVERLAP))
    views = np.lib.stride_tricks.sliding_window_view(torque, size)[::step]
    frequency, amplitude = spectrum(views, rate)
    kept = (frequency > 0.0) & (frequency <= highest)
    return size // 2 + step * np.arange(len(views)), frequency[kept], amplitude[:, kept]


def _pooled_speeds(speed: Array, amplitude: Array) -> tuple[Array, Array]:
    """Middles of even cells of speed, rising, and the largest amplitudes of the blocks in each; empty cells dropped."""
    edges = np.linspace(speed.min(), speed.max(), min(MOST_SPEEDS, len(speed)) + 1)
    cell = np.clip(np.searchsorted(edges, speed, side="right") - 1, 0, edges.size - 2)
    used = np.unique(cell)
    middles = 0.5 * (edges[:-1] + edges[1:])
    return middles[used], np.array([amplitude[cell == i].max(axis=0) for i in used])


def _pooled_frequencies(frequency: Array, amplitude: Array) -> tuple[Array, Array]:
    """Middles of even cells of frequency and the largest amplitudes in each (s, f)."""
    count = -(-frequency.size // MOST_FREQUENCIES)
    starts = np.arange(0, frequency.size, count)
    ends = np.minimum(starts + count, frequency.size) - 1
    return 0.5 * (frequency[starts] + frequency[ends]), np.maximum.reduceat(amplitude, starts, axis=1)


def _pooled(order: Array, amplitude: Array, most: int) -> tuple[Array, Array]:
    """The largest of every group of neighbours, with its order."""
    count = -(-order.size // most)
    starts = np.arange(0, order.size, count)
    best = [start + int(np.argmax(amplitude[start : start + count])) for start in starts]
    return order[best], amplitude[best]
