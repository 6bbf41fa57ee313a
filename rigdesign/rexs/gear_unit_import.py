"""A REXS model as a gear unit in SI, with an account of everything in the file."""

from dataclasses import dataclass

from rigdesign.rexs.attribute_log import AttributeLog, ListedAttribute, MappedAttribute
from rigdesign.rexs.external_parts import DATA_SOURCE, REFERENCED
from rigdesign.rexs.gear_unit import GearUnit
from rigdesign.rexs.loads import read_operation
from rigdesign.rexs.model import RexsModel
from rigdesign.rexs.shafts import read_shafts
from rigdesign.rexs.substances import read_lubricant, read_materials
from rigdesign.rexs.supports import COUPLINGS, read_bearings, read_couplings
from rigdesign.rexs.toothing import read_gears, read_meshes
from rigdesign.rexs.versions import ROLLING_BEARINGS, Renaming, in_newest_names

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
