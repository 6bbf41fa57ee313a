"""`rigdesign mesh`: the housings of a case as mesh files."""

from pathlib import Path

from rigdesign.base.fidelity import Fidelity
from rigdesign.cli.application import OutFolder, app, loaded_case
from rigdesign.cli.exit_status import NOTHING_KEPT, interrupted


@app.command
def mesh(case: Path, /, *, out: OutFolder, fidelity: Fidelity = "standard") -> int:
    """Write the housings of a case as gmsh files with all their names, and pictures of STEP parts with numbered faces.

    Parameters
    ----------
    case
        Case folder or its case.toml.
    out
        Folder for one file per housing, NAME.msh.
    fidelity
        Size of the meshes: quick, standard or reference.
    """
    loaded = loaded_case(case)
    from rigdesign.base.output_folder import prepare_output
    from rigdesign.cli.mesh_export import export_meshes
    from rigdesign.cli.terminal.console import print_meshes
    from rigdesign.cli.terminal.progress import Progress

    prepare_output(out)
    with Progress() as progress, interrupted(NOTHING_KEPT):
        progress("meshing")
        written = export_meshes(loaded, out, fidelity)
    print_meshes(written)
    return 0
