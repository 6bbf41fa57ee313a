"""Error of each number beside the answer of a right cause."""

import numpy as np
import pytest

from rigdesign.diagnosis.statistics.columns import ModelError
from rigdesign.prediction.model import Feature

PARTS = [(order, part) for order in (27.0, 28.0) for part in ("real", "imaginary")]
FEATURES = (*(Feature("M", point, *part) for point in ("P1", "P2") for part in PARTS), Feature("T", "P1"))
MESH = np.array([one.order == 28.0 for one in FEATURES])


def error(share: float, read: np.ndarray) -> ModelError:
    shares = np.array([share if one.order else 0.0 for one in FEATURES])
    return ModelError.of(FEATURES, shares, MESH, read)


def test_an_order_is_off_by_a_share_of_its_amplitude_whatever_its_phase():
    answer = np.array([3.0, 4.0, 0.0, 1.0, 0.0, 0.0, 5.0, 12.0, 7.0])
    found = error(0.1, np.zeros(9)).at(answer, circuit=True)
    assert found == pytest.approx([0.5, 0.5, 0.1, 0.1, 0.0, 0.0, 1.3, 1.3, 0.0])


def test_what_the_teeth_excite_anyway_follows_the_mesh_orders_of_its_channel_and_point():
    """A mesh order that a cause changes by a tenth: the sideband there may go a tenth of itself, elsewhere nothing."""
    read = np.array([2.0, 2.0, 50.0, 50.0, 2.0, 2.0, 50.0, 50.0, 0.0])
    answer = np.array([0.0, 0.0, 3.0, -4.0, 0.0, 0.0, 0.0, 0.0, 9.0])
    found = error(0.0, read).at(answer, circuit=True)
    assert found == pytest.approx([0.2, 0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])


def test_a_cause_that_leaves_the_mesh_orders_alone_leaves_the_others_to_its_own_answer():
    read = np.full(9, 10.0)
    answer = np.array([6.0, 8.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    assert error(0.04, read).at(answer, circuit=True) == pytest.approx([0.4, 0.4, 0, 0, 0, 0, 0, 0, 0])


def test_a_cause_outside_the_circuit_changes_nothing_of_what_passes_through_it():
    answer = np.array([0.0, 0.0, 3.0, -4.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    assert not error(0.0, np.full(9, 10.0)).at(answer, circuit=False).any()


def test_nothing_follows_by_more_than_itself():
    read = np.array([2.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0])
    answer = np.array([0.0, 0.0, 30.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0])
    assert error(0.0, read).at(answer, circuit=True) == pytest.approx(
        [2.0, 2.0, 0.0, 0.0, 2.0, 2.0, 0.0, 0.0, 0.0]
    )
