"""Bearings and couplings: what they join, where, and what the file says of them."""

from typing import Literal

from rigdesign.rexs.attribute_log import AttributeLog
from rigdesign.rexs.gear_unit import BearingPlace, CatalogueData, UnitBearing, UnitCoupling
from rigdesign.rexs.model import Component, RexsModel
from rigdesign.rexs.versions import ROLLING_BEARINGS

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
