"""What peaks near a dwell speed: the same list for the check, the table of the stages and the reason of the ramp."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from dynamics.drivetrain.modes import LoopMode
from rigdesign.records.campbell import excitation_orders
from rigdesign.records.dynamics import DynamicRun
from rigdesign.records.loop_modes import modes_at
from rigdesign.records.loop_states import dwell_speeds, state_at
from rigdesign.records.resonance_bands import USUAL_MARGIN, DynamicShare, resonances
from rigdesign.records.torques_over_speed import AROUND, LoopOverSpeed, is_around, torques_over_speed
from rigdesign.results.campbell import CampbellCrossing
from rigdesign.results.dwell import AvoidedResonance, NearResonance
from rigdesign.results.section_torques import TorqueOverSpeed
from rigdesign.rig.model import Rig

SHAFT_SHARE = 0.5
"""Half peak-to-peak torque of a shaft or joint, over the mean of the loop, from which it counts as in resonance: below,
its peak stays within what it carries under the highest K_V of a mesh."""
LIVELY = 0.1
"""Damping ratio below which a mode counts where a shaft order meets it (amplification above 5)."""
REACH = 1.5
"""Distance up to which a resonance is near, over the margin; no further than torques are looked at around a dwell."""


@dataclass(frozen=True)
class Bounds:
    """Share of the mean that the dynamic part may have, and margin from a peak."""

    share: float
    margin: float

    def of(self, quantity: DynamicShare) -> float:
        """Share from which a quantity counts."""
        return SHAFT_SHARE if quantity.kind == "shaft torque" else self.share

    def resonances(self, shares: Iterable[DynamicShare]) -> Iterator[AvoidedResonance]:
        """Of all quantities."""
        for share in shares:
            yield from resonances(share, self.of(share), self.margin)


def bounds_of(rig: Rig) -> Bounds:
    """As the case states them."""
    limits = rig.case.limits.dynamics
    return Bounds(limits.dangerous_force_share, limits.resonance_distance_minimum or USUAL_MARGIN)


@dataclass(frozen=True)
class NearDwell:
    """What lies near a dwell: the nearest resonance, and all shaft orders that meet a lively mode of the loop there."""

    nearest: NearResonance
    orders: tuple[AvoidedResonance, ...]


def near_dwells(rig: Rig, run: DynamicRun) -> dict[float, NearDwell]:
    """Of every dwell whose response is computed, by the speed of the first pinion [rad/s], rising."""
    low, high = run.curves.response.speeds[0], run.curves.response.speeds[-1]
    stated = {rig.pinion_speed(speed): speed for speed in dwell_speeds(rig)}
    margin = bounds_of(rig).margin
    found = {}
    for speed in sorted(own for own in stated if low <= own <= high):
        orders = tuple(held_orders(rig, modes_at(rig, run.test, stated[speed]), margin))
        found[speed] = NearDwell(near_dwell(rig, run, orders, speed), orders)
    return found


def near_dwell(rig: Rig, run: DynamicRun, orders: Iterable[AvoidedResonance], speed: float) -> NearResonance:
    """The resonance nearest to a dwell.

    orders : that meet a lively mode of the closed loop as it runs there; speed : of the first pinion [rad/s]
    """
    bounds = bounds_of(rig)
    reach = min(REACH * bounds.margin, AROUND)
    found = [
        *bounds.resonances(mesh_shares(rig, run)),
        *bounds.resonances(_near_shafts(rig, run, speed)),
        *orders,
    ]
    nearest = min(found, key=lambda one: one.distance(speed, bounds.margin), default=None)
    if nearest is None or nearest.distance(speed, bounds.margin) > reach:
        return NearResonance(distance=reach, resonance=None)
    return NearResonance(distance=nearest.distance(speed, bounds.margin), resonance=nearest)


def mesh_shares(rig: Rig, run: DynamicRun) -> Iterator[DynamicShare]:
    """K_V - 1 of every mesh at every torque of the curves."""
    for torque, (_, curve) in run.curves.named.items():
        for mesh, name in enumerate(rig.mesh_names):
            if len(curve.points) > 1:
                where = f"{rig.mesh_labels[name]} at {torque}"
                yield DynamicShare("dynamic factor", where, curve.speeds, curve.dynamic_factor(mesh) - 1.0)


def shaft_shares(
    rig: Rig, speeds: Sequence[float], curves: Sequence[TorqueOverSpeed]
) -> Iterator[DynamicShare]:
    """Half peak-to-peak torque of every shaft section and joint over the mean torque of the first mesh.

    speeds : (s,) of the first pinion [rad/s]
    """
    first = rig.mesh_labels[rig.mesh_names[0]]
    of_mesh = next(c for c in curves if c.place.kind == "mesh" and c.place.part == first)
    mean = np.array([swing.mean for swing in of_mesh.swings])
    for curve in curves:
        if curve.place.kind != "mesh" and len(speeds) > 1:
            swing = np.array([one.half_peak_to_peak for one in curve.swings])
            yield DynamicShare("shaft torque", curve.place.name, np.array(speeds), swing / mean)


def _near_shafts(rig: Rig, run: DynamicRun, speed: float) -> Iterator[DynamicShare]:
    """Torque of shafts and joints around a speed of the first pinion [rad/s]."""
    points = [point for point in run.curves.response.points if is_around(point.speed, speed)]
    if len(points) > 1:
        state = state_at(rig, run.test, speed / rig.pinion_speed(1.0))
        met, curves = torques_over_speed(LoopOverSpeed(rig, run.test.last, [state]), points, None)
        yield from shaft_shares(rig, [point.speed for point in met], curves)


def held_orders(rig: Rig, modes: Sequence[LoopMode], margin: float) -> Iterator[AvoidedResonance]:
    """Turning and coupling orders that meet a lively mode of these, wherever that lies."""
    swinging = [mode for mode in modes if mode.frequency > 0.0]
    names = {number: mode.name for number, mode in enumerate(swinging, start=1)}
    crossings = [
        CampbellCrossing(
            mode=number,
            kind=order.kind,
            of=order.of,
            harmonic=order.harmonic,
            speed=2.0 * math.pi * mode.frequency / order.cycles,
            frequency=mode.frequency,
            damping_ratio=mode.damping_ratio,
            gain=0.0,
        )
        for number, mode in enumerate(swinging, start=1)
        for order in excitation_orders(rig)
        if order.kind != "mesh"
    ]
    yield from order_resonances(crossings, names, margin)


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
