"""Parameter studies: the case over a grid of values, resumable, with failed points kept."""

import traceback
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from rigdesign.base.errors import CaseError, OutputError, RigdesignError
from rigdesign.base.fidelity import Fidelity
from rigdesign.base.file_lock import FileLock, HeldError
from rigdesign.base.json_text import to_plain
from rigdesign.base.output_folder import prepare_output
from rigdesign.base.worker_pool import compute_all, worker_count
from rigdesign.results.result import RunResult
from rigdesign.studies.grid import Variation, grid, parse_variation
from rigdesign.studies.ledger import Ledger, point_key
from rigdesign.studies.result import Record, StudyPoint, StudyResult

if TYPE_CHECKING:
    from rigdesign.case import Case

__all__ = ["Execution", "StudyOutcome", "StudyPoint", "Variation", "parse_variation", "run_study"]

LEDGER_NAME = "ledger.sqlite"
LOCK_NAME = ".rigdesign-study.lock"
CHECK_KEYS = (
    "id", "title", "group", "value", "limit", "upper_limit", "unit", "comparison", "margin", "utilisation", "verdict",
)  # fmt: skip


class Writer(Protocol):
    """What writes the files of a study; `rigdesign.report.pages.study.write_study`."""

    def __call__(self, study: StudyResult, out: Path) -> None:
        """Write them to ``out``."""


class Run(Protocol):
    """What computes one point; `rigdesign.run_case` or a stand-in."""

    def __call__(self, case: "Case", *, fidelity: Fidelity) -> RunResult:
        """Compute one case."""


@dataclass(frozen=True, kw_only=True)
class StudyOutcome:
    """What a study found; how many of its points were computed now and how many were found done."""

    result: StudyResult
    completed: int
    reused: int

    @property
    def points(self) -> Sequence[StudyPoint]:
        """All points in the order of the grid."""
        return self.result.points

    @property
    def failed(self) -> list[str]:
        """One line per failed point: its values and its error."""
        return [
            ", ".join(f"{path} = {value}" for path, value in point.values.items())
            + f": {point.record['error']}"
            for point in self.points
            if point.failed
        ]


@dataclass(frozen=True, kw_only=True)
class Execution:
    """How a study is computed, which changes nothing in its points.

    workers : processes, one thread each; None for one per core
    retry : compute points again that failed before
    progress : called with one line per finished point
    note : called with what the user has to know of, such as a damaged ledger; ``progress`` if left out
    run : picklable stand-in for `rigdesign.run_case`
    """

    workers: int | None = None
    retry: bool = False
    progress: Callable[[str], None] | None = None
    note: Callable[[str], None] | None = None
    run: Run | None = None

    def say(self, line: str) -> None:
        """Pass a line of progress on."""
        if self.progress is not None:
            self.progress(line)


DEFAULT = Execution()
"""One process per core, silent."""


@dataclass(frozen=True)
class _Task:
    case: Any
    values: dict[str, str]
    key: str


def run_study(
    case: "Case",
    variations: Sequence[Variation],
    out: Path,
    *,
    write: Writer,
    fidelity: Fidelity = "standard",
    execution: Execution = DEFAULT,
) -> StudyOutcome:
    """Run a case over the grid of ``variations`` and write its files to ``out``.

    A point goes to ``out/ledger.sqlite`` the moment it is finished; the same call again computes only what
    is missing. Points are the same when resolved case, tool version and fidelity
    are. The files depend on the points only, not on interruptions, workers or time.

    Parameters
    ----------
    case : base case; ``with_value(path, value)`` makes a point of it
    write : writes the files while the folder is still locked
    execution : processes, progress, points to compute again

    Raises
    ------
    UsageError
        If nothing is varied, a path stands twice, the grid is too large, or ``workers`` is below 1.
    CaseError
        If no point of the grid is a valid case (a path that does not exist, say), or a value is none its place
        can hold whatever else the case says (a choice or an oil that does not exist); nothing is written then.
    OutputError
        If ``out`` cannot be written or another study runs in it.
    KeyboardInterrupt
        With a note that says what is stored and how to go on.
    """
    combinations = grid(variations)
    count = worker_count(execution.workers)
    points = [dict(zip((v.path for v in variations), values, strict=True)) for values in combinations]
    tasks, invalid = _tasks(case, points, fidelity)
    prepare_output(out)
    out.mkdir(parents=True, exist_ok=True)
    say = execution.say
    with _alone_in(out), Ledger(out / LEDGER_NAME) as ledger:
        if ledger.repaired:
            (execution.note or say)(ledger.repaired)
        stored = {key: entry for key, entry in ledger.stored().items() if not (execution.retry and entry[0])}
        missing = list(
            {task.key: task for task in tasks if task is not None and task.key not in stored}.values()
        )
        say(f"{len(points)} points, {len(points) - len(missing)} of them known already, {count} workers")
        try:
            with closing(_compute(missing, fidelity, count, execution.run)) as finished:
                for task, failed, record in _stored(ledger, finished, fidelity):
                    stored[task.key] = (failed, record)
                    say(_progress_line(task, failed, record))
        except KeyboardInterrupt as stop:
            left = sum(task.key not in stored for task in missing)
            stop.add_note(
                f"{len(points) - left} of {len(points)} points are computed ({out / LEDGER_NAME}); the same command "
                f"computes the other {left}"
            )
            raise
        computed = [
            StudyPoint(values=values, failed=True, record={"error": error})
            if task is None
            else StudyPoint(values=values, failed=stored[task.key][0], record=stored[task.key][1])
            for values, task, error in zip(points, tasks, invalid, strict=True)
        ]
        found = StudyResult(
            case=case, fidelity=fidelity, design="grid", variations=variations, points=computed
        )
        write(found, out)
    reused = sum(task is not None for task in tasks) - len(missing)
    return StudyOutcome(result=found, completed=len(missing), reused=reused)


@contextmanager
def _alone_in(out: Path) -> Iterator[None]:
    """Hold the lock of the folder: a second study in it would compute every point twice."""
    try:
        lock = FileLock(out / LOCK_NAME)
    except HeldError as error:
        raise OutputError(
            f"output folder {out}: a study of {error.owner or 'another process'} runs in it; wait for its end, or "
            "give another folder with --out"
        ) from None
    except OSError as error:
        raise OutputError(
            f"output folder {out}: {error.strerror} for {LOCK_NAME}; give another folder with --out"
        ) from error
    with lock:
        yield


def _tasks(
    case: "Case", points: Sequence[dict[str, str]], fidelity: Fidelity
) -> tuple[list[_Task | None], list[str]]:
    """The points that are valid cases, None and a message for the others; raises if none is or ever could be."""
    tasks: list[_Task | None] = []
    errors: list[str] = []
    first: CaseError | None = None
    for values in points:
        try:
            varied = case
            for path, value in values.items():
                varied = varied.with_value(path, value)
        except CaseError as error:
            if any(fault.impossible for fault in error.faults):
                raise
            first = first or error
            tasks.append(None)
            errors.append(str(error))
        else:
            tasks.append(_Task(varied, values, point_key(varied.hash, fidelity)))
            errors.append("")
    if first is not None and not any(tasks):
        raise first
    return tasks, errors


def _compute(
    tasks: Sequence[_Task], fidelity: Fidelity, workers: int, run: Run | None
) -> Generator[tuple[_Task, bool, Record], None, None]:
    work = partial(_solve, fidelity=fidelity, run=run)
    for index, outcome in compute_all(work, [task.case for task in tasks], workers):
        failed, record = outcome or (True, {"error": "the worker process died; look for a lack of memory"})
        yield tasks[index], failed, record


def _stored(
    ledger: Ledger, finished: Iterator[tuple[_Task, bool, Record]], fidelity: Fidelity
) -> Iterator[tuple[_Task, bool, Record]]:
    """Every finished point, once it is in the ledger."""
    for task, failed, record in finished:
        ledger.store(
            task.key,
            fidelity=fidelity,
            case_hash=task.case.hash,
            inputs=task.values,
            failed=failed,
            record=record,
        )
        yield task, failed, record


def _solve(case: "Case", *, fidelity: Fidelity, run: Run | None) -> tuple[bool, Record]:
    """Compute one point in a worker; an error is a result that says what happened."""
    try:
        if run is None:
            from rigdesign.run.main import run_case

            result: RunResult = run_case(case, fidelity=fidelity)
        else:
            result = run(case, fidelity=fidelity)
        return False, _record(result)
    except RigdesignError as error:
        return True, {"error": str(error), "kind": type(error).__name__}
    except Exception as error:
        return True, {
            "error": f"{type(error).__name__}: {error}",
            "kind": type(error).__name__,
            "traceback": traceback.format_exc(),
        }


def _record(result: RunResult) -> Record:
    hottest = max((item.max_temperature_degC for item in result.thermal), default=None)
    checks = [{key: getattr(check, key) for key in CHECK_KEYS} for check in result.checks]
    record: Record = to_plain({"verdict": result.verdict, "max_temperature_degC": hottest, "checks": checks})
    return record


def _progress_line(task: _Task, failed: bool, record: Record) -> str:
    values = ", ".join(f"{path.rsplit('.', 1)[-1]} {value}" for path, value in task.values.items())
    outcome = str(record["error"]).partition("\n")[0] if failed else record["verdict"]
    return f"{values}: {outcome}"
