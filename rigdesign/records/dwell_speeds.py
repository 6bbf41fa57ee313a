"""At which speeds the rig may dwell: bands of the response to avoid, stages in them, the ramp that follows."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rigdesign.case.schedule import StageValues
from rigdesign.records.dynamics import DynamicRun
from rigdesign.records.loop_states import dwell_stages
from rigdesign.records.near_dwell import (
    SHAFT_SHARE,
    Bounds,
    NearDwell,
    bounds_of,
    mesh_resonances,
    mesh_shares,
    order_resonances,
    root_shares,
    shaft_shares,
)
from rigdesign.records.ramp_steps import RampLimits, ramp_steps, speed_limit
from rigdesign.records.resonance_bands import DynamicShare, bands, nearest_safe, safe_windows
from rigdesign.records.start_torque import StartResponse, start_torque, worst_start
from rigdesign.records.torques_over_speed import is_around
from rigdesign.results.loads import DynamicLoads
from rigdesign.results.vibration import (
    AvoidedResonance,
    CampbellRecord,
    DwellRecord,
    DwellStage,
    ResonanceKind,
    SectionTorqueRecord,
)
from rigdesign.rig.model import Rig


@dataclass(frozen=True, kw_only=True)
class DwellSources:
    """What the advice follows from, all of the same run; start : None where it is not computed."""

    loads: DynamicLoads
    torques: SectionTorqueRecord
    diagram: CampbellRecord
    start: StartResponse | None
    near: Mapping[float, NearDwell]
    """By the speed of the first pinion [rad/s]."""


def dwell_record(rig: Rig, run: DynamicRun, found: DwellSources) -> DwellRecord:
    """Bands over all speeds of the governing curve; speeds above the limit of the rig are none to dwell at."""
    bounds, limit = bounds_of(rig), speed_limit(rig)
    speeds = found.torques.speeds
    others = [*root_shares(rig, found.loads), *shaft_shares(rig, speeds, found.torques.curves)]
    low, high = speeds[0], speeds[-1]
    avoided = bands(
        [*mesh_resonances(rig, run, found.loads), *bounds.resonances(others), *_orders(found, bounds)]
    )
    safe = safe_windows(avoided, low, high if limit is None else min(high, limit.speed))
    limits = RampLimits(
        run=run,
        bands=avoided,
        safe=safe,
        near={speed: one.nearest for speed, one in found.near.items()},
        limit=limit,
        start=found.start,
        up=worst_start(rig, found.loads, 1),
        down=worst_start(rig, found.loads, -1),
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


def _orders(found: DwellSources, bounds: Bounds) -> Iterator[AvoidedResonance]:
    """Crossings of shaft orders over speed; around a dwell speed those with the modes at the nearest one."""
    names = {mode.number: mode.name for mode in found.diagram.modes}
    for one in order_resonances(found.diagram.crossings, names, bounds.margin):
        if _around(one.speed, found.near) is None:
            yield one
    for dwell, near in found.near.items():
        for one in near.orders:
            if _around(one.speed, found.near) == dwell:
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
