"""Places of natural frequencies: torsional ones by number, others by name."""

import pytest

from rigdesign.case.loader import load_case
from rigdesign.measurement.places import Places
from tests.builders.paths import CASES


@pytest.fixture(scope="module")
def places():
    return Places(load_case(CASES / "loop_1to1"))


@pytest.mark.parametrize(
    "place", ["1", "12", "torsional 3", "lateral test_pinion 1", "axial reference_wheel 2", "housing 1"]
)
def test_a_mode_is_numbered_or_named(places, place):
    assert places.is_mode(place)


@pytest.mark.parametrize(
    "place",
    ["", "0", "-1", "first", "torsional", "torsional 0", "lateral 1", "lateral motor 1", "test_pinion 1"],
)
def test_other_words_are_no_modes(places, place):
    assert not places.is_mode(place)
