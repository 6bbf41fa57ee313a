"""Torques of sections in a time run: the modal state read in the march against angles and speeds, and a resonance."""

from typing import NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray

from dynamics.drivetrain.graph import assemble
from dynamics.drivetrain.speed_bands import DrivetrainOverSpeed, SpeedBands
from dynamics.drivetrain.twist_rows import TwistRows, torsional_twist_rows
from dynamics.elastic_rig.assembly import assemble_rig
from dynamics.elastic_rig.mesh_rows import mesh_ports
from dynamics.elastic_rig.reduction import reduce_rig
from dynamics.elastic_rig.seen_system import SeenRig
from dynamics.elastic_rig.twist_rows import elastic_twist_rows
from dynamics.response import state_reader, time_march, time_response
from dynamics.response.command import Command, MotorDrive, Sampling
from dynamics.response.event_channels import Watched, torque_channels
from dynamics.response.state_reader import Glance, SectionPeaks, section_peaks
from dynamics.response.time_response import TimeResponse, run_schedule
from tests.builders.elastic_rig import bearings, prototype_rig, running
from tests.builders.rig import prototype, prototype_laws

Array = NDArray[np.float64]
TORQUE = 180.0


class Seen(NamedTuple):
    """A run, its glances, and the torques that `section_peaks` was given."""

    run: TimeResponse
    glances: list[Glance]


def looked_at(
    system: DrivetrainOverSpeed,
    command: Command,
    sections: TwistRows | None,
    stretch: int = state_reader.STRETCH,
) -> Seen:
    """A run at 180 N m whose glances are kept."""
    kept: list[Glance] = []

    def noted(glances: list[Glance], slow: Array) -> SectionPeaks:
        kept.extend(glances)
        return section_peaks(glances, slow)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(time_response, "section_peaks", noted)
        patch.setattr(state_reader, "STRETCH", stretch)
        sampling = Sampling(keep_accounts=False, cutoff=20e3, sections=sections)
        motor = MotorDrive(torque_limit=100.0)
        return Seen(run_schedule(system, prototype_laws(), command, motor, sampling=sampling), kept)


def test_torques_read_in_bands_are_those_of_angles_and_speeds() -> None:
    """Elastic rig that passes from one band to another; read a segment on from the last glance, at the end of the run,
    they are stiffness and damping on angles and speeds of the freedoms there. Every sample is a march of its own in the
    one, so that the hold of the tooth forces begins anew: 1e-3."""
    rig = prototype_rig(0.03)
    model = assemble_rig(rig)
    seen = SeenRig(
        reduced=reduce_rig(model, bearings(rig), 20e3),
        ports={mesh.name: mesh_ports(model, mesh.name) for mesh in rig.drivetrain.meshes},
    )
    first, second = (seen.system(running(rig, speed)) for speed in (100.0, 140.0))
    rows = elastic_twist_rows(seen, first)
    command = Command(time=np.array([0.0, 0.1]), speed=np.array([100.0, 140.0]), torque=np.full(2, TORQUE))
    bands = SpeedBands(limits=(110.0,), systems=(first, second))
    run, glances = looked_at(bands, command, rows, time_march.SEGMENT)
    assert [glance.time for glance in glances] == pytest.approx([0.0, 0.025, 0.05, 0.075])
    course = glances[-1].again()
    assert len(course) == time_march.SEGMENT // state_reader.READ_ON
    exact = Watched(torque_channels(rows)).read(run.end)
    kept = [i for i, section in enumerate(rows.sections) if section.kind in ("shaft", "coupling")]
    assert np.abs(exact).max() > 0.9 * TORQUE
    assert course[-1, kept] == pytest.approx(exact, abs=1e-3 * TORQUE)
    # the end of a stretch is the next glance
    assert glances[-2].again()[-1] == pytest.approx(glances[-1].torque, abs=1e-3 * TORQUE)


def test_largest_alternating_torques_of_a_run_up_through_resonances() -> None:
    """Against half the peak-to-peak torque of every 5 ms of the whole run, all of it read on: never more. 720 rpm a
    second between 1000 and 1700 rpm pass the narrowest resonances between two glances: half of the sections are short
    by less than 10 %, none by more than half. Looking leaves the run as it is."""
    drivetrain = prototype()
    rows = torsional_twist_rows(drivetrain)
    command = Command(time=np.array([0.0, 1.0]), speed=np.array([100.0, 175.0]), torque=np.full(2, TORQUE))
    plain = looked_at(assemble(drivetrain), command, None).run
    run = looked_at(assemble(drivetrain), command, rows).run
    assert plain.sections is None and run.sections is not None
    assert np.array_equal(plain.torque, run.torque)
    whole = looked_at(assemble(drivetrain), command, rows, time_march.SEGMENT).glances
    courses = np.concatenate([glance.again() for glance in whole])
    courses = courses.reshape(-1, 50, len(rows.sections))
    largest = 0.5 * np.ptp(courses, axis=1).max(axis=0)
    shares = []
    for section in dict.fromkeys(rows.sections):
        own = [i for i, other in enumerate(rows.sections) if other == section]
        shares.append(run.sections.half_peak_to_peak[own].max() / largest[own].max())
    assert max(shares) <= 1.0 + 1e-9
    assert np.median(shares) > 0.9 and min(shares) > 0.5
