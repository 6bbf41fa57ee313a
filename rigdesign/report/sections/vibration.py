"""Vibration of the power circuit: modes over speed, dynamic torque, and at which speeds the rig may dwell."""

from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult


def held_speeds(result: RunResult) -> dict[str, float]:
    """Pinion speed of every held stage [rpm]."""
    torques = result.dynamics.section_torques if result.dynamics is not None else None
    return {row["stage"]: row["speed_rpm"] for row in torques["held"]} if torques else {}


def _vibration(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures.campbell import campbell_diagram
    from rigdesign.report.figures.section_torques import section_torque_figure

    dynamics = result.dynamics
    assert dynamics is not None
    shown: Values = {"campbell_figure": None, "torque_figure": None, "torques": []}
    held = held_speeds(result)
    if dynamics.campbell is not None and dynamics.campbell["modes"]:
        shown["campbell_figure"] = draw(
            campbell_diagram(dynamics.campbell, held), "Modes of the closed loop and excitation orders over speed"
        )
    if dynamics.section_torques is not None:
        shown["torque_figure"] = draw(
            section_torque_figure(dynamics.section_torques["over_speed"], held),
            "Half peak-to-peak torque in meshes, joints and shafts over speed",
        )
        shown["torques"] = _governing(dynamics.section_torques["held"])
    return shown


def _governing(held: list[dict[str, object]]) -> list[dict[str, object]]:
    """Of every part the row with the highest peak, in the order of the list."""
    found: dict[object, dict[str, object]] = {}
    for row in held:
        key = row["kind"], row["part"]
        if key not in found or float(str(row["peak_Nm"])) > float(str(found[key]["peak_Nm"])):
            found[key] = row
    return list(found.values())


def _turns(result: RunResult) -> bool:
    return result.dynamics is not None and result.dynamics.campbell is not None


VIBRATION = ReportSection(
    id="vibration", title="Vibration of the power circuit", template="vibration.html.j2", values=_vibration,
    applies=_turns,
)  # fmt: skip
VIBRATION_DETAILS = ReportSection(
    id="vibration_details", title="Dynamic torque by section", template="vibration_details.html.j2",
    applies=_turns, place="appendix",
)  # fmt: skip
