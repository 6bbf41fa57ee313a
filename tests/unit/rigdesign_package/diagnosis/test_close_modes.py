"""Natural frequencies that lie close divide a change differently on the rig and in the model."""

import numpy as np
import pytest
from scipy.linalg import eigh

from rigdesign.diagnosis.statistics.resonance import CloseModes


def changes(stiffness: np.ndarray, local: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Natural frequencies (2,) of a chain of two unit masses, and their change by one more spring."""
    before, after = (np.sqrt(eigh(one, eigvals_only=True)) for one in (stiffness, stiffness + local))
    return before, after - before


@pytest.mark.parametrize("coupling", [0.002, 0.006, 0.02])
def test_the_error_of_a_pair_is_the_most_that_mixed_modes_make_of_a_local_stiffness(coupling):
    """Of two modes 3 % apart with a coupling of either sign between them that the model has not."""
    model = np.diag([1.0, 1.06])
    along = np.array([0.4, 0.9])
    local = 1e-4 * np.outer(along, along)
    frequencies, answer = changes(model, local)
    modes = CloseModes.of(frequencies, coupling / 2.0)
    found = np.array([float(error[0]) for error in modes.errors(answer)])
    missed = [
        changes(model + np.array([[0.0, sign], [sign, 0.0]]), local)[1] - answer
        for sign in (coupling, -coupling)
    ]
    most = max(missed, key=lambda one: float(np.abs(one).max()))
    assert np.abs(found) == pytest.approx(np.abs(most), rel=0.15)
    assert found[0] * found[1] < 0.0


def test_modes_far_apart_keep_their_changes():
    near, far = (CloseModes.of(np.array([100.0, 0.0, top]), 0.01) for top in (103.0, 400.0))
    answer = np.array([1.0, 5.0, 4.0])
    assert near.errors(answer)[0] > 1.0
    assert far.errors(answer)[0] < 0.05
    assert len(CloseModes.of(np.zeros(4), 0.01).errors(np.ones(4))[0]) == 0


def test_two_readings_of_one_mode_are_no_pair():
    modes = CloseModes.of(np.array([100.0, 100.0, 103.0]), 0.01)
    assert list(zip(modes.first.tolist(), modes.second.tolist(), strict=True)) == [(0, 2), (1, 2)]
