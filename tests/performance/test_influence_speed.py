"""Influence numbers of the reference gear of the UHCF prototype, 40 mm wide and helical: time, nodes, memory, cache.

Times of the wall clock and of one core; a figure that is missed is printed, not failed.
Run with ``pytest -m performance -s tests/performance/test_influence_speed.py``; it takes some minutes
and means nothing on a busy machine.
"""

import resource
from pathlib import Path
from time import perf_counter, process_time

import pytest
from threadpoolctl import threadpool_limits

from dynamics.tooth.compliance import InterpolatedCompliance
from dynamics.tooth.loaded_mesh import LoadedMesh
from dynamics.tooth.points import FaceGrid
from rigdesign.case.loader import load_case
from rigdesign.rig.model import build_rig
from rigdesign.rig.tooth_influence import InfluenceStore, gear_model

pytestmark = pytest.mark.performance

COLD, CACHED, CYCLE, MEMORY = 60.0, 0.1, 0.5, 4.0


def verdict(found: float, limit: float) -> str:
    return "ok" if found < limit else f"MISSED {limit:g}"


def test_reference_gear(tmp_path: Path):
    pair = build_rig(load_case("cases/uhcf_prototype"), "quick").pairs["reference.main"]
    store, model = InfluenceStore(tmp_path), gear_model(pair, 0)
    with threadpool_limits(1):
        start, used = perf_counter(), process_time()
        numbers = store.numbers(model)
        wall, core = perf_counter() - start, process_time() - used
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024**2
    n_p, n_f = numbers.shape
    print(
        f"\n{n_p} x {n_f} positions, {numbers.n_nodes} nodes: {wall:.1f} s ({core:.1f} s of one core), "
        f"{verdict(wall, COLD)}; peak memory {memory:.2f} GB, {verdict(memory, MEMORY)}"
    )
    times = []
    for _ in range(5):
        start = perf_counter()
        again = store.numbers(model)
        times.append(perf_counter() - start)
    size = store.file(model).stat().st_size / 1e6
    print(f"read again, {size:.1f} MB: {min(times):.3f} s, {verdict(min(times), CACHED)}")
    assert again.shape == (n_p, n_f)
    assert n_p >= 8 and n_f == 11
    gears = (
        InterpolatedCompliance.of(again.reversed_face(), pair.base_helix_angle),
        InterpolatedCompliance.of(store.numbers(gear_model(pair, 1)), pair.base_helix_angle),
    )
    mesh = LoadedMesh(pair=pair, gears=gears, grid=FaceGrid.over(pair.face_width, 11))
    force = 180.0 / pair.base_radii[0]
    with threadpool_limits(1):
        mesh.cycle(force)
        times = []
        for _ in range(5):
            used = process_time()
            cycle = mesh.cycle(force)
            times.append(process_time() - used)
    print(f"mesh cycle, 64 x 11: {min(times):.3f} s of one core, {verdict(min(times), CYCLE)}")
    assert cycle.force.shape[0] == 64
