"""Writes the housings of a case as mesh files: examples of what ``mesh_file`` reads; STEP parts with a picture too."""

from dataclasses import dataclass
from pathlib import Path

from rigdesign.base.errors import UsageError
from rigdesign.base.fidelity import Fidelity
from rigdesign.base.output_folder import staged
from rigdesign.case.model import Case
from rigdesign.rig.model import Rig, build_rig
from rigdesign.rig.user_mesh import step_part
from rigdesign.run.solver_errors import solver_errors
from thermal.housing.gearbox import build_gearbox, mesh_sizes
from thermal.housing.mesh_file import write_mesh
from thermal.housing.step_file import FaceNames

PICTURE_TRIANGLES = 0.06
"""Size of the triangles of a picture, relative to the height of the part."""


@dataclass(frozen=True)
class ExportedFile:
    """A file that was written for the housing of a gearbox, and what to do with it in words."""

    file: Path
    remark: str


def export_meshes(case: Case, out: Path, fidelity: Fidelity = "standard") -> list[ExportedFile]:
    """Write ``<gearbox>.msh`` of every housing of the case to ``out``.

    A housing that is read from a mesh file is written as the box its table describes. Of a STEP housing comes the
    picture ``<gearbox>_faces.png`` with its faces numbered, and its mesh when all of them have a name.

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
        rig = build_rig(case, fidelity)
        if not rig.geometries:
            raise UsageError(f"{case.path}: no gearbox has a housing; add gearboxes.NAME.housing")
        with staged(out) as scratch:
            for name, housing in case.housings.items():
                if housing.step_file is None:
                    written += _export_box(rig, name, scratch)
                else:
                    written += _export_step(rig, name, housing.step_file, scratch)
    return [ExportedFile(out / done.file.name, done.remark) for done in written]


def _export_box(rig: Rig, name: str, folder: Path) -> list[ExportedFile]:
    housing = rig.case.housings[name]
    geometry = rig.geometries[name]
    model = build_gearbox(geometry, mesh_sizes(geometry, rig.fidelity, housing.mesh.sizes()))
    file = folder / f"{name}.msh"
    write_mesh(model.mesh, file)
    return [ExportedFile(file, _reads(name, file, len(model.mesh.points)))]


def _export_step(rig: Rig, name: str, step_file: str, folder: Path) -> list[ExportedFile]:
    from rigdesign.cli.face_picture import draw_faces

    housing = rig.case.housings[name]
    part = step_part(rig.case, name, step_file, PICTURE_TRIANGLES * housing.height)
    picture = folder / f"{name}_faces.png"
    draw_faces(picture, f"{step_file}: {len(part.faces)} faces", part.faces, part.names, part.triangles)
    done = [ExportedFile(picture, f"{len(part.faces)} faces, {_named(part.names)}")]
    if part.names.complete:
        mesh, file = rig.models[name].mesh, folder / f"{name}.msh"
        write_mesh(mesh, file)
        done.append(ExportedFile(file, _reads(name, file, len(mesh.points))))
    return done


def _reads(name: str, file: Path, nodes: int) -> str:
    return f'{nodes} nodes; [gearboxes.{name}.housing] mesh_file = "{file.name}" reads it'


def _named(names: FaceNames) -> str:
    if names.complete:
        return f"all named: {', '.join(names.surfaces)}"
    open_ones = [f"no name: {', '.join(str(face.number) for face in names.unnamed)}"] if names.unnamed else []
    return "; ".join([*open_ones, *names.doubled, *names.idle])
