"""Speed and torque at the pinion of a stage from those that a gear unit states anywhere, without losses."""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace

from rigdesign.rexs.gear_unit import GearUnit, OperatingCase, ShaftLoad, UnitMesh


@dataclass(frozen=True)
class PinionLoad:
    """One operating case at the pinion.

    speed, torque : without sign [rad/s, N m]; None where the file does not determine them
    speed_of : shaft whose speed is stated; loads : ids of the loads that make the torque
    undetermined : why the file does not determine the torque; empty where it does
    """

    case: OperatingCase
    speed: float | None
    torque: float | None
    speed_of: int | None = None
    loads: tuple[int, ...] = ()
    undetermined: str = ""


def pinion_loads(unit: GearUnit, meshes: tuple[UnitMesh, ...]) -> tuple[PinionLoad, ...]:
    """Operating cases at the pinion of a stage, that with the most torque first.

    Its torque is what comes from the shafts on one side of the stage; where power takes another way round the stage,
    statics do not say it.
    """
    shaft, other = unit.gear(meshes[0].pinion).shaft, unit.gear(meshes[0].wheel).shaft
    if shaft is None:
        return ()
    ratios = _speeds_over(unit, shaft)
    sides = tuple(
        frozenset[int]() if start is None else frozenset(_speeds_over(unit, start, without=meshes))
        for start in (shaft, other)
    )
    found = [_at_pinion(case, ratios, sides) for case in unit.operating_cases]
    return tuple(sorted(found, key=lambda load: -(load.torque or 0.0)))


def _speeds_over(unit: GearUnit, start: int, without: Collection[UnitMesh] = ()) -> dict[int, float]:
    """Speed of every shaft that turns with ``start`` over its speed."""
    joints = list(_joints(unit, without))
    found, front = {start: 1.0}, [start]
    while front:
        here = front.pop()
        for first, second, ratio in joints:
            for source, other, times in ((first, second, ratio), (second, first, 1.0 / ratio)):
                if source == here and other not in found:
                    found[other] = found[here] * times
                    front.append(other)
    return found


def _joints(unit: GearUnit, without: Collection[UnitMesh]) -> Iterator[tuple[int, int, float]]:
    """Shafts that turn together: the two, speed of the second over that of the first."""
    for mesh in unit.meshes:
        pinion, wheel = unit.gear(mesh.pinion), unit.gear(mesh.wheel)
        if mesh in without or pinion.shaft is None or wheel.shaft is None:
            continue
        if pinion.teeth and wheel.teeth:
            yield pinion.shaft, wheel.shaft, -pinion.teeth / wheel.teeth
    shafts = {shaft.id for shaft in unit.shafts}
    for coupling in unit.couplings:
        inner, outer = coupling.place.inner, coupling.place.outer
        if inner is not None and outer is not None and {inner, outer} <= shafts:
            yield inner, outer, 1.0


def _at_pinion(
    case: OperatingCase, ratios: Mapping[int, float], sides: tuple[frozenset[int], ...]
) -> PinionLoad:
    turning = [shaft for shaft in ratios if case.speeds.get(shaft)]
    speed_of = turning[0] if turning else None
    speed = None if speed_of is None else case.speeds[speed_of] / ratios[speed_of]
    known = PinionLoad(case, None if speed is None else abs(speed), None, speed_of)
    if not sides[0].isdisjoint(sides[1]):
        return replace(
            known,
            undetermined="power branches: other stages or couplings join the same shafts beside this stage",
        )
    unknown: set[int] = set()
    for side in sides:
        loads = [load for load in case.loads if load.shaft in side and load.transmits_torque is not False]
        torques = {load.id: _torque(load, ratios, speed) for load in loads}
        used = {number: torque for number, torque in torques.items() if torque is not None}
        loaded = {load.shaft for load in loads if load.id in used}
        missing = {load.id for load in loads if load.shaft not in loaded}
        total = abs(sum(used.values()))
        if total > 0.0 and not missing:
            return replace(known, torque=total, loads=tuple(used))
        unknown |= missing
    text = f"power branches: loads {', '.join(map(str, sorted(unknown)))} of other shafts state no torque"
    return replace(known, undetermined=text if unknown else "")


def _torque(load: ShaftLoad, ratios: Mapping[int, float], speed: float | None) -> float | None:
    """A load reduced to the pinion [N m]: the same power at its speed."""
    if load.torque is not None and load.shaft is not None and load.shaft in ratios:
        return load.torque * ratios[load.shaft]
    return load.power / speed if load.power is not None and speed else None
