"""How fast the rig may turn: limits that the case states for the speed of its parts."""

from dataclasses import dataclass

from rigdesign.case.component_limits import shafts_of
from rigdesign.rig.model import Rig


@dataclass(frozen=True)
class SpeedLimit:
    """Highest speed of the first pinion [rad/s], and the key that states it."""

    speed: float
    source: str


def speed_limit(rig: Rig) -> SpeedLimit | None:
    """The lowest of ``limits.bought_parts`` with quantity speed; None where the case states none."""
    found = []
    for name, part in rig.case.limits.bought_parts.items():
        if part.quantity == "speed":
            shafts = shafts_of(rig.case, part.part)
            ratio = max((abs(rig.shaft_speed(shaft, 1.0)) for shaft in shafts), default=0.0)
            if ratio > 0.0:
                found.append(
                    SpeedLimit(rig.pinion_speed(part.limit_si / ratio), f"limits.bought_parts.{name}")
                )
    return min(found, key=lambda one: one.speed, default=None)
