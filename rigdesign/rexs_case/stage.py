"""The stage of a gear unit that becomes a gearbox: two gears, their shafts, and the bearings of these."""

from dataclasses import dataclass
from math import copysign

from rigdesign.base.errors import UsageError
from rigdesign.rexs.gear_unit import GearUnit, ShaftSection, UnitBearing, UnitGear, UnitMesh, UnitShaft

SIDES = ("front", "rear")
SAME = 1e-6
"""Difference of two measures that is round-off [m]."""


@dataclass(frozen=True)
class SeatedGear:
    """A gear of the stage with its shaft.

    bearings : of the shaft, from the front, at most two: the outermost ones
    direction : 1 where the shaft counts from the front to the rear, else -1
    """

    name: str
    gear: UnitGear
    shaft: UnitShaft | None
    bearings: tuple[UnitBearing, ...]
    direction: float = 1.0

    def bearing_at(self, bearing: UnitBearing) -> float | None:
        """Place of a bearing on the shaft [m]."""
        place, shaft = bearing.place, self.gear.shaft
        return place.inner_position if place.inner == shaft else place.outer_position


@dataclass(frozen=True)
class GearStage:
    """A pair of gears.

    number : among the stages of the file, from 1
    """

    number: int
    mesh: UnitMesh
    pinion: SeatedGear
    wheel: SeatedGear

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
    if number is None and len(unit.meshes) > 1:
        raise UsageError(
            f"{source}: no case was written: {len(unit.meshes)} stages, a gearbox of a case takes one; choose with "
            f"--stage:\n{_listed(unit)}"
        )
    number = 1 if number is None else number
    if not 1 <= number <= len(unit.meshes):
        raise UsageError(
            f"{source}: no case was written: --stage {number}: no such stage; choose one of these:\n{_listed(unit)}"
        )
    mesh = unit.meshes[number - 1]
    first = unit.gear(mesh.pinion)
    return GearStage(
        number,
        mesh,
        _seated(unit, "pinion", first, first),
        _seated(unit, "wheel", unit.gear(mesh.wheel), first),
    )


def _listed(unit: GearUnit) -> str:
    lines = []
    for number, mesh in enumerate(unit.meshes, 1):
        pair = [unit.gear(gear) for gear in (mesh.pinion, mesh.wheel)]
        teeth = "/".join("?" if gear.teeth is None else str(gear.teeth) for gear in pair)
        module, distance = pair[0].normal_module, mesh.centre_distance
        sizes = "" if module is None else f", module {1e3 * module:.4g} mm"
        sizes += "" if distance is None else f", centre distance {1e3 * distance:.5g} mm"
        lines.append(
            f"  {number}: {teeth} teeth{sizes} (cylindrical_stage {mesh.id}{mesh.name and f', {mesh.name}'})"
        )
    return "\n".join(lines)


def _seated(unit: GearUnit, name: str, gear: UnitGear, first: UnitGear) -> SeatedGear:
    shaft, pinion_shaft = (_shaft(unit, item) for item in (gear, first))
    direction = 1.0
    if shaft is not None and pinion_shaft is not None and shaft.axis and pinion_shaft.axis:
        along = sum(a * b for a, b in zip(shaft.axis, pinion_shaft.axis, strict=True))
        direction = copysign(1.0, along)
    seated = SeatedGear(name, gear, shaft, (), direction)
    if gear.shaft is None:
        return seated
    own = [item for item in unit.bearings if gear.shaft in (item.place.inner, item.place.outer)]
    places = {item.id: seated.bearing_at(item) for item in own}
    own.sort(key=lambda item: direction * (places[item.id] or 0.0))
    ends = (own[0], own[-1]) if len(own) > 2 else tuple(own)
    return SeatedGear(name, gear, shaft, ends, direction)


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
