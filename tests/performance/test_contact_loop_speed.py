"""The prototype at its test stage with the tooth contact in the loop, next to its response with contact tables.

Prints processor time of a step, that of a run-up of 3.2 s, K_V of both meshes by both, and the tilt
in motion, at the positions over the face that fidelity reference takes and at those of the quasi-static contact. Run
with ``pytest -m performance -s tests/performance/test_contact_loop_speed.py``; influence numbers of the four gears are
computed where they are not kept.
"""

from time import process_time

import numpy as np
import pytest

from dynamics.response.looped_response import looped_response
from rigdesign.case import load_case
from rigdesign.coupling.loop import PointResult, solve_point
from rigdesign.coupling.time_run import held_points
from rigdesign.records import contact_in_loop
from rigdesign.rig.model import Rig, build_rig

pytestmark = pytest.mark.performance
RUN_UP, STEP = 3.2, 6.25e-6
"""Time of a run-up, and the step that it is taken with: four steps a sample [s]."""


@pytest.fixture(scope="module")
def solved() -> tuple[Rig, PointResult]:
    rig = build_rig(load_case("cases/uhcf_prototype"), "standard")
    rig.prepare_teeth(print)
    return rig, solve_point(rig, held_points(rig)[-1])


@pytest.mark.parametrize("fewer", [contact_in_loop.FEWER_POSITIONS, 1])
def test_contact_in_the_loop_of_the_prototype(
    fewer: int, solved: tuple[Rig, PointResult], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(contact_in_loop, "FEWER_POSITIONS", fewer)
    rig, point = solved
    by_table, problem = contact_in_loop.problem_in_loop(rig, point, point.point.speed)
    looped_response(problem, longest=0.0)  # compiles
    before = process_time()
    looped = looped_response(problem)
    each = (process_time() - before) / looped.steps
    positions = [len(mesh.contact.grid.position) for mesh in problem.meshes]
    print(
        f"\n{positions} positions over the faces: {1e6 * each:.0f} us a step, run-up of {RUN_UP} s "
        f"{each * RUN_UP / STEP:.0f} s; K_V {np.array2string(looped.dynamic_factor, precision=4)}, "
        f"contact tables {np.array2string(by_table.dynamic_factor, precision=4)}; tilt, peak to peak [urad] "
        f"{np.array2string(1e6 * looped.tilt, precision=2)}; settled after {looped.time:.2f} s"
    )
    assert looped.settled
    assert looped.unconverged == 0
