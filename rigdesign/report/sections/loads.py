"""Ramp, dynamic factor, root stress, resonances."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from rigdesign.report.sections.section import Draw, ReportSection, Values, gearbox_styles
from rigdesign.results.dynamics import GearboxDynamics
from rigdesign.results.loads import HeldBracing
from rigdesign.results.quantity import row
from rigdesign.results.result import RunResult

if TYPE_CHECKING:
    from markupsafe import Markup


def _loads(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures import dynamics as figures
    from rigdesign.report.figures.dynamics import ramp_figure
    from rigdesign.report.figures.teeth import label, tooth_history_figure

    shown: Values = {
        "ramp_figure": None,
        "kv_figure": None,
        "root_stress": {},
        "contact": {},
        "gauges": {},
        "turn_figure": None,
    }
    dynamics = result.dynamics
    if dynamics is None:
        return shown
    if dynamics.ramp is not None and len(dynamics.ramp.time_s) > 1:
        shown["ramp_figure"] = draw(
            ramp_figure(dynamics.ramp), "Speed, torques and torque envelopes over time"
        )
    if any(gearbox.dynamic_factor for gearbox in dynamics.gearboxes.values()):
        shown["kv_figure"] = draw(
            figures.dynamic_factor_figure(dynamics),
            "Dynamic factor over speed, simulated and by ISO 6336-1",
        )
    first = [name for name in dynamics.gearboxes if _shown_first(result, name)]
    shown["root_stress"] = _root_stress(result, draw, first)
    shown["contact"] = _contact(result, draw, first)
    shown["gauges"] = _gauges(result, draw)
    shown["gauge_label"] = label
    if bent := [history for history in dynamics.tooth_histories if history.rated]:
        shown["turn_figure"] = draw(
            tooth_history_figure(bent), "Root stress in both fillets of a tooth over a turn of its gear"
        )
    return shown


def _details(result: RunResult, draw: Draw) -> Values:
    assert result.dynamics is not None
    rest = [name for name in result.dynamics.gearboxes if not _shown_first(result, name)]
    return {
        "root_stress": _root_stress(result, draw, rest),
        "contact": _contact(result, draw, rest),
        "bracing": [_bracing(held) for held in result.dynamics.bracing],
    }


def _bracing(held: HeldBracing) -> dict[str, Any]:
    """Warm, and as drawn what differs."""
    shown = row(held)
    as_drawn = {key: shown.pop(key) for key in list(shown) if "as_drawn" in key}
    first, *others = as_drawn.items()
    return shown | dict((first, ("torque_warm_Nm", shown["torque_Nm"]), *others))


def _root_stress(result: RunResult, draw: Draw, names: Sequence[str]) -> "dict[str, Markup]":
    from rigdesign.report.figures.dynamics import root_stress_figure

    assert result.dynamics is not None
    chosen = {name: result.dynamics.gearboxes[name] for name in names}
    return {
        name: draw(
            root_stress_figure(gearbox, gearbox_styles(result)[name]),
            f"Root stress of gearbox {name}, dynamic and quasi-static",
        )
        for name, gearbox in chosen.items()
        if _has_root_stress(gearbox)
    }


def _contact(result: RunResult, draw: Draw, names: Sequence[str]) -> "dict[str, Markup]":
    from rigdesign.report.figures.teeth import tooth_contact_figure

    assert result.dynamics is not None
    found = {name: result.dynamics.gearboxes[name].loaded_contact for name in names}
    return {
        name: draw(
            tooth_contact_figure(contact, gearbox_styles(result)[name]),
            f"Loaded contact and root stress of gearbox {name}",
        )
        for name, contact in found.items()
        if contact
    }


def _gauges(result: RunResult, draw: Draw) -> "dict[str, Markup]":
    """Stress at the strain gauges of every gearbox that has some and whose contact is known."""
    from rigdesign.report.figures.teeth import strain_gauge_figure

    assert result.dynamics is not None
    found = {name: gearbox.loaded_contact for name, gearbox in result.dynamics.gearboxes.items()}
    return {
        name: draw(
            strain_gauge_figure(contact),
            f"Root stress at the strain gauges of gearbox {name} over the rolling angle",
        )
        for name, contact in found.items()
        if contact and contact.get("strain_gauges")
    }


def _shown_first(result: RunResult, name: str) -> bool:
    """The mesh whose root stress stands in the body: the first specimen, else the first of all."""
    assert result.dynamics is not None
    gearboxes = result.dynamics.gearboxes
    drawn = [other for other, gearbox in gearboxes.items() if _has_root_stress(gearbox)]
    specimens = [other for other in drawn if gearboxes[other].role == "specimen"]
    return name in (specimens or drawn)[:1]


def _has_root_stress(gearbox: GearboxDynamics) -> bool:
    return bool(gearbox.root_stress or gearbox.root_stress_factor)


def _turns(result: RunResult) -> bool:
    return result.dynamics is not None


LOADS = ReportSection(id="loads", title="Ramp and loads", template="loads.html.j2", values=_loads)
LOAD_DETAILS = ReportSection(
    id="load_details", title="Dynamics in detail", template="load_details.html.j2", values=_details, applies=_turns,
    place="appendix",
)  # fmt: skip
