"""`rigdesign compare`: measured data against the simulation."""

from pathlib import Path
from typing import Literal

from rigdesign.base.fidelity import Fidelity
from rigdesign.cli.application import OptionalOutFolder, app, loaded_case, print_json
from rigdesign.cli.exit_status import NOTHING_KEPT, interrupted


@app.command
def compare(
    case: Path,
    measurement: Path,
    /,
    *,
    out: OptionalOutFolder = None,
    model: Literal["full", "reduced"] = "full",
    fidelity: Fidelity = "quick",
    json: bool = False,
) -> int:
    """Hold a measurement set against the simulation and say where they disagree; changes no model.

    Where the set names a healthy one as its baseline, what simulation and healthy set say together is held against it.

    Parameters
    ----------
    case
        Case folder or its case.toml.
    measurement
        Folder with measurement.toml.
    out
        Folder for compare.json and compare.html.
    model
        Thermal model: full, or reduced with its stated error.
    fidelity
        Size of the models: quick, standard or reference.
    json
        Print compare.json on stdout; everything else goes to stderr.
    """
    loaded = loaded_case(case)
    from rigdesign.base.output_folder import prepare_output
    from rigdesign.cli.terminal.console import print_comparison
    from rigdesign.cli.terminal.progress import Progress
    from rigdesign.measurement.comparison.compare import compare_measurement, comparison_document
    from rigdesign.report.pages.measurement import write_comparison

    if out is not None:
        prepare_output(out)
    with Progress() as progress, interrupted(NOTHING_KEPT):
        comparison = compare_measurement(loaded, measurement, model=model, fidelity=fidelity, say=progress)
        if out is not None:
            progress("writing report")
            write_comparison(comparison, out, model=model, fidelity=fidelity)
    if json:
        print_json(comparison_document(comparison, model=model, fidelity=fidelity))
    else:
        print_comparison(comparison, out)
    return 0
