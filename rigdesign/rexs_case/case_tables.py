"""All tables of an imported case in their order."""

import re
from collections.abc import Iterator
from math import ceil

from rigdesign.rexs.gear_unit import GearUnit, UnitMaterial
from rigdesign.rexs.gear_unit_import import GearUnitImport
from rigdesign.rexs_case.bearing_keys import bearing_tables
from rigdesign.rexs_case.entries import CaseTable, Entry, Origins, millimetres, quoted
from rigdesign.rexs_case.gear_keys import gear_entries, material_entry, mesh_entries, toothing_of
from rigdesign.rexs_case.operation_keys import oil_tables, operation_of, schedule_tables
from rigdesign.rexs_case.pinion_load import pinion_loads
from rigdesign.rexs_case.shaft_keys import shaft_tables
from rigdesign.rexs_case.stage import GearStage, SeatedGear, left_out

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
