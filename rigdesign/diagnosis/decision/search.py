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
            own={one.name: one for one in own.single},
            there={one.name: one for one in there.single},
        )

    def seen_from(self, own: Explanations) -> "OtherDomain":
        """The same beside a space with some causes in the model, in which unmodelled ones have other lengths."""
        return replace(self, own={one.name: one for one in own.single})

    def contradicts(self, one: Evidence) -> bool:
        """Whether the residual there grows by more than what is seen, whatever the factor on the answer."""
        answer, residual = self._answer(one), self.space.residual
        square = float(answer @ answer)
        if square <= SEEN**2:
            return False
        exact = one.hypothesis.family in EXACT
        factor = 1.0 if exact else float(np.clip(answer @ residual / square, 1.0 / WIDE, WIDE))
        return factor**2 * square - 2.0 * factor * float(answer @ residual) > SEEN**2

    def _answer(self, one: Evidence) -> Array:
        """(n,) what an explanation, or a pair of them, leaves in the other domain at its size."""
        names = one.hypothesis.name.split(JOIN)
        sizes = (
            np.split(np.array(one.coordinates), [one.joined]) if one.joined else [np.array(one.coordinates)]
        )
        found = np.zeros(len(self.space.residual))
        for name, size in zip(names, sizes, strict=True):
            if name in self.there:
                found += self.there[name].at(size * self.there[name].unit / self.own[name].unit)
        return found


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
    found: list[Evidence] = []
    while evaluations[-1].decision.verdict == "named" and len(found) < MOST_EFFECTS:
        new = _best_of(evaluations[-1])
        if not new:
            break
        found += new
        after = _with_named(space, found, signature)
        claimed = {part for one in found for part in one.hypothesis.parts}
        rest = explanations_of(residuals, after)
        left = Explanations(
            physical=[one for one in rest.physical if claimed.isdisjoint(one.parts)],
            sensor=[one for one in rest.sensor if claimed.isdisjoint(one.parts)],
            unmodelled=rest.unmodelled,
        )
        earlier = Earlier(look=evaluations[0], named=frozenset(claimed))
        explained = max(one.gain for one in found)
        beside = _beside(criteria, other, rest)
        evaluations.append(evaluate(after, left, beside, explained=explained, earlier=earlier))
    return Look(
        tier=tier,
        residuals=residuals,
        space=space,
        explanations=explanations,
        criteria=criteria,
        evaluations=tuple(evaluations),
        found=tuple(found),
    )


def _beside(criteria: Criteria, other: OtherDomain | None, own: Explanations) -> Criteria:
    """The criteria with what the other domain says against explanations."""
    return criteria if other is None else replace(criteria, contradicted=other.seen_from(own).contradicts)


def causes_of_orders(residuals: ResidualProblem, explanations: Explanations, tier: Tier) -> frozenset[str]:
    """Parts of explanations whose evidence is of orders and natural frequencies: in a look at rotation all."""
    effects = {effect.claim for effect in residuals.effects if effect.family.dynamic}
    if tier == "heat":
        return frozenset(effects)
    others = (*explanations.sensor, *explanations.unmodelled)
    of_orders = {
        part for one in others for part in one.parts if tier != "all" or part.startswith(ORDER_CAUSE)
    }
    return frozenset(effects | of_orders)


def losses_of_oils(residuals: ResidualProblem, explanations: Explanations) -> dict[str, frozenset[str]]:
    """Unmodelled loss in an oil, whatever its law -> losses of the catalogue of which that oil takes most."""
    oils = {effect.heats for effect in residuals.effects if effect.heats}
    found: dict[str, frozenset[str]] = {}
    for oil in oils:
        losses = frozenset(effect.claim for effect in residuals.effects if effect.heats == oil)
        start = f"{UNKNOWN}heat at oil:{oil} "
        found |= {one.name: losses for one in explanations.unmodelled if one.name.startswith(start)}
    return found


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
    own = ModelError.of(residuals.features, share, residuals.of_mesh, residuals.values)
    return Signature.of(
        residuals.features,
        relative_speed(residuals.features, residuals.library.settings),
        calibration.signature_error,
        None if problem.baseline is None else own,
        CloseModes.of(residuals.natural_frequencies, calibration.amplitudes.frequency),
        circuit=frozenset(effect.claim for effect in residuals.effects if effect.family.circuit),
    )


def _best_of(evaluation: Evaluation) -> list[Evidence]:
    """For every named effect its best explanation by itself."""
    found = []
    for name in evaluation.decision.named:
        own = [one for one in evaluation.evidence if one.hypothesis.parts == (name,)]
        if own:
            found.append(own[0])
    return found


def _with_named(space: Whitened, found: Sequence[Evidence], signature: Signature) -> Whitened:
    """The space with the named effects in the model, their sizes left free, and what it may answer wrongly to them."""
    lower = space.covariance.lower
    columns = [
        Column(
            name=f"named {one.hypothesis.name}/{number}",
            kind="named",
            values=lower @ slope,
            spread=one.hypothesis.widest,
        )
        for one in found
        for number, slope in enumerate(one.columns.T)
    ]
    precision = np.diagonal(space.precision)
    for one in found:
        columns += signature.columns(one.hypothesis, lower @ one.answer, precision)
    owns = [own for one in found for own in one.hypothesis.own]
    residual = lower @ (space.freed(owns) - sum((one.answer for one in found), np.zeros(len(space.residual))))
    nonlinear_parts = {
        effect: lower @ part for effect, part in space.nonlinear_parts.items() if effect not in owns
    }
    return Whitened.of(space.covariance.with_extra(columns), residual, nonlinear_parts)


def fitted(space: Whitened, found: Sequence[Evidence], calibration: Calibration) -> JointFit:
    """The joint fit of some explanations in a space, with their intervals."""
    return fit_together(
        space, found, calibration.signature_error, [one.hypothesis.intervals for one in found]
    )
