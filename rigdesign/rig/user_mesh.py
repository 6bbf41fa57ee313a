"""The mesh file of a housing in place of the parametric box: read once, held against the case."""

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

from rigdesign.base.errors import CaseError, Fault
from rigdesign.base.files import check_regular
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.rules.surfaces import boundary_faults
from thermal.fe.mesh import MeshError
from thermal.housing.fitted import fitted_model
from thermal.housing.geometry import HousingGeometry
from thermal.housing.mesh_file import read_mesh
from thermal.housing.parametric_stations import seal_stations
from thermal.housing.stations import GearboxModel
from thermal.housing.surfaces import body_names, joined_surfaces

LARGEST_MESH = 2_000_000_000
"""Bytes of a mesh file; a gearbox of a million nodes has a tenth."""


def user_model(name: str, gearbox: Gearbox, geometry: HousingGeometry, case: Path) -> GearboxModel:
    """Model of the mesh file of gearbox ``name``, next to its ``case`` file.

    Raises
    ------
    CaseError
        A file that is no mesh to compute with, one that lacks a part into which the case lets heat go, bodies without
        a material, surfaces without a condition or conditions without a surface.
    """
    housing = gearbox.housing
    assert housing is not None and housing.mesh_file is not None
    at, given = f"gearboxes.{name}.housing.mesh_file", f'"{housing.mesh_file}"'
    file = case.parent / housing.mesh_file
    try:
        check_regular(file, LARGEST_MESH)
        model = _read(file, file.stat().st_mtime_ns, geometry)
    except OSError as error:
        raise CaseError(
            [Fault(at, given, str(error.strerror), "correct the path of the mesh")], str(case)
        ) from error
    except MeshError as error:
        text, _, remedy = str(error).rpartition("; ")
        raise CaseError([Fault(at, given, text, remedy)], str(case)) from error
    held = (*model.mesh.bodies, *model.mesh.surfaces)
    lost = {name: why for name, why in _needed(gearbox, geometry).items() if name not in held}
    known = body_names(geometry)
    faults = [_lacking(at, given, model, lost)] if lost else []
    faults += [
        Fault(at, given, f"body {body!r} has no material", f"name bodies {', '.join(known)}")
        for body in model.mesh.bodies
        if body not in known
    ]
    joined = joined_surfaces(geometry)
    surfaces = tuple(surface for surface in model.mesh.surfaces if surface not in joined)
    if faults := [*faults, *boundary_faults(name, gearbox, surfaces)]:
        raise CaseError(faults, str(case))
    return model


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
        "add them to the mesh under these names (rigdesign mesh CASE --out DIR writes an example), or set the shares "
        "of heat_split that go into parts without a mesh to 0",
    )  # fmt: skip


@lru_cache(maxsize=8)
def _read(file: Path, changed: int, geometry: HousingGeometry) -> GearboxModel:
    """The model; ``changed`` is when the file was, so that a new one is read again."""
    return fitted_model(read_mesh(file), geometry)
