"""Writes what CalculiX reads, runs it, and reads what it writes: the same mesh, supports and conditions."""

import os
import subprocess
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from thermal.conditions.boundary import BoundaryCondition, Film, Radiation
from thermal.fe.mesh import NamedMesh, facet_keys

ELEMENT = {10: "C3D10", 20: "C3D20"}
FACES = {
    10: ((0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3)),
    20: ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 4, 5), (1, 2, 5, 6), (2, 3, 6, 7), (0, 3, 4, 7)),
}
"""Corners of faces 1, 2, ... of each element. Source: CalculiX CrunchiX manual 2.20, element types."""


@dataclass(frozen=True)
class Run:
    """Result of a process: nodal values (n_nodes, k), wall and processor seconds, peak memory [GB]."""

    values: np.ndarray
    wall: float
    processor: float
    peak: float


def heat_lines(
    mesh: NamedMesh, given: Sequence[BoundaryCondition], conductivity: float, cold: float, solver: str
) -> Iterator[str]:
    """Deck of steady conduction with films and radiation."""
    yield from _geometry(mesh)
    yield f"*CONDUCTIVITY\n{conductivity}\n*SOLID SECTION, ELSET=ALL, MATERIAL=M"
    yield "*PHYSICAL CONSTANTS, ABSOLUTE ZERO=0, STEFAN BOLTZMANN=5.670374419E-8"
    yield f"*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNALL, {cold}\n*STEP"
    yield f"*HEAT TRANSFER, STEADY STATE{solver}\n1., 1."
    for condition in given:
        if isinstance(condition, Film):
            value = condition.law(0.0, 0.0).value
            yield "*FILM"
            for element, face in _faces(mesh, condition.surface):
                yield f"{element}, F{face}, {condition.fluid_temperature}, {value}"
        elif isinstance(condition, Radiation):
            yield "*RADIATE"
            for element, face in _faces(mesh, condition.surface):
                yield f"{element}, R{face}, {condition.surroundings_temperature}, {condition.emissivity}"
    yield "*NODE FILE\nNT\n*END STEP"


def expansion_lines(
    mesh: NamedMesh,
    material: tuple[float, float, float],
    held: np.ndarray,
    temperature: np.ndarray,
    cold: float,
    solver: str,
) -> Iterator[str]:
    """Deck of free expansion on supports ``held`` (n_nodes, 3)."""
    yield from _geometry(mesh)
    yield f"*ELASTIC\n{material[0]}, {material[1]}\n*EXPANSION, ZERO={cold}\n{material[2]}"
    yield f"*SOLID SECTION, ELSET=ALL, MATERIAL=M\n*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNALL, {cold}"
    yield "*BOUNDARY"
    for node, axis in np.argwhere(held):
        yield f"{node + 1}, {axis + 1}, {axis + 1}"
    yield f"*STEP\n*STATIC{solver}\n*TEMPERATURE"
    for node, value in enumerate(temperature, start=1):
        yield f"{node}, {value:.12g}"
    yield "*NODE FILE\nU\n*END STEP"


def run(lines: Iterator[str], folder: Path, block: str, columns: int, n_nodes: int, threads: int = 1) -> Run:
    """Solve the deck; ``block`` is the name of the nodal result."""
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "job.inp").open("w") as deck:
        deck.writelines(f"{line}\n" for line in lines)
    measured = measure(["ccx", "-i", "job"], folder, {"OMP_NUM_THREADS": str(threads)})
    return Run(_read(folder / "job.frd", block, columns, n_nodes), *measured)


def measure(
    command: Sequence[str], folder: Path, environment: Mapping[str, str]
) -> tuple[float, float, float]:
    """Wall and processor seconds and peak memory [GB] of a process; RuntimeError with its words if it fails."""
    start = time.perf_counter()
    with (folder / "log.txt").open("w") as log:
        process = subprocess.Popen(
            command, cwd=folder, stdout=log, stderr=log, env={**os.environ, **environment}
        )
        _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise RuntimeError(f"{command[0]} failed: {(folder / 'log.txt').read_text()[-2000:]}")
    return time.perf_counter() - start, used.ru_utime + used.ru_stime, used.ru_maxrss / 1e6


def _geometry(mesh: NamedMesh) -> Iterator[str]:
    yield "*NODE, NSET=NALL"
    for number, (x, y, z) in enumerate(mesh.points, start=1):
        yield f"{number}, {x:.12g}, {y:.12g}, {z:.12g}"
    yield f"*ELEMENT, TYPE={ELEMENT[mesh.cells.shape[1]]}, ELSET=ALL"
    for number, nodes in enumerate(mesh.cells + 1, start=1):
        words = [str(number), *map(str, nodes)]
        yield ", ".join(words[:11]) + (",\n" + ", ".join(words[11:]) if len(words) > 11 else "")
    yield "*MATERIAL, NAME=M"


def _faces(mesh: NamedMesh, surface: str) -> list[tuple[int, int]]:
    """CalculiX element and face number of every facet."""
    faces = np.array(FACES[mesh.cells.shape[1]])
    keys = facet_keys(mesh.cells[:, faces].reshape(-1, faces.shape[1]), len(mesh.points))
    order = np.argsort(keys)
    wanted = facet_keys(mesh.surfaces[surface][:, : faces.shape[1]], len(mesh.points))
    at = order[np.searchsorted(keys[order], wanted)]
    return [(int(k // len(faces)) + 1, int(k % len(faces)) + 1) for k in at]


def _read(path: Path, block: str, columns: int, n_nodes: int) -> np.ndarray:
    values, inside = np.full((n_nodes, columns), np.nan), False
    with path.open() as text:
        for line in text:
            if line.startswith(" -4"):
                inside = block in line
            elif inside and line.startswith(" -1"):
                parts = [float(line[13 + 12 * k : 25 + 12 * k]) for k in range(columns)]
                values[int(line[3:13]) - 1] = parts
    assert np.isfinite(values).all(), f"{path} lacks {block} at some nodes"
    return values
