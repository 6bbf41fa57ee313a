"""Rolling bearings: loads, friction, temperatures, life."""

from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult

LOADS = (
    "bearing", "stage", "designation", "radial_load_N", "axial_load_N", "minimum_load_N", "speed_rpm",
    "speed_utilisation", "static_safety", "basic_life_h", "modified_life_h", "viscosity_ratio",
)  # fmt: skip
FRICTION = (
    "bearing", "stage", "rolling_torque_Nm", "sliding_torque_Nm", "seal_torque_Nm", "drag_torque_Nm", "friction_W",
    "heat_to_shaft_W", "heat_to_housing_W",
)  # fmt: skip
WARM = (
    "bearing", "stage", "temperature_degC", "inner_ring_degC", "outer_ring_degC", "operating_clearance_um",
    "radial_stiffness_N_um", "axial_stiffness_N_um", "tilting_stiffness_kNm_rad",
)  # fmt: skip


def _tables(result: RunResult, draw: Draw) -> Values:
    return {
        name: [{key: row[key] for key in keys} for row in result.rolling_bearings]
        for name, keys in (("loads", LOADS), ("friction", FRICTION), ("warm", WARM))
    }


ROLLING_BEARINGS = ReportSection(
    id="rolling_bearings", title="Rolling bearings", template="rolling_bearings.html.j2", values=_tables,
    applies=lambda result: bool(result.rolling_bearings),
)  # fmt: skip
