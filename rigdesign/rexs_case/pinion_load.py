"""Speed and torque at the pinion of a stage from those that a gear unit states anywhere, without losses."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from rigdesign.rexs.gear_unit import GearUnit, OperatingCase, ShaftLoad, UnitMesh


@dataclass(frozen=True)
class PinionLoad:
    """One operating case at the pinion.

    speed, torque : without sign [rad/s, N m]; None where the file does not determine them
    speed_of : shaft whose speed is stated; loads : ids of the loads that make the torque
    """

    case: OperatingCase
    speed: float | None
    torque: float | None
    speed_of: int | None = None
    loads: tuple[int, ...] = ()


def pinion_loads(unit: GearUnit, mesh: UnitMesh) -> tuple[PinionLoad, ...]:
    """Operating cases at the pinion of a mesh, that with the most torque first."""
    shaft = unit.gear(mesh.pinion).shaft
    if shaft is None:
        return ()
    ratios = _speeds_over(unit, shaft)
    sides = tuple(
        frozenset(_speeds_over(unit, start, without=mesh)) if start is not None else frozenset[int]()
        for start in (shaft, unit.gear(mesh.wheel).shaft)
    )
    found = [_at_pinion(case, ratios, sides) for case in unit.operating_cases]
    return tuple(sorted(found, key=lambda load: -(load.torque or 0.0)))


def _speeds_over(unit: GearUnit, start: int, without: UnitMesh | None = None) -> dict[int, float]:
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


def _joints(unit: GearUnit, without: UnitMesh | None) -> Iterator[tuple[int, int, float]]:
    """Shafts that turn together: the two, speed of the second over that of the first."""
    for mesh in unit.meshes:
        pinion, wheel = unit.gear(mesh.pinion), unit.gear(mesh.wheel)
        if mesh is without or pinion.shaft is None or wheel.shaft is None:
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
    best: tuple[float, tuple[int, ...]] | None = None
    for side in sides:
        loads = [load for load in case.loads if load.shaft in side and load.transmits_torque is not False]
        torques = {load.id: _torque(load, ratios, speed) for load in loads}
        known = {number: torque for number, torque in torques.items() if torque is not None}
        total = abs(sum(known.values()))
        if total > 0.0 and (best is None or len(known) == len(torques)):
            best = (total, tuple(known))
        if best is not None and len(known) == len(torques):
            break
    torque, used = best if best is not None else (None, ())
    return PinionLoad(case, None if speed is None else abs(speed), torque, speed_of, used)


def _torque(load: ShaftLoad, ratios: Mapping[int, float], speed: float | None) -> float | None:
    """A load reduced to the pinion [N m]: the same power at its speed."""
    if load.torque is not None and load.shaft is not None and load.shaft in ratios:
        return load.torque * ratios[load.shaft]
    return load.power / speed if load.power is not None and speed else None
