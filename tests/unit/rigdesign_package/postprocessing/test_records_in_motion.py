"""Records of the 1:1 loop in motion: pair shares, root stress and strain rate, spectra, torques near a dwell."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from rigdesign.checks import dynamics
from rigdesign.checks.dwell_speeds import checks
from rigdesign.postprocessing.dwell_speeds import dwell_record
from rigdesign.postprocessing.dynamic_root import dynamic_root
from rigdesign.postprocessing.dynamics import SolvedLoads, _SolvedMesh
from rigdesign.postprocessing.dynamics_section import pair_shares, section_torque_record
from rigdesign.postprocessing.nearest_resonance import near_dwells
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.postprocessing.spectra import held_spectra, waterfalls
from rigdesign.results.teeth import DynamicRootCurve, DynamicRootRecord
from rigdesign.results.vibration import DwellRecord, Waterfall
from tests.builders.solved_loop import solved, solved_twisting

TEETH, TEST_SPEED, SLOW_SPEED = 28, 3500.0 * math.pi / 30.0, 120.0 * math.pi / 30.0
RPM = 30.0 / math.pi


@cache
def roots() -> DynamicRootRecord:
    return dynamic_root(solved().rig, solved().run)


@cache
def rise_and_fall() -> tuple[Waterfall, ...]:
    return tuple(waterfalls(solved().rig, solved().run))


def test_the_pairs_in_mesh_share_the_whole_force() -> None:
    """A pitch apart on the path stands the next pair: the shares of all pairs at one phase sum to one, moving and
    still."""
    found = list(pair_shares(solved().rig, solved().run))
    assert {one.mesh for one in found} == {"test", "reference"}
    for one in found:
        angle, pitch = np.array(one.angle), 2.0 * math.pi / TEETH
        phase = np.linspace(0.0, pitch, 41)[:-1] + angle[0]
        for values in (one.share, one.static_share):
            total = sum(
                np.interp(phase + turn * pitch, angle, values, left=0.0, right=0.0) for turn in range(3)
            )
            # the grid of the record cuts the corners where a pair comes and goes
            assert np.median(total) == pytest.approx(1.0, abs=0.01)
            assert np.abs(total - 1.0).max() < 0.1
        assert max(one.share) == pytest.approx(1.0)
        assert np.mean(one.force) < max(one.force) < 1.5


def test_the_line_load_over_the_face_is_the_force_of_the_most_loaded_pair() -> None:
    """Its integral over the face, times the base radius, is the highest torque that a pair carries: that of the mesh
    in single contact. At rest and in motion the crowned flank carries most at the same slice."""
    run = solved().run
    assert run is not None
    for mesh, one in enumerate(pair_shares(solved().rig, run)):
        face, load, still = (np.array(row) for row in (one.face, one.line_load, one.static_line_load))
        assert face.size == load.size == still.size > 4 and np.all(np.diff(face) > 0.0)
        assert face.mean() == pytest.approx(0.0, abs=1e-9)
        width = float(np.ptp(face)) / (face.size - 1)
        last = run.test.last
        radius = last.models[mesh].law.base_radius_1
        response = last.response
        assert response is not None
        carried = float(np.sum(load)) * width * radius
        assert carried == pytest.approx(max(one.force) * response.mean[mesh], rel=0.01)
        assert carried <= 1.001 * response.maximum[mesh]
        assert one.angle[0] <= one.most_loaded <= one.angle[-1]
        assert abs(int(np.argmax(load)) - int(np.argmax(still))) <= 1


def climb(curve: DynamicRootCurve) -> float:
    """Integral of the strain rate over time from the first angle of a curve to that of the highest strain [-]."""
    half = int(np.argmax(curve.strain)) + 1
    time, rate = np.array(curve.angle)[:half] / curve.speed, np.array(curve.strain_rate)[:half]
    return float(np.sum(0.5 * (rate[1:] + rate[:-1]) * np.diff(time)))


def test_the_strain_rate_is_the_derivative_of_the_strain_over_time() -> None:
    """Over angles that grow towards the tip: contact climbs the driving tooth from root to tip and the driven one the
    other way, so that one is strained where the other is relieved."""
    for curve in roots().curves:
        gained = max(curve.strain) - curve.strain[0]
        assert abs(climb(curve)) == pytest.approx(gained, rel=0.02)
    for mesh in ("test", "reference"):
        own = [curve for curve in roots().curves if curve.mesh == mesh and curve.stage]
        pinion, wheel = (next(curve for curve in own if curve.gear == gear) for gear in ("pinion", "wheel"))
        assert climb(pinion) * climb(wheel) < 0.0


def test_root_stress_of_a_creeping_tooth_is_the_quasi_static_one() -> None:
    """At 120 rpm the mesh frequency is 56 Hz, the first mode of the loop at 258 Hz; at 3500 rpm they part."""
    slow = [curve for curve in roots().curves if not curve.stage]
    fast = [curve for curve in roots().curves if curve.stage == "test"]
    assert len(slow) == len(fast) == 4 and not roots().missing
    for curve in slow:
        assert curve.in_motion
        assert curve.pinion_speed == pytest.approx(SLOW_SPEED)
        assert curve.ratio == pytest.approx(1.0, abs=0.03)
    assert max(abs(curve.ratio - 1.0) for curve in fast) > 2.0 * max(abs(curve.ratio - 1.0) for curve in slow)
    for one, other in zip(slow, fast, strict=True):
        assert max(one.quasi_static) == pytest.approx(max(other.quasi_static), rel=0.02)
        assert other.highest_rate / one.highest_rate == pytest.approx(TEST_SPEED / SLOW_SPEED, rel=0.25)


def test_waterfalls_cover_the_mesh_order_of_the_highest_speed_up_and_down() -> None:
    assert [(one.mesh, one.stage) for one in rise_and_fall()] == [
        (mesh, stage) for stage in ("run_up", "run_down") for mesh in ("test", "reference")
    ]
    for one in rise_and_fall():
        assert one.frequency[-1] == pytest.approx(1.25 * TEETH * TEST_SPEED / (2.0 * math.pi), rel=0.02)
        assert all(low < high for low, high in pairwise(one.speed))
        amplitude, speed, frequency = np.array(one.amplitude), np.array(one.speed), np.array(one.frequency)
        for row in np.flatnonzero(speed > 0.5 * TEST_SPEED):
            mesh = TEETH * speed[row] / (2.0 * math.pi)
            ridge = amplitude[row, np.abs(frequency - mesh) < 0.06 * mesh].max()
            between = amplitude[row, np.abs(frequency - 0.6 * mesh) < 0.06 * mesh].max()
            assert ridge > 5.0 * between


@pytest.mark.parametrize(
    ("find", "relative", "of_mean"),
    [(solved_twisting, 0.05, 2e-4), (solved, 0.05, 2e-4)],
    ids=["twist", "bend"],
)
def test_mesh_orders_of_the_time_run_are_those_of_the_periodic_response(
    find: Callable[[], SolvedRig], relative: float, of_mean: float
) -> None:
    """The march and harmonic balance at the held stage: first three mesh orders, no other line as high."""
    found = find()
    for one in held_spectra(found.rig, found.run):
        order, amplitude = np.array(one.order), np.array(one.amplitude)
        assert order[-1] > 3.0 * TEETH
        for number, expected in zip(one.harmonic_order, one.harmonic_amplitude, strict=True):
            if number < 3.1 * TEETH:
                here = amplitude[np.abs(order - number) < 0.3].max()
                assert here == pytest.approx(expected, rel=relative, abs=of_mean * one.mean)
        between = np.abs((order + 0.5 * TEETH) % TEETH - 0.5 * TEETH) > 2.0
        assert amplitude[between & (order > 2.5)].max() < 2e-3 * one.mean


@cache
def advice() -> DwellRecord:
    return dwell_of(solved())


def dwell_of(found: SolvedRig) -> DwellRecord:
    return dwell_record(found, section_torque_record(found, *found.vibration.torques))


BY_DISTANCE = ("resonances by strength", "peaks of the periodic response")
"""Ends of the sources of the checks on distances."""


def test_check_table_and_ramp_name_the_same_nearest_resonance() -> None:
    """With a share so low that shafts resonate: one distance by one function."""
    found = solved()
    limits = found.case.with_value("limits.dynamics.dangerous_force_share", 0.06)
    rig = replace(found.rig, case=limits)
    assert found.run is not None
    assert found.loads is not None
    (near,) = (one.nearest for one in near_dwells(rig, found.run, found.loads).values())
    assert near.resonance is not None
    own = replace(found, rig=rig)
    held = [check for check in (*dynamics.checks(own), *checks(own)) if check.source.endswith(BY_DISTANCE)]
    check = min(held, key=lambda check: check.value or 0.0)
    dwelling = dwell_of(replace(found, rig=rig))
    (stage,) = dwelling.stages
    assert stage.band is not None and stage.near is not None
    assert check.value == stage.near.distance == near.distance
    assert f"{near.resonance.speed * RPM:.0f} rpm" in check.reason
    dwell = next(step for step in dwelling.ramp if step.action == "dwell")
    assert f"peaks at {near.resonance.speed * RPM:.0f} rpm, " in dwell.reason
    assert stage.nearest_safe is None or dwell.speed * RPM == math.floor(stage.nearest_safe * RPM)


def test_bands_and_what_is_safe_fill_the_speeds_without_overlap() -> None:
    record = advice()
    assert record.low < record.high
    pieces = sorted([*record.safe, *((band.low, band.high) for band in record.bands)])
    for (_, end), (start, _) in pairwise(pieces):
        assert start >= end - 1e-9
    covered = sum(min(high, record.high) - max(low, record.low) for low, high in pieces)
    assert covered == pytest.approx(record.high - record.low)
    assert {"dynamic factor", "root stress", "shaft torque"} <= set(record.highest)


def test_a_mesh_whose_roots_carry_nothing_has_no_ratios() -> None:
    """Of two meshes that share a torque one may take all of it."""
    found = solved()
    assert found.run is not None
    mesh = SolvedLoads(found.rig, found.run).meshes["test"]
    assert isinstance(mesh, _SolvedMesh)
    stage = found.run.test.point.stage
    held = mesh._held[stage]
    idle = replace(held, static=tuple((path, 0.0 * stress) for path, stress in held.static))
    mesh.__dict__["_held"] = {stage: idle}
    assert mesh.root_stress_ratios == ()
