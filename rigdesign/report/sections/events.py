"""Events: loads of parts when teeth break, in an emergency stop, at overspeed."""

from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult


def _events(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures.events import event_figure

    return {
        "event_figures": {
            event["name"]: draw(
                event_figure(event), f"Torque in couplings and meshes over the event {event['name']}"
            )
            for event in result.events
            if event["curves"]["time_s"]
        }
    }


EVENTS = ReportSection(
    id="events", title="Events", template="events.html.j2", values=_events,
    applies=lambda result: bool(result.events),
)  # fmt: skip
