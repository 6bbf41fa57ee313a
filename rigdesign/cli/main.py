"""The command line: `rigdesign check | study | compare | diagnose | validate | new | mesh | schema | doctor`.

Exit status: 0 all checks pass (study: complete; compare, diagnose: any verdict; validate: no gate missed), 1 a
check fails or a gate is missed, 2 usage or case error, 3 no convergence, 4 a system library is missing, 5 measured
data cannot be used, 70 a defect of the tool, 130 stopped by Ctrl-C. Heavy imports happen inside the commands, so that
`--help` answers at once.
"""

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import App, Parameter

from rigdesign.base.fidelity import Fidelity
from rigdesign.base.version import __version__
from rigdesign.cli.ending import NOTHING_KEPT, SIMULATIONS_KEPT, exit_status, failure_kept, interrupted

if TYPE_CHECKING:
    from rigdesign.case import Case


app = App(
    name="rigdesign",
    help="Coupled thermal-dynamic design checker for back-to-back gear test rigs.",
    version=__version__,
    exit_on_error=False,
    print_error=False,
    suppress_keyboard_interrupt=False,
)


@app.command
def check(
    case: Path,
    *,
    out: Path | None = None,
    fidelity: Fidelity = "standard",
    transient: Annotated[bool, Parameter(negative=())] = False,
    ranges: Annotated[bool, Parameter(negative=())] = False,
    json: bool = False,
    fail_on: Literal["fail", "warn"] = "fail",
) -> int:
    """Compute loads, losses, temperatures and clearances of a rig and hold them against its limits.

    Parameters
    ----------
    case
        Case folder or its case.toml.
    out
        Folder for results.json, report.html, junit.xml, fields and curves.
    fidelity
        Size of the models: quick, standard or reference.
    transient
        Follow temperatures and clearances over warm-up, schedule, stops and soak-back as well.
    ranges
        Move every assumed input to both ends of its range, one at a time: a check passes only if it holds there too.
    json
        Print results.json on stdout; everything else goes to stderr.
    fail_on
        Verdict from which the exit status is 1.
    """
    loaded = _loaded(case)
    from rigdesign.cli.terminal import Progress, print_checks
    from rigdesign.report import prepare_output, results_document, write_results
    from rigdesign.run.main import run_case

    if out is not None:
        prepare_output(out)
    with Progress() as progress, interrupted(NOTHING_KEPT), failure_kept(out):
        result = run_case(loaded, fidelity=fidelity, progress=progress, transient=transient)
        if ranges:
            from rigdesign.uncertainty.run import with_ranges

            result = with_ranges(loaded, result, progress=progress, count=progress.count)
        if out is not None:
            progress("writing report")
            write_results(result, out)
    if json:
        _print_json(results_document(result))
    else:
        print_checks(result, out)
    failing = {"fail"} if fail_on == "fail" else {"fail", "warn"}
    return 1 if result.verdict in failing else 0


@app.command
def study(
    case: Path,
    *,
    vary: Annotated[list[str], Parameter(negative=())],
    out: Path,
    fidelity: Fidelity = "standard",
    workers: int | None = None,
    retry: bool = False,
) -> int:
    """Run a case over a grid of parameter values; resumes where it stopped.

    Parameters
    ----------
    case
        Case folder or its case.toml.
    vary
        'PATH=START:STOP:STEP' or 'PATH=v1,v2', once per parameter; several make a grid.
    out
        Folder of the study: ledger, results.csv, plot of margins.
    fidelity
        Size of the models.
    workers
        Number of worker processes; default one per core.
    retry
        Run points again that failed before.
    """
    loaded = _loaded(case)
    from rigdesign.cli.terminal import Progress, print_study
    from rigdesign.report.pages.study import write_study
    from rigdesign.studies.run import Execution, parse_variation, run_study

    variations = [parse_variation(text) for text in vary]
    with Progress() as progress:
        execution = Execution(workers=workers, retry=retry, progress=progress, note=progress.note)
        outcome = run_study(
            loaded, variations, out, write=write_study, fidelity=fidelity, execution=execution
        )
    print_study(outcome, out)
    return 0


@app.command
def compare(
    case: Path,
    measurement: Path,
    *,
    out: Path | None = None,
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
    loaded = _loaded(case)
    from rigdesign.cli.terminal import Progress, print_comparison
    from rigdesign.measurement.comparison.compare import comparison_document
    from rigdesign.measurement.comparison.comparing import compare_measurement
    from rigdesign.report import prepare_output
    from rigdesign.report.pages.measurement import write_comparison

    if out is not None:
        prepare_output(out)
    with Progress() as progress, interrupted(NOTHING_KEPT):
        comparison = compare_measurement(loaded, measurement, model=model, fidelity=fidelity, say=progress)
        if out is not None:
            progress("writing report")
            write_comparison(comparison, out, model=model, fidelity=fidelity)
    if json:
        _print_json(comparison_document(comparison, model=model, fidelity=fidelity))
    else:
        print_comparison(comparison, out)
    return 0


@app.command
def diagnose(
    case: Path,
    measurement: Path,
    *,
    out: Path,
    json: bool = False,
    name: str | None = None,
    calibrate: Annotated[bool, Parameter(negative=())] = False,
) -> int:
    """Name the effect that the model lacks against a measurement set, patch the case, and prove that the gap shrinks.

    Parameters
    ----------
    case
        Case folder or its case.toml; it is not written to.
    measurement
        Folder with measurement.toml.
    out
        Folder for diagnosis.json, diagnosis.html and, where nothing speaks against it, case.patch.json and
        patched/case.toml.
    json
        Print diagnosis.json on stdout; everything else goes to stderr.
    name
        Effect to patch where the data leave several, such as one of an alias group.
    calibrate
        The set is of a healthy rig: fit the uncertain constants of the case to it and write calibrated/case.toml.
    """
    if calibrate:
        return _calibrate(case, measurement, out)
    loaded = _loaded(case)
    from rigdesign.cli.terminal import Progress, print_diagnosis
    from rigdesign.diagnosis.catalogue import effects_of
    from rigdesign.diagnosis.document.document import diagnosis_document
    from rigdesign.diagnosis.document.outcome import check_pick, outcome
    from rigdesign.diagnosis.run import diagnose_measurement
    from rigdesign.report import prepare_output
    from rigdesign.report.diagnosis_files import write_diagnosis

    if name is not None:
        check_pick(effects_of(loaded), name)
    prepare_output(out)
    with Progress() as progress, interrupted(SIMULATIONS_KEPT):
        found = diagnose_measurement(loaded, measurement, say=progress)
        reported = outcome(found, pick=name, proposals=found.proposals)
        progress("writing report")
        write_diagnosis(reported, out)
    if json:
        _print_json(diagnosis_document(reported))
    else:
        print_diagnosis(reported, out)
    return 0


def _loaded(path: Path) -> "Case":
    """The case, before anything else is imported: a fault in it is said at once."""
    from rigdesign.case import load_case

    return load_case(path)


def _calibrate(case: Path, measurement: Path, out: Path) -> int:
    loaded = _loaded(case)
    from rigdesign.cli.terminal import Progress, print_constants
    from rigdesign.diagnosis.run import calibrate_case
    from rigdesign.report import prepare_output
    from rigdesign.report.diagnosis_files import write_calibrated

    prepare_output(out)
    with Progress() as progress, interrupted(SIMULATIONS_KEPT):
        found = calibrate_case(loaded, measurement, say=progress)
        write_calibrated(found, out)
    print_constants(found, out)
    return 0


@app.command
def mesh(case: Path, *, out: Path, fidelity: Fidelity = "standard") -> int:
    """Write the housings of a case as gmsh files with all their names: examples of what mesh_file reads.

    Parameters
    ----------
    case
        Case folder or its case.toml.
    out
        Folder for one file per housing, NAME.msh.
    fidelity
        Size of the meshes: quick, standard or reference.
    """
    loaded = _loaded(case)
    from rigdesign.cli.mesh_export import export_meshes
    from rigdesign.cli.terminal import Progress, print_meshes
    from rigdesign.report import prepare_output

    prepare_output(out)
    with Progress() as progress, interrupted(NOTHING_KEPT):
        progress("meshing")
        written = export_meshes(loaded, out, fidelity)
    print_meshes(written)
    return 0


new = App(name="new", help="Write the start of a file to fill in.")
app.command(new)


@new.command(name="measurement")
def new_measurement(case: Path, *, out: Path) -> int:
    """Write measurement.toml and an empty data.csv with the channels the case offers.

    Parameters
    ----------
    case
        Case folder or its case.toml.
    out
        Folder of the set; files in it are not overwritten.
    """
    loaded = _loaded(case)
    from rigdesign.measurement.template import write_template

    for path in write_template(loaded, out):
        print(path)
    return 0


@app.command
def validate(*, out: Path | None = None, json: bool = False, quick: bool = False) -> int:
    """Print every published number against ours, with the assumption it depends on.

    Parameters
    ----------
    out
        Folder for validation.json and validation.csv.
    json
        Print the rows as JSON on stdout.
    quick
        Leave out the rows that need a run of the prototype case.
    """
    from rigdesign.cli.terminal import Progress, print_validation
    from rigdesign.report import prepare_output
    from rigdesign.validation import validation_document, validation_rows, write_validation

    if out is not None:
        prepare_output(out)
    with Progress() as progress, interrupted(NOTHING_KEPT):
        rows = validation_rows(with_run=not quick, progress=progress)
    if out is not None:
        write_validation(rows, out)
    if json:
        _print_json(validation_document(rows))
    else:
        print_validation(rows)
    return 1 if any(row.verdict == "gate missed" for row in rows) else 0


@app.command
def schema() -> int:
    """Print the JSON Schema of the case file, for editors."""
    from rigdesign.case import json_schema

    _print_json(json_schema())
    return 0


@app.command
def doctor() -> int:
    """Look for missing system libraries and compile the kernels once."""
    from rigdesign.base.system import diagnose
    from rigdesign.cli.terminal import print_findings

    findings = diagnose()
    print_findings(findings)
    return 0 if all(finding.ok for finding in findings) else 4


def main() -> None:
    """Entry point of the `rigdesign` command."""
    sys.exit(exit_status(lambda: app(result_action="return_value")))


def _print_json(document: object) -> None:
    json.dump(document, sys.stdout, indent=2, ensure_ascii=False, allow_nan=False)
    sys.stdout.write("\n")
