"""Campbell diagram of the closed loop: SI record. Speeds are those of the pinion of the first mesh."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Literal

OrderKind = Literal["mesh", "shaft", "coupling"]
Sense = Literal["forward", "backward", ""]
CIRCLING = 0.1
"""Whirl, as area of an orbit over that of a circle of its size, from which it has a sense."""


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
