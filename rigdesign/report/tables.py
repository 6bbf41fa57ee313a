"""Curves and tables as .csv: a header line with units in square brackets, dot as decimal sign."""

from collections.abc import Iterator
from typing import Any

from rigdesign.report.csv_text import csv_text
from rigdesign.report.fields import file_stem
from rigdesign.report.transient_tables import transient_tables
from rigdesign.results.result import (
    DynamicFactorPoint,
    DynamicsResult,
    GearboxDynamics,
    HeatRow,
    RampHistory,
    RunResult,
)


def curve_tables(result: RunResult) -> dict[str, str]:
    """Every table of a result: file name -> CSV text."""
    tables = {"checks.csv": _checks(result), "losses.csv": _losses(result), "oil.csv": _oil(result)}
    if result.thermal:
        tables["heat.csv"] = _heat(result)
    if result.expansion:
        tables["seal_gaps.csv"] = _seal_gaps(result)
    if result.dynamics is not None:
        tables.update(_dynamics(result.dynamics))
    tables.update(transient_tables(result.transient))
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
        "utilisation",
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


def _seal_gaps(result: RunResult) -> str:
    header = ("gearbox", "stage", "seal", "angle [deg]", "cold gap [mm]", "hot gap [mm]")
    rows = (
        (expansion.gearbox, expansion.stage, seal["seal"], angle, seal["cold_mm"], gap)
        for expansion in result.expansion
        for seal in expansion.seal_gaps
        for angle, gap in zip(seal.get("angle_deg", ()), seal.get("hot_mm", ()), strict=True)
    )
    return csv_text(header, rows)


def _dynamics(dynamics: DynamicsResult) -> Iterator[tuple[str, str]]:
    for name, gearbox in dynamics.gearboxes.items():
        yield f"{file_stem('dynamic_factor', name)}.csv", _dynamic_factor(gearbox)
        for history in gearbox.root_stress:
            header = ("rolling angle [deg]", "dynamic [N/mm2]", "quasi-static [N/mm2]")
            columns = (history.rolling_angle_deg, history.dynamic_MPa, history.quasi_static_MPa)
            rows = zip(*columns, strict=True)
            yield f"{file_stem('root_stress', name, history.gear)}.csv", csv_text(header, rows)
    if dynamics.ramp is not None:
        yield "ramp.csv", _ramp(dynamics.ramp)


def _dynamic_factor(gearbox: GearboxDynamics) -> str:
    """K_V(n): the curves of all torques and variants below each other, distinguished by the last two columns."""
    header = (
        "speed [rpm]",
        "max/mean [1]",
        "half peak-to-peak [1]",
        "ISO 6336-1 method B [1]",
        "method",
        "torque",
        "variant",
    )
    main = gearbox.torque
    curves = [
        (main, "", gearbox.dynamic_factor),
        *((torque, "", points) for torque, points in gearbox.dynamic_factor_at.items()),
        *((main, variant, points) for variant, points in gearbox.dynamic_factor_variants.items()),
    ]
    rows = (
        (*_factors(point), point.method, torque, variant)
        for torque, variant, points in curves
        for point in points
    )
    return csv_text(header, rows)


def _factors(point: DynamicFactorPoint) -> tuple[float, ...]:
    return (
        point.speed_rpm,
        point.simulated,
        point.simulated_half_peak_to_peak,
        point.iso_6336_1_method_b,
    )


def _ramp(ramp: RampHistory) -> str:
    envelopes = [
        (f"{name} {bound} [Nm]", values)
        for name, curves in ramp.torque.items()
        for bound, values in curves.items()
    ]
    header = ["time [s]", "stage", "speed [rpm]", "target torque [Nm]", "drive torque [Nm]"]
    columns = [ramp.time_s, ramp.stage, ramp.speed_rpm, ramp.target_torque_Nm, ramp.drive_torque_Nm]
    rows = zip(*columns, *(values for _, values in envelopes), strict=True)
    return csv_text([*header, *(title for title, _ in envelopes)], rows)
