"""Curves and tables as .csv: a header line with units in square brackets, dot as decimal sign."""

from rigdesign.base.json_text import csv_text
from rigdesign.results.quantity import row
from rigdesign.results.result import RunResult


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
    names = ("place", "kind", "stage", "power", "into_oil", "into_body", "not_heat", "pump", "basis")
    return csv_text(header, (list(row(item, *names).values()) for item in result.losses))


def _oil(result: RunResult) -> str:
    header = ("consumer", "stage", "inlet [degC]", "outlet [degC]", "flow [l/min]", "heat [W]")
    names = ("consumer", "stage", "inlet", "outlet", "flow", "heat")
    return csv_text(header, (list(row(item, *names).values()) for item in result.oil))


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
            *row(flow, "surface", "kind", "power", "area", "mean_temperature").values(),
            *(getattr(flow.coefficient, key, None) for key in ("value", "formula", "valid_range", "source")),
        )
        for case in result.thermal
        for flow in case.heat
    )
    return csv_text(header, rows)
