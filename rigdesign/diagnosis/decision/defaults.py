"""What calibration froze: amplitudes, inflation, thresholds and signature errors, with their origin.

Fitted by `tests.blind.calibration` to 108 healthy sets of the virtual rig, 36 of each of three rigs;
the amplitudes to those 76 with up to 700 numbers (36 of the prototype, 24 of the 1:1 loop, 16 of the loop with a
hunting ratio), the inflation to all. Dimensionless, so that they serve rigs that nobody has simulated. Thresholds come
from the development split and from what healthy sets reach.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from rigdesign.diagnosis.residual.baseline import Drift
from rigdesign.diagnosis.statistics.amplitudes import Amplitudes
from rigdesign.diagnosis.statistics.evidence import Evidence

# What a verdict is, and what it depends on: thresholds, the effects that may be named, the whitened square.

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

    def exceeds_healthy(self, explanation: Evidence, orders: frozenset[str]) -> bool:
        """Whether an explanation has more evidence than healthy rigs have given; ``orders``: causes of orders."""
        parts = frozenset(explanation.hypothesis.parts)
        floor = self.evidence if orders.isdisjoint(parts) else self.evidence_loop
        return explanation.log_bayes >= floor * len(parts)


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


AMPLITUDES = Amplitudes(
    constant_loss=2.5,
    constant_film=0.903,
    constant_oil=2.42,
    constant_loop=2.5,
    tooth=1.84,
    exponent=0.109,
    link=0.625,
    link_speed=0.147,
    answer=0.375,
    source=0.00234,
    channel=0.00427,
    channel_speed=0.000701,
    point=0.00347,
    series_mean=0.000829,
    series_mesh=0.123,
    series_mesh_point=0.48,
    series_shaft=0.0117,
    series_shaft_point=0.00964,
    frequency=0.017,
    sensor=1.0,
    input=1.0,
)

REAL_MODEL = {"channel": 0.05, "channel_speed": 0.02, "point": 0.01, "frequency": 0.05}
"""Least amplitudes where a model of a real rig stands alone, with neither a healthy set as baseline nor a calibration.

The fitted ones hold for a virtual rig and are a tenth of this: of temperatures over their excess, powers and natural
frequencies a model that was never held against its rig is known to 5 % each, to 2 % per factor e of speed, and to 1 %
from point to point."""

INFLATION = {
    "single_pitch": 1.87e-06,
    "weak_tooth": 0.157,
    "shell_contact": 0.000202,
    "heat at oil ~T n": 0.068,
    "heat unpaid at oil ~n": 0.0186,
    "motor_ripple": 0.0036,
    "bracing_drift": 0.000326,
    "bypass": 0.127,
    "mesh_loss": 0.141,
    "spline_stiffness": 1.5,
    "heat unpaid at oil ~T n": 0.0214,
    "jet_loss": 0.112,
    "heat unpaid at oil ~n2": 0.00587,
    "inertia": 0.0457,
    "bearing_film": 0.116,
    "heat unpaid at rim ~n2": 0.00142,
    "run_out": 2.21e-06,
    "coupling_stiffness": 0.0343,
    "heat at film ~n2": 0.00152,
    "heat unpaid at oil constant": 0.00368,
    "heat unpaid at film ~T n": 0.00507,
    "one_bearing_oil": 0.0094,
}
"""Spread of a coordinate beyond the columns, by likeness of the cause; of heat without a name its share of all
losses."""

SIGNATURE_ERROR = {
    "": 0.15,
    "film": 0.25,
    "ambient_film": 0.25,
    "bearing_film": 0.25,
    "emissivity": 0.25,
    "shell_contact": 0.35,
    "foot_contact": 0.35,
    "windage_loss": 0.25,
    "loss_split": 0.25,
    "not_steady": 0.35,
    "one_bearing_loss": 0.5,
    "one_bearing_oil": 0.5,
    "one_bearing_joint": 0.5,
    "draught": 0.5,
    "leak_one_side": 0.35,
    "run_out": 0.04,
    "cumulative_pitch": 0.05,
    "coupling_stiffness": 0.33,
    "spline_stiffness": 0.45,
    "mesh_stiffness": 0.22,
    "inertia": 0.33,
    "coupling_damping": 0.57,
    "mesh_damping": 0.82,
    "profile_slope": 0.33,
    "motor_ripple": 0.04,
    "coupling_order_2": 0.04,
}
"""Kind of effect -> relative error of the model's answer to it: how far the traces of 22 effects of the heat, and of
run-out, ripple and coupling torques, lie from those of the virtual rig with nominal constants; of a rig not yet steady
by how far its rate was off in the second score, as its parts warm at their own pace; of heat at one place by the
rise of a single shell, which is half of that of the virtual rig, and by walls that the catalogue divides otherwise; of
what changes the power circuit, of profile slopes and of cumulative pitch how far three other models of the two loops
answer from their own one (`tests.blind.model_spread`: shafts that twist or bend, teeth analytic or by influence
numbers).
The spread of a pitch error of one tooth and of a weak tooth, 1.05 and 1.07 there, is not taken over: models that count
teeth from another angle would give as much."""


PLAIN = Thresholds(evidence=10.0, evidence_loop=100.0)
"""Without a baseline; the evidence is as much as any of 108 healthy sets gave: what teeth do is known that badly."""

GIVEN_BASELINE = Thresholds(evidence=6.0, evidence_loop=18.0)
"""With one."""

DRIFT = Drift(
    shared=0.00344,
    slope=0.593,
    shaft=1.02,
    mesh=1.08,
    amplitude=0.0239,
    sensors=0.35,
    constants=0.02,
    inflation={
        "film.chamber_oil": 0.000642,
        "heat unpaid at rim ~T n": 8.25e-05,
        "film.chamber_sump": 0.00251,
        "bearing_film": 0.00569,
        "inertia": 0.00222,
        "heat at rim ~n2": 4.07e-05,
        "jet_loss": 0.00273,
        "short_circuit": 0.000563,
    },
)
"""Fitted to 80 pairs of healthy sets, those with up to 900 numbers: 36 of the prototype, 28 of the 1:1 loop, 16 of the
loop with a hunting ratio; the inflation to 108 pairs, 36 of each rig. All that orders take part in was fitted while
they were 25 times as steep as their frequency at most (`rigdesign.diagnosis.statistics.resonance`: 110 now) and has not
been fitted again. ``sensors`` and ``constants`` are declared: the sets that all the others were fitted to are of rigs
that do not change from day to day."""


@dataclass(frozen=True, kw_only=True)
class Origin:
    """Where a calibration is from.

    path, hash : of the file that `rigdesign calibrate` wrote, SHA-256; case_hash : of the case it was made with
    sets : titles of the healthy sets; odd : names of those that did not look like the others
    """

    kind: Literal["shipped", "file"] = "shipped"
    path: str = ""
    hash: str = ""
    case_hash: str = ""
    sets: tuple[str, ...] = ()
    odd: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Calibration:
    """Everything a diagnosis takes from calibration."""

    amplitudes: Amplitudes = AMPLITUDES
    inflation: Mapping[str, float] = field(default_factory=lambda: dict(INFLATION))
    """Likeness of an effect -> spread of its coordinate that healthy sets asked for beyond the columns."""
    plain: Thresholds = PLAIN
    """Without a baseline."""
    given_baseline: Thresholds = GIVEN_BASELINE
    signature_error: Mapping[str, float] = field(default_factory=lambda: dict(SIGNATURE_ERROR))
    drift: Drift = DRIFT
    """With a baseline."""
    origin: Origin = Origin()

    least_alone: Mapping[str, float] = field(default_factory=lambda: dict(REAL_MODEL))
    """Least amplitudes without a baseline and without healthy sets of the rig."""

    @property
    def alone(self) -> Amplitudes:
        """Amplitudes of the model alone: with a file those of the rig's own sets, else as wide as real models are."""
        if self.origin.kind == "file":
            return self.amplitudes
        values = self.amplitudes.as_dict()
        return self.amplitudes.with_values(
            {n: max(values[n], least) for n, least in self.least_alone.items()}
        )

    def thresholds(self, baseline: bool) -> Thresholds:
        """Those of a set with a baseline or without one."""
        return self.given_baseline if baseline else self.plain


DEFAULT = Calibration()
