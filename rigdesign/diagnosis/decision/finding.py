"""What may be said of a set: its heat and what oscillates in it are looked at each by itself, then put together.

Heat hardly knows what the rig does at an order, and no temperature tells a tooth. An effect that either domain names is
named whatever the other one leaves, and two effects of different domains do not compete. Within a domain the numbers of
a model known well decide; orders of the meshes are asked where those name nothing, and cannot veto.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial

import numpy as np

from rigdesign.base.errors import RigdesignError
from rigdesign.diagnosis.decision.claims import Claim, Traces, claim, withdrawn
from rigdesign.diagnosis.decision.decision import Decision
from rigdesign.diagnosis.decision.defaults import Calibration
from rigdesign.diagnosis.decision.evaluate import Evaluation, Explanations
from rigdesign.diagnosis.decision.problem import Problem, Tier, of_tier
from rigdesign.diagnosis.decision.proof import Proof, Rerun
from rigdesign.diagnosis.decision.search import Look, explanations_of, fitted, search
from rigdesign.diagnosis.decision.suspicion import Suspicion, agreement_in, suspected
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem
from rigdesign.diagnosis.statistics.covariance import Whitened
from rigdesign.diagnosis.statistics.detectability import SEEN, Detectability, aliases, detectabilities
from rigdesign.diagnosis.statistics.evidence import Evidence
from rigdesign.diagnosis.statistics.intervals import JointFit

SURE = frozenset({"named", "alias_group"})
"""Verdicts that give names."""

OPEN = frozenset({"unknown_located", "too_small"})
"""Verdicts that an effect may be suspected under."""

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
    _proofs: dict[Tier, Proof] = field(default_factory=dict, repr=False)

    def look(self, tier: Tier) -> Look:
        """The search over the numbers of a tier at the points that are not held out."""
        residuals, space = self._seen(tier)
        return search(self.problem, residuals, space, self.calibration, tier)

    def proof(self, tier: Tier) -> Proof:
        """What names of a tier are held against; made once."""
        if tier not in self._proofs:
            self._proofs[tier] = Proof(
                residuals=self.residuals, whole=self.whole, points=self.points, tier=tier, rerun=self.rerun
            )
        return self._proofs[tier]

    def claim(self, look: Look, decision: Decision, found: Sequence[Evidence]) -> Claim:
        """What of a decision with the explanations it found may be claimed.

        Where all that is named is too small to matter, it is a nuisance: a group that the evaluation with it in the
        model found holds.
        """
        fit = partial(fitted, look.space, calibration=self.calibration)
        thresholds = self.calibration.thresholds(self.has_baseline)
        traces, proof = self.traces(look), self.proof(look.tier)
        agreement = agreement_in(look, self.calibration)
        claimed = claim(decision, found, traces, proof, fit, thresholds, agreement)
        last = look.evaluations[-1].decision
        if last.verdict == "alias_group" and not claimed.found and claimed.insignificant:
            group = claim(last, (), traces, proof, fit, thresholds, agreement)
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
        fits = {name: fitted(look.space, [one], self.calibration) for name, one in members.items()}
        leader = claimed.decision.named[0]
        return Fitted(found=(members[leader],), fit=fits[leader], fits=fits)

    def contradiction(self, look: Look, found: Sequence[Evidence], fit: JointFit) -> str:
        """What the other domain says against an error of a sensor that a look gives, in words; empty for nothing.

        A wrong scale of a torque cell shows in its mean as well as in its orders. What else shows in both is known less
        exactly in one of them.
        """
        other: Tier = "rotation" if look.tier == "heat" else "heat"
        errors = [
            (one.hypothesis.name, size)
            for one, size in zip(found, fit.coordinates, strict=True)
            if one.hypothesis.family == "sensor"
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
        return Traces(
            space=look.space, explanations=look.first.evidence, assembly=_assemblies(look.residuals)
        )

    @property
    def has_baseline(self) -> bool:
        """Whether a healthy set of the rig is known."""
        return self.problem.baseline is not None

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
        known = (*self._explanations.physical, *self._explanations.sensor)
        return tuple(detectabilities(self._everything[1], known, self._explanations.unmodelled))

    @property
    def aliases(self) -> tuple[tuple[str, str, float], ...]:
        """Effects that leave one trace in all numbers."""
        return tuple(aliases(self._everything[1], self._explanations.physical))

    @cached_property
    def _everything(self) -> tuple[ResidualProblem, Whitened]:
        return self._seen("all")

    @cached_property
    def _explanations(self) -> Explanations:
        return explanations_of(self.problem, *self._everything, data=False)

    def _seen(self, tier: Tier) -> tuple[ResidualProblem, Whitened]:
        """Numbers of a tier at the points that are not held out, and their space."""
        wanted = of_tier(self.residuals, tier)
        aside = np.array([one.setting in self.points for one in self.residuals.features], dtype=bool)
        rows = np.flatnonzero(wanted & ~aside).tolist()
        seen = self.residuals.rows(rows)
        return seen, self.problem.cut(self.whole, seen, rows, self.calibration)


@dataclass(frozen=True, kw_only=True)
class Finding:
    """What numbers say.

    looks : of the domains it is from, that of the reported alternatives first
    """

    looks: tuple[Look, ...]
    claimed: Claim
    suspicion: Suspicion | None = None

    @property
    def look(self) -> Look:
        """The look whose alternatives are reported."""
        return self.looks[0]

    @property
    def tier(self) -> Tier:
        """Numbers that count on the points held out."""
        return self.look.tier if len(self.looks) == 1 else "all"

    @property
    def evaluations(self) -> tuple[Evaluation, ...]:
        """Of all looks, one after the other."""
        return tuple(one for look in self.looks for one in look.evaluations)

    @property
    def decision(self) -> Decision:
        """Of what is claimed, or suspected."""
        return self.claimed.decision if self.suspicion is None else self.suspicion.decision

    @property
    def sure(self) -> bool:
        """Whether it gives names."""
        return self.decision.verdict in SURE


def found_in(numbers: Numbers, given: Decision | None = None) -> Finding:
    """The finding of all numbers; ``given``: a verdict that no search changes."""
    if given is not None:
        look = numbers.look("all")
        return Finding(looks=(look,), claimed=numbers.claim(look, given, ()))
    findings = [_of_domain(numbers, tiers) for tiers in numbers.domains]
    if len(findings) == 1:
        return findings[0]
    sure = [one for one in findings if one.sure]
    if len(sure) == 2:
        return _together(numbers, *sure)
    if sure:
        (other,) = (one for one in findings if one is not sure[0])
        return _beside(sure[0], other)
    return max(findings, key=_severity)


def _severity(finding: Finding) -> int:
    """Of two domains that name nothing the verdict of the graver one holds for both."""
    match finding.decision.verdict:
        case "suspected":
            return 4
        case "unknown_located":
            return 3
        case "too_small":
            return 2
        case "data_insufficient":  # for a name that was found, else to see anything here
            return 2 if finding.claimed.refused else 0
        case _:
            return 1


def _of_domain(numbers: Numbers, tiers: Sequence[Tier]) -> Finding:
    """By the first tier that names something; else what may be suspected.

    A suspect that leaves no more than the model may answer wrongly is held against the points held out like a name.
    """
    looks = []
    for tier in tiers:
        look = numbers.look(tier)
        claimed = numbers.claim(look, look.first.decision, look.found)
        if claimed.decision.verdict in SURE:
            return Finding(looks=(look,), claimed=claimed)
        looks.append((look, claimed))
    contradicted = any(claimed.contradicted for _, claimed in looks)
    thresholds = numbers.calibration.thresholds(numbers.has_baseline)
    for look, claimed in () if contradicted else looks:
        if claimed.decision.verdict not in OPEN:
            continue
        suspicion = suspected(
            look, numbers.proof(look.tier), numbers.traces(look), numbers.calibration, numbers.has_baseline
        )
        if suspicion is None or numbers.contradiction(look, [suspicion.evidence], suspicion.fit):
            continue
        if suspicion.accounts_for_all(thresholds):
            held = numbers.claim(look, suspicion.as_named, [suspicion.evidence])
            if held.decision.verdict in SURE:
                return Finding(looks=(look,), claimed=held)
        return Finding(looks=(look,), claimed=claimed, suspicion=suspicion)
    look, claimed = looks[-1]
    return Finding(looks=(look,), claimed=claimed)


def _beside(sure: Finding, other: Finding) -> Finding:
    """A finding with names, and in its reason what the other domain says beyond a healthy rig."""
    if other.decision.verdict not in ("unknown_located", "suspected"):
        return sure
    where = WORDS["heat" if other.tier == "heat" else "rotation"]
    reason = f"{sure.claimed.decision.reason}; in {where}: {other.decision.reason}"
    decision = replace(sure.claimed.decision, reason=reason)
    return replace(sure, claimed=replace(sure.claimed, decision=decision))


def _together(numbers: Numbers, first: Finding, second: Finding) -> Finding:
    """Names of both domains; of two groups the smaller one, as a verdict has one."""
    grouped = [one for one in (first, second) if one.decision.verdict == "alias_group"]
    if len(grouped) == 2:
        leads, other = sorted(grouped, key=lambda one: len(one.decision.named))
        return replace(
            leads,
            claimed=replace(
                leads.claimed,
                decision=replace(
                    leads.decision,
                    as_well=other.decision.named,
                    reason=f"{leads.decision.reason}; one of {', '.join(other.decision.named)} as well",
                ),
            ),
        )
    leads, other = (second, first) if grouped == [second] else (first, second)
    decision = leads.decision
    if grouped:
        decision = replace(decision, apart=(*decision.apart, *other.decision.named))
    else:
        names = tuple(dict.fromkeys((*decision.named, *other.decision.named)))
        decision = replace(decision, named=names, reason=f"{decision.reason}; so is {other.decision.reason}")
    first_fit, others_fit = (numbers.fitted(one.look, one.claimed) for one in (leads, other))
    found = (*others_fit.found, *first_fit.found)
    fit = others_fit.fit.with_other(first_fit.fit)
    sizes = {one.hypothesis.name: size for one, size in zip(found, fit.coordinates, strict=True)}
    proof = numbers.proof("all")
    try:
        answer = proof.again(sizes)
    except RigdesignError:
        return _beside(leads, other)
    return Finding(
        looks=(*leads.looks, *other.looks),
        claimed=Claim(
            decision=decision,
            found=found,
            fit=fit,
            fits={member: others_fit.fit.with_other(one) for member, one in first_fit.fits.items()},
            answer=answer,
            gap=proof.gap(answer),
            refused=(*leads.claimed.refused, *other.claimed.refused),
        ),
    )


def _assemblies(residuals: ResidualProblem) -> list[tuple[tuple[str, int], ...]]:
    """(n,) teeth by which meshes were put on further at the point of each number."""
    found = {one.name: tuple(sorted(one.tooth_offset.items())) for one in residuals.library.settings}
    return [found.get(feature.setting, ()) for feature in residuals.features]
