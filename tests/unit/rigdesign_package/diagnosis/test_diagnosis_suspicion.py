"""What is suspected: a probable effect with a remainder; what is one-sided, contradicted or slight is not."""

import json
from dataclasses import replace
from math import log

import numpy as np
import pytest

from rigdesign.cli.terminal.diagnosis import print_diagnosis
from rigdesign.diagnosis.decision.claims import agreement
from rigdesign.diagnosis.decision.cross_validation import Problem
from rigdesign.diagnosis.decision.held_out_data import AGREEMENT
from rigdesign.diagnosis.decision.naming import in_words
from rigdesign.diagnosis.decision.workflow import diagnose
from rigdesign.diagnosis.document.document import diagnosis_document
from rigdesign.diagnosis.document.outcome import outcome
from rigdesign.diagnosis.statistics.columns import Column
from rigdesign.diagnosis.statistics.covariance import Covariance, Whitened
from rigdesign.diagnosis.statistics.evidence import Hypothesis, evaluate_hypothesis
from rigdesign.report.diagnosis_files import write_diagnosis
from tests.builders.diagnosis import DESIGN, rerun, story
from tests.unit.rigdesign_package.diagnosis.test_diagnosis_claims import SIZE, healthy, stored, with_added


def unmodelled(problem: Problem, kelvin: float):
    """(n,) a warmer bearing by a law that no cause of the catalogue and no heat without a name has."""
    speeds = {one.name: one.speed for one in problem.residuals.library.settings}
    features = problem.residuals.features
    return np.array(
        [
            kelvin * (-1.0) ** int(one.setting[1:]) * (speeds[one.setting] / 200.0) ** 0.3
            if one.channel == "T_bearing"
            else 0.0
            for one in features
        ]
    )


def with_remainder() -> Problem:
    """Mesh losses 30 % higher, and a bearing that does what the model knows nothing of."""
    problem = healthy()
    return with_added(problem, stored(problem, SIZE) + unmodelled(problem, 1.8))


def diagnosed(problem: Problem):
    return diagnose(problem, DESIGN, rerun(problem.residuals.library.settings))


def reported(problem: Problem):
    found = diagnosed(problem)
    return outcome(replace(story("mesh loss"), problem=problem, diagnosis=found))


def test_an_effect_with_an_unmodelled_remainder_is_suspected():
    found = diagnosed(with_remainder())
    assert (found.decision.verdict, found.named) == ("suspected", ("mesh_loss:test",))
    assert found.strength == "indicative" and found.found == ()
    (size,) = found.suspicion.fit.sizes
    assert size.interval[0] < log(1.3) < size.interval[1]
    assert found.suspicion.gap.shrunk


def test_a_suspect_that_leaves_next_to_nothing_is_named():
    """Where an unmodelled cause mends a few per cent of what the effect explains, and the points held out agree."""
    problem = healthy()
    found = diagnosed(with_added(problem, stored(problem, SIZE) + unmodelled(problem, 1.3)))
    assert found.evaluations[0].decision.verdict == "unknown_located"
    assert (found.decision.verdict, found.named) == ("named", ("mesh_loss:test",))
    assert found.suspicion is None and found.gap.shrunk and found.strength == "proven"


def test_nothing_is_suspected_of_a_healthy_rig_or_of_the_remainder_alone():
    assert diagnosed(healthy()).suspicion is None
    problem = healthy()
    alone = diagnosed(with_added(problem, unmodelled(problem, 1.8)))
    assert alone.suspicion is None and alone.named == ()


def test_an_effect_at_some_points_only_is_another_one():
    """Losses that are twice as high at every other point, and as in the model between, follow no friction."""
    problem = with_remainder()
    twice = np.array([one.setting != "" and int(one.setting[1:]) % 2 for one in problem.residuals.features])
    answer = stored(problem, SIZE)
    found = diagnosed(with_added(problem, np.where(twice, 2.0 * answer, -answer)))
    assert found.suspicion is None and found.named == ()


def test_its_patch_is_offered_and_not_applied(tmp_path, capsys):
    shown = reported(with_remainder())
    assert shown.case_patch is None and shown.offered is not None and shown.named == ()
    document = diagnosis_document(shown)
    assert (
        document["verdict"] == "suspected"
        and document["strength"] == "indicative"
        and document["named"] == []
    )
    assert document["suspected"]["effect"] == "mesh_loss:test" and document["gap"]["effects_added"] == [
        "mesh_loss:test"
    ]
    write_diagnosis(shown, tmp_path)
    patch = json.loads((tmp_path / "suspected.patch.json").read_text())
    assert any("suspected, not proven" in str(step.get("value", "")) for step in patch)
    assert (tmp_path / "suspected" / "case.toml").is_file() and not (tmp_path / "patched").exists()
    page = (tmp_path / "diagnosis.html").read_text()
    assert "Suspected effect" in page and "rigdesign check suspected" in page
    print_diagnosis(shown, tmp_path)
    printed = capsys.readouterr().out
    assert "effect suspected" in printed and "mesh_loss:test" in printed


def test_picked_by_the_user_it_is_applied():
    found = diagnosed(with_remainder())
    shown = outcome(
        replace(story("mesh loss"), problem=with_remainder(), diagnosis=found), pick="mesh_loss:test"
    )
    assert shown.case_patch is not None and shown.offered is None and shown.in_model == ("mesh_loss:test",)


def test_sizes_agree_over_groups_if_they_are_of_one_effect():
    """Against the closed form of independent groups: chi square of their factors about the weighted mean."""
    rng = np.random.default_rng(3)
    count, noise = 60, 0.2
    groups = np.repeat(np.arange(6), 10)
    answer = rng.normal(size=count)
    for factors, alike in ((np.full(6, 1.3), True), (np.array([2.0, 2.0, 2.0, 0.0, 0.0, 0.0]), False)):
        read = factors[groups] * answer + noise * rng.normal(size=count)
        space = Whitened.of(Covariance.of_noise(np.full(count, noise), [], {}), read)
        hypothesis = Hypothesis(
            name="a", family="physical", parts=("a",), columns=answer[:, None] / noise, half=5.0
        )
        probability = agreement(space, evaluate_hypothesis(space, hypothesis), groups.tolist(), 0.1)
        assert (probability > AGREEMENT) is alike


def test_a_common_cause_in_the_covariance_is_no_disagreement():
    """What all numbers of a group share by the covariance of a healthy rig does not count as another size."""
    rng = np.random.default_rng(5)
    count = 40
    groups = np.repeat([0, 1], 20)
    answer = np.ones(count)
    shared = Column(name="of the first group", kind="x", values=(groups == 0) * 1.0, spread=1.0)
    space = Whitened.of(
        Covariance.of_noise(np.full(count, 0.1), [shared], {}),
        answer + 0.9 * (groups == 0) + 0.1 * rng.normal(size=count),
    )
    white = space.covariance.whiten(answer)[:, None]
    hypothesis = Hypothesis(name="a", family="physical", parts=("a",), columns=white, half=5.0)
    assert agreement(space, evaluate_hypothesis(space, hypothesis), groups.tolist(), 0.1) > AGREEMENT


def test_a_cause_beside_an_effect_has_a_size_of_its_own():
    """Two causes that overlap in one group: alone the first seems to want two sizes there, with the second one."""
    rng = np.random.default_rng(7)
    count = 60
    groups = np.repeat(np.arange(3), 20)
    first, second = rng.normal(size=count), np.where(groups == 0, rng.normal(size=count), 0.0)
    second = np.where(groups == 0, second + 0.9 * first, 0.0)
    space = Whitened.of(Covariance.of_noise(np.ones(count), [], {}), 20.0 * first + 30.0 * second)
    one, other = (
        evaluate_hypothesis(
            space, Hypothesis(name=name, family="physical", parts=(name,), columns=column[:, None], half=90.0)
        )
        for name, column in (("a", first), ("b", second))
    )
    assert agreement(space, one, groups.tolist(), 0.1) < AGREEMENT
    assert agreement(space, one, groups.tolist(), 0.1, [other]) > AGREEMENT


@pytest.mark.parametrize(
    ("cause", "words", "size"),
    [
        (
            "heat unpaid at body:test.housing ~n2",
            "heat from outside the drive in test.housing, growing with the square of the speed",
            3.0,
        ),
        ("heat at rim:test.wheel ~T n", "power loss in gear test.wheel, growing with torque and speed", 0.0),
        (
            "heat near TC07 ~T above ambient",
            "heat source or draught near thermocouple TC07, growing with the temperature above ambient",
            0.0,
        ),
        ("heat in the drain of test.gear_oil constant", "heat in the drain line of test.gear_oil", 1.0),
        (
            "order 2 of M_1 ~n2",
            "order 2 of M_1 without a known source, growing with the square of the speed",
            -1.0,
        ),
        ("conductance contact:test.a|b", "heat path other than modelled: contact from test.a to b", 0.0),
        ("conductance film:test.outer_warm", "heat path other than modelled: film at test.outer_warm", 0.0),
        (
            "heat at body:test.housing ~n2",
            "less power loss than modelled in test.housing, growing with the square of the speed",
            -2.0,
        ),
        (
            "heat unpaid at oil:a ~n",
            "cooling from outside the drive in the oil a, growing with the speed",
            -2.0,
        ),
        ("heat near TC07 constant", "draught near thermocouple TC07, the same at all operating points", -0.1),
        ("heat in the drain of a constant", "cooling in the drain line of a", -1.0),
        ("conductance film:a", "heat path worse than modelled: film at a", -0.3),
    ],
)
def test_unmodelled_causes_are_said_in_words_by_their_sign(cause, words, size):
    assert in_words(cause, size) == words
