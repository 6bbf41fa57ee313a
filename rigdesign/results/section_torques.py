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
