"""The mesh file of a housing in place of the parametric box: read once, held against the case."""

from functools import lru_cache
from pathlib import Path

from rigdesign.case.gearbox import Gearbox
from rigdesign.case.surfaces import boundary_faults
from rigdesign.errors import CaseError, Fault
from rigdesign.files import RefusedFileError, check_regular
from thermal.fe.mesh import MeshError
from thermal.housing_file import read_mesh
from thermal.housing_fitted import fitted_model
from thermal.housing_geometry import HousingGeometry
from thermal.housing_surfaces import body_names
from thermal.stations import GearboxModel

LARGEST_MESH = 2_000_000_000
"""Bytes of a mesh file; a gearbox of a million nodes has a tenth."""


def user_model(name: str, gearbox: Gearbox, geometry: HousingGeometry, case: Path) -> GearboxModel:
    """Model of the mesh file of gearbox ``name``, beside its ``case`` file.

    Raises
    ------
    CaseError
        A file that is no mesh to compute with, bodies without a material, surfaces without a condition or
        conditions without a surface.
    """
    housing = gearbox.housing
    assert housing is not None and housing.mesh_file is not None
    at, given = f"gearboxes.{name}.housing.mesh_file", f'"{housing.mesh_file}"'
    file = case.parent / housing.mesh_file
    try:
        check_regular(file, LARGEST_MESH)
        model = _read(file, file.stat().st_mtime_ns, geometry)
    except (RefusedFileError, FileNotFoundError, PermissionError) as error:
        raise CaseError(
            [Fault(at, given, str(error.strerror), "correct the path of the mesh")], str(case)
        ) from error
    except MeshError as error:
        text, _, remedy = str(error).rpartition("; ")
        raise CaseError([Fault(at, given, text, remedy)], str(case)) from error
    known = body_names(geometry)
    faults = [
        Fault(at, given, f"body {body!r} has no material", f"name bodies {', '.join(known)}")
        for body in model.mesh.bodies
        if body not in known
    ]
    if faults := [*faults, *boundary_faults(name, gearbox, tuple(model.mesh.surfaces))]:
        raise CaseError(faults, str(case))
    return model


@lru_cache(maxsize=8)
def _read(file: Path, changed: int, geometry: HousingGeometry) -> GearboxModel:
    """The model; ``changed`` is when the file was, so that a new one is read again."""
    return fitted_model(read_mesh(file), geometry)
