"""Lubricant and materials."""

from rigdesign.rexs.attribute_log import AttributeLog
from rigdesign.rexs.gear_unit import UnitLubricant, UnitMaterial
from rigdesign.rexs.model import Component, RexsModel


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
