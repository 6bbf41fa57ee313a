"""Checks of the dynamic loads: K_V, resonances, tooth contact and peaks on the ramp, mesh by mesh."""

import math
from collections.abc import Iterator
from typing import Any

from rigdesign.checks.rules import Rule, hold, not_applicable
from rigdesign.coupling.loads import signed_torque
from rigdesign.records.curves import speed_ranges
from rigdesign.records.solved_rig import NO_LIMIT, NO_LOADS, SolvedRig, worst
from rigdesign.results.result import Check, GearboxDynamics

RPM = 30.0 / math.pi
Found = tuple[float, str]
"""Value and how it came about."""
NOT_LOADED = "no stage turns under more than the start torque"


def checks(solved: SolvedRig) -> list[Check]:
    """All of them, mesh by mesh."""
    return [check for mesh in range(len(solved.rig.mesh_names)) for check in _of_mesh(solved, mesh)]


def _of_mesh(solved: SolvedRig, mesh: int) -> Iterator[Check]:
    limits = solved.case.limits.dynamics
    rows = (
        (
            "dynamic_factor", "K_V at the held stages", limits.dynamic_factor_maximum, "<=",
            "limits.dynamics.dynamic_factor_maximum; max/mean, P2 Formula 1", _dynamic_factor,
        ),
        (
            "ramp_peak", "highest torque of the loaded ramp over the test torque", limits.dynamic_factor_maximum, "<=",
            "limits.dynamics.dynamic_factor_maximum times the test torque; time run over the schedule", _ramp_peak,
        ),
        (
            "resonance_distance", "distance of held speeds from dangerous resonances",
            limits.resonance_distance_minimum, ">=",
            "limits.dynamics.resonance_distance_minimum; resonances by strength", _resonance,
        ),
        (
            "lift_off", "time without tooth contact in loaded stages", limits.lift_off_share_maximum, "<=",
            "limits.dynamics.lift_off_share_maximum; time run over the schedule", _lift_off,
        ),
        (
            "contact_margin", "least torque in loaded stages as a share of the mean",
            limits.contact_margin_minimum, ">=",
            "limits.dynamics.contact_margin_minimum; time run over the schedule", _contact_margin,
        ),
    )  # fmt: skip
    label = solved.label(mesh)
    for key, title, limit, comparison, source, value in rows:
        rule = Rule(
            id=f"dynamics.{key}.{label}", title=f"{title}, {label} gearbox", unit="-", source=source,
            group="dynamics", role=solved.role(mesh), limit=limit, comparison=">=" if comparison == ">=" else "<=",
        )  # fmt: skip
        if solved.run is None or limit is None:
            yield not_applicable(rule, NO_LOADS if solved.run is None else NO_LIMIT)
        elif (found := value(solved, mesh)) is None:
            yield not_applicable(rule, NOT_LOADED)
        else:
            yield hold(rule, *found)


def _result(solved: SolvedRig, mesh: int) -> GearboxDynamics:
    assert solved.dynamics is not None
    return solved.dynamics.gearboxes[solved.label(mesh)]


def _dynamic_factor(solved: SolvedRig, mesh: int) -> Found:
    return worst(
        (float(point.last.response.dynamic_factor[mesh]), f"stage {point.point.stage}")
        for point in solved.points
        if point.last.response is not None
    )


def _ramp_peak(solved: SolvedRig, mesh: int) -> Found | None:
    """Peak of the time run over the mean torque of the governing held stage."""
    response = solved.test.last.response
    assert response is not None
    row = max(loaded_stages(solved, mesh), key=lambda row: float(row["peak_Nm"]), default=None)
    if row is None:
        return None
    return (
        row["peak_Nm"] / float(response.mean[mesh]),
        f"{row['peak_Nm']:.1f} N m in stage {row['stage']}; highest K_V there "
        f"{row['dynamic_factor']:.2f}, at {row['speed_rpm']:.0f} rpm on {row['mean_Nm']:.0f} N m",
    )


def _resonance(solved: SolvedRig, mesh: int) -> Found:
    """Distance of the nearest dangerous resonance, or of the end of the speeds looked at: the lesser."""
    assert solved.run is not None
    rig, rows = solved.rig, _result(solved, mesh).resonances
    named = {round(torque, 6): name for name, (torque, _) in solved.run.curves.named.items()}
    shaft = rig.mesh_gear(mesh, 0).shaft
    found: list[Found] = []
    for point in solved.points:
        torque = round(signed_torque(rig, point.point), 6)
        held = point.point.speed
        low, high = speed_ranges(rig)[torque]
        end = min(held - low, high - held) / held
        searched = f"{low * RPM:.0f} to {high * RPM:.0f} rpm"
        found.append(
            (end, f"none dangerous nearer in {searched}, held {held * RPM:.0f} rpm: at least this far")
        )
        own = rig.shaft_speed(shaft, held) * RPM
        found += [
            (
                abs(row["speed_rpm"] - own) / own,
                f"{row['speed_rpm']:.0f} rpm{' or above' if row['at_end'] else ''} ({row['mode']}), held {own:.0f} rpm",
            )
            for row in rows
            if row["dangerous"] and row["torque"] == named[torque]
        ]
    value, reason = worst(found, smallest=True)
    near = near_crossings(solved, mesh, math.inf)
    if not near:
        return value, reason
    share, row = near[0]
    mode = (
        f"mode {row['mode']} ({row['shape']}), {row['frequency_Hz']:.0f} Hz, order {row['harmonic']} at "
        f"{row['speed_rpm']:.0f} rpm, {100.0 * share:.1f} % away"
    )
    return value, f"{reason}; nearest mode of the closed loop that the mesh excites: {mode}"


def near_crossings(solved: SolvedRig, mesh: int, within: float) -> list[tuple[float, dict[str, Any]]]:
    """Crossings of a mesh with modes of the closed loop that it excites, nearest first: share of a held speed, row.

    within : largest distance as a share of the held speed
    """
    assert solved.dynamics is not None
    rig, label = solved.rig, solved.label(mesh)
    shaft = rig.mesh_gear(mesh, 0).shaft
    speeds = [rig.shaft_speed(shaft, point.point.speed) * RPM for point in solved.points]
    found = [
        (min(abs(row["speed_rpm"] - own) / own for own in speeds), row)
        for row in solved.dynamics.loop_crossings
        if row["kind"] == "mesh" and row["order_of"] == label and row["excited"]
    ]
    return sorted((item for item in found if item[0] <= within), key=lambda item: item[0])


def _lift_off(solved: SolvedRig, mesh: int) -> Found | None:
    loaded = {row["stage"] for row in loaded_stages(solved, mesh)}
    if not loaded:
        return None
    rows = [row for row in _result(solved, mesh).lift_off if row["stage"] in loaded]
    if not rows:
        return 0.0, "no gap longer than 5 % of a mesh period in a loaded stage"
    return worst((float(row["share"]), f"stage {row['stage']}, {row['start_s']:.2f} s") for row in rows)


def _contact_margin(solved: SolvedRig, mesh: int) -> Found | None:
    found = [
        (
            float(row["least_share"]),
            f"{row['least_Nm']:.1f} N m at least in stage {row['stage']}, near {row['least_share_at_rpm']:.0f} rpm",
        )
        for row in loaded_stages(solved, mesh)
    ]
    return worst(found, smallest=True) if found else None


def loaded_stages(solved: SolvedRig, mesh: int) -> list[dict[str, Any]]:
    """Loads of the stages that carry more than the start torque while they turn."""
    light = solved.case.limits.bearing.start_torque_limit or 0.0
    loaded = {
        stage.name
        for stage in solved.case.schedule.resolved()
        if min(abs(stage.torque_start), abs(stage.torque_end)) > light
        and max(stage.speed_start, stage.speed_end) > 0.0
    }
    return [row for row in _result(solved, mesh).stage_loads if row["stage"] in loaded]
