"""One point of a study in a worker: the case with its values, computed, and what is kept of it."""

import pickle
import sys
import threading
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Literal, Protocol

from threadpoolctl import ThreadpoolController

from rigdesign.base.errors import MissingLibraryError, RigdesignError
from rigdesign.base.fidelity import Fidelity
from rigdesign.base.json_text import to_plain
from rigdesign.base.parallel import one_core
from rigdesign.base.version import __version__
from rigdesign.results.result import RunResult
from rigdesign.studies.result import CheckedPoint, Record, checked_point

if TYPE_CHECKING:
    from rigdesign.case import Case

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
