"""The sets of the blind test: how many of which kind, and their seeds.

The null split calibrates the covariance, the dev split the thresholds; the seed of the test split is the hash of the
commit that froze both, so that nobody could have looked at it before. So is that of the transfer split: sets of a rig
that no other split has.
"""

from dataclasses import dataclass
from typing import Any

RIGS = ("uhcf_prototype", "loop_1to1", "loop_hunting")
TRANSFER_RIGS = ("fzg",)
"""In no calibration: scored with the constants of the others."""
SENSORS = ("rich", "usual", "sparse")
PLANS = (9, 12, 15)

COUNTS = {
    "null": {"none": 108},
    "dev": {"none": 45, "single": 45, "pair": 12, "out": 24, "small": 12, "input": 6},
    "test": {"none": 201, "single": 102, "pair": 60, "out": 102, "small": 30, "input": 24},
    "transfer": {"none": 60, "single": 30, "pair": 15, "out": 30, "small": 6, "input": 9},
}
"""Sets of each kind by split, over all rigs."""

FIRST_SEED = {"null": 100_000, "dev": 200_000}
SEED_BY_COMMIT = {"test": 1_000_000, "transfer": 2_000_000}
"""Added to the hash of the commit that froze the method."""


@dataclass(frozen=True)
class Spec:
    """One set: what `tests.virtual_rig.generate.make_set` is asked for."""

    name: str
    rig: str
    seed: int
    wanted: dict[str, Any]


def seed_of(split: str, commit: str | None) -> int:
    """First seed of a split; of the test and transfer splits by the commit that froze the method.

    Raises ValueError for one of these without a commit.
    """
    if split in FIRST_SEED:
        return FIRST_SEED[split]
    if commit is None:
        raise ValueError(
            f"the {split} split takes its seed from a commit; give --commit HASH of the frozen method"
        )
    return SEED_BY_COMMIT[split] + int(commit[:8], 16)


def specs(split: str, mode: str, commit: str | None = None, only: str | None = None) -> list[Spec]:
    """All sets of a split in one mode; rigs, sensors and plans in turn, a quarter of the sets by commit shifted."""
    rigs = TRANSFER_RIGS if split == "transfer" else RIGS
    first = seed_of(split, commit) + (500_000 if mode == "baseline" else 0)
    found = []
    number = 0
    for kind, count in COUNTS[split].items():
        for place in range(count):
            rig = rigs[place % len(rigs)]
            turn = place // len(rigs)
            wanted: dict[str, Any] = {
                "kind": kind,
                "sensors": SENSORS[turn % len(SENSORS)],
                "plan": PLANS[turn // len(SENSORS) % len(PLANS)],
                "baseline": mode == "baseline",
                "shift": split in SEED_BY_COMMIT and place % 4 == 3,
            }
            if only is None or rig == only:
                found.append(Spec(f"{number:04d}", rig, first + number, wanted))
            number += 1
    return found
