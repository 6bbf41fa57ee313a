"""Distances between operating conditions, and small steps of their values for derivatives."""

from collections.abc import Sequence
from dataclasses import replace

from rigdesign.case.model import Case
from rigdesign.prediction.model import OperatingCondition

STEP_SHARE = 2e-3
"""Share of a speed, torque or flow by which it is moved for a derivative."""
STEP_KELVIN = 0.2
"""Temperature by which an inlet or the room is moved for a derivative [K]."""


def moved_conditions(
    case: Case, setting: OperatingCondition
) -> dict[tuple[str, str], tuple[OperatingCondition, float]]:
    """(kind, place) -> the setting with that value moved a little, and by how much."""
    moved: dict[tuple[str, str], tuple[OperatingCondition, float]] = {}
    for kind in ("speed", "torque"):
        step = STEP_SHARE * max(abs(getattr(setting, kind)), 1.0)
        moved[kind, ""] = replace(setting, **{kind: getattr(setting, kind) + step}), step
    for name, box in case.gearboxes.items():
        for kind, (feed, _) in box.feeds.items():
            stream = f"{name}.{kind}"
            inlet = setting.inlet_temperature.get(stream, feed.inlet_temperature)
            inlets = {**setting.inlet_temperature, stream: inlet + STEP_KELVIN}
            moved["inlet_temperature", stream] = replace(setting, inlet_temperature=inlets), STEP_KELVIN
            flow = setting.flow.get(stream, feed.flow)
            flows = {**setting.flow, stream: flow * (1.0 + STEP_SHARE)}
            moved["flow", stream] = replace(setting, flow=flows), flow * STEP_SHARE
        if box.sump is not None and box.sump.sump_temperature is not None:
            stream = f"{name}.gear_oil"
            held = setting.inlet_temperature.get(stream, box.sump.sump_temperature)
            inlets = {**setting.inlet_temperature, stream: held + STEP_KELVIN}
            moved["inlet_temperature", stream] = replace(setting, inlet_temperature=inlets), STEP_KELVIN
    room = case.ambient.temperature if setting.ambient_temperature is None else setting.ambient_temperature
    warmer = replace(setting, ambient_temperature=room + STEP_KELVIN)
    moved["ambient_temperature", ""] = warmer, STEP_KELVIN
    return moved


def distance(first: OperatingCondition, second: OperatingCondition) -> float:
    """How far two operating points lie apart, for a choice among neighbours."""
    speed = abs(first.speed - second.speed) / max(first.speed, second.speed, 1e-9)
    torque = abs(first.torque - second.torque) / max(abs(first.torque), abs(second.torque), 1e-9)
    feeds = [(first.inlet_temperature, second.inlet_temperature), (first.flow, second.flow)]
    oil = sum(
        abs(one.get(key, other[key]) - other[key]) / abs(other[key]) for one, other in feeds for key in other
    )
    return float(speed + 0.5 * torque + 3.0 * oil)


def furthest_apart(settings: Sequence[OperatingCondition], count: int) -> list[OperatingCondition]:
    """The most severe operating point and those that lie furthest from all chosen before."""
    if not settings:
        return []
    chosen = [max(settings, key=lambda s: (s.speed * abs(s.torque), s.speed))]
    while len(chosen) < min(count, len(settings)):
        chosen.append(max(settings, key=lambda s: min(distance(c, s) for c in chosen)))
    return chosen
