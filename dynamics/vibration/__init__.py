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

from typing import TYPE_CHECKING

import lazy_loader

if TYPE_CHECKING:
    from dynamics.vibration.deviation_response import DeviationResponse as DeviationResponse
    from dynamics.vibration.event_march import EventMarch as EventMarch
    from dynamics.vibration.response_curve import CurvePoint as CurvePoint
    from dynamics.vibration.response_curve import ResponseCurve as ResponseCurve
    from dynamics.vibration.schedule import Schedule as Schedule
    from dynamics.vibration.schedule import Stage as Stage
    from dynamics.vibration.speed_sweep import SweepSettings as SweepSettings
    from dynamics.vibration.speed_sweep import periodic_response as periodic_response
    from dynamics.vibration.steady_motion import TimeSettings as TimeSettings
    from dynamics.vibration.steady_motion import periodic_by_time as periodic_by_time
    from dynamics.vibration.time_response import run_schedule as run_schedule

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "deviation_response": ["DeviationResponse"],
        "event_march": ["EventMarch"],
        "response_curve": ["CurvePoint", "ResponseCurve"],
        "schedule": ["Schedule", "Stage"],
        "speed_sweep": ["SweepSettings", "periodic_response"],
        "steady_motion": ["TimeSettings", "periodic_by_time"],
        "time_response": ["run_schedule"],
    },
)
