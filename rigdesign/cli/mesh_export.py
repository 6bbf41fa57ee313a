"""Writes the parametric housings of a case as mesh files: an example of what ``mesh_file`` reads."""

from pathlib import Path

from rigdesign.base.errors import UsageError
from rigdesign.base.fidelity import Fidelity
from rigdesign.base.output_folder import staged
from rigdesign.case.model import Case
from rigdesign.rig.model import build_rig
from rigdesign.run.solver_errors import solver_errors
from thermal.housing.export import write_mesh
from thermal.housing.gearbox import build_gearbox, mesh_sizes


def export_meshes(case: Case, out: Path, fidelity: Fidelity = "standard") -> list[tuple[str, Path, int]]:
    """Write ``<gearbox>.msh`` of every housing of the case to ``out``: gearbox, file, number of nodes.

    A housing that itself is read from a mesh file is written as the box its table describes.

    Raises
    ------
    UsageError
        If no gearbox has a housing.
    CaseError
        A housing that cannot be built.
    OutputError
        If ``out`` cannot be written.
    """
    written = []
    with solver_errors(case):
        geometries = build_rig(case, fidelity).geometries
        if not geometries:
            raise UsageError(f"{case.path}: no gearbox has a housing; add gearboxes.NAME.housing")
        with staged(out) as scratch:
            for name, geometry in geometries.items():
                housing = case.gearboxes[name].housing
                assert housing is not None
                mesh = build_gearbox(geometry, mesh_sizes(geometry, fidelity, housing.mesh.sizes())).mesh
                write_mesh(mesh, scratch / f"{name}.msh")
                written.append((name, out / f"{name}.msh", len(mesh.points)))
    return written
