"""Modes, torques, spectra and speeds to avoid: SI records. Speeds are those of the pinion of the first mesh."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Literal

from rigdesign.results.quantity import NewtonMetres, Quantity, Revolutions

OrderKind = Literal["mesh", "shaft", "coupling"]
Sense = Literal["forward", "backward", ""]
CIRCLING = 0.1
"""Whirl, as area of an orbit over that of a circle of its size, from which it has a sense."""
PlaceKind = Literal["shaft", "spline", "coupling", "motor", "mesh"]
Row = tuple[float, ...]
ResonanceKind = Literal["dynamic factor", "root stress", "shaft torque", "shaft order"]
SHAFT_SHARE = 0.5
"""Half peak-to-peak torque of a shaft or joint, over the mean of the loop, from which it counts as in resonance: below,
its peak stays within what it carries under the highest K_V of a mesh."""
NEAR = 0.2
"""Distance of a mode, as a share of its frequency, within which it may still be called near: loaded teeth are stiffer
or softer than the mean stiffness of the modes."""


@dataclass(frozen=True, kw_only=True)
class CampbellMode:
    """A mode that a mesh or a shaft drives, followed over speed."""

    number: int
    """In the list of natural frequencies at the governing held point."""
    name: str
    """Parts that hold its strain energy there."""
    frequency: tuple[float | None, ...]
    """(s,) [Hz]; None where it is damped out or beyond the range."""
    damping_ratio: tuple[float | None, ...]
    """(s,) [-]"""
    whirl: tuple[float | None, ...]
    """(s,) of the shaft that moves most sideways, -1 backward circle to 1 forward circle in its own sense; None where
    less than half of the kinetic energy is lateral motion of shafts, and for shafts that only twist."""
    gain: Mapping[str, float]
    """Largest over speed of what each mesh makes of it, by label (`LoopMode.mesh_gain`) [-]."""
    driven_by: Literal["mesh", "shaft"]

    @property
    def logarithmic_decrement(self) -> tuple[float | None, ...]:
        """(s,) decay from one period to the next, 2 pi D / sqrt(1 - D^2) [-]."""
        return tuple(
            None if ratio is None else 2.0 * math.pi * ratio / math.sqrt(1.0 - ratio**2)
            for ratio in self.damping_ratio
        )


@dataclass(frozen=True, kw_only=True)
class ExcitationOrder:
    """A line of the diagram: frequency = cycles times the turning frequency of the first pinion."""

    kind: OrderKind
    of: tuple[str, ...]
    """Labels of the meshes, or names of the shafts or couplings, that share it."""
    harmonic: float
    """Of the mesh frequency, or order of the shaft."""
    cycles: float


@dataclass(frozen=True, kw_only=True)
class CampbellCrossing:
    """An order that meets a mode it can drive."""

    mode: int
    kind: OrderKind
    of: tuple[str, ...]
    harmonic: float
    speed: float
    """[rad/s]"""
    frequency: float
    """[Hz]"""
    damping_ratio: float
    gain: float
    """Largest of the meshes whose order it is [-]; 0 for a shaft, whose errors drive it."""


@dataclass(frozen=True, kw_only=True)
class CampbellRecord:
    """Modes over speed with what excites them."""

    speeds: tuple[float, ...]
    """(s,) [rad/s]"""
    modes: tuple[CampbellMode, ...]
    orders: tuple[ExcitationOrder, ...]
    crossings: tuple[CampbellCrossing, ...]
    left_out: int
    """Modes of the range that no order drives enough."""


def sense_of_whirl(whirl: Iterable[float | None]) -> Sense:
    """Sense of a mode over speed, at the speed at which it whirls most clearly; empty for one that does not."""
    clearest = max((value for value in whirl if value is not None), key=abs, default=0.0)
    if abs(clearest) < CIRCLING:
        return ""
    return "forward" if clearest > 0.0 else "backward"


@dataclass(frozen=True, kw_only=True)
class TorquePlace:
    """A section of a shaft, a joint, or a mesh with its torque at the pinion."""

    kind: PlaceKind
    part: str
    """Shaft, name of the joint, or label of the mesh."""
    start: float | None = None
    end: float | None = None
    """Of a section, on its shaft [m]."""

    @property
    def name(self) -> str:
        """As it is called in tables."""
        if self.start is None or self.end is None:
            return f"{self.kind} {self.part}"
        return f"{self.part} {1e3 * self.start:.0f} to {1e3 * self.end:.0f} mm"


@dataclass(frozen=True, kw_only=True)
class TorqueSwing:
    """Torque at one place in a periodic state [N m]; of a section where it is highest."""

    mean: float
    """Never negative: it gives the positive direction."""
    half_peak_to_peak: float
    peak: float
    """Largest, whichever its direction."""


@dataclass(frozen=True, kw_only=True)
class HeldTorque:
    """Torque at one place at a held stage."""

    place: TorquePlace
    stage: str
    speed: float
    """[rad/s]"""
    swing: TorqueSwing
    run_peak: float | None
    """Highest of the time run in this stage [N m]."""
    shear_stress: float | None
    """Nominal torsional stress at the surface under the peak [Pa]; shafts only."""


@dataclass(frozen=True, kw_only=True)
class TorqueOverSpeed:
    """Torque at one place over the speeds of the record."""

    place: TorquePlace
    swings: tuple[TorqueSwing, ...]
    shear_per_torque: float
    """Nominal torsional stress at the surface per torque [Pa/(N m)]; 0 of joints and meshes."""


@dataclass(frozen=True, kw_only=True)
class RunTorque:
    """Torque at one place in one stage of the time run, read at every sample; of a section where it is highest."""

    place: TorquePlace
    stage: str
    peak: float
    """Largest amount in the stage [N m]."""
    half_peak_to_peak: float
    """Largest within one window of the run [N m]."""
    mean: float
    """Of that window, never negative [N m]."""
    time: float
    """End of that window [s]."""
    speed: float
    """There [rad/s]."""
    shear_stress: float | None
    """Nominal torsional stress at the surface under the peak [Pa]; shafts only."""


@dataclass(frozen=True, kw_only=True)
class SectionTorqueRecord:
    """All places at the held stages, and over speed under the torque of the governing one."""

    held: tuple[HeldTorque, ...]
    torque: str
    """Of the curves, where the case counts it, in words: ``180 Nm``."""
    speeds: tuple[float, ...]
    """(s,) [rad/s]"""
    curves: tuple[TorqueOverSpeed, ...]
    run: tuple[RunTorque, ...] = ()
    """Of every section and joint in every stage."""


@dataclass(frozen=True, kw_only=True)
class Waterfall:
    """Amplitude of the torque of one mesh over frequency and speed in a run-up or run-down."""

    mesh: str
    """Its label."""
    stage: str
    speed: Annotated[Row, Quantity("rpm")]
    """(s,) of the pinion of the mesh, rising"""
    frequency: Annotated[Row, Quantity("Hz")]
    """(f,) middles of the bins"""
    amplitude: Annotated[tuple[Row, ...], Quantity("N m")]
    """(s, f) largest in each cell, with four digits: it is looked at, not computed with"""
    per_turn: float
    """Mesh frequency per turning frequency of the pinion [-]."""


@dataclass(frozen=True, kw_only=True)
class HeldSpectrum:
    """Torque of one mesh at a held stage over the order of its pinion."""

    mesh: str
    stage: str
    speed: Revolutions
    """Of the pinion of the mesh."""
    mean: NewtonMetres
    order: Row
    """(n,) of the time run, as far as its torque is kept: three mesh orders of the highest speed."""
    amplitude: Annotated[Row, Quantity("N m")]
    """(n,) largest around each order"""
    harmonic_order: Row
    """(h,) of the periodic response: mesh orders, and those between them where its period is longer than a mesh."""
    harmonic_amplitude: Annotated[Row, Quantity("N m")]
    """(h,)"""
    teeth: int
    """Of the pinion: order of the mesh frequency."""


def nearer(peak: float, margin: float) -> tuple[float, float]:
    """Speeds between which a peak is nearer than a margin, a share of the speed [rad/s]."""
    return peak / (1.0 + margin), peak / (1.0 - margin) if margin < 1.0 else math.inf


@dataclass(frozen=True, kw_only=True)
class AvoidedResonance:
    """Speeds around one peak of the response, or a crossing of a shaft order with a mode.

    low, high : between which a speed is nearer than the margin (`nearer`), or the response itself above the share
    """

    kind: ResonanceKind
    where: str
    """Gearbox, gear, place of a torque, or mode."""
    mode: str = ""
    """What vibrates, of a peak of a mesh."""
    speed: float
    """Of the peak [rad/s]."""
    share: float | None
    """Dynamic part over the mean there [-]; None of a crossing, whose response is not computed."""
    low: float
    """[rad/s]"""
    high: float
    """[rad/s]"""

    def widened(self, margin: float) -> "AvoidedResonance":
        """With the speeds round the peak that are nearer than a margin."""
        low, high = nearer(self.speed, margin)
        return replace(self, low=min(self.low, low), high=max(self.high, high))

    def distance(self, speed: float, margin: float) -> float:
        """Of a speed from the peak, as a share of that speed [-]; 0 in the band beyond the margin, where the response
        itself is above the stated share. Below the margin just where the speed is in the band."""
        away = abs(speed - self.speed) / speed
        return 0.0 if away >= margin and self.low < speed < self.high else away


@dataclass(frozen=True, kw_only=True)
class NearResonance:
    """The resonance nearest to a dwell."""

    distance: float
    """As a share of the speed of the dwell; the range searched where none is near [-]."""
    resonance: AvoidedResonance | None


@dataclass(frozen=True, kw_only=True)
class AvoidedBand:
    """Resonances whose bands touch."""

    low: float
    """[rad/s]"""
    high: float
    """[rad/s]"""
    resonances: tuple[AvoidedResonance, ...]


@dataclass(frozen=True, kw_only=True)
class DwellStage:
    """A stage of the schedule that turns at one speed, or is held at its end."""

    stage: str
    kind: str
    speed: float
    """[rad/s]"""
    computed: bool
    """Whether the response is known at its speed."""
    near: NearResonance | None
    """None where it is not known."""
    band: AvoidedBand | None
    """In which it lies."""
    nearest_safe: float | None
    """Nearest safe speed within the limit of the rig for a stage in a band [rad/s]; None where there is none."""
    above_limit: bool
    """Whether it turns faster than the rig may."""
    loses_contact: bool
    """Whether contact is lost at its speed under the start torque, with which it begins or ends."""


@dataclass(frozen=True, kw_only=True)
class RampStep:
    """One step of the recommended ramp."""

    action: str
    speed: float
    """At its end [rad/s]."""
    torque: float
    """Stated, at its end [N m]."""
    reason: str


@dataclass(frozen=True, kw_only=True)
class DwellRecord:
    """Bands to avoid between two speeds, what is left, the stages of the case and the recommended ramp."""

    share_limit: float
    """Of meshes and root stress [-]."""
    shaft_share_limit: float
    """Of the torque in shafts and joints [-]."""
    margin: float
    low: float
    """[rad/s]"""
    high: float
    """[rad/s]"""
    speed_limit: float | None
    """Of the rig [rad/s]; None where the case states none."""
    speed_limit_source: str
    """Key that states it."""
    bands: tuple[AvoidedBand, ...]
    safe: tuple[tuple[float, float], ...]
    """Within the limit of the rig [rad/s]."""
    stages: tuple[DwellStage, ...]
    ramp: tuple[RampStep, ...]
    speeds: tuple[float, ...]
    """(s,) [rad/s]"""
    highest: Mapping[ResonanceKind, tuple[float, ...]]
    """(s,) largest share of all quantities of a kind [-]."""
