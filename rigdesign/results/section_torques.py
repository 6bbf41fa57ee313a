"""Dynamic torque in shafts, joints and meshes: SI records. Speeds are those of the pinion of the first mesh."""

from dataclasses import dataclass
from typing import Literal

PlaceKind = Literal["shaft", "spline", "coupling", "motor", "mesh"]


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
    """Highest of the time run in this stage [N m]; meshes only."""
    shear_stress: float | None
    """Nominal torsional stress at the surface under the peak [Pa]; shafts only."""


@dataclass(frozen=True, kw_only=True)
class TorqueOverSpeed:
    """Torque at one place over the speeds of the record."""

    place: TorquePlace
    swings: tuple[TorqueSwing, ...]


@dataclass(frozen=True, kw_only=True)
class RunTorque:
    """Largest alternating torque at one place in the time run, of those at 40 instants a second."""

    place: TorquePlace
    half_peak_to_peak: float
    """Over the milliseconds from that instant on [N m]."""
    mean: float
    """Of the same time, never negative [N m]."""
    time: float
    """[s]"""
    speed: float
    """[rad/s]"""
    stage: str


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
    """Sections and joints; none where the time run did not look at them."""
