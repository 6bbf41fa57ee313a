"""Dwells on an undamped resonance: they have no steady state that any result could be taken from."""

from collections.abc import Iterator
from dataclasses import dataclass

from rigdesign.base.errors import CaseError
from rigdesign.records.curves import own_ratio
from rigdesign.results.loads import DynamicLoads, ModeCrossing
from rigdesign.results.units import RPM
from rigdesign.rig.model import Rig

UNDAMPED, LIGHTLY = 1e-4, 1e-3
"""Damping ratios below which a mode has no steady state at its resonance, and below which no rig of steel with joints
and bearings is; its own material damps with 5e-4 and more."""
ON = 0.01
"""Distance of a dwell from a resonance, as a share of its speed, up to which it stands on it."""
REMEDY = (
    "state the damping of the parts that vibrate (damping of the meshes, torsional_damping of splines and "
    "couplings, of bearings), or dwell elsewhere"
)


@dataclass(frozen=True)
class LightDwell:
    """A stage that dwells where a mesh order meets a mode of next to no damping; speed : of the pinion [rad/s]."""

    stage: str
    speed: float
    crossing: ModeCrossing

    @property
    def distance(self) -> float:
        """Of the resonance, as a share of the speed [-]."""
        return abs(self.crossing.speed - self.speed) / self.speed

    def text(self, limit: float) -> str:
        """What, where, how much against which limit."""
        one = self.crossing
        return (
            f"stage {self.stage} dwells at {self.speed * RPM:.0f} rpm on an undamped resonance: order "
            f"{one.harmonic} of mesh {one.order_of} meets mode {one.mode} ({one.shape}), {one.frequency:.4g} Hz, at "
            f"{one.speed * RPM:.1f} rpm, {100.0 * self.distance:.1f} % away; its damping ratio is "
            f"{abs(one.damping_ratio):.2g}, limit {limit:g}"
        )


def light_dwells(rig: Rig, loads: DynamicLoads, limit: float) -> Iterator[LightDwell]:
    """Dwells on a mode that a mesh excites with a damping ratio below the limit."""
    meshes = {rig.mesh_labels[name]: mesh for mesh, name in enumerate(rig.mesh_names)}
    stages = [s for s in rig.case.schedule.resolved() if (s.kind == "dwell" or s.held) and s.speed_end > 0.0]
    for stage in stages:
        for crossing in loads.loop_crossings:
            if crossing.kind != "mesh" or not crossing.excited or crossing.damping_ratio >= limit:
                continue
            own = own_ratio(rig, meshes[crossing.order_of]) * rig.pinion_speed(stage.speed_end)
            found = LightDwell(stage.name, own, crossing)
            if found.distance <= ON:
                yield found


def require_damping(rig: Rig, loads: DynamicLoads) -> None:
    """Raise CaseError for a dwell on an undamped resonance: torques there are limited by loss of contact alone."""
    found = min(light_dwells(rig, loads, UNDAMPED), key=lambda one: one.distance, default=None)
    if found is not None:
        raise CaseError(
            f"{found.text(UNDAMPED)}: no steady state exists, the torque grows until contact is lost; {REMEDY}",
            str(rig.case.path),
        )
