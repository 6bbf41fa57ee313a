"""Alternating torques of the time run as records: the element that counts in a section, its stage and speed."""

from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from dynamics.drivetrain.twist_rows import TorqueSection
from dynamics.response.state_reader import SectionPeaks
from rigdesign.case import load_case
from rigdesign.coupling.time_run import schedule_of
from rigdesign.records.run_torques import run_torques
from rigdesign.results.rows.section_torques import section_torque_rows
from rigdesign.results.section_torques import SectionTorqueRecord
from rigdesign.rig.model import Rig, build_rig
from tests.builders.paths import CASES

SECTIONS = (
    TorqueSection(kind="shaft", part="test_pinion", start=0.0, end=0.1),
    TorqueSection(kind="shaft", part="test_pinion", start=0.0, end=0.1),
    TorqueSection(kind="coupling", part="pinion_side"),
)


@cache
def rig() -> Rig:
    return build_rig(load_case(CASES / "uhcf_prototype"), "quick")


def run(sections: SectionPeaks | None) -> Any:
    schedule = schedule_of(rig())
    time = np.linspace(0.0, schedule.duration, 1000)
    return SimpleNamespace(sections=sections, time=time, speed=schedule.at(time).speed)


def test_of_a_section_the_element_with_the_largest_torque_counts() -> None:
    schedule = schedule_of(rig())
    up = next(i for i, stage in enumerate(schedule.stages) if stage.name == "run_up")
    middle = 0.5 * float(schedule.starts[up] + schedule.starts[up + 1])
    peaks = SectionPeaks(
        half_peak_to_peak=np.array([12.0, 40.0, 9.0]),
        mean=np.array([-90.0, -91.0, 92.0]),
        time=np.array([0.0, middle, middle]),
    )
    section, coupling = run_torques(rig(), run(peaks), SECTIONS)
    assert (section.half_peak_to_peak, section.mean, section.stage) == (40.0, 91.0, "run_up")
    assert section.speed == pytest.approx(float(schedule.at(np.array([middle])).speed[0]), rel=1e-3)
    assert (coupling.place.name, coupling.half_peak_to_peak) == ("coupling pinion_side", 9.0)
    record = SectionTorqueRecord(held=(), torque="", speeds=(), curves=(), run=(section, coupling))
    row = section_torque_rows(record)["time_run"][0]
    assert (row["place"], row["half_peak_to_peak_Nm"]) == ("test_pinion 0 to 100 mm", 40.0)


def test_a_run_that_did_not_look_has_none() -> None:
    assert run_torques(rig(), run(None), SECTIONS) == ()
