"""At which speeds the rig may dwell: bands of the response to avoid, stages in them, the ramp that follows."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np

from rigdesign.case.schedule import StageValues
from rigdesign.records.loop_states import dwell_stages, is_around
from rigdesign.records.near_dwell import (
    SHAFT_SHARE,
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
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.records.start_torque import start_torque, worst_start
from rigdesign.results.vibration import (
    AvoidedResonance,
    CampbellRecord,
    DwellRecord,
    DwellStage,
    ResonanceKind,
    SectionTorqueRecord,
)
from rigdesign.rig.model import Rig


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
