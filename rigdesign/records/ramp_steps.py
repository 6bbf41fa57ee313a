"""The recommended ramp, step by step with its reason: P2, Figure 9, at the speeds and torques of the rig.

Braced at rest, up to the speed at which the bearings float, part of the torque, without a stop through the resonances,
full torque at the test speed: above the highest resonance of a mesh none is passed under it.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from rigdesign.records.dynamics import DynamicRun
from rigdesign.records.resonance_bands import nearest_safe
from rigdesign.results.dwell import AvoidedBand, RampStep
from rigdesign.results.units import RPM
from rigdesign.rig.model import Rig

TOUCHING = 0.05
"""Share of the test torque that closes the flanks, where the case states none."""
USUAL_SHARE = 0.5
"""Of the test torque on the way up (P2, Figure 9), where the case states none."""


@dataclass(frozen=True, kw_only=True)
class RampLimits:
    """What the ramp follows from; speeds of the first pinion [rad/s]."""

    run: DynamicRun
    bands: Sequence[AvoidedBand]
    safe: Sequence[tuple[float, float]]
    range: tuple[float, float]


def ramp_steps(rig: Rig, found: RampLimits) -> Iterator[RampStep]:
    """From rest to the test point and back."""
    case = rig.case
    test, torque = rig.pinion_speed(case.schedule.test_speed), case.schedule.test_torque
    start = min(case.limits.bearing.start_torque_limit or TOUCHING * torque, USUAL_SHARE * torque)
    top = _highest_resonance(found)
    yield RampStep(
        action="brace at rest",
        speed=0.0,
        torque=start,
        reason="closes the flanks before the rig turns; bearings without a film carry no more than this",
    )
    first, reason = _first_speed(rig, found, test)
    yield RampStep(action="run up", speed=first, torque=start, reason=reason)
    passed = max(_factors(found, first, test), default=1.0)
    share = min(case.limits.ramp.run_up_torque_share_maximum or USUAL_SHARE, 1.0 / passed)
    if test > first:
        yield RampStep(
            action="raise the torque in part",
            speed=first,
            torque=share * torque,
            reason=f"K_V up to {passed:.2f} is passed on the way up: {share:.2f} of the test torque stays below "
            f"{share * passed:.2f} of it at its peak",
        )
        yield RampStep(
            action="run up without a stop",
            speed=test,
            torque=share * torque,
            reason=_passing(found, first, test),
        )
    yield RampStep(
        action="raise to the test torque", speed=test, torque=torque, reason=_full(found, top, test)
    )
    yield RampStep(action="dwell", speed=test, torque=torque, reason=_dwell(found, test))
    if test > first:
        yield RampStep(
            action="relieve",
            speed=test,
            torque=share * torque,
            reason="the resonances are passed again on the way down",
        )
        yield RampStep(
            action="run down without a stop", speed=first, torque=share * torque, reason="as on the way up"
        )
    yield RampStep(
        action="relieve and stop",
        speed=0.0,
        torque=start,
        reason="no more than the start torque while the bearings lose their film",
    )


def _first_speed(rig: Rig, found: RampLimits, test: float) -> tuple[float, str]:
    """Speed at which the torque is first raised, moved out of an avoided band, and why."""
    floating = rig.case.limits.ramp.transition_speed
    speeds = [
        rig.pinion_speed(stage.speed_end) for stage in rig.case.schedule.resolved() if stage.speed_end > 0.0
    ]
    wanted = min(rig.pinion_speed(floating) if floating else speeds[0], test)
    why = "the bearings float from here on" if floating else "first speed of the schedule"
    band = _band(found.bands, wanted)
    if band is None or wanted >= test:
        return wanted, why
    least = wanted if floating else 0.0
    windows = [(max(low, least), high) for low, high in found.safe if low <= test and high > least]
    safe = nearest_safe(windows, wanted)
    if safe is None:
        return wanted, f"{why}; no speed from there to the test speed lies outside the avoided bands"
    return safe, f"{why}; moved from {wanted * RPM:.0f} rpm, which lies in the band {_span(band)}"


def _factors(found: RampLimits, first: float, test: float) -> Iterator[float]:
    """K_V of all meshes and curves between two speeds."""
    for _, curve in found.run.curves.named.values():
        for point in curve.points:
            if first <= point.speed <= test:
                yield float(point.dynamic_factor.max())


def _highest_resonance(found: RampLimits) -> float | None:
    """Highest speed at which a mesh has a peak of K_V above the stated share."""
    peaks = [one.speed for band in found.bands for one in band.resonances if one.kind == "dynamic factor"]
    return max(peaks, default=None)


def _passing(found: RampLimits, first: float, test: float) -> str:
    passed = [band for band in found.bands if band.high > first and band.low < test]
    if not passed:
        return "no band is to be avoided on the way"
    spans = (f"{max(band.low, first) * RPM:.0f} to {min(band.high, test) * RPM:.0f} rpm" for band in passed)
    return f"avoided bands on the way: {'; '.join(spans)}"


def _full(found: RampLimits, top: float | None, test: float) -> str:
    if top is None:
        return "no mesh has a resonance above the stated share in the speeds computed"
    if test > top:
        above = test / top - 1.0
        return (
            f"{100.0 * above:.0f} % above the highest main resonance of a mesh at {top * RPM:.0f} rpm: none is passed "
            "under full torque"
        )
    return (
        f"the highest main resonance of a mesh, {top * RPM:.0f} rpm, lies above the test speed and is not reached: the "
        "torque is raised where the rig dwells, after all resonances below have been passed in part load"
    )


def _dwell(found: RampLimits, test: float) -> str:
    if not found.range[0] <= test <= found.range[1]:
        return "the response is not computed at this speed"
    band = _band(found.bands, test)
    if band is None:
        return "outside all avoided bands"
    safe = nearest_safe(found.safe, test)
    nearest = min(band.resonances, key=lambda one: one.distance(test))
    instead = (
        "no speed computed is safe" if safe is None else f"nearest safe speed {_outward(safe, test)} rpm"
    )
    return (
        f"lies in the avoided band {_span(band)}: {nearest.kind} of {nearest.where.replace('_', ' ')} peaks at "
        f"{nearest.speed * RPM:.0f} rpm, {100.0 * nearest.distance(test):.1f} % away; {instead}"
    )


def _outward(safe: float, test: float) -> int:
    """A safe speed in whole rpm, away from the band."""
    return math.ceil(safe * RPM) if safe > test else math.floor(safe * RPM)


def _band(bands: Sequence[AvoidedBand], speed: float) -> AvoidedBand | None:
    return next((band for band in bands if band.low < speed < band.high), None)


def _span(band: AvoidedBand) -> str:
    return f"{band.low * RPM:.0f} to {band.high * RPM:.0f} rpm"
