"""What the shipped cases are expected to give: ``cases/<name>/expected.json``, read, compared and written again.

    python -m tests.regression.expected [NAME ...] [--all]

from the root of the project runs the named cases (all without a name), carries over every verdict, and every
utilisation outside its tolerance, with ``--all`` every one; the reasons stay. What it changed is printed, and the
diff is to be read: a commit that moves a utilisation says why, and a reason that no longer holds is written anew. A
check that is new gets an empty reason, which tests/regression/test_cases.py refuses until it is written.
"""

import argparse
import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from rigdesign import load_case, run_case
from rigdesign.results.check import Check
from rigdesign.results.result import RunResult
from tests.builders.paths import CASES

NAMES = ("uhcf_prototype", "uhcf_main", "loop_1to1", "loop_hunting", "fzg", "strain_gauge_rig")
UTILISATION_TOLERANCE = 0.005
"""Relative. A wrong formula among many seldom moves a check by more than a few per cent."""
ROUNDING = 5e-4
"""Absolute, for what is nearly zero: inclinations and skew of axes there are how the surfaces happen to be divided."""
DECIMALS = 4

Document = dict[str, Any]
"""{fidelity, verdict, checks: {id: {verdict, utilisation, reason}}}"""


def read(name: str) -> Document:
    """The expected results of a shipped case."""
    document: Document = json.loads((CASES / name / "expected.json").read_text(encoding="utf-8"))
    return document


def run(name: str) -> RunResult:
    """A shipped case at the fidelity its expected results hold for."""
    return run_case(load_case(CASES / name), fidelity=read(name)["fidelity"])


def agrees(expected: float | None, found: float | None) -> bool:
    """Whether a utilisation is the expected one; None is one that does not exist."""
    if expected is None or found is None:
        return expected is found
    return abs(found - expected) <= max(UTILISATION_TOLERANCE * abs(expected), ROUNDING)


def renewed(document: Document, verdict: str, checks: Sequence[Check], *, every: bool = False) -> Document:
    """The document with the verdicts of ``checks`` and the utilisations that left their tolerance; with ``every``
    all of them. Reasons are kept, fidelity too."""
    return document | {
        "verdict": verdict,
        "checks": {check.id: _entry(document["checks"].get(check.id), check, every) for check in checks},
    }


def _entry(old: Mapping[str, Any] | None, check: Check, every: bool) -> Document:
    if old is None:
        old = {"utilisation": None, "reason": ""}
    found = None if check.utilisation is None else round(check.utilisation, DECIMALS)
    keeps = agrees(old["utilisation"], check.utilisation) and not every
    utilisation = old["utilisation"] if keeps else found
    return {"verdict": check.verdict, "utilisation": utilisation, "reason": old["reason"]}


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
            yield f"{key}: {_told(before)} -> {_told(after)}{_per_cent(before, after)}"


def _told(entry: Document) -> str:
    return f"{entry['verdict']} {entry['utilisation']}"


def _per_cent(before: Document, after: Document) -> str:
    first, second = before["utilisation"], after["utilisation"]
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
    parser.add_argument("--all", action="store_true", help="carry over every utilisation")
    given = parser.parse_args()
    if unknown := sorted(set(given.names) - set(NAMES)):
        parser.error(f"no shipped case {', '.join(unknown)}; there are {', '.join(NAMES)}")
    for name in given.names or NAMES:
        old, result = read(name), run(name)
        new = renewed(old, result.verdict, result.checks, every=given.all)
        write(name, new)
        for line in changes(old, new):
            print(f"{name}: {line}")


if __name__ == "__main__":
    main()
