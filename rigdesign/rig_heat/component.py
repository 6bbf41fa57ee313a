"""Heat of a component and where it goes."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

from rigdesign.base.number_faults import require_share

ROOM = "room"
"""Where heat goes that no coolant takes."""


@dataclass(frozen=True, kw_only=True)
class HeatSplit:
    """How the heat of a component splits.

    coolant : what takes part of it, an oil circuit or the cooling water of a motor
    coolant_share : of the heat [-]; the rest goes to the room
    """

    coolant: str = "coolant"
    coolant_share: float = 0.0

    def __post_init__(self) -> None:
        require_share("coolant_share", self.coolant_share, "give 0 for a component cooled by air")


@dataclass(frozen=True, kw_only=True)
class ComponentHeat:
    """Heat of one component [W]."""

    name: str
    power: float
    split: HeatSplit
    source: str
    warnings: tuple[str, ...] = ()

    @property
    def to_coolant(self) -> float:
        """[W]"""
        return self.split.coolant_share * self.power

    @property
    def to_room(self) -> float:
        """[W]"""
        return self.power - self.to_coolant


def heat_by_sink(components: Iterable[ComponentHeat]) -> dict[str, float]:
    """Heat of all components by where it goes [W]: `ROOM`, and every coolant by name."""
    parts: dict[str, list[float]] = {ROOM: []}
    for each in components:
        parts[ROOM].append(each.to_room)
        if each.split.coolant_share:
            parts.setdefault(each.split.coolant, []).append(each.to_coolant)
    return {sink: math.fsum(values) for sink, values in parts.items()}
