"""Operating points met again: how far two of them lie apart, and which of one set are those of another."""

from collections.abc import Callable, Sequence
from typing import TypeVar

from rigdesign.prediction.model import OperatingCondition

NEAR = {"speed": 0.05, "torque": 0.05, "flow": 0.15, "temperature": 8.0}
"""How far a point may lie from the plan for derivatives to carry it over: relative, temperatures in kelvin."""
AGAIN = 2.0
"""How far a point may lie from one of another set to be the same, met again (`apart`)."""

T = TypeVar("T")


def nearest_of(
    wanted: Sequence[T], offered: Sequence[T], distance: Callable[[T, T], float], most: float
) -> dict[int, int]:
    """Place of a wanted one -> that of the nearest offered one, none used twice; without those that are farther off."""
    found: dict[int, int] = {}
    for number, one in enumerate(wanted):
        free = [place for place in range(len(offered)) if place not in found.values()]
        nearest = min(free, key=lambda place: distance(offered[place], one), default=None)
        if nearest is not None and distance(offered[nearest], one) <= most:
            found[number] = nearest
    return found


def apart(planned: OperatingCondition, run: OperatingCondition) -> float:
    """Distance of a point from one of a plan, at most one where derivatives serve; infinite where they state
    different things."""
    if dict(planned.tooth_offset) != dict(run.tooth_offset):
        return float("inf")
    if set(planned.inlet_temperature) != set(run.inlet_temperature) or set(planned.flow) != set(run.flow):
        return float("inf")
    if (planned.ambient_temperature is None) != (run.ambient_temperature is None):
        return float("inf")
    shares = [
        abs(run.speed / planned.speed - 1.0) / NEAR["speed"],
        abs(run.torque - planned.torque) / max(abs(planned.torque), 1e-9) / NEAR["torque"],
    ]
    shares += [abs(run.flow[place] / value - 1.0) / NEAR["flow"] for place, value in planned.flow.items()]
    warmer = [run.inlet_temperature[place] - value for place, value in planned.inlet_temperature.items()]
    if planned.ambient_temperature is not None and run.ambient_temperature is not None:
        warmer.append(run.ambient_temperature - planned.ambient_temperature)
    return max(*shares, *(abs(step) / NEAR["temperature"] for step in warmer))


def met_again(now: Sequence[OperatingCondition], before: Sequence[OperatingCondition]) -> dict[str, str]:
    """Operating point -> that of the other set it is; the rig at rest is one of them."""
    pairs = nearest_of(now, before, apart, AGAIN)
    return {"": ""} | {now[here].name: before[there].name for here, there in pairs.items()}
