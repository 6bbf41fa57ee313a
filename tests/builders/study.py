"""A cheap stand-in for case and run, importable by the worker processes of a study."""

import json
import os
import sqlite3
import time
from contextlib import closing
from dataclasses import dataclass, field, replace
from hashlib import sha256
from pathlib import Path

from rigdesign.base.errors import CaseError, NotConvergedError
from rigdesign.report.pages.study import write_study
from rigdesign.studies import run as study
from rigdesign.studies.run import parse_variation
from tests.builders.report import make_check, make_result


def run_study(case, variations, out, *, fidelity="standard", **execution):
    """A study with the page of the report, its execution by keywords."""
    return study.run_study(
        case, variations, out, write=write_study, fidelity=fidelity, execution=study.Execution(**execution)
    )


@dataclass(frozen=True)
class ExampleCase:
    """Has what a study needs of a case: name, title, hash, with_value."""

    log: str
    name: str = "example"
    title: str = "Example <rig>"
    values: dict[str, str] = field(default_factory=lambda: {"oil.inlet": "80 degC", "gear.width": "7 mm"})

    @property
    def hash(self) -> str:
        return sha256(json.dumps(self.values, sort_keys=True).encode()).hexdigest()

    def with_value(self, path, value):
        if path not in self.values:
            raise CaseError(f"{path}: no such key; the nearest is oil.inlet")
        if value.startswith("-"):
            raise CaseError(f"{path} = {value}: below 0; give a positive value")
        return replace(self, values={**self.values, path: value})


def run_example(case, *, fidelity):
    """A result whose gap closes with the oil temperature; logs begin and end of the computation."""
    _log(case, "begin")
    time.sleep(0.2)
    inlet = float(case.values["oil.inlet"].split()[0])
    if inlet == 666:
        os._exit(9)
    if inlet == 120:
        raise NotConvergedError("temperature: 3 K above the limit of 0.05 K after 40 passes; relax the loop")
    if inlet == 121:
        raise ZeroDivisionError("a defect")
    gap = 1.0 - 0.006 * inlet
    limit = 0.05 * float(case.values["gear.width"].split()[0])
    result = make_result(
        checks=[
            make_check("seal_gap", gap, limit, comparison=">="),
            make_check("oil_outlet", inlet + 11, 150.0, unit="degC"),
        ],
        verdict="fail" if gap < limit else "pass", dynamics=None, expansion=[], fields=[],
    )  # fmt: skip
    _log(case, "end")
    return result


def _log(case, what):
    with Path(case.log).open("a", encoding="utf-8") as log:
        log.write(f"{what} {os.getpid()} {case.values['oil.inlet']} {case.values['gear.width']}\n")


VARIED = [parse_variation("oil.inlet=90 degC,100 degC,110 degC")]


def in_process(work, tasks, workers):  # type: ignore[no-untyped-def]
    """Stands in for the pool of processes."""
    for index, task in enumerate(tasks):
        yield index, work(task)


DRIVER = """
import sys
from pathlib import Path
sys.path.insert(0, {root!r})
from rigdesign.studies.run import parse_variation
from tests.builders.study import ExampleCase, run_example, run_study

if __name__ == "__main__":
    out = Path(sys.argv[1])
    case = ExampleCase(log=str(out.parent / (out.name + ".log")))
    run_study(case, [parse_variation("{values}")], out, workers=2, run=run_example)
"""


POINTS = 15


def _stored(out):
    if not (out / "ledger.sqlite").exists():
        return 0
    try:
        with closing(sqlite3.connect(out / "ledger.sqlite")) as connection:
            return connection.execute("SELECT COUNT(*) FROM points").fetchone()[0]
    except sqlite3.OperationalError:
        return 0


def _events(log, what):
    return log.read_text().count(what) if log.exists() else 0
