"""Mutants of the shipped case through the whole chain: whatever a case says, no traceback.

A mutant is the shipped case with one number times 0.1 to 10 (even in its logarithm) or one choice or reference
exchanged for another text that stands under the same key. Each goes the way of `rigdesign check --fidelity quick
--json`: load, run, document. It ends in a result or in an error of the tool's own tree with a message; anything else
is a defect.

So that many can be run, the base is shortened first (`tests.builders.shortened`).
"""

import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import islice

import pytest

from rigdesign.base.errors import CaseError, NotConvergedError, RigdesignError
from rigdesign.case import Case, load_case
from rigdesign.report.results_json import results_document
from rigdesign.run.main import run_case
from tests.builders.mutant import mutations
from tests.builders.paths import CASES
from tests.builders.shortened import shortened_case
from tests.builders.twisting import OWN_EVERY, twisting_case

PROTOTYPE = CASES / "uhcf_prototype"
SEEDS, PER_SEED, RUN = 2, 10, 2
MANY = 1000


@dataclass(frozen=True)
class Outcome:
    """What became of one mutant; ``reached`` says that it passed validation and came to a solver."""

    path: str
    value: object
    kind: str
    reached: bool
    seconds: float
    message: str = ""


@cache
def shortened() -> Case:
    return shortened_case(load_case(PROTOTYPE))


def mutants(seed: int, count: int) -> list[tuple[str, object]]:
    """Paths and values of ``count`` mutants; the same seed gives the same."""
    return list(islice(mutations(shortened(), seed), count))


class SolverReachedError(Exception):
    """The mutant passed validation and the assembly of the rig: the coupling loop begins."""


def until_coupling(line: str) -> None:
    """Progress that ends a run where its first solver begins."""
    if line.startswith("coupling"):
        raise SolverReachedError


def reaches_a_solver(path: str, value: object) -> bool:
    """True if a mutant is valid up to the coupling loop, which is not run."""
    try:
        run_case(shortened().with_value(path, value), fidelity="quick", progress=until_coupling)
    except SolverReachedError:
        return True
    except RigdesignError:
        return False
    raise AssertionError(f"{path}: ran through without a line of the coupling loop")


def outcome(path: str, value: object, *, own: bool = True) -> Outcome:
    """Run one mutant as the command does; an exception outside the tool's own tree is not caught.

    own : with the shafts and teeth of the case
    """
    started = time.perf_counter()
    said: list[str] = []
    try:
        base = shortened() if own else twisting_case(shortened())
        result = run_case(base.with_value(path, value), fidelity="quick", progress=said.append)
        assert results_document(result)["verdict"] in ("pass", "open", "fail")
        kind, message = "solved", ""
    except CaseError as error:
        kind, message = "refused", str(error)
    except NotConvergedError as error:
        kind, message = "not converged", str(error)
    except RigdesignError as error:
        kind, message = type(error).__name__, str(error)
    reached = any(line.startswith("coupling") for line in said)
    return Outcome(path, value, kind, reached, time.perf_counter() - started, message)


def judge(outcomes: Sequence[Outcome]) -> None:
    """Every end has words, and only errors of the right kinds occur."""
    for entry in outcomes:
        assert entry.kind in ("solved", "refused", "not converged"), entry
        assert entry.kind == "solved" or len(entry.message.split()) > 4, entry


def test_mutants_end_in_a_result_or_a_plain_error() -> None:
    judge([outcome(path, value) for path, value in mutants(0, RUN)])


def test_half_of_the_mutants_come_to_a_solver() -> None:
    reached = [
        reaches_a_solver(path, value) for seed in range(SEEDS) for path, value in mutants(seed, PER_SEED)
    ]
    assert sum(reached) >= len(reached) / 2


@pytest.mark.slow
def test_a_thousand_mutants(capsys: pytest.CaptureFixture[str]) -> None:
    outcomes = [
        outcome(path, value, own=number % OWN_EVERY == 0)
        for number, (path, value) in enumerate(mutants(2026, MANY))
    ]
    seconds = sorted(entry.seconds for entry in outcomes)
    with capsys.disabled():
        print(f"\n{MANY} mutants: {sum(entry.reached for entry in outcomes)} came to a solver")
        print(", ".join(f"{count} {kind}" for kind, count in Counter(o.kind for o in outcomes).items()))
        print(f"median {seconds[MANY // 2]:.1f} s, longest {seconds[-1]:.1f} s, sum {sum(seconds):.0f} s")
    judge(outcomes)
