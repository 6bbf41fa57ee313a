"""The prototype at its test stage with the tooth contact in the loop, next to its response with contact tables.

Prints processor time of a step, seconds per simulated second, K_V of both meshes by both, and the tilt in motion. The
first stretch of the march is left out: it settles from uniform rotation. Run with
``pytest -m performance -s tests/performance/test_contact_loop_speed.py``; influence numbers of the four gears are
computed where they are not kept.
"""

from time import process_time

import numpy as np
import pytest

from dynamics.drivetrain.loop_load import LoopLoad
from dynamics.elastic_rig.wrench_rows import wrench_rows
from dynamics.response.contact_loop import ContactLoop, MeshInLoop
from dynamics.response.initial_state import wound_state
from rigdesign.case import load_case
from rigdesign.coupling.braced_loop import signed_torque
from rigdesign.coupling.loop import solve_point
from rigdesign.coupling.loop_system import loop_system
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.coupling.time_run import held_points
from rigdesign.records.loaded_contact import held_contact
from rigdesign.rig.model import build_rig

pytestmark = pytest.mark.performance
SAMPLE = 25e-6
SETTLED, SEEN = 1200, 400
"""Samples."""


@pytest.mark.parametrize("substeps", [4, 8])
def test_contact_in_the_loop_of_the_prototype(substeps: int) -> None:
    rig = build_rig(load_case("cases/uhcf_prototype"), "standard")
    rig.prepare_teeth(print)
    point = solve_point(rig, held_points(rig)[-1])
    last, response = point.last, point.last.response
    assert response is not None
    system = loop_system(rig, point.point, last.coupling_state, last.bearings)
    laws = laws_of(last.models)
    load = LoopLoad(torque=signed_torque(rig, point.point))
    wound = wound_state(system, laws, rig.pinion_speed(point.point.speed), load, last.drags)
    meshes = []
    for number, law in enumerate(laws):
        contact = held_contact(rig, point, number)
        assert contact is not None
        force = float(np.sign(response.flank[number])) * contact.force
        meshes.append(MeshInLoop(contact=contact.mesh, law=law, force=force))
    model = rig.elastic.model
    rows = rig.elastic.seen.on_freedoms(np.vstack([wrench_rows(model, name) for name in rig.mesh_names]))
    loop = ContactLoop(
        system, rows, meshes, wound, step=SAMPLE / substeps, cutoff=rig.highest_mode, drag_torques=last.drags
    )
    loop.advance(SETTLED * substeps)
    before = process_time()
    record = loop.advance(SEEN * substeps)
    seconds = process_time() - before
    force = record.net_force
    factors = force.max(axis=1) / force.mean(axis=1)
    print(
        f"\n{substeps} steps a sample: {1e6 * seconds / SEEN / substeps:.0f} us a step, "
        f"{seconds / SEEN / SAMPLE:.1f} s per simulated second; K_V {np.array2string(factors, precision=4)}, "
        f"contact tables {np.array2string(response.dynamic_factor, precision=4)}; "
        f"tilt, peak to peak [urad] {np.array2string(1e6 * np.ptp(record.tilt, axis=1), precision=2)}"
    )
    assert loop.unconverged == 0
