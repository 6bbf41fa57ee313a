"""Shafts and their bearings: lateral vibration; loads, friction, temperatures and life of rolling bearings."""

from typing import Any

from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult

HIGHEST_RATIO = 3.0
"""Modes are shown up to this times the fastest shaft, at least the lowest few."""
LEAST_MODES = 6
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


def _values(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures.vibration import whirl_figure

    lateral = result.lateral
    assert lateral is not None
    limits = {check.id: check.limit for check in result.checks}
    return {
        "modes": [row for stage in lateral["stages"] for row in _modes(stage)],
        "bearings": [
            {
                "bearing": row["bearing"],
                "stage": stage["stage"],
                **{k: v for k, v in row.items() if k != "bearing"},
            }
            for stage in lateral["stages"]
            for row in stage["bearings"]
        ],
        "seats": lateral["seats"],
        "seals": [
            {"seal": row["seal"], "stage": stage["stage"], "shaft": row["shaft"], "orbit_um": row["orbit_um"]}
            for stage in lateral["stages"]
            for row in stage["seals"]
        ],
        "meshes": [
            {
                "mesh": row["mesh"],
                "stage": stage["stage"],
                "line": row["line"],
                "force_N": row["force_N"],
                "share": row["share"],
            }
            for stage in lateral["stages"]
            for row in stage["meshes"]
        ],
        "whirl_figure": draw(
            whirl_figure(lateral, limits.get("lateral.orbit")),
            "Motion once a turn in every bearing over speed, against the clearance of its film",
        ),
    }


def _modes(stage: dict[str, Any]) -> list[dict[str, Any]]:
    """Lateral and torsional modes of a stage, the lowest first."""
    listed = [mode for mode in stage["modes"] if mode["family"] in ("lateral", "torsion")]
    highest = HIGHEST_RATIO * stage["speed_rpm"] / 60.0
    near = [mode for mode in listed if mode["frequency_Hz"] <= highest]
    shown = near if len(near) >= LEAST_MODES else listed[:LEAST_MODES]
    return [
        {
            "mode": mode["mode"],
            "stage": stage["stage"],
            "torque": stage["torque"],
            "frequency_Hz": mode["frequency_Hz"],
            "logarithmic_decrement": mode["logarithmic_decrement"],
            "amplification": mode["amplification"],
            "margin": mode["margin"],
            "required_margin": mode["required_margin"],
            "rigid_body": mode["rigid_body"],
        }
        for mode in shown
    ]


LATERAL = ReportSection(
    id="lateral", title="Lateral vibration", template="lateral.html.j2", values=_values,
    applies=lambda result: result.lateral is not None,
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
