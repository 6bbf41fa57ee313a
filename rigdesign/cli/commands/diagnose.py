"""`rigdesign diagnose`: the effect that a simulation lacks against measured data."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from rigdesign.base.errors import UsageError
from rigdesign.cli.application import OutFolder, app, loaded_case, print_json
from rigdesign.cli.ending import SIMULATIONS_KEPT, interrupted


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
    from rigdesign.cli.terminal.diagnosis import print_diagnosis
    from rigdesign.cli.terminal.progress import Progress
    from rigdesign.diagnosis.catalogue import effects_of
    from rigdesign.diagnosis.decision.defaults import DEFAULT
    from rigdesign.diagnosis.document.document import diagnosis_document
    from rigdesign.diagnosis.document.outcome import check_pick, outcome
    from rigdesign.diagnosis.rig_calibration.reading import load_rig_calibration
    from rigdesign.diagnosis.run import diagnose_measurement
    from rigdesign.report import prepare_output
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
