"""The search over one selection of the numbers: evaluate, take what is named into the model, evaluate what is left."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from rigdesign.diagnosis.decision.cross_validation import Problem, Tier
from rigdesign.diagnosis.decision.decision import PRIOR, UNNAMED, Posterior, decide, gain_of, posterior
from rigdesign.diagnosis.decision.defaults import (
    Calibration,
    Candidates,
    Decision,
    Thresholds,
    WhitenedSquare,
)
from rigdesign.diagnosis.residual.healthy import EXACT, Contest, Signature, relative_speed
from rigdesign.diagnosis.residual.hypotheses import (
    ORDER_CAUSE,
    UNKNOWN,
    physical,
    sensor,
    unmodelled_causes,
    without_a_name,
)
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem
from rigdesign.diagnosis.statistics.columns import Array, Column, ModelError
from rigdesign.diagnosis.statistics.covariance import Whitened
from rigdesign.diagnosis.statistics.detectability import ALIAS, REACHES, SEEN, Detectability, detectabilities
from rigdesign.diagnosis.statistics.evidence import (
    JOIN,
    Evidence,
    Hypothesis,
    JointFit,
    evaluate_hypothesis,
    evaluate_pair,
    fit_together,
    support,
)
from rigdesign.diagnosis.statistics.resonance import CloseModes

# One evaluation of a residual: every explanation evaluated, the best of them joined in pairs, a verdict.

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
        local = sum(1 for hypothesis in self.unmodelled if hypothesis.family == "local")
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
        contest, [evaluate_hypothesis(space, hypothesis) for hypothesis in (*known, *explanations.unmodelled)]
    )
    singles = _without_copies(singles)
    against = [criteria.contradicted(explanation) for explanation in singles]
    contradicted = [explanation for explanation, spoken in zip(singles, against, strict=True) if spoken]
    singles = [explanation for explanation, spoken in zip(singles, against, strict=True) if not spoken]
    pairs = [
        explanation
        for explanation in _with_model_error(contest, _pairs(space, singles))
        if not criteria.contradicted(explanation)
    ]
    evidence = sorted((*singles, *pairs), key=lambda explanation: -explanation.log_bayes)
    weights = posterior(evidence, explanations.members, criteria.priors)
    candidates = Candidates(
        effects=frozenset(part for hypothesis in known for part in hypothesis.parts),
        detectable={row.effect: row.detectable <= row.bound for row in table},
        orders=criteria.orders,
        sensors=frozenset(part for hypothesis in explanations.sensor for part in hypothesis.parts),
        circuit=criteria.circuit,
        alike=_alike(singles, frozenset(part for hypothesis in known for part in hypothesis.parts)),
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
        more = [
            explanation.hypothesis
            for explanation in self.look.evidence
            if self.named < frozenset(explanation.hypothesis.parts)
        ]
        return sum(masses[hypothesis.name] for hypothesis in more), sum(
            masses[hypothesis.name] for hypothesis in more if part in hypothesis.parts
        )


def _undivided(decision: Decision, earlier: Earlier | None, thresholds: Thresholds) -> Decision:
    """The decision without a further name that the first evaluation left divided, where all names compete at once.

    With the sizes of the names left free, a later evaluation sees less of what separates the rivals.
    """
    if earlier is None or decision.verdict != "named":
        return decision
    kept = []
    for part in decision.named:
        whole, mass = earlier.rivals(part)
        if whole < 1.0 - thresholds.named or mass >= thresholds.named * whole:
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
    ordered = sorted(evidence, key=lambda explanation: -weights.masses[explanation.hypothesis.name])
    refused: dict[str, str] = {}
    for part in decision.named if decision.verdict == "named" else decision.named[:1]:
        best = next(explanation for explanation in ordered if part in explanation.hypothesis.parts)
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
    for explanation in evidence:
        if explanation.hypothesis.parts == (part,) and len(explanation.coordinates) == 1:
            (size,) = explanation.coordinates
            return any(end and abs(size - end) <= 1e-6 * abs(end) for (end,) in explanation.hypothesis.bounds)
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
    known = [
        explanation.answer
        for explanation in singles
        if explanation.hypothesis.family == "physical" and np.any(explanation.answer)
    ]
    if not known:
        return list(singles)
    directions = np.array([answer / np.linalg.norm(answer) for answer in known])

    def copied(explanation: Evidence) -> bool:
        length = float(np.linalg.norm(explanation.answer))
        return length > 0.0 and float((directions @ explanation.answer).max()) > COPY * length

    return [
        explanation
        for explanation in singles
        if explanation.hypothesis.family not in UNNAMED or not copied(explanation)
    ]


def _alike(singles: Sequence[Evidence], effects: frozenset[str]) -> dict[str, frozenset[str]]:
    """Effect -> others whose answer at their best fit is its own one again: correlated, and not much smaller."""
    best: dict[str, Evidence] = {}
    for explanation in sorted(singles, key=lambda single: -single.log_bayes):
        part = explanation.hypothesis.parts[0]
        if part in effects and np.any(explanation.answer):
            best.setdefault(part, explanation)
    if not best:
        return {}
    names = list(best)
    answers = np.array([explanation.answer for explanation in best.values()])
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
    ordered = sorted(singles, key=lambda explanation: -explanation.log_bayes)
    unnamed = [explanation for explanation in ordered if explanation.hypothesis.family in UNNAMED]
    leaders = [explanation for explanation in ordered if explanation.hypothesis.family not in UNNAMED][
        :LEADERS
    ]
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
    others = [
        explanation
        for explanation in singles
        if explanation.hypothesis.name != first.hypothesis.name and explanation.columns.shape[1]
    ]
    left = space.residual - first.answer
    columns = np.hstack([explanation.columns for explanation in others])
    if first.columns.shape[1]:
        basis, _ = np.linalg.qr(first.columns)
        columns = columns - basis @ (basis.T @ columns)
    explained = (columns.T @ left) ** 2 / np.maximum(np.einsum("nk,nk->k", columns, columns), 1e-300)
    ends = np.cumsum([explanation.columns.shape[1] for explanation in others])
    shares = np.add.reduceat(explained, np.concatenate([[0], ends[:-1]]))
    return [others[place] for place in np.argsort(-shares, kind="stable")[:PARTNERS]]


# Whether the numbers of the other domain speak against an explanation.
#
# Heat at an oil by which the orders of the meshes would be explained has to be there in the temperatures, and so has a
# bracing that drifts with the oil in the mean torques. The model may answer wrongly there, too, by a factor.

WIDE = 2.0
"""Factor by which an answer of the model may be too small or too large in the other domain."""


@dataclass(frozen=True, kw_only=True)
class OtherDomain:
    """Numbers of the other domain, and what every single explanation leaves in them.

    own, there : name of a single explanation -> its hypothesis in this domain and in the other one
    """

    space: Whitened = field(repr=False)
    own: Mapping[str, Hypothesis] = field(repr=False)
    there: Mapping[str, Hypothesis] = field(repr=False)

    @classmethod
    def of(cls, space: Whitened, own: Explanations, there: Explanations) -> "OtherDomain":
        """By the explanations of either domain; ``space``: of the other one."""
        return cls(
            space=space,
            own={hypothesis.name: hypothesis for hypothesis in own.single},
            there={hypothesis.name: hypothesis for hypothesis in there.single},
        )

    def seen_from(self, own: Explanations) -> "OtherDomain":
        """The same beside a space with some causes in the model, in which unmodelled ones have other lengths."""
        return replace(self, own={hypothesis.name: hypothesis for hypothesis in own.single})

    def contradicts(self, explanation: Evidence) -> bool:
        """Whether the residual there grows by more than what is seen, whatever the factor on the answer."""
        answer, residual = self._answer(explanation), self.space.residual
        square = float(answer @ answer)
        if square <= SEEN**2:
            return False
        exact = explanation.hypothesis.family in EXACT
        factor = 1.0 if exact else float(np.clip(answer @ residual / square, 1.0 / WIDE, WIDE))
        return factor**2 * square - 2.0 * factor * float(answer @ residual) > SEEN**2

    def _answer(self, explanation: Evidence) -> Array:
        """(n,) what an explanation, or a pair of them, leaves in the other domain at its size."""
        names = explanation.hypothesis.name.split(JOIN)
        sizes = (
            np.split(np.array(explanation.coordinates), [explanation.joined])
            if explanation.joined
            else [np.array(explanation.coordinates)]
        )
        answer = np.zeros(len(self.space.residual))
        for name, size in zip(names, sizes, strict=True):
            if name in self.there:
                answer += self.there[name].at(size * self.there[name].unit / self.own[name].unit)
        return answer


MOST_EFFECTS = 4
"""Effects that are looked for one after the other."""


@dataclass(frozen=True, kw_only=True)
class Look:
    """What a search evaluated and found.

    residuals, space : of the numbers it had; criteria : of every evaluation; evaluations : one after the other, the
    first with nothing named yet; found : the best explanation of every name
    """

    tier: Tier
    residuals: ResidualProblem = field(repr=False)
    space: Whitened = field(repr=False)
    explanations: Explanations = field(repr=False)
    criteria: Criteria = field(repr=False)
    evaluations: tuple[Evaluation, ...] = field(repr=False)
    found: tuple[Evidence, ...]

    @property
    def first(self) -> Evaluation:
        """The evaluation in which all causes compete at once."""
        return self.evaluations[0]


def search(
    problem: Problem,
    residuals: ResidualProblem,
    space: Whitened,
    explanations: Explanations,
    calibration: Calibration,
    tier: Tier,
    other: OtherDomain | None = None,
) -> Look:
    """Evaluate, take what is named into the model, evaluate what is left.

    explanations : of the numbers of the tier; other : numbers of the other domain, where they are read
    """
    signature = signature_of(problem, residuals, calibration)
    criteria = Criteria(
        thresholds=calibration.thresholds(problem.baseline is not None),
        points=[feature.setting for feature in residuals.features],
        orders=causes_of_orders(residuals, explanations, tier),
        unnamed=frozenset(effect.claim for effect in residuals.effects if effect.stands_for),
        one_oil=losses_of_oils(residuals, explanations),
        signature=signature,
    )
    evaluations = [evaluate(space, explanations, _beside(criteria, other, explanations))]
    named: list[Evidence] = []
    while evaluations[-1].decision.verdict == "named" and len(named) < MOST_EFFECTS:
        new = _best_of(evaluations[-1])
        if not new:
            break
        named += new
        after = _with_named(space, named, signature)
        claimed = {part for explanation in named for part in explanation.hypothesis.parts}
        rest = explanations_of(residuals, after)
        left = Explanations(
            physical=[hypothesis for hypothesis in rest.physical if claimed.isdisjoint(hypothesis.parts)],
            sensor=[hypothesis for hypothesis in rest.sensor if claimed.isdisjoint(hypothesis.parts)],
            unmodelled=rest.unmodelled,
        )
        earlier = Earlier(look=evaluations[0], named=frozenset(claimed))
        explained = max(explanation.gain for explanation in named)
        beside = _beside(criteria, other, rest)
        evaluations.append(evaluate(after, left, beside, explained=explained, earlier=earlier))
    return Look(
        tier=tier,
        residuals=residuals,
        space=space,
        explanations=explanations,
        criteria=criteria,
        evaluations=tuple(evaluations),
        found=tuple(named),
    )


def _beside(criteria: Criteria, other: OtherDomain | None, explanations: Explanations) -> Criteria:
    """The criteria with what the other domain says against explanations."""
    return (
        criteria
        if other is None
        else replace(criteria, contradicted=other.seen_from(explanations).contradicts)
    )


def causes_of_orders(residuals: ResidualProblem, explanations: Explanations, tier: Tier) -> frozenset[str]:
    """Parts of explanations whose evidence is of orders and natural frequencies: in a look at rotation all."""
    effects = {effect.claim for effect in residuals.effects if effect.family.dynamic}
    if tier == "heat":
        return frozenset(effects)
    others = (*explanations.sensor, *explanations.unmodelled)
    of_orders = {
        part
        for hypothesis in others
        for part in hypothesis.parts
        if tier != "all" or part.startswith(ORDER_CAUSE)
    }
    return frozenset(effects | of_orders)


def losses_of_oils(residuals: ResidualProblem, explanations: Explanations) -> dict[str, frozenset[str]]:
    """Unmodelled loss in an oil, whatever its law -> losses of the catalogue of which that oil takes most."""
    oils = {effect.heats for effect in residuals.effects if effect.heats}
    by_cause: dict[str, frozenset[str]] = {}
    for oil in oils:
        losses = frozenset(effect.claim for effect in residuals.effects if effect.heats == oil)
        start = f"{UNKNOWN}heat at oil:{oil} "
        by_cause |= {
            hypothesis.name: losses
            for hypothesis in explanations.unmodelled
            if hypothesis.name.startswith(start)
        }
    return by_cause


def explanations_of(residuals: ResidualProblem, space: Whitened, *, rivals: bool = True) -> Explanations:
    """All explanations; without the unmodelled ``rivals`` where only the catalogue is evaluated."""
    covariance = space.covariance
    return Explanations(
        physical=physical(
            covariance,
            residuals.features,
            residuals.effects,
            residuals.library.responses,
            residuals.teeth_a_turn,
        ),
        sensor=sensor(covariance, residuals.errors),
        unmodelled=without_a_name(covariance, unmodelled_causes(residuals.library, residuals.channels))
        if rivals
        else [],
    )


def signature_of(problem: Problem, residuals: ResidualProblem, calibration: Calibration) -> Signature:
    """An order is answered as badly as the model knows it: the frequencies near it, and of a mesh its own size.

    Without a baseline the residual of a healthy rig is as wide as that by itself.
    """
    placed = calibration.amplitudes.frequency * residuals.resonances.steepness
    share = np.hypot(placed, np.where(residuals.of_mesh, calibration.amplitudes.series_mesh_point, 0.0))
    model_error = ModelError.of(residuals.features, share, residuals.of_mesh, residuals.values)
    return Signature.of(
        residuals.features,
        relative_speed(residuals.features, residuals.library.settings),
        calibration.signature_error,
        None if problem.baseline is None else model_error,
        CloseModes.of(residuals.natural_frequencies, calibration.amplitudes.frequency),
        circuit=frozenset(effect.claim for effect in residuals.effects if effect.family.circuit),
    )


def _best_of(evaluation: Evaluation) -> list[Evidence]:
    """For every named effect its best explanation by itself."""
    best = []
    for name in evaluation.decision.named:
        alone = [
            explanation for explanation in evaluation.evidence if explanation.hypothesis.parts == (name,)
        ]
        if alone:
            best.append(alone[0])
    return best


def _with_named(space: Whitened, named: Sequence[Evidence], signature: Signature) -> Whitened:
    """The space with the named effects in the model, their sizes left free, and what it may answer wrongly to them."""
    lower = space.covariance.lower
    columns = [
        Column(
            name=f"named {explanation.hypothesis.name}/{number}",
            kind="named",
            values=lower @ slope,
            spread=explanation.hypothesis.widest,
        )
        for explanation in named
        for number, slope in enumerate(explanation.columns.T)
    ]
    precision = np.diagonal(space.precision)
    for explanation in named:
        columns += signature.columns(explanation.hypothesis, lower @ explanation.answer, precision)
    effects = [name for explanation in named for name in explanation.hypothesis.own]
    residual = lower @ (
        space.freed(effects)
        - sum((explanation.answer for explanation in named), np.zeros(len(space.residual)))
    )
    nonlinear_parts = {
        effect: lower @ part for effect, part in space.nonlinear_parts.items() if effect not in effects
    }
    return Whitened.of(space.covariance.with_extra(columns), residual, nonlinear_parts)


def fitted(space: Whitened, explanations: Sequence[Evidence], calibration: Calibration) -> JointFit:
    """The joint fit of some explanations in a space, with their intervals."""
    return fit_together(
        space,
        explanations,
        calibration.signature_error,
        [explanation.hypothesis.intervals for explanation in explanations],
    )
