"""The sets of the blind test: how many of which kind, and their seeds.

The null split calibrates the covariance, the dev split the thresholds; the seed of the test split is the hash of the
commit that froze both, so that nobody could have looked at it before.
"""

from dataclasses import dataclass
from typing import Any

RIGS = ("uhcf_prototype", "loop_1to1", "loop_hunting")
SENSORS = ("rich", "usual", "sparse")
PLANS = (9, 12, 15)

COUNTS = {
    "null": {"none": 108},
    "dev": {"none": 45, "single": 45, "pair": 12, "out": 24, "small": 12, "input": 6},
    "test": {"none": 201, "single": 102, "pair": 60, "out": 102, "small": 30, "input": 24},
}
"""Sets of each kind by split, over all rigs."""

FIRST_SEED = {"null": 100_000, "dev": 200_000}


@dataclass(frozen=True)
class Spec:
    """One set: what `tests.virtual_rig.generate.make_set` is asked for."""

    name: str
    rig: str
    seed: int
    wanted: dict[str, Any]


def seed_of(split: str, commit: str | None) -> int:
    """First seed of a split; of the test split by the commit that froze the method."""
    if split != "test":
        return FIRST_SEED[split]
    if commit is None:
        raise ValueError(
            "the test split takes its seed from a commit; give --commit HASH of the frozen method"
        )
    return 1_000_000 + int(commit[:8], 16)


def specs(split: str, mode: str, commit: str | None = None, only: str | None = None) -> list[Spec]:
    """All sets of a split in one mode; rigs, sensors and plans in turn, a third of the test split shifted."""
    first = seed_of(split, commit) + (500_000 if mode == "baseline" else 0)
    found = []
    number = 0
    for kind, count in COUNTS[split].items():
        for place in range(count):
            rig = RIGS[place % len(RIGS)]
            wanted: dict[str, Any] = {
                "kind": kind,
                "sensors": SENSORS[(place // 3) % 3],
                "plan": PLANS[(place // 9) % 3],
                "baseline": mode == "baseline",
                "shift": split == "test" and place % 4 == 3,
            }
            if only is None or rig == only:
                found.append(Spec(f"{number:04d}", rig, first + number, wanted))
            number += 1
    return found
