"""At which speeds the rig may dwell: bands of the response to avoid, stages in them, the ramp that follows."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rigdesign.case.component_limits import shafts_of
from rigdesign.case.schedule import StageValues
from rigdesign.postprocessing.curves import dwell_stages, is_around
from rigdesign.postprocessing.dynamics import DynamicRun
from rigdesign.postprocessing.nearest_resonance import (
    NearDwell,
    bounds_of,
    mesh_resonances,
    mesh_shares,
    order_resonances,
    root_shares,
    shaft_shares,
)
from rigdesign.postprocessing.resonances import DynamicShare, bands, nearest_safe, safe_windows
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.postprocessing.start_torque import (
    USUAL_SHARE,
    StagePeak,
    StartResponse,
    first_speed,
    start_torque,
    worst_start,
)
from rigdesign.results.units import RPM
from rigdesign.results.vibration import (
    SHAFT_SHARE,
    AvoidedBand,
    AvoidedResonance,
    CampbellRecord,
    DwellRecord,
    DwellStage,
    NearResonance,
    RampStep,
    ResonanceKind,
    SectionTorqueRecord,
)
from rigdesign.rig.model import Rig

# The recommended ramp, step by step with its reason: P2, Figure 9, at the speeds and torques of the rig.
#
# Braced at rest, up to the speed at which the bearings float and the start torque keeps the flanks in contact, part of
# the torque, without a stop through the resonances, full torque at the test speed: above the highest resonance of a
# mesh none is passed under it.


@dataclass(frozen=True)
class SpeedLimit:
    """Highest speed of the first pinion [rad/s], and the key that states it."""

    speed: float
    source: str


@dataclass(frozen=True, kw_only=True)
class RampLimits:
    """What the ramp follows from; speeds of the first pinion [rad/s].

    near : the nearest resonance of every speed at which the rig dwells and whose response is computed
    limit : None where the case states none; start : None where it is not computed
    up, down : worst of the time run under the start torque, None where the schedule does not turn under it
    """

    run: DynamicRun
    bands: Sequence[AvoidedBand]
    safe: Sequence[tuple[float, float]]
    near: Mapping[float, NearResonance]
    limit: SpeedLimit | None
    start: StartResponse | None
    up: StagePeak | None
    down: StagePeak | None

    def band_at(self, speed: float) -> AvoidedBand | None:
        """The band in which a speed lies."""
        return next((band for band in self.bands if band.low < speed < band.high), None)


def ramp_steps(rig: Rig, found: RampLimits) -> Iterator[RampStep]:
    """From rest to the test point and back."""
    case = rig.case
    wanted, torque = rig.pinion_speed(case.schedule.test_speed), case.schedule.test_torque
    test = _dwell_speed(found, wanted)
    start = start_torque(rig)
    top = _highest_resonance(found)
    yield RampStep(
        action="brace at rest",
        speed=0.0,
        torque=start,
        reason="closes the backlash before the rig turns; highest load of bearings without a film",
    )
    first, reason = _first_speed(rig, found, test)
    yield RampStep(
        action="run up",
        speed=first,
        torque=start,
        reason="; ".join([reason, *_passed(found.up), *_lost(found)]),
    )
    passed = max(_factors(found, first, test), default=1.0)
    share = min(case.limits.ramp.run_up_torque_share_maximum or USUAL_SHARE, 1.0 / passed)
    if test > first:
        yield RampStep(
            action="raise the torque in part",
            speed=first,
            torque=share * torque,
            reason=f"K_V reaches {passed:.2f} between here and the dwell at the torques of the curves: "
            f"{share:.2f} of the test torque peaks at no more than {share * passed:.2f} of it",
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
    yield RampStep(action="dwell", speed=test, torque=torque, reason=_dwell(found, wanted))
    if test > first:
        yield RampStep(
            action="relieve",
            speed=test,
            torque=share * torque,
            reason="the resonances are passed again during run-down",
        )
        yield RampStep(
            action="run down without a stop",
            speed=first,
            torque=share * torque,
            reason="as during run-up",
        )
    yield RampStep(
        action="relieve and stop",
        speed=0.0,
        torque=start,
        reason="; ".join(
            ["at most the start torque while the bearings lose their film", *_passed(found.down)]
        ),
    )


def _dwell_speed(found: RampLimits, wanted: float) -> float:
    """Where the ramp dwells: at the test speed, or in whole rpm outside the avoided band in which that lies, where it
    can."""
    safe = None if found.band_at(wanted) is None else nearest_safe(found.safe, wanted)
    return wanted if safe is None else _outward(safe, wanted) / RPM


def _first_speed(rig: Rig, found: RampLimits, test: float) -> tuple[float, str]:
    """Speed at which the torque is first raised, and why: moved up to where the start torque keeps the flanks in
    contact, then out of an avoided band, never back to where they part."""
    floating = rig.case.limits.ramp.transition_speed
    wanted = first_speed(rig)
    why = "the bearings float from here on" if floating else "first speed of the schedule"
    if wanted >= test:
        return test, why if wanted == test else "speed of the dwell"
    raised = False
    if found.start is not None and not found.start.holds_at(wanted):
        contact = found.start.next_held(wanted)
        if contact is None or contact >= test:
            why += "; contact is lost here under the start torque, and at all higher speeds computed"
        else:
            place = f"the bearings float from {_rpm(wanted)} on" if floating else f"{why}, {_rpm(wanted)}"
            why = (
                f"{place}, at which contact is lost under the start torque; raised to the next speed without contact "
                "loss"
            )
            wanted, raised = contact, True
    band = found.band_at(wanted)
    if band is None:
        return wanted, why
    least = wanted if floating or raised else 0.0
    windows = [(max(low, least), high) for low, high in found.safe if high > least]
    held = windows if found.start is None else found.start.held(windows)
    safe = nearest_safe([(low, high) for low, high in held if low <= test], wanted)
    if safe is None:
        return wanted, f"{why}; no speed up to the test speed lies outside the avoided bands"
    return safe, f"{why}; moved from {_rpm(wanted)}, which lies in the band {_span(band)}"


def _passed(worst: StagePeak | None) -> Iterator[str]:
    """What the time run passes under the start torque."""
    if worst is not None:
        stage = worst.stage.replace("_", " ")
        yield (
            f"under the start torque the time run reaches K_V {worst.factor:.2f} at {_rpm(worst.speed)} in stage "
            f"{stage}, contact is {'lost' if worst.lost else 'kept'}"
        )


def _lost(found: RampLimits) -> Iterator[str]:
    """Where contact is lost under the start torque."""
    spans = [] if found.start is None else found.start.spans()
    if spans:
        where = ", ".join(
            f"{low * RPM:.0f} to {_rpm(high)}" if high > low else f"near {_rpm(low)}" for low, high in spans
        )
        yield f"hold no speed at which contact is lost in the periodic response: {where}"


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
        return "no avoided band is passed"
    spans = (f"{max(band.low, first) * RPM:.0f} to {min(band.high, test) * RPM:.0f} rpm" for band in passed)
    return f"avoided bands passed: {'; '.join(spans)}"


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
        f"the highest main resonance of a mesh, {top * RPM:.0f} rpm, lies above the speed of the dwell and is not "
        "reached: the torque is raised at the dwell speed, after all lower resonances have been passed at part load"
    )


def _dwell(found: RampLimits, test: float) -> str:
    near = found.near.get(test)
    if near is None:
        return "the response is not computed at this speed"
    above = found.limit is not None and test > found.limit.speed * (1.0 + 1e-9)
    beyond = f"above the limit of the rig, {_limit(found.limit)}; " if above and found.limit else ""
    band = found.band_at(test)
    if band is None:
        return f"{beyond}outside all avoided bands"
    why = f"{beyond}the test speed, {_rpm(test)}, lies in the avoided band {_span(band)}"
    if near.resonance is not None:
        one = near.resonance
        away = f"{100.0 * abs(one.speed - test) / test:.1f} % away"
        why += f": {one.kind} of {one.where.replace('_', ' ')} peaks at {_rpm(one.speed)}, {away}"
    return f"{why}; {_instead(found, test)}"


def _instead(found: RampLimits, test: float) -> str:
    """The nearest safe speed, at which the ramp dwells; that there is none above within the limit of the rig, where it
    lies below."""
    safe = nearest_safe(found.safe, test)
    none_above = (
        f"none above it up to the limit of the rig, {_limit(found.limit)}"
        if found.limit is not None
        else "none above it in the speeds computed"
    )
    if safe is None:
        return "no speed computed is safe within the limits of the rig"
    text = f"nearest safe speed {_outward(safe, test)} rpm"
    return text if any(high > test for _, high in found.safe) else f"{text}, {none_above}"


def _limit(limit: SpeedLimit | None) -> str:
    return "" if limit is None else f"{_rpm(limit.speed)} ({limit.source})"


def _outward(safe: float, test: float) -> int:
    """A safe speed in whole rpm, away from the band."""
    return math.ceil(safe * RPM - 1e-6) if safe > test else math.floor(safe * RPM + 1e-6)


def _rpm(speed: float) -> str:
    return f"{speed * RPM:.0f} rpm"


def _span(band: AvoidedBand) -> str:
    return f"{band.low * RPM:.0f} to {band.high * RPM:.0f} rpm"


def speed_limit(rig: Rig) -> SpeedLimit | None:
    """The lowest of ``limits.bought_parts`` with quantity speed; None where the case states none."""
    found = []
    for name, part in rig.case.limits.bought_parts.items():
        if part.quantity == "speed":
            shafts = shafts_of(rig.case, part.part)
            ratio = max((abs(rig.shaft_speed(shaft, 1.0)) for shaft in shafts), default=0.0)
            if ratio > 0.0:
                found.append(
                    SpeedLimit(rig.pinion_speed(part.limit_si / ratio), f"limits.bought_parts.{name}")
                )
    return min(found, key=lambda one: one.speed, default=None)


def dwell_record(solved: SolvedRig, torques: SectionTorqueRecord) -> DwellRecord:
    """Bands over all speeds of the governing curve of a rig with loads; speeds above the limit of the rig are none to
    dwell at."""
    rig, run, loads, vibration = solved.rig, solved.run, solved.loads, solved.vibration
    assert run is not None and loads is not None
    bounds, limit = bounds_of(rig), speed_limit(rig)
    speeds = torques.speeds
    others = [*root_shares(rig, loads), *shaft_shares(rig, speeds, torques.curves)]
    low, high = speeds[0], speeds[-1]
    avoided = bands(
        [
            *mesh_resonances(rig, run, loads),
            *bounds.resonances(others),
            *_orders(vibration.campbell, solved.near_dwells, bounds.margin),
        ]
    )
    safe = safe_windows(avoided, low, high if limit is None else min(high, limit.speed))
    limits = RampLimits(
        run=run,
        bands=avoided,
        safe=safe,
        near={speed: one.nearest for speed, one in solved.near_dwells.items()},
        limit=limit,
        start=vibration.start,
        up=worst_start(rig, loads, 1),
        down=worst_start(rig, loads, -1),
    )
    return DwellRecord(
        share_limit=bounds.share,
        shaft_share_limit=SHAFT_SHARE,
        margin=bounds.margin,
        low=low,
        high=high,
        speed_limit=None if limit is None else limit.speed,
        speed_limit_source="" if limit is None else limit.source,
        bands=avoided,
        safe=safe,
        stages=tuple(_stages(rig, limits)),
        ramp=tuple(ramp_steps(rig, limits)),
        speeds=speeds,
        highest=_highest([*mesh_shares(rig, run), *others], speeds),
    )


def _orders(
    diagram: CampbellRecord, nearby: Mapping[float, NearDwell], margin: float
) -> Iterator[AvoidedResonance]:
    """Crossings of shaft orders over speed; around a dwell speed those with the modes at the nearest one."""
    names = {mode.number: mode.name for mode in diagram.modes}
    for one in order_resonances(diagram.crossings, names, margin):
        if _around(one.speed, nearby) is None:
            yield one
    for dwell, near in nearby.items():
        for one in near.orders:
            if _around(one.speed, nearby) == dwell:
                yield one


def _around(speed: float, dwells: Iterable[float]) -> float | None:
    """The nearest of the dwell speeds around which a speed lies; None if there is none."""
    near = (dwell for dwell in dwells if is_around(speed, dwell))
    return min(near, key=lambda dwell: abs(dwell - speed), default=None)


def _highest(
    shares: Sequence[DynamicShare], speeds: Sequence[float]
) -> dict[ResonanceKind, tuple[float, ...]]:
    """Largest share of every kind at some speeds; each counts where it was computed."""
    found: dict[ResonanceKind, np.ndarray[tuple[int], np.dtype[np.float64]]] = {}
    for one in shares:
        values = np.interp(speeds, one.speed, one.share, left=0.0, right=0.0)
        found[one.kind] = np.maximum(found.get(one.kind, np.zeros(len(speeds))), values)
    return {kind: tuple(values.tolist()) for kind, values in found.items()}


def _stages(rig: Rig, found: RampLimits) -> Iterator[DwellStage]:
    """Every stage in which the rig dwells."""
    for stage in dwell_stages(rig):
        speed = rig.pinion_speed(stage.speed_end)
        band = found.band_at(speed)
        yield DwellStage(
            stage=stage.name,
            kind=stage.kind,
            speed=speed,
            computed=speed in found.near,
            near=found.near.get(speed),
            band=band,
            nearest_safe=None if band is None else nearest_safe(found.safe, speed),
            above_limit=found.limit is not None and speed > found.limit.speed * (1.0 + 1e-9),
            loses_contact=found.start is not None and not found.start.holds_at(speed) and _light(rig, stage),
        )


def _light(rig: Rig, stage: StageValues) -> bool:
    """Whether a stage stands at its speed under the start torque, when it begins or ends."""
    turns = stage.speed_start == stage.speed_end
    torques = (stage.torque_start, stage.torque_end) if turns else (stage.torque_end,)
    return min(abs(torque) for torque in torques) <= start_torque(rig)
