"""One evaluation of a residual: every explanation evaluated, the best of them joined in pairs, a verdict."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from rigdesign.diagnosis.decision.decision import UNNAMED, decide
from rigdesign.diagnosis.decision.posterior import PRIOR, Posterior, gain_of, posterior
from rigdesign.diagnosis.decision.verdict import Candidates, Decision, Thresholds, WhitenedSquare
from rigdesign.diagnosis.residual.signature import Contest, Signature
from rigdesign.diagnosis.statistics.covariance import Whitened
from rigdesign.diagnosis.statistics.detectability import ALIAS, REACHES, Detectability, detectabilities
from rigdesign.diagnosis.statistics.evidence import Evidence, evaluate_hypothesis, evaluate_pair
from rigdesign.diagnosis.statistics.hypothesis import Hypothesis
from rigdesign.diagnosis.statistics.support import support

LEADERS = 12
"""Explanations of the catalogue that are joined with every other one."""

UNNAMED_LEADERS = 4
"""Unmodelled causes that are."""

COPY = 0.99
"""Cosine of two answers above which they are one explanation: what bears a name keeps it."""


@dataclass(frozen=True, kw_only=True)
class Explanations:
    """All hypotheses of a comparison, by family."""

    physical: Sequence[Hypothesis]
    sensor: Sequence[Hypothesis]
    unmodelled: Sequence[Hypothesis]

    @property
    def single(self) -> tuple[Hypothesis, ...]:
        """All of them."""
        return (*self.physical, *self.sensor, *self.unmodelled)

    @property
    def members(self) -> dict[str, int]:
        """Number of explanations by family; a pair joins any two."""
        known, unnamed = len(self.physical) + len(self.sensor), len(self.unmodelled)
        local = sum(1 for one in self.unmodelled if one.family == "local")
        return {
            "physical": len(self.physical),
            "sensor": len(self.sensor),
            "unmodelled": unnamed - local,
            "local": local,
            "pair": (known + unnamed) * (known + unnamed - 1) // 2,
        }


@dataclass(frozen=True, kw_only=True)
class Evaluation:
    """What was found.

    evidence : of every hypothesis, best first; detectability : by effect, known before any name
    """

    evidence: tuple[Evidence, ...]
    contradicted: tuple[Evidence, ...]
    """Single explanations that the other domain contradicts, not in the evidence."""
    weights: Posterior
    decision: Decision
    detectability: tuple[Detectability, ...]
    chi_square: float
    count: int


@dataclass(frozen=True, kw_only=True)
class Criteria:
    """What every evaluation of one set of data has in common.

    points : (n,) operating point of each number; left out, a name may depend on one
    orders : causes that show in orders and natural frequencies
    unnamed : effects that are suspected at most
    one_oil : as of `Candidates`
    contradicted : whether numbers of the other domain speak against an explanation
    signature : how wrong the model may answer to a right cause; left out, not at all
    """

    thresholds: Thresholds
    priors: Mapping[str, float] = field(default_factory=lambda: dict(PRIOR))
    points: Sequence[str] = ()
    orders: frozenset[str] = frozenset()
    unnamed: frozenset[str] = frozenset()
    one_oil: Mapping[str, frozenset[str]] = field(default_factory=dict)
    signature: Signature | None = None
    contradicted: Callable[[Evidence], bool] = lambda one: False

    @property
    def circuit(self) -> frozenset[str]:
        """Effects that change what goes through the power circuit."""
        return frozenset() if self.signature is None else self.signature.circuit


def evaluate(
    space: Whitened,
    explanations: Explanations,
    criteria: Criteria,
    *,
    explained: float = 0.0,
    earlier: "Earlier | None" = None,
) -> Evaluation:
    """Evaluate every hypothesis and decide.

    explained : largest fall of the whitened square by what was named before
    earlier : the evaluation that named it
    """
    known = (*explanations.physical, *explanations.sensor)
    table = detectabilities(space, known, explanations.unmodelled)
    contest = None if criteria.signature is None else Contest(space, criteria.signature)
    singles = _with_model_error(
        contest, [evaluate_hypothesis(space, one) for one in (*known, *explanations.unmodelled)]
    )
    singles = _without_copies(singles)
    against = [criteria.contradicted(one) for one in singles]
    contradicted = [one for one, spoken in zip(singles, against, strict=True) if spoken]
    singles = [one for one, spoken in zip(singles, against, strict=True) if not spoken]
    pairs = [
        one for one in _with_model_error(contest, _pairs(space, singles)) if not criteria.contradicted(one)
    ]
    evidence = sorted((*singles, *pairs), key=lambda one: -one.log_bayes)
    weights = posterior(evidence, explanations.members, criteria.priors)
    candidates = Candidates(
        effects=frozenset(part for one in known for part in one.parts),
        detectable={row.effect: row.detectable <= row.bound for row in table},
        orders=criteria.orders,
        sensors=frozenset(part for one in explanations.sensor for part in one.parts),
        circuit=criteria.circuit,
        alike=_alike(singles, frozenset(part for one in known for part in one.parts)),
        one_oil=criteria.one_oil,
        passed_over=criteria.unnamed,
    )
    square = WhitenedSquare(value=space.chi_square, count=len(space.residual))
    decision = decide(evidence, weights, square, candidates, criteria.thresholds)
    refused = _unsupported(space, decision, evidence, weights, criteria, explained)
    if refused and (decision.verdict == "alias_group" or not set(decision.named) - set(refused)):
        others = replace(candidates, passed_over=criteria.unnamed.union(refused))
        group = decide(evidence, weights, square, others, criteria.thresholds)
        if group.verdict == "alias_group":
            decision = group
            refused = _unsupported(space, decision, evidence, weights, criteria, explained)
    decision = _without(decision, refused)
    return Evaluation(
        evidence=tuple(evidence),
        contradicted=tuple(contradicted),
        weights=weights,
        decision=_undivided(decision, earlier, criteria.thresholds),
        detectability=tuple(table),
        chi_square=space.chi_square,
        count=len(space.residual),
    )


@dataclass(frozen=True, kw_only=True)
class Earlier:
    """The first evaluation, and what was named since."""

    look: Evaluation
    named: frozenset[str]

    def rivals(self, part: str) -> tuple[float, float]:
        """Posterior mass of what added anything at all to the names, and of that part of it that added ``part``."""
        masses = self.look.weights.masses
        more = [one.hypothesis for one in self.look.evidence if self.named < frozenset(one.hypothesis.parts)]
        return sum(masses[one.name] for one in more), sum(
            masses[one.name] for one in more if part in one.parts
        )


def _undivided(decision: Decision, earlier: Earlier | None, thresholds: Thresholds) -> Decision:
    """The decision without a further name that the first evaluation left divided, where all names compete at once.

    With the sizes of the names left free, a later evaluation sees less of what separates the rivals.
    """
    if earlier is None or decision.verdict != "named":
        return decision
    kept = []
    for part in decision.named:
        whole, own = earlier.rivals(part)
        if whole < 1.0 - thresholds.named or own >= thresholds.named * whole:
            kept.append(part)
    if kept:
        return replace(decision, named=tuple(kept))
    reason = f"{decision.named[0]} or another one explains the remaining residual, all named effects evaluated at once"
    return Decision(verdict="too_small", named=(), reason=reason)


def _unsupported(
    space: Whitened,
    decision: Decision,
    evidence: Sequence[Evidence],
    weights: Posterior,
    criteria: Criteria,
    explained: float,
) -> dict[str, str]:
    """Names that depend on one operating point or add too little to the others, with the reason.

    Of an alias group its leader is checked.
    """
    if not criteria.points or decision.verdict not in ("named", "alias_group"):
        return {}
    thresholds = criteria.thresholds
    ordered = sorted(evidence, key=lambda one: -weights.masses[one.hypothesis.name])
    refused: dict[str, str] = {}
    for part in decision.named if decision.verdict == "named" else decision.named[:1]:
        best = next(one for one in ordered if part in one.hypothesis.parts)
        least, where = support(space, criteria.points, best, part)
        whole = max(explained, best.gain)
        if least < thresholds.support:
            alone = f"operating point {where}" if where else "chance"
            refused[part] = f"the evidence for {part} comes from {alone} alone"
        elif least < thresholds.share * whole or (
            part in criteria.orders
            and _added(best, part, evidence, thresholds.share) < thresholds.share_loop * whole
        ):
            refused[part] = f"{part} explains too little in addition to the effects named before"
        elif explained and _at_its_end(part, evidence):  # rather what the model answers wrongly to those
            refused[part] = f"{part} fits best at the end of its range, beside the effects named before"
    return refused


def _at_its_end(part: str, evidence: Sequence[Evidence]) -> bool:
    """Whether an effect of one size fits best where its range ends; zero, where an effect begins, is no end."""
    for one in evidence:
        if one.hypothesis.parts == (part,) and len(one.coordinates) == 1:
            (size,) = one.coordinates
            return any(end and abs(size - end) <= 1e-6 * abs(end) for (end,) in one.hypothesis.bounds)
    return False


def _without(decision: Decision, refused: Mapping[str, str]) -> Decision:
    """The decision without some of its names; of an alias group with a refused leader nothing is left."""
    kept = tuple(part for part in decision.named if part not in refused)
    if not refused or (decision.verdict == "named" and kept):
        return replace(decision, named=kept)
    return Decision(verdict="too_small", named=(), reason=next(iter(refused.values())))


def _added(best: Evidence, part: str, evidence: Sequence[Evidence], least: float) -> float:
    """Fall of the whitened square that a part adds to the rest of an explanation.

    A rest that adds less than the share ``least`` to the part is none: the part explains what both do.
    """
    rest = [other for other in best.hypothesis.parts if other != part]
    if best.gain - gain_of([part], evidence) < least * best.gain:
        return best.gain
    return best.gain - gain_of(rest, evidence)


def _with_model_error(contest: Contest | None, evidence: list[Evidence]) -> list[Evidence]:
    return evidence if contest is None else contest.evaluated(evidence)


def _without_copies(singles: Sequence[Evidence]) -> list[Evidence]:
    """Explanations less the unmodelled causes that answer as one of the catalogue does.

    An error of a sensor has no claim to what is heat just as well: it keeps its unmodelled rivals.
    """
    known = [one.answer for one in singles if one.hypothesis.family == "physical" and np.any(one.answer)]
    if not known:
        return list(singles)
    directions = np.array([answer / np.linalg.norm(answer) for answer in known])

    def copied(one: Evidence) -> bool:
        length = float(np.linalg.norm(one.answer))
        return length > 0.0 and float((directions @ one.answer).max()) > COPY * length

    return [one for one in singles if one.hypothesis.family not in UNNAMED or not copied(one)]


def _alike(singles: Sequence[Evidence], effects: frozenset[str]) -> dict[str, frozenset[str]]:
    """Effect -> others whose answer at their best fit is its own one again: correlated, and not much smaller."""
    best: dict[str, Evidence] = {}
    for one in sorted(singles, key=lambda single: -single.log_bayes):
        part = one.hypothesis.parts[0]
        if part in effects and np.any(one.answer):
            best.setdefault(part, one)
    if not best:
        return {}
    names = list(best)
    answers = np.array([one.answer for one in best.values()])
    products = answers @ answers.T
    squares = np.diagonal(products)
    same = products > ALIAS * np.sqrt(np.outer(squares, squares))
    reaching = products >= REACHES * squares[:, None]
    return {
        name: frozenset(names[other] for other in np.flatnonzero(row) if other != place)
        for place, (name, row) in enumerate(zip(names, same & reaching, strict=True))
    }


def _pairs(space: Whitened, singles: Sequence[Evidence]) -> list[Evidence]:
    """The leading explanations joined with everything else, those without a name among them."""
    ordered = sorted(singles, key=lambda one: -one.log_bayes)
    unnamed = [one for one in ordered if one.hypothesis.family in UNNAMED]
    leaders = [one for one in ordered if one.hypothesis.family not in UNNAMED][:LEADERS]
    leaders += unnamed[:UNNAMED_LEADERS]
    done: set[frozenset[str]] = set()
    pairs = []
    for first in leaders:
        partners = _promising(space, first, singles)
        for second in partners:
            key = frozenset((first.hypothesis.name, second.hypothesis.name))
            if len(key) == 2 and key not in done:
                done.add(key)
                pairs.append(evaluate_pair(space, first, second))
    return pairs


PARTNERS = 24
"""Partners of a leader that explain most of what it leaves."""


def _promising(space: Whitened, first: Evidence, singles: Sequence[Evidence]) -> list[Evidence]:
    """Those whose columns, less what the leader spans, hold most of what it leaves."""
    others = [one for one in singles if one.hypothesis.name != first.hypothesis.name and one.columns.shape[1]]
    left = space.residual - first.answer
    columns = np.hstack([one.columns for one in others])
    if first.columns.shape[1]:
        own, _ = np.linalg.qr(first.columns)
        columns = columns - own @ (own.T @ columns)
    explained = (columns.T @ left) ** 2 / np.maximum(np.einsum("nk,nk->k", columns, columns), 1e-300)
    ends = np.cumsum([one.columns.shape[1] for one in others])
    shares = np.add.reduceat(explained, np.concatenate([[0], ends[:-1]]))
    return [others[place] for place in np.argsort(-shares, kind="stable")[:PARTNERS]]
