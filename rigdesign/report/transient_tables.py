"""The thermal course in the report and as curves: figures by course, one table of all steps a course."""

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from rigdesign.report.fields import file_stem
from rigdesign.results.transient import TransientCurve, TransientResult

if TYPE_CHECKING:
    from markupsafe import Markup
    from matplotlib.figure import Figure


def transient_figures(
    result: TransientResult | None, draw: Callable[["Figure", str], "Markup"]
) -> dict[str, Any]:
    """Figures of every course by its title; none without a thermal course."""
    if result is None:
        return {}
    from rigdesign.report.figures.transient import transient_figure

    return {
        f"{curve.gearbox}, {curve.branch.replace('_', ' ')}": draw(
            transient_figure(result, curve),
            f"Temperatures and clearances of gearbox {curve.gearbox} over the course {curve.branch}",
        )
        for curve in result.curves
    }


def oil_power_figures(
    result: TransientResult | None, draw: Callable[["Figure", str], "Markup"]
) -> dict[str, Any]:
    """Heaters and cooler of every course by its title; none without a thermal course."""
    if result is None:
        return {}
    from rigdesign.report.figures.transient import oil_power_figure

    return {
        curve.branch.replace("_", " "): draw(
            oil_power_figure(result, curve), f"Power of heaters and cooler over the course {curve.branch}"
        )
        for curve in result.oil_power
    }


def transient_tables(result: TransientResult | None) -> Iterator[tuple[str, str]]:
    """File name and CSV text of every course."""
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
