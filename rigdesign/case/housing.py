"""Geometry of a gearbox housing and what its surfaces exchange heat with."""

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Annotated, Literal, TypeAlias

from pydantic import Field, model_validator

from rigdesign.case.fields import (
    Conductance,
    Conductivity,
    Flow,
    Gap,
    HeatTransferCoefficient,
    Length,
    Name,
    Offset,
    Part,
    Power,
    Pressure,
    Share,
    Size,
    Small,
    Stress,
    Temperature,
    Text,
    Usual,
    fault,
)
from rigdesign.case.films import FilmFactor, matched
from rigdesign.case.surface_conditions import Condition
from rigdesign.properties.fluid import ATMOSPHERE
from thermal.housing.face_rules import Box, Cylinder, FaceRule, Plane

if TYPE_CHECKING:
    from thermal.films.law import ExchangeLaw

# Fluids of a housing besides its oil and room air: volumes of one temperature, streams, and what links them.
#
# A film of ``boundary`` names one of them as its fluid. Their temperatures are unknowns of the temperature field.

LINKED = ("ambient", "gear_oil", "bearing_oil")
"""What a volume may be linked to besides other volumes: room air, the oils as they leave the chamber."""


class HousingVolume(Part):
    """Air, mist or oil at rest in the housing, of one temperature that follows from its films, links and power."""

    power: Power = 0.0
    """Heat set free in it."""


class HousingStream(Part):
    """A stream along surfaces of the housing that warms up on its way (plug flow): jacket, oil gallery, air duct.

    Over time it runs through all phases, warm-up and cooling down included.
    """

    flow: Flow
    """Volume flow at the inlet."""
    inlet_temperature: Temperature
    """As it enters."""
    medium: Text
    """Oil of the case, or a fluid by its name in CoolProp, such as ``Water`` or ``Air``."""
    pressure: Pressure = ATMOSPHERE
    """Absolute, for a fluid of CoolProp."""
    surfaces: tuple[Text, ...] = ()
    """Its surfaces in the order in which it passes them; that of ``boundary`` when left out."""


class HousingLink(Part):
    """Heat exchange between a volume and another volume, room air or an oil."""

    between: tuple[Name, Name]
    """Two volumes, or a volume and ``ambient``, ``gear_oil`` or ``bearing_oil`` (as they leave the chamber)."""
    conductance: Conductance | None = None
    """Heat per kelvin between the two."""
    flow: Flow | None = None
    """In place of it: volume flow that goes each way, as of a breather or an opening, at room temperature."""
    medium: Text | None = None
    """What flows: oil of the case, or a fluid by its name in CoolProp; needed with ``flow``."""

    @model_validator(mode="after")
    def _conducts(self) -> "HousingLink":
        if (self.conductance is None) == (self.flow is None):
            raise fault(
                "needs either a conductance or a flow",
                'write conductance = "5 W/K", or flow with its medium',
            )
        if (self.flow is None) != (self.medium is None):
            raise fault("flow and medium go together", 'write both, e.g. medium = "Air"')
        return self


# Chambers of a housing whose surfaces radiate at each other.

Chamber = Literal["warm", "cold_front", "cold_rear"]
"""A chamber of the box."""
IN_CHAMBER: Mapping[Chamber, tuple[str, ...]] = {
    "warm": (
        "chamber_*", "partition_warm_*", "end_wall_*", "shaft_*_warm", "gear_*_rim", "gear_*_side_*",
    ),
    "cold_front": ("cold_wall_front", "cold_floor_front", "partition_cold_front", "shaft_*_cold_front"),
    "cold_rear": ("cold_wall_rear", "cold_floor_rear", "partition_cold_rear", "shaft_*_cold_rear"),
}  # fmt: skip
"""Surfaces of each chamber."""
OILED = 0.82
"""Emissivity of a thick film of oil on polished steel (P2, heat transfers within the test gear unit)."""


class RadiatingPart(Part):
    """Surfaces of an enclosure with an emissivity of their own."""

    surfaces: tuple[Text, ...] = Field(min_length=1)
    """Surface names; ``*`` stands for any run of characters."""
    emissivity: Annotated[Share, Usual(0.1, 1.0)]
    """Emissivity of the grey surface; 0 for one that gives back all that arrives (re-radiating, no net heat)."""


class EnclosureInput(Part):
    """Surfaces that radiate at each other, grey and diffuse, each with one radiosity.

    Films and gap exchange of the surfaces stay; the gas between them neither absorbs nor emits.
    """

    chamber: Chamber | None = None
    """Chamber of the box whose walls, shafts and gears take part; left out, only ``parts`` do."""
    emissivity: Annotated[Share, Usual(0.1, 1.0)] | None = None
    """Emissivity of the surfaces of the chamber that no part names; 0.82, oil on polished steel, when left out, which
    the report lists as an assumption."""
    parts: Mapping[Name, RadiatingPart] = {}
    """Surfaces with an emissivity of their own, by any name; in addition to the chamber or as its exception."""
    view_factors: Literal["computed"] | Mapping[Name, Mapping[Name, Share]] = "computed"
    """computed: by rays between the surfaces as they are meshed, hidden by all that stands between them; or a table
    surface -> surface -> share of its radiation that arrives there; a pair named in one direction holds in the other by
    reciprocity. Both are closed by reciprocity and summation."""
    opening_temperature: Temperature | None = None
    """Surroundings behind an opening, which take what the view factors of the surfaces leave to one; a closed
    chamber when left out."""

    @model_validator(mode="after")
    def _has_surfaces(self) -> "EnclosureInput":
        if self.chamber is None and not self.parts:
            raise fault("has no surfaces", 'add chamber = "warm", or parts with their surfaces')
        if self.chamber is None and self.emissivity is not None:
            raise fault(
                "emissivity is that of a chamber, and none is named",
                "add chamber, or write the emissivity into the parts",
            )
        return self

    def emissivities(self, names: Iterable[str]) -> dict[str, float]:
        """Surface -> emissivity of everything that takes part, among surfaces with ``names``."""
        known = tuple(names)
        usual = OILED if self.emissivity is None else self.emissivity
        patterns = () if self.chamber is None else IN_CHAMBER[self.chamber]
        found = {surface: usual for surface in known if surface in matched(patterns, known)}
        for part in self.parts.values():
            found |= dict.fromkeys(matched(part.surfaces, known), part.emissivity)
        return found

    def rows(self, areas: Mapping[str, float]) -> tuple[tuple[float, ...], ...] | None:
        """The given view factors as a matrix between surfaces with ``areas`` [m2]; None where they are computed.

        What the table says in one direction only holds in the other by reciprocity, A_i F_ij = A_j F_ji.
        """
        if self.view_factors == "computed":
            return None
        given = self.view_factors

        def factor(name: str, other: str) -> float:
            if other in given.get(name, {}):
                return given[name][other]
            return given.get(other, {}).get(name, 0.0) * areas[other] / areas[name]

        return tuple(tuple(factor(name, other) for other in areas) for name in areas)


# Rules of a case that give the faces of a STEP file their names.

Place = tuple[Offset, Offset, Offset]
"""x, y and z in the frame of the STEP file."""
Direction = tuple[float, float, float]
"""x, y and z of a direction; its length does not count."""


class FacePlane(Part):
    """Faces in a plane."""

    point: Place
    """Any point of the plane."""
    normal: Direction
    """Direction across it, in either sense."""

    @model_validator(mode="after")
    def _has_direction(self) -> "FacePlane":
        _require_direction("normal", self.normal)
        return self


class FaceCylinder(Part):
    """Faces on a cylinder, bore or boss."""

    point: Place
    """Any point of the axis."""
    direction: Direction = (1.0, 0.0, 0.0)
    """Direction of the axis; along the shafts when left out."""
    radius: Length
    """Of the cylinder."""

    @model_validator(mode="after")
    def _has_direction(self) -> "FaceCylinder":
        _require_direction("direction", self.direction)
        return self


class FaceBox(Part):
    """Faces that lie wholly inside a box along x, y and z."""

    low: Place
    """Corner of least x, y and z."""
    high: Place
    """Corner of greatest x, y and z."""

    @model_validator(mode="after")
    def _starts_before_it_ends(self) -> "FaceBox":
        if any(low > high for low, high in zip(self.low, self.high)):
            raise fault("the box ends before it starts", "write the lesser of each coordinate in low")
        return self


class FaceSelection(Part):
    """Faces that meet everything this entry says; several entries of a surface add up."""

    plane: FacePlane | None = None
    """In this plane."""
    cylinder: FaceCylinder | None = None
    """On this cylinder."""
    box: FaceBox | None = None
    """Inside this box."""

    @model_validator(mode="after")
    def _says_something(self) -> "FaceSelection":
        if self.plane is None and self.cylinder is None and self.box is None:
            raise fault("says nothing of its faces", "add plane, cylinder or box")
        return self

    @property
    def rule(self) -> FaceRule:
        """The same as the solver reads it."""
        shapes: list[Plane | Cylinder | Box] = []
        if self.plane is not None:
            shapes.append(Plane(self.plane.point, self.plane.normal))
        if self.cylinder is not None:
            shapes.append(Cylinder(self.cylinder.point, self.cylinder.direction, self.cylinder.radius))
        if self.box is not None:
            shapes.append(Box(self.box.low, self.box.high))
        return FaceRule(tuple(shapes))


def _require_direction(key: str, direction: Direction) -> None:
    length = math.hypot(*direction)
    if not (math.isfinite(length) and length > 0.0):
        raise fault(f"{key} = {list(direction)} has no length", f"write a direction, e.g. {key} = [1, 0, 0]")


SMALLEST = 1e-3
"""Least element size [m]; below it a gearbox has millions of nodes."""
PARTITIONS = ("cold_length_front", "cold_length_rear", "partition_thickness")
"""Keys of a housing with partitions: all of them or none."""


class HousingMesh(Part):
    """Element size by zone at standard fidelity; quick and reference keep their usual ratio to it.

    A zone that is left out takes its size from that of the whole box. Bores and shafts are never divided into
    fewer elements a turn than the fidelity asks for.
    """

    walls: Length | None = None
    """Largest elements in the walls of the housing."""
    field: Length | None = None
    """Largest elements at the outer edges of the clamping field; under the foot the size of the walls holds."""
    seals: Length | None = None
    """Largest elements on bores and shafts of the seals."""
    bearings: Length | None = None
    """Largest elements on bearing bores, bosses and journals."""
    gears: Length | None = None
    """Largest elements on gears and their seats."""

    @model_validator(mode="after")
    def _feasible(self) -> "HousingMesh":
        if small := [zone for zone, size in self.sizes().items() if size < SMALLEST]:
            raise fault(
                f"element size of {', '.join(small)} is below {1e3 * SMALLEST:g} mm",
                "write a larger one; second-order elements need one layer in a wall",
            )
        return self

    def sizes(self) -> dict[str, float]:
        """Given sizes [m] by the zone's name in thermal.housing.solids.MeshSizes."""
        zones = {"wall": self.walls, "field": self.field, "seal": self.seals, "bearing": self.bearings}
        zones["gear"] = self.gears
        return {zone: size for zone, size in zones.items() if size is not None}


AIR_JUMP = 0.37e-6
"""Temperature jump length of air at one atmosphere [m] (Yovanovich 2005)."""


class PressedJoint(Part):
    """Two rough metal faces under pressure (Cooper, Mikic, Yovanovich 1969)."""

    pressure: Stress
    """Mean contact pressure of the joint."""
    roughness: Small
    """Root of the sum of both squared rms roughnesses."""
    slope: Annotated[float, Field(gt=0.0, le=1.0)]
    """Root of the sum of both squared mean slopes of the asperities; 0.05 to 0.3 for machined faces."""
    hardness: Stress
    """Micro-hardness of the softer side."""
    filling_conductivity: Conductivity | None = None
    """Thermal conductivity of oil or grease between the faces; dry air when left out."""

    @model_validator(mode="after")
    def _rough(self) -> "PressedJoint":
        if self.roughness == 0.0:
            raise fault("roughness is zero", "write the rms roughness of both faces, e.g. 3 um")
        return self

    def law(self, conductivities: tuple[float, float], air: float) -> "ExchangeLaw":
        """Conductance between solids of two conductivities, in air of another one [W/(m K)]."""
        from thermal.films.joint_conductance import GapFilling, RoughContact, pressed_joint

        contact = RoughContact(
            pressure=self.pressure, hardness=self.hardness, roughness=self.roughness, slope=self.slope
        )
        dry = self.filling_conductivity is None
        filling = GapFilling(
            conductivity=self.filling_conductivity or air, gas_parameter=AIR_JUMP if dry else 0.0
        )
        return pressed_joint(contact, conductivities, filling)


FootJoint: TypeAlias = PressedJoint
"""Joint of any kind, each with the ``law`` of its conductance; a further kind joins here."""


class FootContact(Part):
    """Foot and field as bodies that touch: a measured or assumed conductance, or the joint it follows from."""

    conductance: HeatTransferCoefficient | None = None
    """Heat flux per kelvin between foot and field."""
    joint: FootJoint | None = None
    """Joint of two rough faces from which the conductance follows."""

    @model_validator(mode="after")
    def _one(self) -> "FootContact":
        if (self.conductance is None) == (self.joint is None):
            given = "neither" if self.conductance is None else "both"
            raise fault(f"{given} of conductance and joint is given", "write one of the two")
        return self


class HousingShaft(Part):
    """A shaft inside the housing; journals are those of its bearings, the seat is the bore of its gear."""

    lateral_position: Offset
    """y of its axis; the pinion usually at minus half the centre distance."""
    seal_diameter: Annotated[Length, Usual(0.4, 2.5, "shaft diameter")] | None = None
    """Diameter in the partition seals and in the cold sections; left out in a housing without partitions."""
    outside_diameter: Annotated[Length, Usual(0.4, 2.5, "shaft diameter")]
    """Diameter in the end seals and outside the housing."""
    overhang_front: Annotated[Gap, Usual(0.15, 4.0, "shaft diameter")]
    """Length that leaves the front end wall; zero for a shaft that ends at its bearing."""
    overhang_rear: Annotated[Gap, Usual(0.15, 4.0, "shaft diameter")]
    """Length that leaves the rear end wall; zero for a shaft that ends at its bearing."""
    bore_diameter: Annotated[Gap, Usual(0.1, 1.0, "shaft diameter")] = 0.0
    """Bore through the shaft; zero for a solid one."""
    material: Name
    """Built-in material or a name under ``materials``."""


class ClampingFieldInput(Part):
    """Plate the gearbox stands on."""

    length: Annotated[Size, Usual(1.8, 26.0, "centre distance")]
    """Length of the plate along the shafts."""
    width: Annotated[Size, Usual(1.8, 26.0, "centre distance")]
    """Width of the plate across the shafts."""
    thickness: Annotated[Length, Usual(0.2, 5.0, "centre distance")]
    """Height of the plate."""
    material: Name
    """Built-in material or a name under ``materials``."""


class Housing(Part):
    """A box on a clamping field: a warm chamber between two cold sections, or one chamber without partitions.

    x runs along the shafts from front to rear, y from pinion to wheel, z up.
    """

    warm_length: Annotated[Size, Usual(0.3, 4.0, "centre distance")]
    """Clear length of the warm chamber, between the partitions; without partitions from end wall to end wall."""
    cold_length_front: Annotated[Size, Usual(0.1, 4.0, "centre distance")] | None = None
    """Clear length of the front cold section, between end wall and partition. Left out together with
    ``cold_length_rear`` and ``partition_thickness``: one chamber, its end walls carry the bearings and stand in it."""
    cold_length_rear: Annotated[Size, Usual(0.1, 4.0, "centre distance")] | None = None
    """Clear length of the rear cold section, between partition and end wall."""
    width: Annotated[Size, Usual(1.2, 9.0, "centre distance")]
    """Outer width, across the shafts."""
    height: Annotated[Size, Usual(1.0, 9.0, "centre distance")]
    """Outer height above the clamping field."""
    wall_thickness: Annotated[Length, Usual(0.02, 0.5, "centre distance")]
    """Thickness of the two side walls."""
    floor_thickness: Annotated[Length, Usual(0.025, 0.5, "centre distance")]
    """Thickness of the floor."""
    top_thickness: Annotated[Length, Usual(0.02, 0.5, "centre distance")]
    """Thickness of the top."""
    partition_thickness: Annotated[Length, Usual(0.02, 0.5, "centre distance")] | None = None
    """Thickness of the walls between warm chamber and cold sections: length of their seals."""
    end_wall_thickness: Annotated[Length, Usual(0.05, 1.5, "centre distance")]
    """Thickness of the walls that carry the bearings."""
    end_seal_width: Annotated[Length, Usual("2.5 mm", "40 mm")]
    """Length of the end seal outside of each bearing."""
    shaft_height: Annotated[Size, Usual(0.5, 5.0, "centre distance")]
    """Height of the shaft axes above the clamping field."""
    material: Name
    """Built-in material or a name under ``materials``."""
    field: ClampingFieldInput
    """Plate the gearbox stands on."""
    foot_contact: FootContact | None = None
    """Joint between foot and field; perfect contact when left out, which the report lists as an assumption."""
    bearing_seats: Literal["rigid", "elastic"] = "rigid"
    """elastic: bearing seats of bending shafts have the radial and axial stiffness and mass condensed from the mesh of
    the housing, bolted down at its foot; rigid: only a ``support_stiffness`` stated for a bearing is elastic."""
    mesh: HousingMesh = HousingMesh()
    """Element sizes by zone where the usual ones do not do."""
    mesh_file: Text | None = None
    """A gmsh .msh next to the case file in place of the parametric box: 10-node tetrahedra or hexahedra of 20 or
    27 nodes, in metres, physical volumes named like the bodies of the box, physical surfaces with the names that
    ``boundary`` covers, every boundary facet in one of them; ``rigdesign mesh CASE --out DIR`` writes an example.
    A housing alone will do: shafts and gears that it lacks and whose surfaces have conditions are drawn from the
    tables, others are left out, and no heat may go there (``heat_split``). A ``foot_contact`` draws the field under
    ``housing_foot`` where it is lacking. The body ``housing`` is always needed. Heights of films, diameters and speeds
    of shafts stay those of this table; clearances are read where bearings, shafts and gears carry the names of the
    box and journals stand in their bores."""
    step_file: Text | None = None
    """A STEP file next to the case file in place of the parametric box: one closed solid, the body ``housing``, meshed
    at the fidelity of the run, in the frame of the box (x along the shafts from the front end, z up from the foot). Its
    faces have the names that ``boundary`` covers, in the file or by ``faces``; shafts and gears are drawn from the
    tables, and the field with a ``foot_contact``."""
    faces: Mapping[Name, Annotated[tuple[FaceSelection, ...], Field(min_length=1)]] = {}
    """Surface -> which faces of the STEP file it is, where they have no names there. Each entry adds the faces that
    meet all it says: ``plane = { point = ["0 mm", "0 mm", "15 mm"], normal = [0, 0, 1] }``, ``cylinder = { point = …,
    direction = [1, 0, 0], radius = "40 mm" }``, ``box = { low = […], high = […] }``. ``rigdesign mesh CASE --out DIR``
    draws the part with its faces numbered."""
    shafts: Mapping[Name, HousingShaft] = Field(min_length=1)
    """Shafts in the housing by name, each with two bearings and a seal."""
    boundary: Mapping[Name, Condition] = Field(min_length=1)
    """Boundary conditions by name: every surface needs one."""
    enclosures: Mapping[Name, EnclosureInput] = {}
    """Chambers whose surfaces radiate at each other, by name; none when left out: walls, shafts and gears then
    exchange heat through films and bodies only."""
    volumes: Mapping[Name, HousingVolume] = {}
    """Air, mist or oil at rest in the housing, whose temperature is found with the field; ``boundary`` films name them
    as their fluid."""
    streams: Mapping[Name, HousingStream] = {}
    """Streams along surfaces of the housing, as through a jacket; ``boundary`` films name them as their fluid."""
    links: Mapping[Name, HousingLink] = {}
    """Heat exchange of volumes with each other, room air and oils."""
    ambient_film_factor: FilmFactor = 1.0
    """Multiplies every film to room air on top of the ``film_factor`` of each: draught, a badly ventilated place."""
    surface_film_factors: Mapping[Name, FilmFactor] = {}
    """Surface -> multiplies its film to room air on top of that: a draught on one wall."""
    bearing_film_factor: FilmFactor = 1.0
    """Multiplies the conductance between every bearing film and its walls on top of the ``film_factor`` of each."""
    radiation_included: bool
    """True: a Niemann/Winter film to room air already contains radiation, explicit radiation of those surfaces is
    left out of the verdicts; the other reading is computed as well. Other films contain none: with them explicit
    radiation stays."""

    @property
    def part_file(self) -> str | None:
        """The file in place of the parametric box: of a mesh or STEP; None for the box."""
        return self.mesh_file or self.step_file

    @property
    def one_chamber(self) -> bool:
        """Whether it has no partitions."""
        return self.partition_thickness is None

    @model_validator(mode="after")
    def _one_file(self) -> "Housing":
        if self.mesh_file is not None and self.step_file is not None:
            raise fault("mesh_file and step_file both stand for the box", "remove one of them")
        if self.faces and self.step_file is None:
            raise fault(
                "faces name those of a STEP file, and there is none", "add step_file, or remove faces"
            )
        return self

    @model_validator(mode="after")
    def _all_partitions_or_none(self) -> "Housing":
        missing = [key for key in PARTITIONS if getattr(self, key) is None]
        if missing and len(missing) < len(PARTITIONS):
            raise fault(
                f"{', '.join(missing)} missing beside {', '.join(key for key in PARTITIONS if key not in missing)}",
                "write all three for a housing with partitions, or none of them for one chamber",
            )
        return self
