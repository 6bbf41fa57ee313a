"""The shipped prototype made short, so that tests can run its whole chain often."""

from rigdesign.case import Case

SHORTENED = {
    "schedule.stages.bracing.duration": "50 ms",
    "schedule.stages.to_transition_speed.duration": "100 ms",
    "schedule.stages.half_torque.duration": "50 ms",
    "schedule.stages.run_up.duration": "800 ms",
    "schedule.stages.full_torque.duration": "50 ms",
    "schedule.stages.test.duration": "100 ms",
    "schedule.stages.relief.duration": "50 ms",
    "schedule.stages.run_down.duration": "600 ms",
    "schedule.stages.to_start_torque.duration": "50 ms",
    "schedule.stages.to_standstill.duration": "100 ms",
    "drivetrain.motor.torque_limit": "200 N m",
    "numerics.curve_speeds": "5",
    "numerics.temperature_tolerance": "0.5 K",
    "numerics.growth_tolerance": "5 um",
    "numerics.torque_tolerance": "0.01",
}
"""A ramp of two seconds with a motor to match, five speeds of the curve, a loop of a tenth of its sharpness."""


def shortened_case(case: Case) -> Case:
    """The prototype, or a variant of it, with the short schedule and loose tolerances."""
    for path, value in SHORTENED.items():
        case = case.with_value(path, value)
    return case
