"""A gear unit in neutral terms: what a REXS model says of gears, shafts, bearings, couplings, oil and loads, in SI.

Lengths [m], angles [rad], temperatures [K], speeds [rad/s]; parts are named by their REXS id. None stands for what the
file does not state or states unusably. Positions count along the shaft from its start, in the direction of its axis.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

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
