"""A check of a case explained: rule, limit, how the value is computed, what it needs and what moves it."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from rigdesign.base.errors import UsageError
from rigdesign.base.files import RefusedFileError, read_regular
from rigdesign.case.model import Case
from rigdesign.checks.assumptions import influences_of
from rigdesign.checks.registry import RuleFamily
from rigdesign.checks.rules import Rule, not_applicable
from rigdesign.explanation.keys import declared_rules, depends_on, entry_at, starred
from rigdesign.results.check import Check, status

# What a finished check says of one of its checks: value, verdict, and what the ranges of the inputs do to it.

LARGEST = 500 * 1024 * 1024
"""Of a results.json that is read [bytes]."""


@dataclass(frozen=True, kw_only=True)
class FinishedCheck:
    """One check of a results.json.

    same_case : the results are those of the case as it stands now
    margins : input -> margin at the low and at the high end of its range; empty without ``check --ranges``
    ranged : the ranges were evaluated
    """

    folder: str
    value: float | None
    unit: str
    margin: float | None
    distance: float | None
    verdict: str
    reason: str
    same_case: bool
    ranged: bool
    margins: Mapping[str, tuple[float | None, float | None]]


def finished_check(folder: Path, identity: str, case: Case) -> FinishedCheck:
    """A check of the results in ``folder``.

    case : as it stands now

    Raises
    ------
    UsageError
        No results.json there, one that is damaged, of another case, or without this check.
    """
    document = _read(folder / "results.json")
    try:
        checks = {row["id"]: row for row in document["checks"]}
        ranges = document.get("ranges")
        if document["case"]["name"] != case.name:
            raise UsageError(
                f"{folder}: results of case {document['case']['name']}, not of {case.name}; name the folder of a check "
                "of this case"
            )
        if identity not in checks:
            near = get_close_matches(identity, list(checks), n=3, cutoff=0.4)
            raise UsageError(
                f"{identity}: no such check in {folder}; the nearest are {', '.join(near) or 'none'}"
            )
        row = checks[identity]
        return FinishedCheck(
            folder=str(folder),
            value=row["value"],
            unit=row["unit"],
            margin=row["margin"],
            distance=row["distance"],
            verdict=status(row["verdict"], row["flags"]),
            reason=row["reason"],
            same_case=document["case"]["hash"] == case.hash,
            ranged=ranges is not None,
            margins={
                entry["path"]: (entry["margin_low"], entry["margin_high"])
                for entry in (ranges or {}).get("margins", [])
                if entry["check"] == identity
            },
        )
    except (KeyError, TypeError, AttributeError) as error:
        raise UsageError(
            f"{folder / 'results.json'}: no results of this tool ({type(error).__name__}: {error}); name a folder "
            "that rigdesign check --out has written"
        ) from None


def _read(file: Path) -> Any:
    try:
        return json.loads(read_regular(file, LARGEST))
    except RefusedFileError as error:
        raise UsageError(f"{file}: {error.strerror}; name the folder of a finished check") from None
    except OSError as error:
        raise UsageError(
            f"{file}: {error.strerror or 'cannot be read'}; name a folder that rigdesign check --out has written"
        ) from None
    except ValueError as error:
        raise UsageError(f"{file}: no JSON document ({error}); run the check again") from None


@dataclass(frozen=True, kw_only=True)
class Limit:
    """One limit of a check: its key, and the value that the case gives it; empty where it states none."""

    path: str
    value: str


@dataclass(frozen=True, kw_only=True)
class Input:
    """An input that a check depends on.

    key : its path with ``*`` for names
    influences : groups it moves the check by; empty for an input that moves every check, or its own limit
    assumed : the case assumes it; range : its plausible ends
    shift : how far the ends move the margin, in the unit of the check; None where no ranges were evaluated
    margins : at the low and at the high end
    """

    path: str
    key: str
    value: str
    influences: tuple[str, ...]
    assumed: bool
    range: tuple[str, str] | None = None
    shift: float | None = None
    margins: tuple[float | None, float | None] | None = None


@dataclass(frozen=True, kw_only=True)
class CheckExplanation:
    """How a check comes about.

    comparison : ``<=``, ``>=`` or ``within``; unit : of value and limits
    source : standard, paper or case path behind limit and value
    procedure : how the value is computed
    needs : parts of the case without which it does not apply
    inputs : by the shift of the margin where ranges were evaluated, then the assumed ones, in the order of the case
    finished : the check in the results that were named
    """

    id: str
    title: str
    group: str
    comparison: str
    unit: str
    limits: tuple[Limit, ...]
    source: str
    procedure: str
    needs: tuple[str, ...]
    applicable: bool
    inputs: tuple[Input, ...]
    finished: FinishedCheck | None = None

    @property
    def ranked(self) -> bool:
        """Whether ranges were evaluated that sort the inputs."""
        return self.finished is not None and self.finished.ranged


def explain_check(case: Case, identity: str, finished: FinishedCheck | None = None) -> CheckExplanation:
    """How the check ``identity`` of a case is computed.

    finished : the same check in the results of a run, whose ranges sort the inputs

    Raises
    ------
    UsageError
        No such check in this case; the nearest ones are named.
    """
    rules = {rule.id: (family, rule) for family, rule in declared_rules(case)}
    if identity not in rules:
        near = get_close_matches(identity, list(rules), n=3, cutoff=0.4)
        hint = f"the nearest are {', '.join(near)}" if near else "rigdesign explain CASE lists the checks"
        raise UsageError(f"{identity}: no such check of {case.path}; {hint}")
    family, rule = rules[identity]
    limits = tuple(Limit(path=path, value=_stated(case, path)) for path in family.limits_of(rule))
    needs = tuple(_needs(family))
    return CheckExplanation(
        id=rule.id,
        title=rule.title,
        group=rule.group,
        comparison=rule.comparison,
        unit=rule.unit,
        limits=limits,
        source=rule.source,
        procedure=family.procedure,
        needs=needs,
        applicable=(any if family.one_limit_suffices else all)(limit.value for limit in limits)
        and _met(case, needs),
        inputs=tuple(_inputs(case, family, rule, finished)),
        finished=finished,
    )


DRIVETRAIN, HOUSING, TRANSIENT = "a drivetrain", "a gearbox with a housing", "check --transient"
LOADED_CONTACT = "loaded contact, of influence numbers"
BENDING = "shafts that bend"
PRESS_FIT = "a gear with shaft_interference and no spline.toothing"
SPLINES = {
    "strength.spline_pressure": "allowable_pressure in spline.toothing of a gear",
    "strength.spline_shear": "allowable_shear in spline.toothing of a gear",
    "strength.spline_hub": "allowable_tension and hub_root_diameter in spline.toothing of a gear",
}
"""What each check of splines needs."""


def _needs(family: RuleFamily) -> Iterator[str]:
    if family.needs is not None:
        yield DRIVETRAIN
    if family.housed:
        yield HOUSING
    if family.key.startswith("transient."):
        yield TRANSIENT
    if family.key in ("flank.contact_pressure", "flank.edge_pressure"):
        yield LOADED_CONTACT
    if family.key.startswith("lateral."):
        yield BENDING
    if family.key == "strength.press_fit_slip":
        yield PRESS_FIT
    if family.key in SPLINES:
        yield SPLINES[family.key]


def _met(case: Case, needs: tuple[str, ...]) -> bool:
    """Whether the case has what the check needs; that it is run with an option is not a matter of the case."""
    housed = any(box.housing is not None for box in case.gearboxes.values())
    return (
        (DRIVETRAIN not in needs or case.drivetrain is not None)
        and (HOUSING not in needs or housed)
        and (BENDING not in needs or case.power_circuit.shaft_model == "elastic")
        and _seats_met(case, needs)
    )


def _seats_met(case: Case, needs: tuple[str, ...]) -> bool:
    """Whether the gears have what checks of their seats need."""
    gears = [gear for box in case.gearboxes.values() for gear in box.gears.values()]
    splines = [gear.spline.toothing for gear in gears if gear.spline is not None and gear.spline.toothing]
    pressed = [
        gear for gear in gears if gear.shaft_interference and not (gear.spline and gear.spline.toothing)
    ]
    found = {
        PRESS_FIT: bool(pressed),
        SPLINES["strength.spline_pressure"]: any(one.allowable_pressure for one in splines),
        SPLINES["strength.spline_shear"]: any(one.allowable_shear for one in splines),
        SPLINES["strength.spline_hub"]: any(
            one.allowable_tension and one.hub_root_diameter for one in splines
        ),
    }
    return all(met for need, met in found.items() if need in needs)


def _stated(case: Case, path: str) -> str:
    """The value of a key as the case writes it, else its default; empty where there is neither."""
    stated = case.origin.value_of.get(path)
    if stated is not None:
        return stated
    entry = entry_at(path)
    return "" if entry is None or entry.default is None else f"{entry.default} by default"


def _inputs(case: Case, family: RuleFamily, rule: Rule, finished: FinishedCheck | None) -> Iterator[Input]:
    """Inputs of the case that the check depends on: as far as ranges rank them, then the assumed ones."""
    check = not_applicable(rule, "not computed")
    moved = {} if finished is None else finished.margins
    found = [
        _input(case, family, check, row.path, row.value, moved.get(row.path))
        for row in case.inputs
        if depends_on(case, check, row.path)
    ]
    shifts = {one.path: -1.0 if one.shift is None else one.shift for one in found}
    yield from sorted(found, key=lambda one: (-shifts[one.path], not one.assumed))


def _input(
    case: Case,
    family: RuleFamily,
    check: Check,
    path: str,
    value: str,
    margins: tuple[float | None, float | None] | None,
) -> Input:
    mark = case.origin.mark_of.get(path)
    known = set(influences_of(case, path) or ()) & set(family.moved_by)
    entry = entry_at(path)
    assert entry is not None, path
    return Input(
        path=path,
        key=starred(entry.path),
        value=value,
        influences=tuple(sorted(known)),
        assumed=mark is not None and mark.assumed is not None,
        range=None if mark is None or mark.range is None else (str(mark.range[0]), str(mark.range[1])),
        shift=None if margins is None else _span(margins),
        margins=margins,
    )


def _span(margins: tuple[float | None, float | None]) -> float | None:
    low, high = margins
    return None if low is None or high is None else abs(high - low)
