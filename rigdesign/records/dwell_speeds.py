"""At which speeds the rig may dwell: bands of the response to avoid, stages in them, the ramp that follows."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from dynamics.drivetrain.modes import LoopMode
from dynamics.response.section_torque import section_torques
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.coupling.tooth_deviations import periodic_laws
from rigdesign.coupling.twist_rows import twist_rows_of
from rigdesign.records.campbell import excitation_orders
from rigdesign.records.curves import own_ratio
from rigdesign.records.dynamics import DynamicRun
from rigdesign.records.ramp_steps import RampLimits, ramp_steps
from rigdesign.records.resonance_bands import (
    USUAL_MARGIN,
    DynamicShare,
    bands,
    nearest_safe,
    resonances,
    safe_windows,
)
from rigdesign.results.campbell import CampbellCrossing, CampbellRecord
from rigdesign.results.dwell import AvoidedBand, AvoidedResonance, DwellRecord, DwellStage, ResonanceKind
from rigdesign.results.loads import DynamicLoads
from rigdesign.results.section_torques import SectionTorqueRecord
from rigdesign.rig.model import Rig

SHAFT_SHARE = 0.5
"""Half peak-to-peak torque of a shaft or joint, over the mean of the loop, from which it counts as in resonance: below,
its peak stays within what it carries under the highest K_V of a mesh."""
LIVELY = 0.1
"""Damping ratio below which a mode counts where a shaft order meets it (amplification above 5)."""
NEAR = 1.5
"""Speeds around a held one whose shaft torques a check asks for, per margin."""


@dataclass(frozen=True)
class Bounds:
    """Share of the mean that the dynamic part may have, and margin from a peak."""

    share: float
    margin: float

    def of(self, quantity: DynamicShare) -> float:
        """Share from which a quantity counts."""
        return SHAFT_SHARE if quantity.kind == "shaft torque" else self.share


def bounds_of(rig: Rig) -> Bounds:
    """As the case states them."""
    limits = rig.case.limits.dynamics
    return Bounds(limits.dangerous_force_share, limits.resonance_distance_minimum or USUAL_MARGIN)


def dwell_record(
    rig: Rig,
    run: DynamicRun,
    loads: DynamicLoads,
    torques: SectionTorqueRecord,
    diagram: CampbellRecord,
) -> DwellRecord:
    """Bands over all speeds of the governing curve; torques and diagram are those of the run."""
    bounds = bounds_of(rig)
    shares = [*mesh_shares(rig, run), *_root_shares(rig, loads), *_torque_shares(rig, torques)]
    found = [one for share in shares for one in resonances(share, bounds.of(share), bounds.margin)]
    names = {mode.number: mode.name for mode in diagram.modes}
    found += order_resonances(diagram.crossings, names, bounds.margin)
    avoided = bands(found)
    low, high = torques.speeds[0], torques.speeds[-1]
    safe = safe_windows(avoided, low, high)
    stages = tuple(_stages(rig, avoided, safe, (low, high)))
    return DwellRecord(
        share_limit=bounds.share,
        shaft_share_limit=SHAFT_SHARE,
        margin=bounds.margin,
        low=low,
        high=high,
        bands=avoided,
        safe=safe,
        stages=stages,
        ramp=tuple(ramp_steps(rig, RampLimits(run=run, bands=avoided, safe=safe, range=(low, high)))),
        speeds=torques.speeds,
        highest=_highest(shares, torques.speeds),
    )


def _highest(
    shares: Sequence[DynamicShare], speeds: Sequence[float]
) -> dict[ResonanceKind, tuple[float, ...]]:
    """Largest share of every kind at some speeds; each counts where it was computed."""
    found: dict[ResonanceKind, np.ndarray[tuple[int], np.dtype[np.float64]]] = {}
    for one in shares:
        values = np.interp(speeds, one.speed, one.share, left=0.0, right=0.0)
        found[one.kind] = np.maximum(found.get(one.kind, np.zeros(len(speeds))), values)
    return {kind: tuple(values.tolist()) for kind, values in found.items()}


def mesh_shares(rig: Rig, run: DynamicRun) -> Iterator[DynamicShare]:
    """K_V - 1 of every mesh at every torque of the curves."""
    for torque, (_, curve) in run.curves.named.items():
        for mesh, name in enumerate(rig.mesh_names):
            if len(curve.points) > 1:
                where = f"{rig.mesh_labels[name]} at {torque}"
                yield DynamicShare("dynamic factor", where, curve.speeds, curve.dynamic_factor(mesh) - 1.0)


def _root_shares(rig: Rig, loads: DynamicLoads) -> Iterator[DynamicShare]:
    """Ratio of dynamic to quasi-static root stress less one, of every gear."""
    for mesh, name in enumerate(rig.mesh_names):
        label = rig.mesh_labels[name]
        ratios = loads.meshes[label].root_stress_ratios
        if len(ratios) > 1:
            speed = np.array([ratio.speed for ratio in ratios]) / own_ratio(rig, mesh)
            for gear in ("pinion", "wheel"):
                values = np.array([getattr(ratio, gear) for ratio in ratios]) - 1.0
                yield DynamicShare("root stress", f"{label} {gear}", speed, values)


def _torque_shares(rig: Rig, torques: SectionTorqueRecord) -> Iterator[DynamicShare]:
    """Half peak-to-peak torque of every shaft section and joint over the mean torque of the first mesh."""
    speed = np.array(torques.speeds)
    first = rig.mesh_labels[rig.mesh_names[0]]
    of_mesh = next(c for c in torques.curves if c.place.kind == "mesh" and c.place.part == first)
    mean = np.array([swing.mean for swing in of_mesh.swings])
    for curve in torques.curves:
        if curve.place.kind != "mesh" and speed.size > 1:
            swing = np.array([one.half_peak_to_peak for one in curve.swings])
            yield DynamicShare("shaft torque", curve.place.name, speed, swing / mean)


def near_shares(rig: Rig, run: DynamicRun, speed: float) -> Iterator[DynamicShare]:
    """Torque of shafts and joints near a speed of the first pinion [rad/s], with the loop of the governing point."""
    held = run.test.last
    assert held.system is not None
    reach = NEAR * bounds_of(rig).margin
    points = [p for p in run.curves.response.points if abs(p.speed - speed) <= reach * speed]
    if len(points) < 2:
        return
    loop = section_torques(
        held.system, periodic_laws(rig, laws_of(held.models)), twist_rows_of(rig, held.system)
    )
    swings = np.array([np.ptp(loop.over_period(point, held.drags), axis=1) for point in points])
    share = 0.5 * swings / np.array([abs(point.mean[0]) for point in points])[:, None]
    places: dict[str, list[int]] = {}
    for i, section in enumerate(loop.rows.sections):
        places.setdefault(section.name, []).append(i)
    speeds = np.array([point.speed for point in points])
    for name, own in places.items():
        yield DynamicShare("shaft torque", name, speeds, share[:, own].max(axis=1))


def held_crossings(rig: Rig, modes: Sequence[LoopMode]) -> Iterator[CampbellCrossing]:
    """Where turning and coupling orders meet the modes of a held point, wherever that lies.

    modes : of the closed loop there that oscillate
    """
    for number, mode in enumerate(modes, start=1):
        for order in excitation_orders(rig):
            if order.kind != "mesh":
                yield CampbellCrossing(
                    mode=number,
                    kind=order.kind,
                    of=order.of,
                    harmonic=order.harmonic,
                    speed=2.0 * math.pi * mode.frequency / order.cycles,
                    frequency=mode.frequency,
                    damping_ratio=mode.damping_ratio,
                    gain=0.0,
                )


def order_resonances(
    crossings: Iterable[CampbellCrossing], names: Mapping[int, str], margin: float
) -> Iterator[AvoidedResonance]:
    """Turning and coupling orders that meet a lively mode; names : of the modes by number."""
    for crossing in crossings:
        if crossing.kind != "mesh" and crossing.damping_ratio < LIVELY:
            yield AvoidedResonance(
                kind="shaft order",
                where=f"{crossing.kind} {', '.join(crossing.of)}, order {crossing.harmonic:g}, mode {crossing.mode} "
                f"({names[crossing.mode]})",
                speed=crossing.speed,
                share=None,
                low=crossing.speed * (1.0 - margin),
                high=crossing.speed * (1.0 + margin),
            )


def _stages(
    rig: Rig,
    avoided: Sequence[AvoidedBand],
    safe: Sequence[tuple[float, float]],
    span: tuple[float, float],
) -> Iterator[DwellStage]:
    """Every stage that turns at one speed."""
    for stage in rig.case.schedule.resolved():
        if stage.speed_end > 0.0 and stage.speed_start == stage.speed_end:
            speed = rig.pinion_speed(stage.speed_end)
            band = next((one for one in avoided if one.low < speed < one.high), None)
            yield DwellStage(
                stage=stage.name,
                kind=stage.kind,
                speed=speed,
                computed=span[0] <= speed <= span[1],
                band=band,
                nearest_safe=None if band is None else nearest_safe(safe, speed),
            )
