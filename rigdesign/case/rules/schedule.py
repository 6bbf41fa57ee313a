"""Rules of the schedule: names, directions, what is held."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from rigdesign.base.errors import Fault
from rigdesign.base.units import show

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
