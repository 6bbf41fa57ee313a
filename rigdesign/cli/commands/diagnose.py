"""`rigdesign diagnose`: the effect that a simulation lacks against measured data."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from rigdesign.base.errors import UsageError
from rigdesign.cli.application import OutFolder, app, loaded_case, print_json
from rigdesign.cli.exit_status import SIMULATIONS_KEPT, interrupted

if TYPE_CHECKING:
    from rigdesign.case import Case


@app.command
def diagnose(
    case: Path,
    measurement: Path,
    /,
    *,
    out: OutFolder,
    json: bool = False,
    name: str | None = None,
    calibration: Path | None = None,
    calibrate: Annotated[bool, Parameter(negative=(), show=False)] = False,
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
    calibration
        calibration.json that `rigdesign calibrate` wrote for this rig, or its folder; the shipped values when left out.
    calibrate
        Moved to `rigdesign calibrate --constants`.
    """
    if calibrate:
        raise UsageError(
            "--calibrate of diagnose is now `rigdesign calibrate CASE SET --constants --out DIR`; "
            "--calibration FILE uses the calibration of a rig"
        )
    loaded = loaded_case(case)
    from rigdesign.base.output_folder import prepare_output
    from rigdesign.cli.terminal.diagnosis import print_diagnosis
    from rigdesign.cli.terminal.progress import Progress
    from rigdesign.diagnosis.catalogue import effects_of
    from rigdesign.diagnosis.decision.defaults import DEFAULT
    from rigdesign.diagnosis.document.document import diagnosis_document
    from rigdesign.diagnosis.document.outcome import check_pick, outcome
    from rigdesign.diagnosis.rig_calibration.document import load_rig_calibration
    from rigdesign.diagnosis.run import diagnose_measurement
    from rigdesign.report.diagnosis_files import write_diagnosis

    if name is not None:
        check_pick(effects_of(loaded, channels=None), name)
    used = DEFAULT if calibration is None else load_rig_calibration(calibration, loaded)
    prepare_output(out)
    with Progress() as progress, interrupted(SIMULATIONS_KEPT):
        found = diagnose_measurement(loaded, measurement, calibration=used, say=progress)
        reported = outcome(found, pick=name)
        progress("writing report")
        write_diagnosis(reported, out)
    if json:
        print_json(diagnosis_document(reported))
    else:
        print_diagnosis(reported, out)
    return 0


# `rigdesign calibrate`: what the user's own healthy rig leaves, as a file that a diagnosis uses.


@app.command
def calibrate(
    case: Path,
    /,
    *healthy_set: Path,
    out: OutFolder,
    json: bool = False,
    constants: Annotated[bool, Parameter(negative=())] = False,
) -> int:
    """Estimate drift, channels and model error of a rig from two to four healthy measurement sets of it.

    Take the sets on different days, at the same operating points, with everything in between that happens in service:
    a drift can only hold what changed between them. `rigdesign diagnose --calibration` uses the result.

    Parameters
    ----------
    case
        Case folder or its case.toml; it is not written to.
    healthy_set
        Folders with measurement.toml, each of the rig in a state known to be healthy: two to four; one with
        --constants.
    out
        Folder for calibration.json and calibration.html; with --constants for calibrated/case.toml and
        constants.json.
    json
        Print calibration.json on stdout; everything else goes to stderr.
    constants
        Fit the uncertain constants of the case to one healthy set and write calibrated/case.toml, which extends the
        case.
    """
    loaded = loaded_case(case)
    if constants:
        return _constants(loaded, healthy_set, out, json=json)
    from rigdesign.base.output_folder import prepare_output
    from rigdesign.cli.terminal.diagnosis import print_rig_calibration
    from rigdesign.cli.terminal.progress import Progress
    from rigdesign.diagnosis.rig_calibration.document import calibration_document
    from rigdesign.diagnosis.rig_calibration.healthy_sets import calibrate_rig
    from rigdesign.report.diagnosis_files import write_rig_calibration

    prepare_output(out)
    with Progress() as progress, interrupted(SIMULATIONS_KEPT):
        found = calibrate_rig(loaded, healthy_set, say=progress)
        write_rig_calibration(found, out)
    if json:
        print_json(calibration_document(found))
    else:
        print_rig_calibration(found, out)
    return 0


def _constants(case: "Case", healthy_set: tuple[Path, ...], out: Path, *, json: bool) -> int:
    """The case with its constants fitted to one set."""
    if len(healthy_set) != 1:
        raise UsageError(
            f"--constants takes one healthy set, {len(healthy_set)} given; choose the one to fit to"
        )
    if json:
        raise UsageError(
            "--json: --constants prints no document; leave one of them out, constants.json holds the fit"
        )
    from rigdesign.base.output_folder import prepare_output
    from rigdesign.cli.terminal.diagnosis import print_constants
    from rigdesign.cli.terminal.progress import Progress
    from rigdesign.diagnosis.run import calibrate_case
    from rigdesign.report.diagnosis_files import write_constants

    prepare_output(out)
    with Progress() as progress, interrupted(SIMULATIONS_KEPT):
        found = calibrate_case(case, healthy_set[0], say=progress)
        write_constants(found, out)
    print_constants(found, out)
    return 0
