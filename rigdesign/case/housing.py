"""Geometry of a gearbox housing and what its surfaces exchange heat with."""

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import Field, model_validator

from rigdesign.case.fields import (
    Clearance,
    Gap,
    HeatTransferCoefficient,
    Length,
    Name,
    Offset,
    Part,
    Size,
    Temperature,
    TemperatureDifference,
    Text,
    fault,
)
from rigdesign.case.joint import FootContact
from rigdesign.case.mesh import HousingMesh
from thermal.films.law import RADIATION_INCLUDED

Fluid = Literal[
    "ambient",
    "gear_oil_inlet",
    "gear_oil_mean",
    "gear_oil_outlet",
    "bearing_oil_inlet",
    "bearing_oil_mean",
    "bearing_oil_outlet",
]
"""What wets a surface: room air, or the oil of the chamber at inlet, outlet or their mean."""
Medium = Literal["air", "mist"]
"""What a surface of the chamber turns in: dry air at the film temperature, or the mist whose density
``losses.chamber_density`` gives for windage."""


class HousingShaft(Part):
    """A shaft inside the housing; journals are those of its bearings, the seat is the bore of its gear."""

    lateral_position: Offset
    """y of its axis; the pinion usually at minus half the centre distance."""
    seal_diameter: Length
    """Diameter in the partition seals and in the cold sections."""
    outside_diameter: Length
    """Diameter in the end seals and outside the housing."""
    overhang_front: Gap
    """Length that leaves the front end wall; zero for a shaft that ends at its bearing."""
    overhang_rear: Gap
    bore_diameter: Gap = 0.0
    material: Name


class ClampingFieldInput(Part):
    """Plate the gearbox stands on."""

    length: Size
    """Along the shafts."""
    width: Size
    thickness: Length
    material: Name


class _Condition(Part):
    surfaces: tuple[Text, ...] = Field(min_length=1)
    """Surface names; ``*`` stands for any run of characters."""


FilmFactor = Annotated[float, Field(gt=0.0, le=10.0)]
"""Multiplies a film: what it really is, over what its law or the case says."""


class _Correlation(_Condition):
    film_factor: FilmFactor = 1.0
    """Multiplies the film: with a range it stands for the scatter of the correlation."""


class NiemannWinter(_Correlation):
    """Housing to room air, alpha = f_k (10 + 0.07 dT) h^-0.15 (Niemann/Winter; P2, Formula 2)."""

    law: Literal["niemann_winter"]
    draught_factor: float = Field(default=1.0, gt=0.0, le=5.0)
    """f_k: 1 in still room air."""
    height: Size | None = None
    """h; the height of the housing when left out."""


class RecknagelPlate(_Correlation):
    """Horizontal plate to still room air."""

    law: Literal["recknagel_plate"]
    correlation: Literal["dimensional", "turbulent"] = "dimensional"
    """dimensional: 2.0 dT^(1/4); turbulent: Nu = 0.125 Ra^(1/3)."""


class IsoTr14179(_Correlation):
    """Housing to room air by ISO/TR 14179-2, free convection."""

    law: Literal["iso_tr_14179_2"]
    height: Size | None = None
    """The height of the housing when left out."""


class VerticalPlate(_Correlation):
    """Vertical wall to still room air (Churchill and Chu, as the VDI Heat Atlas has it); no radiation in it."""

    law: Literal["vertical_plate"]
    height: Size | None = None
    """The height of the housing when left out."""


class HorizontalPlate(_Correlation):
    """Horizontal plate to still room air; no radiation in it."""

    law: Literal["horizontal_plate"]
    correlation: Literal["mcadams", "vdi", "rohsenow"] = "mcadams"
    length: Size
    """Characteristic length: area over perimeter."""
    facing: Literal["up", "down"] = "up"
    """Side of the plate the air is on."""


class TakenFrom(Part):
    """Where a printed coefficient to room air was read: at an assumed temperature difference, from a film law."""

    temperature_difference: TemperatureDifference
    """Wall above air that was assumed; the run warns when it comes out otherwise."""
    law: Literal["niemann_winter", "recknagel_plate", "iso_tr_14179_2"] | None = None
    """Film law it was read from: tells what the coefficient would have been, and whether it holds radiation."""
    height: Size | None = None
    """h: height of the housing, for niemann_winter and iso_tr_14179_2."""


class ConstantFilm(_Condition):
    """A given heat transfer coefficient to a fluid."""

    law: Literal["constant_film"]
    heat_transfer_coefficient: HeatTransferCoefficient
    fluid: Fluid
    taken_from: TakenFrom | None = None
    """For a printed coefficient to room air: what it was read from."""
    fluid_temperature: Temperature | None = None
    """Overrides the temperature of the fluid."""
    film_factor: FilmFactor = 1.0
    """Multiplies the coefficient."""


class FlankFilm(_Condition):
    """Rim of a gear that stands for its teeth: the oil the jets lay on the flanks, tooth as a fin."""

    law: Literal["flank_film"]
    correlation: Literal["fling_off", "jet_renewal", "constant"] = "fling_off"
    """fling_off: laid by every jet and flung off; jet_renewal: stays until the next jet, an upper bound; constant:
    ``heat_transfer_coefficient`` on the flanks."""
    wetted_share: float = Field(default=1.0, gt=0.0, le=1.0)
    """Outer share of the tooth height that the oil reaches."""
    film_factor: FilmFactor = 1.0
    """Multiplies the film."""
    heat_transfer_coefficient: HeatTransferCoefficient | None = None
    """Mean over all flanks, for ``constant``."""


class HorizontalCylinder(_Correlation):
    """Shaft at rest in still room air (Churchill and Chu); diameter from the shaft."""

    law: Literal["horizontal_cylinder"]


class RotatingCylinder(_Correlation):
    """Rotating shaft in air or oil mist; diameter and speed from the shaft."""

    law: Literal["rotating_cylinder"]
    correlation: Literal["becker", "jungnickel", "kays_bjorklund", "etemad", "dropkin_carmi"] = "becker"
    """becker, etemad, dropkin_carmi: air at the film temperature; kays_bjorklund: with buoyancy, down to standstill;
    jungnickel: constants of air near room temperature."""
    fluid: Fluid
    medium: Medium = "air"


class RotatingDisc(_Correlation):
    """Rotating end or gear face in air or oil mist; radius and speed from the shaft."""

    law: Literal["rotating_disc"]
    correlation: Literal["kreith", "jungnickel"] = "kreith"
    """kreith: air at the film temperature; jungnickel: constants of air near room temperature."""
    fluid: Fluid
    medium: Medium = "air"


class BearingFilm(_Condition):
    """Bore or journal to the lubricant film: conductance of the film, sink at film temperature."""

    law: Literal["bearing_film"]
    film_factor: FilmFactor = 1.0
    """Multiplies the conductance between film and wall, not what the film carries or heats."""


class ThermalRadiation(_Condition):
    """Grey radiation to large surroundings; may stand beside a film on the same surface."""

    law: Literal["radiation"]
    emissivity: float = Field(gt=0.0, le=1.0)
    emissivity_excess: float = Field(default=0.0, ge=-1.0, le=1.0)
    """What the surface has beyond ``emissivity``: it counts even where a film to room air stands for the rest."""
    surroundings_temperature: Temperature | None = None
    """Walls of the room; ambient when left out."""

    @model_validator(mode="after")
    def _grey(self) -> "ThermalRadiation":
        whole = self.emissivity + self.emissivity_excess
        if not 0.0 <= whole <= 1.0:
            raise fault(
                f"emissivity and emissivity_excess add up to {whole:g}, outside of 0 to 1",
                f"write an excess within {-self.emissivity:g} and {1.0 - self.emissivity:g}",
            )
        return self


class GapExchange(_Correlation):
    """Heat across a narrow rotating gap from each surface to its partner (area means)."""

    law: Literal["narrow_gap"]
    correlation: Literal["becker_kaye", "jungnickel"] = "becker_kaye"
    """becker_kaye: air at the mean temperature, with the onset of vortices; jungnickel: constants of air near room
    temperature."""
    partner: Text
    """Surface on the other side; ``*`` is filled with what it stood for in ``surfaces``."""
    gap: Clearance | None = None
    """The radial gap of the seals of the shaft when left out."""


class SeriesExchange(_Condition):
    """Heat from a rotating shaft through air to a wall: two films in series (P2, Formula 3)."""

    law: Literal["series_films"]
    partner: Text
    coefficients: tuple[HeatTransferCoefficient, HeatTransferCoefficient]
    """Film on the surface, film on the partner."""
    film_factor: FilmFactor = 1.0
    """Multiplies the conductance of both in series."""


class FixedTemperature(_Condition):
    """A surface held at one temperature."""

    law: Literal["fixed_temperature"]
    temperature: Temperature


class Insulated(_Condition):
    """A surface that passes no heat."""

    law: Literal["insulated"]


PlateFilm = NiemannWinter | RecknagelPlate | IsoTr14179 | VerticalPlate | HorizontalPlate
"""Film between a still wall or plate and room air."""
ShaftFilm = HorizontalCylinder | RotatingCylinder | RotatingDisc
"""Film that takes its diameter from a shaft or gear."""

Condition = Annotated[
    NiemannWinter
    | RecknagelPlate
    | IsoTr14179
    | VerticalPlate
    | HorizontalPlate
    | ConstantFilm
    | FlankFilm
    | HorizontalCylinder
    | RotatingCylinder
    | RotatingDisc
    | BearingFilm
    | ThermalRadiation
    | GapExchange
    | SeriesExchange
    | FixedTemperature
    | Insulated,
    Field(discriminator="law"),
]
"""One boundary condition; ``law`` says which."""


def holds_radiation(condition: Condition) -> bool:
    """Whether a film to room air is of the size of convection and radiation together."""
    if isinstance(condition, ConstantFilm):
        return condition.taken_from is not None and condition.taken_from.law in RADIATION_INCLUDED
    return condition.law in RADIATION_INCLUDED


class Housing(Part):
    """A box with a warm chamber between two cold sections, on a clamping field.

    x runs along the shafts from front to rear, y from pinion to wheel, z up.
    """

    warm_length: Size
    """Clear length of the warm chamber, between the partitions."""
    cold_length_front: Size
    cold_length_rear: Size
    width: Size
    height: Size
    wall_thickness: Length
    floor_thickness: Length
    top_thickness: Length
    partition_thickness: Length
    end_wall_thickness: Length
    """Walls that carry the bearings."""
    end_seal_width: Length
    """Length of the end seal outside of each bearing."""
    shaft_height: Size
    """Height of the shaft axes above the clamping field."""
    material: Name
    field: ClampingFieldInput
    foot_contact: FootContact | None = None
    """Joint between foot and field; perfect contact when left out, which the report lists as an assumption."""
    mesh: HousingMesh = HousingMesh()
    """Element sizes by zone where the usual ones do not do."""
    mesh_file: Text | None = None
    """A gmsh .msh beside the case file in place of the parametric box: 10-node tetrahedra or hexahedra of 20 or
    27 nodes, in metres, physical volumes named like the bodies of the box, physical surfaces with the names that
    ``boundary`` covers, every boundary facet in one of them; ``rigdesign mesh CASE --out DIR`` writes an example.
    A housing alone will do where heat goes nowhere else: the body ``housing`` is always needed, ``gear_<shaft>_rim``
    for heat of the mesh into the gears (or ``flank_film``), body ``gear_<shaft>`` for windage into the gears, the
    ``seal_bore_…`` and ``shaft_<shaft>_seal_…`` for heat of the seals into housing and shaft (``heat_split``), and
    ``field``, ``housing_foot`` and ``field_seat`` for a ``foot_contact``. Heights of films, diameters and speeds of
    shafts stay those of this table; clearances are read where bearings, shafts and gears carry the names of the box."""
    shafts: Mapping[Name, HousingShaft] = Field(min_length=1)
    boundary: Mapping[Name, Condition] = Field(min_length=1)
    ambient_film_factor: FilmFactor = 1.0
    """Multiplies every film to room air, beside the ``film_factor`` of each: draught, a stuffy corner."""
    bearing_film_factor: FilmFactor = 1.0
    """Multiplies the conductance between every bearing film and its walls, beside the ``film_factor`` of each."""
    radiation_included: bool
    """True: a Niemann/Winter film to room air already contains radiation, explicit radiation of those surfaces is
    left out of the verdicts; the other reading is computed beside it. Other films hold none: beside them explicit
    radiation stays."""
