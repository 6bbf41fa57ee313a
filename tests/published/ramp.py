"""Rows of P2's ramp: the stages of Figure 9 in the shipped schedule, judged by the ramp rules."""

from collections.abc import Iterator

from dynamics.vibration.schedule import RampLimits, ramp_rules
from rigdesign.coupling.time_run import schedule_of
from tests.published.prototype import RPM, Prototype
from tests.published.rows import PublishedQuantity, ValidationRow, compare

SOURCE = "P2, Figure 9"
P2_LIMITS = RampLimits(
    standstill_torque=10.0,
    start_torque_limit=10.0,
    transition_speed=750.0 * RPM,
    run_up_share=0.5,
    test_torque=180.0,
    test_speed=12000.0 * RPM,
)


def ramp_rows(prototype: Prototype) -> Iterator[ValidationRow]:
    """Five numbers of the ramp and how many of its rules the schedule keeps."""
    case = prototype.rig.case
    stages = {stage.name: stage for stage in case.schedule.resolved()}
    values = (
        ("standstill-torque", "torque at standstill", 10.0, stages["bracing"].torque_end, "N m"),
        (
            "transition-speed",
            "speed of the first run-up",
            750.0,
            stages["to_transition_speed"].speed_end / RPM,
            "rpm",
        ),
        ("half-torque", "torque while running up", 90.0, stages["half_torque"].torque_end, "N m"),
        ("test-speed", "speed of the second run-up", 12000.0, stages["run_up"].speed_end / RPM, "rpm"),
        ("full-torque", "torque at test speed", 180.0, stages["full_torque"].torque_end, "N m"),
    )
    for name, quantity, published, computed, unit in values:
        yield compare(
            PublishedQuantity(id=f"P2-ramp-{name}", text=quantity, source=SOURCE, value=published, unit=unit),
            computed,
            "input",
            assumptions="input of the shipped schedule; durations are not printed",
        )
    rules = ramp_rules(schedule_of(prototype.rig), P2_LIMITS)
    held = sum(rule.holds for rule in rules)
    yield compare(
        PublishedQuantity(
            id="P2-ramp-rules",
            text=f"ramp rules of P2 that the schedule keeps, of {len(rules)}",
            source=SOURCE,
            printed="the order of the five steps",
            unit="1",
        ),
        float(held),
        "input",
        assumptions="; ".join(
            f"{rule.text} {rule.value:g} {rule.comparison} {rule.limit:g} N m" for rule in rules
        ),
    )
