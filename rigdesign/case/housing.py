"""Geometry of a gearbox housing and what its surfaces exchange heat with."""

import math
from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import Field, model_validator

from rigdesign.case.enclosures import EnclosureInput
from rigdesign.case.fields import (
    Conductivity,
    Gap,
    HeatTransferCoefficient,
    Length,
    Name,
    Offset,
    Part,
    Size,
    Small,
    Stress,
    Text,
    Usual,
    fault,
)
from rigdesign.case.films import FilmFactor
from rigdesign.case.housing_fluids import HousingLink, HousingStream, HousingVolume
from rigdesign.case.surface_conditions import Condition
from thermal.housing.face_rules import Box, Cylinder, FaceRule, Plane

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


class FootContact(Part):
    """Foot and field as bodies that touch: a measured or assumed conductance, or the joint it follows from."""

    conductance: HeatTransferCoefficient | None = None
    """Heat flux per kelvin between foot and field."""
    joint: PressedJoint | None = None
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
