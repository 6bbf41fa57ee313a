"""Loads a measurement set: measurement.toml, its tables and recordings, held against the case."""

import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from rigdesign.base.errors import Fault, MeasurementError
from rigdesign.case import Case
from rigdesign.case.faults import faults_of, unknown, written
from rigdesign.measurement.places import Places
from rigdesign.measurement.processing.features import with_rates
from rigdesign.measurement.processing.impacts import read_impacts
from rigdesign.measurement.processing.recorded import Readings, SetPlan, read_recordings
from rigdesign.measurement.processing.sweeps import read_sweeps
from rigdesign.measurement.reading.columns import channels_of, column_faults, sensors_of
from rigdesign.measurement.reading.measurement_set import (
    COST_ITEMS,
    DataFinding,
    MeasurementFile,
    MeasurementSet,
)
from rigdesign.measurement.reading.rows import Rows, points_of, read_orders
from rigdesign.measurement.reading.table import digest_of, document_text, read_table, set_file

FILE = "measurement.toml"


def load_measurement(path: str | Path, case: Case) -> MeasurementSet:
    """Load a measurement set and hold it against the case.

    Parameters
    ----------
    path : folder with measurement.toml, or that file

    Raises
    ------
    MeasurementError
        With every fault found: key or cell, value, limit, remedy; and when no reading is left to use.
    """
    file = measurement_file(Path(path))
    content = _read(file)
    document = _validated(content, file)
    places = Places(case)
    folder = file.parent
    faults = [
        *_head_faults(document, file),
        *column_faults(document, places),
        *_doubt_faults(document),
        *_cost_faults(document),
    ]
    try:
        table = read_table(folder, document.data.table, document.data, with_units=True)
    except MeasurementError as error:
        raise MeasurementError([*faults, *error.faults], str(file)) from None
    rows = Rows(document, table)
    faults += rows.faults
    if faults:
        raise MeasurementError(faults, str(file))
    channels = channels_of(document, places)
    sensors = sensors_of(document)
    points, findings = points_of(document, sensors, rows)
    readings = rows.scalars(channels, points)
    findings += [*rows.findings(channels), *_doubts(document)]
    if document.case is not None and document.case != case.name:
        findings.append(
            DataFinding(
                id="other_case", weight="suspect",
                text=f"the set belongs to case {document.case}, compared is {case.name}; give its own case or correct "
                "the key 'case'",
            )
        )  # fmt: skip
    try:
        if document.data.orders is not None:
            readings |= read_orders(folder, document, channels, rows, readings, findings)
        plan = SetPlan(
            folder=folder, document=document, places=places, channels=channels, points=points, rows=rows
        )
        if document.data.recordings:
            readings |= read_recordings(plan, readings, findings)
        if document.data.impacts:
            readings = joined(readings, read_impacts(plan, findings))
        if document.data.sweeps:
            swept = read_sweeps(plan, findings)
            points += swept.points
            readings = joined(readings, swept.readings)
    except MeasurementError as error:
        raise MeasurementError(error.faults, str(file)) from None
    names = {"", *(point.name for point in points)}
    readings = {feature: values for feature, values in readings.items() if feature.setting in names}
    channels_read = {feature.channel for feature in readings}
    told = {name for finding in findings if finding.weight == "dropped" for name in finding.channels}
    findings += [
        DataFinding(
            id="missing_channel", weight="dropped", channels=(name,),
            text=f"{name}: no column, order or recording holds this channel; add it or remove [channels.{name}]",
        )
        for name in channels if name not in channels_read and name not in told
    ]  # fmt: skip
    if not readings:
        reasons = "; ".join(finding.text for finding in findings if finding.weight == "dropped")
        raise MeasurementError(f"no channel has a reading: {reasons}", str(file))
    try:
        hashed = digest_of(file, _named_files(folder, document))
    except MeasurementError as error:
        raise MeasurementError(error.faults, str(file)) from None
    loaded = MeasurementSet(
        title=document.title,
        folder=folder,
        case=case,
        baseline=None if document.baseline is None else (folder / document.baseline).resolve(),
        channels={name: channel for name, channel in channels.items() if name in channels_read},
        setting_sensors=sensors,
        points=points,
        readings=readings,
        findings=tuple(findings),
        costs=document.costs,
        hash=hashed,
        inspections={name: inspection.uncertainty for name, inspection in document.inspections.items()},
    )
    return with_rates(loaded)


def measurement_file(path: Path) -> Path:
    """measurement.toml of a folder, or the file itself; MeasurementError when there is none."""
    file = path / FILE if path.is_dir() else path
    if not file.is_file():
        problem = f"no {FILE} in this folder" if path.is_dir() else "no such file or folder"
        raise MeasurementError(f"{problem}; give the folder of a measurement set", str(path))
    return file


def _read(file: Path) -> dict[str, Any]:
    text = document_text(file)
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise MeasurementError(
            f"is not valid TOML or was cut off: {error}; correct it there", str(file)
        ) from None
    except ValueError as error:
        raise MeasurementError(f"holds a value that cannot be read: {error}; correct it", str(file)) from None
    except RecursionError:
        raise MeasurementError("is nested too deeply to be read; flatten its tables", str(file)) from None


def _validated(content: dict[str, Any], file: Path) -> MeasurementFile:
    tree = _tuples(content)
    try:
        return MeasurementFile.model_validate(tree)
    except ValidationError as error:
        raise MeasurementError(faults_of(error, MeasurementFile, tree), str(file)) from None


def _tuples(node: Any) -> Any:
    """The tree with tuples for lists, as strict models want them."""
    if isinstance(node, dict):
        return {key: _tuples(value) for key, value in node.items()}
    return tuple(_tuples(item) for item in node) if isinstance(node, list) else node


def _head_faults(document: MeasurementFile, file: Path) -> Iterable[Fault]:
    if document.baseline is None:
        return
    try:
        folder = (file.parent / document.baseline).resolve()
        exists = (folder / FILE).is_file()
    except (OSError, RuntimeError, ValueError) as error:
        shown = written(repr(document.baseline))
        yield Fault("baseline", shown, f"is no path: {error}", "write the path of the healthy set")
        return
    if folder == file.parent.resolve():
        yield Fault("baseline", written(document.baseline), "is this set itself", "name the healthy set")
    elif not exists:
        yield Fault(
            "baseline", written(document.baseline), f"no {FILE} in {folder}",
            "write the path of the healthy set from this folder",
        )  # fmt: skip


def _cost_faults(document: MeasurementFile) -> Iterable[Fault]:
    for item in document.costs:
        if item not in COST_ITEMS:
            yield unknown("costs", item, COST_ITEMS, "sensor or point")


def _doubt_faults(document: MeasurementFile) -> Iterable[Fault]:
    for number, doubt in enumerate(document.doubts):
        for name in doubt.channels:
            if name not in document.channels:
                yield unknown(f"doubts[{number}].channels", name, tuple(document.channels), "channel")


def _doubts(document: MeasurementFile) -> Iterable[DataFinding]:
    """What the writer of the set suspects of it."""
    for doubt in document.doubts:
        yield DataFinding(
            id="doubt", weight="suspect", channels=doubt.channels,
            text=f"{doubt.what}: {doubt.size} ({doubt.source})",
        )  # fmt: skip


def joined(first: Readings, second: Readings) -> Readings:
    """Readings of both: of a feature that both have one after the other."""
    both = first.keys() & second.keys()
    return {**first, **second} | {
        feature: np.concatenate([first[feature], second[feature]]) for feature in both
    }


def _named_files(folder: Path, document: MeasurementFile) -> list[Path]:
    """Files that hold the readings."""
    data = document.data
    names = [data.table, *([data.orders] if data.orders else []), *(entry.file for entry in data.recordings)]
    names += [entry.file for entry in data.sweeps] + [entry.file for entry in data.impacts]
    return [set_file(folder, name, data.size_limit) for name in names]
