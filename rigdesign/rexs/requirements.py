"""What a case needs and a gear unit does not have: to be asked for, or assumed and marked."""

from collections.abc import Iterator
from dataclasses import dataclass

from rigdesign.rexs.gear_unit import GearUnit, UnitBearing, UnitGear, UnitMesh, UnitShaft
from rigdesign.rexs.model import RexsModel

_OTHER_STAGES = {
    "bevel_stage": "bevel stage", "worm_stage": "worm stage", "planetary_stage": "planetary stage",
    "ring_gear": "ring gear",
}  # fmt: skip


@dataclass(frozen=True)
class MissingInput:
    """An input of a case that the file does not state.

    place : in the gear unit, e.g. ``gears[6].quality_grade``
    needed : True where nothing can be assumed for it
    remedy : what to state, or what an assumption may be taken from
    """

    place: str
    needed: bool
    remedy: str


def missing_inputs(model: RexsModel, unit: GearUnit) -> tuple[MissingInput, ...]:
    """Inputs that a case needs beyond what the gear unit has, needed ones first."""
    found = [
        *_unsupported(model),
        *_toothing(unit),
        *_shafts(unit),
        *_oil(unit),
        *_operation(unit),
        *_rig(unit),
    ]
    return tuple(sorted(found, key=lambda item: not item.needed))


def _unsupported(model: RexsModel) -> Iterator[MissingInput]:
    for kind, words in _OTHER_STAGES.items():
        for component in model.of_type(kind):
            yield MissingInput(
                f"{kind} {component.id}", True, f"a case has no {words}; leave it out or replace it"
            )


def _toothing(unit: GearUnit) -> Iterator[MissingInput]:
    if not unit.meshes:
        yield MissingInput("meshes", True, "state a cylindrical stage of two gears with outer teeth")
    meshing = {number for mesh in unit.meshes for number in (mesh.pinion, mesh.wheel)}
    for gear in unit.gears:
        if gear.id in meshing:
            yield from _gear(gear)
    for mesh in unit.meshes:
        yield from _mesh(unit, mesh)


def _gear(gear: UnitGear) -> Iterator[MissingInput]:
    asked = (
        ("shaft", gear.shaft, True, "assemble the gear on a shaft"),
        ("teeth", gear.teeth, True, "state number_of_teeth"),
        ("normal_module", gear.normal_module, True, "state normal_module"),
        ("face_width", gear.face_width, True, "state face_width"),
        ("position", gear.position, False, "middle between the bearings of its shaft"),
        ("pressure_angle", gear.pressure_angle, False, "20 deg (ISO 53)"),
        ("helix_angle", gear.helix_angle, False, "zero, spur gear"),
        ("tip_diameter", gear.tip_diameter, False, "from module, profile shift and basic rack"),
        ("quality_grade", gear.quality_grade, False, "tolerance class 5 or 6 of ISO 1328-1 for ground gears"),
        ("flank_roughness", gear.flank_roughness, False, "0.2 to 0.8 um for ground flanks"),
        ("material", gear.material, False, "that of its shaft, or case-hardened steel"),
    )
    for name, value, needed, remedy in asked:
        if value is None:
            yield MissingInput(f"gears[{gear.id}].{name}", needed, remedy)


def _mesh(unit: GearUnit, mesh: UnitMesh) -> Iterator[MissingInput]:
    shifts = [unit.gear(number).profile_shift for number in (mesh.pinion, mesh.wheel)]
    both = None not in shifts
    if mesh.centre_distance is None:
        yield MissingInput(
            f"meshes[{mesh.id}].centre_distance", not both, "from teeth, module and profile shifts"
        )
    if shifts == [None, None]:
        yield MissingInput(f"meshes[{mesh.id}].profile_shift_split", False, "equal shares of the sum for a")


def _shafts(unit: GearUnit) -> Iterator[MissingInput]:
    bearings: dict[int | None, list[UnitBearing]] = {}
    for bearing in unit.bearings:
        for part in {bearing.place.inner, bearing.place.outer}:
            bearings.setdefault(part, []).append(bearing)
    geared = {gear.shaft for gear in unit.gears}
    for shaft in unit.shafts:
        yield from _shaft(shaft, bearings.get(shaft.id, []), shaft.id in geared)
    for bearing in unit.bearings:
        yield from _bearing(bearing)


def _shaft(shaft: UnitShaft, bearings: list[UnitBearing], geared: bool) -> Iterator[MissingInput]:
    if not shaft.sections:
        bore = any(item.inner_diameter for item in bearings)
        yield MissingInput(f"shafts[{shaft.id}].sections", not bore, "diameter of the bearing bores")
    for section in shaft.sections:
        if not section.start_stated:
            yield MissingInput(
                f"shafts[{shaft.id}].sections[{section.id}].start", False, "zero, as the only one"
            )
    if len(bearings) < 2:
        remedy = "state two bearings of the shaft" if geared else "carried by what it is coupled to"
        yield MissingInput(f"shafts[{shaft.id}].bearings", geared, remedy)


def _bearing(bearing: UnitBearing) -> Iterator[MissingInput]:
    here, data = f"bearings[{bearing.id}]", bearing.catalogue
    ring = (bearing.inner_diameter, bearing.outer_diameter, bearing.width)
    if bearing.kind == "stiffness":
        yield MissingInput(
            f"{here}.catalogue.designation", True, "a support of given stiffness: name the bearing"
        )
    elif bearing.kind == "journal":
        if ring[0] is None or ring[2] is None:
            yield MissingInput(f"{here}.width", True, "state inner_diameter and width of the bearing")
    elif data.designation is None and (None in ring or data.dynamic_load_rating is None):
        remedy = "state the designation, or bore, outer diameter, width and load ratings"
        yield MissingInput(f"{here}.catalogue.designation", True, remedy)
    if bearing.place.inner_position is None:
        yield MissingInput(f"{here}.place.inner_position", False, "at the end of the shaft")
    if bearing.radial_clearance is None and bearing.clearance_class is None and bearing.kind != "stiffness":
        normal = "normal clearance (CN)" if bearing.kind == "rolling" else "1.5 per mille of the diameter"
        yield MissingInput(f"{here}.radial_clearance", False, normal)


def _oil(unit: GearUnit) -> Iterator[MissingInput]:
    oil = unit.lubricant
    if oil is None:
        yield MissingInput("lubricant", True, "state the oil with its viscosities at 40 and 100 degC")
        return
    for name, value in (("viscosity_40", oil.viscosity_40), ("viscosity_100", oil.viscosity_100)):
        if value is None:
            yield MissingInput(f"lubricant.{name}", True, "state the kinematic viscosity")
    if oil.density_15 is None:
        yield MissingInput("lubricant.density_15", False, "870 kg/m3, mineral oil")


def _operation(unit: GearUnit) -> Iterator[MissingInput]:
    if not unit.operating_cases:
        yield MissingInput("operating_cases", True, "state speed and torque")
    for case in unit.operating_cases:
        here = "operating_cases" if case.id is None else f"operating_cases[{case.id}]"
        if not any(case.speeds.values()):
            yield MissingInput(f"{here}.speeds", True, "state rotational_speed of a shaft")
        if not any(load.torque or load.power for load in case.loads):
            yield MissingInput(f"{here}.torque", True, "state the torque or power of a load")
        if case.lubricant_temperature is None:
            yield MissingInput(
                f"{here}.lubricant_temperature", False, "60 to 90 degC; state temperature_lubricant"
            )


def _rig(unit: GearUnit) -> Iterator[MissingInput]:
    """What REXS has no place for."""
    if not unit.couplings:
        yield MissingInput(
            "couplings", False, "torsional stiffness and damping between the gearboxes of the rig"
        )
    lubricated = any(bearing.lubrication for bearing in unit.bearings)
    if not lubricated:
        yield MissingInput("lubrication", False, "jet with flow, or dip with immersion depth")
    yield MissingInput("housing", False, "inner length, width and height, wall thickness, material")
    yield MissingInput("surroundings", False, "room temperature and air speed")
