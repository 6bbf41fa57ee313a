"""The blind score: makes sets, fits the calibration to healthy ones, diagnoses the others, counts.

    python -m tests.blind.score generate null plain --out WORK
    python -m tests.blind.score calibrate --out WORK [--without RIG]
    python -m tests.blind.score run dev plain --out WORK [--calibration FILE]
    python -m tests.blind.score run test plain --out WORK --commit HASH
    python -m tests.blind.score report dev plain --out WORK [--floor measured]

A report counts detectable sizes over the floor declared before any set was diagnosed, or over the one they were drawn
by (`tests.virtual_rig.detect`); `generate` adds these to answers that were stored without them. Every step goes
on where it was stopped. Sets and results stay in WORK, outside of the repository.
"""

import argparse
import csv
import json
import shutil
import tempfile
import time
import tomllib
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from rigdesign.case import load_case
from rigdesign.case.model import Case
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.decision.defaults import DEFAULT, Calibration
from rigdesign.diagnosis.residual.baseline import Drift
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem, plain
from rigdesign.diagnosis.run import diagnose_measurement, read_residuals
from rigdesign.diagnosis.statistics.amplitudes import Amplitudes
from rigdesign.measurement import load_measurement
from tests.blind.ablations import ABLATIONS
from tests.blind.calibration import calibrate as fit_all
from tests.blind.calibration import calibrate_drift
from tests.blind.comparators import COMPARATORS, comparators
from tests.blind.covariance_inflation import inflate_drift
from tests.blind.metrics import SIZES, Row, canonical, compared, table
from tests.blind.splits import RIGS, SENSORS, Spec, specs
from tests.builders.paths import ROOT
from tests.virtual_rig.generate import make_set

FIXED = frozenset({"sensor", "input", "inflation"})
"""Amplitudes that are what the measurement states."""


def folder_of(out: Path, split: str, mode: str, spec: Spec) -> Path:
    """Where a set lies; its name says nothing of what is in it."""
    return out / split / mode / spec.name


def set_of(folder: Path) -> Path:
    """The set itself; with a baseline it lies next to it."""
    return folder / "set_1" if (folder / "set_1").is_dir() else folder


def generate(split: str, mode: str, out: Path, commit: str | None, workers: int) -> None:
    """Make the sets of a split that are not there yet."""
    jobs = [(split, mode, out, spec) for spec in specs(split, mode, commit)]
    with ProcessPoolExecutor(workers) as pool:
        for number, text in enumerate(pool.map(_generate, jobs, chunksize=2), 1):
            print(f"{number}/{len(jobs)} {text}", flush=True)


def _generate(job: tuple[str, str, Path, Spec]) -> str:
    split, mode, out, spec = job
    folder = folder_of(out, split, mode, spec)
    answer = out / "answers" / split / mode / f"{spec.name}.json"
    started = time.perf_counter()
    if answer.exists():
        if all(set(SIZES.values()) <= set(effect) for effect in json.loads(answer.read_text())["effects"]):
            return "there"
        with tempfile.TemporaryDirectory() as scratch:  # the same set again by its seed, for its sizes
            entry = make_set(spec.rig, spec.wanted, spec.seed, Path(scratch))
        answer.write_text(json.dumps(entry))
        return f"{spec.rig} {spec.wanted['kind']}: sizes added in {time.perf_counter() - started:.1f} s"
    try:
        entry = make_set(spec.rig, spec.wanted, spec.seed, folder)
    except ValueError as error:
        return f"{spec.rig} {spec.wanted['kind']}: {error}"
    answer.parent.mkdir(parents=True, exist_ok=True)
    answer.write_text(json.dumps(entry))
    return f"{spec.rig} {spec.wanted['kind']} {time.perf_counter() - started:.1f} s"


@cache
def case_of(rig: str) -> Case:
    """The case of a rig."""
    return load_case(ROOT / "cases" / rig)


@cache
def effects_for(rig: str) -> tuple[Effect, ...]:
    """Its catalogue."""
    return effects_of(case_of(rig))


MOST_NUMBERS = {"plain": 700, "baseline": 900}
"""Healthy sets with more numbers take too long to fit amplitudes and drifts to; the inflation counts them too."""


def calibrate(out: Path, without: str | None, target: Path) -> None:
    """Amplitudes, inflation and drifts from the null split in both modes, rigs but one if asked; written as JSON."""
    wanted = [spec for spec in specs("null", "plain") if spec.rig != without]
    folders = [(spec.rig, folder_of(out, "null", "plain", spec)) for spec in wanted]
    problems = [_subject(rig, folder) for rig, folder in folders if folder.is_dir()]
    larger = [one for one in problems if len(one.features) >= MOST_NUMBERS["plain"]]
    alike = list(_alike(one for one in problems if len(one.features) < MOST_NUMBERS["plain"]))
    amplitudes, inflation = fit_all(alike, Amplitudes(), FIXED, larger)
    squares = [
        space.chi_square / len(space.residual)
        for space in (plain(residuals, amplitudes, inflation) for residuals in problems)
    ]
    pairs = [pair for spec in specs("null", "baseline") if spec.rig != without for pair in _pairs(out, spec)]
    small = [pair for pair in pairs if len(pair[0].features) < MOST_NUMBERS["baseline"]]
    shares = calibrate_drift(small, amplitudes, FIRST_DRIFT)
    drift = inflate_drift(pairs, amplitudes, shares)
    content = {
        "sets": [len(problems) - len(larger), len(problems)],
        "pairs": [len(small), len(pairs)],
        "chi_square": [float(np.median(squares)), float(np.max(squares))],
        "amplitudes": asdict(amplitudes),
        "widening": inflation,
        "drift": asdict(drift),
    }
    target.write_text(json.dumps(content, indent=1))
    print(json.dumps(content, indent=1))


FIRST_DRIFT = Drift(shared=0.01, slope=0.5, shaft=0.5, mesh=0.5, amplitude=0.03, sensors=0.35, constants=0.02)
"""Where the fit of the drifts starts, and the centre of its prior."""


def _pairs(out: Path, spec: Spec) -> Iterable[tuple[ResidualProblem, ResidualProblem]]:
    """A healthy set and its healthy baseline, if they were made."""
    folder = folder_of(out, "null", "baseline", spec)
    if (folder / "set_1").is_dir():
        yield _subject(spec.rig, folder / "set_1"), _subject(spec.rig, folder / "set_0")


def _alike(problems: Iterable[ResidualProblem]) -> Iterable[list[ResidualProblem]]:
    """Sets with the very same numbers."""
    groups: dict[tuple[object, ...], list[ResidualProblem]] = {}
    for residuals in problems:
        groups.setdefault(residuals.features, []).append(residuals)
    return groups.values()


def _subject(rig: str, folder: Path) -> ResidualProblem:
    case = case_of(rig)
    return read_residuals(case, load_measurement(set_of(folder), case), effects_for(rig))[1]


def calibration_of(file: Path | None) -> Calibration:
    """The frozen one, or one from a file of `calibrate`."""
    if file is None:
        return DEFAULT
    content = json.loads(file.read_text())
    return replace(
        DEFAULT,
        amplitudes=Amplitudes(**content["amplitudes"]),
        inflation=content["widening"],
        drift=Drift(**content["drift"]),
    )


def run(
    split: str, mode: str, out: Path, commit: str | None, method: "Method", workers: int, tag: str
) -> None:
    """Diagnose every set of a split that has no result yet."""
    target = out / "results" / f"{split}_{mode}{tag}.jsonl"
    target.parent.mkdir(parents=True, exist_ok=True)
    done = (
        {json.loads(line)["name"] for line in target.read_text().splitlines()} if target.exists() else set()
    )
    jobs = [(split, mode, out, spec, method) for spec in specs(split, mode, commit) if spec.name not in done]
    with ProcessPoolExecutor(workers) as pool, target.open("a") as results:
        for row in pool.map(_run, jobs):
            if row is not None:
                results.write(json.dumps(row) + "\n")
                results.flush()
                shown = [effect["effect"] for effect in row["effects"]]
                print(
                    row["name"],
                    row["rig"],
                    row["kind"],
                    shown,
                    "->",
                    row["verdict"],
                    row["named"],
                    flush=True,
                )


@dataclass(frozen=True)
class Method:
    """How sets are diagnosed: calibration from a file or as frozen, with a part taken away, points shuffled."""

    file: Path | None = None
    ablation: str = ""
    placebo: bool = False

    @property
    def calibration(self) -> Calibration:
        """With what an ablation takes away gone."""
        made = calibration_of(self.file)
        return ABLATIONS[self.ablation](made) if self.ablation else made


def _run(job: tuple[str, str, Path, Spec, Method]) -> Row | None:
    split, mode, out, spec, method = job
    answer = out / "answers" / split / mode / f"{spec.name}.json"
    if not answer.exists():
        return None
    entry = json.loads(answer.read_text())
    started = time.perf_counter()
    folder = set_of(folder_of(out, split, mode, spec))
    if method.placebo:
        folder = shuffled(folder, spec.seed)
    result = diagnose_measurement(case_of(spec.rig), folder, calibration=method.calibration, propose=False)
    found = result.diagnosis
    row: Row = {
        **entry,
        "name": spec.name,
        "rig": spec.rig,
        "verdict": found.decision.verdict,
        "named": [*found.named, *found.decision.apart, *found.decision.as_well],
        "reason": found.decision.reason,
        "strength": found.strength,
        "refused": [one.explanation for one in found.refused],
        "top": [list(one.parts) for one in found.alternatives],
        "masses": [one.posterior for one in found.alternatives],
        "evidence": max(one.log_bayes for one in found.evaluations[0].evidence),
        "chi_square": found.evaluations[0].chi_square / found.evaluations[0].count,
        "rejected": len(found.rejected),
        "seconds": time.perf_counter() - started,
        "comparators": comparators(result),
        "covered": None,
        "size_error": None,
        "gap_shrink": None,
        "gap_worse": None,
    }
    _sizes(row, result)
    if found.gap is not None and found.found:
        above = max(found.gap.before - 1.0, 0.0)
        row["gap"] = [
            found.gap.before,
            found.gap.after,
            found.gap.raw_before,
            found.gap.raw_after,
            found.gap.raw_floor,
        ]
        row["gap_worse"] = found.gap.after > found.gap.before + 1e-9
        if above > 0.05:
            row["gap_shrink"] = 1.0 - max(found.gap.after - 1.0, 0.0) / above
    return row


def shuffled(folder: Path, seed: int) -> Path:
    """A copy of a set next to it whose readings went to other operating points; it must be refused."""
    target = folder.with_name(f"{folder.name}_shuffled")
    if target.is_dir():
        return target
    shutil.copytree(folder, target)
    for name in ("data.csv", "orders.csv"):
        file = target / name
        if file.is_file():
            _shuffle(file, np.random.default_rng(seed), settings=len(_settings(target)))
    return target


def _settings(folder: Path) -> list[str]:
    return list(tomllib.loads((folder / "measurement.toml").read_text())["settings"])


def _shuffle(file: Path, rng: np.random.Generator, settings: int) -> None:
    """Readings of each point to another one; the settings stay. Tables start with point and repeat."""
    rows = list(csv.reader(file.read_text().splitlines()))
    first = 2 if file.name == "data.csv" else 1
    body = rows[first:]
    points = list(dict.fromkeys(row[0] for row in body if row[0]))
    other = dict(zip(points, rng.permutation(points).tolist(), strict=True))
    if file.name == "orders.csv":
        back = {source: point for point, source in other.items()}
        changed = [[back.get(row[0], row[0]), *row[1:]] for row in body]
    else:
        start = 2 + settings
        by_place = {(row[0], row[1]): row[start:] for row in body}
        changed = [
            [*row[:start], *by_place.get((other.get(row[0], row[0]), row[1]), row[start:])] for row in body
        ]
    file.write_text("\n".join(",".join(row) for row in (*rows[:first], *changed)) + "\n")


def _sizes(row: Row, result: Any) -> None:
    """Whether the interval of a single effect that was named rightly holds its true size.

    An interval that ends on a bound of the catalogue is reported as open there: the size may be larger. Errors of
    sensors and settings count by name: what is hidden is what they read, what is found is how to put it right.
    """
    found = result.diagnosis
    if row["kind"] == "input" or found.fit is None or len(row["effects"]) != 1 or len(found.found) != 1:
        return
    hidden = row["effects"][0]
    if canonical(hidden["effect"], row["rig"]) not in found.named:
        return
    sizes = found.fit.sizes
    effect = next((one for one in result.effects if one.claim in found.named), None)
    true = float(hidden["size"])
    if effect is not None and len(effect.parameters) == 2:
        value = float(np.hypot(sizes[0].coordinate, sizes[1].coordinate))
        half = max(0.5 * (one.interval[1] - one.interval[0]) for one in sizes)
        low, high = value - half, value + half
        true = abs(true)
    elif effect is not None and effect.parameters[0].factor:
        value, low, high = (float(np.expm1(u)) for u in (sizes[0].coordinate, *sizes[0].interval))
    else:
        value, (low, high) = sizes[0].coordinate, sizes[0].interval
    if hidden["effect"].startswith("not_steady"):
        value, low, high = (3600.0 * one for one in (value, low, high))
    if hidden["effect"].startswith("seal_loss"):
        return
    if hidden["effect"].startswith("emissivity"):  # hidden as a share of what the case has
        box = case_of(row["rig"]).gearboxes[hidden["effect"].partition(":")[2]]
        true *= box.housing.boundary["housing_radiation"].emissivity
    if effect is not None and len(effect.parameters) == 1:
        ends = sizes[0].interval
        low, high = (
            other if end == bound != 0.0 else one
            for one, end, bound, other in zip(
                (low, high), ends, effect.parameters[0].bounds, (-np.inf, np.inf)
            )
        )
    row["true_size"], row["size"], row["interval"] = true, value, [float(low), float(high)]
    row["covered"] = bool(low <= true <= high)
    row["size_error"] = abs(value - true) / max(abs(true), 1e-12)


def stored_rows(split: str, mode: str, out: Path, tag: str) -> list[Row]:
    """Stored results with the effects as the answers have them now: sizes may have been added since."""
    text = (out / "results" / f"{split}_{mode}{tag}.jsonl").read_text()
    rows = [json.loads(line) for line in text.splitlines()]
    answers = out / "answers" / split / mode
    for row in rows:
        answer = answers / f"{row['name']}.json"
        if answer.exists():
            row["effects"] = json.loads(answer.read_text())["effects"]
    return rows


def report(split: str, mode: str, out: Path, tag: str, floor: str) -> None:
    """Print the table of a split in one mode: all sets, by rig, by the sensors they have."""
    rows = stored_rows(split, mode, out, tag)
    for chosen in (None, *RIGS, *SENSORS):
        own = [row for row in rows if chosen in (None, row["rig"], row["sensors"])]
        print(f"\n{split}, {mode}, {chosen or 'all'}: {len(own)} sets, sizes over the {floor} floor")
        for line in table(own, floor):
            target = line.baseline if mode == "baseline" else line.alone
            print(f"  {line.name:44s} {target:9s} {line.measured}")
    for name in COMPARATORS:
        print(f"\n{split}, {mode}, all, by {name}:")
        for what, measured in compared(rows, name, floor):
            print(f"  {what:54s} {measured}")


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("step", choices=["generate", "calibrate", "run", "report"])
    parser.add_argument("split", nargs="?", default="null")
    parser.add_argument("mode", nargs="?", default="plain")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--commit")
    parser.add_argument("--calibration", type=Path)
    parser.add_argument("--ablation", choices=sorted(ABLATIONS), default="")
    parser.add_argument("--placebo", action="store_true", help="readings shuffled over the points")
    parser.add_argument("--without")
    parser.add_argument("--tag", default="")
    parser.add_argument("--floor", choices=sorted(SIZES), default="declared")
    parser.add_argument("--workers", type=int, default=2)
    args = parser.parse_args()
    match args.step:
        case "generate":
            generate(args.split, args.mode, args.out, args.commit, args.workers)
        case "calibrate":
            target = (
                args.out / f"calibration{'' if args.without is None else '_without_' + args.without}.json"
            )
            calibrate(args.out, args.without, target)
        case "run":
            method = Method(args.calibration, args.ablation, args.placebo)
            tag = args.tag or "".join(
                f"_{part}" for part in (args.ablation, "placebo" * args.placebo) if part
            )
            run(args.split, args.mode, args.out, args.commit, method, args.workers, tag)
        case _:
            report(args.split, args.mode, args.out, args.tag, args.floor)


if __name__ == "__main__":
    main()
