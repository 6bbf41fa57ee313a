"""What the library offers: the commands as functions, on objects in memory.

Nothing is printed. Files are written where a function has ``out``, and by :func:`save`.
"""

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path

from threadpoolctl import threadpool_limits

from rigdesign.base.fidelity import Fidelity
from rigdesign.case import Case
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.diagnosis.decision.defaults import DEFAULT
from rigdesign.diagnosis.document.outcome import Outcome, check_pick, outcome
from rigdesign.diagnosis.rig_calibration.document import load_rig_calibration
from rigdesign.diagnosis.run import diagnose_measurement
from rigdesign.measurement.comparison.compare import Comparison, compare_measurement
from rigdesign.prediction.predict import Thermal
from rigdesign.report.pages.study import write_study
from rigdesign.report.study_tables import TableFormat, require_table_libraries, write_tables
from rigdesign.report.writing import write_results
from rigdesign.results.result import RunResult
from rigdesign.run import main
from rigdesign.studies.assumed_ranges import with_ranges
from rigdesign.studies.design import StudyDesign
from rigdesign.studies.result import CheckSelection, StudyResult
from rigdesign.studies.run import DEFAULT as ONE_PROCESS_A_CORE
from rigdesign.studies.run import Execution, StudyOutcome, run_study
from rigdesign.studies.verdict_sensitivity import with_flips

Progress = Callable[[str], None]


def run_case(
    case: Case,
    fidelity: Fidelity = "standard",
    progress: Progress | None = None,
    *,
    transient: bool = False,
    ranges: bool = False,
    checks: Sequence[str] = (),
) -> RunResult:
    """Compute a case and hold it against its limits, as ``rigdesign check`` does.

    Parameters
    ----------
    case : from `load_case`
    fidelity : size of the models
    progress : called with what is being computed
    transient : follow temperatures and clearances over the schedule and its events as well
    ranges : move every assumed input to both ends of its range; a check passes only if it holds there too
    checks : patterns on the ids of the checks to judge, as `CheckSelection` takes them; the others do not apply

    Raises
    ------
    UsageError
        A pattern that matches no check.
    CaseError
        A case that cannot be computed: gears that do not mesh, a loop or housing that does not close.
    NotConvergedError
        An iteration that does not converge, a first stage that the motor does not hold, a NaN or infinite result.
    MissingLibraryError
        A system library that gmsh needs.
    """
    selection = CheckSelection(checks)
    selection.require(case, transient=transient)
    follow_ups = {"checks": selection.applied, "flips": with_flips}
    result = main.run_case(case, fidelity, progress, transient=transient, follow_ups=follow_ups)
    return with_ranges(case, result, progress=progress) if ranges else result


def save(result: RunResult, out: str | Path) -> None:
    """Write results.json, report.html, junit.xml, fields and curves of a run to a folder.

    Raises
    ------
    OutputError
        If the folder cannot be written.
    """
    write_results(result, Path(out))


def study(
    case: Case,
    design: StudyDesign | str | Iterable[str],
    out: str | Path,
    *,
    fidelity: Fidelity = "standard",
    execution: Execution = ONE_PROCESS_A_CORE,
    tables: Sequence[TableFormat] = (),
) -> StudyOutcome:
    """Compute a case over values of its inputs; what ``out`` holds already is not computed again.

    Parameters
    ----------
    design : a `StudyDesign`, or the values of a grid: ``"PATH=START:STOP:STEP"`` or ``"PATH=v1,v2"``, one or
        several
    out : folder of the ledger, results.csv and the page
    execution : workers or any `concurrent.futures.Executor`, share of the points, progress
    tables : ``"parquet"`` and ``"xlsx"`` beside results.csv

    Raises
    ------
    UsageError
        A design that cannot be made, workers that do not exist, a folder that cannot be written.
    CaseError
        No point is a valid case.
    MissingLibraryError
        A library of ``tables`` or of the workers that is not installed.
    """
    require_table_libraries(tables)
    if not isinstance(design, StudyDesign):
        design = StudyDesign(vary=(design,) if isinstance(design, str) else tuple(design))
    write = partial(_write_study, tables=tables)
    with threadpool_limits(limits=1):
        return run_study(case, design, Path(out), write=write, fidelity=fidelity, execution=execution)


def _write_study(study: StudyResult, out: Path, tables: Sequence[TableFormat]) -> None:
    write_tables(study, out, tables)
    write_study(study, out)


def compare(
    case: Case, measurement: str | Path, *, model: Thermal = "full", fidelity: Fidelity = "quick"
) -> Comparison:
    """Where a measurement set and the simulation disagree.

    measurement : folder with measurement.toml

    Raises
    ------
    MeasurementError
        Data of which nothing can be used.
    CaseError, NotConvergedError, MissingLibraryError
        As :func:`run_case`.
    """
    with threadpool_limits(limits=1):
        return compare_measurement(case, Path(measurement), model=model, fidelity=fidelity)


def diagnose(
    case: Case,
    measurement: str | Path,
    *,
    name: str | None = None,
    calibration: str | Path | None = None,
) -> Outcome:
    """The effect that the model lacks against a measurement set, or that the data do not identify one.

    measurement : folder with measurement.toml; name : effect to patch where the data leave several; calibration : file
    that `rigdesign calibrate` wrote for this rig, the shipped values when left out

    Raises
    ------
    UsageError
        A name that is no effect of this case, or that these data exclude; a calibration of another rig, or damaged.
    MeasurementError
        Data of which nothing can be used.
    CaseError, NotConvergedError, MissingLibraryError
        As :func:`run_case`.
    """
    if name is not None:
        check_pick(effects_of(case, channels=None), name)
    used = DEFAULT if calibration is None else load_rig_calibration(Path(calibration), case)
    with threadpool_limits(limits=1):
        return outcome(diagnose_measurement(case, Path(measurement), calibration=used), pick=name)
