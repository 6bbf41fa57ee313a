"""Campbell diagram of the closed loop: SI record. Speeds are those of the pinion of the first mesh."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

OrderKind = Literal["mesh", "shaft", "coupling"]


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
    gain: Mapping[str, float]
    """Largest over speed of what each mesh makes of it, by label (`LoopMode.mesh_gain`) [-]."""
    driven_by: Literal["mesh", "shaft"]


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
