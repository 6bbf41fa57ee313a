"""A cheap stand-in for case and run, importable by the worker processes of a study."""

import json
import os
import sqlite3
import time
from concurrent.futures import Executor, Future
from contextlib import closing
from dataclasses import dataclass, field, replace
from hashlib import sha256
from pathlib import Path

from rigdesign.base.errors import CaseError, NotConvergedError
from rigdesign.case.assumptions import AssumptionRecord
from rigdesign.case.provenance import InputRow
from rigdesign.report.pages.study import write_study
from rigdesign.studies import run as study
from rigdesign.studies.design import StudyDesign
from tests.builders.report import make_check, make_result


def run_study(case, design, out, *, fidelity="standard", write=write_study, **execution):
    """A study with the page of the report, its execution by keywords; ``design`` may be the values of a grid."""
    if not isinstance(design, StudyDesign):
        design = StudyDesign(vary=(design,) if isinstance(design, str) else tuple(design))
    return study.run_study(
        case, design, out, write=write, fidelity=fidelity, execution=study.Execution(**execution)
    )


class InProcess(Executor):
    """Computes where it is called, one task after the other."""

    def submit(self, work, /, *arguments, **keywords):
        future = Future()
        try:
            future.set_result(work(*arguments, **keywords))
        except BaseException as error:
            future.set_exception(error)
        return future


STATED = {"oil.inlet": "80 degC", "gear.width": "7 mm", "oil.name": "FVA 3", "gear.teeth": "20"}


@dataclass(frozen=True)
class ExampleCase:
    """Has what a study needs of a case: name, title, hash, values to change, what they are."""

    log: str
    name: str = "example"
    title: str = "Example <rig>"
    values: dict[str, str] = field(default_factory=lambda: {**STATED})
    ranges: dict[str, tuple] = field(default_factory=lambda: {"gear.width": ("6 mm", "8 mm")})

    @property
    def hash(self) -> str:
        return sha256(json.dumps(self.values, sort_keys=True).encode()).hexdigest()

    def with_values(self, values):
        for path, value in values.items():
            if path not in self.values:
                raise CaseError(f"{path}: no such key; the nearest is oil.inlet")
            if value.startswith("-"):
                raise CaseError(f"{path} = {value}: below 0; give a positive value")
        return replace(self, values={**self.values, **values})

    def input_kind(self, path):
        if path not in self.values:
            return None
        return {"oil.name": "other", "gear.teeth": "whole number"}.get(path, "number")

    def copies_of(self, path):
        return ()

    @property
    def inputs(self):
        return tuple(InputRow(path=path, value=value) for path, value in self.values.items())

    @property
    def assumptions(self):
        return tuple(
            AssumptionRecord(path=path, value=self.values[path], reason="example", range=ends)
            for path, ends in self.ranges.items()
        )


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


VARIED = "oil.inlet=90 degC,100 degC,110 degC"


DRIVER = """
import sys
from pathlib import Path
sys.path.insert(0, {root!r})
from tests.builders.study import ExampleCase, run_example, run_study

if __name__ == "__main__":
    out = Path(sys.argv[1])
    case = ExampleCase(log=str(out.parent / (out.name + ".log")))
    run_study(case, "{values}", out, workers=2, run=run_example)
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
