"""Ledgers of a study damaged in many places: no traceback, no false point, whole after the next run.

pytest -m slow -s tests/regression/test_damaged_ledgers.py      prints the counts
"""

import random
from collections import Counter
from pathlib import Path

import pytest

from tests.builders.ledger_damage import DAMAGE, POINTS, copy_ledger, harm_file, resumed, write_ledger

PER_KIND = 150


@pytest.mark.slow
@pytest.mark.parametrize("kind", DAMAGE)
def test_many_damaged_ledgers(kind: str, tmp_path: Path) -> None:
    sound = tmp_path / "sound.sqlite"
    write_ledger(sound)
    counts: Counter[str] = Counter()
    for seed in range(PER_KIND):
        path = tmp_path / "l.sqlite"
        copy_ledger(sound, path)
        harm_file(path, kind, random.Random(f"many {kind} {seed}"))
        kept, reported = resumed(path)
        counts["damaged ledgers"] += 1
        counts["points"] += POINTS
        counts["points kept"] += kept
        counts[
            "nothing lost, nothing to say" if kept == POINTS and not reported else "set aside and said"
        ] += 1
        assert kept == POINTS or reported
    print(f"\n{kind}: {dict(counts)}")
