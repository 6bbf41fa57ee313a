import numpy as np
import pytest

from dynamics.rating.root_stress import root_influence, root_stress_over_face
from tests.builders.p2_gears import spur_pair

PAIR = spur_pair()


def test_stress_grows_towards_the_own_tip():
    pinion, wheel = (root_influence(PAIR, index) for index in (0, 1))
    assert np.all(np.diff(pinion.value) > 0.0)
    assert np.all(np.diff(wheel.value) < 0.0)
    assert (pinion.width, wheel.width) == pytest.approx((7e-3, 9e-3))
    assert pinion.at(1.0) == pinion.value[-1]


def test_uniform_slices_give_the_stress_of_the_whole_face():
    influence = root_influence(PAIR, 0)
    path = np.array([1e-3, 3e-3])
    slices = np.full((2, 5), 200.0)
    local = root_stress_over_face(influence, slices, path, np.zeros(5), 7e-3)
    whole = 1000.0 / 7e-3 * influence.at(path)
    assert local == pytest.approx(np.repeat(whole[:, None], 5, axis=1))


def test_impossible_histories_are_refused():
    influence = root_influence(PAIR, 0)
    with pytest.raises(ValueError, match="slice_forces"):
        root_stress_over_face(influence, np.ones((2, 4)), [1e-3, 2e-3], np.zeros(5), 7e-3)
