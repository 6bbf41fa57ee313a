"""Lateral vibration of the shafts: SI records. Amplitudes are half axes of ellipses."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from dynamics.rotor.damped_modes import RigMode

RIGID, SWAYING = 0.05, 0.1
"""Strain energy over kinetic energy, and frequency over that of the fastest shaft, below which a mode is no vibration
of shafts: films whirl at 0.4 to 0.5 of the speed, unbalance at once, teeth above."""
Torque = Literal["held", "lost"]
"""Whether the bearings carry the torque of the stage, or the weight alone after the loop has lost it at speed."""


@dataclass(frozen=True, kw_only=True)
class BearingWhirl:
    """Motion and force once a turn in one bearing."""

    bearing: str
    """``gearbox.bearing``."""
    shaft: str
    orbits: Mapping[str, float]
    """Larger half axis of the orbit by the shaft line that shakes it [m]."""
    minor: float
    """Smaller half axis of the largest of them, negative for backward whirl [m]."""
    clearance: float | None
    """Of an oil film, diametral, as it runs [m]; None for rolling elements."""
    force: float
    """Largest force once a turn, those of all lines added [N]."""
    static_load: float
    """[N]"""

    @property
    def amplitude(self) -> float:
        """Largest distance from the mean position, the orbits of all lines added in the worst phase [m]."""
        return sum(self.orbits.values())

    @property
    def clearance_share(self) -> float | None:
        """Peak-to-peak motion over the diametral clearance."""
        return None if not self.clearance else 2.0 * self.amplitude / self.clearance


@dataclass(frozen=True, kw_only=True)
class SealWhirl:
    """Motion once a turn in one seal."""

    seal: str
    shaft: str
    amplitude: float
    """Largest distance from the mean position, of all lines [m]."""


@dataclass(frozen=True, kw_only=True)
class MeshWhirl:
    """Force that unbalance, bow and run-out make in a mesh once a turn, teeth at their mean stiffness."""

    mesh: str
    """``gearbox.mesh``."""
    forces: Mapping[str, float]
    """Amplitude along the line of action by the shaft line that makes it [N]."""
    mean: float
    """Force of the mean torque [N]."""

    def share(self, lines: Iterable[str] | None = None) -> float:
        """Of the mean force, some lines or all added in the worst phase; infinite without a torque."""
        force = sum(value for line, value in self.forces.items() if lines is None or line in lines)
        return force / self.mean if self.mean > 0.0 else inf


@dataclass(frozen=True, kw_only=True)
class Separation:
    """A mode next to the speed of its shaft or to an excitation of it."""

    mode: RigMode
    speed: float
    """Of the shaft at the held stage [rad/s]."""
    harmonic: int
    margin: float
    """Distance of the mode from harmonic times speed, over that [-]; negative for a mode below."""
    required: float
    """Least distance [-]; 0 where the mode is critically damped."""


@dataclass(frozen=True, kw_only=True)
class StageLateral:
    """One held stage, with its torque or after it is lost."""

    stage: str
    torque: Torque
    speed: float
    """Where the case counts it [rad/s]."""
    modes: tuple[RigMode, ...]
    bearings: tuple[BearingWhirl, ...] = ()
    seals: tuple[SealWhirl, ...] = ()
    meshes: tuple[MeshWhirl, ...] = ()
    separations: tuple[Separation, ...] = ()
    """Lateral modes against once a turn."""
    torsional: tuple[Separation, ...] = ()
    """Torsional modes against once and twice a turn, the nearest first."""
    highest_turn: float = 0.0
    """Of the fastest shaft [Hz]."""

    def as_rigid_body(self, mode: RigMode) -> bool:
        """Whether shafts sway undeformed in the play of unloaded bearings, slower than anything that turns drives."""
        return mode.elastic_share < RIGID and mode.frequency < SWAYING * self.highest_turn


@dataclass(frozen=True, kw_only=True)
class SpeedWhirl:
    """Bearings at one speed of the curve [rad/s]."""

    speed: float
    bearings: tuple[BearingWhirl, ...]


@dataclass(frozen=True, kw_only=True)
class SeatStiffness:
    """Elastic seat of one bearing: force over its travel with that bearing alone loaded [N/m]."""

    bearing: str
    lateral: float
    vertical: float
    axial: float | None
    """None of a seat that stands still along the shaft."""


@dataclass(frozen=True, kw_only=True)
class LateralVibration:
    """All held stages, and the whirl over speed under torque and temperatures of the one that speaks for the rig."""

    stages: tuple[StageLateral, ...]
    curve: tuple[SpeedWhirl, ...]
    seats: tuple[SeatStiffness, ...] = ()
    """Of housings condensed to their seats, and of supports that the case states; rigid ones are left out."""

    def of(self, torque: Torque) -> tuple[StageLateral, ...]:
        """Stages with their torque, or without."""
        return tuple(stage for stage in self.stages if stage.torque == torque)


# Rolling bearings at the held stages: SI records.


@dataclass(frozen=True, kw_only=True)
class RollingBearingRecord:
    """One rolling bearing at one held stage."""

    name: str
    """``gearbox.bearing``."""
    stage: str
    designation: str
    radial_load: float
    """[N]"""
    axial_load: float
    """Inside the bearing, the induced one included [N]."""
    speed: float
    """[rad/s]"""
    torques: tuple[float, float, float, float]
    """Rolling, sliding, seals, drag [N m]."""
    power: float
    """Friction by its law [W]."""
    temperature: float
    """Of rolling elements and lubricant [K]."""
    inner_ring: float
    """[K]"""
    outer_ring: float
    """[K]"""
    heat_to_shaft: float
    """[W]"""
    heat_to_housing: float
    """[W]"""
    clearance: float
    """Radial internal clearance as it runs, on the diameter; negative is preload [m]."""
    basic_life: float
    """L_10h [h]; infinite at rest."""
    modified_life: float
    """L_nmh [h]; infinite at rest."""
    static_safety: float
    viscosity_ratio: float
    speed_utilisation: float
    """Speed over the limiting speed."""
    minimum_load: float
    """[N]"""
    radial_stiffness: float
    """[N/m]"""
    axial_stiffness: float
    """[N/m]"""
    tilting_stiffness: float
    """In the plane of the radial load [N m/rad]."""
