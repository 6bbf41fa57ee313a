"""A gear unit in neutral terms: what a REXS model says of gears, shafts, bearings, couplings, oil and loads, in SI.

Lengths [m], angles [rad], temperatures [K], speeds [rad/s]; parts are named by their REXS id. None stands for what the
file does not state or states unusably. Positions count along the shaft from its start, in the direction of its axis.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import cos, fsum
from typing import Literal

from rigdesign.rexs.attribute_log import AttributeLog
from rigdesign.rexs.model import AttributeValueError, Component, RexsModel, before_1_1

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class UnitGear:
    """A cylindrical gear.

    helix_angle : at the reference cylinder, with sign: positive for right-hand teeth
    position : middle of the face from the start of its shaft
    profile_shift : x, in modules, of the left flank if the two differ
    quality_grade : tolerance class, ISO 1328-1:2013
    flank_roughness : arithmetic mean Ra [m]
    material : id of its material
    """

    id: int
    name: str
    shaft: int | None = None
    position: float | None = None
    teeth: int | None = None
    normal_module: float | None = None
    pressure_angle: float | None = None
    helix_angle: float | None = None
    face_width: float | None = None
    profile_shift: float | None = None
    tip_diameter: float | None = None
    bore_diameter: float | None = None
    quality_grade: int | None = None
    flank_roughness: float | None = None
    material: int | None = None


@dataclass(frozen=True)
class UnitMesh:
    """Two meshing cylindrical gears.

    pinion, wheel : gear ids; the pinion is the one with fewer teeth
    """

    id: int
    name: str
    pinion: int
    wheel: int
    centre_distance: float | None = None
    application_factor: float | None = None
    face_load_factor: float | None = None


@dataclass(frozen=True)
class ShaftSection:
    """A piece of a shaft: cylinder or cone, solid where its bores are zero; diameters at its begin and end [m].

    start : from the start of the shaft; zero where the file states none for the only section
    """

    id: int
    start: float
    length: float
    outer_begin: float
    outer_end: float
    inner_begin: float = 0.0
    inner_end: float = 0.0


@dataclass(frozen=True)
class UnitShaft:
    """A shaft.

    sections : by their start
    origin : start of the shaft in the coordinates of the gear unit [m]
    axis : unit vector along the shaft there
    """

    id: int
    name: str
    sections: tuple[ShaftSection, ...] = ()
    origin: Vector | None = None
    axis: Vector | None = None

    @property
    def length(self) -> float:
        """From zero to the end of the last section [m]."""
        return max((section.start + section.length for section in self.sections), default=0.0)


@dataclass(frozen=True)
class BearingPlace:
    """What a bearing or coupling joins: ids of inner and outer part, and its middle on each of them [m]."""

    inner: int | None = None
    outer: int | None = None
    inner_position: float | None = None
    outer_position: float | None = None


@dataclass(frozen=True)
class CatalogueData:
    """Catalogue numbers of a rolling bearing.

    type : as REXS has it, e.g. ``radial_roller_bearing``
    dynamic_load_rating, static_load_rating, fatigue_limit_load : radial C, C_0, C_u [N]
    contact_angle : of its first row
    limit_e, axial_factor, static_axial_factor : e, Y for F_a/F_r above e, and Y_0
    contamination_factor : e_C of ISO 281
    limiting_speed, reference_speed : [rad/s]
    """

    designation: str | None = None
    type: str | None = None
    contact_angle: float | None = None
    dynamic_load_rating: float | None = None
    static_load_rating: float | None = None
    fatigue_limit_load: float | None = None
    limiting_speed: float | None = None
    reference_speed: float | None = None
    limit_e: float | None = None
    axial_factor: float | None = None
    static_axial_factor: float | None = None
    contamination_factor: float | None = None


@dataclass(frozen=True)
class UnitBearing:
    """A bearing.

    kind : rolling with catalogue numbers; journal (hydrodynamic); stiffness: a support of given stiffness, no more
    inner_diameter, outer_diameter, width : of bore, outer ring, ring; of a journal bearing its bore, shell and width
    radial_clearance : as delivered, else in operation; of a journal bearing the diametral one [m]
    axial_force : direction in which it takes axial force: both_directions, positive, negative, no_direction
    """

    id: int
    name: str
    kind: Literal["rolling", "journal", "stiffness"]
    place: BearingPlace
    catalogue: CatalogueData = CatalogueData()
    inner_diameter: float | None = None
    outer_diameter: float | None = None
    width: float | None = None
    radial_clearance: float | None = None
    clearance_class: str | None = None
    axial_force: str | None = None


@dataclass(frozen=True)
class UnitCoupling:
    """A coupling of two shafts or of a shaft with its surroundings."""

    id: int
    name: str
    place: BearingPlace


@dataclass(frozen=True)
class UnitLubricant:
    """An oil or grease.

    density_15 : at 15 degC [kg/m^3]
    viscosity_40, viscosity_100 : kinematic, at 40 and 100 degC [m^2/s]
    """

    id: int
    name: str
    designation: str | None = None
    density_15: float | None = None
    viscosity_40: float | None = None
    viscosity_100: float | None = None
    heat_capacity: float | None = None
    conductivity: float | None = None


@dataclass(frozen=True)
class UnitMaterial:
    """A material."""

    id: int
    name: str
    designation: str | None = None


@dataclass(frozen=True)
class ShaftLoad:
    """Load on a shaft from outside.

    torque : around the shaft axis [N m]; power [W] where the file states that instead
    transmits_torque : False for forces only
    """

    id: int
    shaft: int | None
    position: float | None = None
    torque: float | None = None
    power: float | None = None
    transmits_torque: bool | None = None


@dataclass(frozen=True)
class OperatingCase:
    """One load case, or the state that the components themselves give (id None).

    id : of the load case, with that of its spectrum before it if there are several: ``3``, ``2.3``
    time_share : of the operating time; duration : [s]
    speeds : shaft id -> speed with sign [rad/s]
    lubricant_temperature : of the oil in the casing [K]
    """

    id: str | None
    speeds: Mapping[int, float]
    loads: tuple[ShaftLoad, ...]
    time_share: float | None = None
    duration: float | None = None
    lubricant_temperature: float | None = None


@dataclass(frozen=True)
class GearUnit:
    """All of a gear unit that has a counterpart in a case."""

    name: str = ""
    gears: tuple[UnitGear, ...] = ()
    meshes: tuple[UnitMesh, ...] = ()
    shafts: tuple[UnitShaft, ...] = ()
    bearings: tuple[UnitBearing, ...] = ()
    couplings: tuple[UnitCoupling, ...] = ()
    lubricant: UnitLubricant | None = None
    materials: tuple[UnitMaterial, ...] = ()
    operating_cases: tuple[OperatingCase, ...] = ()
    operating_time: float | None = None
    """Of the whole spectrum [s]."""

    @cached_property
    def _gears_by_id(self) -> Mapping[int, UnitGear]:
        return {gear.id: gear for gear in self.gears}

    @cached_property
    def _shafts_by_id(self) -> Mapping[int, UnitShaft]:
        return {shaft.id: shaft for shaft in self.shafts}

    @cached_property
    def _turning(self) -> frozenset[int | None]:
        return frozenset((*self._shafts_by_id, *self._gears_by_id))

    def in_casing(self, bearing: UnitBearing) -> bool:
        """Whether a bearing does not sit between two parts that turn."""
        return not {bearing.place.inner, bearing.place.outer} <= self._turning

    def gear(self, number: int) -> UnitGear:
        """Gear of this id; KeyError for none."""
        return self._gears_by_id[number]

    def shaft(self, number: int) -> UnitShaft:
        """Shaft of this id; KeyError for none."""
        return self._shafts_by_id[number]


# Cylindrical gears and their meshes.

_APPLICATION_FACTORS = (
    "application_factor_iso_6336_2019", "application_factor_iso_6336_2006", "application_factor_din_3990_1987",
)  # fmt: skip
_DEEPEST_TIP, _HIGHEST_TIP = -1.25, 2.0
"""Modules from the shifted reference circle between which a tip circle lies."""


def read_gears(model: RexsModel, log: AttributeLog) -> tuple[UnitGear, ...]:
    """Cylindrical gears with outer teeth, in the order of the file."""
    return tuple(_gear(model, log, component) for component in model.of_type("cylindrical_gear"))


def read_meshes(model: RexsModel, log: AttributeLog, gears: tuple[UnitGear, ...]) -> tuple[UnitMesh, ...]:
    """Cylindrical stages of two such gears; stages with a ring gear are left out."""
    known = {gear.id: gear for gear in gears}
    meshes = []
    for stage in model.of_type("cylindrical_stage"):
        relations = model.relations_of("stage", "stage", stage.id)
        pair = [relations[0].with_role(role) for role in ("gear_1", "gear_2")] if relations else [None, None]
        first, second = (known.get(number) if number is not None else None for number in pair)
        if first is not None and second is not None and first is not second:
            meshes.append(_mesh(model, log, stage, first, second))
        else:
            log.list_rest(stage, "a stage that is not of two cylindrical gears with outer teeth")
    return tuple(meshes)


def _gear(model: RexsModel, log: AttributeLog, component: Component) -> UnitGear:
    here = f"gears[{component.id}]"
    width = log.number(component, "face_width", "mm", f"{here}.face_width", above=0.0)
    gear = UnitGear(
        id=component.id,
        name=component.name,
        shaft=shaft_of(model, component.id),
        position=gear_position(model, log, component, width),
        teeth=log.whole_number(component, "number_of_teeth", f"{here}.teeth", least=3),
        normal_module=log.number(component, "normal_module", "mm", f"{here}.normal_module", above=0.0),
        helix_angle=log.number(component, "helix_angle_reference_diameter", "deg", f"{here}.helix_angle"),
        face_width=width,
        tip_diameter=log.number(component, "tip_diameter", "mm", f"{here}.tip_diameter", above=0.0),
        bore_diameter=log.number(component, "inner_diameter", "mm", f"{here}.bore_diameter"),
        quality_grade=log.whole_number(
            component, "global_tolerance_class_iso_1328_2013", f"{here}.quality_grade", least=1
        ),
        flank_roughness=log.number(
            component,
            "arithmetic_mean_roughness_flank_iso_4287_1997",
            "mum",
            f"{here}.flank_roughness",
            above=0.0,
        ),
        material=_material_of(model, component.id),
    )
    return _with_plausible_tip(log, component, _with_flanks(model, log, component, gear))


def _with_flanks(model: RexsModel, log: AttributeLog, component: Component, gear: UnitGear) -> UnitGear:
    """Pressure angle and profile shift, which REXS states of each flank; the left one counts."""
    flanks = [
        flank for side in ("left", "right") for flank in model.related("flank", "gear", component.id, side)
    ]
    here = f"gears[{gear.id}]"
    angles = [
        log.number(flank, "normal_pressure_angle", "deg", f"{here}.pressure_angle", above=0.0)
        for flank in (*flanks, component)
    ]
    shifts = [_profile_shift(log, flank, gear, here) for flank in (*flanks, component)]
    for attribute, values in (
        ("normal_pressure_angle", angles), ("addendum_modification_coefficient", shifts),
    ):  # fmt: skip
        for flank, value in zip(flanks[1:], values[1:], strict=False):
            if value is not None and values[0] is not None and abs(value - values[0]) > 1e-9:
                log.refuse(flank, attribute, "not that of the left flank, which counts for both")
    return replace(gear, pressure_angle=first_stated(angles), profile_shift=first_stated(shifts))


def _profile_shift(log: AttributeLog, flank: Component, gear: UnitGear, here: str) -> float | None:
    target = f"{here}.profile_shift"
    stated = log.number(flank, "addendum_modification_coefficient", "none", target)
    if stated is not None or gear.normal_module is None:
        return stated
    length = log.number(flank, "addendum_modification", "mm", target)
    return None if length is None else length / gear.normal_module


def _with_plausible_tip(log: AttributeLog, component: Component, gear: UnitGear) -> UnitGear:
    """Drop a tip diameter that cannot be that of the gear; some exporters write 1 mm for one that is not set."""
    module, tip = gear.normal_module, gear.tip_diameter
    if module is None or gear.teeth is None or tip is None or gear.teeth > 10_000:
        return gear
    reference = gear.teeth * module / max(abs(cos(gear.helix_angle or 0.0)), 0.1)
    least, most = (
        reference + 2.0 * module * ((gear.profile_shift or 0.0) + height)
        for height in (_DEEPEST_TIP, _HIGHEST_TIP)
    )
    if least < tip < most:
        return gear
    reason = f"not the tip of {gear.teeth} teeth of this module ({least * 1e3:.4g} to {most * 1e3:.4g} mm)"
    log.refuse(component, "tip_diameter", reason)
    return replace(gear, tip_diameter=None)


def _mesh(
    model: RexsModel, log: AttributeLog, stage: Component, first: UnitGear, second: UnitGear
) -> UnitMesh:
    here = f"meshes[{stage.id}]"
    swapped = first.teeth is not None and second.teeth is not None and second.teeth < first.teeth
    pinion, wheel = (second, first) if swapped else (first, second)
    factors = [
        log.number(stage, name, "none", f"{here}.application_factor", above=0.0)
        for name in _APPLICATION_FACTORS
    ]
    return UnitMesh(
        id=stage.id,
        name=stage.name,
        pinion=pinion.id,
        wheel=wheel.id,
        centre_distance=log.number(stage, "center_distance", "mm", f"{here}.centre_distance", above=0.0),
        application_factor=first_stated(factors),
        face_load_factor=log.number(
            stage, "face_load_factor_contact_stress", "none", f"{here}.face_load_factor", above=0.0
        ),
    )


def _material_of(model: RexsModel, part: int) -> int | None:
    found = model.related("reference", "origin", part, "referenced")
    return next((item.id for item in found if item.type == "material"), None)


def first_stated(values: list[float | None]) -> float | None:
    """The first of some values that is there."""
    return next((value for value in values if value is not None), None)


# Where a part sits on its shaft, from its coordinate on the shaft and from its place in the gear unit.

SAME_PLACE = 1e-6
"""Difference of two statements of one position that is round-off [m]."""


def shaft_of(model: RexsModel, part: int) -> int | None:
    """Id of the shaft that a part is assembled on, None for none."""
    owners = model.related("assembly", "part", part, "assembly")
    return next((owner.id for owner in owners if owner.type == "shaft"), None)


def place_of(component: Component, log: AttributeLog, target: str) -> tuple[Vector | None, Vector | None]:
    """Origin [m] and unit vector of a component's axis in the coordinates it refers to; None where not stated."""
    origin = log.vector(component, "support_vector", "mm", f"{target}.origin")
    return origin, log.direction(component, "u_axis_vector", f"{target}.axis")


def gear_position(
    model: RexsModel, log: AttributeLog, gear: Component, face_width: float | None
) -> float | None:
    """Middle of the face of a gear from the start of its shaft [m].

    ``u_coordinate_on_shaft`` counts to the middle; files of REXS 1.0 have it to the start of the face. The place of the
    gear in the gear unit always is that of its middle, so that it decides where the two differ.
    """
    target = f"gears[{gear.id}].position"
    coordinate = log.number(gear, "u_coordinate_on_shaft", "mm", target)
    shaft = shaft_of(model, gear.id)
    middle = None if shaft is None else _along(model, log, gear, model.component(shaft), target)
    if middle is not None:
        if coordinate is not None and abs(middle - coordinate) > SAME_PLACE:
            reason = (
                f"not the middle of the face, which its place in the gear unit puts at {middle * 1e3:.6g} mm"
            )
            log.refuse(gear, "u_coordinate_on_shaft", reason)
        return middle
    if coordinate is not None and face_width is not None and before_1_1(model.version):
        return coordinate + 0.5 * face_width
    return coordinate


def _along(
    model: RexsModel, log: AttributeLog, part: Component, shaft: Component, target: str
) -> float | None:
    """Distance of a part from the start of its shaft along the axis, where both refer to the same coordinates."""
    frames = [_reference(component) for component in (part, shaft)]
    if frames[0] is None or frames[0] != frames[1] or not model.has(frames[0]):
        return None
    origin, axis = place_of(shaft, log, f"shafts[{shaft.id}]")
    place = log.vector(part, "support_vector", "mm", target)
    if origin is None or axis is None or place is None:
        return None
    return fsum((there - here) * along for there, here, along in zip(place, origin, axis, strict=True))


def _reference(component: Component) -> int | None:
    found = component.attribute("reference_component_for_position")
    try:
        return found.whole_number() if found else None
    except AttributeValueError:
        return None
