"""Ramp, dynamic factor, root stress, resonances."""

from rigdesign.report.sections.gearbox_styles import gearbox_styles
from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.dynamics import GearboxDynamics
from rigdesign.results.result import RunResult


def _loads(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures import dynamics as figures
    from rigdesign.report.figures.ramp import ramp_figure

    shown: Values = {"ramp_figure": None, "kv_figure": None, "campbell": None, "root_stress": {}}
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
    if dynamics.crossings:
        shown["campbell"] = draw(
            figures.campbell_figure(dynamics), "Mesh orders and natural frequencies over speed"
        )
    for name, gearbox in dynamics.gearboxes.items():
        if _has_root_stress(gearbox):
            shown["root_stress"][name] = draw(
                figures.root_stress_figure(gearbox, gearbox_styles(result)[name]),
                f"Root stress of gearbox {name}, dynamic and quasi-static",
            )
    return shown


def _has_root_stress(gearbox: GearboxDynamics) -> bool:
    return bool(gearbox.root_stress or gearbox.root_stress_factor)


LOADS = ReportSection(id="loads", title="Ramp and loads", template="loads.html.j2", values=_loads)
