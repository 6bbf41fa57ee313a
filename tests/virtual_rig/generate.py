"""Blind measurement sets of the four rigs.

    python tests/virtual_rig/generate.py --rig loop_1to1 --kind single --seed 7 --out DIR [--count 20] [--baseline]

Sets get neutral names; what is hidden in them goes to ``DIR.answers.json`` beside the folder, never into it.
"""

import argparse
import copy
import hashlib
import json
import math
import os
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

if __package__ in (None, ""):
    sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.virtual_rig import chain as chains
from tests.virtual_rig.chain import draw_chain, put_in, put_on, repeats, systematic, write_set
from tests.virtual_rig.detect import Detector, detector
from tests.virtual_rig.generate_effects import CHAIN_KINDS, draw_effect, draw_input_error, reach, sized
from tests.virtual_rig.generate_plans import (
    PLANS,
    RIGS,
    Sensor,
    TruePoint,
    plan_points,
    sensors,
    streams,
    thermometer,
)
from tests.virtual_rig.generate_truth import (
    Constants,
    RigTruth,
    another_day,
    draw_rig,
    has_loop,
    readings,
    true_points,
)
from tests.virtual_rig.loop_changes import CHANGES

KINDS = ("none", "single", "pair", "out", "small", "input")
TARGET = {"single": (0.25, 8.0), "pair": (0.7, 8.0), "out": (0.7, 8.0), "small": (0.1, 0.5)}
"""Detectable sizes aimed at, log-uniform."""
TRIAL_POINTS = 4


def make_set(
    rig: str, spec: Mapping[str, Any], seed: int, folder: Path, baseline: Path | None = None
) -> dict[str, Any]:
    """Write one set and return its answer.

    spec : ``kind``, or ``effects`` given (entries with effect, size, phase, order, tooth; no search for a size); and as
        wished ``sensors`` (rich, usual, sparse), ``plan`` (9, 12, 15), ``baseline`` (bool: the healthy rig is
        measured, too, in ``folder/set_0``, the set itself in ``folder/set_1``), ``shift``, ``reindex`` (teeth by
        which the test wheel is put on further in every second point), ``noise`` (factor), ``title``, ``more`` (places
        of thermometers inside in addition, which a baseline made before does not have), ``drift`` (factor on what a rig
        with a baseline changes from that day to the day of the set; 0 for a rig that does not change)
    folder : of the set (with ``baseline`` in ``spec`` of both)
    baseline : folder of a healthy set made by an earlier call, of the same rig when both have the same ``rig_seed``,
        ``sensors`` and ``plan`` in ``spec``
    """
    rng = np.random.default_rng([seed, RIGS.index(rig), *spec.get("kind", "given").encode()])
    if "rig_seed" in spec:
        rng = np.random.default_rng([spec["rig_seed"], RIGS.index(rig)])
    level = rng.choice(["rich", "usual", "sparse"])
    level = spec.get("sensors", str(level))
    plan = int(spec.get("plan", rng.choice(PLANS)))
    paired = bool(spec.get("baseline", False)) or baseline is not None
    shift = bool(spec.get("shift", False))
    own = sensors(rig, level)
    if spec.get("noise", 1.0) != 1.0:
        own = [replace(s, noise=s.noise * spec["noise"]) for s in own]
    constants = draw_rig(rig, rng, own, shift=shift)
    chain = draw_chain(own, rng, *streams(rig))
    if "rig_seed" in spec:
        rng = np.random.default_rng([seed, RIGS.index(rig), *spec.get("kind", "given").encode()])
    points = _reindexed(true_points(rig, plan_points(rig, plan), rng), rig, int(spec.get("reindex", 0)))
    again = _reindexed(true_points(rig, plan_points(rig, plan), rng), rig, int(spec.get("reindex", 0)))
    before, healthy = constants, copy.deepcopy(chain)
    if paired and (times := float(spec.get("drift", 1.0))):
        later = np.random.default_rng([seed, RIGS.index(rig), *b"another day"])
        constants, chain = another_day(constants, later, times), chains.another_day(chain, own, later, times)
    job = _Set(rig, own, constants, points, lambda: Detectors.of(rig, level, plan), paired, rng)
    effects = job.effects(spec)
    if more := [thermometer(place) for place in spec.get("more", ())]:
        for one in (chain, healthy):
            put_on(one, more, np.random.default_rng([seed, *map(len, spec["more"])]))
        own = [*own, *more]
        job = _Set(rig, own, constants, points, lambda: Detectors.of(rig, level, plan), paired, rng)
    entry: dict[str, Any] = {
        "rig": rig, "kind": spec.get("kind", "given"), "effects": [_shown(e) for e in effects], "sensors": level,
        "plan": plan, "baseline": paired, "shift": shift, "reindex": int(spec.get("reindex", 0)), "seed": seed,
    }  # fmt: skip
    put_in(chain, effects)
    title = spec.get("title", f"measured on {rig}")
    counts = {point.name: int(rng.integers(2, 4)) for point in points}
    if any(row.point == "" for row in job.rows):
        counts[""] = 3
    target = folder / "set_1" if spec.get("baseline") and baseline is None else folder
    if paired and baseline is None:
        as_new = RigTruth(rig, before).values(again, own)
        told = repeats(healthy, own, readings(own, again), again, as_new, counts, rng)
        write_set(folder / "set_0", rig, healthy, own, again, told, rng, title=f"{title}, before")
    told = repeats(chain, own, job.rows, points, job.truth(effects), counts, rng)
    back = None if not paired else "../set_0" if baseline is None else _relative(baseline, target)
    write_set(target, rig, chain, own, points, told, rng, title=title, baseline=back)
    return entry


class Detectors(NamedTuple):
    """Over the floor that sizes are drawn by, and over the one declared before any set was diagnosed."""

    measured: Detector
    declared: Detector

    @classmethod
    def of(cls, rig: str, level: str, plan: int) -> "Detectors":
        """Of a rig, its sensors and a plan."""
        return cls(detector(rig, level, plan, "measured"), detector(rig, level, plan, "declared"))


class _Set:
    """One set in the making: truth with and without effects, and sizes found by detectability."""

    def __init__(
        self,
        rig: str,
        own: Sequence[Sensor],
        constants: Constants,
        points: Sequence[TruePoint],
        found: Callable[[], Detectors],
        paired: bool,
        rng: np.random.Generator,
    ) -> None:
        self.rig, self.own, self.constants, self.points = rig, own, constants, points
        self._found = found
        self.paired, self.rng = paired, rng
        self.rows = readings(own, points)
        self._base: np.ndarray | None = None
        self._known: dict[str, np.ndarray] = {}
        exact = [replace(s, offset=0.0, scale=0.0) for s in own]
        self.chain = draw_chain(exact, np.random.default_rng(0), *streams(rig))

    @cached_property
    def detectors(self) -> Detectors:
        """Made where an effect needs a size: their sensitivities take minutes."""
        return self._found()

    @property
    def detector(self) -> Detector:
        """By which sizes are drawn."""
        return self.detectors.measured

    def truth(self, effects: Sequence[Mapping[str, Any]]) -> np.ndarray:
        """Readings [SI] without sensor errors, with the effects of the rig itself."""
        physical = [e for e in effects if e["effect"].partition(":")[0] not in CHAIN_KINDS]
        if not physical:
            if self._base is None:
                self._base = RigTruth(self.rig, self.constants).values(self.points, self.own)
            return self._base
        key = json.dumps(physical, sort_keys=True)
        if key not in self._known:
            truth = RigTruth(self.rig, self.constants, physical)
            moving = any(e["effect"].partition(":")[0] in CHANGES for e in physical)
            if has_loop(self.rig) and not moving:
                values = truth.values(self.points, self.own, loop=False)
                base = self.truth([])
                self._known[key] = np.where(values != 0.0, values, base)
            else:
                self._known[key] = truth.values(self.points, self.own)
        return self._known[key]

    def effects(self, spec: Mapping[str, Any]) -> list[dict[str, Any]]:
        """Effects of a spec with their sizes and how detectable they are."""
        if "effects" in spec:
            return [self._measured(dict(effect)) for effect in spec["effects"]]
        kind = spec["kind"]
        if kind == "none":
            return []
        if kind == "input":
            return [self._measured(draw_input_error(self.own, self.points, self.rng))]
        low, high = TARGET[kind]
        chosen: list[dict[str, Any]] = []
        for _ in range(2 if kind == "pair" else 1):
            avoid = [e["family"] for e in chosen]
            wanted = math.exp(self.rng.uniform(math.log(low), math.log(high)))
            effect = draw_effect(self.rig, self.own, self.rng, catalogue=kind != "out", avoid=avoid)
            if "family" in spec:
                while effect["family"] != spec["family"]:
                    effect = draw_effect(self.rig, self.own, self.rng, catalogue=kind != "out", avoid=avoid)
            chosen.append(self._sized(effect, wanted))
        return chosen

    def _sized(self, effect: Mapping[str, Any], wanted: float) -> dict[str, Any]:
        """The effect at about the wanted detectable size: two trials at a few points, one measurement at all."""
        few = [self.points[i] for i in np.linspace(0, len(self.points) - 1, TRIAL_POINTS).astype(int)]
        most = reach(effect)
        size = 0.1 * most
        base = None if self._of_chain(effect) else RigTruth(self.rig, self.constants).values(few, self.own)
        seen = self._trial(sized(effect, size), few, base)
        size = most if seen <= 1e-6 else min(size * wanted / seen, most)
        found = self._measured(sized(effect, size))
        ratio = found["detectable_sizes"] / wanted
        if ratio < 1e-6 or 0.75 < ratio < 1.33 or (ratio < 1.0 and size >= most):
            return found
        return self._measured(sized(effect, min(size / ratio, most)))

    def _trial(self, effect: Mapping[str, Any], few: Sequence[TruePoint], base: np.ndarray | None) -> float:
        """Detectable sizes seen at a few points."""
        if base is None:
            return float(self._measured(dict(effect))["detectable_sizes"])
        moving = effect["effect"].partition(":")[0] in CHANGES
        values = RigTruth(self.rig, self.constants, [effect]).values(few, self.own, loop=moving)
        here = {tuple(row): i for i, row in enumerate(readings(self.own, few))}
        at = np.array([here.get(tuple(row), -1) for row in self.rows])
        change = np.where(at >= 0, values[at] - base[at], 0.0)
        if not moving:
            change[values[at] == 0.0] = 0.0
        return self.detector.partial_sizes(change, at >= 0, baseline=self.paired)

    def _of_chain(self, effect: Mapping[str, Any]) -> bool:
        return effect["effect"].partition(":")[0] in CHAIN_KINDS

    def _measured(self, effect: dict[str, Any]) -> dict[str, Any]:
        """The effect with how many detectable sizes it has, alone, over either floor."""
        change = self._seen(effect) if self._of_chain(effect) else self.truth([effect]) - self.truth([])
        effect["detectable_sizes"] = self.detector.detectable_sizes(change, baseline=self.paired)
        effect["detectable_sizes_declared"] = self.detectors.declared.detectable_sizes(
            change, baseline=self.paired
        )
        return effect

    def _seen(self, effect: Mapping[str, Any]) -> np.ndarray:
        """Change of the readings by an error of sensor or input; of an input as the change of setting it feigns."""
        kind, _, place = effect["effect"].partition(":")
        base = self.truth([])
        if kind in ("inlet_offset", "flow_scale"):
            step = 0.3 if kind == "inlet_offset" else 0.01
            at = self.detector.names.index(f"{'inlet' if kind == 'inlet_offset' else 'flow'}:{place}")
            return -effect["size"] / step * self.detector.constants[:, at]
        wrong = copy.deepcopy(self.chain)
        put_in(wrong, [effect])
        changed = systematic(wrong, self.own, self.rows, self.points, base)
        if kind in ("swapped_channels", "swapped_points"):
            one, two = place.split(",")
            column = "channel" if kind == "swapped_channels" else "point"
            other = {one: two, two: one}
            at = {tuple(row): i for i, row in enumerate(self.rows)}
            for i, row in enumerate(self.rows):
                name = other.get(getattr(row, column))
                if name is not None:
                    changed[i] = base[at[tuple(row._replace(**{column: name}))]]
        if kind == "unit":
            mine = np.array([row.channel == place for row in self.rows])
            changed = np.where(mine, base * effect["factor"] + effect["addend"], changed)
        return changed - systematic(self.chain, self.own, self.rows, self.points, base)


def _reindexed(points: list[TruePoint], rig: str, teeth: int) -> list[TruePoint]:
    if not teeth or not has_loop(rig):
        return points
    return [replace(p, tooth_offset={"test.main": teeth}) if i % 2 else p for i, p in enumerate(points)]


def _shown(effect: Mapping[str, Any]) -> dict[str, Any]:
    place = effect["effect"].partition(":")[2]
    return {"place": place, **{key: value for key, value in effect.items() if key != "sign"}}


def _relative(baseline: Path, folder: Path) -> str:
    return Path(os.path.relpath(baseline, folder)).as_posix()


def set_name(rig: str, kind: str, seed: int) -> str:
    """Neutral name of a set."""
    return "s" + hashlib.sha256(f"{rig} {kind} {seed}".encode()).hexdigest()[:8]


def answers_file(out: Path) -> Path:
    """Where the answers of the sets of a folder go: beside it."""
    return out.with_name(out.name + ".answers.json")


def main(arguments: Sequence[str] | None = None) -> int:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--rig", choices=RIGS, required=True)
    parser.add_argument("--kind", choices=KINDS, required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--count", type=int, default=1)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--sensors", choices=("rich", "usual", "sparse"))
    parser.add_argument("--plan", type=int, choices=PLANS)
    parser.add_argument("--baseline", action="store_true")
    parser.add_argument("--shift", action="store_true")
    parser.add_argument("--reindex", type=int, default=0)
    parser.add_argument("--family", help="only effects of this family")
    options = parser.parse_args(arguments)
    spec = {
        "kind": options.kind,
        "baseline": options.baseline,
        "shift": options.shift,
        "reindex": options.reindex,
    }
    spec |= {
        key: value for key in ("sensors", "plan", "family") if (value := getattr(options, key)) is not None
    }
    file = answers_file(options.out)
    options.out.mkdir(parents=True, exist_ok=True)
    answers = json.loads(file.read_text(encoding="utf-8")) if file.is_file() else {}
    for seed in range(options.seed, options.seed + options.count):
        name = set_name(options.rig, options.kind, seed)
        start = time.perf_counter()
        answers[name] = make_set(options.rig, spec, seed, options.out / name)
        beside = file.with_suffix(".part")
        beside.write_text(json.dumps(answers, indent=1), encoding="utf-8")
        beside.replace(file)
        print(f"{name}: {time.perf_counter() - start:.1f} s", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
