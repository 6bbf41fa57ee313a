"""Parameter studies: a case over values of its inputs, resumable, with failed points kept."""

import csv
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from rigdesign.base.errors import UsageError
from rigdesign.base.fidelity import Fidelity
from rigdesign.base.output_folder import prepare_output
from rigdesign.base.worker_pool import LostWorkersError, ProcessWorkers, Workers, worker_count
from rigdesign.studies.analysis import analysed, computed_so_far, kept_by_copies
from rigdesign.studies.design import Plan, StudyDesign, planned
from rigdesign.studies.ledger import Shard, StudyLedgers, files_lock, folder_lock
from rigdesign.studies.result import StudyPoint, StudyResult
from rigdesign.studies.solver import (
    Listeners,
    PointDefectError,
    PointSetup,
    PointSolver,
    PointTask,
    Prepare,
    Run,
    tasks_of,
)

if TYPE_CHECKING:
    from rigdesign.case import Case


class Writer(Protocol):
    """What writes the files of a study; `rigdesign.report.pages.study.write_study`."""

    def __call__(self, study: StudyResult, out: Path) -> None:
        """Write them to ``out``."""


@dataclass(frozen=True, kw_only=True)
class StudyOutcome:
    """What is known of a study: how many points were computed now, found done, and left to other shares.

    The files are written when no point is missing.
    """

    result: StudyResult
    completed: int
    reused: int
    missing: int = 0

    @property
    def points(self) -> Sequence[StudyPoint]:
        """The points that are known, in the order of the design."""
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

    workers : processes on this machine, one thread each, or the address of a dask scheduler,
        ``"tcp://host:8786"``; None for one process per core
    executor : any `concurrent.futures.Executor` in place of ``workers``; it is not shut down
    shard : share of the points that is computed, of a study that several jobs compute in one folder
    retry : compute points again that failed before
    progress : called with what is being done, and with a line per finished point where there is no ``count``
    count : called with points done, points in all (of those to be computed) and the last one
    note : called with what the user has to know of, such as a damaged ledger; ``progress`` if left out
    run : picklable stand-in for `from_base.FromBase`; not part of what makes two points the same
    prepare : picklable; called once in every worker with the case of the study, what it returns is its ``run``
    """

    workers: int | str | None = None
    executor: Executor | None = None
    shard: Shard | None = None
    retry: bool = False
    progress: Callable[[str], None] | None = None
    count: Callable[[int, int, str], None] | None = None
    note: Callable[[str], None] | None = None
    run: Run | None = None
    prepare: Prepare | None = None

    def say(self, line: str) -> None:
        """Pass a line of progress on."""
        if self.progress is not None:
            self.progress(line)

    def tell(self, line: str) -> None:
        """Pass on what the user has to know of."""
        (self.note or self.say)(line)

    def finished(self, done: int, whole: int, last: str) -> None:
        """Pass on that a point is finished."""
        if self.count is not None:
            self.count(done, whole, last)
        else:
            self.say(last)


DEFAULT = Execution()
"""One process per core, silent."""


def run_study(
    case: "Case",
    design: StudyDesign,
    out: Path,
    *,
    write: Writer,
    fidelity: Fidelity = "standard",
    execution: Execution = DEFAULT,
) -> StudyOutcome:
    """Compute the points of a study of ``case`` and write its files to ``out``.

    A point goes to the ledger in ``out`` the moment it is finished; the same call again computes only what is
    missing. Points are the same when resolved case, tool version and fidelity are. The files depend on the points
    only, not on interruptions, workers, shares or time. A point that cannot be computed is a result.

    Parameters
    ----------
    case : base case; ``with_values`` makes a point of it
    design : what is varied, and how the points are chosen
    write : writes the files while the folder is still locked
    execution : workers, share, progress, points to compute again

    Raises
    ------
    UsageError
        A design that cannot be made or contradicts itself, a pattern of checks that matches none, workers that
        do not exist or have another version of the tool.
    CaseError
        If no point is a valid case (a path that does not exist, say), or a value is none its place can hold
        whatever else the case says (a choice or an oil that does not exist); nothing is written then.
    OutputError
        If ``out`` cannot be written or another study runs in it.
    LostWorkersError, MissingLibraryError
        Workers that are gone, or lack a library.
    PointDefectError
        A defect of the tool. What was computed stays, here and after every other error.
    KeyboardInterrupt
        With a note that says what is stored and how to go on.
    """
    if execution.shard is not None and design.boundary:
        raise UsageError(
            "--shard: a boundary search chooses its points as it goes, so that they cannot be shared out beforehand; "
            "leave --shard out, or give several --workers"
        )
    plan = planned(case, design)
    if execution.run is None and execution.prepare is None:
        plan.require_checks(case)
    for finding in kept_by_copies(case, plan):
        execution.tell(finding.text)
    execution.say(f"{len(plan.points)} points: are they valid cases")
    tasks = tasks_of(case, plan.points, fidelity)
    workers = _workers(execution)
    prepare_output(out)
    out.mkdir(parents=True, exist_ok=True)
    with folder_lock(out, execution.shard), StudyLedgers(out, execution.shard) as ledgers, workers:
        for line in (*ledgers.repaired, *replaced_pages(out, plan)):
            execution.tell(line)
        setup = PointSetup(case, fidelity, execution.run, execution.prepare)
        solver = PointSolver(setup, ledgers, workers, retry=execution.retry, shard=execution.shard)
        own = execution.run is None and execution.prepare is None
        if own and isinstance(workers, ProcessWorkers) and solver.missing(tasks):
            _prepare_teeth(case, fidelity, execution.say)
        with _left_over(solver, tasks):
            _compute(plan, tasks, solver, execution)
        solver.look_again()
        points = solver.points(tasks)
        missing = len(tasks) - len(points)
        concluded = analysed if missing == 0 else computed_so_far
        result = concluded(case, fidelity, plan, points)
        if missing == 0:
            with files_lock(out, execution.shard) as free:
                if free:
                    write(result, out)
    computed = len(solver.computed)
    known = sum(not task.fault for task in tasks) - missing
    return StudyOutcome(result=result, completed=computed, reused=known - computed, missing=missing)


def _prepare_teeth(case: "Case", fidelity: Fidelity, say: Callable[[str], None]) -> None:
    """Influence numbers of the base case, stored before every worker computes them; a base case may have no rig."""
    from rigdesign.base.errors import RigdesignError
    from rigdesign.rig.model import build_rig
    from rigdesign.run.solver_errors import solver_errors

    with suppress(RigdesignError), solver_errors(case):
        rig = build_rig(case, fidelity)
        if rig.mesh_stiffness == "influence_numbers":
            rig.prepare_teeth(say)


def _workers(execution: Execution) -> Workers:
    if execution.executor is not None:
        return Workers(execution.executor)
    if isinstance(execution.workers, str):
        from rigdesign.base.cluster import ClusterWorkers

        return ClusterWorkers(execution.workers)
    return ProcessWorkers(worker_count(execution.workers))


def _compute(plan: Plan, tasks: list[PointTask], solver: PointSolver, execution: Execution) -> None:
    """Compute what is missing, round by round: a boundary search adds to ``tasks`` what it needs next."""
    missing = len(solver.missing(tasks))
    execution.say(f"{len(tasks)} points, {len(tasks) - missing} of them known already, {solver.workers}")
    listeners = Listeners(count=execution.finished, remark=execution.tell)
    new = list(tasks)
    while new:
        solver.solve(new, listeners, left=plan.left(solver.points(tasks)))
        new = solver.tasks_of(plan.more(solver.points(tasks)))
        tasks += new


@contextmanager
def _left_over(solver: PointSolver, tasks: Sequence[PointTask]) -> Iterator[None]:
    """Whatever stops the study from outside the points says what is stored and how to go on."""
    try:
        yield
    except (KeyboardInterrupt, LostWorkersError, PointDefectError) as stop:
        solver.look_at_ledger()
        left, whole = len(solver.missing(tasks)), len(solver.share(tasks))
        text = (
            f"{whole - left} of {whole} points are computed ({solver.ledger}); the same command computes the other "
            f"{left}"
        )
        if isinstance(stop, KeyboardInterrupt):
            stop.add_note(text)
        else:
            stop.args = (f"{stop}; {text}", *stop.args[1:])
        raise


# Whether the folder of a study holds the pages of another one, which those of this one will replace.

TABLE, STATUS = "results.csv", "status"
"""Table of a study, and its first column behind the varied values."""


def replaced_pages(out: Path, plan: Plan) -> Iterator[str]:
    """A sentence where ``out`` holds the table of a study with points that ``plan`` has not."""
    with suppress(OSError, UnicodeError, csv.Error, StopIteration):
        with (out / TABLE).open(encoding="utf-8", newline="") as file:
            rows = csv.reader(file)
            header = next(rows)
            paths = header[: header.index(STATUS)] if STATUS in header else []
            earlier = {tuple(zip(paths, row)) for row in rows} if paths else set()
        same_inputs = paths == [variation.path for variation in plan.variations]
        now = {tuple(point.values.items()) for point in plan.points}
        if not (earlier <= now or (plan.search is not None and same_inputs)):
            yield (
                f"{out} holds the pages of a study of {', '.join(paths)} with {len(earlier)} points: those of this "
                "study replace them; its points stay, and its command in this folder writes its pages again without "
                "computing; give another --out to keep both"
            )
