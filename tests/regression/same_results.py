"""Do two checkouts give the same numbers? Runs both on the shipped cases and measurement sets and compares their JSON.

    python -m tests.regression.same_results run CHECKOUT OUT      once for each checkout
    python -m tests.regression.same_results compare OUT OUT [--relative 1e-9] [--texts]

``compare`` wants every value equal but times; with ``--relative`` numbers may differ by that share, with ``--texts``
texts may differ. A change that moves and renames modules keeps every byte; one of words keeps every number.
"""

import argparse
import json
import math
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

COMMAND = "from rigdesign.cli.main import main; main()"
OLD_COMMAND = "from rigdesign.cli import main; main()"
CASES = ("loop_1to1", "loop_hunting", "uhcf_prototype", "uhcf_main")
TIMES = ("timings_s", "path", "seconds", "computed_in_s", "created", "duration_s")
"""Keys that may differ: times, and where the checkout lies."""


def jobs(checkout: Path) -> Iterator[tuple[str, list[str]]]:
    """Name and arguments of every run."""
    for case in CASES:
        yield f"check_{case}", ["check", f"cases/{case}", "--fidelity", "quick"]
    yield "check_standard", ["check", "cases/uhcf_prototype", "--fidelity", "standard"]
    for measured in sorted(checkout.glob("cases/*/measured/*")):
        case = measured.parents[1].name
        yield (
            f"diagnose_{case}_{measured.name}",
            ["diagnose", f"cases/{case}", str(measured.relative_to(checkout))],
        )


def run(checkout: Path, out: Path) -> None:
    command = COMMAND if (checkout / "rigdesign" / "cli").is_dir() else OLD_COMMAND
    environment = os.environ | {
        "PYTHONPATH": str(checkout), "RIGDESIGN_CACHE_DIR": str(out / "cache"), "OMP_NUM_THREADS": "1",
    }  # fmt: skip
    for name, arguments in jobs(checkout):
        folder = out / name
        if folder.is_dir():
            continue
        line = [sys.executable, "-c", command, *arguments, "--out", str(folder)]
        done = subprocess.run(
            line, cwd=checkout, env=environment, capture_output=True, text=True, check=False
        )
        print(f"{name}: exit {done.returncode}", flush=True)
        if done.returncode not in (0, 1):
            print(done.stderr[-2000:], flush=True)


def differences(before: Any, after: Any, relative: float, texts: bool, path: str = "") -> Iterator[str]:
    """Every place where two documents differ by more than they may."""
    if isinstance(before, dict) and isinstance(after, dict):
        for key in sorted(before.keys() | after.keys()):
            if key not in TIMES:
                missing = [name for name, side in (("before", before), ("after", after)) if key not in side]
                if missing:
                    yield f"{path}.{key}: not {missing[0]}"
                else:
                    yield from differences(before[key], after[key], relative, texts, f"{path}.{key}")
    elif isinstance(before, list) and isinstance(after, list) and len(before) == len(after):
        for number, (one, other) in enumerate(zip(before, after, strict=True)):
            yield from differences(one, other, relative, texts, f"{path}[{number}]")
    elif _is_number(before) and _is_number(after):
        if not math.isclose(before, after, rel_tol=relative, abs_tol=0.0):
            yield f"{path}: {before} -> {after}"
    elif before != after and not (texts and isinstance(before, str) and isinstance(after, str)):
        yield f"{path}: {str(before)[:80]} -> {str(after)[:80]}"


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def compare(before: Path, after: Path, relative: float, texts: bool) -> int:
    """Print what differs; the number of documents that do."""
    unequal = 0
    documents = sorted(path.relative_to(before) for path in before.glob("*/*.json"))
    for name in documents:
        if not (after / name).is_file():
            found = ["missing after"]
        else:
            sides = (json.loads((side / name).read_text(encoding="utf-8")) for side in (before, after))
            found = list(differences(*sides, relative, texts))
        unequal += bool(found)
        print(f"{name}: {'equal' if not found else f'{len(found)} differences'}")
        for line in found[:10]:
            print(f"    {line}")
    print(f"{len(documents) - unequal} of {len(documents)} documents equal")
    return unequal


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    commands = parser.add_subparsers(dest="command", required=True)
    running = commands.add_parser("run")
    running.add_argument("checkout", type=Path)
    running.add_argument("out", type=Path)
    comparing = commands.add_parser("compare")
    comparing.add_argument("before", type=Path)
    comparing.add_argument("after", type=Path)
    comparing.add_argument("--relative", type=float, default=0.0)
    comparing.add_argument("--texts", action="store_true")
    given = parser.parse_args()
    if given.command == "run":
        run(given.checkout.absolute(), given.out.absolute())
    else:
        sys.exit(bool(compare(given.before, given.after, given.relative, given.texts)))


if __name__ == "__main__":
    main()
