"""Motion of the drivetrain: periodic over speed, over a schedule in time, in events; orders of unequal teeth.

The dynamic factor of both meshes of `dynamics.rotor` at three speeds of the pinion:

>>> from math import pi
>>> from dynamics.rotor import LoopLoad, assemble
>>> from dynamics.vibration import periodic_response
>>> speeds = [rpm * pi / 30.0 for rpm in (1000.0, 2000.0, 3000.0)]
>>> curve = periodic_response(assemble(rig), (law, law), speeds, LoopLoad(torque=302.0))
>>> print([f"{test:.2f} {slave:.2f}" for test, slave in (point.dynamic_factor for point in curve.points)])
['1.04 1.06', '1.05 1.07', '1.06 1.05']
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from dynamics.vibration.deviation_response import DeviationResponse
    from dynamics.vibration.event_march import EventMarch
    from dynamics.vibration.response_curve import CurvePoint, ResponseCurve
    from dynamics.vibration.schedule import Schedule, Stage
    from dynamics.vibration.speed_sweep import SweepSettings, periodic_response
    from dynamics.vibration.steady_motion import TimeSettings, periodic_by_time
    from dynamics.vibration.time_response import run_schedule

__all__ = [
    "CurvePoint",
    "DeviationResponse",
    "EventMarch",
    "ResponseCurve",
    "Schedule",
    "Stage",
    "SweepSettings",
    "TimeSettings",
    "periodic_by_time",
    "periodic_response",
    "run_schedule",
]

_HOMES = {
    "CurvePoint": "response_curve",
    "DeviationResponse": "deviation_response",
    "EventMarch": "event_march",
    "ResponseCurve": "response_curve",
    "Schedule": "schedule",
    "Stage": "schedule",
    "SweepSettings": "speed_sweep",
    "TimeSettings": "steady_motion",
    "periodic_by_time": "steady_motion",
    "periodic_response": "speed_sweep",
    "run_schedule": "time_response",
}


def __getattr__(name: str) -> object:
    """Import a name on first use."""
    if name in _HOMES:
        return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
