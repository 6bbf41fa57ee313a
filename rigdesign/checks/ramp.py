"""Checks of the schedule: ramp rules, start torque, limits of bought parts."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from dynamics.ramp import RampLimits, ramp_rules
from rigdesign.case.limits import BoughtPart
from rigdesign.checks.subject import NO_HOUSING, NO_LIMIT, NO_LOADS, Subject, worst
from rigdesign.checks.thermal import transition_speed_rpm
from rigdesign.kinds import KINDS
from rigdesign.ramp_run import schedule_of
from rigdesign.results import Check
from rigdesign.rules import Rule, hold, not_applicable
from rigdesign.units import display

RPM = 30.0 / math.pi
SOURCES = {
    "ramp.standstill_torque": "limits.ramp.standstill_torque",
    "ramp.start_torque": "limits.bearing.start_torque_limit",
    "ramp.run_up_torque": "limits.ramp.run_up_torque_share_maximum",
    "ramp.test_torque": "schedule.test_torque",
}


def checks(subject: Subject) -> list[Check]:
    """Ramp rules of the paper, the transition speed they rest on, then the bought parts."""
    return [
        *_ramp(subject),
        _transition(subject),
        *(_bought(subject, name, part) for name, part in subject.case.limits.bought_parts.items()),
    ]


def _ramp(subject: Subject) -> Iterator[Check]:
    """The rules of the paper, each where the case states what it needs."""
    case, limits = subject.case, subject.case.limits
    start, share = limits.bearing.start_torque_limit, limits.ramp.run_up_torque_share_maximum
    floating = limits.ramp.transition_speed
    stated = {
        "ramp.standstill_torque": limits.ramp.standstill_torque is not None,
        "ramp.start_torque": start is not None and floating is not None,
        "ramp.run_up_torque": share is not None and floating is not None,
        "ramp.test_torque": True,
    }
    rig = subject.rig
    rules = ramp_rules(
        schedule_of(rig),
        RampLimits(
            standstill_torque=rig.torque_ratio * (limits.ramp.standstill_torque or 0.0),
            start_torque_limit=rig.torque_ratio * (start or 0.0),
            transition_speed=rig.pinion_speed(floating or 0.0),
            test_speed=rig.pinion_speed(case.schedule.test_speed),
            test_torque=rig.torque_ratio * case.schedule.test_torque,
            run_up_share=share or 0.0,
        ),
    )
    for entry in rules:
        rule = Rule(
            id=entry.id, title=entry.text, unit="N m", source=SOURCES.get(entry.id, "P2, Figure 9"), group="ramp",
            limit=entry.limit if stated[entry.id] else None, comparison=entry.comparison,
        )  # fmt: skip
        if not stated[entry.id]:
            yield not_applicable(rule, NO_LIMIT)
        elif not entry.stage:
            yield not_applicable(rule, "no stage of the schedule runs there")
        else:
            yield _exact(hold(rule, entry.value, f"stage {entry.stage} at {entry.time:.2f} s"))


def _exact(check: Check) -> Check:
    """A ramp is commanded, not predicted: a rule met to the digit is met, not near its limit."""
    if check.verdict == "warn" and check.margin is not None and check.margin >= 0.0:
        return replace(check, verdict="pass")
    return check


def _saturated(subject: Subject) -> str:
    """Why the torque found may be less than what was asked: the run stood at the limit of the motor."""
    run, power = subject.run, subject.case.drivetrain
    if run is None or power is None:
        return ""
    controlled = np.array([stage.drive_torque is None for stage in subject.case.schedule.resolved()])
    stage = schedule_of(subject.rig).at(run.ramp.time).stage
    full = np.abs(run.ramp.drive_torque) >= (1.0 - 1e-9) * power.motor.torque_limit
    share = float(np.mean(full & controlled[stage]))
    if not share:
        return ""
    return (
        f"the motor stands at drivetrain.motor.torque_limit for {100.0 * share:.1f} % of the run: the speed control "
        "asked for more; raise the limit to see how much"
    )


def _transition(subject: Subject) -> Check:
    """The computed transition speed under the start torque against the one the ramp relies on."""
    limit = subject.case.limits.ramp.transition_speed
    rule = Rule(
        id="bearing.transition_speed", title="transition speed of the bearings under the start torque", unit="rpm",
        source="Vogelpohl, against limits.ramp.transition_speed", group="bearings",
        limit=None if limit is None else limit * RPM,
    )  # fmt: skip
    start = subject.case.limits.bearing.start_torque_limit
    if limit is None or start is None or not any(point.point.torque for point in subject.points):
        return not_applicable(rule, NO_LIMIT)
    value, where = transition_speed_rpm(subject, start)
    return hold(rule, value, f"{where}, load of the start torque")


def _bought(subject: Subject, name: str, part: BoughtPart) -> Check:
    unit = KINDS[part.kind].display_unit
    rule = Rule(
        id=f"bought_part.{name}", title=f"{part.title} ({part.part})", unit=unit, source=part.source,
        group="bought parts", limit=display(part.limit_si, part.kind),
    )  # fmt: skip
    value: float | None
    value, reason = part.given_si, "given in the case"
    if value is None:
        value, reason = _result(subject, part.quantity)
    if value is None:
        return not_applicable(rule, reason)
    shown = display(value, part.kind)
    check = hold(rule, shown, reason, doubt=_saturated(subject) if part.quantity == "drive_torque" else "")
    return _exact(check) if part.quantity in ("speed", "torque_mean", "oil_flow") else check


def _result(subject: Subject, quantity: str) -> tuple[float | None, str]:
    """A result of the run [SI] and where it occurs; None with the reason where there is none."""
    case, schedule = subject.case, subject.case.schedule
    simple: dict[str, tuple[float, str]] = {
        "speed": (max(stage.speed_end for stage in schedule.resolved()), "schedule"),
        "torque_mean": (max(abs(stage.torque_end) for stage in schedule.resolved()), "schedule"),
        "circulating_power": worst(
            (abs(stage.torque_end) * stage.speed_end, f"stage {stage.name}") for stage in schedule.resolved()
        ),
        "oil_flow": worst((float(row["flow_l_min"]) / 6e4, "all circuits") for row in subject.cooler),
    }
    if quantity in simple:
        return simple[quantity]
    if quantity in ("shaft_growth", "temperature_maximum", "seal_surface_velocity") and not subject.growth:
        return None, NO_HOUSING
    if quantity == "shaft_growth":
        return worst((1e-3 * s["growth_mm"], s["shaft"]) for r in subject.growth for s in r.shafts)
    if quantity == "temperature_maximum":
        return worst((r.max_temperature_degC + 273.15, r.max_temperature_body) for r in subject.thermal)
    if quantity == "seal_surface_velocity":
        return worst(
            (
                0.5 * shaft.seal_diameter * subject.rig.shaft_speed(shaft.name, case.schedule.test_speed),
                shaft.name,
            )
            for geometry in subject.rig.geometries.values()
            for shaft in geometry.shafts
        )
    if subject.run is None or subject.dynamics is None:
        return None, NO_LOADS
    ramp = subject.run.ramp
    if quantity == "torque_peak":
        return worst((box.dynamic_torque_peak_Nm, name) for name, box in subject.dynamics.gearboxes.items())
    if quantity == "drive_torque":
        return float(abs(ramp.drive_torque).max()), "time run over the schedule"
    if quantity == "drive_power":
        return float(abs(ramp.drive_torque * ramp.speed).max()), "time run over the schedule"
    return worst(
        (row["actuator_force_N"] + row["spline_friction_N"], f"stage {row['stage']}")
        for row in subject.dynamics.bracing
    )
