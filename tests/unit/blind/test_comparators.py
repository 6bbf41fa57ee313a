"""Comparators of the blind score name what is there, and what is not as often as they are known to."""

import numpy as np
import pytest

from tests.blind.comparators import COMPARATORS, Candidate


def candidates(rng, count=40, numbers=120):
    return [Candidate(f"effect:{i}", rng.normal(size=(numbers, 1 + i % 2))) for i in range(count)]


@pytest.mark.parametrize("name", COMPARATORS)
def test_a_large_effect_is_named(name):
    rng = np.random.default_rng(1)
    known = candidates(rng)
    residual = known[4].columns @ np.full(known[4].columns.shape[1], 1.0) + rng.normal(size=120)
    assert COMPARATORS[name](residual, known)[0] == "effect:4"


def test_two_effects_are_added_one_after_the_other():
    rng = np.random.default_rng(2)
    known = candidates(rng)
    residual = 2.0 * known[4].columns[:, 0] + known[7].columns @ np.ones(2) + rng.normal(size=120)
    for name in ("BIC", "F-test"):
        assert set(COMPARATORS[name](residual, known)[:2]) == {"effect:4", "effect:7"}


def test_on_noise_the_f_test_is_silent_and_bic_is_not():
    rng = np.random.default_rng(3)
    said = dict.fromkeys(COMPARATORS, 0)
    for _ in range(60):
        known, noise = candidates(rng), rng.normal(size=120)
        for name, choose in COMPARATORS.items():
            said[name] += bool(choose(noise, known))
    assert said["F-test"] <= 8
    assert said["BIC"] > 20
