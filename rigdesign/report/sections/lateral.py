"""Lateral vibration: modes with decrement and amplification, orbits in bearings and seals, whirl over speed."""

from typing import Any

from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult

HIGHEST_RATIO = 3.0
"""Modes are shown up to this times the fastest shaft, at least the lowest few."""
LEAST_MODES = 6


def _values(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures.lateral import whirl_figure

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
        }
        for mode in shown
    ]


LATERAL = ReportSection(
    id="lateral", title="Lateral vibration", template="lateral.html.j2", values=_values,
    applies=lambda result: result.lateral is not None,
)  # fmt: skip
