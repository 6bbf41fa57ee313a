"""The file of a housing in place of the parametric box, mesh or STEP: read once, held against the case.

Shafts and gears that the file lacks and of which ``boundary`` speaks are drawn from the tables of the case, as in the
box, and so is the field under a foot with a ``foot_contact``.
"""

from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import Path

import numpy as np

from rigdesign.base.errors import CaseError, Fault
from rigdesign.base.files import check_regular
from rigdesign.base.units import show
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.geometry import conditions_of
from rigdesign.case.housing import Housing
from rigdesign.case.model import Case
from rigdesign.case.rules.surfaces import boundary_faults
from thermal.fe.kept_results import kept
from thermal.fe.mesh import MeshError, NamedMesh, disjoint_union
from thermal.housing.face_rules import FaceRule
from thermal.housing.gearbox import build_field, build_shaft
from thermal.housing.geometry import HousingGeometry
from thermal.housing.housing_surfaces import FOOT, body_names, joined_surfaces
from thermal.housing.mesh_file import read_mesh
from thermal.housing.shaft_geometry import MINIMUM_LAND, SIDES, ShaftGeometry
from thermal.housing.shaft_surfaces import shaft_faces
from thermal.housing.solids import MeshSizes
from thermal.housing.stations import (
    ROUND,
    GearboxModel,
    Point,
    bearing_stations,
    fit_cylinder,
    fitted_model,
    seal_stations,
)
from thermal.housing.step_file import BODY, StepPart, part_size, read_part, read_step

LARGEST_MESH = 2_000_000_000
"""Bytes of a mesh file; a gearbox of a million nodes has a tenth."""
LARGEST_STEP = 200_000_000
"""Bytes of a STEP file; a gearbox with every fillet has a tenth."""
LARGEST_RATIO, BORE_RATIO, PLACE_RATIO, AXES_RATIO = 2.0, 1.5, 1.5, 1.05
"""Of width and height, of diameters of bores, and of the distances of bearings and of axes, found in a part over those
of the case: feet, bushes and covers are in it, no other unit."""
MOST_NAMED = 4
"""Measures that a fault names one by one."""
SAME_FACTOR = 1.25
"""Of the ratios of all measures to their median, up to which one factor brings the part to its size."""

NamedRules = tuple[tuple[str, tuple[FaceRule, ...]], ...]
"""Rules that pick faces, by surface."""


def user_model(
    case: Case, name: str, part_file: str, geometry: HousingGeometry, sizes: MeshSizes
) -> GearboxModel:
    """Model of the mesh or STEP file of gearbox ``name``, next to the file of its case.

    sizes : of the elements of a STEP file

    Raises
    ------
    CaseError
        A file that is no mesh or part to compute with, one that lacks a part into which the case lets heat go, bodies
        without a material, surfaces without a condition or conditions without a surface, a part of another size than
        the case says.
    """
    gearbox, housing = case.gearboxes[name], case.housings[name]
    key = "mesh_file" if housing.mesh_file is not None else "step_file"
    at, given = f"gearboxes.{name}.housing.{key}", f'"{part_file}"'
    file = case.path.parent / part_file
    with _file_faults(at, given, case.path):
        check_regular(file, LARGEST_MESH if key == "mesh_file" else LARGEST_STEP)
        step = key == "step_file"
        if step and (wrong := _size_faults(at, given, _outside(housing, part_size(file)))):
            raise CaseError(wrong, str(case.path))  # meshed by mistake it would never end
        part = _Part(file, file.stat().st_mtime_ns, _face_rules(housing), sizes.wall, sizes.circle, step)
        mesh = _read(part)
        if wrong := _size_faults(at, given, _measures(mesh, geometry, housing)):
            raise CaseError(wrong, str(case.path))
        drawn = _Drawn(_drawn_shafts(housing, geometry, mesh), _foot_width(geometry, mesh))
        model = _whole(part, geometry, drawn, sizes)
    faults = _part_faults(at, given, gearbox, geometry, model)
    joined = joined_surfaces(geometry)
    surfaces = tuple(surface for surface in model.mesh.surfaces if surface not in joined)
    if faults := [*faults, *boundary_faults(name, gearbox, housing, surfaces)]:
        raise CaseError(faults, str(case.path))
    return model


def step_part(case: Case, name: str, step_file: str, size: float) -> StepPart:
    """Faces of the STEP file of gearbox ``name`` with triangles of about ``size`` [m], whether or not all have a name.

    Raises
    ------
    CaseError
        A file that is no part to compute with.
    """
    at, given = f"gearboxes.{name}.housing.step_file", f'"{step_file}"'
    with _file_faults(at, given, case.path):
        file = case.path.parent / step_file
        check_regular(file, LARGEST_STEP)
        return read_part(file, dict(_face_rules(case.housings[name])), size)


@contextmanager
def _file_faults(at: str, given: str, case: Path) -> Iterator[None]:
    """What is wrong with a file as a fault of its key."""
    try:
        yield
    except OSError as error:
        raise CaseError(
            [Fault(at, given, str(error.strerror), "correct the path of the file")], str(case)
        ) from error
    except MeshError as error:
        text, _, remedy = str(error).rpartition("; ")
        raise CaseError([Fault(at, given, text, remedy)], str(case)) from error


def _face_rules(housing: Housing) -> NamedRules:
    """Rules of a housing that pick faces of its STEP file, by surface."""
    return tuple((name, tuple(one.rule for one in own)) for name, own in housing.faces.items())


def _drawn_shafts(housing: Housing, geometry: HousingGeometry, mesh: NamedMesh) -> tuple[ShaftGeometry, ...]:
    """Shafts of the case that the mesh lacks with all their surfaces, and on which a condition stands."""
    drawn = []
    for shaft in geometry.shafts:
        surfaces = [face.name for face in shaft_faces(geometry, shaft)]
        lacking = f"shaft_{shaft.name}" not in mesh.bodies and not mesh.surfaces.keys() & set(surfaces)
        if lacking and conditions_of(housing, surfaces):
            drawn.append(shaft)
    return tuple(drawn)


def _foot_width(geometry: HousingGeometry, mesh: NamedMesh) -> float | None:
    """Width of the foot under which a field is to be drawn [m]; None where the mesh has one or nothing joins it."""
    if not geometry.foot_joint or "field" in mesh.bodies or FOOT not in mesh.surfaces:
        return None
    return 2.0 * float(np.abs(mesh.points[np.unique(mesh.surfaces[FOOT]), 1]).max())


@dataclass(frozen=True)
class _Measure:
    """A length of a part beside that of the case [m].

    most : of their ratio, either way, between a part of another shape and one in another unit
    """

    what: str
    found: float
    stated_as: str
    stated: float
    most: float

    @property
    def ratio(self) -> float:
        """Of the part over the case."""
        return self.found / self.stated

    @property
    def text(self) -> str:
        """Both lengths in words."""
        found, stated = (show(length, "length", digits=4) for length in (self.found, self.stated))
        return f"{self.what} is {found}, {self.stated_as} {stated}"


def _outside(housing: Housing, size: Point) -> list[_Measure]:
    """Width and height of a housing."""
    return [
        _Measure("width", size[1], "housing.width", housing.width, LARGEST_RATIO),
        _Measure("height", size[2], "housing.height", housing.height, LARGEST_RATIO),
    ]


def _measures(mesh: NamedMesh, geometry: HousingGeometry, housing: Housing) -> list[_Measure]:
    """Everything of a part that the case states as well."""
    found = []
    if BODY in mesh.bodies:
        size = np.ptp(mesh.points[np.unique(mesh.cells[mesh.bodies[BODY]])], axis=0).tolist()
        found = _outside(housing, (size[0], size[1], size[2]))
    return [*found, *_bores(mesh, geometry)]


def _bores(mesh: NamedMesh, geometry: HousingGeometry) -> Iterator[_Measure]:
    """Diameters of the bores that the mesh names and that are cylinders about an axis along x, and their distances."""
    corners = mesh.shape.side.n_corners
    fits = {
        one.bore_surface: fit_cylinder(mesh.points[np.unique(mesh.surfaces[one.bore_surface][:, :corners])])
        for one in bearing_stations(geometry)
        if one.bore_surface in mesh.surfaces
    }
    fits = {name: fit for name, fit in fits.items() if fit.roundness <= ROUND}
    found = [one for one in bearing_stations(geometry) if one.bore_surface in fits]
    radii = {
        f"{shaft.name}_{side}": shaft.bearing(side).bore_radius for shaft in geometry.shafts for side in SIDES
    }
    for one in found:
        diameter, needed = 2.0 * fits[one.bore_surface].radius, 2.0 * radii[one.name]
        yield _Measure(f"diameter of {one.bore_surface}", diameter, "its bearing", needed, BORE_RATIO)
    for one, other in combinations(found, 2):
        names = f"distance from {one.bore_surface} to {other.bore_surface}"
        pairs = zip(
            (one.centre, fits[one.bore_surface].centre), (other.centre, fits[other.bore_surface].centre)
        )
        stated, measured = (np.abs(np.subtract(*pair)) for pair in pairs)
        if one.shaft == other.shaft:
            yield _Measure(names, float(measured[0]), "that of its bearings", float(stated[0]), PLACE_RATIO)
        elif stated[0] < MINIMUM_LAND:
            apart = float(np.hypot(*measured[1:]))
            yield _Measure(names, apart, "that of their axes", float(stated[1]), AXES_RATIO)


def _size_faults(at: str, given: str, measures: Collection[_Measure]) -> list[Fault]:
    """A part of another size than the case says, with the factor that fits all its measures, if there is one."""
    wrong = [one for one in measures if not 1.0 / one.most <= one.ratio <= one.most]
    if not wrong:
        return []
    ratio = float(np.median([one.ratio for one in measures]))
    if all(1.0 / SAME_FACTOR <= one.ratio / ratio <= SAME_FACTOR for one in measures):
        remedy = f"scale the part by {1.0 / ratio:.4g}: check its unit"
    else:
        remedy = "check its unit, its axes (x along the shafts, z up) and the keys"
    more = f" and {len(wrong) - MOST_NAMED} more" if len(wrong) > MOST_NAMED else ""
    return [Fault(at, given, f"{', '.join(one.text for one in wrong[:MOST_NAMED])}{more}", remedy)]


def _part_faults(
    at: str, given: str, gearbox: Gearbox, geometry: HousingGeometry, model: GearboxModel
) -> list[Fault]:
    """Parts that the case needs and the mesh lacks, and bodies without a material."""
    held = (*model.mesh.bodies, *model.mesh.surfaces)
    lost = {name: why for name, why in _needed(gearbox, geometry).items() if name not in held}
    known = body_names(geometry)
    faults = [_lacking(at, given, model, lost)] if lost else []
    return faults + [
        Fault(at, given, f"body {body!r} has no material", f"name bodies {', '.join(known)}")
        for body in model.mesh.bodies
        if body not in known
    ]


def _needed(gearbox: Gearbox, geometry: HousingGeometry) -> dict[str, str]:
    """Bodies and surfaces into which the case lets heat go, or which a joint needs: name -> what needs it."""
    split = gearbox.heat_split
    needed = {"housing": "every case"}
    if geometry.foot_joint:
        needed |= dict.fromkeys(("field", *joined_surfaces(geometry)), "foot_contact")
    for gear in gearbox.gears.values():
        if split.rule == "flank_film":
            needed[f"gear_{gear.shaft}_rim"] = 'heat_split.mesh = "flank_film"'
        elif split.mesh_into_gears:
            needed[f"gear_{gear.shaft}_rim"] = "heat_split.mesh_into_gears"
        if split.windage_into_gears:
            needed[f"gear_{gear.shaft}"] = "heat_split.windage_into_gears"
    for seal in seal_stations(geometry):
        if split.seal_into_housing:
            needed[seal.bore_surface] = "heat_split.seal_into_housing"
        if split.seal_into_shaft:
            needed[seal.shaft_surface] = "heat_split.seal_into_shaft"
    return needed


def _lacking(at: str, given: str, model: GearboxModel, lost: Mapping[str, str]) -> Fault:
    """The names a mesh lacks, each with what needs it, and the ways out."""
    listed = "; ".join(
        f"{', '.join(name for name, why in lost.items() if why == reason)} for {reason}"
        for reason in dict.fromkeys(lost.values())
    )
    return Fault(
        at, given, f"has the bodies {', '.join(model.mesh.bodies)} and lacks {listed}",
        "add them to the mesh under these names (rigdesign mesh CASE --out DIR writes an example), or give the "
        "surfaces of missing shafts and gears their boundary conditions, so that they are drawn from the tables, or "
        "set the shares of heat_split that go into parts without a mesh to 0",
    )  # fmt: skip


@dataclass(frozen=True)
class _Part:
    """A file to read; rules and sizes count for a STEP file only."""

    file: Path
    changed: int
    """When the file was, so that a new one is read again."""
    rules: NamedRules
    size: float
    """Largest element [m]."""
    circle: int
    """Elements round a full circle."""
    step: bool


@kept
def _read(part: _Part) -> NamedMesh:
    """What the file holds."""
    if part.step:
        return read_step(part.file, dict(part.rules), part.size, part.circle)
    return read_mesh(part.file)


@dataclass(frozen=True)
class _Drawn:
    """Parts that the file lacks and the tables of the case describe."""

    shafts: tuple[ShaftGeometry, ...]
    foot_width: float | None
    """Of the foot on the field [m]; None without a field to draw."""


@kept
def _whole(part: _Part, geometry: HousingGeometry, drawn: _Drawn, sizes: MeshSizes) -> GearboxModel:
    """The model with the parts that are drawn from the tables."""
    mesh = _read(part)
    parts = [build_shaft(geometry, shaft, sizes) for shaft in drawn.shafts]
    if drawn.foot_width is not None:
        parts.append(build_field(replace(geometry, width=drawn.foot_width), sizes))
    return fitted_model(disjoint_union(mesh, *parts) if parts else mesh, geometry)
