"""Seconds for heat and expansion of a gearbox, beside CalculiX on one mesh; printed, never fails by time.

Heat: constant films and radiation outside, oil inside, no exchange, so both codes solve the same problem.
CalculiX runs with its iterative solver, its best (``SOLVER=ITERATIVE CHOLESKY``), as a whole process that
reads and writes its files; ours is the time of setup plus solve. Run it with

    python -m pytest tests/performance/test_fe_speed.py -m performance -s
"""

import os
import shutil
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from thermal.boundary import Adiabatic, BoundaryCondition, Film, FilmCoefficient, Radiation
from thermal.conduction import ConductionSetup, solve_steady
from thermal.expansion import ExpansionSetup, expand
from thermal.fe.mesh import CELL_FACETS, NamedMesh, facet_keys
from thermal.housing import ClampingField, Fidelity, GearDisc, HousingGeometry, ShaftGeometry, build_gearbox
from thermal.stations import GearboxModel

STEEL = (210e9, 0.3, 11.5e-6)
CONDUCTIVITY = 45.0
COLD = 293.15
CALCULIX_FACES = (3, 2, 0, 1)
"""Corner that faces 1 to 4 of C3D10 do not have."""


def gearbox(fidelity: Fidelity) -> GearboxModel:
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
    return build_gearbox(geometry, fidelity)


def film(surface: str, value: float, fluid: float) -> Film:
    record = FilmCoefficient(value=value, formula="given", inputs={}, valid_range="any", source="benchmark")
    return Film(surface=surface, kind="film", fluid_temperature=fluid, law=lambda wall, fluid: record)


def conditions(mesh: NamedMesh) -> list[BoundaryCondition]:
    """Films and radiation by the name of the surface."""
    found: list[BoundaryCondition] = []
    for name in mesh.surfaces:
        if name == "field_bottom":
            found.append(Adiabatic(surface=name))
        elif name.startswith(("outer", "field")):
            found.append(film(name, 10.0, COLD))
            found.append(Radiation(surface=name, emissivity=0.6, surroundings_temperature=COLD))
        elif name.startswith(("chamber", "partition_warm", "gear")) or "warm" in name:
            found.append(film(name, 300.0, 433.15))
        else:
            found.append(film(name, 300.0, 318.15))
    return found


def calculix_heat(mesh: NamedMesh, given: list[BoundaryCondition], folder: Path) -> tuple[float, float]:
    """Seconds of the whole run and its highest temperature [K]."""
    lines = [
        *_geometry_lines(mesh),
        f"*CONDUCTIVITY\n{CONDUCTIVITY}",
        "*SOLID SECTION, ELSET=ALL, MATERIAL=M",
    ]
    lines += ["*PHYSICAL CONSTANTS, ABSOLUTE ZERO=0, STEFAN BOLTZMANN=5.670374419E-8"]
    lines += [f"*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNALL, {COLD}", "*STEP"]
    lines += ["*HEAT TRANSFER, STEADY STATE, SOLVER=ITERATIVE CHOLESKY\n1., 1."]
    for condition in given:
        if isinstance(condition, Film):
            value = condition.law(0.0, 0.0).value
            faces = _faces(mesh, condition.surface)
            lines += ["*FILM", *(f"{e}, F{f}, {condition.fluid_temperature}, {value}" for e, f in faces)]
        elif isinstance(condition, Radiation):
            faces = _faces(mesh, condition.surface)
            lines += ["*RADIATE", *(f"{e}, R{f}, {COLD}, {condition.emissivity}" for e, f in faces)]
    lines += ["*NODE FILE\nNT", "*END STEP"]
    return _run_calculix(lines, folder, "NDTEMP", 1)


def calculix_expansion(
    model: GearboxModel, setup: ExpansionSetup, field: np.ndarray, folder: Path
) -> tuple[float, float]:
    """Seconds of the whole run and its largest displacement component [m], same supports."""
    lines = [
        *_geometry_lines(model.mesh),
        f"*ELASTIC\n{STEEL[0]}, {STEEL[1]}",
        f"*EXPANSION, ZERO={COLD}\n{STEEL[2]}",
    ]
    lines += ["*SOLID SECTION, ELSET=ALL, MATERIAL=M", f"*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNALL, {COLD}"]
    held = np.argwhere(setup.elastic.fixed)
    lines += ["*BOUNDARY", *(f"{node + 1}, {axis + 1}, {axis + 1}" for node, axis in held)]
    lines += ["*STEP", "*STATIC, SOLVER=ITERATIVE CHOLESKY", "*TEMPERATURE"]
    lines += [f"{node}, {value:.12g}" for node, value in enumerate(field, start=1)]
    lines += ["*NODE FILE\nU", "*END STEP"]
    return _run_calculix(lines, folder, "DISP", 3)


def _geometry_lines(mesh: NamedMesh) -> Iterator[str]:
    yield "*NODE, NSET=NALL"
    for number, (x, y, z) in enumerate(mesh.points, start=1):
        yield f"{number}, {x:.12g}, {y:.12g}, {z:.12g}"
    yield "*ELEMENT, TYPE=C3D10, ELSET=ALL"
    for number, nodes in enumerate(mesh.cells + 1, start=1):
        yield f"{number}, " + ", ".join(map(str, nodes))
    yield "*MATERIAL, NAME=M"


def _faces(mesh: NamedMesh, surface: str) -> list[tuple[int, int]]:
    """CalculiX element and face number of every facet."""
    corners = mesh.cells[:, CELL_FACETS[:, :3]]
    keys = facet_keys(corners.reshape(-1, 3), len(mesh.points))
    order = np.argsort(keys)
    at = order[np.searchsorted(keys[order], facet_keys(mesh.surfaces[surface][:, :3], len(mesh.points)))]
    missing = np.array([6 - face[:3].sum() for face in CELL_FACETS])
    return [(int(k // 4) + 1, CALCULIX_FACES.index(int(missing[k % 4])) + 1) for k in at]


def _run_calculix(lines: list[str], folder: Path, block: str, columns: int) -> tuple[float, float]:
    (folder / "job.inp").write_text("\n".join(lines) + "\n")
    start = time.perf_counter()
    subprocess.run(
        ["ccx", "-i", "job"],
        cwd=folder,
        check=True,
        capture_output=True,
        env={**os.environ, "OMP_NUM_THREADS": "1"},
    )
    seconds = time.perf_counter() - start
    largest, inside = 0.0, False
    for line in (folder / "job.frd").read_text().splitlines():
        if line.startswith(" -4"):
            inside = block in line
        elif inside and line.startswith(" -1"):
            values = [abs(float(line[13 + 12 * k : 25 + 12 * k])) for k in range(columns)]
            largest = max(largest, *values)
    return seconds, largest


@pytest.mark.performance
@pytest.mark.parametrize("fidelity", ["quick", "standard", "reference"])
def test_heat_and_expansion_beside_calculix(fidelity: Fidelity, tmp_path: Path) -> None:
    model = gearbox(fidelity)
    mesh = model.mesh
    conductivity, elastic = dict.fromkeys(mesh.bodies, CONDUCTIVITY), dict.fromkeys(mesh.bodies, STEEL)
    given = conditions(mesh)
    marks = [time.perf_counter()]
    heat_setup = ConductionSetup(mesh, conductivity)
    marks.append(time.perf_counter())
    heat = solve_steady(mesh, conductivity, given, reuse=heat_setup)
    marks.append(time.perf_counter())
    expansion_setup = ExpansionSetup(model, elastic, heat_setup.elements)
    marks.append(time.perf_counter())
    shape = expand(model, heat.temperature, COLD, elastic, reuse=expansion_setup)
    marks.append(time.perf_counter())
    solve_steady(mesh, conductivity, given, heat.temperature + 1.0, reuse=heat_setup)
    marks.append(time.perf_counter())
    setup, solve, stiff, swell, again = np.diff(marks)
    print(f"\n{fidelity}: {len(mesh.points)} nodes, {len(mesh.cells)} cells")
    print(f"  heat       setup {setup:.2f} s, solve {solve:.2f} s, 1 K warm start {again:.2f} s,")
    hottest = heat.temperature.max() - 273.15
    print(f"             linear iterations {heat.linear_iterations}, T_max {hottest:.3f} degC")
    print(f"  expansion  setup {stiff:.2f} s, solve {swell:.2f} s, {shape.iterations} iterations")
    if shutil.which("ccx") is None:
        pytest.skip("CalculiX (ccx) is not installed: no comparison")
    (tmp_path / "heat").mkdir()
    (tmp_path / "expansion").mkdir()
    seconds, hottest = calculix_heat(mesh, given, tmp_path / "heat")
    ratio = seconds / (setup + solve)
    print(f"  CalculiX   heat {seconds:.2f} s = {ratio:.1f} x ours, T_max {hottest - 273.15:.3f} degC")
    raw = expansion_setup.elastic.solve(heat.temperature, COLD)
    seconds, largest = calculix_expansion(model, expansion_setup, heat.temperature, tmp_path / "expansion")
    ratio = seconds / (stiff + swell)
    print(f"  CalculiX   expansion {seconds:.2f} s = {ratio:.1f} x ours,", end=" ")
    print(f"largest component {largest * 1e3:.5f} mm, ours {np.abs(raw.values).max() * 1e3:.5f} mm")
