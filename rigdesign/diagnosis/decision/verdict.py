"""What a verdict is, and what it depends on: thresholds, the effects that may be named, the whitened square."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from rigdesign.diagnosis.statistics.evidence import Evidence

Verdict = Literal[
    "named",
    "suspected",
    "alias_group",
    "unknown_located",
    "within_noise",
    "too_small",
    "input_error_suspected",
    "data_insufficient",
]


@dataclass(frozen=True, kw_only=True)
class Thresholds:
    """Numbers the verdict depends on.

    named : inclusion probability of a name; input : mass of input errors; catalogue : logarithm of the Bayes factor
    by which an explanation outside the catalogue may lead the best one within; misfit : standard deviations of the
    whitened square after the best fit above which nothing known fits, unless that is less than a share of the fall;
    group, one_trace : most members of an alias group, of any effects and of those that leave one trace; evidence,
    evidence_loop : logarithm of the Bayes factor against a healthy rig that each name of an explanation needs, in the
    heat and in orders and natural frequencies; support : fall of the whitened square that must be left of a name's
    explanation without the operating point that speaks for it most; share, share_loop : of the largest fall explained
    so far that this must be, as no answer of the model is more exact, in the heat and in orders and natural frequencies
    """

    named: float = 0.95
    input: float = 0.5
    catalogue: float = 5.0
    misfit: float = 5.0
    group: int = 3
    one_trace: int = 8
    evidence: float = 0.0
    evidence_loop: float = 0.0
    support: float = 12.0
    share: float = 0.05
    share_loop: float = 0.25

    def exceeds_healthy(self, one: Evidence, orders: frozenset[str]) -> bool:
        """Whether an explanation has more evidence than healthy rigs have given; ``orders``: causes of orders."""
        parts = frozenset(one.hypothesis.parts)
        floor = self.evidence if orders.isdisjoint(parts) else self.evidence_loop
        return one.log_bayes >= floor * len(parts)


@dataclass(frozen=True, kw_only=True)
class Decision:
    """The verdict with the parts it depends on.

    named : effects of a name, or the members of an alias group; reason : in one sentence; apart : names that hold
        whichever of the group is present; as_well : members of a further group, which one of is present as well
    elsewhere : what the numbers of the other domain say beyond a healthy rig, in words; outside : whether a cause in no
        catalogue explains the data, and better than the catalogue does
    """

    verdict: Verdict
    named: tuple[str, ...]
    reason: str
    apart: tuple[str, ...] = ()
    as_well: tuple[str, ...] = ()
    elsewhere: str = ""
    outside: bool = False


RARE = 3.0
"""Standard deviations of the whitened square above that of a healthy rig up to which a residual is still called within
it: 6 of 108 healthy pairs and 1 of 108 healthy sets without a baseline leave more in a domain."""


@dataclass(frozen=True, kw_only=True)
class WhitenedSquare:
    """Whitened square of a residual and the number of readings in it."""

    value: float
    count: int

    @property
    def deviation(self) -> float:
        """Of the whitened square of a healthy rig."""
        return float((2.0 * self.count) ** 0.5)

    @property
    def rare(self) -> bool:
        """Whether few healthy rigs leave as much."""
        return self.value - self.count > RARE * self.deviation

    def misfit(self, gain: float, thresholds: Thresholds) -> str:
        """What an explanation leaves that takes ``gain`` away, in words; empty where nothing known leaves less."""
        left = self.value - gain - self.count
        if left <= max(thresholds.misfit * self.deviation, thresholds.share * gain):
            return ""
        return f"{left / self.deviation:.1f} standard deviations above that of a healthy rig"


@dataclass(frozen=True, kw_only=True)
class Candidates:
    """What a decision may name.

    effects : of catalogue and sensors, not the unmodelled causes
    detectable : effect -> whether these sensors could see it within its bounds at all
    orders : causes that show in orders and natural frequencies, unmodelled ones among them
    sensors : those that are errors of sensors and settings; circuit : those that change the power circuit
    """

    effects: frozenset[str]
    detectable: Mapping[str, bool]
    orders: frozenset[str] = frozenset()
    sensors: frozenset[str] = frozenset()
    circuit: frozenset[str] = frozenset()
    alike: Mapping[str, frozenset[str]] = field(default_factory=dict)
    """Effect -> those that leave its trace in these numbers, itself left out."""
    one_oil: Mapping[str, frozenset[str]] = field(default_factory=dict)
    """Unmodelled loss in an oil -> losses of the catalogue of which that oil takes most."""
    passed_over: frozenset[str] = frozenset()
    """Effects that were refused: part of an explanation they may be, a name they are not."""

    @property
    def open(self) -> frozenset[str]:
        """Effects that may be named."""
        return self.effects - self.passed_over

    def without(self, others: Iterable[str]) -> "Candidates":
        """With some more that are passed over."""
        return replace(self, passed_over=self.passed_over.union(others))
