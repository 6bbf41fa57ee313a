"""Seconds and memory of heat and expansion beside CalculiX on one mesh; printed, never fails by time.

Processes against processes: each reads its mesh, solves and writes its nodal values; ours also solves a second
time with the oil 5 K warmer, which is taken out of its time. CalculiX runs with its default solver (SPOOLES)
and with SOLVER=ITERATIVE CHOLESKY. Both codes get the same number of threads. Run it with

    python -m pytest tests/performance/test_fe_speed.py -m performance -s

and OMP_NUM_THREADS, NUMBA_NUM_THREADS for the threads. FE_SPEED_DEFAULT=1 adds the default solver for
expansion beyond 200,000 nodes, which takes 16 GB.
"""

import json
import os
import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from tests import calculix
from tests.performance import fe_process
from thermal.boundary import BoundaryCondition
from thermal.elastic import three_two_one
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import NamedMesh, box_mesh, facet_table
from thermal.housing import (
    ClampingField,
    GearDisc,
    HousingGeometry,
    MeshSizes,
    ShaftGeometry,
    build_gearbox,
    mesh_sizes,
)

STEEL = (210e9, 0.3, 11.5e-6)
CONDUCTIVITY = 45.0
COLD = 293.15
THREADS = int(os.environ.get("NUMBA_NUM_THREADS", os.cpu_count() or 1))


def gearbox(factor: float) -> NamedMesh:
    """Housing with field, two shafts and gears; cells ``factor`` times those of `reference`."""
    shafts = tuple(
        ShaftGeometry(
            name=name, y=y, journal_diameter=0.04, seal_diameter=0.042, seat_diameter=0.044,
            overhang_diameter=0.038, bearing_width=0.03, seal_gap=0.5e-3, locating="rear",
            overhang_rear=0.04, gear=GearDisc(outer_diameter=0.099, width=0.015),
        )
        for name, y in (("pinion", -0.05), ("wheel", 0.05))
    )  # fmt: skip
    geometry = HousingGeometry(
        chamber_length=0.08, cold_length_front=0.05, cold_length_rear=0.06, height=0.28, width=0.32,
        wall_thickness=0.015, floor_thickness=0.02, top_thickness=0.015, partition_thickness=0.015,
        end_wall_thickness=0.036, shaft_height=0.14, shafts=shafts,
        field=ClampingField(length=0.8, width=1.2, thickness=0.15),
    )  # fmt: skip
    usual = mesh_sizes(geometry, "reference")
    sizes = MeshSizes(
        wall=factor * usual.wall, field=factor * usual.field, shaft=factor * usual.shaft,
        circle=max(6, round(usual.circle / factor / 2.0) * 2),
    )  # fmt: skip
    return build_gearbox(geometry, sizes).mesh


def hollow_box(divisions: int, wall: int) -> NamedMesh:
    """A box of 0.4 m with walls ``wall`` hexahedra thick."""
    solid = box_mesh((0.4, 0.4, 0.4), (divisions,) * 3, cell="hexahedron20")
    centres = solid.points[solid.cells[:, :8]].mean(axis=1) / 0.4 * divisions
    cells = solid.cells[np.any((centres < wall) | (centres > divisions - wall), axis=1)]
    used, packed = np.unique(cells, return_inverse=True)
    cells = packed.reshape(cells.shape).astype(np.int32)
    points = solid.points[used]
    table = facet_table(cells, len(points))
    sides = table.nodes_at(np.flatnonzero(table.on_boundary))
    middle = points[sides].mean(axis=1)
    on_outside = np.any((middle < 1e-9) | (middle > 0.4 - 1e-9), axis=1)
    foot = middle[:, 2] < 1e-9
    surfaces = {
        "outer": sides[on_outside & ~foot], "foot": sides[foot], "chamber": sides[~on_outside],
    }  # fmt: skip
    return NamedMesh(points, cells, {"box": np.arange(len(cells), dtype=np.int32)}, surfaces)


def given_of(mesh: NamedMesh) -> dict[str, object]:
    """Films and radiation by the name of the surface."""
    films: dict[str, tuple[float, float]] = {}
    radiating: dict[str, tuple[float, float]] = {}
    for name in mesh.surfaces:
        if name in ("field_bottom", "foot"):
            continue
        if name.startswith(("outer", "field")):
            films[name], radiating[name] = (10.0, COLD), (0.6, COLD)
        elif name.startswith(("chamber", "partition_warm", "gear")) or "warm" in name:
            films[name] = (300.0, 433.15)
        else:
            films[name] = (300.0, 318.15)
    return {
        "films": films, "radiating": radiating, "conductivity": CONDUCTIVITY, "elastic": STEEL, "cold": COLD,
    }  # fmt: skip


def supports(mesh: NamedMesh) -> np.ndarray:
    """(n_nodes, 3) three, two and one held directions on every piece."""
    elements = FiniteElements(mesh)
    held = np.zeros((len(mesh.points), 3), dtype=bool)
    corner_piece = elements.piece_of_node[elements.corners]
    for piece in range(int(corner_piece.max()) + 1):
        nodes = elements.corners[corner_piece == piece].astype(np.int32)
        for node, directions in three_two_one(mesh.points, nodes):
            held[node, list(directions)] = True
    return held


MESHES: dict[str, Callable[[], NamedMesh]] = {
    "tet 107k": lambda: gearbox(1.6),
    "tet 370k": lambda: gearbox(0.97),
    "tet 1M": lambda: gearbox(0.66),
    "hex 330k": lambda: hollow_box(58, 5),
}


@dataclass(frozen=True)
class Ours:
    values: np.ndarray
    wall: float
    processor: float
    peak: float
    times: dict[str, object]


def ours(what: str, folder: Path) -> Ours:
    """Our process without its second solve."""
    command = [sys.executable, fe_process.__file__, what, str(folder)]
    path = os.pathsep.join([str(Path.cwd()), os.environ.get("PYTHONPATH", "")])
    wall, processor, peak = calculix.measure(command, folder, {"PYTHONPATH": path})
    times = json.loads((folder / "times.json").read_text())
    share = 1.0 - times["again"] / processor
    return Ours(np.load(folder / "values.npy"), share * wall, share * processor, peak, times)


def shown(name: str, run: Ours | calculix.Run, beside: Ours | None = None, difference: float = 0.0) -> None:
    ratio = "" if beside is None else (
        f"{run.wall / beside.wall:8.1f} x wall{run.processor / beside.processor:8.1f} x processor"
        f"   differs by {difference:.1e}"
    )  # fmt: skip
    print(f"  {name:34s}{run.wall:9.1f} s{run.processor:9.1f} s{run.peak:7.2f} GB{ratio}", flush=True)


@pytest.mark.performance
@pytest.mark.parametrize("name", MESHES)
def test_heat_and_expansion_beside_calculix(name: str, tmp_path: Path) -> None:
    mesh = MESHES[name]()
    n = len(mesh.points)
    given = given_of(mesh)
    (tmp_path / "given.json").write_text(json.dumps(given))
    fe_process.save_mesh(tmp_path, mesh)
    print(f"\n{name}: {n} nodes, {len(mesh.cells)} cells, {THREADS} threads; wall, processor, peak memory")
    heat = ours("heat", tmp_path)
    shown("heat", heat)
    print(f"    processor {_words(heat.times)}")
    conditions = fe_process.conditions(mesh, given["films"], given["radiating"])  # type: ignore[arg-type]
    _calculix_heat(mesh, conditions, heat, tmp_path)
    held = supports(mesh)
    field = heat.values.copy()
    if mesh.shape.n_corners == 8:  # CalculiX takes the corners' temperatures for the strain of C3D20
        field[mesh.cells] = field[mesh.cells[:, :8]] @ mesh.shape.corner_values(mesh.shape.nodes).T
    fe_process.save_mesh(tmp_path, mesh, held=held, temperature=field)
    expansion = ours("expansion", tmp_path)
    shown("expansion", expansion)
    print(f"    processor {_words(expansion.times)}")
    _calculix_expansion(mesh, held, field, expansion, tmp_path)


def _words(times: dict[str, object]) -> str:
    return ", ".join(f"{k} {v:.2f} s" if isinstance(v, float) else f"{k} {v}" for k, v in times.items())


def _calculix_heat(mesh: NamedMesh, given: list[BoundaryCondition], beside: Ours, folder: Path) -> None:
    if shutil.which("ccx") is None or len(mesh.points) > 600_000:
        return
    for solver in ("ITERATIVE CHOLESKY", ""):
        line = f", SOLVER={solver}" if solver else ""
        lines = calculix.heat_lines(mesh, given, CONDUCTIVITY, COLD, line)
        run = calculix.run(lines, folder / "heat", "NDTEMP", 1, len(mesh.points), THREADS)
        difference = float(np.abs(run.values[:, 0] - beside.values).max() / np.ptp(beside.values))
        shown(f"CalculiX {solver or 'default'}", run, beside, difference)


def _calculix_expansion(
    mesh: NamedMesh, held: np.ndarray, field: np.ndarray, beside: Ours, folder: Path
) -> None:
    if shutil.which("ccx") is None or len(mesh.points) > 600_000:
        return
    small = len(mesh.points) < 200_000 or os.environ.get("FE_SPEED_DEFAULT")
    for solver in ("ITERATIVE CHOLESKY", "") if small else ("ITERATIVE CHOLESKY",):
        line = f", SOLVER={solver}" if solver else ""
        lines = calculix.expansion_lines(mesh, STEEL, held, field, COLD, line)
        run = calculix.run(lines, folder / "expansion", "DISP", 3, len(mesh.points), THREADS)
        difference = float(np.abs(run.values - beside.values).max() / np.abs(beside.values).max())
        shown(f"CalculiX {solver or 'default'}", run, beside, difference)
