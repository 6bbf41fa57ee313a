"""What a study found: its points and what follows from them, immutable."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from rigdesign.studies.grid import Variation

if TYPE_CHECKING:
    from rigdesign.case import Case

Design = Literal["grid", "boundary", "one at a time", "latin hypercube", "sobol"]
"""How the points were chosen."""
Record = dict[str, Any]
"""What is kept of a point: {verdict, max_temperature_degC, checks: [...]} or {error, traceback}."""


@dataclass(frozen=True, kw_only=True)
class StudyPoint:
    """One point of a study with what came of it.

    values : varied values by path
    record : {verdict, max_temperature_degC, checks} of a computed point, {error} of a failed one
    """

    values: dict[str, str]
    failed: bool
    record: Record


@dataclass(frozen=True, kw_only=True)
class Crossing:
    """The value of an input at which a check changes from held to broken, between two computed points.

    value : in ``unit``, as the study varies it; ``low`` and ``high`` bracket it
    holds : the side of the value on which the check holds
    """

    check: str
    path: str
    value: float
    low: float
    high: float
    unit: str
    holds: Literal["below", "above"]


@dataclass(frozen=True, kw_only=True)
class Swing:
    """A check with one input at its two ends, all others as stated: a bar of a tornado plot."""

    check: str
    path: str
    low: str
    high: str
    utilisation_stated: float | None
    utilisation_low: float | None
    utilisation_high: float | None


@dataclass(frozen=True, kw_only=True)
class PassProbability:
    """Share of the samples in which a check holds, with its 95 % interval (Wilson)."""

    check: str
    probability: float
    low: float
    high: float
    samples: int


@dataclass(frozen=True, kw_only=True)
class SobolIndex:
    """Share of the variance of a check's utilisation that an input causes: alone, and with all its interactions."""

    check: str
    path: str
    first_order: float
    first_order_interval: tuple[float, float]
    total: float
    total_interval: tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class StudyResult:
    """All points in the order of the design, and what was found from them."""

    case: "Case"
    fidelity: str
    design: Design
    variations: Sequence[Variation]
    points: Sequence[StudyPoint]
    crossings: Sequence[Crossing] = ()
    swings: Sequence[Swing] = ()
    probabilities: Sequence[PassProbability] = ()
    indices: Sequence[SobolIndex] = ()
