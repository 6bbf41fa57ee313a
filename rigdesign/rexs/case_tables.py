"""All tables of an imported case in their order."""

import math
import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from math import ceil

from rigdesign.base.units import ZERO_CELSIUS
from rigdesign.rexs.bearing_keys import bearing_tables, tabled_bearing
from rigdesign.rexs.gear_keys import gear_entries, material_entry, mesh_entries, toothing_of
from rigdesign.rexs.gear_stage import (
    SAME,
    CaseTable,
    Entry,
    GearStage,
    Origins,
    SeatedGear,
    assumed,
    diameter_at,
    left_out,
    mean_diameter,
    millimetres,
    needed,
    quantity,
    quoted,
)
from rigdesign.rexs.gear_unit import (
    GearUnit,
    OperatingCase,
    ShaftLoad,
    ShaftSection,
    UnitBearing,
    UnitLubricant,
    UnitMaterial,
    UnitMesh,
    UnitShaft,
)
from rigdesign.rexs.gear_unit_import import GearUnitImport

# Speed and torque at the pinion of a stage from those that a gear unit states anywhere, without losses.


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


LIKE_THE_TEST = (
    "the slave gearbox equals the test gearbox, without a housing; a REXS file holds one unit, no rig"
)
OFF_THE_TIPS = 0.02
"""Room between tips and walls in the housing that is suggested [m]."""


def case_tables(imported: GearUnitImport, stage: GearStage, file: str) -> tuple[CaseTable, ...]:
    """The case of a stage.

    Parameters
    ----------
    imported : gear unit with the account of its attributes
    stage : one stage of it
    file : name of the file, for sources
    """
    return tuple(_tables(imported, stage, Origins(file, imported.mapped)))


def _tables(imported: GearUnitImport, stage: GearStage, origins: Origins) -> Iterator[CaseTable]:
    unit = imported.unit
    named = unit.name or origins.file.rpartition(".")[0]
    head = Entry(
        "name", quoted(_name(named)), "stated", f"{origins.file}: name of the gear unit", markable=False
    )
    version = Entry("schema_version", "1", "stated", "form of this file", markable=False)
    missing = tuple(f"not in this case: {text}" for text in left_out(unit, stage))
    yield CaseTable("", (version, head), missing)
    toothing = toothing_of(stage)
    for seated in stage.gears:
        entries = list(gear_entries(origins, stage, seated))
        material = material_entry(origins, _material(unit, seated.gear.material))
        entries += [material] if material is not None else []
        if seated.position is not None:
            notes = ["middle of both halves"] if stage.double_helical else []
            notes += ["from the other end of the shaft"] if seated.direction < 0.0 else []
            target, place = f"gears[{seated.gear.id}].position", millimetres(seated.position)
            entries.append(origins.stated("position", place, target, note=", ".join(notes)))
        remark: tuple[str, ...] = (f"gear {seated.gear.id} {seated.gear.name}",)
        if seated is stage.wheel and toothing.contradiction:
            remark += ("its profile shift in the file contradicts the centre distance, which counts",)
        yield CaseTable(f"gearboxes.test.gears.{seated.name}", tuple(entries), remark)
    halves = tuple(f"cylindrical_stage {mesh.id} {mesh.name}" for mesh in stage.meshes)
    yield CaseTable("gearboxes.test.meshes.main", tuple(mesh_entries(origins, stage)), halves)
    yield from bearing_tables(origins, stage)
    yield from shaft_tables(origins, stage)
    operation = operation_of(stage, () if imported.epicyclic else pinion_loads(unit, stage.meshes))
    yield from oil_tables(origins, unit, stage, operation)
    like = Entry("like", '"test"', "assumed", LIKE_THE_TEST, markable=False)
    yield CaseTable("gearboxes.slave", (like,), tuple(_housing_remarks(stage)))
    yield from schedule_tables(origins, unit, operation)


def _housing_remarks(stage: GearStage) -> Iterator[str]:
    """A housing to write, without which there is no temperature field."""
    tips = [_tip(seated) for seated in stage.gears]
    distance = toothing_of(stage).centre_distance
    sizes = [tip for tip in tips if tip is not None]
    room = max((_room(seated) or 0.0 for seated in stage.gears), default=0.0)
    length = room or max(seated.gear.face_width or 0.0 for seated in stage.gears) + 0.06
    width, height = 0.2, 0.2
    if distance is not None and len(sizes) == 2:
        width = distance + 0.5 * sum(sizes) + 2.0 * OFF_THE_TIPS + 0.02
        height = max(sizes) + 2.0 * OFF_THE_TIPS + 0.02
    yield "No housing in a REXS file, so that there is no temperature field. Write one, e.g. round these gears:"
    yield "[gearboxes.test.housing]"
    for key, size in (("warm_length", length), ("width", width), ("height", height)):
        yield f'{key} = "{ceil(1e3 * size - 1e-6)} mm"'
    yield 'and then, in the table below: remove = ["housing"]'


def _tip(seated: SeatedGear) -> float | None:
    gear = seated.gear
    if gear.tip_diameter is not None or gear.teeth is None or gear.normal_module is None:
        return gear.tip_diameter
    return gear.normal_module * (gear.teeth + 2.0)


def _room(seated: SeatedGear) -> float | None:
    """Between the inner faces of the two bearings of a shaft [m]."""
    if seated.position is None:
        return None
    front, rear = (seated.bearing_at(bearing) or 0.0 for bearing in seated.bearings)
    return rear - front - 0.5 * sum(bearing.width or 0.0 for bearing in seated.bearings)


def _material(unit: GearUnit, number: int | None) -> UnitMaterial | None:
    return next((material for material in unit.materials if material.id == number), None)


def _name(text: str) -> str:
    """A name for the case: lower-case letters, digits, underscores."""
    name = re.sub(r"[^a-z0-9]+", "_", text.lower()).strip("_")[:60].rstrip("_")
    return name if re.match(r"[a-z]", name) else f"rig_{name}"[:60].rstrip("_")


# Sections of the shafts: those of the file where they fit the bearings, else a step where the bores differ.

STUB = 2.5
"""Length from the rear bearing to the coupling, in diameters of the shaft, as by the defaults of a drivetrain."""


def shaft_tables(origins: Origins, stage: GearStage) -> Iterator[CaseTable]:
    """Both shafts of the stage in both gearboxes; none of them where the default, one diameter, will do."""
    for seated in stage.gears:
        entry = _sections(origins, seated)
        if entry is not None:
            yield CaseTable(f"drivetrain.shafts.test_{seated.name}", (entry,))
            reason = f"as test_{seated.name}, which has its gear and bearings at the same places"
            yield CaseTable(
                f"drivetrain.shafts.slave_{seated.name}", (assumed("sections", entry.value, reason),)
            )


def _sections(origins: Origins, seated: SeatedGear) -> Entry | None:
    position, shaft = seated.position, seated.shaft
    if position is None or shaft is None:
        return None
    front, rear = (seated.bearing_at(bearing) or 0.0 for bearing in seated.bearings)
    bores = [_bore(bearing) for bearing in seated.bearings]
    if bores[0] is None or bores[1] is None:
        return None
    if _connected(shaft) and all(
        abs((diameter_at(shaft, place) or 0.0) - bore) <= SAME
        for place, bore in ((front, bores[0]), (rear, bores[1]))
    ):
        first = f"shafts[{shaft.id}].sections[{shaft.sections[0].id}]"
        value = _written([(item.length, mean_diameter(item), _inner(item)) for item in shaft.sections])
        targets = [
            item for item in origins.under(f"shafts[{shaft.id}].sections") if not item.startswith(first)
        ]
        note = f"and {len(shaft.sections) - 1} further sections" if shaft.sections[1:] else ""
        return origins.stated("sections", value, *origins.under(first), *targets, note=note)
    between = front < position < rear
    if abs(bores[0] - bores[1]) <= SAME and between and not shaft.sections:
        return None
    step, place = (position, "at the gear") if between else (0.5 * (front + rear), "between them")
    end = max(rear + STUB * bores[1], shaft.length, position + 0.5 * (seated.gear.face_width or 0.0))
    value = _written([(step, bores[0], 0.0), (end - step, bores[1], 0.0)])
    cause = "the file has none"
    if shaft.sections:
        cause = "those of the file leave gaps or have other diameters in the bearings"
    return assumed("sections", value, f"as thick as in its bearings, stepped {place}: {cause}")


def _bore(bearing: UnitBearing) -> float | None:
    tabled = tabled_bearing(bearing) if bearing.kind == "rolling" else None
    return bearing.inner_diameter if tabled is None else tabled.bore


def _connected(shaft: UnitShaft) -> bool:
    """Whether the sections follow each other from the start of the shaft without a gap."""
    end = 0.0
    for section in shaft.sections:
        if (
            abs(section.start - end) > SAME
            or section.length <= 0.0
            or _inner(section) >= mean_diameter(section)
        ):
            return False
        end += section.length
    return bool(shaft.sections)


def _inner(section: ShaftSection) -> float:
    return 0.5 * (section.inner_begin + section.inner_end)


def _written(sections: list[tuple[float, float, float]]) -> str:
    """Sections as TOML: length, outside and inside diameter [m]."""
    written = []
    for length, outer, inner in sections:
        bore = f", inner_diameter = {millimetres(inner)}" if inner > 0.0 else ""
        written.append(f"{{ length = {millimetres(length)}, outer_diameter = {millimetres(outer)}{bore} }}")
    return f"[{', '.join(written)}]"


# Keys of oil and schedule: lubricant and its temperature, the load case with the most torque at the pinion.

FASTEST_DIP = 15.0
"""Pitch line velocity up to which gears dip, beyond which oil is injected [m/s]."""
ALIKE = 0.02
"""Difference of viscosities up to which an oil of a built-in name is that oil."""
FEWEST, MOST = 1e-6, 1e-1
"""Kinematic viscosities that an oil may have [m^2/s]."""
RPM = math.pi / 30.0


@dataclass(frozen=True)
class Operation:
    """Operating cases at the pinion, and the pitch line velocity of the first [m/s]; None where it is not known."""

    loads: tuple[PinionLoad, ...]
    velocity: float | None

    @property
    def first(self) -> PinionLoad | None:
        """The case that becomes the test."""
        return self.loads[0] if self.loads else None


def operation_of(stage: GearStage, loads: tuple[PinionLoad, ...]) -> Operation:
    """Operation of a stage."""
    gear, speed = stage.pinion.gear, loads[0].speed if loads else None
    if gear.normal_module is None or gear.teeth is None or not speed:
        return Operation(loads, None)
    radius = 0.5 * gear.normal_module * gear.teeth / math.cos(gear.helix_angle or 0.0)
    return Operation(loads, radius * speed)


# ------------------------------------------------------------------ oil


def oil_tables(
    origins: Origins, unit: GearUnit, stage: GearStage, operation: Operation
) -> Iterator[CaseTable]:
    """Oil of the test gearbox, and the oil itself where it is no built-in one."""
    journals = any(bearing.kind == "journal" for seated in stage.gears for bearing in seated.bearings)
    velocity = operation.velocity
    dips = not journals and (velocity is None or velocity <= FASTEST_DIP)
    name, custom = _oil(origins, unit.lubricant)
    temperature = _oil_temperature(origins, operation, "sump_temperature" if dips else "inlet_temperature")
    if dips:
        known = "" if velocity is None else f"; here {velocity:.3g} m/s"
        reason = f"gears dip up to a pitch line velocity of {FASTEST_DIP:g} m/s{known}"
        kind = Entry("lubrication", '"dip"', "assumed", f"{reason}; or jet", markable=False)
        level = assumed("level", '"0 mm"', "oil up to the shaft axes, as in an FZG rig")
        yield CaseTable("gearboxes.test.oil", (kind, name, level, temperature))
    else:
        why = "plain bearings need fed oil" if journals else f"above {FASTEST_DIP:g} m/s at the pitch line"
        kind = Entry("lubrication", '"jet"', "assumed", f"oil is injected, {why}", markable=False)
        yield CaseTable("gearboxes.test.oil", (kind, name, temperature))
    if custom is not None:
        yield custom


def _oil(origins: Origins, oil: UnitLubricant | None) -> tuple[Entry, CaseTable | None]:
    """The key of the oil, and its table where it is no built-in one."""
    example, remedy = '"FVA 3A"', "built-in oil, or a table of its own under oils with two viscosities"
    if oil is None:
        return needed("oil", example, remedy), None
    cold, warm = oil.viscosity_40, oil.viscosity_100
    if built_in := _built_in(oil):
        return origins.stated("oil", quoted(built_in), "lubricant.designation"), None
    if cold is None or warm is None or not FEWEST < warm < cold < MOST:
        shown = oil.designation or oil.name or "the lubricant"
        return needed("oil", example, f"viscosities of {shown} are missing: {remedy}"), None
    entries = [
        origins.stated("title", quoted(oil.designation or oil.name or "oil"), "lubricant.designation"),
        origins.stated("kinematic_viscosity_40", quantity(1e6 * cold, "mm2/s"), "lubricant.viscosity_40"),
        origins.stated("kinematic_viscosity_100", quantity(1e6 * warm, "mm2/s"), "lubricant.viscosity_100"),
    ]
    for key, value, unit, field, usual, low, high, why in (
        ("density_15", oil.density_15, "kg/m3", "density_15", 870, 850, 1000, "mineral oil"),
        ("heat_capacity", oil.heat_capacity, "J/(kg K)", "heat_capacity", 2000, 1850, 2150, "mineral oil, warm"),
        ("conductivity", oil.conductivity, "W/(m K)", "conductivity", 0.132, 0.12, 0.15, "mineral oil at 40 degC"),
    ):  # fmt: skip
        if value is not None:
            entries.append(origins.stated(key, quantity(value, unit), f"lubricant.{field}"))
        else:
            entries.append(assumed(key, f'"{usual} {unit}"', why, f'"{low} {unit}"', f'"{high} {unit}"'))
    return origins.stated("oil", '"imported"', "lubricant.designation"), CaseTable(
        "oils.imported", tuple(entries)
    )


def _built_in(oil: UnitLubricant) -> str:
    """Name of the built-in oil with this designation and the viscosities that the file states, else empty."""
    from rigdesign.properties.oil import OILS

    found = OILS.get((oil.designation or oil.name).strip())
    if found is None:
        return ""
    for stated, temperature in ((oil.viscosity_40, 313.15), (oil.viscosity_100, 373.15)):
        if stated is not None and abs(stated / found.kinematic_viscosity(temperature) - 1.0) > ALIKE:
            return ""
    return found.name


def _oil_temperature(origins: Origins, operation: Operation, key: str) -> Entry:
    case = operation.first.case if operation.first is not None else None
    if case is None or case.lubricant_temperature is None:
        return assumed(key, '"80 degC"', "usual oil of gearboxes in operation", '"60 degC"', '"90 degC"')
    value = quantity(case.lubricant_temperature - ZERO_CELSIUS, "degC")
    return origins.stated(key, value, *_targets(case.id, "lubricant_temperature"))


def _targets(case: str | None, place: str) -> tuple[str, ...]:
    """Places of a value of an operating case: in the case itself, then in the components."""
    own = () if case is None else (f"operating_cases[{case}].{place}",)
    return (*own, f"operating_cases.{place}")


# ------------------------------------------------------------------ schedule


def schedule_tables(origins: Origins, unit: GearUnit, operation: Operation) -> Iterator[CaseTable]:
    """The load case with the most torque as the test; the others in comments."""
    load = operation.first
    speed, torque = (load.speed, load.torque) if load is not None else (None, None)
    entries = []
    if load is not None and speed and load.speed_of is not None:
        place = _first(origins, _targets(load.case.id, f"speeds[{load.speed_of}]"))
        entries.append(
            origins.stated("test_speed", quantity(speed / RPM, "rpm"), *place, note="at the pinion")
        )
    else:
        entries.append(needed("test_speed", '"1500 rpm"', "speed of the pinion"))
    if load is not None and torque:
        places = [
            target
            for number in load.loads
            for target in _first(
                origins,
                (
                    *_targets(load.case.id, f"loads[{number}].torque"),
                    *_targets(load.case.id, f"loads[{number}].power"),
                ),
            )
        ]
        entries.append(
            origins.stated(
                "test_torque", quantity(torque, "N m"), *places, note="at the pinion, without losses"
            )
        )
    else:
        why = f"; {load.undetermined}" if load is not None and load.undetermined else ""
        entries.append(needed("test_torque", '"300 N m"', f"torque of the pinion{why}"))
    remarks = ["the test, counted at the pinion"]
    if len(operation.loads) > 1:
        remarks[0] += ": the load case with the most torque; the others of the file:"
        remarks += [_remark(other) for other in operation.loads[1:]]
    yield CaseTable("schedule", tuple(entries), tuple(remarks))
    yield from _plan(origins, unit, load)


def _plan(origins: Origins, unit: GearUnit, load: PinionLoad | None) -> Iterator[CaseTable]:
    """Time of the test: that of its load case."""
    case = None if load is None else load.case
    if case is None:
        return
    time, targets = case.duration, _targets(case.id, "duration")
    if time is None and unit.operating_time is not None:
        time = unit.operating_time * (1.0 if case.time_share is None else case.time_share)
        targets = (*targets, *_targets(case.id, "time_share"))
    if time:
        yield CaseTable("test_plan", (origins.stated("time", quantity(time / 3600.0, "h"), *targets),))


def _first(origins: Origins, targets: tuple[str, ...]) -> tuple[str, ...]:
    """The first place that the file states."""
    return next(((target,) for target in targets if origins.knows(target)), targets[:1])


def _remark(load: PinionLoad) -> str:
    torque = "no torque" if load.torque is None else f"{load.torque:.5g} N m"
    speed = "no speed" if load.speed is None else f"{load.speed / RPM:.5g} rpm"
    share = "" if load.case.time_share is None else f", {100.0 * load.case.time_share:.3g} % of the time"
    warm = load.case.lubricant_temperature
    oil = "" if warm is None else f", oil {warm - ZERO_CELSIUS:.3g} degC"
    return f"  load case {load.case.id}: {torque}, {speed}{share}{oil}"
