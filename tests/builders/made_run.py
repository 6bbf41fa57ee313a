"""A time run that was not marched: what its windows read is known."""

from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any

import numpy as np

from dynamics.rotor.graph import TorqueSection
from dynamics.vibration.propagator import SectionEnvelopes
from dynamics.vibration.time_response import EnvelopeWindows
from rigdesign.coupling.time_run import schedule_of, stage_names
from rigdesign.postprocessing.curves import Curves
from rigdesign.postprocessing.dynamics import DynamicRun
from rigdesign.rig.model import Rig

Torques = Mapping[tuple[int, str], tuple[float, float]]
"""(number of a spring, stage) -> least and greatest torque [N m] in the second of its windows."""


def made_ramp(rig: Rig, sections: tuple[TorqueSection, ...] | None, torques: Torques | None = None) -> Any:
    """Windows of 10 ms over the schedule of the case: every spring carries 1 N m but where ``torques`` says more."""
    schedule = schedule_of(rig)
    count = round(schedule.duration / 0.01)
    time = 0.01 * np.arange(1, count + 1)
    none = np.zeros((0, count))
    windows = EnvelopeWindows(
        duration=0.01, time=time, speed=schedule.at(time).speed, least=none, mean=none, greatest=none,
        out_of_contact=none, longest_gap=none,
    )  # fmt: skip
    if sections is None:
        return SimpleNamespace(windows=windows, sections=None, cut="")
    least, greatest = np.ones((2, len(sections), count))
    stages = np.array(stage_names(schedule, time - 0.005))
    for (spring, stage), (low, high) in (torques or {}).items():
        at = np.flatnonzero(stages == stage)[1]
        least[spring, at], greatest[spring, at] = low, high
    read = SectionEnvelopes(sections=sections, least=least, mean=0.5 * (least + greatest), greatest=greatest)
    return SimpleNamespace(windows=windows, sections=read, cut="")


def made_run(rig: Rig, points: Any, ramp: Any, curves: Curves | None = None) -> DynamicRun:
    """Of held points, a ramp and, where they are asked for, curves."""
    return DynamicRun(tuple(points), curves, ramp)  # type: ignore[arg-type]
