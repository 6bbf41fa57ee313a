"""orders.csv: averaged complex orders, one row per point, repeat, channel and order."""

import math
from collections.abc import Iterator, Mapping, MutableSequence, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.errors import Fault, MeasurementError
from rigdesign.case.faults import unknown, written
from rigdesign.measurement.quantities import CHANNELS, impossible, impossible_text, to_si
from rigdesign.measurement.reading.document import MeasurementFile
from rigdesign.measurement.reading.measurement_set import DataFinding, MeasuredChannel
from rigdesign.measurement.reading.rows import Rows
from rigdesign.measurement.reading.table import MOST_FAULTS, numbers, read_table
from rigdesign.prediction.model import ORDER_QUANTITIES, Feature

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
    found: dict[Feature, NDArray[np.float64]] = {}
    written_at: dict[tuple[Feature, int], int] = {}
    unused: dict[str, set[float]] = {}
    orphans = 0
    order_channels = tuple(name for name, c in channels.items() if c.channel.quantity in ORDER_QUANTITIES)
    points = frozenset(rows.names)
    wrong_parts: dict[str, list[str]] = {}
    places = zip(table.lines, table.column("point"), table.column("channel"))
    for row, (line, point, name) in enumerate(places):
        point, name = point.strip(), name.strip()
        at = f"{table.file} line {line}"
        if rows.table.cut and not _has(rows, point, values["repeat"][row]):
            orphans += 1
            continue
        if point not in points:
            faults.append(unknown(f"{at}, point", point, rows.names, f"point in {rows.table.file}"))
            continue
        if name not in order_channels:
            faults.append(unknown(f"{at}, channel", name, order_channels, "channel that is read by orders"))
            continue
        order, repeat = values["order"][row], values["repeat"][row]
        place = rows.place(point, int(repeat)) if math.isfinite(repeat) and repeat == round(repeat) else None
        if place is None or not order >= 0.0:
            faults.append(
                Fault(at, written(f"repeat {repeat:g}, order {order:g}"),
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
                        at,
                        f"{name}, order {order:g}",
                        f"stands in line {written_at[feature, place]}, too",
                        "remove one",
                    )
                )
                break
            written_at[feature, place] = line
            readings = found.setdefault(feature, np.full(len(rows.rows_of(point)), np.nan))
            reading = np.array(to_si(values[column][row], kind, unit))
            if impossible(reading, CHANNELS[quantity]):
                wrong_parts.setdefault(name, []).append(f"{at}, {column} = {values[column][row]:g}")
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
    findings.extend(_gaps(found, rows.names, table.file))
    if orphans:
        findings.append(
            DataFinding(id="cut_file", weight="dropped",
                    text=f"{table.file}: {orphans} rows belong to points or repeats that {rows.table.file}, which ends "
                    "early, does not have")
        )  # fmt: skip
    if table.cut:
        text = f"{table.file} {table.cut}; export it again"
        findings.append(DataFinding(id="cut_file", weight="dropped", text=text))
    return found


def _has(rows: Rows, point: str, repeat: float) -> bool:
    return math.isfinite(repeat) and rows.place(point, int(repeat)) is not None


def _gaps(
    found: Mapping[Feature, NDArray[np.float64]], points: Sequence[str], file: str
) -> Iterator[DataFinding]:
    """Orders that stand in the table at some points and repeats, but not at all."""
    lines = dict.fromkeys((one.channel, one.order, one.part) for one in found)
    missing: dict[str, list[str]] = {}
    for channel, order, part in lines:
        for point in points:
            readings = found.get(Feature(channel, point, order, part))
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
