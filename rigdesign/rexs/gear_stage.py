"""The stage of a gear unit that becomes a gearbox: two gears, their shafts and bearings; what is left out of the case.

Two stages of opposite hand between the same two shafts are one double-helical stage.
"""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import copysign
from typing import Literal

from rigdesign.base.errors import UsageError
from rigdesign.rexs.attribute_log import MappedAttribute
from rigdesign.rexs.gear_unit import GearUnit, ShaftSection, UnitBearing, UnitGear, UnitMesh, UnitShaft
from rigdesign.rexs.model import printable

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


# Keys of an imported case: taken from the file, assumed, or needed from the user; and their form in TOML.

WIDEST_TEXT = 400
"""Characters of a text taken over from a file."""
MOST_PLACES = 6
"""Attributes that one source names; of more it names the first."""


@dataclass(frozen=True)
class Entry:
    """A key of a table.

    value : as TOML; of a needed key an example
    kind : stated: of the file; assumed: in place of what it lacks; needed: to be given by the user
    text : source, reason, or what to give
    targets : places of the gear unit that it is taken from
    range : lowest and highest plausible value of an assumption, as TOML
    markable : False for keys that select a kind of table, whose text becomes a comment
    """

    key: str
    value: str
    kind: Literal["stated", "assumed", "needed"]
    text: str
    targets: tuple[str, ...] = ()
    range: tuple[str, str] | None = None
    markable: bool = True


@dataclass(frozen=True)
class CaseTable:
    """A table of the case.

    path : empty for the keys at its head
    remarks : comments above it
    """

    path: str
    entries: tuple[Entry, ...]
    remarks: tuple[str, ...] = ()

    def place(self, entry: Entry) -> str:
        """Path of a key."""
        return f"{self.path}.{entry.key}" if self.path else entry.key


class Origins:
    """Where each value of a gear unit stands in its file.

    Parameters
    ----------
    file : name of the file, for sources
    mapped : attributes taken over from it
    """

    def __init__(self, file: str, mapped: Sequence[MappedAttribute]) -> None:
        self.file = file
        self._first: dict[str, MappedAttribute] = {}
        for item in mapped:
            self._first.setdefault(item.target, item)

    def knows(self, target: str) -> bool:
        """Whether the file states what stands at a place of the gear unit."""
        return target in self._first

    def attribute(self, target: str) -> str:
        """Name of the attribute, empty where the file does not state it."""
        return self._first[target].attribute if target in self._first else ""

    def under(self, target: str) -> tuple[str, ...]:
        """Places of the gear unit that begin with ``target``."""
        return tuple(known for known in self._first if known.startswith(target))

    def stated(self, key: str, value: str, *targets: str, note: str = "") -> Entry:
        """A key with its source: component and attribute of the first target, then those of the others."""
        found = [self._first[target] for target in targets if target in self._first]
        if note and len(found) > MOST_PLACES:
            found = found[:1]
        places = "; ".join(dict.fromkeys(map(_place, found))) or "structure of the model"
        text = f"{self.file}: {places}" + (f" ({note})" if note else "")
        return Entry(key, value, "stated", text, targets)


def assumed(key: str, value: str, reason: str, *ends: str) -> Entry:
    """An assumed value, with the two ends of its range where it has one."""
    limits = (ends[0], ends[1]) if len(ends) == 2 else None
    return Entry(key, value, "assumed", reason, range=limits)


def needed(key: str, example: str, remedy: str) -> Entry:
    """A key that the user has to give."""
    return Entry(key, example, "needed", remedy)


def _place(item: MappedAttribute) -> str:
    where = f"{item.type} {item.component}, {item.attribute}"
    return where if item.load_case is None else f"{where}, load case {item.load_case}"


def quoted(text: str) -> str:
    """A TOML string."""
    return json.dumps(printable(" ".join(text.split()))[:WIDEST_TEXT], ensure_ascii=False)


def quantity(value: float, unit: str) -> str:
    """A number in its unit as a TOML string, without the last digits of the conversion from SI."""
    return f'"{value:.9g} {unit}"'


def millimetres(length: float) -> str:
    """A length [m]."""
    return quantity(1e3 * length, "mm")


def toml_text(tables: Sequence[CaseTable], *, with_examples: bool = False) -> str:
    """The tables as a file; needed keys are comments, or with examples, keys like any other."""
    return "\n".join(line for table in tables for line in _table(table, with_examples)) + "\n"


def _table(table: CaseTable, with_examples: bool) -> Iterator[str]:
    for remark in table.remarks:
        yield f"# {printable(' '.join(remark.split()))}"
    if table.path:
        yield f"[{table.path}]"
    for entry in table.entries:
        yield from _entry(entry, with_examples)
    yield ""


def _entry(entry: Entry, with_examples: bool) -> Iterator[str]:
    if entry.kind == "needed":
        yield f"# NEEDED, {printable(entry.text)}:"
        yield f"{'' if with_examples else '# '}{entry.key} = {entry.value}"
    elif not entry.markable:
        said = "assumed: " if entry.kind == "assumed" else ""
        yield f"# {said}{printable(' '.join(entry.text.split()))[:WIDEST_TEXT]}"
        yield f"{entry.key} = {entry.value}"
    else:
        mark = "source" if entry.kind == "stated" else "assumed"
        limits = "" if entry.range is None else f", range = [{entry.range[0]}, {entry.range[1]}]"
        yield f"{entry.key} = {{ value = {entry.value}, {mark} = {quoted(entry.text)}{limits} }}"
