"""What the shipped cases are expected to give: ``cases/<name>/expected.json``, read, compared and written again.

    python -m tests.regression.expected [NAME ...] [--all]

from the root of the project runs the named cases (all without a name) at their default fidelity, carries over every
verdict, and every value outside its tolerance, with ``--all`` every one; the reasons stay. A check that does not apply
has no entry. What it changed is printed,
and the diff is to be read: a commit that moves a value says why, and a reason that no longer holds is written anew. A
check that is new gets an empty reason, which tests/regression/test_cases.py refuses until it is written.
"""

import argparse
import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from rigdesign import load_case, run_case
from rigdesign.base.fidelity import Fidelity
from rigdesign.results.check import Check
from tests.builders.paths import CASES

NAMES = ("uhcf_prototype", "uhcf_main", "loop_1to1", "loop_hunting", "fzg", "strain_gauge_rig")
FIDELITY: Fidelity = "standard"
"""The default of `rigdesign check`."""
TOLERANCE = 0.005
"""Relative. A wrong formula among many seldom moves a value by more than a few per cent."""
ROUNDING = 5e-4
"""Share of the limit, for what is nearly zero: inclinations and skew of axes there are how surfaces are divided."""
DIGITS = 6

Document = dict[str, Any]
"""{verdict, checks: {id: {verdict, value, reason}}}, of the checks that apply; verdict: `Check.status`."""
NOT_APPLICABLE = "not applicable"


def read(name: str) -> Document:
    """The expected results of a shipped case."""
    document: Document = json.loads((CASES / name / "expected.json").read_text(encoding="utf-8"))
    return document


def agrees(expected: float | None, check: Check) -> bool:
    """Whether the value of a check is the expected one; None is one that does not exist."""
    if expected is None or check.value is None:
        return expected is check.value
    return abs(check.value - expected) <= max(TOLERANCE * abs(expected), ROUNDING * abs(check.limit or 0.0))


def renewed(document: Document, verdict: str, checks: Sequence[Check], *, every: bool = False) -> Document:
    """The document with the verdicts of ``checks`` and the values that left their tolerance; with ``every`` all."""
    old = document["checks"]
    return {
        "verdict": verdict,
        "checks": {
            check.id: _entry(old.get(check.id), check, every)
            for check in checks
            if check.status != NOT_APPLICABLE
        },
    }


def _entry(old: Mapping[str, Any] | None, check: Check, every: bool) -> Document:
    keeps = old is not None and not every and agrees(old["value"], check)
    found = None if check.value is None else float(f"{check.value:.{DIGITS}g}")
    value = old["value"] if old is not None and keeps else found
    return {"verdict": check.status, "value": value, "reason": "" if old is None else old["reason"]}


def changes(old: Document, new: Document) -> Iterator[str]:
    """One line for every check that differs, and for the verdict of the case."""
    if old["verdict"] != new["verdict"]:
        yield f"verdict {old['verdict']} -> {new['verdict']}"
    for key in dict.fromkeys((*old["checks"], *new["checks"])):
        before, after = old["checks"].get(key), new["checks"].get(key)
        if before == after:
            continue
        if before is None or after is None:
            yield f"{key}: {'new, reason to be written' if before is None else 'gone'}"
        else:
            texts = (f"{entry['verdict']} {entry['value']}" for entry in (before, after))
            yield f"{key}: {' -> '.join(texts)}{_per_cent(before, after)}"


def _per_cent(before: Document, after: Document) -> str:
    first, second = before["value"], after["value"]
    moved = first and second is not None and first != second
    return f" ({100.0 * (second / first - 1.0):+.2f} %)" if moved else ""


def write(name: str, document: Document) -> None:
    """Replace the expected results of a shipped case."""
    text = json.dumps(document, indent=1, ensure_ascii=False) + "\n"
    (CASES / name / "expected.json").write_text(text, encoding="utf-8", newline="\n")


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(NAMES))
    parser.add_argument("--all", action="store_true", help="carry over every value")
    given = parser.parse_args()
    if unknown := sorted(set(given.names) - set(NAMES)):
        parser.error(f"no shipped case {', '.join(unknown)}; there are {', '.join(NAMES)}")
    for name in given.names or NAMES:
        old, result = read(name), run_case(load_case(CASES / name), FIDELITY)
        new = renewed(old, result.verdict, result.checks, every=given.all)
        write(name, new)
        for line in changes(old, new):
            print(f"{name}: {line}")


if __name__ == "__main__":
    main()
