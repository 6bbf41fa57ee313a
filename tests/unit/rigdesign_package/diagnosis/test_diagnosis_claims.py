"""What may be claimed: sizes that matter, a gap that shrinks on points held out, no effect of the same trace."""

from dataclasses import replace
from math import log

import numpy as np
import pytest

from rigdesign.base.errors import NotConvergedError
from rigdesign.case import load_case
from rigdesign.cli.terminal.diagnosis import print_diagnosis
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.diagnosis.decision.claims import Traces, _group
from rigdesign.diagnosis.decision.cross_validation import FullRun, Problem, Proof
from rigdesign.diagnosis.decision.workflow import diagnose
from rigdesign.diagnosis.document.document import diagnosis_document
from rigdesign.diagnosis.document.outcome import outcome
from rigdesign.diagnosis.library.library import Response
from rigdesign.diagnosis.statistics.covariance import Covariance, Whitened
from rigdesign.diagnosis.statistics.evidence import Hypothesis, evaluate_hypothesis
from rigdesign.diagnosis.statistics.heldout import gap, held_out
from rigdesign.prediction import MEASURED_AGAINST, Channel, OperatingCondition
from rigdesign.prediction.model import changed_case
from rigdesign.prediction.predict import predict
from rigdesign.report.pages.diagnosis import diagnosis_page
from tests.builders.diagnosis import DESIGN, Rig, rerun, result_of, story, the_case, write_set
from tests.builders.paths import CASES

SIZE = {"mesh_loss:test": (log(1.3),)}


def stored(problem, sizes):
    """(n,) what effects at these sizes add to the numbers of a problem, by the stored runs."""
    residuals = problem.residuals
    space = Whitened.of(Covariance.of_noise(residuals.noise, [], {}), residuals.residual)
    return Proof(residuals=residuals, whole=space, points=()).stored(sizes)


def with_added(problem: Problem, added) -> Problem:
    """The problem with something added to what was read."""
    residuals = problem.residuals
    return replace(problem, residuals=replace(residuals, values=residuals.values + added))


def aside(problem: Problem) -> np.ndarray:
    """(n,) whether a number is of a point held out."""
    points = held_out([one.name for one in problem.residuals.library.settings], problem.seed)
    return np.array([feature.setting in points for feature in problem.residuals.features])


def diagnosed(problem: Problem, again=None):
    return diagnose(problem, DESIGN, again or rerun(problem.residuals.library.settings))


def healthy() -> Problem:
    """Of a rig that was measured before, with nothing at work."""
    problem = story("mesh loss").problem
    return with_added(problem, -stored(problem, {"mesh_loss:test": (log(1.2),)}))


def contradicted() -> Problem:
    """Readings that show an effect at the points of the fit, and its opposite at those held out."""
    problem = healthy()
    answer = stored(problem, SIZE)
    return with_added(problem, np.where(aside(problem), -answer, answer))


def test_no_name_and_nothing_proven_where_the_gap_grows():
    """As a weak tooth that was named a ripple of the motor while the gap on the points held out grew."""
    found = diagnosed(contradicted())
    assert (found.decision.verdict, found.named, found.strength) == ("unknown_located", (), "indicative")
    (refusal,) = found.refused
    assert refusal.name == "mesh_loss:test" and refusal.gap is not None
    assert refusal.gap.grown and refusal.gap.after > refusal.gap.before and "grows" in refusal.reason


def test_a_grown_gap_is_red_on_the_page_and_in_the_terminal(tmp_path, capsys, monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    problem = contradicted()
    reported = outcome(replace(story("mesh loss"), problem=problem, diagnosis=diagnosed(problem)))
    document = diagnosis_document(reported)
    assert document["named"] == [] and document["patch"]["case"] is None
    (row,) = document["refused"]
    assert (
        row["effect"] == "mesh_loss:test"
        and row["gap"]["grown"]
        and row["gap"]["after"] > row["gap"]["before"]
    )
    page = diagnosis_page(reported, document)
    assert (
        '<p class="grown">With <b>friction of the teeth' in page
        and ".grown { color: var(--fail)" in page.replace(".grown, .grown b", ".grown")
    )
    print_diagnosis(reported, tmp_path)
    text = capsys.readouterr().out
    red = text.split("\x1b[1;31m")[1:]
    assert any("grows from" in part.split("\x1b[0m")[0] for part in red)


def test_a_gap_that_shrinks_by_less_than_its_scatter_proves_nothing():
    problem = healthy()
    answer = stored(problem, SIZE)
    found = diagnosed(with_added(problem, np.where(aside(problem), 0.52 * answer, answer)))
    (refusal,) = found.refused
    assert refusal.gap is not None and not refusal.gap.grown and not refusal.gap.shrunk
    assert (found.decision.verdict, found.named) == ("too_small", ()) and "scatter" in refusal.reason


def test_the_gap_reported_is_that_of_the_full_run():
    problem = with_added(healthy(), stored(healthy(), SIZE))
    formulas = rerun(problem.residuals.library.settings)
    by_stored = diagnosed(problem)
    assert by_stored.strength == "proven" and by_stored.named == ("mesh_loss:test",)
    less = diagnosed(problem, lambda features, sizes: 0.9 * formulas(features, sizes))
    assert less.strength == "proven" and less.gap.after > by_stored.gap.after
    rows = aside(problem)
    assert less.answer[rows] == pytest.approx(0.9 * by_stored.answer[rows], rel=1e-3)
    assert less.answer[~rows] == pytest.approx(by_stored.answer[~rows])
    nothing = diagnosed(problem, lambda features, sizes: -formulas(features, sizes))
    assert nothing.named == () and nothing.refused[0].gap.grown


def test_a_solver_that_gives_up_is_no_evidence_against_a_name():
    """As a misalignment with a posterior of 1.0 that was refused since the full model did not converge at one point."""
    problem = with_added(healthy(), stored(healthy(), SIZE))

    def fails(features, sizes):
        raise NotConvergedError("temperatures do not settle")

    found = diagnosed(problem, fails)
    assert (found.decision.verdict, found.named) == ("named", ("mesh_loss:test",))
    assert found.strength == "indicative" and found.gap is not None and found.gap.shrunk
    reported = outcome(replace(story("mesh loss"), problem=problem, diagnosis=found))
    document = diagnosis_document(reported)
    assert document["certainty"] == (
        "Indicative: it could not be confirmed: the case with mesh_loss:test does not run in full: "
        "temperatures do not settle."
    )
    assert reported.case_patch is None and "does not run in full" in reported.refused
    assert "by the stored runs of the model" in diagnosis_page(reported, document)


def test_without_a_full_run_nothing_is_proven():
    problem = with_added(healthy(), stored(healthy(), SIZE))
    found = diagnose(problem, DESIGN)
    assert found.named == ("mesh_loss:test",) and found.strength == "indicative"
    reported = outcome(replace(story("mesh loss"), problem=problem, diagnosis=found))
    assert "not run in full" in diagnosis_document(reported)["certainty"]


def test_of_two_names_only_the_one_that_closes_the_gap_is_given():
    problem = healthy()
    good, bad = (stored(problem, {name: (log(1.4),)}) for name in ("mesh_loss:test", "bearing_loss:test"))
    found = diagnosed(with_added(problem, good + np.where(aside(problem), -bad, bad)))
    assert found.named == ("mesh_loss:test",) and [one.name for one in found.refused] == ["bearing_loss:test"]
    assert found.fit is not None and [size.effect for size in found.fit.sizes] == ["mesh_loss:test"]


def test_too_few_points_to_keep_one_aside_give_no_name(tmp_path):
    found = result_of(
        write_set(tmp_path, Rig({"run_out:reference.pinion": (25e-6, -10e-6)}, points=5))
    ).diagnosis
    assert (found.decision.verdict, found.named) == ("data_insufficient", ())
    assert (
        "none of 5 operating points" in found.decision.reason
        and found.refused[0].name == "run_out:reference.pinion"
    )


@pytest.mark.parametrize(
    ("size", "verdict"), [(5e-6, "within_noise"), (6.4e-6, "too_small"), (10e-6, "named")]
)
def test_a_pitch_within_the_tolerance_of_its_grade_is_not_named(tmp_path, size, verdict):
    """f_pT of the pinion is 6.5 um (ISO 1328-1, its grade)."""
    found = result_of(write_set(tmp_path, Rig({"single_pitch:test.pinion/5": (size,)}))).diagnosis
    assert found.decision.verdict == verdict, found.decision.reason
    if verdict == "too_small":
        assert found.refused[0].explanation == "single_pitch:test.pinion/5"
        assert "below 6.5 um it is not significant" in found.decision.reason


@pytest.mark.parametrize("rig", ["loop_1to1", "loop_hunting", "uhcf_prototype", "uhcf_main"])
def test_what_a_healthy_rig_does_not_have_has_a_smallest_size(rig):
    for effect in effects_of(load_case(CASES / rig)):
        if effect.healthy == 0.0:
            assert 0.0 < effect.matters < 0.2 * effect.reach, effect.name
        else:
            assert effect.matters == 0.0, effect.name


def thin_oil(problem: Problem, teeth: float = 0.02) -> Problem:
    """With a viscosity that answers as friction of the bearings does, but for a little of the friction of the teeth."""

    def more(residuals):
        known = residuals.library.responses
        bearing, mesh = known["bearing_loss:test"], known["mesh_loss:test"]
        answers = bearing.answers + teeth * bearing.coordinates * mesh.sensitivity()[:, 0]
        viscosity = Response(coordinates=0.45 * bearing.coordinates, answers=answers)
        library = replace(residuals.library, responses={**known, "oil_viscosity:test": viscosity})
        return replace(residuals, library=library)

    return replace(problem, residuals=more(problem.residuals), baseline=more(problem.baseline))


def test_effects_of_one_trace_end_as_a_group():
    """As viscosity, which was named friction of the bearings at a correlation of 0.997."""
    problem = thin_oil(healthy())
    found = diagnosed(with_added(problem, stored(problem, {"bearing_loss:test": (log(1.35),)})))
    assert found.evaluations[0].decision.verdict == "named"
    assert found.decision.verdict == "alias_group" and found.strength == "indicative"
    assert set(found.named) == {"bearing_loss:test", "oil_viscosity:test"}
    assert "oil_viscosity:test has the signature of bearing_loss:test" in found.decision.reason


def test_effects_present_apart_from_a_group_are_reported():
    problem = thin_oil(healthy())
    both = {"bearing_loss:test": (log(1.2),), "single_pitch:test.pinion/5": (60e-6,)}
    found = diagnosed(with_added(problem, stored(problem, both)))
    assert (found.decision.verdict, found.decision.apart) == ("alias_group", ("single_pitch:test.pinion",))
    reported = outcome(replace(story("mesh loss"), problem=problem, diagnosis=found))
    document = diagnosis_document(reported)
    assert [row["effect"] for row in document["named"]] == ["single_pitch:test.pinion"]
    assert {row["effect"] for row in document["suspects"]} == {"bearing_loss:test", "oil_viscosity:test"}
    assert "Missing in the model: single pitch deviation of test.pinion: tooth 5" in document["headline"]
    assert reported.case_patch is None and "--name" in reported.refused and document["gap"]["shrunk"]
    assert document["gap"]["effects_added"] == ["single_pitch:test.pinion/5", "bearing_loss:test"]
    assert (
        document["strength"] == "indicative"
        and "an alias group identifies no single effect" in document["certainty"]
    )
    for pick in ("bearing_loss:test", "oil_viscosity:test"):
        picked = outcome(reported.result, pick=pick)
        assert [one.name for one in picked.applied] == ["single_pitch:test.pinion", pick]
        assert picked.gap is not None and picked.gap.shrunk and picked.case_patch is not None
        assert len(picked.case_patch.values) >= 2
    again = outcome(reported.result, pick="single_pitch:test.pinion")
    assert [one.name for one in again.applied] == ["single_pitch:test.pinion"]
    assert again.case_patch is not None and again.case_patch.title.count("single pitch deviation") == 1


def slight_below(problem: Problem, effect: str, least: float) -> Problem:
    """The problem with an effect that does not matter below a coordinate."""

    def more(residuals):
        effects = [replace(one, matters=least) if one.name == effect else one for one in residuals.effects]
        return replace(residuals, effects=tuple(effects))

    return replace(problem, residuals=more(problem.residuals), baseline=more(problem.baseline))


def test_a_group_stands_beside_a_name_that_is_too_little_for_one():
    """Friction of teeth that explains part of what friction of bearings, or viscosity, does."""
    problem = slight_below(thin_oil(healthy(), teeth=0.0), "mesh_loss:test", log(1.05))
    both = {"bearing_loss:test": (log(1.12),), "mesh_loss:test": (log(1.02),)}
    found = diagnosed(with_added(problem, stored(problem, both)))
    assert found.evaluations[0].weights.inclusion["mesh_loss:test"] > 0.95
    assert found.decision.verdict == "alias_group", found.decision.reason
    assert set(found.named) == {"bearing_loss:test", "oil_viscosity:test"}


def test_a_name_is_not_left_alone_where_most_belongs_to_a_slight_one():
    """A draught was named where a bolted frame took the heat, as a rig not yet steady was too slight to be named."""
    problem = slight_below(healthy(), "mesh_loss:test", log(1.2))
    both = {"mesh_loss:test": (log(1.1),), "bearing_loss:test": (log(1.06),)}
    found = diagnosed(with_added(problem, stored(problem, both)))
    assert [(one.name, one.slight) for one in found.refused] == [
        ("mesh_loss:test", True), ("bearing_loss:test", False),
    ]  # fmt: skip
    assert (found.decision.verdict, found.named) == ("unknown_located", ())
    assert "after bearing_loss:test alone the residual is" in found.decision.reason


def test_effects_of_different_domains_do_not_compete():
    """Friction of the teeth in temperatures, a pitch error in orders: both are named, each by its own numbers."""
    problem = healthy()
    both = {"mesh_loss:test": (log(1.3),), "single_pitch:test.pinion/5": (30e-6,)}
    found = diagnosed(with_added(problem, stored(problem, both)))
    assert found.decision.verdict == "named"
    assert set(found.named) == {"mesh_loss:test", "single_pitch:test.pinion"}
    assert found.gap is not None and found.gap.shrunk
    sizes = {one.effect: one for one in found.fit.sizes}
    for name, (size,) in both.items():
        assert sizes[name].interval[0] < size < sizes[name].interval[1]


def traces(columns, *, noise=None, assembly=None):
    """Of effects with these columns (n, k), the first one at work."""
    columns = np.asarray(columns, dtype=float)
    space = Whitened.of(
        Covariance.of_noise(np.ones(len(columns)) if noise is None else noise, [], {}), 9.0 * columns[:, 0]
    )
    effects = [
        Hypothesis(
            name=name,
            family="physical",
            parts=(name,),
            columns=space.covariance.whiten(column[:, None]),
            half=20.0,
        )
        for name, column in zip("abc", columns.T)
    ]
    assembly = [()] * len(columns) if assembly is None else assembly
    return Traces(
        space=space, explanations=[evaluate_hypothesis(space, one) for one in effects], assembly=assembly
    )


def test_the_group_begins_at_a_correlation_of_95_per_cent():
    columns = [[1.0, 0.96, 0.94], [0.0, (1 - 0.96**2) ** 0.5, 0.0], [0.0, 0.0, (1 - 0.94**2) ** 0.5]]
    ((rival, correlation),) = traces(columns).like("a", (9.0,))
    assert rival == "b" and correlation == pytest.approx(0.96)


def test_a_mesh_put_together_otherwise_tells_its_gears_apart():
    """The same trace at points read exactly, another one at points where the wheel stands further, read less so."""
    noise = np.array([0.001, 0.001, 0.1, 0.1])
    columns = [[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [1.0, -0.4, 0.0], [1.0, -0.4, 0.0]]
    assert [name for name, _ in traces(columns, noise=noise).like("a", (9.0,))] == ["b"]
    further = [(), (), (("test.main", 9),), (("test.main", 9),)]
    assert traces(columns, noise=noise, assembly=further).like("a", (9.0,)) == []
    same = [[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [1.0, 0.9, 0.0], [1.0, 0.9, 0.0]]
    assert [name for name, _ in traces(same, noise=noise, assembly=further).like("a", (9.0,))] == ["b"]


def test_a_second_group_is_not_apart_from_the_first():
    """Two pairs of effects, each of one trace, and a fifth by itself."""
    columns = np.zeros((6, 5))
    columns[0, :2] = columns[2, 2:4] = columns[4, 4] = 1.0
    columns[1, 1] = columns[3, 3] = 0.1
    space = Whitened.of(
        Covariance.of_noise(np.ones(6), [], {}), 9.0 * (columns[:, 0] + columns[:, 2] + columns[:, 4])
    )
    effects = [
        Hypothesis(name=name, family="physical", parts=(name,), columns=column[:, None], half=20.0)
        for name, column in zip("abcde", columns.T)
    ]
    evaluated = [evaluate_hypothesis(space, one) for one in effects]
    found = [evaluated[0], evaluated[2], evaluated[4]]
    sizes = dict.fromkeys("ace", (9.0,))
    decision = _group(found, sizes, Traces(space=space, explanations=evaluated, assembly=[()] * 6))
    assert decision is not None and decision.named == ("a", "b") and decision.apart == ("e",)
    assert "b has the signature of a" in decision.reason and "d has the signature of c" in decision.reason
    assert (
        _group([evaluated[4]], sizes, Traces(space=space, explanations=evaluated, assembly=[()] * 6)) is None
    )


def test_offset_and_scale_of_one_sensor_are_one_finding():
    columns = [[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [0.0, 0.1, 1.0]]
    found = traces(columns)
    names = ("sensor_offset:T1", "sensor_scale:T1")
    for other, alike in (("sensor_scale:T1", []), ("sensor_scale:T2", ["sensor_scale:T2"])):
        evaluated = [
            replace(one, hypothesis=replace(one.hypothesis, family="sensor", parts=(name,)))
            for one, name in zip(found.explanations, (names[0], other))
        ]
        rivals = Traces(space=found.space, explanations=evaluated, assembly=[()] * 3).like("a", (9.0,))
        assert [name for name, _ in rivals] == alike


def test_what_its_bounds_keep_too_small_cannot_stand_for_a_name():
    evaluated = traces([[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [0.0, 0.1, 1.0]]).explanations
    space = traces([[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [0.0, 0.1, 1.0]]).space
    small = replace(evaluated[1].hypothesis, half=2.0)
    again = Traces(
        space=space, explanations=[evaluated[0], evaluate_hypothesis(space, small)], assembly=[()] * 3
    )
    assert (
        traces([[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [0.0, 0.1, 1.0]]).like("a", (9.0,))
        and again.like("a", (9.0,)) == []
    )


@pytest.mark.parametrize("size", [0.0, 1.0])
def test_scatter_is_the_standard_deviation_of_the_fall(size):
    """Of a healthy rig the fall is -d^2, of one with the effect +d^2, both with a standard deviation of 2 d."""
    rng = np.random.default_rng(8)
    mixed = rng.normal(size=(30, 30))
    covariance = Covariance(base=0.3 * np.eye(30) + mixed @ mixed.T / 30, columns=(), amplitudes={})
    answer = rng.normal(size=30)
    length = float(np.linalg.norm(covariance.whiten(answer)))
    draws = covariance.lower @ rng.normal(size=(30, 4000)) + size * answer[:, None]
    found = [gap(covariance, draw, answer, np.ones(30), ["T"] * 30, ("P1",)) for draw in draws.T]
    falls = np.array([one.fall for one in found])
    assert falls.mean() == pytest.approx((2.0 * size - 1.0) * length**2, abs=0.2 * length)
    assert falls.std() == pytest.approx(2.0 * length, rel=0.04)
    scatters = np.array([one.scatter for one in found])
    assert np.all(scatters >= 2.0 * length - 1e-9)
    one = found[0]
    assert one.fall == pytest.approx(30 * (one.before**2 - one.after**2))
    assert (one.shrunk, one.grown) == (one.fall > one.scatter, one.fall < 0.0)


def test_a_pick_with_which_the_gap_grows_is_not_patched():
    problem = contradicted()
    reported = outcome(
        replace(story("mesh loss"), problem=problem, diagnosis=diagnosed(problem)), pick="mesh_loss:test"
    )
    assert (
        reported.case_patch is None
        and "grows" in reported.refused
        and reported.gap is not None
        and reported.gap.grown
    )
    alias = outcome(story("alias"), pick="run_out:test.wheel")
    assert alias.case_patch is not None and alias.gap is not None and alias.gap.shrunk


def test_the_full_run_is_that_of_a_check():
    case = the_case()
    setting = OperatingCondition(name="P1", speed=150.0, torque=200.0)
    channels = (
        Channel(name="P", quantity="motor_power", place="motor"),
        Channel(name="T", quantity="oil_outlet_temperature", place="test.gear_oil"),
    )
    full = FullRun(case=case, settings=(setting,), channels=channels, effects=effects_of(case))
    before = predict(case, [setting], channels, circuit=MEASURED_AGAINST)
    changed = changed_case(case, {"gearboxes.test.loss_factors.mesh": 1.5})
    after = predict(changed, [setting], channels, circuit=MEASURED_AGAINST)
    found = full(before.features[::-1], {"mesh_loss:test": (log(1.5),)})
    assert found[::-1] == pytest.approx(after.values - before.values, rel=1e-9)
    assert found.min() > 0.0


def test_what_the_other_domain_contradicts_has_a_trace_and_is_no_rival():
    """With a name in the model it may be contradicted no longer, and be the next name."""
    columns = [[1.0, 0.99, 0.0], [0.0, 0.1, 1.0], [0.0, 0.0, 0.0]]
    known = traces(columns)
    first, second, _ = known.explanations
    assert [name for name, _ in known.like("a", (9.0,))] == ["b"]
    left = replace(known, explanations=[first], contradicted=[second])
    assert left.like("a", (9.0,)) == []
    assert left.of("b") is second and left.like("b", (9.0,)) != []
