"""The stage of a gear unit that becomes a gearbox: two gears, their shafts and bearings; what is left out of the case.

Two stages of opposite hand between the same two shafts are one double-helical stage.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import copysign

from rigdesign.base.errors import UsageError
from rigdesign.rexs.gear_unit import GearUnit, ShaftSection, UnitBearing, UnitGear, UnitMesh, UnitShaft

SIDES = ("front", "rear")
ALIKE = ("shaft", "teeth", "normal_module", "pressure_angle", "face_width", "profile_shift")
"""What both halves of a double-helical gear have in common."""
SAME = 1e-6
"""Difference of two measures that is round-off [m]."""


@dataclass(frozen=True)
class SeatedGear:
    """A gear of the stage with its shaft, whose places count from the front, turned where the file has them otherwise.

    bearings : between shaft and casing, from the front, at most two: the outermost ones
    more : its other bearings, which a case does not have
    direction : 1 where the file counts the shaft from the front to the rear, else -1
    """

    name: str
    gear: UnitGear
    shaft: UnitShaft | None
    bearings: tuple[UnitBearing, ...] = ()
    more: tuple[UnitBearing, ...] = ()
    direction: float = 1.0

    def bearing_at(self, bearing: UnitBearing) -> float | None:
        """Place of a bearing on the shaft, from its front [m]."""
        place, shaft = bearing.place, self.gear.shaft
        return self.from_front(place.inner_position if place.inner == shaft else place.outer_position)

    def from_front(self, place: float | None) -> float | None:
        """A place that the file counts from its start of the shaft [m]."""
        if place is None or self.direction > 0.0:
            return place
        return None if self.shaft is None or not self.shaft.sections else self.shaft.length - place

    @property
    def position(self) -> float | None:
        """Middle of its face from the front of its shaft [m], where both its bearings have places as well."""
        places = [self.bearing_at(bearing) for bearing in self.bearings]
        known = [place for place in (self.gear.position, *places) if place is not None]
        ordered = len(known) == 3 and min(known) >= 0.0 and known[1] < known[2]
        return self.gear.position if ordered else None


@dataclass(frozen=True)
class GearStage:
    """A pair of gears.

    number : among the stages of the file, from 1
    meshes : of the file: one, or both halves of a double-helical stage
    """

    number: int
    meshes: tuple[UnitMesh, ...]
    pinion: SeatedGear
    wheel: SeatedGear

    @property
    def mesh(self) -> UnitMesh:
        """The mesh, or its first half."""
        return self.meshes[0]

    @property
    def double_helical(self) -> bool:
        """Whether it has two halves of opposite hand."""
        return len(self.meshes) == 2

    @property
    def gears(self) -> tuple[SeatedGear, SeatedGear]:
        """Pinion and wheel."""
        return self.pinion, self.wheel


def chosen_stage(unit: GearUnit, number: int | None, source: str) -> GearStage:
    """The stage of this number; without one the only stage.

    Raises
    ------
    UsageError
        No stage of two cylindrical gears with outer teeth, several and none chosen, or none of this number; the
        stages are listed.
    """
    if not unit.meshes:
        raise UsageError(
            f"{source}: no case was written: no cylindrical stage of two gears with outer teeth in this file; a case "
            "has no planetary, bevel or worm stages, give a model with a cylindrical stage"
        )
    stages = gear_stages(unit)
    if number is None and len(stages) > 1:
        raise UsageError(
            f"{source}: no case was written: {len(stages)} stages, a gearbox of a case takes one; choose with "
            f"--stage:\n{_listed(unit)}"
        )
    number = 1 if number is None else number
    if not 1 <= number <= len(stages):
        raise UsageError(
            f"{source}: no case was written: --stage {number}: no such stage; choose one of these:\n{_listed(unit)}"
        )
    meshes = stages[number - 1]
    first = unit.gear(meshes[0].pinion)
    return GearStage(
        number,
        meshes,
        _seated(unit, "pinion", meshes, first),
        _seated(unit, "wheel", meshes, first),
    )


def gear_stages(unit: GearUnit) -> tuple[tuple[UnitMesh, ...], ...]:
    """Meshes of the unit, the two halves of a double-helical stage together."""
    stages: list[tuple[UnitMesh, ...]] = []
    alone: dict[tuple[int | None, int | None], list[int]] = {}
    for mesh in unit.meshes:
        waiting = alone.setdefault((unit.gear(mesh.pinion).shaft, unit.gear(mesh.wheel).shaft), [])
        half = next((number for number in waiting if _halves(unit, stages[number][0], mesh)), None)
        if half is None:
            waiting.append(len(stages))
            stages.append((mesh,))
        else:
            waiting.remove(half)
            stages[half] = (*stages[half], mesh)
    return tuple(stages)


def _halves(unit: GearUnit, first: UnitMesh, second: UnitMesh) -> bool:
    """Whether two meshes join the same shafts by equal gears of opposite hand."""
    gears = [unit.gear(gear) for gear in (first.pinion, first.wheel)]
    mates = [unit.gear(gear) for gear in (second.pinion, second.wheel)]
    return first.centre_distance == second.centre_distance and all(
        gear.shaft is not None
        and bool(gear.helix_angle)
        and gear.helix_angle == -(mate.helix_angle or 0.0)
        and all(getattr(gear, key) == getattr(mate, key) for key in ALIKE)
        for gear, mate in zip(gears, mates, strict=True)
    )


def left_out(unit: GearUnit, stage: GearStage) -> Iterator[str]:
    """Parts of the unit at the shafts of the stage that a case does not have, each with what follows."""
    seats = {seated.gear.shaft: seated.name for seated in stage.gears if seated.gear.shaft is not None}
    for seated in stage.gears:
        for bearing in seated.more:
            yield (
                f"bearing {bearing.id} {bearing.name}: a case holds a shaft in two bearings, that of the "
                f"{seated.name} in its outermost ones, {' and '.join(str(item.id) for item in seated.bearings)}"
            )
        if seated.position is None and unit.gear(seated.gear.id).position is not None:
            yield (
                f"place of gear {seated.gear.id}: counts where both bearings of its shaft have places too, from its "
                "front on; the case takes its defaults"
            )
    for bearing in unit.bearings:
        joined = [part for part in (bearing.place.inner, bearing.place.outer) if part in seats]
        if joined and not unit.in_casing(bearing):
            yield (
                f"bearing {bearing.id} {bearing.name}: sits between the shaft of the {seats[joined[0]]} and another "
                "turning part; a case holds shafts in the housing only"
            )
    for mesh in unit.meshes:
        if mesh in stage.meshes:
            continue
        ends = {unit.gear(gear).shaft for gear in (mesh.pinion, mesh.wheel)}
        at = [name for shaft, name in seats.items() if shaft in ends]
        loads = f"; its forces on the shaft of the {' and the '.join(at)} are missing" if at else ""
        yield f"cylindrical_stage {mesh.id} {mesh.name}: a gearbox of a case takes one stage{loads}"


def _listed(unit: GearUnit) -> str:
    lines = []
    for number, meshes in enumerate(gear_stages(unit), 1):
        mesh = meshes[0]
        pair = [unit.gear(gear) for gear in (mesh.pinion, mesh.wheel)]
        teeth = "/".join("?" if gear.teeth is None else str(gear.teeth) for gear in pair)
        module, distance = pair[0].normal_module, mesh.centre_distance
        sizes = "" if module is None else f", module {1e3 * module:.4g} mm"
        sizes += "" if distance is None else f", centre distance {1e3 * distance:.5g} mm"
        ids = " and ".join(str(item.id) for item in meshes)
        lines.append(
            f"  {number}: {teeth} teeth{sizes} (cylindrical_stage {ids}{mesh.name and f', {mesh.name}'})"
        )
    return "\n".join(lines)


def _seated(unit: GearUnit, name: str, meshes: tuple[UnitMesh, ...], first: UnitGear) -> SeatedGear:
    halves = [unit.gear(mesh.pinion if name == "pinion" else mesh.wheel) for mesh in meshes]
    gear, places = halves[0], [half.position for half in halves]
    shaft, pinion_shaft = (_shaft(unit, item) for item in (gear, first))
    direction = 1.0
    if shaft is not None and pinion_shaft is not None and shaft.axis and pinion_shaft.axis:
        along = sum(a * b for a, b in zip(shaft.axis, pinion_shaft.axis, strict=True))
        direction = copysign(1.0, along)
    if shaft is not None and direction < 0.0:
        shaft = turned(shaft)
    seated = SeatedGear(name, gear, shaft, direction=direction)
    known = [place for place in places if place is not None]
    middle = sum(known) / len(known) if len(known) == len(halves) else None
    seated = replace(seated, gear=replace(gear, position=seated.from_front(middle)))
    if gear.shaft is None:
        return seated
    own = [item for item in unit.bearings if gear.shaft in (item.place.inner, item.place.outer)]
    own = sorted(
        (item for item in own if unit.in_casing(item)), key=lambda item: seated.bearing_at(item) or 0.0
    )
    ends = (own[0], own[-1]) if len(own) > 2 else tuple(own)
    return replace(seated, bearings=ends, more=tuple(own[1:-1]) if len(own) > 2 else ())


def turned(shaft: UnitShaft) -> UnitShaft:
    """A shaft counted from its other end."""
    sections = (
        replace(
            item,
            start=shaft.length - item.start - item.length,
            outer_begin=item.outer_end,
            outer_end=item.outer_begin,
            inner_begin=item.inner_end,
            inner_end=item.inner_begin,
        )
        for item in reversed(shaft.sections)
    )
    return replace(shaft, sections=tuple(sections))


def _shaft(unit: GearUnit, gear: UnitGear) -> UnitShaft | None:
    return next((shaft for shaft in unit.shafts if shaft.id == gear.shaft), None)


def diameter_at(shaft: UnitShaft, place: float) -> float | None:
    """Outside diameter at a place, at a step the smaller one."""
    here = [
        mean_diameter(item)
        for item in shaft.sections
        if item.start - SAME <= place <= item.start + item.length + SAME
    ]
    return min(here, default=None)


def mean_diameter(section: ShaftSection) -> float:
    """Of a cone its mean diameter."""
    return 0.5 * (section.outer_begin + section.outer_end)
