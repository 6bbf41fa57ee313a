"""A diagnosis in sentences: the verdict, how sure it is, and what to do next."""

from dataclasses import dataclass
from math import exp

from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.decision.naming import formatted
from rigdesign.diagnosis.decision.proposals import credible_places
from rigdesign.diagnosis.decision.workflow import LEAST_RUNNING_POINTS
from rigdesign.diagnosis.document.outcome import Outcome
from rigdesign.diagnosis.statistics.heldout import LEAST_POINTS, gap_in_words
from rigdesign.diagnosis.statistics.next_measurement import Ranked
from rigdesign.measurement.comparison.compare import sentence, significant

VERDICTS = {
    "named": "effect named",
    "suspected": "effect suspected",
    "alias_group": "one of an alias group",
    "unknown_located": "unknown, located",
    "within_noise": "no effect missing",
    "too_small": "too small to identify",
    "input_error_suspected": "data error suspected",
    "data_insufficient": "data insufficient",
}
"""Verdict -> as a heading."""


NOTABLE = 1.5
"""Residual of a group [standard deviations of a healthy rig] from which on it is reported although it proves
nothing."""


WORTH = 0.5
"""Expected logarithm of the Bayes factor from which on a measurement is proposed."""

LARGEST_ODDS = 1e6
"""Odds beyond which none are distinguished."""

MOST_PROPOSED = 8
"""Measurements proposed."""


@dataclass(frozen=True, kw_only=True)
class NextStep:
    """Something to measure or do next.

    expected_evidence : logarithm of the Bayes factor of the true rival, of those distinguished least; cost : as the set
    states costs, else relative to one thermocouple; None where it follows from a rule and not from a computation
    """

    text: str
    why: str
    expected_evidence: float | None = None
    cost: float | None = None
    decides: bool | None = None

    @property
    def odds(self) -> float | None:
        """Expected odds of the true rival against the others."""
        return None if self.expected_evidence is None else min(exp(self.expected_evidence), LARGEST_ODDS)


DOUBTFUL_READINGS = ("swapped_channels", "unit", "thousands")
"""Findings of the data, beside those that are named, that the verdict of a set in which nothing is named has to say."""
NOTHING_NAMED = ("within_noise", "too_small", "unknown_located", "data_insufficient")


def headline(outcome: Outcome) -> str:
    """The verdict in a sentence or two, and readings in doubt where nothing is named."""
    texts = [_verdict(outcome)]
    if outcome.verdict in NOTHING_NAMED:
        doubtful = [finding for finding in outcome.result.data.findings if finding.id in DOUBTFUL_READINGS]
        texts += [
            f"Readings in doubt: {finding.text}." for finding in doubtful if finding.weight == "suspect"
        ]
    return " ".join(texts)


def _verdict(outcome: Outcome) -> str:
    diagnosis = outcome.result.diagnosis
    match outcome.verdict:
        case "named":
            return " ".join([*_named(outcome), *_besides(outcome)])
        case "alias_group":
            group = f"One of these effects is present; the data do not identify which: {_titles(outcome)}."
            return " ".join([group, *_named(outcome), *_besides(outcome)])
        case "suspected":
            return _suspected(outcome)
        case "input_error_suspected":
            return f"A data error is more probable than a model error: {_titles(outcome)}."
        case "unknown_located":
            reason = diagnosis.decision.reason
            lead = "An effect is present; the data do not identify it"
            return f"{lead}: {reason}. {_located(outcome)}{_where(outcome)}".rstrip()
        case "within_noise":
            return (
                "No missing effect is detectable in these data: the residual is within that of a healthy rig."
            )
        case "too_small":
            lead = "An effect may be present, too small to be distinguished from competing causes"
            return f"{lead}; most probable: {_titles(outcome)}."
    return f"These data cannot identify an effect: {diagnosis.decision.reason}. {_foremost(outcome)}".rstrip()


def _named(outcome: Outcome) -> list[str]:
    """What is named, of the case and of the measurement apart."""
    texts = []
    for lead, of_case in (("Missing in the model", True), ("Wrong in the measurement", False)):
        causes = [cause for cause in outcome.named if isinstance(cause.entry, Effect) == of_case]
        if causes:
            texts.append(
                f"{lead}: {'; '.join(f'{cause.title}, {formatted(cause.shown[0])}' for cause in causes)}."
            )
    return texts


def _besides(outcome: Outcome) -> list[str]:
    """A further group, and what the numbers of the other domain say."""
    decision = outcome.result.diagnosis.decision
    texts = []
    if decision.as_well:
        titles = "; ".join(outcome.names.title(name) for name in decision.as_well)
        texts.append(f"One of these as well: {titles}.")
    if decision.elsewhere:
        texts.append(f"{decision.elsewhere[:1].upper()}{decision.elsewhere[1:]}.")
    return texts


def _suspected(outcome: Outcome) -> str:
    """The suspected effect with its size, what speaks for it, and the gap with it."""
    assert outcome.suspected is not None
    suspect = outcome.suspected
    gap = "" if outcome.gap is None else f" With it in the model the gap {gap_in_words(outcome.gap)}."
    reason = outcome.result.diagnosis.decision.reason
    return (
        f"Suspected: {suspect.title}, {formatted(suspect.shown[0])}. {reason[:1].upper()}{reason[1:]}.{gap}"
    )


def _located(outcome: Outcome) -> str:
    """The places of a cause in no catalogue in a sentence; empty where they are not known."""
    places = _places(outcome)
    return f"Located: {places}. " if places else ""


def _places(outcome: Outcome) -> str:
    """``power loss in a or power loss in b, growing with the speed``; empty where they are not known."""
    words = [place.in_words.partition(", ") for place in credible_places(outcome.result.diagnosis)]
    if len({law for _, _, law in words}) == 1:
        return f"{' or '.join(cause for cause, _, _ in words)}, {words[0][2]}".rstrip(", ")
    return " or ".join("".join(parts) for parts in words)


def _where(outcome: Outcome) -> str:
    """The most conspicuous group in a sentence; empty where none is outside the residual of a healthy rig."""
    first = outcome.before[0] if outcome.before else None
    return "" if first is None or not significant(first) else sentence(first, outcome.result.measurement)


def _foremost(outcome: Outcome) -> str:
    """The largest residual and the best explanation of it, as far as few data allow."""
    first = outcome.before[0] if outcome.before else None
    if first is None or first.rms < NOTABLE:
        return ""
    text = f"Largest residual at the {first.group}: {first.rms:.2g} standard deviations of a healthy rig"
    leading = outcome.suspects[0].title if outcome.suspects else ""
    return f"{text}; most probable cause: {leading}." if leading else f"{text}."


def certainty(outcome: Outcome) -> str:
    """Why the verdict is proven or only indicative."""
    diagnosis = outcome.result.diagnosis
    if diagnosis.strength == "proven" and diagnosis.gap is not None:
        return (
            "Proven: the noise is known from repeats, and with the named effects in the model, run in full, the gap "
            f"{gap_in_words(diagnosis.gap)}."
        )
    missing = []
    if outcome.verdict == "alias_group":
        missing.append("an alias group identifies no single effect")
    elif outcome.verdict == "suspected":
        missing.append("the effect is suspected, not named, and the case was not run with it in full")
    elif not diagnosis.found:
        missing.append("no effect is named")
    elif diagnosis.proof.rerun is None:
        missing.append("the case with the named effects was not run in full")
    if diagnosis.unconfirmed:
        missing.append(f"it could not be confirmed: {diagnosis.unconfirmed}")
    if not outcome.result.problem.repeated:
        missing.append("most numbers have a single reading, so the declared noise is used")
    if not diagnosis.held_out_points:
        missing.append(f"no operating point was held out (that takes at least {LEAST_POINTS})")
    return f"Indicative: {', and '.join(missing)}."


def steps(outcome: Outcome) -> tuple[NextStep, ...]:
    """What to measure or do next: computed proposals first, then what the rules of the workflow say."""
    together = () if outcome.ahead.together is None else outcome.ahead.together.titles
    computed = [
        NextStep(
            text=proposal.title, why=_why(outcome, proposal), expected_evidence=proposal.expected_evidence,
            cost=proposal.cost, decides=proposal.decides,
        )
        for proposal in outcome.ahead.ranked
        if proposal.expected_evidence >= WORTH and (proposal.title,) != together
    ][:MOST_PROPOSED]  # fmt: skip
    nothing = [] if computed or together or not outcome.ahead.ranked else [_none_separates(outcome)]
    return (
        *_baseline(outcome),
        *_first(outcome),
        *_together(outcome),
        *computed,
        *nothing,
        *_better_data(outcome),
    )


def _none_separates(outcome: Outcome) -> NextStep:
    """That the measurements this rig offers would not help."""
    count = len(outcome.ahead.ranked)
    return NextStep(
        text="inspect the rig, or run points at which the residual is larger",
        why=f"none of {count} further sensors and points considered separates the leading explanations at this size",
    )


def _together(outcome: Outcome) -> list[NextStep]:
    """The cheapest measurements that decide, with what simulating them gave."""
    together = outcome.ahead.together
    if together is None:
        return []
    why = f"the cheapest set that {_decides(outcome)}"
    return [
        NextStep(
            text=" and ".join(together.titles),
            why=why,
            expected_evidence=together.expected_evidence,
            cost=together.cost,
            decides=True,
        )
    ]


def _decides(outcome: Outcome) -> str:
    """What the cheapest set tells apart, or what simulating it ended in."""
    if outcome.ahead.causes:
        return f"tells apart {_causes(outcome)}"
    named = [outcome.names.title(name) for name, right in outcome.ahead.verified if right]
    count = len(outcome.ahead.verified)
    names = "names" if outcome.verdict != "unknown_located" else "names or locates"
    if count == 1:
        shown = f"{names} it" if named else "does not name it yet"
        return f"tells the suspect from a healthy rig; in a simulation with it true the diagnosis {shown}"
    which = f" ({'; '.join(named)})" if named else ""
    shown = f"{names} it every time" if len(named) == count else f"{names} {len(named)} of {count}{which}"
    return f"decides; in a simulation with each of them true the diagnosis {shown}"


def _baseline(outcome: Outcome) -> list[NextStep]:
    """Without any healthy set of the rig: measure one, before anything else."""
    result = outcome.result
    if result.baseline is not None or result.calibration.origin.kind == "file":
        return []
    return [
        NextStep(
            text="measure a healthy baseline first: the same points in a state known to be healthy, given as baseline; "
            "two to four such sets calibrate the rig (rigdesign calibrate)",
            why="errors of the model cancel in the difference of two sets; without one, intervals are wide",
        )
    ]


def _why(outcome: Outcome, proposal: Ranked) -> str:
    """What a proposal is good for."""
    if outcome.ahead.causes:
        return f"{'tells' if proposal.decides else 'partly tells'} apart {_causes(outcome)}"
    apart = (
        "the leading explanation from a healthy rig"
        if outcome.verdict == "data_insufficient" or outcome.suspected is not None
        else "the leading explanations"
    )
    return f"separates {apart}" if proposal.decides else f"partly separates {apart}"


def _causes(outcome: Outcome) -> str:
    """The causes that are distinguished where the data are too few."""
    titles = [outcome.names.title(name) for name in outcome.ahead.causes]
    return f"{' and '.join(titles)}, each at the size that it would need"


def _first(outcome: Outcome) -> list[NextStep]:
    """What follows from the verdict itself."""
    corrections = [
        NextStep(text=correction.text, why="then diagnose again") for correction in outcome.corrections
    ]
    match outcome.verdict:
        case "alias_group":
            if outcome.picked is None:
                return [
                    NextStep(
                        text="inspect the rig for other signs of one member of the group, or choose one with --name",
                        why="these data fit all of them equally well",
                    )
                ]
        case "suspected":
            if outcome.suspected is not None and outcome.picked is None:
                offered = ", and try the case offered in suspected/" if outcome.offered is not None else ""
                check = (
                    "inspect the rig for" if isinstance(outcome.suspected.entry, Effect) else "check for an"
                )
                text = f"{check} {outcome.suspected.title}{offered}"
                return [NextStep(text=text, why="the data point at it and do not prove it")]
        case "unknown_located":
            if places := _places(outcome):
                text = f"inspect the rig for {places}"
                return [
                    NextStep(text=text, why="the data locate it, and no effect of the catalogue explains it")
                ]
            place = outcome.before[0].group if outcome.before else "the rig"
            return [NextStep(text=f"look at {place}", why="the residual is largest there")]
    return corrections


def _better_data(outcome: Outcome) -> list[NextStep]:
    result, diagnosis = outcome.result, outcome.result.diagnosis
    running = len(result.data.settings)
    steps = []
    if running < LEAST_RUNNING_POINTS:
        steps.append(
            NextStep(
                text="measure 9 to 15 operating points that mix low and high speed, torque, oil temperature and flow",
                why=f"{running} operating point{'s' if running != 1 else ''} cannot separate effects",
            )
        )
    elif not diagnosis.held_out_points:
        steps.append(
            NextStep(
                text=f"measure at least {LEAST_POINTS} operating points: corners of speed, torque and oil temperature",
                why="some can then be held out to verify a named effect",
            )
        )
    if not result.problem.repeated:
        steps.append(
            NextStep(text="repeat every operating point", why="the noise is then measured, not declared")
        )
    if result.baseline is None and result.calibration.origin.kind == "file" and outcome.verdict != "named":
        steps.append(
            NextStep(
                text="measure the same points in a state known to be healthy and give that set as baseline",
                why="errors of the model cancel in the difference, so that smaller effects are seen",
            )
        )
    return steps


def _titles(outcome: Outcome) -> str:
    return "; ".join(suspect.title for suspect in outcome.suspects)
