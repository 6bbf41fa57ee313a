"""Rules of the events: parts that exist, speeds and torques that the rig runs at."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rigdesign.base.errors import Fault
from rigdesign.base.units import show
from rigdesign.case.events import EmergencyStop, Overspeed, ToothLoss
from rigdesign.case.faults import unknown, written

if TYPE_CHECKING:
    from rigdesign.case.model import Case


def event_faults(case: "Case") -> Iterator[Fault]:
    """Everything wrong with the table ``events``."""
    if case.events and case.drivetrain is None:
        yield Fault(
            "events", "", "needs a drivetrain: nothing moves without one", "state drivetrain or leave it out"
        )
        return
    top = max(stage.speed_end for stage in case.schedule.resolved())
    most = max(stage.torque_end for stage in case.schedule.resolved())
    for name, event in case.events.items():
        at = f"events.{name}"
        if isinstance(event, Overspeed):
            if event.speed <= top:
                yield Fault(
                    f"{at}.speed", show(event.speed, "speed"),
                    f"is no overspeed: the schedule runs up to {show(top, 'speed')}",
                    "state a speed above it",
                )  # fmt: skip
        elif event.speed is not None and not 0.0 < event.speed <= top:
            yield Fault(
                f"{at}.speed", show(event.speed, "speed"),
                f"is not on the ramp: the schedule runs up to {show(top, 'speed')}",
                "state a speed above 0 and up to it, or leave it out for the test speed",
            )  # fmt: skip
        if event.torque is not None and not 0.0 < event.torque <= most:
            yield Fault(
                f"{at}.torque", show(event.torque, "torque"),
                f"is not on the ramp: the schedule goes up to {show(most, 'torque')}",
                "state a torque above 0 and up to it, or leave it out for the test torque",
            )  # fmt: skip
        if (
            isinstance(event, EmergencyStop)
            and event.stop_time is not None
            and event.stop_time <= event.brake_onset
        ):
            yield Fault(
                f"{at}.stop_time", show(event.stop_time, "time"),
                f"is not above brake_onset {show(event.brake_onset, 'time')}, in which the brake comes on",
                "state a longer stop_time, or a shorter brake_onset",
            )  # fmt: skip
        if isinstance(event, ToothLoss):
            yield from _tooth_loss(case, at, event)


def _tooth_loss(case: "Case", at: str, event: ToothLoss) -> Iterator[Fault]:
    meshes = [f"{box}.{mesh}" for box, own in case.gearboxes.items() for mesh in own.meshes]
    if event.mesh not in meshes:
        yield unknown(f"{at}.mesh", event.mesh, meshes, "mesh")
    if event.trip_time_maximum is not None and event.trip_time_maximum >= event.duration:
        yield Fault(
            f"{at}.trip_time_maximum", show(event.trip_time_maximum, "time"),
            f"is not below {show(event.duration, 'time')}, for which the event is followed",
            "raise duration or lower the limit",
        )  # fmt: skip
    if event.monitor is None:
        return
    assert case.drivetrain is not None
    couplings = [f"drivetrain.couplings.{name}" for name in case.drivetrain.couplings]
    bearings = [
        f"gearboxes.{box}.bearings.{name}" for box, own in case.gearboxes.items() for name in own.bearings
    ]
    if event.monitor not in (*couplings, *bearings):
        yield unknown(f"{at}.monitor", event.monitor, [*couplings, *bearings], "coupling or bearing")
    elif (event.monitor in couplings) != (event.trip_torque is not None):
        key = "trip_torque" if event.monitor in couplings else "trip_velocity"
        yield Fault(
            f"{at}.monitor",
            written(event.monitor),
            f"is watched by another quantity than {key}",
            f"give {key}",
        )
