"""Lateral vibration of the shafts: SI records. Amplitudes are half axes of ellipses."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING, Annotated, Literal

from rigdesign.results.quantity import (
    Degrees,
    NewtonMetres,
    Newtons,
    Quantity,
    Revolutions,
    Watts,
)

if TYPE_CHECKING:
    from dynamics.rotor.damped_modes import RigMode

RIGID, SWAYING = 0.05, 0.1
"""Strain energy over kinetic energy, and frequency over that of the fastest shaft, below which a mode is no vibration
of shafts: films whirl at 0.4 to 0.5 of the speed, unbalance at once, teeth above."""
Torque = Literal["held", "lost"]
"""Whether the bearings carry the torque of the stage, or the weight alone after the loop has lost it at speed."""


Micrometres = Annotated[float | None, Quantity("um")]


@dataclass(frozen=True, kw_only=True)
class BearingWhirl:
    """Motion and force once a turn in one bearing."""

    bearing: str
    """``gearbox.bearing``."""
    shaft: str
    orbits: Annotated[Mapping[str, float], Quantity("um")]
    """Larger half axis of the orbit by the shaft line that shakes it."""
    minor: Annotated[float, Quantity("um")]
    """Smaller half axis of the largest of them, negative for backward whirl."""
    clearance: Micrometres
    """Of an oil film, diametral, as it runs; None for rolling elements."""
    force: Newtons
    """Largest force once a turn, those of all lines added."""
    static_load: Newtons

    @property
    def amplitude(self) -> Annotated[float, Quantity("um", "orbit")]:
        """Largest distance from the mean position, the orbits of all lines added in the worst phase."""
        return sum(self.orbits.values())

    @property
    def clearance_share(self) -> Annotated[float | None, Quantity(label="share")]:
        """Peak-to-peak motion over the diametral clearance."""
        return None if not self.clearance else 2.0 * self.amplitude / self.clearance


@dataclass(frozen=True, kw_only=True)
class SealWhirl:
    """Motion once a turn in one seal."""

    seal: str
    shaft: str
    amplitude: Annotated[float, Quantity("um", "orbit")]
    """Largest distance from the mean position, of all lines."""


@dataclass(frozen=True, kw_only=True)
class MeshWhirl:
    """Force that unbalance, bow and run-out make in a mesh once a turn, teeth at their mean stiffness."""

    mesh: str
    """``gearbox.mesh``."""
    forces: Annotated[Mapping[str, float], Quantity("N")]
    """Amplitude along the line of action by the shaft line that makes it."""
    mean: Newtons
    """Force of the mean torque."""

    def share(self, lines: Iterable[str] | None = None) -> float:
        """Of the mean force, some lines or all added in the worst phase; infinite without a torque."""
        force = sum(value for line, value in self.forces.items() if lines is None or line in lines)
        return force / self.mean if self.mean > 0.0 else inf


@dataclass(frozen=True, kw_only=True)
class Separation:
    """A mode next to the speed of its shaft or to an excitation of it."""

    mode: int
    """Its number among the modes of the stage, from 0."""
    speed: Revolutions
    """Of the shaft at the held stage."""
    harmonic: int
    margin: float
    """Distance of the mode from harmonic times speed, over that; negative for a mode below."""
    required: float
    """Least distance; 0 where the mode is critically damped."""


@dataclass(frozen=True, kw_only=True)
class StageLateral:
    """One held stage, with its torque or after it is lost."""

    stage: str
    torque: Torque
    speed: Revolutions
    """Where the case counts it."""
    modes: tuple[RigMode, ...]
    bearings: tuple[BearingWhirl, ...] = ()
    seals: tuple[SealWhirl, ...] = ()
    meshes: tuple[MeshWhirl, ...] = ()
    separations: tuple[Separation, ...] = ()
    """Lateral modes against once a turn."""
    torsional: tuple[Separation, ...] = ()
    """Torsional modes against once and twice a turn, the nearest first."""
    highest_turn: Annotated[float, Quantity("Hz")] = 0.0
    """Of the fastest shaft."""

    def as_rigid_body(self, mode: RigMode) -> bool:
        """Whether shafts sway undeformed in the play of unloaded bearings, slower than anything that turns drives."""
        return mode.elastic_share < RIGID and mode.frequency < SWAYING * self.highest_turn

    def separation_of(self, mode: int) -> Separation | None:
        """The nearest of a mode; None where nothing excites it."""
        return next((near for near in (*self.torsional, *self.separations) if near.mode == mode), None)


@dataclass(frozen=True, kw_only=True)
class BearingOrbit:
    """Motion once a turn in one bearing over speed."""

    bearing: str
    """``gearbox.bearing``."""
    orbit: Annotated[tuple[float, ...], Quantity("um")]
    """(s,) as `BearingWhirl.amplitude`."""
    clearance: Micrometres
    """As of `BearingWhirl`."""


@dataclass(frozen=True, kw_only=True)
class WhirlCurve:
    """Orbits of the bearings over speed."""

    speed: Annotated[tuple[float, ...], Quantity("rpm")] = ()
    """(s,)"""
    bearings: tuple[BearingOrbit, ...] = ()


@dataclass(frozen=True, kw_only=True)
class SeatStiffness:
    """Elastic seat of one bearing: force over its travel with that bearing alone loaded."""

    bearing: str
    lateral: Annotated[float, Quantity("N/um")]
    vertical: Annotated[float, Quantity("N/um")]
    axial: Annotated[float | None, Quantity("N/um")]
    """None of a seat that stands still along the shaft."""


@dataclass(frozen=True, kw_only=True)
class LateralVibration:
    """All held stages, and the whirl over speed under torque and temperatures of the one that speaks for the rig."""

    stages: tuple[StageLateral, ...]
    curve: WhirlCurve = WhirlCurve()
    seats: tuple[SeatStiffness, ...] = ()
    """Of housings condensed to their seats, and of supports that the case states; rigid ones are left out."""

    def of(self, torque: Torque) -> tuple[StageLateral, ...]:
        """Stages with their torque, or without."""
        return tuple(stage for stage in self.stages if stage.torque == torque)


# Rolling bearings at the held stages: SI records.


@dataclass(frozen=True, kw_only=True)
class RollingBearingRecord:
    """One rolling bearing at one held stage."""

    bearing: str
    """``gearbox.bearing``."""
    stage: str
    designation: str
    radial_load: Newtons
    axial_load: Newtons
    """Inside the bearing, the induced one included."""
    minimum_load: Newtons
    speed: Revolutions
    speed_utilisation: float
    """Speed over the limiting speed."""
    rolling_torque: NewtonMetres
    sliding_torque: NewtonMetres
    seal_torque: NewtonMetres
    drag_torque: NewtonMetres
    friction: Watts
    """By its law."""
    temperature: Degrees
    """Of rolling elements and lubricant."""
    inner_ring: Degrees
    outer_ring: Degrees
    heat_to_shaft: Watts
    heat_to_housing: Watts
    operating_clearance: Annotated[float, Quantity("um")]
    """Radial internal clearance as it runs, on the diameter; negative is preload."""
    basic_life: Annotated[float | None, Quantity("h")]
    """L_10h; None without end, at rest."""
    modified_life: Annotated[float | None, Quantity("h")]
    """L_nmh; None without end, at rest."""
    static_safety: float | None
    """None without load."""
    viscosity_ratio: float
    radial_stiffness: Annotated[float, Quantity("N/um")]
    axial_stiffness: Annotated[float, Quantity("N/um")]
    tilting_stiffness: Annotated[float, Quantity("kN m/rad")]
    """In the plane of the radial load."""
