"""Points of a study through workers and ledger: nothing that is stored is computed again."""

import pickle
import sys
import threading
import traceback
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Literal, Protocol

from threadpoolctl import ThreadpoolController

from rigdesign.base.errors import CaseError, MissingLibraryError, RigdesignError
from rigdesign.base.fidelity import Fidelity
from rigdesign.base.json_text import to_plain
from rigdesign.base.parallel import one_core
from rigdesign.base.version import __version__
from rigdesign.base.worker_pool import DIED, LostWorkersError, Workers
from rigdesign.results.result import RunResult
from rigdesign.studies.design import DesignPoint
from rigdesign.studies.ledger import Entry, Shard, StudyLedgers, point_key, read_points
from rigdesign.studies.result import CheckedPoint, Record, StudyPoint, checked_point

if TYPE_CHECKING:
    from rigdesign.case import Case

# One point of a study in a worker: the case with its values, computed, and what is kept of it.

CHECK_KEYS = (
    "id", "title", "group", "value", "limit", "upper_limit", "unit", "comparison", "margin", "distance", "verdict",
    "flags", "by_definition",
)  # fmt: skip
NO_MEMORY = "the worker has no memory left; give it more, or start fewer workers"

Status = Literal["done", "failed", "library missing", "defect"]


class Run(Protocol):
    """What computes one point: `from_base.FromBase`, `rigdesign.run_case` or a stand-in."""

    def __call__(self, case: "Case", *, fidelity: Fidelity) -> RunResult | CheckedPoint:
        """Compute one case."""


Prepare = Callable[["Case", Fidelity], Run]
"""Called once in every worker with the case of the study: what it returns computes the points there."""


@dataclass(frozen=True)
class PointSetup:
    """What all points of a study share; goes to the workers packed, and is unpacked once in each.

    run, prepare : one of them may stand in for `from_base.FromBase`; picklable
    """

    case: "Case"
    fidelity: Fidelity
    run: Run | None = None
    prepare: Prepare | None = None

    @property
    def functions(self) -> tuple[Run | Prepare | None, ...]:
        """Of the user."""
        return self.run, self.prepare

    def packed(self) -> bytes:
        """As `compute_point` takes it."""
        return pickle.dumps(self, protocol=pickle.HIGHEST_PROTOCOL)


@dataclass(frozen=True)
class PointOutcome:
    """What became of a point: a record of it (done, failed), or why the study has to stop.

    A point that cannot be computed is a result; a library that is missing is not the point's fault, and an error
    that nobody raised on purpose is a defect of the tool.

    version : of the tool in the worker, which may have joined a cluster after the start
    """

    status: Status
    record: Record
    version: str = ""


_ONE_POINT = threading.Lock()
"""Meshing and compiled threads allow one point at a time in a process, whatever threads the executor has."""


def compute_point(
    changes: Mapping[str, str], *, setup: bytes, loaded: tuple[Run | Prepare | None, ...] = ()
) -> PointOutcome:
    """Compute the case of ``setup`` with some of its values changed; never raises an `Exception`.

    loaded : functions in ``setup``, so that a worker that cannot load them fails before it computes
    """
    return replace(_computed(changes, setup), version=__version__)


def _computed(changes: Mapping[str, str], setup: bytes) -> PointOutcome:
    try:
        with _ONE_POINT, one_core(), _libraries(len(sys.modules)).limit(limits=1):
            case, fidelity, run = _unpacked(setup)
            return PointOutcome("done", record_of(run(case.with_values(changes), fidelity=fidelity)))
    except MissingLibraryError as error:
        return PointOutcome("library missing", {"error": str(error)})
    except RigdesignError as error:
        return PointOutcome("failed", {"error": str(error), "kind": type(error).__name__})
    except MemoryError:
        return PointOutcome("failed", {"error": NO_MEMORY, "kind": "MemoryError"})
    except Exception as error:
        return PointOutcome(
            "defect", {"error": f"{type(error).__name__}: {error}", "traceback": traceback.format_exc()}
        )


@lru_cache(maxsize=1)
def _libraries(modules: int) -> ThreadpoolController:
    """Libraries with threads in this process; looked for again where more Python modules are loaded than before."""
    return ThreadpoolController()


@lru_cache(maxsize=1)
def _unpacked(setup: bytes) -> tuple["Case", Fidelity, Run]:
    """Case and fidelity of a study and what computes its points, made once in a process."""
    shared: PointSetup = pickle.loads(setup)
    if shared.prepare is not None:
        return shared.case, shared.fidelity, shared.prepare(shared.case, shared.fidelity)
    if shared.run is not None:
        return shared.case, shared.fidelity, shared.run
    from rigdesign.studies.from_base import FromBase

    return shared.case, shared.fidelity, FromBase(shared.case, shared.fidelity)


def record_of(found: RunResult | CheckedPoint) -> Record:
    """What the ledger keeps of a computed case."""
    point = checked_point(found) if isinstance(found, RunResult) else found
    checks = [{key: getattr(check, key) for key in CHECK_KEYS} for check in point.checks]
    record: Record = to_plain(
        {"verdict": point.verdict, "max_temperature_degC": point.max_temperature_degC, "checks": checks}
    )
    return record


class PointDefectError(Exception):
    """An error of the tool itself while it computed a point; the study stops, the note holds the traceback."""


@dataclass(frozen=True)
class PointTask:
    """A point as a case: its key, or why it is no valid one."""

    point: DesignPoint
    key: str = ""
    case_hash: str = ""
    fault: str = ""


def tasks_of(
    case: "Case", points: Sequence[DesignPoint], fidelity: "Fidelity", *, one_valid: bool = True
) -> list[PointTask]:
    """The points as cases; one that is no valid case carries its fault.

    one_valid : whether one of them has to be a valid case; not in a later round of a search

    Raises
    ------
    CaseError
        If one has to be a valid case and none is, or a value is one its place can never hold.
    """
    tasks: list[PointTask] = []
    first: CaseError | None = None
    for point in points:
        try:
            found = case.with_values(point.changes).hash
        except CaseError as error:
            if any(fault.impossible for fault in error.faults):
                raise
            first = first or error
            tasks.append(PointTask(point, fault=str(error)))
        else:
            tasks.append(PointTask(point, point_key(found, fidelity, case.hash), found))
    if one_valid and first is not None and all(task.fault for task in tasks):
        raise first
    return tasks


@dataclass(frozen=True, kw_only=True)
class Listeners:
    """Callbacks for finished points.

    count : called with points done, points in all, and the last one in words
    remark : called with what is to know of the workers
    """

    count: Callable[[int, int, str], None]
    remark: Callable[[str], None]


class PointSolver:
    """Computes the points that are not stored, and stores each the moment it is finished.

    Parameters
    ----------
    setup : case, fidelity and what computes a point
    ledgers : where points are stored
    workers : compute them
    retry : compute points again that failed before
    shard : share of the points that is computed here, None for all
    """

    def __init__(
        self, setup: PointSetup, ledgers: StudyLedgers, workers: Workers, *, retry: bool, shard: Shard | None
    ) -> None:
        self.workers = workers
        self._setup = setup
        self._ledgers = ledgers
        self._shard = shard
        self._retry = retry
        self.known = self._usable(ledgers.stored())
        """Stored points: key -> (failed, record)."""
        self.computed: set[str] = set()
        """Keys of the points computed now."""

    @property
    def ledger(self) -> Path:
        """File of the points computed here."""
        return self._ledgers.path

    def tasks_of(self, points: Sequence[DesignPoint]) -> list[PointTask]:
        """Points of a later round of this study as cases."""
        return tasks_of(self._setup.case, points, self._setup.fidelity, one_valid=False)

    def share(self, tasks: Sequence[PointTask]) -> Sequence[PointTask]:
        """The tasks that are for this process, each once."""
        unique = list({task.key: task for task in tasks if not task.fault}.values())
        return unique if self._shard is None else self._shard.of(unique)

    def missing(self, tasks: Sequence[PointTask]) -> list[PointTask]:
        """The tasks to compute here."""
        return [task for task in self.share(tasks) if task.key not in self.known]

    def solve(self, tasks: Sequence[PointTask], listeners: Listeners, left: int = 0) -> None:
        """Compute what is missing of ``tasks``; ``left``: points that will follow, for the count.

        Raises
        ------
        PointDefectError
            An error that nobody raised on purpose; the point is not stored.
        MissingLibraryError
            A system library that a worker lacks.
        LostWorkersError
            If the workers are gone, or one has another version of the tool.
        OutputError
            If the ledger cannot be written.
        """
        missing = self.missing(tasks)
        if not missing:
            return
        work = partial(compute_point, setup=self._setup.packed(), loaded=self._setup.functions)
        changes = [dict(task.point.changes) for task in missing]
        self.workers.open(work, changes)
        if self.workers.remark and not self.computed:
            listeners.remark(self.workers.remark)
        whole = len(self.computed) + len(missing) + left
        with closing(self.workers.compute(work, changes)) as finished:
            for index, outcome in finished:
                task = missing[index]
                failed, record = _entry(task, outcome)
                self._store(task, failed, record)
                listeners.count(len(self.computed), whole, _progress_line(task, failed, record))

    def points(self, tasks: Sequence[PointTask]) -> list[StudyPoint]:
        """The tasks that are known, with what came of them."""
        found = []
        for task in tasks:
            values = dict(task.point.values)
            if task.fault:
                found.append(StudyPoint(values=values, failed=True, record={"error": task.fault}))
            elif task.key in self.known:
                failed, record = self.known[task.key]
                found.append(StudyPoint(values=values, failed=failed, record=record))
        return found

    def look_again(self) -> None:
        """Take over what the other shares have stored since; nothing to do without shares."""
        if self._shard is None:
            return
        self._ledgers.read_others()
        self.known = {**self._ledgers.stored(), **{key: self.known[key] for key in self.computed}}

    def look_at_ledger(self) -> None:
        """Take over a point that was stored when an interrupt came, before it was noted here."""
        self.known = {**self._usable(read_points(self.ledger)), **self.known}

    def _usable(self, stored: Mapping[str, Entry]) -> dict[str, Entry]:
        """The stored points that are not computed again."""
        return {key: entry for key, entry in stored.items() if not (self._retry and entry[0])}

    def _store(self, task: PointTask, failed: bool, record: Record) -> None:
        self._ledgers.ledger.store(
            task.key,
            fidelity=self._setup.fidelity,
            case_hash=task.case_hash,
            inputs=dict(task.point.values),
            failed=failed,
            record=record,
        )
        self.known[task.key] = (failed, record)
        self.computed.add(task.key)


def _entry(task: PointTask, outcome: PointOutcome | None) -> tuple[bool, Record]:
    """What the ledger keeps of an outcome; raises for one that stops the study."""
    if outcome is None:
        return True, {"error": DIED}
    if outcome.version != __version__:
        raise LostWorkersError(
            f"a worker that joined after the start has rigdesign {outcome.version or 'of another version'}, this study "
            f"is of rigdesign {__version__}: its point is not used; install 'rigdesign[cluster]=={__version__}' there "
            "and start it again"
        )
    if outcome.status == "library missing":
        raise MissingLibraryError(str(outcome.record["error"]))
    if outcome.status == "defect":
        defect = PointDefectError(f"point {_words(task)}: {outcome.record['error']}")
        defect.add_note(f"in the worker:\n{outcome.record['traceback']}")
        raise defect
    return outcome.status == "failed", outcome.record


def _words(task: PointTask) -> str:
    changed = task.point.changes.items()
    return ", ".join(f"{path} = {value}" for path, value in changed) or "as stated"


def _progress_line(task: PointTask, failed: bool, record: Record) -> str:
    values = [f"{path.rsplit('.', 1)[-1]} {value}" for path, value in task.point.changes.items()]
    more = f" and {len(values) - 3} more" if len(values) > 3 else ""
    outcome = str(record["error"]).partition("\n")[0] if failed else record["verdict"]
    return f"{', '.join(values[:3]) or 'as stated'}{more}: {outcome}"
