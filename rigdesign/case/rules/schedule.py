"""Rules of the schedule: names, directions, what is held."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from rigdesign.base.errors import Fault
from rigdesign.base.units import show
from rigdesign.case.events import EmergencyStop, Overspeed, ToothLoss
from rigdesign.case.faults import unknown, written

if TYPE_CHECKING:
    from rigdesign.case.model import Case


def schedule_faults(case: "Case") -> Iterator[Fault]:
    """Everything wrong with the order and direction of the stages."""
    names = [stage.name for stage in case.schedule.stages]
    for name in dict.fromkeys(names):
        if names.count(name) > 1:
            yield Fault(
                f"schedule.stages.{name}",
                "",
                f"{names.count(name)} stages have this name",
                "rename all but one",
            )
    for stage in case.schedule.resolved():
        at = f"schedule.stages.{stage.name}"
        changes = {
            "speed": (stage.speed_start, stage.speed_end),
            "torque": (stage.torque_start, stage.torque_end),
        }
        rising = {"run_up": "speed", "load": "torque"}.get(stage.kind)
        falling = {"run_down": "speed", "unload": "torque"}.get(stage.kind)
        for quantity, (start, end) in changes.items():
            path, given = f"{at}.{quantity}", show(end, quantity)
            before = f"the stage before ends at {show(start, quantity)}"
            if quantity == rising and end <= start:
                yield Fault(
                    path, given, f"does not rise in a {stage.kind} stage, {before}", _direction(stage.kind)
                )
            elif quantity == falling and end >= start:
                yield Fault(
                    path, given, f"does not fall in a {stage.kind} stage, {before}", _direction(stage.kind)
                )
            elif quantity not in (rising, falling) and not math.isclose(
                start, end, rel_tol=1e-9, abs_tol=1e-9
            ):
                yield Fault(path, given, f"changes in a {stage.kind} stage, {before}", _direction(stage.kind))
        if stage.drive_torque is not None and stage.kind != "run_up":
            yield Fault(
                f"{at}.drive_torque", show(stage.drive_torque, "torque"),
                f"a {stage.kind} stage is speed controlled",
                "give a drive torque to a run_up stage only",
            )  # fmt: skip
        if stage.held and stage.kind != "dwell":
            yield Fault(
                f"{at}.held", "true", "only a dwell can be held at steady temperatures", "make it a dwell"
            )
        if stage.held and min(abs(stage.speed_end), abs(stage.torque_end)) <= 0.0:
            quantity, value = (
                ("speed", stage.speed_end) if not stage.speed_end else ("torque", stage.torque_end)
            )
            yield Fault(
                f"{at}.held", "true", f"its {quantity} is {show(value, quantity)}: loads, losses and temperatures of a "
                "held stage need a turning, loaded rig",
                "hold a dwell under speed and torque",
            )  # fmt: skip
    if not any(stage.held for stage in case.schedule.stages):
        yield Fault(
            "schedule.stages",
            "",
            "no stage is held",
            "write held = true in the dwell whose temperatures count",
        )
    for key, ends in (
        ("test_speed", [stage.speed_end for stage in case.schedule.held()]),
        ("test_torque", [stage.torque_end for stage in case.schedule.held()]),
    ):
        stated, kind = getattr(case.schedule, key), key.removeprefix("test_")
        if stated > 0.0 and not any(math.isclose(end, stated, rel_tol=1e-3) for end in ends):
            yield Fault(
                f"schedule.{key}", show(stated, kind),
                f"no held stage runs at it, they have {', '.join(show(end, kind) for end in ends)}: loads and "
                "temperatures would be those of the stages, load cycles and limits those of the test",
                f"write the {kind} of a held stage, or change both together",
            )  # fmt: skip
    if case.schedule.test_speed <= 0.0:
        yield Fault(
            "schedule.test_speed", show(case.schedule.test_speed, "speed"), "is not above 0 rpm", "correct it"
        )


def _direction(kind: str) -> str:
    what = {"run_up": "speed up", "run_down": "speed down", "load": "torque up", "unload": "torque down"}
    change = what.get(kind, "neither")
    return f"a {kind} stage changes the {change} and nothing else; correct the value or the kind of the stage"


# Rules of the events: parts that exist, speeds and torques that the rig runs at.


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
    couplings = [f"drivetrain.couplings.{name}" for name in case.power_circuit.couplings]
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
