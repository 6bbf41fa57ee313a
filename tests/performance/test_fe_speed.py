"""Seconds and memory of heat and expansion against CalculiX on one mesh; printed, never fails by time.

Processes against processes: each reads its mesh (.msh, .inp), solves and writes its nodal values. The deck of CalculiX
has the nodes in the order of the mesh file, from which we number them anew; heat runs on our order, too. CalculiX runs
with SOLVER=ITERATIVE CHOLESKY and with its default solver (SPOOLES). Both codes get the same number of threads;
a ratio is that of two processes one after the other, wall by wall and processor by processor time. Run it with

    python -m pytest tests/performance/test_fe_speed.py -m performance -s -k "ribbed"

and OMP_NUM_THREADS, NUMBA_NUM_THREADS for the threads. FE_SPEED_REPEATS=3 repeats every pair, and ratios hold
best against best; FE_SPEED_DEFAULT=1 adds the default solver for expansion beyond 200,000 nodes, which takes
16 GB, FE_SPEED_DEFAULT=0 leaves it out for heat too.
"""

import json
import os
import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from tests.builders import calculix
from tests.builders.msh_file import write_msh
from tests.performance import fe_process
from tests.performance.ribbed_box import write_ribbed_box
from thermal.conditions.boundary import BoundaryCondition
from thermal.expansion.elastic import three_two_one
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import NamedMesh, box_mesh, facet_table, inverse
from thermal.housing.gearbox import (
    ClampingField,
    EndBearing,
    GearDisc,
    HousingGeometry,
    MeshSizes,
    ShaftGeometry,
    build_gearbox,
    mesh_sizes,
)
from thermal.housing.mesh_file import read_mesh

STEEL = (210e9, 0.3, 11.5e-6)
CONDUCTIVITY = 45.0
COLD = 293.15
DEFAULT_SOLVER = os.environ.get("FE_SPEED_DEFAULT")
REPEATS = int(os.environ.get("FE_SPEED_REPEATS", "1"))
ITERATIVE = "CalculiX ITERATIVE CHOLESKY"
THREADS = int(os.environ.get("NUMBA_NUM_THREADS", os.cpu_count() or 1))


def gearbox(factor: float) -> NamedMesh:
    """Housing with field, two shafts and gears; cells ``factor`` times those of `reference`."""
    bearing = EndBearing(journal_diameter=0.04, width=0.03)
    shafts = tuple(
        ShaftGeometry(
            name=name, y=y, front=bearing, rear=bearing, seal_diameter=0.042, seat_diameter=0.044,
            overhang_diameter=0.038, seal_gap=0.5e-3, locating="rear",
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


MESHES: dict[str, Callable[[Path], object]] = {
    "ribbed 97k": lambda file: write_ribbed_box(10.5e-3, file),
    "ribbed 386k": lambda file: write_ribbed_box(6e-3, file),
    "gearbox 107k": lambda file: write_msh(gearbox(1.6), file),
    "gearbox 370k": lambda file: write_msh(gearbox(0.97), file),
    "gearbox 1M": lambda file: write_msh(gearbox(0.66), file),
    "hex 330k": lambda file: write_msh(hollow_box(58, 5), file),
}


@dataclass(frozen=True)
class Ours:
    values: np.ndarray
    wall: float
    processor: float
    peak: float
    times: dict[str, object]


def ours(what: str, folder: Path, *more: str) -> Ours:
    """Our process."""
    command = [sys.executable, fe_process.__file__, what, str(folder), *more]
    path = os.pathsep.join([str(Path.cwd()), os.environ.get("PYTHONPATH", "")])
    wall, processor, peak = calculix.measure(command, folder, {"PYTHONPATH": path})
    times = json.loads((folder / "times.json").read_text())
    return Ours(np.load(folder / "values.npy"), wall, processor, peak, times)


def shown(name: str, run: Ours | calculix.Run, reference: Ours | None = None) -> None:
    ratio = ""
    if reference is not None:
        difference = np.abs(run.values.reshape(reference.values.shape) - reference.values).max()
        scale = np.ptp(reference.values) if reference.values.ndim == 1 else np.abs(reference.values).max()
        ratio = (
            f"{run.wall / reference.wall:8.1f} x wall{run.processor / reference.processor:8.1f} x processor"
            f"   differs by {difference / scale:.1e}"
        )
    print(f"  {name:44s}{run.wall:9.1f} s{run.processor:9.1f} s{run.peak:7.2f} GB{ratio}", flush=True)


def compared(what: str, folder: Path, theirs: dict[str, Callable[[], calculix.Run]]) -> np.ndarray:
    """Run ours and theirs in turn ``REPEATS`` times, print all and the ratios of the best; our values."""
    best: dict[str, Ours | calculix.Run] = {}
    for _ in range(REPEATS):
        for name, run in {what: lambda: ours(what, folder), **theirs}.items():
            found = run()
            shown(name, found)
            if name not in best or found.processor < best[name].processor:
                best[name] = found
    mine = best[what]
    assert isinstance(mine, Ours)
    print(f"    processor {_words(mine.times)}")
    for name in theirs:
        shown(f"best {name}", best[name], mine)
    second = ours(what, folder, "again").times
    print(f"    again with warmer oil {second['again']:.2f} s processor, iterations {second['iterations']}")
    return mine.values


@pytest.mark.performance
@pytest.mark.parametrize("name", MESHES)
def test_heat_and_expansion_against_calculix(name: str, tmp_path: Path) -> None:
    MESHES[name](tmp_path / "mesh.msh")
    mesh = read_mesh(tmp_path / "mesh.msh")
    n = len(mesh.points)
    given = given_of(mesh)
    (tmp_path / "given.json").write_text(json.dumps(given))
    print(f"\n{name}: {n} nodes, {len(mesh.cells)} cells, {THREADS} threads; wall, processor, peak memory")
    conditions = fe_process.conditions(mesh, given["films"], given["radiating"])  # type: ignore[arg-type]
    ours("heat", tmp_path)  # fills numba's cache
    temperature = compared("heat", tmp_path, _calculix_heat(mesh, conditions, tmp_path))
    held = supports(mesh)
    if mesh.shape.n_corners == 8:  # CalculiX takes the corners' temperatures for the strain of C3D20
        middle = temperature[mesh.cells[:, :8]] @ mesh.shape.corner_values(mesh.shape.nodes).T
        temperature[mesh.cells] = middle
    np.savez(tmp_path / "problem.npz", held=held, temperature=temperature)
    ours("expansion", tmp_path)
    compared("expansion", tmp_path, _calculix_expansion(mesh, held, temperature, tmp_path))


def _words(times: dict[str, object]) -> str:
    return ", ".join(f"{k} {v:.2f} s" if isinstance(v, float) else f"{k} {v}" for k, v in times.items())


def _calculix_heat(
    mesh: NamedMesh, given: list[BoundaryCondition], folder: Path
) -> dict[str, Callable[[], calculix.Run]]:
    """Solver and order of the nodes -> a run of it."""

    def run(line: str, filed: bool) -> calculix.Run:
        deck, order = _deck_mesh(mesh, filed)
        lines = calculix.heat_lines(deck, given, CONDUCTIVITY, COLD, line)
        found = calculix.run(lines, folder / "heat", "NDTEMP", 1, len(mesh.points), THREADS)
        return replace(found, values=found.values[order])

    ours = {f"{ITERATIVE}, our order": lambda: run(", SOLVER=ITERATIVE CHOLESKY", False)}
    return _solvers(mesh, run, ours, default=DEFAULT_SOLVER != "0")


def _calculix_expansion(
    mesh: NamedMesh, held: np.ndarray, field: np.ndarray, folder: Path
) -> dict[str, Callable[[], calculix.Run]]:
    """Solver -> a run of it."""

    def run(line: str, filed: bool) -> calculix.Run:
        deck, order = _deck_mesh(mesh, filed)
        back = inverse(order)
        lines = calculix.expansion_lines(deck, STEEL, held[back], field[back], COLD, line)
        found = calculix.run(lines, folder / "expansion", "DISP", 3, len(mesh.points), THREADS)
        return replace(found, values=found.values[order])

    small = len(mesh.points) < 200_000 and DEFAULT_SOLVER != "0"
    return _solvers(mesh, run, {}, default=small or DEFAULT_SOLVER == "1")


def _deck_mesh(mesh: NamedMesh, filed: bool) -> tuple[NamedMesh, np.ndarray]:
    """The mesh with the nodes and cells of its file, or with ours; where each of our nodes is in it.

    Both codes get the same file. We number it anew, CalculiX keeps its order, which its iterative solver feels.
    """
    numbering = mesh.numbering
    if not filed or numbering is None:
        return mesh, np.arange(len(mesh.points), dtype=np.int32)
    return NamedMesh(
        points=numbering.given_nodes(mesh.points),
        cells=numbering.nodes[numbering.given_cells(mesh.cells)],
        bodies={name: np.sort(numbering.cells[members]) for name, members in mesh.bodies.items()},
        surfaces={name: numbering.nodes[facets] for name, facets in mesh.surfaces.items()},
    ), numbering.nodes


def _solvers(
    mesh: NamedMesh,
    run: Callable[[str, bool], calculix.Run],
    more: dict[str, Callable[[], calculix.Run]],
    *,
    default: bool,
) -> dict[str, Callable[[], calculix.Run]]:
    if shutil.which("ccx") is None or len(mesh.points) > 600_000:
        return {}
    found = {ITERATIVE: lambda: run(", SOLVER=ITERATIVE CHOLESKY", True)} | more
    return found | ({"CalculiX default": lambda: run("", True)} if default else {})
