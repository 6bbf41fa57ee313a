"""A REXS model as read: components with attributes, relations with roles, load spectra; nothing is converted."""

import re
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import isfinite
from typing import Literal, NoReturn

from rigdesign.base.errors import Fault, RexsError, shortened, spelled_out

Scalar = bool | int | float | str | None
"""One value; XML leaves numbers and truth values as text."""
Value = Scalar | tuple[Scalar, ...] | tuple[tuple[Scalar, ...], ...]
"""Scalar, vector, or matrix by rows (and arrays of arrays, whose rows differ in length)."""
ValueKind = Literal[
    "untyped", "boolean", "string", "integer", "floating_point", "enum", "reference_component", "file_reference",
    "date_time", "floating_point_array", "integer_array", "boolean_array", "string_array", "enum_array",
    "floating_point_matrix", "integer_matrix", "boolean_matrix", "string_matrix", "array_of_integer_arrays", "unknown",
]  # fmt: skip
"""Value type of the database, stated in JSON only; ``unknown`` for a type that REXS 2.0 does not have."""

_NUMBER = re.compile(r"\s*[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,4})?\s*")
_LONGEST_NUMBER = 60
_SHOWN = 60


class AttributeValueError(ValueError):
    """An attribute whose value is not what is asked of it; the text says what it is instead."""


@dataclass(frozen=True)
class Attribute:
    """One attribute of a component, as written.

    unit : unit id as written, None where the file states none
    kind : value type as JSON states it; XML states none
    """

    id: str
    unit: str | None
    value: Value
    kind: ValueKind = "untyped"

    def number(self) -> float:
        """The scalar as a finite number.

        Raises
        ------
        AttributeValueError
            No number: text, a truth value, a vector, not finite, a decimal comma, empty.
        """
        return _number(self.value)

    def whole_number(self) -> int:
        """The scalar as an integer; ``16.0`` counts as one.

        Raises
        ------
        AttributeValueError
            No number, or one with a fraction.
        """
        number = _number(self.value)
        if number != int(number):
            raise AttributeValueError(f"{_shown(self.value)} where a whole number belongs")
        return int(number)

    def text(self) -> str:
        """The scalar as text: string, enumeration, file reference; a number as it is written.

        Raises
        ------
        AttributeValueError
            Empty, a vector or a truth value.
        """
        if isinstance(self.value, str) and self.value.strip():
            return self.value.strip()
        if isinstance(self.value, int | float) and not isinstance(self.value, bool):
            return str(self.value)
        raise AttributeValueError(f"{_shown(self.value)} where a text belongs")

    def flag(self) -> bool:
        """The scalar as true or false.

        Raises
        ------
        AttributeValueError
            Neither.
        """
        if isinstance(self.value, bool):
            return self.value
        if isinstance(self.value, str) and self.value.strip() in ("true", "false"):
            return self.value.strip() == "true"
        raise AttributeValueError(f"{_shown(self.value)} where true or false belongs")

    def vector(self) -> tuple[float, ...]:
        """The vector as finite numbers.

        Raises
        ------
        AttributeValueError
            No vector, or an entry that is no number.
        """
        if not isinstance(self.value, tuple):
            raise AttributeValueError(f"{_shown(self.value)} where a list of numbers belongs")
        return tuple(_number(entry) for entry in self.value)

    def written(self) -> str:
        """Value and unit as a reader of the file sees them, shortened."""
        unit = f" {self.unit}" if self.unit and self.unit != "none" else ""
        return _shown(self.value) + unit


@dataclass(frozen=True)
class Component:
    """One component: part of the gear unit, connection, contact or data of one of them."""

    id: int
    type: str
    name: str
    attributes: tuple[Attribute, ...]

    @cached_property
    def _by_id(self) -> Mapping[str, Attribute]:
        return {attribute.id: attribute for attribute in reversed(self.attributes)}

    def attribute(self, name: str) -> Attribute | None:
        """The first attribute of this id, None where there is none."""
        return self._by_id.get(name)


@dataclass(frozen=True)
class RoleReference:
    """A component in the role it has in a relation."""

    component: int
    role: str


@dataclass(frozen=True)
class Relation:
    """Components related to each other: ``assembly`` of assembly and part, ``side`` of a bearing and what it joins.

    order : place in an ordered relation, counted from 1; None in others
    """

    id: int
    type: str
    references: tuple[RoleReference, ...]
    order: int | None = None

    def with_role(self, role: str) -> int | None:
        """Id of the first component in this role."""
        return next((item.component for item in self.references if item.role == role), None)


@dataclass(frozen=True)
class LoadCase:
    """One load case: of some components the attributes that hold in it."""

    id: int
    components: tuple[Component, ...]


@dataclass(frozen=True)
class LoadSpectrum:
    """Load cases, and attributes that sum up all of them (``accumulation``)."""

    id: int
    load_cases: tuple[LoadCase, ...]
    accumulation: tuple[Component, ...] = ()


@dataclass(frozen=True)
class RexsModel:
    """A REXS file.

    source : file it was read from, for messages
    version : REXS version as written
    application : program that wrote it, with its version
    """

    source: str
    version: str
    application: str
    date: str
    components: tuple[Component, ...]
    relations: tuple[Relation, ...] = ()
    load_spectra: tuple[LoadSpectrum, ...] = ()

    @cached_property
    def _by_id(self) -> Mapping[int, Component]:
        return {component.id: component for component in self.components}

    @cached_property
    def _by_role(self) -> Mapping[tuple[str, str, int], tuple[Relation, ...]]:
        found: dict[tuple[str, str, int], list[Relation]] = {}
        for relation in self.relations:
            for item in relation.references:
                found.setdefault((relation.type, item.role, item.component), []).append(relation)
        return {key: tuple(relations) for key, relations in found.items()}

    def component(self, number: int) -> Component:
        """Component of this id; KeyError for none."""
        return self._by_id[number]

    def has(self, number: int) -> bool:
        """Whether a component has this id."""
        return number in self._by_id

    def of_type(self, *types: str) -> tuple[Component, ...]:
        """All components of these types, in the order of the file."""
        return tuple(component for component in self.components if component.type in types)

    def relations_of(self, relation: str, role: str, component: int) -> tuple[Relation, ...]:
        """Relations of a type in which a component has a role, in the order of the file."""
        return self._by_role.get((relation, role, component), ())

    def related(self, relation: str, role: str, component: int, other: str) -> tuple[Component, ...]:
        """Components in the role ``other`` of the relations in which ``component`` has ``role``.

        Ordered relations come in their order.
        """
        relations = sorted(self.relations_of(relation, role, component), key=lambda item: item.order or 0)
        numbers = [number for item in relations if (number := item.with_role(other)) is not None]
        return tuple(self._by_id[number] for number in dict.fromkeys(numbers))


def _number(value: Value) -> float:
    if isinstance(value, str):
        if len(value) > _LONGEST_NUMBER or not _NUMBER.fullmatch(value):
            raise AttributeValueError(f"{_shown(value)} where a number belongs")
        number = float(value)
    elif isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e300:
        number = float(value)
    else:
        raise AttributeValueError(f"{_shown(value)} where a number belongs")
    if not isfinite(number):
        raise AttributeValueError(f"{_shown(value)} where a finite number belongs")
    return number


def _shown(value: Value) -> str:
    """Value in a line of a list."""
    if value is None or value == "":
        return "nothing"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return shortened(value, _SHOWN)
    if isinstance(value, tuple):
        few = ", ".join(_shown(entry) for entry in value[:4])
        return f"[{few}]" if len(value) <= 4 else f"[{few}, … {len(value)} entries]"
    return shortened(repr(value), _SHOWN)


# Versions of REXS: which are read, and a model in the names of REXS 2.0 whatever version it was written in.
#
# Source: the change logs between the versions of the REXS database. Only names that matter for a gear unit are listed;
# an exporter that writes an old name into a newer file is understood as well, where the new name is not there too.

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


# What is wrong with a REXS file: collected while it is read, raised as one error with file, place and remedy.

MOST_FAULTS = 20
"""Faults after which the rest of a file is not looked at."""
EXPORT_AGAIN = "export the model again from the program it comes from, as REXS 1.0 to 2.0"
_INTEGER = re.compile(r"\s*-?[0-9]{1,9}\s*")


def printable(text: str) -> str:
    """``text`` as a terminal and a file can take it: control characters spelled out, half characters replaced."""
    return spelled_out(text.encode("utf-8", "replace").decode("utf-8"))


class FaultList:
    """Faults of one file."""

    def __init__(self, source: str) -> None:
        self.source = source
        self._faults: list[Fault] = []

    def add(self, place: str, given: object, problem: str, remedy: str) -> None:
        """Note a fault; raises RexsError when there are too many to go on."""
        self._faults.append(_fault(place, given, problem, remedy))
        if len(self._faults) >= MOST_FAULTS:
            self.raise_if_any()

    def error(self, place: str, given: object, problem: str, remedy: str) -> RexsError:
        """The error of a fault after which nothing can be read, with all faults so far."""
        self._faults.append(_fault(place, given, problem, remedy))
        return RexsError(self._faults, self.source)

    def stop(self, place: str, given: object, problem: str, remedy: str) -> NoReturn:
        """Note a fault after which nothing can be read, and raise.

        Raises
        ------
        RexsError
            Always; with all faults so far.
        """
        raise self.error(place, given, problem, remedy)

    def raise_if_any(self) -> None:
        """Raise RexsError with all faults so far, if there are any."""
        if self._faults:
            raise RexsError(self._faults, self.source)

    def whole_number(self, place: str, key: str, given: object) -> int:
        """An id or order; a missing or wrong one is a fault and reads as -1."""
        if isinstance(given, int) and not isinstance(given, bool) and abs(given) < 10**9:
            return given
        if isinstance(given, str) and _INTEGER.fullmatch(given):
            return int(given)
        problem = "missing" if given is None else "no whole number of at most nine digits"
        self.add(f"{place}, {key}", given, problem, f"write {key} as a whole number, as REXS asks for")
        return -1

    def text(self, place: str, key: str, given: object, *, needed: bool = True) -> str:
        """A name or type; empty where it is missing, which is a fault where it is needed."""
        if isinstance(given, str) and (given.strip() or not needed):
            return printable(given.strip())
        if given is not None or needed:
            problem = "missing" if given is None or given == "" else "no text"
            self.add(f"{place}, {key}", given, problem, f"write {key} as a text, as REXS asks for")
        return ""


def _fault(place: str, given: object, problem: str, remedy: str) -> Fault:
    return Fault(place, "" if given is None else printable(str(given)[:1000]), problem, remedy)


# What holds for a REXS model in XML and JSON alike: a version that is read, unique ids, references to something.

MOST_STATES = 2_000_000
"""Load cases times shafts and loads, each of which has a state in each case."""


def check_version(version: str, place: str, faults: FaultList) -> None:
    """Stop at a version that is not read, before the rest of the file is misunderstood.

    Raises
    ------
    RexsError
        The version is none of 1.0 to 1.7 and 2.0.
    """
    if not is_read(version):
        faults.stop(f"{place}, version", version, "not one of REXS 1.0 to 1.7 and 2.0", EXPORT_AGAIN)


def check_model(model: RexsModel, faults: FaultList) -> RexsModel:
    """``model``, if it holds together.

    Raises
    ------
    RexsError
        No components, an id that occurs twice, or a relation or load case that names a component that is not there,
        load cases without end; with all faults collected before.
    """
    if not model.components:
        faults.add("model, components", None, "a model without components", EXPORT_AGAIN)
    _check_unique("component", (component.id for component in model.components), faults)
    _check_unique("relation", (relation.id for relation in model.relations), faults)
    for relation in model.relations:
        for item in relation.references:
            _check_known(model, f"relation {relation.id}, role {item.role!r}", item.component, faults)
    _check_unique("load_spectrum", (spectrum.id for spectrum in model.load_spectra), faults)
    for spectrum in model.load_spectra:
        _check_unique(
            f"load_spectrum {spectrum.id}: load_case", (case.id for case in spectrum.load_cases), faults
        )
        for case in spectrum.load_cases:
            _check_parts(model, f"load_case {case.id}", case.components, faults)
        _check_parts(model, "accumulation", spectrum.accumulation, faults)
    cases = sum(len(spectrum.load_cases) for spectrum in model.load_spectra)
    carriers = len(model.of_type("shaft", "external_load"))
    if cases * carriers > MOST_STATES:
        problem = (
            f"{cases} load cases of {carriers} shafts and loads, above the limit of {MOST_STATES} states"
        )
        faults.add("load_spectrum", None, problem, "export a classified load spectrum")
    faults.raise_if_any()
    return model


def _check_parts(model: RexsModel, place: str, components: tuple[Component, ...], faults: FaultList) -> None:
    _check_unique(f"{place}, component", (component.id for component in components), faults)
    for component in components:
        _check_known(model, f"{place}, component", component.id, faults)


def _check_unique(what: str, numbers: Iterable[int], faults: FaultList) -> None:
    for number, count in Counter(numbers).items():
        if count > 1:
            faults.add(f"{what} {number}", None, f"the id occurs {count} times", "give each an id of its own")


def _check_known(model: RexsModel, place: str, number: int, faults: FaultList) -> None:
    if not model.has(number):
        faults.add(place, number, "no component has this id", f"add the component, or {EXPORT_AGAIN}")
