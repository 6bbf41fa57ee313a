"""Torques of sections, joints and meshes of the settled prototype at quick fidelity, as one record."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rigdesign.coupling.loop_system import twist_rows_of
from rigdesign.postprocessing.curves import Curves, chosen, curve_at
from rigdesign.postprocessing.dynamics_section import section_torque_record
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.results.vibration import SectionTorqueRecord
from tests.builders.made_run import made_ramp, made_run
from tests.builders.warm_prototype import base

RPM = np.pi / 30.0


@cache
def curves() -> Curves:
    """Between 11,000 and 12,500 rpm in steps of 500 rpm, the test speed among them."""
    rig, point = base()
    curve = curve_at(rig, point.last, 180.0, (11000.0 * RPM, 12500.0 * RPM))
    return Curves(response=curve, others={}, torque=180.0)


@cache
def record() -> SectionTorqueRecord:
    rig, point = base()
    assert point.last.system is not None
    sections = twist_rows_of(rig).sections
    seat = next(i for i, one in enumerate(sections) if one.part == "test.pinion")
    ramp = made_ramp(rig, sections, {(seat, "test"): (140.0, 220.0), (seat, "run_down"): (30.0, 150.0)})
    loads: Any = SimpleNamespace(
        meshes={
            label: SimpleNamespace(stage_loads=[SimpleNamespace(stage="test", peak=200.0)])
            for label in rig.mesh_labels.values()
        }
    )
    solved = SolvedRig(rig=rig, points=(point,), run=made_run(rig, [point], ramp, curves()), loads=loads)
    return section_torque_record(solved, *solved.vibration.torques)


def test_held_torques_carry_the_peaks_of_the_run_in_their_stage() -> None:
    held = {torque.place.name: torque for torque in record().held}
    assert held["spline test.pinion"].run_peak == 220.0
    assert held["coupling pinion_side"].run_peak == 1.0
    assert held["mesh test"].run_peak == 200.0
    assert {torque.stage for torque in record().held} == {"test"}
    runs = {(torque.place.name, torque.stage): torque for torque in record().run}
    assert runs["spline test.pinion", "run_down"].half_peak_to_peak == 60.0


def test_the_loop_carries_its_torque_all_round() -> None:
    """Mean torque at the held stage: seat, shaft and coupling of the pinion line carry the torque of the test mesh and
    what bearings and churning take, less than a twentieth; free ends of the shafts carry no more than that."""
    held = {torque.place.name: torque.swing for torque in record().held}
    mesh = held["mesh test"].mean
    assert mesh == pytest.approx(180.0, rel=1e-3)
    for name in ("spline test.pinion", "test_pinion 211 to 293 mm", "coupling pinion_side"):
        assert mesh < held[name].mean < 1.05 * mesh
    assert held["test_pinion 0 to 82 mm"].mean < 0.05 * mesh
    for swing in held.values():
        assert swing.mean <= swing.peak <= swing.mean + 2.0 * swing.half_peak_to_peak + 1e-9


def test_the_curve_at_the_held_speed_is_the_held_stage() -> None:
    """Found with the loop of the nearest of a few speeds, which is that of the held stage."""
    found = record()
    at = int(np.argmin(np.abs(np.array(found.speeds) - 12000.0 * RPM)))
    assert found.speeds[at] == pytest.approx(12000.0 * RPM, rel=1e-9)
    curve = {one.place: one for one in found.curves}
    assert len(curve) == len(found.held)
    for torque in found.held:
        swing = curve[torque.place].swings[at]
        assert swing.mean == pytest.approx(torque.swing.mean, rel=2e-3, abs=0.05)
        assert swing.half_peak_to_peak == pytest.approx(torque.swing.half_peak_to_peak, rel=0.03, abs=0.1)


def test_few_speeds_are_chosen_with_every_peak_of_a_mesh() -> None:
    """A resonance between two of the even ones stays."""
    swing = np.zeros((101, 1))
    swing[37], swing[36], swing[38] = 1.0, 0.5, 0.5
    points: Any = [
        SimpleNamespace(speed=float(i), dynamic_factor_half_peak_to_peak=row) for i, row in enumerate(swing)
    ]
    found = [point.speed for point in chosen(points, 11)]
    assert 37.0 in found and found[0] == 0.0 and found[-1] == 100.0 and found == sorted(found)
    assert chosen(points, 200) == points


def test_held_torques_are_those_of_the_teeth_that_the_response_was_found_with() -> None:
    """Teeth warmed anew on another mesh stand at another approach: temperatures count from them, torques do not."""
    rig, point = base()
    (model, *others) = point.last.models
    moved = replace(model, law=model.law._replace(gap=model.law.gap + 5e-6))
    warmed = replace(point, last=replace(point.last, models=(moved, *others)))
    own = SolvedRig(rig=rig, points=(point,), run=made_run(rig, [point], None))
    final = SolvedRig(rig=rig, points=(warmed,), run=made_run(rig, [point], None))
    assert final.held_torques == own.held_torques
    assert SolvedRig(rig=rig, points=(warmed,)).held_torques != own.held_torques
