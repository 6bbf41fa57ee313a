"""Speed of the loaded contact: a mesh cycle of 64 positions with 11 face positions on interpolated influence numbers.

Processor times, the best of some runs; a figure that is missed is printed, not failed.
Run with ``pytest -m performance -s tests/performance/test_contact_speed.py``.
"""

from time import process_time

import pytest
from threadpoolctl import threadpool_limits

from dynamics.tooth.loaded_mesh import LoadedMesh
from dynamics.tooth.points import FaceGrid
from tests.builders.loaded_mesh import influence_of
from tests.builders.p2_gears import helical_pair, spur_pair

pytestmark = pytest.mark.performance

LIMIT = 0.5


@pytest.mark.parametrize("pair", [spur_pair(), helical_pair()], ids=["test gear", "reference gear"])
@pytest.mark.parametrize("n_face", [11, 49])
def test_mesh_cycle(pair, n_face):
    mesh = LoadedMesh(
        pair=pair,
        gears=(influence_of(pair, 0), influence_of(pair, 1)),
        grid=FaceGrid.over(pair.face_width, n_face),
    )
    force = 180.0 / pair.base_radii[0]
    with threadpool_limits(1):
        mesh.cycle(force)
        times = []
        for _ in range(5):
            start = process_time()
            cycle = mesh.cycle(force)
            times.append(process_time() - start)
    verdict = "ok" if min(times) < LIMIT else f"MISSED {LIMIT} s"
    print(f"\nmesh cycle, 64 x {n_face}: {min(times):.3f} s of one core, {verdict}")
    assert cycle.force.shape[0] == 64
