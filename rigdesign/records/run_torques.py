"""Largest alternating torque of every section and joint in the time run."""

from collections.abc import Sequence

import numpy as np

from dynamics.drivetrain.twist_rows import TorqueSection
from dynamics.response.time_response import TimeResponse
from rigdesign.coupling.time_run import schedule_of, stage_names
from rigdesign.results.section_torques import RunTorque, TorquePlace
from rigdesign.rig.model import Rig


def run_torques(rig: Rig, ramp: TimeResponse, sections: Sequence[TorqueSection]) -> tuple[RunTorque, ...]:
    """One entry for every section and joint; sections : (r,) of the springs that the run looked at."""
    peaks = ramp.sections
    if peaks is None:
        return ()
    names = stage_names(schedule_of(rig), peaks.time)
    worst: dict[TorqueSection, int] = {}
    for i, section in enumerate(sections):
        if peaks.half_peak_to_peak[i] > peaks.half_peak_to_peak[worst.setdefault(section, i)]:
            worst[section] = i
    return tuple(
        RunTorque(
            place=place_of(section),
            half_peak_to_peak=float(peaks.half_peak_to_peak[i]),
            mean=abs(float(peaks.mean[i])),
            time=float(peaks.time[i]),
            speed=float(np.interp(peaks.time[i], ramp.time, ramp.speed)),
            stage=names[i],
        )
        for section, i in worst.items()
    )


def place_of(section: TorqueSection) -> TorquePlace:
    """Place of a section or joint in records."""
    of_shaft = section.kind == "shaft"
    return TorquePlace(
        kind=section.kind,
        part=section.part,
        start=section.start if of_shaft else None,
        end=section.end if of_shaft else None,
    )
