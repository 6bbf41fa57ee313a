"""The numbers of a set that were kept, by tier: looked at, held against points held out, and what may be claimed."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from rigdesign.diagnosis.decision.claims import Agreement, Claim, Traces, claim, too_little, withdrawn
from rigdesign.diagnosis.decision.cross_validation import Problem, Proof, Rerun, Tier, of_tier
from rigdesign.diagnosis.decision.decision import UNNAMED, mass_of_any
from rigdesign.diagnosis.decision.defaults import Calibration, Decision
from rigdesign.diagnosis.decision.search import (
    Explanations,
    Look,
    OtherDomain,
    explanations_of,
    fitted,
    search,
)
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.covariance import Whitened
from rigdesign.diagnosis.statistics.detectability import SEEN, Detectability, aliases, detectabilities
from rigdesign.diagnosis.statistics.evidence import Evidence, JointFit, release_of
from rigdesign.diagnosis.statistics.heldout import Gap

SURE = frozenset({"named", "alias_group"})
"""Verdicts that give names."""

WORDS: Mapping[Tier, str] = {
    "heat": "temperatures, powers and mean torques",
    "rotation": "orders and the rig at rest",
}
"""Domain -> its numbers, in words."""


@dataclass(frozen=True, kw_only=True)
class Fitted:
    """Names of a claim with their fit; of a group its leader, and ``fits`` of every member."""

    found: tuple[Evidence, ...]
    fit: JointFit
    fits: Mapping[str, JointFit]

    def only(self, keep: Sequence[bool]) -> "Fitted":
        """Some of the names."""
        explanations = tuple(evidence for evidence, kept in zip(self.found, keep, strict=True) if kept)
        names = {evidence.hypothesis.name for evidence in explanations}
        fit = replace(
            self.fit,
            sizes=tuple(size for size in self.fit.sizes if size.effect in names),
            coordinates=tuple(size for size, kept in zip(self.fit.coordinates, keep, strict=True) if kept),
        )
        return replace(self, found=explanations, fit=fit)


@dataclass(frozen=True, kw_only=True)
class Numbers:
    """The numbers of a set that were kept, and what is done with all of them or with those of a tier.

    residuals, whole : of the kept numbers; points : held out
    """

    problem: Problem
    residuals: ResidualProblem
    whole: Whitened
    points: tuple[str, ...]
    calibration: Calibration
    rerun: Rerun | None
    _looks: dict[Tier, Look] = field(default_factory=dict, repr=False)
    _proofs: dict[Tier, Proof] = field(default_factory=dict, repr=False)
    _spaces: dict[Tier, tuple[ResidualProblem, Whitened]] = field(default_factory=dict, repr=False)
    _explanations: dict[Tier, Explanations] = field(default_factory=dict, repr=False)

    def look(self, tier: Tier) -> Look:
        """The search over the numbers of a tier at the points that are not held out; made once."""
        if tier not in self._looks:
            self._looks[tier] = search(
                self.problem,
                *self._seen(tier),
                self._explained(tier),
                self.calibration,
                tier,
                self._heat_beside(tier),
            )
        return self._looks[tier]

    def proof(self, tier: Tier) -> Proof:
        """What names of a tier are held against; made once."""
        if tier not in self._proofs:
            self._proofs[tier] = Proof(
                residuals=self.residuals, whole=self.whole, points=self.points, tier=tier, rerun=self.rerun
            )
        return self._proofs[tier]

    def claim(self, look: Look, decision: Decision, explanations: Sequence[Evidence]) -> Claim:
        """What of a decision with the explanations it found may be claimed.

        Where all that is named is too small to matter, it is a nuisance: a group that the evaluation with it in the
        model found holds.
        """
        fit = partial(fitted, look.space, calibration=self.calibration)
        traces, proof = self.traces(look), self.proof(look.tier)
        agreement = agreement_in(look, self.calibration)
        claimed = claim(decision, explanations, traces, proof, fit, look.criteria.thresholds, agreement)
        last = look.evaluations[-1].decision
        if last.verdict == "alias_group" and not claimed.found and claimed.insignificant:
            group = claim(last, (), traces, proof, fit, look.criteria.thresholds, agreement)
            claimed = replace(group, refused=claimed.refused)
        if claimed.decision.verdict in SURE:
            named = self.fitted(look, claimed)
            if text := self.contradiction(look, named.found, named.fit):
                return withdrawn(claimed, proof, text)
        return claimed

    def fitted(self, look: Look, claimed: Claim) -> "Fitted":
        """What a claim names with its sizes."""
        if claimed.fit is not None:
            return Fitted(found=claimed.found, fit=claimed.fit, fits=claimed.fits)
        traces = self.traces(look)
        members = {name: traces.of(name) for name in claimed.decision.named}
        fits = {name: fitted(look.space, [member], self.calibration) for name, member in members.items()}
        leader = claimed.decision.named[0]
        return Fitted(found=(members[leader],), fit=fits[leader], fits=fits)

    def contradiction(self, look: Look, explanations: Sequence[Evidence], fit: JointFit) -> str:
        """What the other domain says against an error of a sensor that a look gives, in words; empty for nothing.

        A wrong scale of a torque cell shows in its mean as well as in its orders. What else shows in both is known less
        exactly in one of them.
        """
        other: Tier = "rotation" if look.tier == "heat" else "heat"
        errors = [
            (evidence.hypothesis.name, size)
            for evidence, size in zip(explanations, fit.coordinates, strict=True)
            if evidence.hypothesis.family == "sensor"
        ]
        if not errors or look.tier == "all" or not of_tier(self.residuals, other).any():
            return ""
        residuals, space = self._seen(other)
        place = {feature: row for row, feature in enumerate(self.residuals.features)}
        rows = [place[feature] for feature in residuals.features]
        for name, size in errors:
            rest = space.residual - space.covariance.whiten(self.proof("all").stored({name: size})[rows])
            if float(rest @ rest) - space.chi_square > SEEN**2:
                return f"{name} fits best, but not {WORDS[other]}"
        return ""

    def traces(self, look: Look) -> Traces:
        """What single effects leave in the numbers of a look."""
        first = look.first
        return Traces(
            space=look.space,
            explanations=first.evidence,
            contradicted=first.contradicted,
            assembly=_assemblies(look.residuals),
        )

    @property
    def domains(self) -> Iterator[tuple[Tier, ...]]:
        """Tiers of heat and of rotation, those that decide first; one domain where the other is not read."""
        heat, mesh = self.residuals.of_heat, self.residuals.of_mesh
        if heat.any():
            yield ("heat",)
        if not heat.all():
            decides, meshes = (~heat & ~mesh).any(), mesh.any()
            yield (*(("rotation",) if decides else ()), *(("rotation_and_meshes",) if meshes else ()))

    @property
    def detectability(self) -> tuple[Detectability, ...]:
        """Of every effect in all numbers."""
        all_of_them = self._explained("all")
        known = (*all_of_them.physical, *all_of_them.sensor)
        return tuple(detectabilities(self._seen("all")[1], known, all_of_them.unmodelled))

    @property
    def aliases(self) -> tuple[tuple[str, str, float], ...]:
        """Effects that leave one trace in all numbers."""
        return tuple(aliases(self._seen("all")[1], self._explained("all").physical))

    def _explained(self, tier: Tier) -> Explanations:
        """Explanations of the numbers of a tier; made once."""
        if tier not in self._explanations:
            self._explanations[tier] = explanations_of(*self._seen(tier))
        return self._explanations[tier]

    def _heat_beside(self, tier: Tier) -> OtherDomain | None:
        """The heat, where a tier looks at what oscillates; None where no heat is read, or it is in the tier.

        What stiffness, damping and tooth errors make of the losses goes by the square of mesh orders: no evidence. Nor
        is an order evidence against heat, as the model knows less well what the heat makes of it.
        """
        if tier in ("all", "heat") or not self.residuals.of_heat.any():
            return None
        known = self._explained("heat")
        moving = {effect.claim for effect in self.residuals.effects if effect.family.dynamic}
        known = replace(
            known,
            physical=[hypothesis for hypothesis in known.physical if moving.isdisjoint(hypothesis.parts)],
        )
        return OtherDomain.of(self._seen("heat")[1], self._explained(tier), known)

    def _seen(self, tier: Tier) -> tuple[ResidualProblem, Whitened]:
        """Numbers of a tier at the points that are not held out, and their space; made once."""
        if tier not in self._spaces:
            wanted = of_tier(self.residuals, tier)
            aside = np.array(
                [feature.setting in self.points for feature in self.residuals.features], dtype=bool
            )
            rows = np.flatnonzero(wanted & ~aside).tolist()
            seen = self.residuals.rows(rows)
            self._spaces[tier] = seen, self.problem.cut(self.whole, seen, rows, self.calibration)
        return self._spaces[tier]


def _assemblies(residuals: ResidualProblem) -> list[tuple[tuple[str, int], ...]]:
    """(n,) teeth by which meshes were put on further at the point of each number."""
    offsets = {
        setting.name: tuple(sorted(setting.tooth_offset.items())) for setting in residuals.library.settings
    }
    return [offsets.get(feature.setting, ()) for feature in residuals.features]


# An effect that is probable and not named: what speaks for it, and what has to hold before it is said.
#
# Between a name and silence: one effect of the catalogue, or one of a few that leave the same trace, is part of every
# probable explanation, but more is left than a healthy rig leaves, an unmodelled cause goes with it or leaves that
# trace as well, or the points held out do not prove it. It is suspected if
#
# - it explains most of what is explained: what it leaves is a small share of what it takes away. Another cause that
#   goes with it in the best explanation, named or not, is in the model meanwhile, if that one takes little of it away;
#   not with an error of a sensor, which would mend what something else leaves;
# - every channel and every operating point asks for the same size of it. What is one-sided, local or grows otherwise
#   over the speed is something else that the effect is fitted to: a leak on one side is no leak on both;
# - it shrinks the gap on the points held out, where these show it at all;
# - it is large enough to matter, and within its bounds.

REMAINDER = 0.3
"""Share of what an effect explains that it may leave in excess of a healthy rig."""

AGREEMENT = 0.01
"""Probability of sizes that differ as much between channels, or between points, below which they are of different
things."""

INCLUSION = 0.95
"""Posterior mass of all explanations that hold an effect, or what leaves its trace, from which on it is suspected."""

CATALOGUE = 0.4
"""Least part of it that the effects of the catalogue hold."""

LARGEST_GROUP = 4
"""Effects that leave one trace at most."""


@dataclass(frozen=True, kw_only=True)
class Suspicion:
    """The most probable effect of the catalogue with those that leave its trace.

    evidence : of the effect alone; companion : of the cause that goes with it, if there is one
    fit : of the effect, with the companion in the model; answer : (n,) what the effect adds to all kept numbers
    gain : fall of the whitened square by the effect, with the companion in the model; left : the square with both
    gap : with it on the points held out
    alike : effects and sensor errors that leave its trace, most alike first; unmodelled : causes that do
    """

    look: Look = field(repr=False)
    evidence: Evidence
    companion: Evidence | None
    fit: JointFit
    gain: float
    left: float
    answer: Array = field(repr=False)
    gap: Gap | None
    alike: tuple[str, ...]
    unmodelled: tuple[str, ...]

    @classmethod
    def of(cls, look: Look, proof: Proof, traces: Traces, calibration: Calibration) -> "Suspicion | None":
        """Of a look; None without any explanation from the catalogue."""
        inclusion = look.first.weights.inclusion
        known = {
            hypothesis.parts[0] for hypothesis in (*look.explanations.physical, *look.explanations.sensor)
        }
        alone = [candidate for candidate in look.first.evidence if len(candidate.hypothesis.parts) == 1]
        single = {candidate.hypothesis.parts[0]: candidate for candidate in reversed(alone)}
        names = [name for name in inclusion if name in known and name in single]
        if not names:
            return None
        evidence = single[max(names, key=lambda name: inclusion[name])]
        of_rig = evidence.hypothesis.family == "physical"
        companion = agreement_in(look, calibration).companion(evidence) if of_rig else None
        together = [evidence] if companion is None else [evidence, companion]
        both = fitted(look.space, together, calibration)
        explanation, size = evidence.hypothesis.name, both.coordinates[0]
        if not np.any(size):
            return None
        effects = [effect for evidence in together for effect in evidence.hypothesis.own]
        rest = look.space.freed(effects) - both.answer
        left = float(release_of(look.space, effects).product(rest, rest))
        before = look.space.chi_square - (0.0 if companion is None else companion.gain)
        answer = proof.stored({explanation: size})
        return cls(
            look=look,
            evidence=evidence,
            companion=companion,
            fit=replace(
                both,
                sizes=tuple(part for part in both.sizes if part.effect == explanation),
                coordinates=both.coordinates[:1],
            ),
            gain=before - left,
            left=left,
            answer=answer,
            gap=proof.gap(answer) if proof.points else None,
            alike=tuple(name for name, _ in traces.like(explanation, size)),
            unmodelled=tuple(name for name, _ in traces.like(explanation, size, UNNAMED)),
        )

    @property
    def group(self) -> tuple[str, ...]:
        """The effect and those that leave its trace, the most probable first."""
        inclusion = self.look.first.weights.inclusion
        suspect = self.evidence.hypothesis.parts[0]
        return (suspect, *sorted(self.alike, key=lambda name: -inclusion.get(name, 0.0)))

    def mass(self, *, unmodelled: bool) -> float:
        """Posterior mass of all explanations that hold one of the group, or an unmodelled cause of its trace."""
        members = {*self.group, *(self.unmodelled if unmodelled else ())}
        return mass_of_any(self.look.first.evidence, self.look.first.weights, members)

    @property
    def decision(self) -> Decision:
        """The verdict with its reason."""
        first, *others = self.group
        also = f"; {' and '.join(others)} would leave the same trace" if others else ""
        rest = f"{self.excess:.0%} of what it accounts for" if self.excess > 0.0 else "nothing"
        reason = f"{first} is the most probable effect; it leaves {rest} beyond a healthy rig"
        as_well = f"; so would {self.stands_for}" if self.stands_for else ""
        return Decision(verdict="suspected", named=self.group, reason=reason + also + as_well)

    @property
    def accounts_for_all(self) -> bool:
        """Whether it leaves a healthy rig, to the share that no answer of the model is more exact than."""
        thresholds = self.look.criteria.thresholds
        return (
            not self.stands_for
            and self.excess <= thresholds.share
            and self.mass(unmodelled=False) >= thresholds.named
        )

    @property
    def stands_for(self) -> str:
        """What outside the catalogue leaves its trace by its nature."""
        suspect = self.evidence.hypothesis.parts[0]
        return next(
            (effect.stands_for for effect in self.look.residuals.effects if effect.claim == suspect), ""
        )

    @property
    def as_named(self) -> Decision:
        """The name it is if it holds."""
        name = self.group[0]
        return Decision(
            verdict="named", named=(name,), reason=f"{name} is part of every probable explanation"
        )

    @property
    def excess(self) -> float:
        """What it leaves of the whitened square beyond a healthy rig, over what it explains."""
        return max(self.left - len(self.look.space.residual), 0.0) / max(self.gain, 1e-300)

    @property
    def at_bound(self) -> bool:
        """Whether the best size is the largest one the catalogue admits."""
        limits = self.evidence.hypothesis.intervals
        return any(
            limit != 0.0 and abs(size.coordinate - limit) <= 1e-6 * abs(limit)
            for size, ends in zip(self.fit.sizes, limits, strict=True)
            for limit in ends
        )


def agreement_in(look: Look, calibration: Calibration) -> Agreement:
    """What channels and operating points of a look agree on."""
    features, modes = look.residuals.features, look.residuals.natural_frequencies
    return Agreement(
        space=look.space,
        evidence=look.first.evidence,
        channels=[
            "natural frequencies" if mode else feature.channel
            for feature, mode in zip(features, modes, strict=True)
        ],
        points=[feature.setting for feature in features],
        errors=calibration.signature_error,
    )


def suspected(look: Look, proof: Proof, traces: Traces, calibration: Calibration) -> Suspicion | None:
    """The effect that every probable explanation of a look holds, if nothing speaks against it."""
    candidate = Suspicion.of(look, proof, traces, calibration)
    return None if candidate is None or objection(candidate, proof, calibration) else candidate


def objection(candidate: Suspicion, proof: Proof, calibration: Calibration) -> str:
    """What speaks against suspecting an effect; empty where nothing does."""
    evidence, look = candidate.evidence, candidate.look
    name, size = evidence.hypothesis.name, candidate.fit.coordinates[0]
    if candidate.gain <= SEEN**2:
        return "it is not seen"
    best, criteria = look.first.weights.best, look.criteria
    if best is None or not criteria.thresholds.exceeds_healthy(best, criteria.orders):
        return "healthy rigs have given as much evidence"
    if len(candidate.group) > LARGEST_GROUP:
        return "too many effects leave its trace"
    if candidate.mass(unmodelled=True) < INCLUSION or candidate.mass(unmodelled=False) < CATALOGUE:
        return "other explanations are as probable"
    if candidate.excess > REMAINDER:
        return f"it leaves {candidate.excess:.0%} of what it explains"
    if text := too_little(look.residuals.effects, name, size):
        return text
    if candidate.at_bound:
        return "its best size is the largest one that is physical"
    beside = [] if candidate.companion is None else [candidate.companion]
    if text := agreement_in(look, calibration).objection(evidence, beside, AGREEMENT):
        return text
    if candidate.gap is not None and not candidate.gap.closer and proof.seen(candidate.answer) > SEEN:
        return "it does not shrink the gap on the points held out"
    return ""
