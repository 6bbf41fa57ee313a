"""Dynamic loads of the meshes: SI records. Speeds are those of a mesh's own pinion, torques positive on the flank that
carries."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Literal, Protocol

from dynamics.rotor.bracing import BracingDrift
from dynamics.rotor.torsional_modes import DampingRecord, LoopMode
from rigdesign.results.check import Role
from rigdesign.results.quantity import (
    Degrees,
    Hertz,
    Megapascals,
    NewtonMetres,
    Newtons,
    Quantity,
    Revolutions,
    Seconds,
    Watts,
)
from rigdesign.results.teeth import FROM_FACTORS, FROM_INFLUENCE, StressSource, ToothHistory


@dataclass(frozen=True, kw_only=True)
class StageLoad:
    """Load of one mesh in one stage of the time run, by its envelopes."""

    stage: str
    dynamic_factor: float
    """Highest torque over the mean of its window."""
    speed: Revolutions
    """Where the dynamic factor occurs."""
    mean: NewtonMetres
    """Mean torque there."""
    peak: NewtonMetres
    """Highest torque of the stage."""
    least: NewtonMetres
    """Lowest torque of the stage."""
    least_share: float
    """Lowest torque over the mean of its window; below zero where the other flank is hit."""
    least_share_speed: Annotated[float, Quantity("rpm", "least share at")]
    least_share_mean: NewtonMetres


@dataclass(frozen=True, kw_only=True)
class ContactLoss:
    """An interval of the time run in which a mesh kept losing contact."""

    stage: str
    start: Seconds
    end: Seconds
    share: float
    """Of the time without contact."""
    longest_gap: Annotated[float, Quantity("ms")]


@dataclass(frozen=True, kw_only=True)
class MeshResonance:
    """A peak of the dynamic torque over speed."""

    torque: str
    """Torque of the curve where the case counts it, in words: ``180 Nm``."""
    mode: str
    frequency: Hertz
    harmonic: int
    speed: Revolutions
    dynamic_factor: float
    force_share: float
    amplification: float
    """Peak over the level it stands on."""
    at_end: bool
    """The torque still rises at the highest speed computed."""
    dangerous: bool
    """Above a limit of the case."""


@dataclass(frozen=True, kw_only=True)
class ModeCrossing:
    """A mesh or shaft order that meets a mode of the closed loop; a mesh excites it."""

    kind: Literal["mesh", "shaft"]
    order_of: str
    """Label of the mesh, or shaft."""
    mode: int
    shape: str
    frequency: Hertz
    damping_ratio: float
    harmonic: int
    speed: Revolutions
    """Of the pinion of the mesh, or of the shaft."""
    gain: float


@dataclass(frozen=True, kw_only=True)
class ListedMode:
    """A mode of the closed loop, meshes at their mean stiffness."""

    mode: int
    """1 for the lowest that oscillates, 0 for rigid rotation."""
    frequency: Hertz
    damping_ratio: float
    shape: str
    """Parts that hold the strain energy."""
    largest_at: str
    """Shaft and place that oscillate most."""


@dataclass(frozen=True, kw_only=True)
class JointDamping:
    """Damping of one joint or mesh."""

    joint: str
    kind: str
    damping_ratio: float
    corner_frequency: Annotated[float | None, Quantity("Hz")]
    """None without damping."""
    own_frequency: Hertz
    warning: str


@dataclass(frozen=True, kw_only=True)
class HeldBracing:
    """The bracing of one held stage, warm and as drawn."""

    stage: str
    mode: str
    torque: NewtonMetres
    twist: Annotated[float, Quantity("deg")]
    axial_shift: Annotated[float, Quantity("mm")]
    half_gear_rotation: Annotated[float, Quantity("deg")]
    actuator_force: Newtons
    spline_friction: Newtons
    loop_stiffness: Annotated[float, Quantity("kN m/rad")]
    torque_as_drawn: NewtonMetres
    axial_shift_as_drawn: Annotated[float, Quantity("mm")]


@dataclass(frozen=True, kw_only=True)
class TorqueBalance:
    """Power of the drive against the losses of one held stage."""

    stage: str
    drive_torque: NewtonMetres
    drive_power: Watts
    losses: Watts

    @property
    def joints(self) -> Watts:
        """What joints damp: the rest."""
        return self.drive_power - self.losses


@dataclass(frozen=True, kw_only=True)
class UnsolvedSpeed:
    """A speed at which a curve has no point because no periodic response was found."""

    curve: str
    speed: Revolutions
    reason: str


@dataclass(frozen=True, kw_only=True)
class RootStressPath:
    """Root stress of one gear over its rolling angle at the held stage that stresses it most."""

    gear: str
    stage: str
    rolling_angle: tuple[float, ...]
    """(n,), zero at the pitch point [rad]."""
    dynamic: tuple[float, ...]
    """(n,) [Pa]"""
    quasi_static: tuple[float, ...]
    """(n,) [Pa]"""
    source: StressSource = FROM_FACTORS
    """Of the stress per tooth force."""

    @property
    def by_influence(self) -> bool:
        """Whether the stress per tooth force is that of finite elements."""
        return self.source == FROM_INFLUENCE


@dataclass(frozen=True, kw_only=True)
class RootStressRatio:
    """Highest dynamic over highest quasi-static root stress at one speed."""

    speed: Revolutions
    pinion: float
    wheel: float


class MeshLoads(Protocol):
    """Dynamic loads of one mesh."""

    @property
    def role(self) -> Role:
        """Of its gearbox."""

    @property
    def torque_peak(self) -> float:
        """Highest of the time run and the periodic responses of the held stages [N m]."""

    @property
    def stage_loads(self) -> tuple[StageLoad, ...]:
        """Of every stage that turns under torque."""

    @property
    def contact_losses(self) -> tuple[ContactLoss, ...]:
        """Of the time run."""

    @property
    def resonances(self) -> tuple[MeshResonance, ...]:
        """Peaks of all curves."""

    @property
    def unsolved(self) -> tuple[UnsolvedSpeed, ...]:
        """Speeds at which a curve has no point."""

    @property
    def root_stress(self) -> tuple[RootStressPath, ...]:
        """Of pinion and wheel."""

    @property
    def root_stress_ratios(self) -> tuple[RootStressRatio, ...]:
        """Over the speeds of the governing curve."""


@dataclass(frozen=True, kw_only=True)
class StageBracing:
    """The bracing of one held stage, as set and warmed up."""

    stage: str
    drift: BracingDrift


class DynamicLoads(Protocol):
    """What the drivetrain says of its loads."""

    @property
    def meshes(self) -> Mapping[str, MeshLoads]:
        """By the label of the mesh."""

    @property
    def modes(self) -> tuple[LoopMode, ...]:
        """Of the closed loop, meshes at their mean stiffness."""

    @property
    def loop_crossings(self) -> tuple[ModeCrossing, ...]:
        """Up to the highest speed of the curves."""

    @property
    def damping(self) -> tuple[DampingRecord, ...]:
        """Of springs and dampers."""

    @property
    def bracing(self) -> tuple[StageBracing, ...]:
        """Of every held stage."""

    @property
    def teeth(self) -> Mapping[str, ToothHistory]:
        """Of every loaded gear ``gearbox.gear``."""


# Press fit and spline of a gear at the largest torque of a stage or event: SI records.

SplineStressKind = Literal["flank pressure", "shear of the teeth", "shear of the shaft", "tension of the hub"]


@dataclass(frozen=True, kw_only=True)
class PressFitCapacity:
    """A gear on its shaft at the largest torque of a stage or event."""

    gear: str
    """``gearbox.gear``"""
    stage: str
    """Held stage whose temperatures count."""
    where: str
    """Stage or event of the torque, in words."""
    interference: Annotated[float, Quantity("um")]
    """Effective and least, on the diameter, at rest and 20 degC."""
    interference_hot: Annotated[float, Quantity("um")]
    gear_temperature: Degrees
    shaft_temperature: Degrees
    pressure_at_rest: Megapascals
    pressure: Megapascals
    """Hot and at speed; 0 where the seat is loose."""
    friction: float
    slip_torque: NewtonMetres
    peak_torque: NewtonMetres

    @property
    def safety(self) -> Annotated[float | None, Quantity()]:
        """Slip torque over peak torque; None without torque."""
        return self.slip_torque / self.peak_torque if self.peak_torque > 0.0 else None


@dataclass(frozen=True, kw_only=True)
class SplineStress:
    """One stress of one spline."""

    gear: str
    """``gearbox.gear``"""
    kind: SplineStressKind
    where: str
    """Stage or event of the torque, in words."""
    torque: NewtonMetres
    stress: Megapascals
    allowable: Megapascals
    """As the case states it."""

    @property
    def safety(self) -> Annotated[float | None, Quantity()]:
        """Allowable over stress; None without stress."""
        return self.allowable / self.stress if self.stress > 0.0 else None


# Loads of the rig in an event: SI records.

Load = Literal["coupling torque", "shaft torque", "seat torque", "mesh torque", "bearing force"]


LEAST_SHARE = 0.05
"""Part of a peak below which what was there before is no measure of it."""
ShearStress = Annotated[float | None, Quantity("MPa")]


@dataclass(frozen=True, kw_only=True)
class EventPeak:
    """Largest amount of one quantity of one part [N m], [N]."""

    place: str
    """Coupling, section of a shaft as in tables, gear on its seat ``gearbox.gear``, ``gearbox.mesh`` or
    ``gearbox.bearing``."""
    part: str
    """The same, of a section its shaft."""
    quantity: Load
    before: float
    """Mean before the event."""
    peak: float
    time: Seconds
    """From the instant of the event."""
    shear_stress: ShearStress = None
    """Nominal torsional stress at the surface of a shaft under the peak."""

    @property
    def unit(self) -> Annotated[str, Quantity()]:
        """Of ``before`` and ``peak``."""
        return "N" if self.quantity == "bearing force" else "N m"

    @property
    def factor(self) -> Annotated[float | None, Quantity()]:
        """Peak over what was there before; None where that was next to nothing."""
        return self.peak / abs(self.before) if abs(self.before) > LEAST_SHARE * self.peak else None


@dataclass(frozen=True, kw_only=True)
class PassingPeak:
    """Largest amount of a torque at one place during run-down through the resonances."""

    place: str
    part: str
    quantity: Load
    peak: NewtonMetres
    speed: Revolutions
    """Stated speed at which it is passed."""
    shear_stress: ShearStress = None
    """As of `EventPeak`."""


@dataclass(frozen=True, kw_only=True)
class Reversal:
    """Contact of one mesh through an event."""

    mesh: str
    open_share: float
    """Share of the time without contact."""
    other_flank: NewtonMetres
    """Most torque on the flanks that carry nothing before."""


@dataclass(frozen=True, kw_only=True)
class EventCurve:
    """Extremes of a torque in envelope windows."""

    place: str
    quantity: Load
    least: Annotated[list[float], Quantity("N m")] = field(repr=False)
    greatest: Annotated[list[float], Quantity("N m")] = field(repr=False)


@dataclass(frozen=True, kw_only=True)
class EventRecord:
    """One event; what its kind does not have is None or empty."""

    name: str
    kind: str
    speed: Revolutions
    """Of the test gear's shaft as stated."""
    torque: NewtonMetres
    """As stated."""
    what: str
    """In words: teeth lost, brake torque."""
    peaks: tuple[EventPeak, ...] = ()
    passing: tuple[PassingPeak, ...] = ()
    """Of a stop, from the periodic responses over speed."""
    reversals: tuple[Reversal, ...] = ()
    tripped: Annotated[float | None, Quantity("s")] = None
    """Time until the limit of the monitor is crossed."""
    untripped: Annotated[float | None, Quantity("s")] = None
    """Time for which a monitor was watched that never tripped."""
    standstill: Annotated[float | None, Quantity("s")] = None
    """Time to standstill, from the trip or the stop on."""
    dynamic_factor: dict[str, float] = field(default_factory=dict)
    """K_V by mesh, of an overspeed."""
    resonance: str = ""
    """Nearest resonance of an overspeed, in words."""
    resonance_distance: float | None = None
    """Its distance as a share of the speed."""
    time: Annotated[list[float], Quantity("s")] = field(default_factory=list, repr=False)
    """End of each envelope window of the curves."""
    curves: tuple[EventCurve, ...] = ()
    notes: tuple[str, ...] = ()
