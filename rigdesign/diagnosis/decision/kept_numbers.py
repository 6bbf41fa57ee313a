"""The numbers of a set that were kept, by tier: looked at, held against points held out, and what may be claimed."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from rigdesign.diagnosis.decision.claims import Claim, claim, withdrawn
from rigdesign.diagnosis.decision.defaults import Calibration
from rigdesign.diagnosis.decision.evaluate import Explanations
from rigdesign.diagnosis.decision.other_domain import OtherDomain
from rigdesign.diagnosis.decision.problem import Problem, Tier, of_tier
from rigdesign.diagnosis.decision.proof import Proof, Rerun
from rigdesign.diagnosis.decision.search import Look, explanations_of, fitted, search
from rigdesign.diagnosis.decision.suspicion import agreement_in
from rigdesign.diagnosis.decision.traces import Traces
from rigdesign.diagnosis.decision.verdict import Decision
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem
from rigdesign.diagnosis.statistics.covariance import Whitened
from rigdesign.diagnosis.statistics.detectability import SEEN, Detectability, aliases, detectabilities
from rigdesign.diagnosis.statistics.evidence import Evidence
from rigdesign.diagnosis.statistics.intervals import JointFit

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
        found = tuple(one for one, kept in zip(self.found, keep, strict=True) if kept)
        names = {one.hypothesis.name for one in found}
        fit = replace(
            self.fit,
            sizes=tuple(one for one in self.fit.sizes if one.effect in names),
            coordinates=tuple(one for one, kept in zip(self.fit.coordinates, keep, strict=True) if kept),
        )
        return replace(self, found=found, fit=fit)


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

    def claim(self, look: Look, decision: Decision, found: Sequence[Evidence]) -> Claim:
        """What of a decision with the explanations it found may be claimed.

        Where all that is named is too small to matter, it is a nuisance: a group that the evaluation with it in the
        model found holds.
        """
        fit = partial(fitted, look.space, calibration=self.calibration)
        traces, proof = self.traces(look), self.proof(look.tier)
        agreement = agreement_in(look, self.calibration)
        claimed = claim(decision, found, traces, proof, fit, look.criteria.thresholds, agreement)
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
        known = replace(known, physical=[one for one in known.physical if moving.isdisjoint(one.parts)])
        return OtherDomain.of(self._seen("heat")[1], self._explained(tier), known)

    def _seen(self, tier: Tier) -> tuple[ResidualProblem, Whitened]:
        """Numbers of a tier at the points that are not held out, and their space; made once."""
        if tier not in self._spaces:
            wanted = of_tier(self.residuals, tier)
            aside = np.array([one.setting in self.points for one in self.residuals.features], dtype=bool)
            rows = np.flatnonzero(wanted & ~aside).tolist()
            seen = self.residuals.rows(rows)
            self._spaces[tier] = seen, self.problem.cut(self.whole, seen, rows, self.calibration)
        return self._spaces[tier]


def _assemblies(residuals: ResidualProblem) -> list[tuple[tuple[str, int], ...]]:
    """(n,) teeth by which meshes were put on further at the point of each number."""
    found = {one.name: tuple(sorted(one.tooth_offset.items())) for one in residuals.library.settings}
    return [found.get(feature.setting, ()) for feature in residuals.features]
