"""Known functions in place of a rig, importable by workers: what a study finds in them has a closed form."""

import os
import time
from dataclasses import dataclass, field, replace
from functools import cache
from hashlib import sha256
from math import pi, sin
from pathlib import Path

from rigdesign.base.errors import CaseError, NotConvergedError
from rigdesign.case.assumptions import AssumptionRecord
from rigdesign.case.provenance import InputRow
from tests.builders.report import make_check, make_result


@dataclass(frozen=True)
class NumberCase:
    """A case of bare numbers.

    ranges : of those that are assumed
    folder : where the points leave their trace, if anywhere
    """

    values: dict[str, str]
    ranges: dict[str, tuple[str, str]] = field(default_factory=dict)
    names: tuple[str, ...] = ()
    whole: tuple[str, ...] = ()
    folder: str = ""
    name: str = "numbers"
    title: str = "Numbers"

    @property
    def hash(self):
        return sha256(repr(sorted(self.values.items())).encode()).hexdigest()

    def with_values(self, values):
        for path in values:
            if path not in self.values:
                raise CaseError(f"{path}: no such path; did you mean {next(iter(self.values))}?")
        return replace(self, values={**self.values, **values})

    def input_kind(self, path):
        if path not in self.values:
            return None
        return "other" if path in self.names else "whole number" if path in self.whole else "number"

    def copies_of(self, path):
        return ()

    def number(self, path):
        return float(self.values[path].split()[0])

    @property
    def inputs(self):
        return tuple(InputRow(path=path, value=value) for path, value in self.values.items())

    @property
    def assumptions(self):
        return tuple(
            AssumptionRecord(path=path, value=self.values[path], reason="example", range=ends)
            for path, ends in self.ranges.items()
        )


def result_of(**values):
    """A result whose checks have these values against a limit of 1."""
    checks = [make_check(name, value, 1.0, unit="1") for name, value in values.items()]
    verdict = "fail" if any(value > 1.0 for value in values.values()) else "pass"
    return replace(_template(), checks=checks, verdict=verdict)


@cache
def _template():
    return make_result(dynamics=None, expansion=[], fields=[])


ISHIGAMI = NumberCase(dict.fromkeys(("x1", "x2", "x3"), "0"))


def ishigami(case, *, fidelity):
    """Ishigami and Homma (1990), a = 7, b = 0.1, moved to positive values; and a check that never moves."""
    x1, x2, x3 = (case.number(name) for name in ("x1", "x2", "x3"))
    value = sin(x1) + 7.0 * sin(x2) ** 2 + 0.1 * x3**4 * sin(x1)
    return result_of(ishigami=value + 20.0, constant=0.5)


def ishigami_indices():
    """First-order and total indices in closed form."""
    a, b = 7.0, 0.1
    variance = a**2 / 8 + b * pi**4 / 5 + b**2 * pi**8 / 18 + 0.5
    first = (0.5 * (1 + b * pi**4 / 5) ** 2 / variance, a**2 / 8 / variance, 0.0)
    mixed = b**2 * pi**8 * (1 / 18 - 1 / 50) / variance
    return first, (first[0] + mixed, first[1], mixed)


CURVES = NumberCase(
    {"oil.inlet": "100 degC", "oil.name": "FVA 3", "gear.teeth": "20"},
    names=("oil.name",),
    whole=("gear.teeth",),
)


def curves(case, *, fidelity):
    """Over the oil temperature: a check that breaks once, one that holds in a window, one that always breaks."""
    inlet = case.number("oil.inlet")
    if inlet == 123:
        raise NotConvergedError("temperature: 3 K above the limit of 0.05 K after 40 passes; relax the loop")
    return result_of(
        rising=inlet / 117.3,
        window=1.0 + ((inlet - 100.0) / 12.0) ** 2 - 0.25,
        narrow=1.02 - ((inlet - 91.3) / 20.0) ** 2,
        always=2.0,
        teeth=case.number("gear.teeth") / 33.5,
    )


def slow(case, *, fidelity):
    """A point of some tenths of a second that says where and when it is computed."""
    folder = Path(case.folder)
    (folder / f"begun-{os.getpid()}-{time.monotonic_ns()}").write_text(case.values["oil.inlet"])
    time.sleep(0.3)
    result = curves(case, fidelity=fidelity)
    (folder / f"ended-{os.getpid()}-{time.monotonic_ns()}").write_text(case.values["oil.inlet"])
    return result


def deadly(case, *, fidelity):
    """A point that takes its worker with it."""
    if case.number("oil.inlet") == 100:
        os._exit(9)
    return curves(case, fidelity=fidelity)


def defective(case, *, fidelity):
    """A defect of the tool at one point."""
    if case.number("oil.inlet") == 100:
        raise ZeroDivisionError("a defect")
    return curves(case, fidelity=fidelity)


class PreparedCurves:
    """What `prepare_curves` makes of the base case."""

    def __init__(self, case, fidelity):
        self.case, self.fidelity = case, fidelity

    def __call__(self, case, *, fidelity):
        assert fidelity == self.fidelity
        return curves(case, fidelity=fidelity)


def prepare_curves(case, fidelity):
    """Leaves one file for each time it is called."""
    (Path(case.folder) / f"prepared-{os.getpid()}-{time.monotonic_ns()}").touch()
    return PreparedCurves(case, fidelity)
