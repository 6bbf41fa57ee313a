"""What peaks near a dwell speed: the same list for the checks, the table of the stages and the ramp."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from dynamics.rotor.torsional_modes import LoopMode
from rigdesign.base.errors import CaseError
from rigdesign.coupling.loop import PointResult
from rigdesign.postprocessing.campbell import excitation_orders
from rigdesign.postprocessing.curves import (
    AROUND,
    dwell_speeds,
    dwell_stages,
    held_modes,
    is_around,
    modes_at,
    own_ratio,
    state_at,
)
from rigdesign.postprocessing.dynamics import DynamicRun, mode_crossings
from rigdesign.postprocessing.resonances import USUAL_MARGIN, DynamicShare, resonances
from rigdesign.postprocessing.run_torques import LoopOverSpeed, torques_over_speed
from rigdesign.results.loads import DynamicLoads, ModeCrossing
from rigdesign.results.units import RPM
from rigdesign.results.vibration import (
    SHAFT_SHARE,
    AvoidedResonance,
    CampbellCrossing,
    NearResonance,
    TorqueOverSpeed,
)
from rigdesign.rig.model import Rig

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
    """What a dwell is held against, and all shaft orders that meet a lively mode of the loop there.

    speed : of the first pinion [rad/s]; margin : share of it that a resonance keeps away
    """

    speed: float
    margin: float
    resonances: tuple[AvoidedResonance, ...]
    orders: tuple[AvoidedResonance, ...] = ()

    @property
    def nearest(self) -> NearResonance:
        """Of all resonances."""
        return self.nearest_of(self.resonances)

    def nearest_of(self, some: Iterable[AvoidedResonance]) -> NearResonance:
        """The nearest of some resonances; the range searched where none is in it."""
        reach = min(REACH * self.margin, AROUND)
        found = min(some, key=lambda one: (self.distance(one), abs(one.speed - self.speed)), default=None)
        if found is None or self.distance(found) > reach:
            return NearResonance(distance=reach, resonance=None)
        return NearResonance(distance=self.distance(found), resonance=found)

    def distance(self, resonance: AvoidedResonance) -> float:
        """Of the dwell from a resonance, as a share of its speed."""
        return resonance.distance(self.speed, self.margin)


def near_dwells(rig: Rig, run: DynamicRun, loads: DynamicLoads) -> dict[float, NearDwell]:
    """Of every dwell whose response is computed, by the speed of the first pinion [rad/s], rising."""
    low, high = run.curves.response.speeds[0], run.curves.response.speeds[-1]
    stated = {rig.pinion_speed(speed): speed for speed in dwell_speeds(rig)}
    bounds = bounds_of(rig)
    meshes = [*mesh_resonances(rig, run, loads), *bounds.resonances(root_shares(rig, loads))]
    found = {}
    for speed in sorted(own for own in stated if low <= own <= high):
        orders = tuple(held_orders(rig, modes_at(rig, run.test, stated[speed]), bounds.margin))
        shafts = bounds.resonances(_near_shafts(rig, run, speed))
        found[speed] = NearDwell(speed, bounds.margin, (*meshes, *shafts, *orders), orders)
    return found


def mesh_resonances(rig: Rig, run: DynamicRun, loads: DynamicLoads) -> Iterator[AvoidedResonance]:
    """Dangerous peaks of every mesh at every torque of the curves, and what is above the share without a peak."""
    bounds = bounds_of(rig)
    shares = {share.where: share for share in mesh_shares(rig, run)}
    for mesh, name in enumerate(rig.mesh_names):
        label, ratio = rig.mesh_labels[name], own_ratio(rig, mesh)
        for torque in run.curves.named:
            where = at_torque(label, torque)
            spans = list(resonances(shares[where], bounds.share, 0.0)) if where in shares else []
            peaked: list[AvoidedResonance] = []
            for peak in loads.meshes[label].resonances:
                if peak.torque == torque and peak.dangerous:
                    speed = peak.speed / ratio
                    own = [span for span in spans if span.low <= speed <= span.high]
                    peaked += own
                    found = AvoidedResonance(
                        kind="dynamic factor",
                        where=where,
                        mode=peak.mode,
                        speed=speed,
                        share=peak.force_share,
                        low=min((span.low for span in own), default=speed),
                        high=max((span.high for span in own), default=speed),
                    )
                    yield found.widened(bounds.margin)
            yield from (span.widened(bounds.margin) for span in spans if span not in peaked)


def at_torque(label: str, torque: str) -> str:
    """Place of the resonances of a mesh on the curve of a torque."""
    return f"{label} at {torque}"


def mesh_shares(rig: Rig, run: DynamicRun) -> Iterator[DynamicShare]:
    """Dynamic torque of every mesh, half peak-to-peak, over the mean at every torque of the curves."""
    for torque, (_, curve) in run.curves.named.items():
        for mesh, name in enumerate(rig.mesh_names):
            if len(curve.points) > 1:
                share = [0.5 * (p.maximum[mesh] - p.minimum[mesh]) / abs(p.mean[mesh]) for p in curve.points]
                where = at_torque(rig.mesh_labels[name], torque)
                yield DynamicShare("dynamic factor", where, curve.speeds, np.array(share))


def root_shares(rig: Rig, loads: DynamicLoads) -> Iterator[DynamicShare]:
    """Ratio of dynamic to quasi-static root stress less one, of every gear."""
    for mesh, name in enumerate(rig.mesh_names):
        label = rig.mesh_labels[name]
        ratios = loads.meshes[label].root_stress_ratios
        if len(ratios) > 1:
            speed = np.array([ratio.speed for ratio in ratios]) / own_ratio(rig, mesh)
            for gear in ("pinion", "wheel"):
                values = np.array([getattr(ratio, gear) for ratio in ratios]) - 1.0
                yield DynamicShare("root stress", f"{label} {gear}", speed, values)


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
            found = AvoidedResonance(
                kind="shaft order",
                where=f"{crossing.kind} {', '.join(crossing.of)}, order {crossing.harmonic:g}, mode {crossing.mode} "
                f"({names[crossing.mode]})",
                speed=crossing.speed,
                share=None,
                low=crossing.speed,
                high=crossing.speed,
            )
            yield found.widened(margin)


# Dwells on an undamped resonance, or on an unstable mode: they have no steady state that any result could be taken
# from.

UNDAMPED, LIGHTLY = 1e-4, 1e-3
"""Damping ratios below which a mode has no steady state at its resonance, and below which no rig of steel with joints
and bearings is; its own material damps with 5e-4 and more."""
GROWS = -1e-9
"""Damping ratio below which a mode is unstable; between this and zero stand rounding errors."""
ON = 0.01
"""Distance of a dwell from a resonance, as a share of its speed, up to which it stands on it."""
REMEDY = (
    "state the damping of the parts that vibrate (damping of the meshes, torsional_damping of splines and "
    "couplings, of bearings), or dwell elsewhere"
)
STABILISE = (
    "correct what drives it (internal damping of shafts and splines, films under too little load for their speed), "
    "or dwell at a lower speed"
)


@dataclass(frozen=True)
class LightDwell:
    """A stage that dwells where a mesh order meets a mode of next to no damping, or one that grows; speed : of the
    pinion [rad/s]."""

    stage: str
    speed: float
    crossing: ModeCrossing

    @property
    def distance(self) -> float:
        """Of the resonance, as a share of the speed [-]."""
        return abs(self.crossing.speed - self.speed) / self.speed

    @property
    def grows(self) -> bool:
        """Whether the mode is unstable."""
        return self.crossing.damping_ratio < GROWS

    def text(self, limit: float) -> str:
        """What, where, how much against which limit."""
        one = self.crossing
        what = "an unstable mode" if self.grows else "an undamped resonance"
        ratio = one.damping_ratio if self.grows else abs(one.damping_ratio)
        return (
            f"stage {self.stage} dwells at {self.speed * RPM:.0f} rpm on {what}: order "
            f"{one.harmonic} of mesh {one.order_of} meets mode {one.mode} ({one.shape}), {one.frequency:.4g} Hz, at "
            f"{one.speed * RPM:.1f} rpm, {100.0 * self.distance:.1f} % away; its damping ratio is "
            f"{ratio:.2g}, limit {limit:g}"
        )


def light_dwells(rig: Rig, crossings: Iterable[ModeCrossing], limit: float) -> Iterator[LightDwell]:
    """Dwells on a mode that a mesh excites with a damping ratio below the limit; crossings : of the closed loop."""
    listed = tuple(crossings)
    meshes = {rig.mesh_labels[name]: mesh for mesh, name in enumerate(rig.mesh_names)}
    for stage in dwell_stages(rig):
        for crossing in listed:
            if crossing.kind != "mesh" or crossing.damping_ratio >= limit:
                continue
            own = own_ratio(rig, meshes[crossing.order_of]) * rig.pinion_speed(stage.speed_end)
            found = LightDwell(stage.name, own, crossing)
            if found.distance <= ON:
                yield found


def held_crossings(rig: Rig, held: PointResult) -> tuple[ModeCrossing, ...]:
    """Crossings of the modes at a held point up to the highest speed at which the rig dwells."""
    top = rig.pinion_speed(max(dwell_speeds(rig)))
    return tuple(mode_crossings(rig, held_modes(rig, held), (1.0 + 2.0 * ON) * top))


def require_damping(rig: Rig, crossings: Iterable[ModeCrossing]) -> None:
    """Raise CaseError for a dwell on an undamped resonance, where torques are limited by loss of contact alone, or on
    an unstable mode."""
    found = min(
        light_dwells(rig, crossings, UNDAMPED), key=lambda one: (not one.grows, one.distance), default=None
    )
    if found is not None:
        then, remedy = (
            ("its vibration grows whatever excites it", STABILISE)
            if found.grows
            else ("the torque grows until contact is lost", REMEDY)
        )
        raise CaseError(
            f"{found.text(UNDAMPED)}: no steady state exists, {then}; {remedy}",
            str(rig.case.path),
        )
