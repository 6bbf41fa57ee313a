"""What may be said of a set: its heat and what oscillates in it are looked at each by itself, then put together.

Heat hardly knows what the rig does at an order, and no temperature tells a tooth. An effect that either domain names is
named whatever the other one leaves, and two effects of different domains do not compete. Within a domain the numbers of
a model known well decide; orders of the meshes are asked where those name nothing. They overrule a name in one case:
where they show a changed power circuit, through which what healthy teeth excite looks like other teeth.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import zip_longest

from rigdesign.base.errors import RigdesignError
from rigdesign.diagnosis.decision.claims import Claim, Refusal, refusals
from rigdesign.diagnosis.decision.evaluate import Evaluation
from rigdesign.diagnosis.decision.kept_numbers import SURE, WORDS, Numbers
from rigdesign.diagnosis.decision.posterior import mass_of_any
from rigdesign.diagnosis.decision.problem import Tier
from rigdesign.diagnosis.decision.search import Look
from rigdesign.diagnosis.decision.suspicion import Suspicion, suspected
from rigdesign.diagnosis.decision.verdict import Decision

OPEN = frozenset({"unknown_located", "too_small"})
"""Verdicts that an effect may be suspected under."""


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
    """By the first tier that names something which the next one does not overrule; else what may be suspected.

    A suspect that leaves no more than the model may answer wrongly is held against the points held out like a name.
    """
    looks = []
    overruled: tuple[Refusal, ...] = ()
    for tier, further in zip_longest(tiers, tiers[1:]):
        look = numbers.look(tier)
        claimed = numbers.claim(look, look.first.decision, look.found)
        if claimed.decision.verdict in SURE:
            if further is None or not _overruled(numbers.look(further), claimed.decision.named):
                return Finding(looks=(look,), claimed=_after(overruled, claimed))
            given = numbers.fitted(look, claimed)
            overruled = refusals(given.found, given.fit, BY_CIRCUIT)
        looks.append((look, claimed))
    contradicted = any(claimed.contradicted for _, claimed in looks)
    for look, claimed in () if contradicted else looks:
        if claimed.decision.verdict not in OPEN:
            continue
        suspicion = suspected(look, numbers.proof(look.tier), numbers.traces(look), numbers.calibration)
        if suspicion is None or numbers.contradiction(look, [suspicion.evidence], suspicion.fit):
            continue
        if suspicion.accounts_for_all:
            held = numbers.claim(look, suspicion.as_named, [suspicion.evidence])
            if held.decision.verdict in SURE:
                return Finding(looks=(look,), claimed=_after(overruled, held))
        return Finding(looks=(look,), claimed=_after(overruled, claimed), suspicion=suspicion)
    look, claimed = looks[-1]
    return Finding(looks=(look,), claimed=_after(overruled, claimed))


def _after(overruled: tuple[Refusal, ...], claimed: Claim) -> Claim:
    return replace(claimed, refused=(*overruled, *claimed.refused))


BY_CIRCUIT = "the orders of the meshes show a change of the power circuit instead"


def _overruled(look: Look, named: Sequence[str]) -> bool:
    """Whether the orders of the meshes show a changed circuit, and what is named no longer."""
    circuit = look.criteria.circuit - set(named)
    masses = [mass_of_any(look.first.evidence, look.first.weights, parts) for parts in (circuit, named)]
    return masses[0] >= look.criteria.thresholds.named and masses[1] < NO_LONGER


NO_LONGER = 0.5
"""Posterior mass of names below which the orders of the meshes speak for something else."""


def _beside(sure: Finding, other: Finding) -> Finding:
    """A finding with names, and what the other domain says beyond a healthy rig."""
    if other.decision.verdict not in ("unknown_located", "suspected"):
        return sure
    where = WORDS["heat" if other.tier == "heat" else "rotation"]
    return _with_decision(sure, replace(sure.decision, elsewhere=f"in {where}: {other.decision.reason}"))


def _with_decision(finding: Finding, decision: Decision) -> Finding:
    return replace(finding, claimed=replace(finding.claimed, decision=decision))


def _together(numbers: Numbers, first: Finding, second: Finding) -> Finding:
    """Names of both domains; of two groups the smaller one, as a verdict has one, with the other one as well."""
    grouped = [one for one in (first, second) if one.decision.verdict == "alias_group"]
    leads, other = (second, first) if grouped == [second] else (first, second)
    if len(grouped) == 2:
        leads, other = sorted(grouped, key=lambda one: len(one.decision.named))
        return _with_decision(leads, replace(leads.decision, as_well=other.decision.named))
    further = tuple(name for name in other.decision.named if name not in leads.decision.named)
    if not further:
        return leads
    own, others = (numbers.fitted(one.look, one.claimed) for one in (leads, other))
    known = {one.hypothesis.parts[0] for one in own.found}
    others = others.only([one.hypothesis.parts[0] not in known for one in others.found])
    found, fit = (*others.found, *own.found), others.fit.with_other(own.fit)
    sizes = {one.hypothesis.name: size for one, size in zip(found, fit.coordinates, strict=True)}
    proof = numbers.proof("all")
    reason = f"{leads.decision.reason}; {other.decision.reason}"
    try:
        answer = proof.again(sizes)
    except RigdesignError:
        return _with_decision(leads, replace(leads.decision, as_well=further))
    decision = replace(leads.decision, reason=reason)
    if grouped:
        decision = replace(decision, apart=(*decision.apart, *further))
    else:
        decision = replace(decision, named=(*decision.named, *further))
    return Finding(
        looks=(*leads.looks, *other.looks),
        claimed=Claim(
            decision=decision,
            found=found,
            fit=fit,
            fits={member: others.fit.with_other(one) for member, one in own.fits.items()},
            answer=answer,
            gap=proof.gap(answer),
            refused=(*leads.claimed.refused, *other.claimed.refused),
        ),
    )
