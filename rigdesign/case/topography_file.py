"""Measured topography of flanks as a CSV grid next to the case.

A row of names, a row of units, then one row for each place:

    tooth,roll_length,face,removed
    ,mm,mm,um
    0,10.0,-12.5,3.2

Profile: one of ``roll_length`` (from the base tangent point), ``diameter``, ``roll_angle``. ``face``: from its middle,
growing to the rear end. Sign: ``removed`` counts metal that is missing as positive, ``deviation``
metal that stands out of the flank, as measuring machines print it; both along the transverse line of action (base
tangent), as ISO 1328-1 has deviations measured. ``tooth`` counts from 0 and may be left out: one flank stands
for all.
"""

import csv
import io
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

from rigdesign.base import units
from rigdesign.base.errors import CaseError, Fault
from rigdesign.base.files import RefusedFileError, foreign, read_regular
from rigdesign.base.units import KINDS
from rigdesign.case.faults import written

ProfileCoordinate = Literal["roll_length", "diameter", "roll_angle"]

LARGEST_FILE = 50_000_000
"""Bytes of a grid; 100 teeth with 50 by 50 places have a tenth."""
LARGEST_AMOUNT = 1e-3
"""Metal removed or standing out [m]; more is a mistaken unit."""
MOST_FAULTS = 20
PROFILE: tuple[ProfileCoordinate, ...] = ("roll_length", "diameter", "roll_angle")
SIGNS = {"removed": 1.0, "deviation": -1.0}
EXAMPLE = 'write e.g. "roll_length,face,removed" and below it "mm,mm,um"'


@dataclass(frozen=True, kw_only=True)
class TopographyGrid:
    """Flank topography as the file has it, in SI.

    coordinate : what ``profile`` (n_p,) is: roll length or diameter [m], roll angle [rad]; growing
    face : (n_f,) from mid-face [m]; growing
    removed : metal removed [m], by tooth (1 where one stands for all), place on the profile and on the face
    """

    coordinate: ProfileCoordinate
    profile: tuple[float, ...]
    face: tuple[float, ...]
    removed: tuple[tuple[tuple[float, ...], ...], ...]


@dataclass(frozen=True)
class _Columns:
    """Column of each quantity, and what turns its numbers into SI."""

    coordinate: ProfileCoordinate
    place: dict[str, int]
    scale: dict[str, float]


Row = tuple[int, int, float, float, float]
"""Line, tooth, profile, face, removed [SI]."""


def read_topography(file: Path, key: str, case: Path) -> TopographyGrid:
    """Grid of a topography file.

    key : of the case that names the file; case : case file, for messages

    Raises
    ------
    CaseError
        A file that cannot be read, unknown or missing columns or units, cells that are no bare number (mixed units,
        holes), places that are twice, missing or out of order, amounts above 1 mm.
    """
    rows = _table(file, key, case)
    try:
        columns = _columns(file.name, rows)
        return _grid(file.name, columns, list(_rows(file.name, columns, rows[2:])))
    except _RefusedGridError as error:
        faults = [replace(fault, path=f"{key}: {fault.path}") for fault in error.faults[:MOST_FAULTS]]
        raise CaseError(faults, str(case)) from None


class _RefusedGridError(Exception):
    def __init__(self, faults: Sequence[Fault]) -> None:
        super().__init__(faults)
        self.faults = list(faults)


def _table(file: Path, key: str, case: Path) -> list[tuple[int, list[str]]]:
    """Rows that hold something, each with its line."""

    def refused(problem: str, remedy: str) -> CaseError:
        return CaseError([Fault(key, written(file.name), problem, remedy)], str(case))

    try:
        content = read_regular(file, LARGEST_FILE)
    except RefusedFileError as error:
        raise refused(f"is {error.strerror}", "name a CSV file next to the case") from None
    except OSError as error:
        raise refused(str(error.strerror), "correct the path of the file") from None
    if (what := foreign(content)) is not None:
        raise refused(f"is {what}, not a table of text", "export the sheet as CSV")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise refused(f"is not UTF-8 text (byte {error.start})", "save it as UTF-8") from None
    delimiter = ";" if ";" in text.partition("\n")[0] else ","
    try:
        cells = list(csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True))
    except csv.Error as error:
        raise refused(f"cannot be read: {error}", "correct the file") from None
    rows = [
        (line, [cell.strip() for cell in row])
        for line, row in enumerate(cells, 1)
        if any(map(str.strip, row))
    ]
    if len(rows) < 3:
        raise refused("holds no grid", "write a row of names, one of units and one for each place")
    return rows


def _columns(file: str, rows: Sequence[tuple[int, list[str]]]) -> _Columns:
    names, spelled = rows[0][1], rows[1][1]
    at = f"{file} line {rows[0][0]}"
    known = ("tooth", *PROFILE, "face", *SIGNS)
    faults = [
        Fault(at, written(name), "unknown column", f"known: {', '.join(known)}")
        for name in names
        if name not in known
    ]
    faults += [Fault(at, name, "stands twice", "keep one of them") for name in known if names.count(name) > 1]
    for choices, what in (
        (PROFILE, "place on the profile"),
        (tuple(SIGNS), "sign of the amounts"),
        (("face",), "place on the face"),
    ):
        given = [name for name in choices if name in names]
        if len(given) != 1:
            problem = (
                f"no column says the {what}" if not given else f"{' and '.join(given)} both say the {what}"
            )
            faults.append(Fault(at, "", problem, f"write one of {', '.join(choices)}"))
    if len(spelled) != len(names):
        faults.append(
            Fault(f"{file} line {rows[1][0]}", "", f"{len(spelled)} units for {len(names)} names", EXAMPLE)
        )
    if faults:
        raise _RefusedGridError(faults)
    scale = {}
    for name, unit in zip(names, spelled, strict=True):
        kind = "angle" if name == "roll_angle" else "length"
        if name == "tooth":
            continue
        found = next((own for own in KINDS[kind].units if unit and units.same_unit(own, unit)), None)
        if found is None:
            faults.append(
                Fault(f"{file} line {rows[1][0]}", written(unit), f"is no unit of {name}",
                      f"write one of {', '.join(KINDS[kind].units)} below the name")
            )  # fmt: skip
            continue
        scale[name] = units.worth(kind, found)[0]
    if faults:
        raise _RefusedGridError(faults)
    coordinate = next(name for name in PROFILE if name in names)
    return _Columns(coordinate, {name: names.index(name) for name in names}, scale)


def _rows(file: str, columns: _Columns, rows: Sequence[tuple[int, list[str]]]) -> Iterator[Row]:
    """Numbers of every row; raises for all cells that hold none."""
    faults, width = [], len(columns.place)
    sign = next(name for name in SIGNS if name in columns.place)
    for line, cells in rows:
        at = f"{file} line {line}"
        if len(cells) != width:
            faults.append(Fault(at, "", f"has {len(cells)} cells, the names are {width}", "correct the row"))
            continue
        tooth, wrong = _tooth(at, columns, cells)
        values = {}
        for name, scale in columns.scale.items():
            cell = cells[columns.place[name]]
            value, fault = _number(f"{at}, {name}", cell)
            wrong += fault
            values[name] = scale * value
        amount = SIGNS[sign] * values[sign]
        if not wrong and abs(amount) > LARGEST_AMOUNT:
            wrong.append(
                Fault(
                    f"{at}, {sign}",
                    cells[columns.place[sign]],
                    "is above 1 mm",
                    "correct the unit of the column",
                )
            )
        faults += wrong
        if len(faults) >= MOST_FAULTS:
            break
        yield line, tooth, values[columns.coordinate], values["face"], amount
    if faults:
        raise _RefusedGridError(faults)


def _tooth(at: str, columns: _Columns, cells: Sequence[str]) -> tuple[int, list[Fault]]:
    if "tooth" not in columns.place:
        return 0, []
    cell = cells[columns.place["tooth"]]
    if cell.isdecimal():
        return int(cell), []
    return 0, [Fault(f"{at}, tooth", written(cell), "is no number of a tooth", "count teeth from 0")]


def _number(at: str, cell: str) -> tuple[float, list[Fault]]:
    """Value of a cell, or what is wrong with it."""
    try:
        value = float(cell)
    except ValueError:
        if not cell:
            return 0.0, [Fault(at, "", "has no value", "fill the holes of the grid before it is used")]
        if units.kind_of(cell) is not None:
            remedy = "write bare numbers, all in the unit of the second row"
            return 0.0, [Fault(at, written(cell), "has a unit of its own", remedy)]
        return 0.0, [Fault(at, written(cell), "is no number", "write a number with a decimal point")]
    if not math.isfinite(value):
        return 0.0, [
            Fault(at, written(cell), "is not finite", "fill the holes of the grid before it is used")
        ]
    return value, []


def _grid(file: str, columns: _Columns, rows: Sequence[Row]) -> TopographyGrid:
    profile = _axis(file, columns.coordinate, [row[2] for row in rows])
    face = _axis(file, "face", [row[3] for row in rows])
    teeth = sorted({row[1] for row in rows})
    if teeth != list(range(len(teeth))):
        missing = next(number for number in range(len(teeth)) if number not in teeth)
        raise _RefusedGridError(
            [Fault(f"{file}, tooth", "", f"tooth {missing} is missing", "number the teeth from 0")]
        )
    amounts: dict[tuple[int, float, float], float] = {}
    for line, tooth, along, across, amount in rows:
        if (tooth, along, across) in amounts:
            raise _RefusedGridError(
                [Fault(f"{file} line {line}", "", "this place is there already", "remove one of them")]
            )
        amounts[tooth, along, across] = amount
    if missing := len(teeth) * len(profile) * len(face) - len(amounts):
        raise _RefusedGridError(
            [Fault(file, "", f"{missing} of {len(teeth)} x {len(profile)} x {len(face)} places of the grid are missing",
                   "give every face position at every place on the profile, with the same digits")]
        )  # fmt: skip
    removed = tuple(tuple(tuple(amounts[t, p, f] for f in face) for p in profile) for t in teeth)
    return TopographyGrid(coordinate=columns.coordinate, profile=profile, face=face, removed=removed)


def _axis(file: str, name: str, values: Sequence[float]) -> tuple[float, ...]:
    """Places in growing order; they must come in growing or falling order."""
    places = tuple(dict.fromkeys(values))
    ordered = tuple(sorted(places))
    if places not in (ordered, ordered[::-1]):
        raise _RefusedGridError(
            [
                Fault(
                    f"{file}, {name}",
                    "",
                    "neither grows nor falls from row to row",
                    "write the grid row by row in order",
                )
            ]
        )
    if len(places) < 2:
        raise _RefusedGridError(
            [
                Fault(
                    f"{file}, {name}",
                    "",
                    "has one place only, at least 2 are needed",
                    "measure at more places",
                )
            ]
        )
    return ordered
