"""From evaluated explanations to a verdict: what a name needs besides its posterior."""

from dataclasses import replace

import numpy as np
import pytest

from rigdesign.diagnosis.decision.decision import changes_of_the_circuit, decide, posterior
from rigdesign.diagnosis.decision.defaults import Candidates, Thresholds, WhitenedSquare
from rigdesign.diagnosis.decision.naming import in_words
from rigdesign.diagnosis.decision.search import _added
from rigdesign.diagnosis.statistics.evidence import Evidence, Hypothesis

COUNTS = {"physical": 50, "unmodelled": 100, "pair": 1000, "sensor": 20}


def evidence(name, log_bayes, family="physical"):
    """With a fall of the whitened square of twice the evidence and 5."""
    parts = tuple(name.split(" + "))
    return Evidence(
        hypothesis=Hypothesis(name=name, family=family, parts=parts),
        log_bayes=log_bayes, coordinates=(1.0, -1.0)[: len(parts)], deviations=(0.1,), gain=2.0 * log_bayes + 5.0,
        columns=np.zeros((60, 1)), answer=np.zeros(60), joined=len(parts) - 1,
    )  # fmt: skip


USUAL = Thresholds()

LOSS = "unknown: heat at oil:test.gear_oil ~n"
HOUSING = "unknown: heat at body:test.housing ~n2"


def verdict(*evaluated, thresholds=USUAL, loop=(), sensors=(), left=0.0, alike=(), one_oil=(), circuit=()):
    ordered = sorted(evaluated, key=lambda one: -one.log_bayes)
    return decide(
        ordered,
        posterior(ordered, COUNTS),
        WhitenedSquare(value=ordered[0].gain + 60.0 + left, count=60),
        Candidates(
            effects=frozenset({"leak", "ripple", *sensors, *alike, *one_oil, *circuit}),
            circuit=frozenset(circuit),
            detectable={"leak": True},
            orders=frozenset(loop),
            sensors=frozenset(sensors),
            alike={name: frozenset(alike) - {name} for name in alike},
            one_oil={LOSS: frozenset(one_oil)} if one_oil else {},
        ),
        thresholds,
    )


def test_a_cause_without_a_name_that_leads_by_too_much_forbids_one():
    pair = "leak + unknown: heat"
    near = verdict(evidence("leak", 40.0), evidence(pair, 44.0, "pair"), thresholds=Thresholds(catalogue=5.0))
    assert (near.verdict, near.named) == ("named", ("leak",))
    far = verdict(evidence("leak", 40.0), evidence(pair, 46.0, "pair"), thresholds=Thresholds(catalogue=5.0))
    assert (far.verdict, far.named) == ("unknown_located", ())


@pytest.mark.parametrize(("name", "loop", "named"), [("leak", (), True), ("ripple", ("ripple",), False)])
def test_orders_ask_for_more_evidence_than_heat(name, loop, named):
    floors = Thresholds(evidence=10.0, evidence_loop=30.0)
    found = verdict(evidence(name, 20.0), thresholds=floors, loop=loop)
    assert (found.verdict == "named") is named
    if not named:
        assert "healthy rigs have given as much" in found.reason


def test_effects_of_one_trace_are_a_group_however_the_posterior_is_divided_among_them():
    bearings = ("all", "front", "rear", "pinion", "wheel")
    each = [evidence(name, 40.0) for name in bearings]
    assert verdict(*each, alike=bearings[:1]).verdict == "unknown_located"
    found = verdict(*each, alike=bearings)
    assert (found.verdict, set(found.named)) == ("alias_group", set(bearings))
    rival = evidence("ripple", 40.0)
    assert verdict(*each, rival, alike=bearings).verdict == "unknown_located"
    few = Thresholds(one_trace=4)
    assert verdict(*each, alike=bearings, thresholds=few).verdict == "unknown_located"


def test_errors_of_sensors_do_not_mend_what_an_effect_leaves():
    offset, other = "sensor_offset:TC01", "sensor_offset:TC02"
    alone = verdict(evidence(offset, 60.0, "sensor"), sensors=(offset, other))
    assert alone.named == (offset,)
    for pair in (f"leak + {offset}", f"{offset} + {other}"):
        found = verdict(
            evidence("leak", 40.0), evidence(offset, 40.0, "sensor"), evidence(pair, 60.0, "pair"),
            sensors=(offset, other),
        )  # fmt: skip
        assert (found.verdict, found.named) == ("unknown_located", ())


@pytest.mark.parametrize(("left", "said"), [(30.0, "within_noise"), (36.0, "too_small")])
def test_what_few_healthy_rigs_leave_is_not_within_noise(left, said):
    """60 numbers leave 3 standard deviations, 32.9, more than 60 in few healthy rigs, whatever explains it weakly."""
    weak = evidence("leak", 0.1)
    assert verdict(weak, left=left - weak.gain).verdict == said


def test_a_group_is_the_smallest_one_not_the_likeliest_effects():
    """A ripple that goes with either of two gears is a more probable part than each of them, and not of the group."""
    gears = ("pinion", "wheel")
    each = [evidence(f"{gear} + ripple", 41.0, "pair") for gear in gears] + [
        evidence(gear, 36.0) for gear in gears
    ]
    found = verdict(*each, alike=gears)
    assert (found.verdict, set(found.named)) == ("alias_group", set(gears))


@pytest.mark.parametrize(("alone", "named"), [(990.0, ("leak",)), (940.0, ())])
def test_the_small_rest_of_a_sensor_is_no_cause_outside_the_catalogue(alone, named):
    """As the zeros of two torque cells, either of which mended 2 % of what the friction of bearings had explained."""
    zeros = ("torque_zero:M_1", "torque_zero:M_2")
    found = verdict(
        evidence("leak", alone),
        *(evidence(f"leak + {zero}", 1000.0, "pair") for zero in zeros),
        sensors=zeros,
    )
    assert found.named == named


@pytest.mark.parametrize(("log_bayes", "named"), [(100.0, ()), (2000.0, ("leak",))])
def test_what_is_left_is_held_against_what_was_explained(log_bayes, named):
    assert verdict(evidence("leak", log_bayes), left=100.0).named == named


LOSSES = ("mesh", "windage", "squeeze")


@pytest.mark.parametrize(("nearest", "found"), [(52.0, "alias_group"), (30.0, "unknown_located")])
def test_a_loss_by_a_law_of_its_own_is_one_of_the_losses_of_that_oil(nearest, found):
    """If the nearest of them accounts for four fifths of it; their order is that of the evidence."""
    said = verdict(
        evidence(LOSS, 60.0, "unmodelled"),
        evidence("windage", nearest),
        evidence("mesh", nearest - 3.0),
        evidence("squeeze", nearest - 6.0),
        one_oil=LOSSES,
    )
    assert said.verdict == found
    if found == "alias_group":
        assert said.named == ("windage", "mesh", "squeeze") and "by its law" in said.reason


def test_a_loss_elsewhere_is_none_of_them():
    other = evidence("unknown: heat at body:test.housing ~n", 60.0, "unmodelled")
    assert verdict(other, evidence("windage", 52.0), evidence("mesh", 50.0), one_oil=LOSSES).named == ()


def test_two_sensors_that_are_off_together_are_not_named():
    """As two thermometers of the wall beside a hot neighbour."""
    first, second = "sensor_offset:TC03", "sensor_offset:TC05"
    both = (evidence(first, 40.0, "sensor"), evidence(f"{first} + {second}", 41.0, "pair"))
    assert verdict(*both, sensors=(first, second)).named == (first,)
    most = evidence(f"{first} + {second}", 90.0, "pair")
    assert verdict(both[0], most, sensors=(first, second)).named == ()


CIRCUIT = ("mesh", "coupling", "spline")


@pytest.mark.parametrize(("rival", "group"), [(380.0, ("mesh", "coupling")), (280.0, ("mesh",))])
def test_changes_of_the_circuit_that_explain_about_as_much_are_a_group(rival, group):
    """Whatever the evidence of one over the other: no answer of the model is more exact than a quarter."""
    found = verdict(
        evidence("mesh", 400.0), evidence("coupling", rival), evidence("spline", 100.0), circuit=CIRCUIT
    )
    assert found.named == group
    assert found.verdict == ("alias_group" if len(group) > 1 else "named")


def test_too_many_changes_of_the_circuit_are_no_group():
    many = [evidence(f"shaft {place}", 380.0) for place in range(USUAL.one_trace)]
    found = verdict(
        evidence("mesh", 400.0), *many, circuit=(*CIRCUIT, *(one.hypothesis.name for one in many))
    )
    assert (found.verdict, found.named) == ("unknown_located", ())


@pytest.mark.parametrize(("rest", "named"), [(480.0, ("mesh",)), (600.0, ())])
def test_an_order_beside_a_change_of_the_circuit_may_be_what_the_model_answers_wrongly(rest, named):
    """Up to a quarter of both; beside any other effect it is a cause of its own."""
    pair = evidence("mesh + unknown: order 32", rest, "pair")
    assert verdict(evidence("mesh", 400.0), pair, circuit=CIRCUIT).named == named
    leak = evidence("leak + unknown: order 32", rest, "pair")
    assert verdict(evidence("leak", 400.0), leak).named == ()


@pytest.mark.parametrize(
    "rest", ["unknown: heat at oil:test.gear_oil ~n", "unknown: conductance film:test.a"]
)
def test_heat_beside_a_change_of_the_circuit_is_a_cause_of_its_own(rest):
    pair = evidence(f"mesh + {rest}", 480.0, "pair")
    assert verdict(evidence("mesh", 400.0), pair, circuit=CIRCUIT).named == ()


def test_a_change_of_the_circuit_named_beside_something_else_loses_nothing():
    both = evidence("ripple + mesh", 450.0, "pair")
    alone = [evidence("mesh", 400.0), evidence("coupling", 395.0), evidence("spline", 390.0)]
    found = verdict(both, *alone, circuit=CIRCUIT)
    assert (found.verdict, set(found.named)) == ("named", {"ripple", "mesh"})


def test_what_explains_nothing_has_no_group():
    none = replace(evidence("mesh", 400.0), gain=-3.0)
    assert changes_of_the_circuit("mesh", [none], open_to(CIRCUIT), USUAL) == ("mesh",)


@pytest.mark.parametrize(
    ("alone", "sensor", "said"),
    [
        (60.0, "", "a cause outside the catalogue explains the data better"),
        (
            30.0,
            "",
            f"leak and {in_words(HOUSING.removeprefix('unknown: '), -1.0)} together explain the data better",
        ),
        (0.0, "torque_zero:M_1", "leak and torque_zero:M_1 together explain the data better"),
    ],
)
def test_a_cause_outside_is_said_to_explain_more_only_where_it_does_so_by_itself(alone, sensor, said):
    """As a rig not yet steady whose walls were 13 K colder, and `power loss in test.housing` was located."""
    other = sensor or HOUSING
    found = verdict(
        evidence("leak", 40.0), evidence(f"leak + {other}", 62.0, "pair"),
        evidence(other, alone, "sensor" if sensor else "unmodelled"), sensors=(sensor,) if sensor else (),
    )  # fmt: skip
    assert found.verdict == "unknown_located" and found.reason.startswith(said)
    assert found.outside is (alone == 60.0)


def test_only_a_cause_outside_the_catalogue_is_said_to_be_outside():
    assert verdict(evidence("unknown: a", 60.0, "unmodelled"), evidence("leak", 20.0)).outside
    assert not verdict(evidence("leak", 60.0)).outside
    assert not verdict(evidence("leak", 60.0), left=400.0).outside


def open_to(names):
    return Candidates(effects=frozenset(names), circuit=frozenset(names), detectable={})


@pytest.mark.parametrize(("alone", "share"), [(999_800.0, 1.0), (900_000.0, 0.2)])
def test_a_companion_that_adds_nothing_takes_no_name_away(alone, share):
    """A ripple that explained 99.99 % was refused for a pitch error that, alone, explained most of it as well."""
    pair, ripple, pitch = (
        replace(evidence(name, 1.0), gain=gain)
        for name, gain in (("ripple + pitch", 1e6), ("ripple", alone), ("pitch", 800_000.0))
    )
    assert _added(pair, "ripple", [pair, ripple, pitch], USUAL.share) == pytest.approx(share * pair.gain)
