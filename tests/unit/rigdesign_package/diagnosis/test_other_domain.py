"""An explanation in one domain is held against the numbers of the other one."""

import numpy as np
import pytest

from rigdesign.diagnosis.decision.search import WIDE, Explanations, OtherDomain
from rigdesign.diagnosis.statistics.covariance import Covariance, Whitened
from rigdesign.diagnosis.statistics.evidence import Hypothesis, evaluate_hypothesis, evaluate_pair

COUNT = 20
RNG = np.random.default_rng(6)
HERE, THERE, BESIDE = (RNG.normal(size=(COUNT, 1)) for _ in range(3))


def space(values: np.ndarray) -> Whitened:
    return Whitened.of(Covariance(base=np.eye(COUNT), columns=(), amplitudes={}), values)


def cause(name: str, columns: np.ndarray, family: str, unit: float = 1.0) -> Hypothesis:
    return Hypothesis(name=name, family=family, parts=(name,), columns=columns, half=100.0, unit=unit)


def contradicted(share: float, family: str = "unmodelled", unit: float = 1.0, pair: bool = False) -> bool:
    """Of a cause of size 10 in this domain, of which the other one reads a share; ``unit``: its columns there."""
    here, beside = cause("heat", HERE, family), cause("other", BESIDE, family)
    there = cause("heat", THERE * unit, family, 1.0 / unit)
    mine, theirs = (
        Explanations(physical=[], sensor=[], unmodelled=list(own)) for own in ((here, beside), (there,))
    )
    other = OtherDomain.of(space(10.0 * share * THERE[:, 0]), mine, theirs)
    read = space(10.0 * HERE[:, 0])
    one = evaluate_hypothesis(read, here)
    if pair:
        one = evaluate_pair(read, one, evaluate_hypothesis(read, beside))
    return other.contradicts(one)


@pytest.mark.parametrize("pair", [False, True])
@pytest.mark.parametrize(("share", "against"), [(1.0, False), (1.2 / WIDE, False), (0.8 * WIDE, False), (0.0, True),
                                                (-1.0, True)])  # fmt: skip
def test_heat_that_the_temperatures_do_not_show_explains_no_order(share, against, pair):
    assert contradicted(share, pair=pair) is against


def test_an_error_of_a_sensor_is_known_exactly():
    assert not contradicted(1.0, "sensor")
    assert contradicted(0.3, "sensor") and not contradicted(0.3)


def test_columns_brought_to_a_length_of_one_keep_their_size():
    assert not contradicted(1.0, unit=0.01)
    assert contradicted(0.0, unit=0.01)


def test_what_is_not_seen_there_is_not_held_against_it():
    faint = Explanations(physical=[], sensor=[], unmodelled=[cause("heat", 1e-3 * THERE, "unmodelled")])
    own = Explanations(physical=[], sensor=[], unmodelled=[cause("heat", HERE, "unmodelled")])
    one = evaluate_hypothesis(space(10.0 * HERE[:, 0]), own.unmodelled[0])
    assert not OtherDomain.of(space(np.zeros(COUNT)), own, faint).contradicts(one)
    nothing = Explanations(physical=[], sensor=[], unmodelled=[])
    assert not OtherDomain.of(space(np.zeros(COUNT)), own, nothing).contradicts(one)


def test_beside_a_named_effect_columns_of_another_length_keep_their_size():
    """A wider covariance shortens the columns of this domain; what they leave in the other one stays."""
    there = Explanations(physical=[], sensor=[], unmodelled=[cause("heat", THERE, "unmodelled")])
    first = Explanations(physical=[], sensor=[], unmodelled=[cause("heat", HERE, "unmodelled")])
    later = Explanations(physical=[], sensor=[], unmodelled=[cause("heat", HERE, "unmodelled", 0.05)])
    one = evaluate_hypothesis(space(10.0 * 0.05 * HERE[:, 0]), later.unmodelled[0])
    other = OtherDomain.of(space(np.zeros(COUNT)), first, there)
    assert not other.contradicts(one)
    assert other.seen_from(later).contradicts(one)
