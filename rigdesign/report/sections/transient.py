"""Over time: thermal histories of the schedule and its events, loads in events."""

from rigdesign.report.sections.section import Draw, ReportSection, Values, gearbox_styles
from rigdesign.results.result import RunResult


def _histories(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures.transient import oil_power_figure, transient_figure

    found = result.transient
    assert found is not None
    styles = gearbox_styles(result)
    return {
        "transient_figures": {
            f"{curve.gearbox}, {curve.branch.replace('_', ' ')}": draw(
                transient_figure(found, curve, styles.get(curve.gearbox)),
                f"Temperatures and clearances of gearbox {curve.gearbox} over the thermal history {curve.branch}",
            )
            for curve in found.curves
        },
        "oil_power_figures": {
            power.branch.replace("_", " "): draw(
                oil_power_figure(found, power),
                f"Power of heaters and cooler over the thermal history {power.branch}",
            )
            for power in found.oil_power
        },
    }


def _computed(result: RunResult) -> bool:
    return result.transient is not None


TRANSIENT = ReportSection(
    id="transient",
    title="Over the schedule and its events",
    template="transient.html.j2",
    values=_histories,
    applies=_computed,
    place="appendix",
)


def _events(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures.transient import event_figure

    return {
        "event_figures": {
            event.name: draw(
                event_figure(event), f"Torque in couplings and meshes over the event {event.name}"
            )
            for event in result.events
            if event.time
        }
    }


EVENTS = ReportSection(
    id="events", title="Events", template="events.html.j2", values=_events,
    applies=lambda result: bool(result.events),
)  # fmt: skip
