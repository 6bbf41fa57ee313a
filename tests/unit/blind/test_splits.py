"""Splits of the blind test: the rig of the transfer split is in no other, and no set moves."""

import hashlib
from collections import Counter

import pytest

from tests.blind.splits import COUNTS, specs
from tests.virtual_rig.generate_plans import RIGS

COMMIT = "c709f79abc"
DIGEST = {"null": "3604a6f16a5dc72a", "dev": "c82785f7f5a4e405", "test": "76c365ef1c5fc021"}
"""Of all specs in both modes, from before there was a transfer split."""


@pytest.mark.parametrize("split", DIGEST)
def test_sets_of_a_split_stay_what_they_are(split):
    found = [
        (one.name, one.rig, one.seed, one.wanted)
        for mode in ("plain", "baseline")
        for one in specs(split, mode, COMMIT)
    ]
    assert hashlib.sha256(repr(found).encode()).hexdigest()[:16] == DIGEST[split]
    assert "fzg" not in {rig for _, rig, _, _ in found}


def test_transfer_has_one_rig_with_all_sensors_and_plans():
    found = specs("transfer", "plain", COMMIT)
    assert {one.rig for one in found} == {"fzg"} <= set(RIGS)
    assert Counter(one.wanted["kind"] for one in found) == COUNTS["transfer"]
    for kind in ("none", "single", "out"):
        turns = Counter(
            (one.wanted["sensors"], one.wanted["plan"]) for one in found if one.wanted["kind"] == kind
        )
        assert len(turns) == 9 and max(turns.values()) - min(turns.values()) <= 3
    assert any(one.wanted["shift"] for one in found)


def test_seed_of_the_transfer_split_is_its_commit():
    seeds = {one.seed for one in specs("transfer", "plain", COMMIT)}
    assert min(seeds) == 2_000_000 + int(COMMIT[:8], 16)
    assert not seeds & {one.seed for one in specs("transfer", "baseline", COMMIT)}
    assert specs("transfer", "plain", "0123456789")[0].seed != min(seeds)
    with pytest.raises(ValueError, match="--commit HASH"):
        specs("transfer", "plain")
