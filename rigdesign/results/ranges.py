"""What the ranges of the assumed inputs say: immutable records, named as they stand in results.json."""

from dataclasses import dataclass

from rigdesign.results.check import Verdict


@dataclass(frozen=True, kw_only=True)
class RangedInput:
    """One assumed input at the two ends of its range, all others as stated.

    Numbers of an end are None where it was not solved; ``low_error`` and ``high_error`` then say why.
    """

    path: str
    together_with: tuple[str, ...]
    """Inputs that the case wants to have the same value: moved with it."""
    stated: str
    low: str
    high: str
    solved_again: tuple[str, ...]
    """Parts of the model that were solved again: coupling, curves, time run; empty where only checks depend on it."""
    max_temperature_low_degC: float | None  # noqa: N815
    """Highest temperature of all housings with the input at its low end."""
    max_temperature_high_degC: float | None  # noqa: N815
    low_error: str | None = None
    high_error: str | None = None
    changes: tuple[str, ...] = ()
    """Ids of the checks whose verdict another value of this input changes."""


@dataclass(frozen=True, kw_only=True)
class RangeMargin:
    """Margin of one check with one input at the ends of its range; only pairs that move are listed."""

    check: str
    path: str
    unit: str
    margin_low: float | None
    margin_high: float | None
    distance_low: float | None
    distance_high: float | None
    verdict_low: Verdict | None
    verdict_high: Verdict | None


@dataclass(frozen=True, kw_only=True)
class CheckRange:
    """One check over all ranges."""

    check: str
    unit: str
    verdict_stated: Verdict
    """With every input as stated."""
    verdict: Verdict
    """Over the ranges: a check that holds as stated and not everywhere in them is open."""
    margin: float | None
    worst_margin: float | None
    """Least margin with one input at an end; as stated where none lowers it."""
    worst_path: str | None
    worst_value: str | None
    best_margin: float | None
    best_path: str | None
    distance: float | None
    worst_distance: float | None
    best_distance: float | None
    all_worst_margin: float | None
    """Margin with every input at its worse end, the single shifts added: an estimate, they are not moved together."""
    decided_by: tuple[str, ...]
    """Inputs of which another value changes whether the check holds."""


@dataclass(frozen=True, kw_only=True)
class TemperatureRange:
    """Highest temperature of all housings over the ranges [degC], one input at a time."""

    stated_degC: float  # noqa: N815
    low_degC: float  # noqa: N815
    low_path: str | None
    high_degC: float  # noqa: N815
    high_path: str | None
    all_high_degC: float  # noqa: N815
    """Every input at its warmer end, the single shifts added: an estimate."""


@dataclass(frozen=True, kw_only=True)
class LeftOut:
    """An assumed input whose range was not evaluated."""

    path: str
    reason: str


@dataclass(frozen=True, kw_only=True)
class RangesResult:
    """Key ``ranges`` of results.json.

    Margins at an end are those of the run plus the shift between the stated value and the end, both solved at
    ``fidelity``: what the mesh size adds to a value cancels.
    """

    fidelity: str
    method: str
    """What was solved again for how many ends, in words."""
    inputs: list[RangedInput]
    checks: list[CheckRange]
    margins: list[RangeMargin]
    """Sorted by check in the order of the report, then by how far the margin moves."""
    max_temperature: TemperatureRange | None
    left_out: list[LeftOut]
