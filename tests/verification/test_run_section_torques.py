"""Torques of sections in a time run: the modal state read in the march against angles and speeds, and how dense."""

import numpy as np
import pytest
from numpy.typing import NDArray

from dynamics.rotor.assembly import assemble_rig
from dynamics.rotor.craig_bampton import SeenRig, elastic_twist_rows, mesh_ports
from dynamics.rotor.graph import TwistRows, assemble, torsional_twist_rows
from dynamics.rotor.linear_system import DrivetrainOverSpeed, SpeedBands
from dynamics.rotor.reduction import reduce_rig
from dynamics.vibration.command import Command, MotorDrive, Sampling
from dynamics.vibration.event_march import Watched, torque_channels
from dynamics.vibration.time_response import TimeResponse, run_schedule
from tests.builders.elastic_rig import bearings, prototype_rig, running
from tests.builders.rig import prototype, prototype_laws

Array = NDArray[np.float64]
TORQUE = 180.0


def run(
    system: DrivetrainOverSpeed, command: Command, sections: TwistRows | None, **settings: float | int
) -> TimeResponse:
    """A run at 180 N m that reads torques."""
    sampling = Sampling(
        keep_accounts=False, sections=None if sections is None else lambda speed: sections,
        **{"cutoff": 20e3, **settings},  # type: ignore[arg-type]
    )  # fmt: skip
    return run_schedule(system, prototype_laws(), command, MotorDrive(torque_limit=100.0), sampling=sampling)


def test_torques_read_in_bands_are_those_of_angles_and_speeds() -> None:
    """Elastic rig that passes from one band to another, a window of one sample: the last one is stiffness and damping
    on angles and speeds of the freedoms at the end of the run."""
    rig = prototype_rig(0.03)
    model = assemble_rig(rig)
    seen = SeenRig(
        reduced=reduce_rig(model, bearings(rig), 20e3),
        ports={mesh.name: mesh_ports(model, mesh.name) for mesh in rig.drivetrain.meshes},
    )
    first, second = (seen.system(running(rig, speed)) for speed in (100.0, 140.0))
    rows = elastic_twist_rows(seen)
    command = Command(time=np.array([0.0, 0.5]), speed=np.array([100.0, 140.0]), torque=np.full(2, TORQUE))
    found = run(SpeedBands(limits=(110.0,), systems=(first, second)), command, rows, window=25e-6)
    assert found.speed[-1] > 112.0 and found.sections is not None
    exact = Watched(torque_channels(rows)).read(found.end)
    assert np.abs(exact).max() > 0.9 * TORQUE

    for read in (found.sections.least, found.sections.mean, found.sections.greatest):
        assert read.shape == (len(rows.sections), 20000)
        assert read[:, -1] == pytest.approx(exact, abs=1e-8 * TORQUE)  # roundings of stiff joints


def test_readings_at_40_khz_miss_little_of_the_torque_through_resonances() -> None:
    """Within a hundredth of readings twice as dense at the same steps: 720 rpm a second between 1000 and 1700 rpm,
    windows of 10 ms. Reading leaves the run as it is."""
    drivetrain = prototype()
    rows, system = torsional_twist_rows(drivetrain), assemble(drivetrain)
    command = Command(time=np.array([0.0, 1.0]), speed=np.array([100.0, 175.0]), torque=np.full(2, TORQUE))
    plain, read = run(system, command, None), run(system, command, rows)
    assert plain.sections is None and read.sections is not None
    assert np.array_equal(plain.torque, read.torque)
    dense = run(system, command, rows, sample_rate=80e3, substeps=4)
    assert dense.sections is not None
    share = read.sections.half_peak_to_peak.max(axis=1) / dense.sections.half_peak_to_peak.max(axis=1)
    assert share == pytest.approx(np.ones(len(share)), abs=0.01)
    assert read.sections.peak.max(axis=1) == pytest.approx(dense.sections.peak.max(axis=1), rel=0.01)
    # a section has the mean torque of its mesh, what drags and friction take aside
    coupling = next(i for i, section in enumerate(rows.sections) if section.kind == "coupling")
    assert np.abs(read.sections.mean[coupling, -1]) == pytest.approx(TORQUE, rel=0.03)


def test_modes_that_are_left_out_move_the_torque_of_a_seat_by_little() -> None:
    """At 12,000 rpm the mesh frequency of 19.8 kHz is next to the highest mode of 20 kHz: against all modes the
    alternating torque of every seat and coupling differs by less than three hundredths of the mean, what a held
    stage takes from its periodic response."""
    drivetrain = prototype()
    rows, system = torsional_twist_rows(drivetrain), assemble(drivetrain)
    speed = 12000.0 * np.pi / 30.0
    command = Command(time=np.array([0.0, 0.4]), speed=np.full(2, speed), torque=np.full(2, TORQUE))
    joints = [i for i, section in enumerate(rows.sections) if section.kind != "shaft"]
    found = [
        run(system, command, rows, cutoff=cutoff).sections.half_peak_to_peak[joints, -10:].max(axis=1)  # type: ignore[union-attr]
        for cutoff in (20e3, 1e9)
    ]
    assert found[0] == pytest.approx(found[1], abs=0.03 * TORQUE)
    assert found[1].max() > 0.01 * TORQUE
