"""Dwells on an undamped resonance, or on an unstable mode: they have no steady state that any result could be taken
from.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from rigdesign.base.errors import CaseError
from rigdesign.coupling.loop import PointResult
from rigdesign.records.curves import own_ratio
from rigdesign.records.dynamics import mode_crossings
from rigdesign.records.loop_states import dwell_speeds, dwell_stages, held_modes
from rigdesign.results.loads import ModeCrossing
from rigdesign.results.units import RPM
from rigdesign.rig.model import Rig

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
