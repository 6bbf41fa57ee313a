"""Mesh study of the shipped rigs: four meshes of one kind, each number with its observed order and its errors.

The loop settles on the standard mesh; the settled point is solved once more on meshes whose elements are 2, 1.4, 1
and 0.8 times those of `reference` everywhere, and on those of `quick` and `standard`. Printed for each number:
its values, the order observed on the three coarsest, the error estimated for the third (350,000 nodes and more)
and for `standard` as a check estimates it, and the true errors of both against the limit of the finest two.
Run it by hand, a quarter of an hour and 4 GB:

    python -m pytest tests/performance/test_mesh_study.py -m performance -s
"""

import math
import time
from dataclasses import replace

import pytest

from rigdesign import load_case
from rigdesign.coupling.loop import PointResult, solve_point
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.model import Rig, build_rig
from rigdesign.run.mesh_convergence import EDGE_ORDER, Numbers, numbers, on_mesh, richardson
from tests.builders.paths import CASES
from thermal.housing.gearbox import MeshSizes, build_gearbox, mesh_sizes

FACTORS = (2.0, 1.4, 1.0, 0.8)
SHOWN = (
    "max_temperature", "heat.air", "heat.radiation", "heat.gear_oil", "heat.bearing_oil", ".seal_gap", ".growth",
    ".centre_distance", ".clearance_change", "temperature.", "clearance.", "oil.room",
)  # fmt: skip
"""Parts of the names of the numbers that are printed."""
BAND = (0.3, 5.0)
"""Estimated over true error in which most numbers must lie: half of them between its ends."""


def sized(rig: Rig, factor: float) -> Rig:
    """The rig at reference with all elements ``factor`` times as large."""
    models = {}
    for name, geometry in rig.geometries.items():
        usual = mesh_sizes(geometry, "reference")
        sizes = MeshSizes(
            wall=factor * usual.wall, field=factor * usual.field, shaft=factor * usual.shaft,
            circle=round(usual.circle / factor),
        )  # fmt: skip
        models[name] = build_gearbox(geometry, sizes)
    return replace(rig, fidelity="reference").with_models(models)


def limit(first: Numbers, second: Numbers, key: tuple[str, str]) -> float:
    """Value of an infinitely fine mesh from the finest two."""
    ratio = (second.nodes[key[1]] / first.nodes[key[1]]) ** (1.0 / 3.0)
    before, after = first.values[key][0], second.values[key][0]
    return after + (after - before) / (ratio**EDGE_ORDER - 1.0)


def estimate(meshes: list[Numbers], key: tuple[str, str]) -> tuple[float, float | None]:
    found = richardson([mesh.nodes[key[1]] for mesh in meshes], [mesh.values[key][0] for mesh in meshes])
    return found[0], found[1]


def solved(rig: Rig, settled: PointResult, source: Rig) -> Numbers:
    began = time.perf_counter()
    found = numbers(rig, [on_mesh(rig, settled, source)], 0)
    print(f"{found.nodes['']} nodes: {time.perf_counter() - began:.0f} s", flush=True)
    return found


@pytest.mark.performance
@pytest.mark.parametrize("name", ["uhcf_prototype", "uhcf_main"])
def test_mesh_study(name: str) -> None:
    rig = build_rig(load_case(CASES / name), "standard")
    settled = solve_point(rig, held_points(rig)[-1])
    quick, standard = (solved(other, settled, rig) for other in (replace(rig, fidelity="quick"), rig))
    family = [solved(sized(rig, factor), settled, rig) for factor in FACTORS]
    assert family[2].nodes[""] >= 350_000
    header = [str(mesh.nodes[""]) for mesh in (quick, standard, *family)]
    print(f"\n{name}\n{'':42}" + "".join(f"{n:>11}" for n in header), end="")
    print(f"{'order':>7}{'est.':>10}{'true':>10}{'est. std':>10}{'true std':>10}")
    inside = []
    for key, (_, unit) in standard.values.items():
        if not any(part in key[0] for part in SHOWN) or any(key not in mesh.values for mesh in family):
            continue
        values = [mesh.values[key][0] for mesh in (quick, standard, *family)]
        if max(values) == min(values):
            continue
        best = limit(family[2], family[3], key)
        fine, order = estimate(family[:3], key)
        usual, _ = estimate([quick, standard], key)
        true, true_usual = abs(family[2].values[key][0] - best), abs(standard.values[key][0] - best)
        ratio = usual / true_usual if true_usual > 0.0 else math.inf
        inside.append(BAND[0] <= ratio <= BAND[1])
        print(f"{key[0] + ' ' + unit:42}" + "".join(f"{v:>11.5g}" for v in values), end="")
        print(f"{'-' if order is None else format(order, '.2f'):>7}", end="")
        print("".join(f"{v:>10.2g}" for v in (fine, true, usual, true_usual)))
    print(f"estimated over true error at standard within {BAND}: {sum(inside)} of {len(inside)}", flush=True)
    assert sum(inside) >= 0.5 * len(inside)
