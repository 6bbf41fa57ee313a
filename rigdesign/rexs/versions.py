"""Versions of REXS: which are read, and a model in the names of REXS 2.0 whatever version it was written in.

Source: the change logs between the versions of the REXS database. Only names that matter for a gear unit are listed; an
exporter that writes an old name into a newer file is understood as well, where the new name is not there too.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

from rigdesign.rexs.model import (
    Attribute,
    Component,
    LoadCase,
    LoadSpectrum,
    Relation,
    RexsModel,
    RoleReference,
)

_VERSIONS = re.compile(r"(?:1\.[0-7]|2\.0)(?:\.[0-9]{1,4})?")

ROLLING_BEARINGS = ("rolling_bearing_with_catalog_geometry", "rolling_bearing_with_detailed_geometry")
_OF_ROLLING_BEARINGS: Mapping[str, str] = {
    "name": "catalogue_designation",
    "dynamic_capacity": "radial_dynamic_load_rating",
    "static_capacity": "radial_static_load_rating",
    "clearance_class": "radial_clearance_class",
    "radial_backlash": "operating_radial_bearing_clearance",
    "axial_backlash": "operating_axial_bearing_clearance",
    "minimum_bearing_clearance": "minimum_radial_bearing_clearance",
    "maximum_bearing_clearance": "maximum_radial_bearing_clearance",
    "initial_load": "preload_force",
    "initial_load_shift": "preload_distance",
    "pin_tolerance_class": "shaft_tolerance_class",
    "boring_tolerance_class": "casing_bore_tolerance_class",
    "contamination_factor_according_to_din_26281": "contamination_factor_iso_281_2007",
    "contamination_factor_according_to_iso_281_2007": "contamination_factor_iso_281_2007",
    "viscosity_ratio_din_26281": "viscosity_ratio_iso_281_2007",
    "viscosity_ratio_according_to_iso_281_2007": "viscosity_ratio_iso_281_2007",
    "survival_probablity": "survival_probability",
}
_OF_GEARS: Mapping[str, str] = {
    "arithmetic_average_roughness_flank": "arithmetic_mean_roughness_flank_iso_4287_1997",
    "averaged_peak_to_valley_height_flank": "mean_peak_to_valley_roughness_flank_iso_4287_1997",
    "tolerance_class_according_to_iso_1328_2013": "global_tolerance_class_iso_1328_2013",
    "reference_circle_diameter": "reference_diameter_cylindrical_gear",
    "base_circle_diameter": "base_diameter",
    "helix_angle_base_circle": "helix_angle_base_diameter",
    "din_3967_deviation_tolerance_series": "tooth_thickness_deviation_tolerance_series_din_3967_1978",
}
_OF_STAGES: Mapping[str, str] = {
    "face_load_factor_flank": "face_load_factor_contact_stress",
    "face_load_factor_root": "face_load_factor_root_stress",
    "din_3964_center_distance_tolerance_field": "center_distance_tolerance_field_din_3964_1980",
}
_OF_TOOLS: Mapping[str, str] = {
    "tip_radius_factor": "tip_corner_radius_factor_reference_profile",
    "tip_radius": "tip_corner_radius_reference_profile",
}
ATTRIBUTES: Mapping[str, Mapping[str, str]] = {
    **dict.fromkeys(ROLLING_BEARINGS, _OF_ROLLING_BEARINGS),
    **dict.fromkeys(("cylindrical_gear", "ring_gear"), _OF_GEARS),
    "cylindrical_stage": _OF_STAGES,
    **dict.fromkeys(("rack_shaped_tool", "cutter_wheel_tool"), _OF_TOOLS),
    "gear_unit": {"load_duration": "operating_time", "load_duration_fraction": "operating_time_fraction"},
    "material": {"fatigue_limit_compression_tension": "fatigue_limit_tension_compression"},
}
"""Component type -> old attribute id -> id in REXS 2.0."""
ENUMERATIONS: Mapping[tuple[str, str], str] = {
    ("bearing_type", "radial_self-aligning_ball_bearing"): "radial_self_aligning_ball_bearing",
    ("basis", "biologic-degradable"): "biologic_degradable",
    ("basis", "food-grade"): "food_grade",
}
"""Attribute id and old entry of its enumeration -> entry in REXS 2.0."""
_BY_STAGE: Mapping[str, str] = {
    "cylindrical_stage": "cylindrical_stage_gear_data",
    "bevel_stage": "bevel_stage_gear_data",
    "worm_stage": "worm_stage_gear_data",
}
_BY_GEAR: Mapping[str, str] = {
    "cylindrical_gear": "cylindrical_gear_flank",
    "ring_gear": "cylindrical_gear_flank",
    "bevel_gear": "bevel_gear_flank",
    "worm_gear": "worm_gear_flank",
    "worm_wheel": "worm_gear_flank",
}


@dataclass(frozen=True)
class Renaming:
    """A name of an older version and the one of REXS 2.0 it is read as."""

    component: int
    old: str
    new: str


def is_read(version: str) -> bool:
    """Whether this version is read: 1.0 to 1.7 and 2.0, with or without a patch number."""
    return _VERSIONS.fullmatch(version) is not None


def before_1_1(version: str) -> bool:
    """Whether the position of a gear on its shaft counts to the start of its face, not to its middle."""
    return version.startswith("1.0")


def in_newest_names(model: RexsModel) -> tuple[RexsModel, tuple[Renaming, ...]]:
    """The model in names of REXS 2.0, and the names that were changed for it.

    ``stage_gear_data`` and ``flank_geometry`` (to 1.2) get the type of their stage or gear, attributes and entries of
    enumerations their new names, the relation ``coupling`` of 1.0 becomes ``side``.
    """
    types = {component.id: _new_type(model, component) for component in model.components}
    log: list[Renaming] = []
    components = tuple(_renamed(component, types[component.id], log) for component in model.components)
    spectra = tuple(_renamed_spectrum(spectrum, types, log) for spectrum in model.load_spectra)
    relations = tuple(_as_side(relation) for relation in model.relations)
    newest = replace(model, components=components, relations=relations, load_spectra=spectra)
    return newest, tuple(dict.fromkeys(log))


def _new_type(model: RexsModel, component: Component) -> str:
    if component.type == "stage_gear_data":
        stages = model.related("stage_gear_data", "stage_gear_data", component.id, "stage")
        return next((_BY_STAGE[stage.type] for stage in stages if stage.type in _BY_STAGE), component.type)
    if component.type == "flank_geometry":
        gears = [
            gear for side in ("left", "right") for gear in model.related("flank", side, component.id, "gear")
        ]
        return next((_BY_GEAR[gear.type] for gear in gears if gear.type in _BY_GEAR), component.type)
    return component.type


def _renamed(component: Component, new_type: str, log: list[Renaming]) -> Component:
    if new_type != component.type != "":
        log.append(Renaming(component.id, component.type, new_type))
    names = ATTRIBUTES.get(new_type, {})
    present = {attribute.id for attribute in component.attributes}
    attributes = []
    for attribute in component.attributes:
        new = names.get(attribute.id, attribute.id)
        if new != attribute.id and new not in present:
            log.append(Renaming(component.id, attribute.id, new))
            attribute = replace(attribute, id=new)
        attributes.append(_with_new_entry(attribute))
    return replace(component, type=new_type, attributes=tuple(attributes))


def _with_new_entry(attribute: Attribute) -> Attribute:
    if not isinstance(attribute.value, str):
        return attribute
    return replace(attribute, value=ENUMERATIONS.get((attribute.id, attribute.value), attribute.value))


def _renamed_spectrum(spectrum: LoadSpectrum, types: Mapping[int, str], log: list[Renaming]) -> LoadSpectrum:
    def renamed(components: tuple[Component, ...]) -> tuple[Component, ...]:
        return tuple(_renamed(item, types.get(item.id, item.type), log) for item in components)

    cases = tuple(LoadCase(case.id, renamed(case.components)) for case in spectrum.load_cases)
    return LoadSpectrum(spectrum.id, cases, renamed(spectrum.accumulation))


def _as_side(relation: Relation) -> Relation:
    if relation.type != "coupling":
        return relation
    roles = {"side_1": "inner_part", "side_2": "outer_part"}
    references = tuple(
        RoleReference(item.component, roles.get(item.role, item.role)) for item in relation.references
    )
    return replace(relation, type="side", references=references)
