"""Torque of every section and joint in the stages of the time run, from its readings at every sample."""

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.twist_rows import TorqueSection
from dynamics.response.time_response import TimeResponse
from rigdesign.coupling.time_run import schedule_of, stage_names
from rigdesign.results.vibration import RunTorque, TorquePlace
from rigdesign.rig.model import Rig

Indices = NDArray[np.int64]


def run_torques(rig: Rig, ramp: TimeResponse) -> tuple[RunTorque, ...]:
    """One entry for every section and joint in every stage of the schedule; none where the run read no torques."""
    if ramp.sections is None:
        return ()
    windows = ramp.windows
    stages = np.array(stage_names(schedule_of(rig), windows.time - 0.5 * windows.duration))
    members: dict[TorqueSection, list[int]] = {}
    for i, section in enumerate(ramp.sections.sections):
        members.setdefault(section, []).append(i)
    return tuple(
        _of_stage(ramp, section, np.array(own), stage, np.flatnonzero(stages == stage))
        for section, own in members.items()
        for stage in dict.fromkeys(stages.tolist())
    )


def _of_stage(
    ramp: TimeResponse, section: TorqueSection, own: Indices, stage: str, windows: Indices
) -> RunTorque:
    """Of the elements ``own`` of a section in some windows of the run."""
    sections, found = ramp.sections, ramp.windows
    assert sections is not None
    place = np.ix_(own, windows)
    swing = sections.half_peak_to_peak[place]
    element, window = np.unravel_index(int(swing.argmax()), swing.shape)
    peak = float(sections.peak[place].max())
    at = windows[window]
    return RunTorque(
        place=place_of(section),
        stage=stage,
        peak=peak,
        half_peak_to_peak=float(swing[element, window]),
        mean=abs(float(sections.mean[own[element], at])),
        time=float(found.time[at]),
        speed=float(found.speed[at]),
        shear_stress=shear_stress(section, peak),
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


def shear_stress(section: TorqueSection, torque: float) -> float | None:
    """Nominal torsional stress at the surface under a torque [N m] [Pa]; None of a joint."""
    return section.shear_per_torque * torque if section.section is not None else None
