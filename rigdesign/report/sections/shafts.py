"""Shafts and their bearings: lateral vibration; loads, friction, temperatures and life of rolling bearings."""

import math
from typing import Any

from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.lateral import StageLateral
from rigdesign.results.quantity import row, value_in_unit
from rigdesign.results.result import RunResult

HIGHEST_RATIO = 3.0
"""Modes are shown up to this times the fastest shaft, at least the lowest few."""
LEAST_MODES = 6
LOADS = (
    "bearing", "stage", "designation", "radial_load", "axial_load", "minimum_load", "speed", "speed_utilisation",
    "static_safety", "basic_life", "modified_life", "viscosity_ratio",
)  # fmt: skip
FRICTION = (
    "bearing", "stage", "rolling_torque", "sliding_torque", "seal_torque", "drag_torque", "friction", "heat_to_shaft",
    "heat_to_housing",
)  # fmt: skip
WARM = (
    "bearing", "stage", "temperature", "inner_ring", "outer_ring", "operating_clearance", "radial_stiffness",
    "axial_stiffness", "tilting_stiffness",
)  # fmt: skip


def _values(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures.vibration import whirl_figure

    lateral = result.lateral
    assert lateral is not None
    limits = {check.id: check.limit for check in result.checks}
    return {
        "modes": [mode for stage in lateral.stages for mode in _modes(stage)],
        "bearings": [
            {
                "bearing": bearing.bearing,
                "stage": stage.stage,
                **row(
                    bearing,
                    "shaft",
                    "amplitude",
                    "minor",
                    "clearance",
                    "clearance_share",
                    "force",
                    "static_load",
                ),
            }
            for stage in lateral.stages
            for bearing in stage.bearings
        ],
        "seats": [row(seat) for seat in lateral.seats],
        "seals": [
            {"seal": seal.seal, "stage": stage.stage, **row(seal, "shaft", "amplitude")}
            for stage in lateral.stages
            for seal in stage.seals
        ],
        "meshes": [
            {
                "mesh": mesh.mesh,
                "stage": stage.stage,
                "line": line,
                "force_N": force,
                "share": mesh.share([line]) if mesh.mean else None,
            }
            for stage in lateral.stages
            for mesh in stage.meshes
            for line, force in mesh.forces.items()
        ],
        "whirl_figure": draw(
            whirl_figure(lateral, limits.get("lateral.orbit")),
            "Motion once a turn in every bearing over speed, against the clearance of its film",
        ),
    }


def _modes(stage: StageLateral) -> list[dict[str, Any]]:
    """Lateral and torsional modes of a stage, the lowest first."""
    listed = [(i, mode) for i, mode in enumerate(stage.modes) if mode.family in ("lateral", "torsion")]
    highest = HIGHEST_RATIO * value_in_unit(stage, "speed") / 60.0
    near = [(i, mode) for i, mode in listed if mode.frequency <= highest]
    rows = []
    for number, mode in near if len(near) >= LEAST_MODES else listed[:LEAST_MODES]:
        against = stage.separation_of(number)
        rows.append(
            {
                "mode": mode.name,
                "stage": stage.stage,
                "torque": stage.torque,
                **row(mode, "frequency", "logarithmic_decrement"),
                "amplification": mode.amplification if math.isfinite(mode.amplification) else None,
                "margin": None if against is None else against.margin,
                "required_margin": None if against is None else against.required,
                "rigid_body": stage.as_rigid_body(mode),
            }
        )
    return rows


LATERAL = ReportSection(
    id="lateral", title="Lateral vibration", template="lateral.html.j2", values=_values,
    applies=lambda result: result.lateral is not None,
)  # fmt: skip


def _tables(result: RunResult, draw: Draw) -> Values:
    return {
        name: [row(bearing, *keys) for bearing in result.rolling_bearings]
        for name, keys in (("loads", LOADS), ("friction", FRICTION), ("warm", WARM))
    }


ROLLING_BEARINGS = ReportSection(
    id="rolling_bearings", title="Rolling bearings", template="rolling_bearings.html.j2", values=_tables,
    applies=lambda result: bool(result.rolling_bearings),
)  # fmt: skip
