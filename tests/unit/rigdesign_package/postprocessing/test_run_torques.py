"""Torques of the time run as records: the element that counts in a section, in every stage."""

from functools import cache

import numpy as np
import pytest

from dynamics.rotor.graph import TorqueSection
from dynamics.rotor.shaft import Section
from rigdesign.case import load_case
from rigdesign.coupling.time_run import schedule_of
from rigdesign.postprocessing.run_torques import run_torques
from rigdesign.results.serialisation.vibration import section_torque_rows
from rigdesign.results.vibration import SectionTorqueRecord
from rigdesign.rig.model import Rig, build_rig
from tests.builders.made_run import made_ramp
from tests.builders.paths import CASES

SHAFT = TorqueSection(
    kind="shaft", part="test_pinion", start=0.0, end=0.1, section=Section(length=0.1, outer_diameter=0.04)
)
SECTIONS = (SHAFT, SHAFT, TorqueSection(kind="coupling", part="pinion_side"))


@cache
def rig() -> Rig:
    return build_rig(load_case(CASES / "uhcf_prototype"), "quick")


def test_of_a_section_the_element_with_the_largest_torque_counts_in_every_stage() -> None:
    """Amount of the torque, half of its peak-to-peak and nominal shear 16 T/(pi d^3) by hand."""
    torques = {
        (0, "run_up"): (-103.0, -79.0), (1, "run_up"): (-131.0, -51.0), (2, "run_up"): (83.0, 101.0),
        (0, "test"): (170.0, 190.0),
    }  # fmt: skip
    found = {
        (one.place.name, one.stage): one for one in run_torques(rig(), made_ramp(rig(), SECTIONS, torques))
    }
    stages = [stage.name for stage in rig().case.schedule.resolved()]
    assert list(found) == [
        (name, s) for name in ("test_pinion 0 to 100 mm", "coupling pinion_side") for s in stages
    ]
    up, test = (found["test_pinion 0 to 100 mm", stage] for stage in ("run_up", "test"))
    assert (up.peak, up.half_peak_to_peak, up.mean) == (131.0, 40.0, 91.0)
    assert (test.peak, test.half_peak_to_peak, test.mean) == (190.0, 10.0, 180.0)
    assert up.shear_stress == pytest.approx(16.0 * 131.0 / (np.pi * 0.04**3))
    schedule = schedule_of(rig())
    began = float(schedule.starts[stages.index("run_up")])
    assert up.time == pytest.approx(began + 0.02, abs=1e-9)
    assert up.speed == pytest.approx(float(schedule.at(np.array([up.time])).speed[0]))
    coupling = found["coupling pinion_side", "run_up"]
    assert (coupling.peak, coupling.half_peak_to_peak, coupling.shear_stress) == (101.0, 9.0, None)
    quiet = found["coupling pinion_side", "test"]
    assert (quiet.peak, quiet.half_peak_to_peak) == (1.0, 0.0)


def test_every_stage_is_a_row() -> None:
    torques = {(1, "run_up"): (-131.0, -51.0)}
    run = run_torques(rig(), made_ramp(rig(), SECTIONS, torques))
    rows = section_torque_rows(SectionTorqueRecord(held=(), torque="", speeds=(), curves=(), run=run))[
        "time_run"
    ]
    row = next(row for row in rows if (row["place"], row["stage"]) == ("test_pinion 0 to 100 mm", "run_up"))
    assert (row["peak_Nm"], row["half_peak_to_peak_Nm"], row["mean_Nm"]) == (131.0, 40.0, 91.0)
    assert row["shear_stress_MPa"] == pytest.approx(16e-6 * 131.0 / (np.pi * 0.04**3))
    assert row["speed_rpm"] > 750.0


def test_a_run_that_did_not_look_has_none() -> None:
    assert run_torques(rig(), made_ramp(rig(), None)) == ()
