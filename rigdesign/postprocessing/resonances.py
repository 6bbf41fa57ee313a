"""Peaks of the dynamic torque over speed, named by what vibrates."""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dynamics.rating.dynamic_factor import DynamicFactorCurve, Resonance
from dynamics.rating.dynamic_factor import resonances as find_resonances
from dynamics.rotor.torsional_modes import LoopMode
from dynamics.vibration.response_curve import CurvePoint, ResponseCurve
from rigdesign.coupling.time_run import held_points
from rigdesign.postprocessing.curves import HARMONICS, LEAST_GAIN, Curves, own_ratio
from rigdesign.results.loads import MeshResonance
from rigdesign.results.vibration import NEAR, AvoidedBand, AvoidedResonance, ResonanceKind
from rigdesign.rig.model import Rig

LEAST_PROMINENCE = 0.01
"""Prominence of a peak of the dynamic torque, as a share of the mean, from which it counts as a resonance."""
LEAST_ORDER = 0.1
"""Amplitude of an order, over that of the strongest one, from which it may name a resonance."""


def mesh_resonances(
    rig: Rig, curves: Curves, mesh: int, modes: Sequence[LoopMode]
) -> Iterator[MeshResonance]:
    """Resonances of one mesh at every torque of the curves, over the speed of its own pinion."""
    limits = rig.case.limits.dynamics
    ratio = own_ratio(rig, mesh)
    teeth = ratio * rig.pairs[rig.mesh_names[mesh]].teeth[0]
    fastest = rig.pinion_speed(max(point.speed for point in held_points(rig)))
    for name, (_, curve) in curves.named.items():
        if len(curve.points) < 3:
            continue
        searched = curve.speeds[-1] > fastest  # a ramp stage ends where the next one takes over
        for peak in find_resonances(_of_mesh(curve, mesh), least_prominence=LEAST_PROMINENCE):
            if peak.at_end and not searched:
                continue
            mode, frequency, harmonic = name_of(peak, curve, mesh, teeth, modes)
            yield MeshResonance(
                torque=name,
                mode=mode,
                frequency=frequency,
                harmonic=harmonic,
                speed=ratio * peak.speed,
                dynamic_factor=peak.factor,
                force_share=peak.force_share,
                amplification=peak.amplification,
                at_end=peak.at_end,
                dangerous=peak.amplification > limits.dangerous_amplification
                or peak.force_share > limits.dangerous_force_share,
            )


def _of_mesh(curve: ResponseCurve, mesh: int) -> DynamicFactorCurve:
    points = curve.points
    return DynamicFactorCurve(
        speed=curve.speeds,
        factor=np.array([[p.dynamic_factor[mesh] for p in points]]),
        mean_torque=np.array([[p.mean[mesh] for p in points]]),
        amplitude=np.array([[0.5 * (p.maximum[mesh] - p.minimum[mesh]) for p in points]]),
        lift_off_share=np.array([[p.lift_off_share[mesh] for p in points]]),
    )


def name_of(
    peak: Resonance, curve: ResponseCurve, mesh: int, teeth: float, modes: Sequence[LoopMode]
) -> tuple[str, float, int]:
    """Mode, frequency [Hz] and order that make a peak.

    A mode counts if an order of the mesh meets it within half its line width or the step of the speeds, if the
    mesh excites it and the order is there; of several the one with most gain times amplitude. With none it is
    looked for more widely and called ``near``; failing that the strongest order stands alone: the peak has
    several parents, or one above the modes that are listed.

    teeth : mesh frequency over the turning frequency of the first pinion
    """
    at = int(np.argmin(np.abs(curve.speeds - peak.speed)))
    amplitude = _amplitudes(curve.points[at], mesh)
    base = peak.speed * teeth / (2.0 * math.pi)
    around = curve.speeds[max(at - 1, 0) : at + 2]
    step = 0.5 * float(np.ptp(around)) * teeth / (2.0 * math.pi) / max(len(around) - 1, 1)
    strongest = int(np.argmax(amplitude)) + 1
    candidates = [
        (harmonic, height, mode, abs(harmonic * base - mode.frequency))
        for harmonic, height in enumerate(amplitude.tolist(), start=1)
        for mode in modes
        if height >= LEAST_ORDER * amplitude.max() and mode.mesh_gain[mesh] >= LEAST_GAIN
    ]
    meeting = [c for c in candidates if c[3] <= max(c[2].damping_ratio * c[2].frequency, c[0] * step)]
    near = [c for c in candidates if c[3] <= NEAR * c[2].frequency]
    if not near and not meeting:
        return "no single mode", strongest * base, strongest
    harmonic, _, mode, _ = max(meeting or near, key=lambda c: float(c[1] * c[2].mesh_gain[mesh]))
    return (mode.name if meeting else f"near {mode.name}"), mode.frequency, harmonic


def _amplitudes(point: CurvePoint, mesh: int) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Amplitudes of the orders 1 to `HARMONICS` of the dynamic torque [N m], zero where none was computed."""
    amplitude = np.zeros(HARMONICS)
    own = point.harmonics[mesh, 1 : HARMONICS + 1]
    amplitude[: own.size] = own
    return amplitude


# Speeds around the peaks of the response: where the dynamic part exceeds a stated share, and nearer than a margin.
#
# The share is ``limits.dynamics.dangerous_force_share``, the margin ``limits.dynamics.resonance_distance_minimum``.

Array = NDArray[np.float64]
USUAL_MARGIN = 0.1
"""Margin of a case that states none."""


@dataclass(frozen=True)
class DynamicShare:
    """Dynamic part over the mean of one quantity over rising speeds of the first pinion, (s,) each."""

    kind: ResonanceKind
    where: str
    speed: Array
    share: Array


def resonances(quantity: DynamicShare, limit: float, margin: float) -> Iterator[AvoidedResonance]:
    """One for each interval in which the share exceeds the limit, widened to the margin round its peak."""
    speed, share = quantity.speed, quantity.share
    above = np.concatenate(([False], share > limit, [False]))
    edges = np.flatnonzero(np.diff(above.astype(int)))
    for first, last in zip(edges[::2], edges[1::2]):
        peak = first + int(np.argmax(share[first:last]))
        at = float(speed[peak])
        low = _crossing(speed, share, first - 1, limit) if first else float(speed[0])
        high = _crossing(speed, share, last - 1, limit) if last < speed.size else float(speed[-1])
        found = AvoidedResonance(
            kind=quantity.kind, where=quantity.where, speed=at, share=float(share[peak]), low=low, high=high
        )
        yield found.widened(margin)


def _crossing(speed: Array, share: Array, place: int, limit: float) -> float:
    """Where the share passes the limit between two speeds."""
    a, b = share[place], share[place + 1]
    return float(speed[place] + (limit - a) / (b - a) * (speed[place + 1] - speed[place]))


def bands(found: Iterable[AvoidedResonance]) -> tuple[AvoidedBand, ...]:
    """Resonances that touch or overlap as one band, rising."""
    groups: list[list[AvoidedResonance]] = []
    top = -np.inf
    for one in sorted(found, key=lambda resonance: resonance.low):
        if one.low > top:
            groups.append([])
        groups[-1].append(one)
        top = max(top, one.high)
    return tuple(
        AvoidedBand(
            low=min(one.low for one in group),
            high=max(one.high for one in group),
            resonances=tuple(sorted(group, key=lambda one: one.speed)),
        )
        for group in groups
    )


def safe_windows(avoided: Sequence[AvoidedBand], low: float, high: float) -> tuple[tuple[float, float], ...]:
    """What the bands leave of a range of speeds."""
    found, at = [], low
    for band in avoided:
        if band.low > at:
            found.append((at, min(band.low, high)))
        at = max(at, band.high)
        if at >= high:
            break
    if at < high:
        found.append((at, high))
    return tuple((a, b) for a, b in found if b > a)


def nearest_safe(windows: Sequence[tuple[float, float]], speed: float) -> float | None:
    """Safe speed nearest to one; None where there is none."""
    places = [min(max(speed, low), high) for low, high in windows]
    return min(places, key=lambda place: abs(place - speed), default=None)
