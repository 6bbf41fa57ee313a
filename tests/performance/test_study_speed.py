"""Points of an oil temperature study against the check of the same case: what starts from the base case costs less."""

import time

import pytest

from rigdesign import load_case
from rigdesign.run.main import run_case
from rigdesign.studies.from_base import FromBase

pytestmark = pytest.mark.performance

INLET = "gearboxes.test.oil.inlet_temperature"


def seconds(work) -> float:
    start = time.process_time()
    work()
    return time.process_time() - start


def test_a_point_costs_a_share_of_a_check(monkeypatch: pytest.MonkeyPatch) -> None:
    """One process, one thread, processor time; the base case is solved before."""
    monkeypatch.setattr("rigdesign.base.parallel.cores", lambda: 1)
    case = load_case("uhcf_prototype")
    run_case(case, "quick")  # kernels are compiled
    whole = seconds(lambda: run_case(case, "standard"))
    solve = FromBase(case, "standard")
    base = seconds(lambda: solve(case.with_value(INLET, "139 degC"), fidelity="standard"))
    inlets = (60, 80, 100, 120, 130)
    points = [
        seconds(lambda inlet=inlet: solve(case.with_value(INLET, f"{inlet} degC"), fidelity="standard"))
        for inlet in inlets
    ]
    mean = sum(points) / len(points)
    print(
        f"\ncheck {whole:.1f} s, base case {base:.1f} s, a point {mean:.1f} s: {mean / whole:.2f} of a check"
    )
    print(f"100 points on two cores, base case on each: {(base + 50 * mean) / whole:.1f} checks on one")
