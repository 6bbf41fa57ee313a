"""The thermal histories as curves: one table of all steps a history."""

from collections.abc import Iterator
from typing import Any

from rigdesign.report.fields import file_stem
from rigdesign.results.transient import TransientCurve, TransientResult


def transient_tables(result: TransientResult | None) -> Iterator[tuple[str, str]]:
    """File name and CSV text of every thermal history."""
    from rigdesign.report.csv_text import csv_text

    for curve in () if result is None else result.curves:
        columns = _columns(curve)
        rows = zip(*columns.values(), strict=True)
        yield f"{file_stem('transient', curve.gearbox, curve.branch)}.csv", csv_text(list(columns), rows)
    for power in () if result is None else result.oil_power:
        columns = {
            "time [s]": power.time_s,
            "phase": power.phase,
            "heater [W]": power.heater_W,
            "cooler [W]": power.cooler_W,
            **{f"heat into {name} [W]": values for name, values in power.streams_W.items()},
        }
        rows = zip(*columns.values(), strict=True)
        yield f"{file_stem('transient', 'oil_power', power.branch)}.csv", csv_text(list(columns), rows)


def _columns(curve: TransientCurve) -> dict[str, list[Any]]:
    return {
        "time [s]": curve.time_s,
        "phase": curve.phase,
        "speed [rpm]": curve.speed_rpm,
        **{f"{place} [degC]": values for place, values in curve.temperatures_degC.items()},
        **{
            f"{quantity} {place} [mm]": values
            for quantity, places in curve.clearances_mm.items()
            for place, values in places.items()
        },
        **{
            f"{quantity} {place} [{unit}]": values
            for key, places in curve.alignment.items()
            for quantity, unit in (_named(key),)
            for place, values in places.items()
        },
    }


def _named(key: str) -> tuple[str, str]:
    """Quantity and unit of a key of the alignment: ``bearing_tilt_mrad``, ``bore_out_of_round``."""
    quantity, _, unit = key.rpartition("_")
    return (quantity, unit) if unit in ("mrad", "um", "mm") else (key, "1")
