"""A REXS model as a gear unit in SI, with an account of everything in the file."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

from rigdesign.rexs.attribute_log import AttributeLog, ListedAttribute, MappedAttribute
from rigdesign.rexs.external_parts import DATA_SOURCE, REFERENCED
from rigdesign.rexs.gear_unit import (
    BearingPlace,
    CatalogueData,
    GearUnit,
    OperatingCase,
    ShaftLoad,
    ShaftSection,
    UnitBearing,
    UnitCoupling,
    UnitLubricant,
    UnitMaterial,
    UnitShaft,
    first_stated,
    place_of,
    read_gears,
    read_meshes,
    shaft_of,
)
from rigdesign.rexs.model import ROLLING_BEARINGS, Component, Renaming, RexsModel, in_newest_names

# Bearings and couplings: what they join, where, and what the file says of them.

_KINDS: dict[str, Literal["rolling", "journal", "stiffness"]] = {
    **dict.fromkeys(ROLLING_BEARINGS, "rolling"),
    "hydrodynamic_radial_plain_bearing": "journal",
    "concept_bearing": "stiffness",
}
COUPLINGS = ("coupling", "switchable_coupling")
_CLEARANCES = ("radial_bearing_clearance", "radial_clearance", "operating_radial_bearing_clearance")
"""As delivered before that in operation, which a case computes."""
_JOURNAL_CLEARANCES = ("diameter_clearance_plain_bearing",)


def read_bearings(model: RexsModel, log: AttributeLog) -> tuple[UnitBearing, ...]:
    """Rolling bearings, hydrodynamic bearings and supports of given stiffness, in the order of the file."""
    return tuple(_bearing(model, log, component) for component in model.of_type(*_KINDS))


def read_couplings(model: RexsModel, log: AttributeLog) -> tuple[UnitCoupling, ...]:
    """Couplings, in the order of the file."""
    return tuple(_coupling(model, log, component) for component in model.of_type(*COUPLINGS))


def _bearing(model: RexsModel, log: AttributeLog, component: Component) -> UnitBearing:
    here = f"bearings[{component.id}]"
    kind = _KINDS[component.type]
    return UnitBearing(
        id=component.id,
        name=component.name,
        kind=kind,
        place=_place(model, log, component, here),
        catalogue=_catalogue(model, log, component, here) if kind == "rolling" else CatalogueData(),
        inner_diameter=log.number(component, "inner_diameter", "mm", f"{here}.inner_diameter", above=0.0),
        outer_diameter=log.number(component, "outer_diameter", "mm", f"{here}.outer_diameter", above=0.0),
        width=log.number(component, "width", "mm", f"{here}.width", above=0.0),
        radial_clearance=_clearance(log, component, here),
        clearance_class=log.text(component, "radial_clearance_class", f"{here}.clearance_class"),
        axial_force=log.text(component, "axial_force_absorption", f"{here}.axial_force"),
    )


def _catalogue(model: RexsModel, log: AttributeLog, component: Component, bearing: str) -> CatalogueData:
    here = f"{bearing}.catalogue"

    def positive(attribute: str, unit: str, field: str) -> float | None:
        return log.number(component, attribute, unit, f"{here}.{field}", above=0.0)

    rows = model.related("ordered_assembly", "assembly", component.id, "part")
    angles = [
        log.number(row, "pressure_angle", "deg", f"{here}.contact_angle")
        for row in rows
        if row.type == "rolling_bearing_row"
    ]
    return CatalogueData(
        designation=log.text(component, "catalogue_designation", f"{here}.designation"),
        type=log.text(component, "bearing_type", f"{here}.type"),
        contact_angle=next((angle for angle in angles if angle is not None), None),
        dynamic_load_rating=positive("radial_dynamic_load_rating", "kN", "dynamic_load_rating"),
        static_load_rating=positive("radial_static_load_rating", "kN", "static_load_rating"),
        fatigue_limit_load=positive("fatigue_limit_load", "kN", "fatigue_limit_load"),
        limiting_speed=positive("limiting_speed", "1 / min", "limiting_speed"),
        reference_speed=positive("reference_speed", "1 / min", "reference_speed"),
        limit_e=positive("catalogue_value_e", "none", "limit_e"),
        axial_factor=positive("axial_factor_y_2", "none", "axial_factor"),
        static_axial_factor=positive("axial_factor_y_0", "none", "static_axial_factor"),
        contamination_factor=positive("contamination_factor_iso_281_2007", "none", "contamination_factor"),
    )


def _coupling(model: RexsModel, log: AttributeLog, component: Component) -> UnitCoupling:
    place = _place(model, log, component, f"couplings[{component.id}]")
    return UnitCoupling(component.id, component.name, place)


def _place(model: RexsModel, log: AttributeLog, component: Component, here: str) -> BearingPlace:
    relations = model.relations_of("side", "assembly", component.id)
    inner, outer = (
        relations[0].with_role(role) if relations else None for role in ("inner_part", "outer_part")
    )
    positions = [
        log.number(component, f"u_coordinate_on_shaft_{side}_side", "mm", f"{here}.place.{side}_position")
        for side in ("inner", "outer")
    ]
    return BearingPlace(inner, outer, *positions)


def _clearance(log: AttributeLog, component: Component, here: str) -> float | None:
    journal = component.type == "hydrodynamic_radial_plain_bearing"
    names = _JOURNAL_CLEARANCES if journal else _CLEARANCES
    taken = None
    for name in names:
        found = log.number(component, name, "mum", f"{here}.radial_clearance")
        if taken is not None:
            log.refuse(component, name, "the clearance as delivered counts")
        taken = found if taken is None else taken
    return taken


_TAKEN = (
    "gear_unit", "gear_casing", "shaft", "shaft_section", "cylindrical_gear", "cylindrical_gear_flank",
    "cylindrical_stage", "cylindrical_stage_gear_data", *ROLLING_BEARINGS, "rolling_bearing_row", "concept_bearing",
    "hydrodynamic_radial_plain_bearing", *COUPLINGS, "lubricant", "material", "external_load",
)  # fmt: skip
"""Component types of which a case takes something."""
EPICYCLIC = ("planetary_stage", "ring_gear")
_OTHER_STAGES = ("bevel_stage", "worm_stage", *EPICYCLIC)
_IN_SPACE = ("support_vector", "u_axis_vector", "w_axis_vector", "reference_component_for_position")
"""Place and direction in the gear unit."""


LEFT_OVER = {
    **dict.fromkeys(COUPLINGS, "the couplings of a rig join two gearboxes: write drivetrain.couplings"),
    "material": "of built-in materials only; for another one write a table under materials",
}
"""Type of component -> why the case does not take what is left of it."""


@dataclass(frozen=True)
class GearUnitImport:
    """What became of a REXS file.

    unit : the gear unit, in SI
    mapped : attributes taken over, with their place in it
    listed : attributes not taken over, with the reason
    other_stages : epicyclic, bevel and worm stages and ring gears, which no case has: type and id
    renamed : names of older versions that were read as those of REXS 2.0
    """

    source: str
    version: str
    application: str
    unit: GearUnit
    mapped: tuple[MappedAttribute, ...]
    listed: tuple[ListedAttribute, ...]
    other_stages: tuple[str, ...]
    renamed: tuple[Renaming, ...]

    @property
    def epicyclic(self) -> bool:
        """Whether axes of gears may turn: speed and torque of a pair then do not follow from its teeth."""
        return any(found.startswith(EPICYCLIC) for found in self.other_stages)


def import_gear_unit(model: RexsModel) -> GearUnitImport:
    """Gear unit of a REXS model.

    Every attribute of every component is either mapped or listed. A value that cannot be used (a text where a number
    belongs, a unit of another quantity, a tip circle inside the teeth) is listed and then missing; it raises nothing.
    """
    newest, renamed = in_newest_names(model)
    log = AttributeLog()
    unit = _gear_unit(newest, log)
    for component in newest.components:
        for attribute in (DATA_SOURCE, REFERENCED):
            log.refuse(
                component,
                attribute,
                "the component stands in another file, which is not in the folder of the model",
            )
        if component.type in _TAKEN:
            for attribute in _IN_SPACE:
                log.refuse_rest(component, attribute, "the place along the shaft counts")
            log.list_rest(component, LEFT_OVER.get(component.type, "no counterpart in a case"))
        else:
            log.list_rest(component, f"a {component.type} has no counterpart in a case")
    return GearUnitImport(
        source=model.source,
        version=model.version,
        application=model.application,
        unit=unit,
        mapped=log.mapped,
        listed=log.listed,
        other_stages=tuple(f"{found.type} {found.id}" for found in newest.of_type(*_OTHER_STAGES)),
        renamed=renamed,
    )


def _gear_unit(model: RexsModel, log: AttributeLog) -> GearUnit:
    heads = model.of_type("gear_unit")
    gears = read_gears(model, log)
    cases, operating_time = read_operation(model, log)
    return GearUnit(
        name=heads[0].name if heads else "",
        gears=gears,
        meshes=read_meshes(model, log, gears),
        shafts=read_shafts(model, log),
        bearings=read_bearings(model, log),
        couplings=read_couplings(model, log),
        lubricant=read_lubricant(model, log),
        materials=read_materials(model, log),
        operating_cases=cases,
        operating_time=operating_time,
    )


# Shafts and their sections.


def read_shafts(model: RexsModel, log: AttributeLog) -> tuple[UnitShaft, ...]:
    """Shafts in the order of the file, each with its sections by their start."""
    return tuple(_shaft(model, log, component) for component in model.of_type("shaft"))


def _shaft(model: RexsModel, log: AttributeLog, component: Component) -> UnitShaft:
    here = f"shafts[{component.id}]"
    parts = [
        part
        for relation in ("assembly", "ordered_assembly")
        for part in model.related(relation, "assembly", component.id, "part")
        if part.type == "shaft_section"
    ]
    only = len(parts) == 1
    sections = [section for part in parts if (section := _section(log, part, here, only)) is not None]
    origin, axis = place_of(component, log, here)
    return UnitShaft(
        id=component.id,
        name=component.name,
        sections=tuple(sorted(sections, key=lambda section: section.start)),
        origin=origin,
        axis=axis,
    )


def _section(log: AttributeLog, part: Component, shaft: str, only: bool) -> ShaftSection | None:
    """A section; None, with all its attributes listed, without a length and an outer diameter."""
    here = f"{shaft}.sections[{part.id}]"
    stated = log.number(part, "u_coordinate_on_shaft", "mm", f"{here}.start")
    start = 0.0 if stated is None and only else stated
    length = log.number(part, "length", "mm", f"{here}.length", above=0.0)
    begin = log.number(part, "outer_diameter_begin", "mm", f"{here}.outer_begin", above=0.0)
    end = log.number(part, "outer_diameter_end", "mm", f"{here}.outer_end", above=0.0)
    inner_begin = log.number(part, "inner_diameter_begin", "mm", f"{here}.inner_begin") or 0.0
    inner_end = log.number(part, "inner_diameter_end", "mm", f"{here}.inner_end")
    begin, end = begin or end, end or begin
    inner_end = inner_begin if inner_end is None else inner_end
    problem = ""
    if start is None or length is None or begin is None or end is None:
        problem = "a section without start, length or outer diameter"
    elif inner_begin >= begin or inner_end >= end:
        problem = "a section whose bore is not inside its outside"
    if problem or start is None or length is None or begin is None or end is None:
        for attribute in part.attributes:
            log.refuse(part, attribute.id, problem)
        return None
    bores = max(inner_begin, 0.0), max(inner_end, 0.0)
    return ShaftSection(part.id, start, length, begin, end, *bores)


# Lubricant and materials.


def read_lubricant(model: RexsModel, log: AttributeLog) -> UnitLubricant | None:
    """The lubricant that casing, gear unit or a stage refers to, else the first of the file; others are listed."""
    lubricants = model.of_type("lubricant")
    if not lubricants:
        return None
    owners = model.of_type("gear_casing", "gear_unit", "cylindrical_stage")
    referred = [
        item
        for owner in owners
        for item in model.related("reference", "origin", owner.id, "referenced")
        if item.type == "lubricant"
    ]
    chosen = (*referred, *lubricants)[0]
    for other in lubricants:
        if other is not chosen:
            log.list_rest(other, "a further lubricant; the one of the casing counts")
    return _lubricant(log, chosen)


def read_materials(model: RexsModel, log: AttributeLog) -> tuple[UnitMaterial, ...]:
    """Materials in the order of the file."""
    return tuple(_material(log, component) for component in model.of_type("material"))


def _lubricant(log: AttributeLog, component: Component) -> UnitLubricant:
    here = "lubricant"
    return UnitLubricant(
        id=component.id,
        name=component.name,
        designation=log.text(component, "name", f"{here}.designation"),
        density_15=log.number(
            component, "density_at_15_degree_celsius", "kg / dm^3", f"{here}.density_15", above=0.0
        ),
        viscosity_40=log.number(
            component, "viscosity_at_40_degree_celsius", "mm^2 / s", f"{here}.viscosity_40", above=0.0
        ),
        viscosity_100=log.number(
            component, "viscosity_at_100_degree_celsius", "mm^2 / s", f"{here}.viscosity_100", above=0.0
        ),
        heat_capacity=log.number(
            component, "thermal_capacity", "J / (kg K)", f"{here}.heat_capacity", above=0.0
        ),
        conductivity=log.number(
            component, "thermal_conductivity", "W / (m K)", f"{here}.conductivity", above=0.0
        ),
    )


def _material(log: AttributeLog, component: Component) -> UnitMaterial:
    target = f"materials[{component.id}].designation"
    return UnitMaterial(component.id, component.name, log.text(component, "material_designation", target))


# Operating cases: speeds, loads and oil temperature of each load case over what the components themselves state.


@dataclass(frozen=True)
class _State:
    """What one set of components says of the operation."""

    speeds: Mapping[int, float]
    loads: Mapping[int, ShaftLoad]
    lubricant_temperature: float | None
    time_share: float | None
    duration: float | None

    def over(self, base: "_State") -> "_State":
        """This state, with ``base`` where it says nothing."""
        loads = {
            number: _over(self.loads[number], base.loads[number]) if number in self.loads else load
            for number, load in base.loads.items()
        }
        temperature = self.lubricant_temperature
        return replace(
            self,
            speeds={**base.speeds, **self.speeds},
            loads={**loads, **{number: load for number, load in self.loads.items() if number not in loads}},
            lubricant_temperature=base.lubricant_temperature if temperature is None else temperature,
        )

    def case(self, number: str | None) -> OperatingCase:
        return OperatingCase(
            number,
            self.speeds,
            tuple(self.loads.values()),
            self.time_share,
            self.duration,
            self.lubricant_temperature,
        )


def read_operation(model: RexsModel, log: AttributeLog) -> tuple[tuple[OperatingCase, ...], float | None]:
    """Operating cases, and the operating time of the whole [s].

    Without a load spectrum, what the components state is the one case, if it has a speed or a torque.
    """
    base = _state(model, log, model.components)
    cases = []
    for spectrum in model.load_spectra:
        prefix = f"{spectrum.id}." if len(model.load_spectra) > 1 else ""
        for load_case in spectrum.load_cases:
            log.load_case = f"{prefix}{load_case.id}"
            parts = tuple(_typed(model, part) for part in load_case.components)
            cases.append(_state(model, log, parts).over(base).case(log.load_case))
            for part in parts:
                log.list_rest(part, "no counterpart in the operation of a case")
        log.load_case = f"{prefix}accumulation"
        for part in spectrum.accumulation:
            log.list_rest(_typed(model, part), "a value over all load cases")
        log.load_case = None
    stated = base.speeds or any(load.torque or load.power for load in base.loads.values())
    if not cases and stated:
        cases = [replace(base, time_share=None, duration=None).case(None)]
    return tuple(cases), base.duration


def _state(model: RexsModel, log: AttributeLog, components: tuple[Component, ...]) -> _State:
    where = "operating_cases" if log.load_case is None else f"operating_cases[{log.load_case}]"
    casings = [part for part in components if part.type == "gear_casing"]
    units = [part for part in components if part.type == "gear_unit"]
    temperatures = [
        log.number(part, "temperature_lubricant", "C", f"{where}.lubricant_temperature", above=0.0)
        for part in casings
    ]
    share = [log.number(part, "operating_time_fraction", "%", f"{where}.time_share") for part in units]
    duration = [log.number(part, "operating_time", "h", f"{where}.duration", above=0.0) for part in units]
    speeds = {
        part.id: log.number(part, "rotational_speed", "1 / min", f"{where}.speeds[{part.id}]")
        for part in components
        if part.type == "shaft"
    }
    loads = [_load(model, log, part, where) for part in components if part.type == "external_load"]
    return _State(
        speeds={number: speed for number, speed in speeds.items() if speed is not None},
        loads={load.id: load for load in loads},
        lubricant_temperature=first_stated(temperatures),
        time_share=first_stated(share),
        duration=first_stated(duration),
    )


def _load(model: RexsModel, log: AttributeLog, part: Component, where: str) -> ShaftLoad:
    here = f"{where}.loads[{part.id}]"
    return ShaftLoad(
        id=part.id,
        shaft=shaft_of(model, part.id),
        position=log.number(part, "u_coordinate_on_shaft", "mm", f"{here}.position"),
        torque=log.number(part, "torque_around_u_axis", "N m", f"{here}.torque"),
        power=log.number(part, "power", "kW", f"{here}.power"),
        transmits_torque=log.flag(part, "transmits_torque", f"{here}.transmits_torque"),
    )


def _over(load: ShaftLoad, base: ShaftLoad) -> ShaftLoad:
    """``load`` with ``base`` where it says nothing; torque and power of ``base`` count only where it has neither."""
    if load.torque is not None or load.power is not None:
        base = replace(base, torque=None, power=None)
    stated = {
        name: value
        for name in ("position", "torque", "power", "transmits_torque")
        if (value := getattr(load, name)) is not None
    }
    return replace(base, **stated)


def _typed(model: RexsModel, part: Component) -> Component:
    """A component of a load case with the type that the model gives it."""
    return replace(part, type=model.component(part.id).type)
