"""results.json of a check, read as far as two of them are compared."""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from rigdesign.base import units
from rigdesign.base.errors import WIDEST_PLACE, UsageError, shortened
from rigdesign.base.version import RESULTS_SCHEMA_VERSION, __version__
from rigdesign.case.provenance import is_label
from rigdesign.results.check import status

RESULTS = "results.json"
TAKES = "diff takes two folders that `rigdesign check --out` wrote, or their results.json"
AGAIN = f"run `rigdesign check` again with version {__version__}"
OTHER_FOLDERS = {
    "ledger.sqlite": "is the folder of a study",
    "diagnosis.json": "is the folder of a diagnosis",
    "compare.json": "is the folder of a comparison",
    "validation.json": "is the folder of a validation",
    "case.toml": "is a case, not its results",
    "failure.json": "holds a run that did not converge",
}
"""File that tells what a folder without results.json is."""


@dataclass(frozen=True, kw_only=True)
class InputValue:
    """Value of an input as the case writes it, and where it is from."""

    value: str
    basis: str


@dataclass(frozen=True, kw_only=True)
class CheckValue:
    """A check of one result; numbers are None where it does not apply.

    reason : why it has its verdict
    """

    id: str
    title: str
    group: str
    unit: str
    verdict: str
    value: float | None
    comparison: str
    limit: float | None
    upper_limit: float | None
    margin: float | None
    distance: float | None
    reason: str


@dataclass(frozen=True, kw_only=True)
class CheckedResults:
    """What one results.json says.

    inputs : by path
    checks : by id
    quantities : number and unit by what it is and where
    assumptions : reason by path
    """

    path: Path
    name: str
    title: str
    hash: str
    tool_version: str
    fidelity: str
    verdict: str
    inputs: Mapping[str, InputValue]
    checks: Mapping[str, CheckValue]
    quantities: Mapping[tuple[str, str], tuple[float, str]]
    assumptions: Mapping[str, str]
    warnings: tuple[tuple[str, str], ...]
    not_modelled: tuple[str, ...]


def read_results(path: Path) -> CheckedResults:
    """Read a folder of a check, or its results.json.

    Raises
    ------
    UsageError
        If there is none, it is damaged, of another schema version or without inputs; says what to do.
    """
    file, document = read_document(path)
    place = shortened(str(file), WIDEST_PLACE)
    if "inputs" not in document:
        by = shortened(str(document.get("tool_version", "an earlier version")))
        raise UsageError(f"{place}: lists no inputs (written by rigdesign {by}); {AGAIN}")
    try:
        return _results(file, document)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise UsageError(
            f"{place}: is damaged ({type(error).__name__}: {shortened(str(error))}); {AGAIN}"
        ) from None


def read_document(path: Path, takes: str = TAKES) -> tuple[Path, dict[str, Any]]:
    """The results.json of a folder, or the file itself, with its content.

    takes : what the command takes, for its messages

    Raises
    ------
    UsageError
        If there is none, it is damaged or of another schema version; says what to do.
    """
    file = _file(path, takes)
    place = shortened(str(file), WIDEST_PLACE)
    document = _document(file, place, takes)
    version = document.get("schema_version")
    if version is None or "checks" not in document:
        raise UsageError(f"{place}: is no results.json of a check; {takes}")
    if str(version) != RESULTS_SCHEMA_VERSION:
        raise UsageError(
            f"{place}: schema_version {shortened(str(version))}, this version reads {RESULTS_SCHEMA_VERSION}; {AGAIN}"
        )
    return file, document


def _file(path: Path, takes: str) -> Path:
    place = shortened(str(path), WIDEST_PLACE)
    try:
        if path.is_file():
            return path
        if not path.is_dir():
            raise UsageError(f"{place}: no such file or folder; {takes}")
        if (path / RESULTS).is_file():
            return path / RESULTS
        found = (text for name, text in OTHER_FOLDERS.items() if (path / name).exists())
        raise UsageError(f"{place}: {next(found, f'holds no {RESULTS}')}; {takes}")
    except (OSError, ValueError) as error:
        raise UsageError(f"{place}: {getattr(error, 'strerror', None) or error}; {takes}") from None


def _document(file: Path, place: str, takes: str) -> dict[str, Any]:
    try:
        document = json.loads(file.read_text(encoding="utf-8"), parse_constant=_not_finite)
    except OSError as error:
        raise UsageError(f"{place}: {error.strerror}; {takes}") from None
    except (ValueError, RecursionError) as error:
        raise UsageError(f"{place}: is damaged ({shortened(str(error))}); {AGAIN}") from None
    if not isinstance(document, dict):
        raise UsageError(f"{place}: is no results.json of a check; {takes}")
    return document


def _not_finite(text: str) -> float:
    raise ValueError(f"{text} is no number of a result")


def _results(file: Path, document: Mapping[str, Any]) -> CheckedResults:
    case = document["case"]
    return CheckedResults(
        path=file,
        name=_text(case["name"]),
        title=_text(case["title"]),
        hash=_text(case["hash"]),
        tool_version=_text(document["tool_version"]),
        fidelity=_text(document["fidelity"]),
        verdict=_text(document["verdict"]),
        inputs={
            _text(row["path"]): InputValue(value=_text(row["value"]), basis=_text(row["basis"]))
            for row in document["inputs"]
        },
        checks={_text(row["id"]): _check(row) for row in document["checks"]},
        quantities=dict(_quantities(document)),
        assumptions={_text(row["path"]): _text(row["reason"]) for row in document["assumptions"]},
        warnings=tuple((_text(row["id"]), _text(row["text"])) for row in document["warnings"]),
        not_modelled=tuple(_text(item) for item in document["not_modelled"]),
    )


def _check(row: Mapping[str, Any]) -> CheckValue:
    return CheckValue(
        id=_text(row["id"]),
        title=_text(row["title"]),
        group=_text(row["group"]),
        unit=_text(row["unit"]),
        verdict=status(row["verdict"], row["flags"]),
        value=_number_or_none(row["value"]),
        comparison=_text(row["comparison"]),
        limit=_number_or_none(row["limit"]),
        upper_limit=_number_or_none(row["upper_limit"]),
        margin=_number_or_none(row["margin"]),
        distance=_number_or_none(row["distance"]),
        reason=_text(row["reason"]),
    )


def _quantities(document: Mapping[str, Any]) -> list[tuple[tuple[str, str], tuple[float, str]]]:
    """Temperatures, losses, seal gaps, dynamic factors: (what, where) and (number, unit)."""
    found = []
    for row in document["thermal"]:
        place = f"{row['gearbox']}, stage {row['stage']}"
        found.append((("highest temperature", place), (_number(row["max_temperature_degC"]), "degC")))
    for row in document["oil"]:
        place = f"{row['consumer']}, stage {row['stage']}"
        found.append((("oil outlet", place), (_number(row["outlet_degC"]), "degC")))
    total, single = _powers(document["losses"])
    found += [(("losses in all", place), (power, "W")) for place, power in total.items()]
    for row in document["expansion"]:
        for gap in row["seal_gaps"]:
            place = f"{gap['seal']}, stage {row['stage']}"
            found.append((("smallest hot seal gap", place), (_number(gap["hot_min_mm"]), "mm")))
    for gearbox, row in (document["dynamics"] or {"gearboxes": {}})["gearboxes"].items():
        factor = row["largest_dynamic_factor"]
        if factor is not None:
            found.append((("largest K_V over speed", gearbox), (_number(factor), "-")))
        peak = row["dynamic_torque_peak_Nm"]
        if peak is not None:
            found.append((("peak torque of the ramp", gearbox), (_number(peak), "Nm")))
    return found + [((what, place), (power, "W")) for (what, place), power in single.items()]


def _powers(rows: list[Mapping[str, Any]]) -> tuple[dict[str, float], dict[tuple[str, str], float]]:
    """Losses of every stage in all, and by kind and place."""
    total: dict[str, float] = {}
    single: dict[tuple[str, str], float] = {}
    for row in rows:
        power = _number(row["power_W"])
        in_all = f"stage {row['stage']}"
        at_place = (f"{row['kind']} loss", f"{row['place']}, stage {row['stage']}")
        total[in_all] = total.get(in_all, 0.0) + power
        single[at_place] = single.get(at_place, 0.0) + power
    return total, single


def _text(value: object) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{shortened(repr(value))} where a text belongs")
    return value


def _number(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise TypeError(f"{shortened(repr(value))} where a number belongs")
    return float(value)


def _number_or_none(value: object) -> float | None:
    return None if value is None else _number(value)


# Inputs of two cases as quantities: 40 mm and 0.04 m are one value.

SAME = 1e-12
"""Relative difference of two quantities that are one value: round-off of the units."""


@dataclass(frozen=True, kw_only=True)
class InputChange:
    """An input that differs; ``before`` or ``after`` is None where the case has it not.

    change : ``basis`` where the value is the same and its source is not
    relative : change over the value before, None for what are no quantities on one scale
    """

    path: str
    change: Literal["changed", "added", "removed", "basis"]
    before: InputValue | None
    after: InputValue | None
    relative: float | None = None


def changed_inputs(
    before: Mapping[str, InputValue], after: Mapping[str, InputValue]
) -> tuple[InputChange, ...]:
    """What differs, in the order of the case: values first changed, then added and removed, then sources.

    Names and titles are left out: no result depends on them.
    """
    found = []
    for path in dict.fromkeys([*before, *after]):
        if is_label(path):
            continue
        old, new = before.get(path), after.get(path)
        if old is None or new is None:
            found.append(
                InputChange(path=path, change="added" if old is None else "removed", before=old, after=new)
            )
        elif not same_value(old.value, new.value):
            found.append(
                InputChange(
                    path=path,
                    change="changed",
                    before=old,
                    after=new,
                    relative=_relative(old.value, new.value),
                )
            )
        elif old.basis != new.basis:
            found.append(InputChange(path=path, change="basis", before=old, after=new))
    order = ("changed", "added", "removed", "basis")
    return tuple(sorted(found, key=lambda row: order.index(row.change)))


def same_value(first: str, second: str) -> bool:
    """Whether two texts of a case state one value: quantity, number, list of them, or word."""
    if first == second:
        return True
    parts, others = first.split(","), second.split(",")
    return len(parts) == len(others) and all(map(_same, parts, others))


def _same(first: str, second: str) -> bool:
    if first.strip() == second.strip():
        return True
    numbers = _numbers(first, second)
    return numbers is not None and math.isclose(*numbers, rel_tol=SAME)


def _numbers(first: str, second: str) -> tuple[float, float] | None:
    """Both in SI, or as plain numbers; None for words and for quantities of different kinds."""
    try:
        return float(first), float(second)
    except ValueError:
        pass
    kind = units.kind_of(first.strip())
    if kind is None:
        return None
    try:
        return units.parse(first.strip(), kind), units.parse(second.strip(), kind)
    except units.QuantityError:
        return None


def _relative(first: str, second: str) -> float | None:
    """Change over the first value; None for lists, words, temperatures (their zero means nothing) and zero."""
    if units.kind_of(first.strip()) == "temperature":
        return None
    numbers = _numbers(first, second)
    if numbers is None or numbers[0] == 0.0:
        return None
    return (numbers[1] - numbers[0]) / abs(numbers[0])
