"""Mutation run over rigdesign, thermal and dynamics: draw mutants, run the tests that reach them, count.

    python -m tests.mutation run --out FOLDER [--count 180] [--seed 15] [--only PATH ...] [--files 0] [--seconds 300]
    python -m tests.mutation report --out FOLDER

``run`` goes on where it stopped. README.md says what it does.
"""

import argparse
import json
from collections import Counter
from dataclasses import asdict
from pathlib import Path
from typing import Any

from tests.mutation.sample import PACKAGES, drawn
from tests.mutation.trial import Limits, copied_project, tried


def run(out: Path, count: int, seed: int, only: tuple[str, ...], limits: Limits) -> None:
    out.mkdir(parents=True, exist_ok=True)
    done = {row["mutant"] for row in results(out)}
    mutants = [mutant for mutant in drawn(count, seed, only) if mutant.name not in done]
    with copied_project() as project, (out / "trials.jsonl").open("a", encoding="utf-8") as file:
        for mutant in mutants:
            trial = tried(mutant, project, out, limits)
            file.write(json.dumps(asdict(trial)) + "\n")
            file.flush()
            print(f"{trial.outcome:11s} {trial.seconds:6.1f} s  {trial.mutant}  {trial.by}", flush=True)


def results(out: Path) -> list[dict[str, Any]]:
    file = out / "trials.jsonl"
    return (
        [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()] if file.is_file() else []
    )


def report(out: Path) -> None:
    """Counts by package, then every mutant that lived."""
    rows = results(out)
    print("package      mutants  killed  endless  survived  not reached  undecided  killed %")
    for package in (*PACKAGES, ""):
        counts = Counter(row["outcome"] for row in rows if row["module"].startswith(package))
        if whole := counts.total():
            gone = counts["killed"] + counts["endless"]
            print(
                f"{package or 'all':12s} {whole:7d} {counts['killed']:7d} {counts['endless']:8d} "
                f"{counts['survived']:9d} {counts['not reached']:12d} {counts['undecided']:10d} "
                f"{100.0 * gone / whole:9.1f}"
            )
    for row in rows:
        if row["outcome"] not in ("killed", "endless"):
            print(f"\n{row['mutant']} ({row['outcome']}, {row['files']} test files)\n    {row['change']}")


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("command", choices=("run", "report"))
    parser.add_argument(
        "--out", type=Path, required=True, help="folder for reach and results; not in the checkout"
    )
    parser.add_argument("--count", type=int, default=180)
    parser.add_argument("--seed", type=int, default=15)
    parser.add_argument(
        "--only", nargs="*", default=(), help="modules or folders, as rigdesign/coupling/losses.py"
    )
    parser.add_argument("--files", type=int, default=0, help="test files asked, nearest first; 0 for all")
    parser.add_argument("--seconds", type=float, default=300.0, help="of tests run against one mutant")
    given = parser.parse_args()
    if given.command == "run":
        limits = Limits(files=given.files, seconds=given.seconds)
        run(given.out.absolute(), given.count, given.seed, tuple(given.only), limits)
    report(given.out.absolute())


if __name__ == "__main__":
    main()
