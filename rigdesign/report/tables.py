"""Curves and tables as .csv: a header line with units in square brackets, dot as decimal sign."""

from typing import Any

from rigdesign.base.json_text import csv_text
from rigdesign.results.result import RunResult
from rigdesign.results.thermal import HeatRow


def curve_tables(result: RunResult) -> dict[str, str]:
    """Every table of a result: file name -> CSV text."""
    tables = {"checks.csv": _checks(result), "losses.csv": _losses(result), "oil.csv": _oil(result)}
    if result.thermal:
        tables["heat.csv"] = _heat(result)
    for name, columns in result.columns.items():
        tables[f"{name}.csv"] = csv_text(list(columns), zip(*columns.values(), strict=True))
    return tables


def _checks(result: RunResult) -> str:
    header = (
        "id",
        "title",
        "group",
        "role",
        "value",
        "comparison",
        "limit",
        "upper_limit",
        "unit",
        "margin",
        "distance",
        "verdict",
        "reason",
        "source",
    )
    return csv_text(header, ([getattr(check, name) for name in header] for check in result.checks))


def _losses(result: RunResult) -> str:
    header = (
        "place",
        "kind",
        "stage",
        "power [W]",
        "into oil [W]",
        "into body [W]",
        "no heat [W]",
        "from the pump [W]",
        "basis",
    )
    rows = (
        (
            r.place,
            r.kind,
            r.stage,
            r.power_W,
            r.into_oil_W,
            r.into_body_W,
            r.not_heat_W,
            r.pump_W,
            r.basis,
        )
        for r in result.losses
    )
    return csv_text(header, rows)


def _oil(result: RunResult) -> str:
    header = ("consumer", "stage", "inlet [degC]", "outlet [degC]", "flow [l/min]", "heat [W]")
    rows = ((r.consumer, r.stage, r.inlet_degC, r.outlet_degC, r.flow_l_min, r.heat_W) for r in result.oil)
    return csv_text(header, rows)


def _heat(result: RunResult) -> str:
    header = (
        "gearbox",
        "stage",
        "surface",
        "kind",
        "power into the solid [W]",
        "area [m2]",
        "mean temperature [degC]",
        "coefficient [W/(m2 K)]",
        "formula",
        "range",
        "source",
    )
    rows = (
        (
            case.gearbox,
            case.stage,
            row.surface,
            row.kind,
            row.power_W,
            row.area_m2,
            row.mean_temperature_degC,
            *_coefficient(row),
        )
        for case in result.thermal
        for row in case.heat
    )
    return csv_text(header, rows)


def _coefficient(row: HeatRow) -> tuple[Any, ...]:
    coefficient = row.coefficient or {}
    return tuple(coefficient.get(key) for key in ("value", "formula", "valid_range", "source"))
