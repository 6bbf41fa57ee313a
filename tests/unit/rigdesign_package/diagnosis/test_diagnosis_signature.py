"""An explanation under the error of its own answer: the same as with that error in the covariance."""

import numpy as np
import pytest
from scipy.special import logsumexp

from rigdesign.diagnosis.residual.healthy import SHARES, Contest, Signature
from rigdesign.diagnosis.statistics.columns import Column, ModelError
from rigdesign.diagnosis.statistics.covariance import Covariance, Whitened
from rigdesign.diagnosis.statistics.evidence import Hypothesis, evaluate_hypothesis, evaluate_pair
from rigdesign.diagnosis.statistics.resonance import CloseModes
from rigdesign.prediction.model import Feature

POINTS = 8
NUMBERS = (("a", 0.0, "value"), ("b", 27.0, "real"), ("b", 27.0, "imaginary"))
FEATURES = tuple(
    Feature(name, f"P{point}", order, part) for point in range(POINTS) for name, order, part in NUMBERS
)
STEEP = np.array([0.3 if feature.order else 0.0 for feature in FEATURES])
"""Relative error of orders by themselves."""
TREND = np.repeat(np.linspace(-0.7, 0.7, POINTS), 3)
SHARE = 0.2
MODES = CloseModes.of(
    np.where(np.isin(np.arange(len(FEATURES)), (0, 3)), 100.0 + np.arange(len(FEATURES)), 0.0), 0.02
)
"""Two of the numbers as if they were natural frequencies of 100 and 103 Hz."""


def signature(alone: float = 0.0) -> Signature:
    own = ModelError.of(FEATURES, alone * STEEP, np.zeros(len(FEATURES), dtype=bool), np.zeros(len(FEATURES)))
    return Signature.of(FEATURES, TREND, {"": SHARE, "known": 0.0}, own, MODES)


def healthy(own: float = 0.0) -> Covariance:
    rng = np.random.default_rng(3)
    base = np.diag(rng.uniform(0.5, 1.5, len(FEATURES)))
    columns = [
        Column(name="link", kind="link", values=rng.normal(size=len(FEATURES)), spread=0.7),
        Column(name="film/0", kind="constant_film", values=trace(), spread=own, effect="film:x"),
    ]
    return Covariance(base=base, columns=tuple(columns if own else columns[:1]), amplitudes={})


def trace() -> np.ndarray:
    return np.random.default_rng(4).normal(size=len(FEATURES))


def plane(
    covariance: Covariance, values: np.ndarray, name: str = "film:x", family: str = "physical"
) -> Hypothesis:
    return Hypothesis(
        name=name,
        family=family,
        parts=(name,),
        columns=covariance.whiten(values[:, None]),
        half=10.0,
        own=(name,),
    )


def direct(
    covariance: Covariance, residual: np.ndarray, answer: np.ndarray, hypothesis_of, alone: float
) -> float:
    """Evidence with the error columns of the answer put into the covariance, against the healthy one."""
    hypothesis = plane(covariance, answer)
    errors = signature(alone).columns(hypothesis, answer, np.diagonal(np.linalg.inv(covariance.matrix)))
    kept = tuple(column for column in covariance.columns if column.effect != "film:x")
    wide = Covariance(base=covariance.base, columns=kept, amplitudes={}).with_extra(errors)
    space, plain = Whitened.of(wide, residual), Whitened.of(covariance, residual)
    found = evaluate_hypothesis(space, hypothesis_of(wide))
    return (
        found.log_bayes
        + 0.5 * (plain.chi_square - space.chi_square)
        - 0.5 * (wide.log_determinant - covariance.log_determinant)
    )


@pytest.mark.parametrize("alone", [0.0, 1.0])
@pytest.mark.parametrize("own", [0.0, 0.4])
def test_low_rank_algebra_is_the_whole_covariance(own, alone, monkeypatch):
    """An explanation whose constant has its own healthy spread, and one without; orders off by themselves, or not."""
    monkeypatch.setattr("rigdesign.diagnosis.residual.healthy.SLIGHT", 0.0)
    covariance = healthy(own)
    residual = 6.0 * trace() + np.random.default_rng(5).normal(size=len(FEATURES))
    space = Whitened.of(covariance, residual)
    first = evaluate_hypothesis(space, plane(covariance, trace()))
    found = Contest(space, signature(alone)).again(first)
    answer = covariance.lower @ first.answer
    wanted = [
        direct(covariance, residual, answer, lambda wide: plane(wide, trace()), alone * share)
        for share in SHARES
    ]
    assert found.log_bayes == pytest.approx(logsumexp(wanted) - np.log(len(SHARES)), rel=1e-9)
    assert found.log_bayes != pytest.approx(first.log_bayes, abs=0.1)


def test_an_answer_that_is_a_share_off_is_forgiven_and_noise_is_not():
    covariance = healthy()
    wrong = trace() * np.where([feature.channel == "b" for feature in FEATURES], 1.25, 0.9)
    rival = (wrong - trace()) + 0.02 * np.random.default_rng(9).normal(size=len(FEATURES))
    space = Whitened.of(covariance, 9.5 * wrong)
    contest = Contest(space, signature())
    right, other = (
        plane(covariance, values, name) for values, name in ((trace(), "film:x"), (rival, "loss:y"))
    )
    both = evaluate_pair(space, evaluate_hypothesis(space, right), evaluate_hypothesis(space, other))
    assert both.log_bayes > evaluate_hypothesis(space, right).log_bayes + 5.0
    # what is left of that is less than the priors of a pair cost
    assert contest.again(both).log_bayes < contest.again(evaluate_hypothesis(space, right)).log_bayes + 1.0
    left = space.chi_square - contest.again(evaluate_hypothesis(space, right)).gain
    assert left < 2.0 * len(FEATURES) < space.chi_square - evaluate_hypothesis(space, right).gain


def test_an_order_near_a_resonance_is_off_by_a_share_of_its_amplitude():
    """Whatever its phase; numbers of which the residual of a healthy rig is larger are left out."""
    answer = np.tile([5.0, 3.0, -4.0], POINTS)
    precision = np.where([feature.setting == "P0" for feature in FEATURES], 1e-4, 1.0)
    rows, alone = signature(1.0).rows(plane(healthy(), answer), answer, precision)
    own = rows.toarray()[alone]
    assert len(own) == 2 * (POINTS - 1)
    variances = np.einsum("kn,kn->n", own, own)
    near = (STEEP > 0.0) & (precision == 1.0)
    assert variances == pytest.approx(np.where(near, (0.3 * 5.0) ** 2, 0.0))


def test_numbers_that_follow_an_answer_closely_are_no_sign_of_one_that_is_far_off():
    """An answer that is met exactly has the evidence of the least error that is admitted, but for the others' prior."""
    answer = np.where([feature.order != 0.0 for feature in FEATURES], 6.0, 0.0) * trace()
    space = Whitened.of(healthy(), answer)
    hypothesis = plane(healthy(), answer / 6.0)
    found, least, most = (
        Contest(space, signature(alone)).again(evaluate_hypothesis(space, hypothesis)).log_bayes
        for alone in (1.0, SHARES[-1], 10.0)
    )
    assert found > most + 5.0
    assert found == pytest.approx(least, abs=2.0)


def test_exact_explanations_keep_their_evidence():
    covariance = healthy()
    space = Whitened.of(covariance, 5.0 * trace())
    contest = Contest(space, signature())
    for hypothesis in (plane(covariance, trace(), "offset", "sensor"), plane(covariance, trace(), "known:x")):
        one = evaluate_hypothesis(space, hypothesis)
        assert contest.again(one) is one
    none = evaluate_hypothesis(Whitened.of(covariance, np.zeros(len(FEATURES))), plane(covariance, trace()))
    assert contest.again(none) is none
