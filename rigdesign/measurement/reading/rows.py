"""Rows of data.csv: operating points, their repeats, settings and scalar channels."""

import math
import re
from collections import Counter
from collections.abc import Iterator, Mapping, MutableSequence, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.errors import Fault, MeasurementError
from rigdesign.case.faults import unknown, written
from rigdesign.measurement.quantities import (
    CHANNELS,
    SETTINGS,
    Measured,
    accepted_unit,
    impossible,
    impossible_text,
    same_worth,
    to_si,
)
from rigdesign.measurement.reading.measurement_set import (
    DataFinding,
    MeasuredChannel,
    MeasuredPoint,
    MeasurementFile,
    SettingSensor,
)
from rigdesign.measurement.reading.measurement_set import Point as PointTable
from rigdesign.measurement.reading.table import MOST_FAULTS, Table, numbers, read_table, time_stamps
from rigdesign.prediction.model import (
    ORDER_QUANTITIES,
    ROOT_WINDOWS,
    STANDING_QUANTITIES,
    Channel,
    Feature,
    OperatingCondition,
    RootWindow,
)

STATIC_TESTS = "standstill"
"""Name of rows that hold numbers of the rig at rest, at the temperature of the room; they need no settings."""
KEYS = ("point", "repeat")
TIME = "time"
"""Column of when each row was read, with a unit of time or as time stamps; it needs no entry."""
WHOLE = re.compile(r"[0-9]{1,9}")
"""A repeat as the table may have it."""
GROUPED = re.compile(r"[+-]?[1-9][0-9]{0,2}[.,][0-9]{3}")
"""A number with three decimals, or one in thousands."""
THREE_DECIMALS = re.compile(r"[.,][0-9]{3}$")
SHOWN = 5
"""Columns that are named of those not described."""


def window_columns(name: str, windows: Sequence[RootWindow]) -> tuple[str, ...]:
    """Columns of the windows of a root gauge: that of the channel where it is one."""
    return (name,) if len(windows) == 1 else tuple(f"{name}.{window}" for window in windows)


class Rows:
    """The table of the set read as numbers; ``faults`` says what is wrong with it."""

    def __init__(self, document: MeasurementFile, table: Table) -> None:
        self.table = table
        self._document = document
        self._columns: dict[str, NDArray[np.float64]] = {}
        self._impossible: dict[str, list[int]] = {}
        self.points, self.repeats, self.faults = self._read_keys()
        """Of each row."""
        self._by_point: dict[str, list[int]] = {}
        for row in sorted(range(len(self.points)), key=self.repeats.__getitem__):
            self._by_point.setdefault(self.points[row], []).append(row)
        self._places = {
            (point, self.repeats[row]): place
            for point, chosen in self._by_point.items() for place, row in enumerate(chosen)
        }  # fmt: skip
        self.faults += self._read_columns()
        self.names: tuple[str, ...] = tuple(
            dict.fromkeys(point for point in self.points if point != STATIC_TESTS)
        )
        """Operating points in the order of the table."""
        self.faults += [
            unknown(f"points.{name}", name, self.names, f"point in {table.file}")
            for name in document.points if name not in self.names
        ]  # fmt: skip
        if not self.names and not self.faults:
            self.faults.append(Fault(table.file, "", "holds no operating point", "add rows"))

    def column(self, name: str) -> NDArray[np.float64]:
        """A column [SI], one number per row; KeyError when there is none."""
        return self._columns[name]

    def rows_of(self, point: str) -> list[int]:
        """Rows of an operating point in the order of their repeats."""
        return self._by_point.get(point, [])

    def times_of(self, point: str) -> NDArray[np.float64] | None:
        """(repeats,) when the rows of a point were read [s]; None without a column of times."""
        return self._columns[TIME][self.rows_of(point)] if self._timed else None

    @property
    def _timed(self) -> bool:
        """Whether a column says when each row was read, and is not a sensor of that name."""
        return TIME in self._columns and not {TIME} & {*self._document.settings, *self._document.channels}

    def place(self, point: str, repeat: int) -> int | None:
        """Index of a repeat among those of its point; None when there is no such row."""
        return self._places.get((point, repeat))

    def impossible(self, name: str, point: str) -> list[int]:
        """Rows of a point with a reading in this column that its quantity cannot have."""
        impossible = set(self._impossible.get(name, ()))
        return [row for row in self.rows_of(point) if row in impossible] if impossible else []

    def impossible_cells(self, name: str, rows: Sequence[int], measured: Measured, unit: str) -> str:
        """Line, column and value of the first of such rows, and what is wrong with it."""
        cell_place = f"{self.table.file} line {self.table.lines[rows[0]]}, {name}"
        cell = written(self.table.column(name)[rows[0]].strip())
        return f"{cell_place} = {cell}: {impossible_text(measured, unit, len(rows))}"

    def scalars(
        self, channels: Mapping[str, MeasuredChannel], points: Sequence[MeasuredPoint]
    ) -> dict[Feature, NDArray[np.float64]]:
        """Readings of the columns by feature; the column of an order channel is its mean."""
        readings: dict[Feature, NDArray[np.float64]] = {}
        for name, channel in channels.items():
            if channel.channel.quantity == "root_strain":
                readings |= self._windows(channel.channel, points)
                continue
            if name not in self._columns:
                continue
            if channel.channel.quantity in STANDING_QUANTITIES:
                values = self._columns[name]
                readings[Feature(name, "")] = values[np.isfinite(values)]
                continue
            if channel.channel.quantity in ORDER_QUANTITIES and 0.0 not in channel.channel.orders:
                continue
            for point in points:
                readings[Feature(name, point.name)] = self._columns[name][self.rows_of(point.name)]
        return readings

    def _windows(
        self, channel: Channel, points: Sequence[MeasuredPoint]
    ) -> dict[Feature, NDArray[np.float64]]:
        """Readings of the columns of a root gauge."""
        return {
            Feature(channel.name, point.name, part=window): self._columns[column][self.rows_of(point.name)]
            for window, column in zip(channel.windows, window_columns(channel.name, channel.windows))
            if column in self._columns
            for point in points
        }

    def findings(self, channels: Mapping[str, MeasuredChannel]) -> list[DataFinding]:
        """What the table holds that is not used, readings that cannot be, and a last row that was cut."""
        known = {*KEYS, *self._document.settings, *channels}
        for name, channel in channels.items():
            known |= set(window_columns(name, channel.channel.windows))
        if self._timed:
            known.add(TIME)
        unused = [name for name in self.table.names if name not in known]
        findings = [
            DataFinding(
                id="impossible_reading", weight="dropped", channels=(name,),
                points=tuple(dict.fromkeys(self.points[row] for row in rows)),
                text=self.impossible_cells(name, rows, CHANNELS[channels[name].channel.quantity], channels[name].unit),
            )
            for name, rows in self._impossible.items() if name in channels
        ]  # fmt: skip
        findings += self._thousands()
        if unused:
            names = ", ".join(unused[:SHOWN]) + (f" and {len(unused) - SHOWN} more" if unused[SHOWN:] else "")
            text = f"{self.table.file}: no channel is described of column {names}; add [channels.{unused[0]}] to use it"
            findings.append(DataFinding(id="unused_column", weight="note", text=text))
        if self.table.cut:
            text = f"{self.table.file} {self.table.cut}; export it again"
            findings.append(DataFinding(id="cut_file", weight="dropped", text=text))
        return findings

    def _thousands(self) -> Iterator[DataFinding]:
        """Numbers such as 2.871 that fit their column, where no other has three decimals, as 2871 only."""
        decimal = self._document.data.decimal
        for name, values in self._columns.items():
            if name == TIME:
                continue
            cells = [cell.strip() for cell in self.table.column(name)]
            grouped = {row for row, cell in enumerate(cells) if GROUPED.fullmatch(cell)}
            plain = [row for row in np.flatnonzero(np.isfinite(values)) if row not in grouped]
            if not grouped or any(THREE_DECIMALS.search(cells[row]) for row in plain):
                continue
            shown = np.abs(numbers(self.table, name, decimal)[0])
            middle = float(np.median(shown[plain])) if plain else 0.0
            for row in sorted(grouped) if middle > 0.0 else ():
                if abs(math.log(1e3 * shown[row] / middle)) > 0.5 * abs(math.log(shown[row] / middle)):
                    continue
                cell_place = f"{self.table.file} line {self.table.lines[row]}, {name} = {written(cells[row])}"
                yield DataFinding(
                    id="thousands", weight="suspect", channels=(name,), points=(self.points[row],),
                    text=f"{cell_place}: the rest of its column is about {middle:.4g}, {1e3 * shown[row]:.6g} would "
                    f'fit it, a factor of 1000; look whether its sign parts thousands (data.decimal = "{decimal}")',
                )  # fmt: skip

    def _read_keys(self) -> tuple[tuple[str, ...], tuple[int, ...], list[Fault]]:
        file = self.table.file
        faults: list[Fault] = []
        if "point" not in self.table.names:
            missing = Fault(
                f"{file} line 1", "", "there is no column 'point'", "name the point of each row there"
            )
            return (), (), [missing]
        cells = tuple(cell.strip() or STATIC_TESTS for cell in self.table.column("point"))
        met: Counter[str] = Counter()
        repeats = []
        for cell in cells:  # without a column of repeats the rows of a point are counted
            met[cell] += 1
            repeats.append(met[cell])
        if "repeat" in self.table.names:
            for row, cell in enumerate(self.table.column("repeat")):
                text = cell.strip()
                if not WHOLE.fullmatch(text) and (text or cells[row] != STATIC_TESTS):
                    faults.append(
                        Fault(f"{file} line {self.table.lines[row]}, repeat", written(text), "not a whole number",
                              "count the repeats of each point from 1")
                    )  # fmt: skip
                repeats[row] = int(text) if WHOLE.fullmatch(text) else 1
        seen: dict[tuple[str, int], int] = {}
        for row, key in enumerate(zip(cells, repeats)):
            if seen.setdefault(key, row) != row and key[0] != STATIC_TESTS:
                faults.append(
                    Fault(f"{file} line {self.table.lines[row]}", f"{key[0]}, {key[1]}",
                          f"stands in line {self.table.lines[seen[key]]}, too", "number the repeats of a point 1, 2, …")
                )  # fmt: skip
        return cells, tuple(repeats), faults

    def _read_columns(self) -> list[Fault]:
        faults: list[Fault] = []
        wanted = {name: (f"settings.{name}", SETTINGS[entry.quantity], entry.unit)
                  for name, entry in self._document.settings.items()}  # fmt: skip
        faults += [
            unknown(f"settings.{name}", name, self.table.names, f"column in {self.table.file}")
            for name in wanted
            if name not in self.table.places
        ]
        for name, entry in self._document.channels.items():
            gauge = entry.quantity == "root_strain"
            columns = window_columns(name, entry.windows or ROOT_WINDOWS) if gauge else (name,)
            wanted |= dict.fromkeys(columns, (f"channels.{name}", CHANNELS[entry.quantity], entry.unit))
        for name, (key, measured, unit) in wanted.items():
            if name not in self.table.places:
                continue
            spelled = accepted_unit(unit, measured.kind)
            if spelled is None:
                continue
            faults += self._unit_fault(name, key, measured.kind, spelled)
            values, wrong = numbers(self.table, name, self._document.data.decimal)
            faults += wrong
            self._keep(name, to_si(np.array(values, dtype=float), measured.kind, spelled), measured)
        if TIME in self.table.places and TIME not in wanted:
            time_unit = accepted_unit(self.table.unit(TIME).strip().strip("[]()"), "time")
            stamps = time_stamps(self.table.column(TIME))
            if stamps is not None:
                self._columns[TIME] = (stamps - np.nanmin(stamps)) / np.timedelta64(1, "s")
            elif time_unit is not None:
                values, wrong = numbers(self.table, TIME, self._document.data.decimal)
                faults += wrong
                self._columns[TIME] = to_si(np.array(values, dtype=float), "time", time_unit)
        return faults

    def _keep(self, name: str, values: NDArray[np.float64], measured: Measured) -> None:
        """A column [SI] without the readings that its quantity cannot have."""
        wrong = impossible(values, measured)
        self._columns[name] = np.where(wrong, np.nan, values)
        if wrong.any():
            self._impossible[name] = np.flatnonzero(wrong).tolist()

    def _unit_fault(self, name: str, key: str, kind: str, spelled: str) -> list[Fault]:
        """The unit above a column must be the one measurement.toml states."""
        said = self.table.unit(name).strip().strip("[]()")
        place = f"{self.table.file} line 2, {name}"
        if not said:
            return [Fault(place, "", "the column has no unit", f'write "{spelled}"')]
        if not same_worth(said, spelled, kind):
            return [
                Fault(
                    place,
                    written(said),
                    f'{key}.unit says "{spelled}"',
                    "correct what is wrong; nothing is converted",
                )
            ]
        return []


def points_of(
    document: MeasurementFile, sensors: Mapping[str, SettingSensor], rows: Rows
) -> tuple[tuple[MeasuredPoint, ...], list[DataFinding]]:
    """Operating points as run, with a finding for those whose speed or torque is not known."""
    points: list[MeasuredPoint] = []
    findings: list[DataFinding] = []
    for name in rows.names:
        chosen = rows.rows_of(name)
        readings = {column: rows.column(column)[chosen] for column in sensors}
        means = {column: _mean(values) for column, values in readings.items()}
        lost = [column for column, sensor in sensors.items()
                if math.isnan(means[column]) and sensor.quantity in ("speed", "torque")]  # fmt: skip
        wrong = [rows.impossible_cells(column, cells, SETTINGS[sensor.quantity], sensor.unit)
                 for column, sensor in sensors.items() if (cells := rows.impossible(column, name))]  # fmt: skip
        still = [f"{column} is zero" for column, sensor in sensors.items()
                 if sensor.quantity == "speed" and means[column] == 0.0]  # fmt: skip
        if lost or wrong or still:
            why = [*wrong, *still] or [f"no reading of {', '.join(lost)}"]
            findings.append(
                DataFinding(id="unknown_setting", weight="dropped", points=(name,),
                        text=f"{name} is left out: {'; '.join(why)}; complete or correct its rows")
            )  # fmt: skip
            continue
        entry = document.points.get(name, PointTable())
        findings += [
            DataFinding(id="unknown_setting", weight="note", points=(name,),
                    text=f"{name}: no reading of {column}; taken as in the case")
            for column in sensors if math.isnan(means[column])
        ]  # fmt: skip
        points.append(
            MeasuredPoint(
                setting=_setting(name, sensors, means, entry.tooth_offset),
                readings=readings,
                times=rows.times_of(name),
                steady=entry.steady,
                reassembled=entry.reassembled,
            )
        )
    return tuple(points), findings


def _setting(
    name: str,
    sensors: Mapping[str, SettingSensor],
    means: Mapping[str, float],
    tooth_offset: Mapping[str, int],
) -> OperatingCondition:
    by_place: dict[str, dict[str, float]] = {"inlet_temperature": {}, "flow": {}}
    single: dict[str, float] = {}
    for column, sensor in sensors.items():
        if math.isnan(means[column]):
            continue
        if sensor.quantity in by_place:
            by_place[sensor.quantity][sensor.place] = means[column]
        else:
            single[sensor.quantity] = means[column]
    return OperatingCondition(
        name=name,
        speed=single["speed"],
        torque=single["torque"],
        inlet_temperature=by_place["inlet_temperature"],
        flow=by_place["flow"],
        ambient_temperature=single.get("ambient_temperature"),
        tooth_offset=dict(tooth_offset),
    )


def _mean(values: NDArray[np.float64]) -> float:
    finite = values[np.isfinite(values)]
    return float(finite.mean()) if finite.size else math.nan


# orders.csv: averaged complex orders, one row per point, repeat, channel and order.

COLUMNS = ("point", "repeat", "channel", "order", "real", "imaginary")
SAME_ORDER = 1e-3
"""Most difference between an order of the table and one that is asked for."""


def read_orders(
    folder: Path,
    document: MeasurementFile,
    channels: Mapping[str, MeasuredChannel],
    rows: Rows,
    known: Mapping[Feature, NDArray[np.float64]],
    findings: MutableSequence[DataFinding],
) -> dict[Feature, NDArray[np.float64]]:
    """Readings of all order channels by feature [SI].

    A mean is taken from here only where data.csv has no column of the channel (``known``). Orders that no
    channel asks for are left out with a finding.

    Raises
    ------
    MeasurementError
        A column is missing, a cell is no number, a point, repeat or channel is unknown, a row stands twice.
    """
    assert document.data.orders is not None
    table = read_table(folder, document.data.orders, document.data, with_units=False)
    missing = [name for name in COLUMNS if name not in table.names]
    if missing:
        raise MeasurementError(
            [
                Fault(
                    f"{table.file} line 1",
                    "",
                    f"no column {', '.join(missing)}",
                    f"write {', '.join(COLUMNS)}",
                )
            ]
        )
    faults: list[Fault] = []
    values = {}
    for name in ("repeat", "order", "real", "imaginary"):
        values[name], wrong = numbers(table, name, document.data.decimal)
        faults += wrong
    by_feature: dict[Feature, NDArray[np.float64]] = {}
    written_at: dict[tuple[Feature, int], int] = {}
    unused: dict[str, set[float]] = {}
    orphans = 0
    order_channels = tuple(name for name, c in channels.items() if c.channel.quantity in ORDER_QUANTITIES)
    points = frozenset(rows.names)
    wrong_parts: dict[str, list[str]] = {}
    places = zip(table.lines, table.column("point"), table.column("channel"))
    for row, (line, point, name) in enumerate(places):
        point, name = point.strip(), name.strip()
        row_place = f"{table.file} line {line}"
        if rows.table.cut and not _has(rows, point, values["repeat"][row]):
            orphans += 1
            continue
        if point not in points:
            faults.append(unknown(f"{row_place}, point", point, rows.names, f"point in {rows.table.file}"))
            continue
        if name not in order_channels:
            faults.append(
                unknown(f"{row_place}, channel", name, order_channels, "channel that is read by orders")
            )
            continue
        order, repeat = values["order"][row], values["repeat"][row]
        place = rows.place(point, int(repeat)) if math.isfinite(repeat) and repeat == round(repeat) else None
        if place is None or not order >= 0.0:
            faults.append(
                Fault(row_place, written(f"repeat {repeat:g}, order {order:g}"),
                      f"no such repeat of {point} in {rows.table.file}, or an order below zero", "correct the row")
            )  # fmt: skip
            continue
        asked = next((k for k in channels[name].channel.orders if abs(k - order) <= SAME_ORDER), None)
        if asked is None:
            unused.setdefault(name, set()).add(order)
            continue
        quantity, unit = channels[name].channel.quantity, channels[name].unit
        kind = CHANNELS[quantity].kind
        parts = ("value",) if asked == 0.0 else ("real", "imaginary")
        for part, column in zip(parts, ("real", "imaginary")):
            feature = Feature(name, point, asked, part)  # type: ignore[arg-type]
            if asked == 0.0 and feature in known:
                continue
            if (feature, place) in written_at:
                faults.append(
                    Fault(
                        row_place,
                        f"{name}, order {order:g}",
                        f"stands in line {written_at[feature, place]}, too",
                        "remove one",
                    )
                )
                break
            written_at[feature, place] = line
            readings = by_feature.setdefault(feature, np.full(len(rows.rows_of(point)), np.nan))
            reading = np.array(to_si(values[column][row], kind, unit))
            if impossible(reading, CHANNELS[quantity]):
                wrong_parts.setdefault(name, []).append(f"{row_place}, {column} = {values[column][row]:g}")
            else:
                readings[place] = reading
    if faults:
        raise MeasurementError(faults[:MOST_FAULTS])
    findings.extend(
        DataFinding(id="unused_order", weight="note", channels=(name,),
                text=f"{name}: {len(orders)} orders of {table.file} are not compared ({_shown(orders)}); name them "
                f"in channels.{name}.orders to use them")
        for name, orders in unused.items()
    )  # fmt: skip
    findings.extend(
        DataFinding(id="impossible_reading", weight="dropped", channels=(name,),
                text=f"{parts[0]}: "
                + impossible_text(CHANNELS[channels[name].channel.quantity], channels[name].unit, len(parts)))
        for name, parts in wrong_parts.items()
    )  # fmt: skip
    findings.extend(_gaps(by_feature, rows.names, table.file))
    if orphans:
        findings.append(
            DataFinding(id="cut_file", weight="dropped",
                    text=f"{table.file}: {orphans} rows belong to points or repeats that {rows.table.file}, which ends "
                    "early, does not have")
        )  # fmt: skip
    if table.cut:
        text = f"{table.file} {table.cut}; export it again"
        findings.append(DataFinding(id="cut_file", weight="dropped", text=text))
    return by_feature


def _has(rows: Rows, point: str, repeat: float) -> bool:
    return math.isfinite(repeat) and rows.place(point, int(repeat)) is not None


def _gaps(
    by_feature: Mapping[Feature, NDArray[np.float64]], points: Sequence[str], file: str
) -> Iterator[DataFinding]:
    """Orders that stand in the table at some points and repeats, but not at all."""
    lines = dict.fromkeys((feature.channel, feature.order, feature.part) for feature in by_feature)
    missing: dict[str, list[str]] = {}
    for channel, order, part in lines:
        for point in points:
            readings = by_feature.get(Feature(channel, point, order, part))
            if readings is None or not np.isfinite(readings).all():
                missing.setdefault(channel, []).append(point)
    for channel, where in missing.items():
        shown = tuple(dict.fromkeys(where))
        yield DataFinding(
            id="missing_order", weight="note", channels=(channel,), points=shown,
            text=f"{channel}: {file} lacks {len(where)} numbers of repeats that were run, at {', '.join(shown[:5])}"
            + (", …" if shown[5:] else ""),
        )  # fmt: skip


def _shown(orders: set[float]) -> str:
    first = sorted(orders)[:5]
    return ", ".join(f"{order:g}" for order in first) + (", …" if len(orders) > len(first) else "")
