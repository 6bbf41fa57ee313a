"""CalculiX decks of plane bodies in contact: what ccx reads, and its results read back.

Millimetres, newtons, N/mm2. Contact is face to face with a linear penalty, without friction.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tests.builders.calculix import measure
from tests.reference.tooth_contact.section import PlaneMesh

Array = NDArray[np.float64]
Integers = NDArray[np.int64]
STEEL = (206000.0, 0.3)
PENALTY = 5e7
"""Stiffness of the contact [N/mm3]: 1000 N/mm2 give 0.02 um of penetration."""


@dataclass(frozen=True, kw_only=True)
class ContactPair:
    """Sides of bodies that may touch, body and names of sides; ``slave`` should be the one with a corner."""

    name: str
    slave: tuple[int, tuple[str, ...]]
    master: tuple[int, tuple[str, ...]]


@dataclass(frozen=True, kw_only=True)
class PlaneModel:
    """Bodies of one thickness [mm], plane strain, one driven and one held along a line of nodes.

    driven, held : body and name of line. The driven line turns about ``centre`` as a rigid body, clockwise, or, with
        ``lever`` None, moves along -y; its motion is counted at ``lever`` [mm] from the centre
    """

    bodies: Sequence[PlaneMesh]
    thickness: float
    pairs: Sequence[ContactPair]
    driven: tuple[int, str]
    held: tuple[int, str]
    lever: float | None
    centre: tuple[float, float] = (0.0, 0.0)
    penalty: float = PENALTY

    @property
    def starts(self) -> Integers:
        """Number of nodes before each body."""
        return np.cumsum([0, *(len(body.points) for body in self.bodies)])


@dataclass(frozen=True, kw_only=True)
class PlaneResult:
    """approach : motion of the driven line [mm]; forces : pair -> force on the slave (2,) [N] and its moment about
    the origin [N mm]; displacement (n, 2) [mm] and stress (n, 4) xx yy zz xy [N/mm2] of the nodes of all bodies;
    pressure : pair -> largest pressure at a node of the slave; pressure_at (n,) that of every node [N/mm2]
    """

    approach: float
    forces: dict[str, tuple[Array, float]]
    displacement: Array
    stress: Array
    pressure: dict[str, float]
    pressure_at: Array
    seconds: float


def solve(model: PlaneModel, folder: Path, *, first: Sequence[float], force: float | None) -> PlaneResult:
    """Move the driven line by the amounts ``first`` [mm] in turn, then, unless None, load it with ``force`` [N]."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "job.inp").write_text("".join(f"{line}\n" for line in _lines(model, first, force)))
    _, seconds, _ = measure(["ccx", "-i", "job"], folder, {"OMP_NUM_THREADS": "1"})
    return _read(model, folder, seconds)


def _lines(model: PlaneModel, first: Sequence[float], force: float | None) -> Iterator[str]:
    starts = model.starts
    driver = int(starts[-1]) + 1
    yield "*NODE, NSET=NALL"
    number = 0
    for body in model.bodies:
        for x, y in body.points:
            number += 1
            yield f"{number}, {x:.14g}, {y:.14g}, 0."
    yield f"*NODE, NSET=DRIVER\n{driver}, {model.centre[0]}, {model.centre[1]}, 0."
    first_cell, cell_starts = 0, []
    for start, body in zip(starts, model.bodies, strict=False):
        yield "*ELEMENT, TYPE=CPE6, ELSET=ALL"
        cell_starts.append(first_cell)
        for k, nodes in enumerate(body.cells + start + 1, start=first_cell + 1):
            yield f"{k}, " + ", ".join(map(str, nodes))
        first_cell += len(body.cells)
    yield f"*MATERIAL, NAME=STEEL\n*ELASTIC\n{STEEL[0]}, {STEEL[1]}"
    yield f"*SOLID SECTION, ELSET=ALL, MATERIAL=STEEL\n{model.thickness}"
    yield "*SURFACE INTERACTION, NAME=TOUCH\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR"
    yield f"{model.penalty}"
    for pair in model.pairs:
        for role, (body, names) in (("S", pair.slave), ("M", pair.master)):
            yield f"*SURFACE, NAME={role}{pair.name}, TYPE=ELEMENT"
            for name in names:
                for cell, side in model.bodies[body].sides[name]:
                    yield f"{cell + cell_starts[body] + 1}, S{side + 1}"
        yield "*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE"
        yield f"S{pair.name}, M{pair.name}"
    yield from _driven(model, driver)
    held = model.bodies[model.held[0]].lines[model.held[1]] + starts[model.held[0]] + 1
    fixed = [f"{node}, 1, 2" for node in np.unique(held)]
    for value in first:
        yield from ("*STEP, INC=200", "*STATIC", "1., 1.", "*BOUNDARY", *fixed)
        yield f"{driver}, 1, 1, {value:.12g}\n{driver}, 2, 3"
        yield from _output(model, last=force is None and value == first[-1])
    if force is not None:
        yield from ("*STEP, INC=200, AMPLITUDE=STEP", "*STATIC", "1., 1.", "*BOUNDARY, OP=NEW", *fixed)
        yield f"{driver}, 2, 3\n*CLOAD, OP=NEW\n{driver}, 1, {force:.12g}"
        yield from _output(model, last=True)


def _driven(model: PlaneModel, driver: int) -> Iterator[str]:
    body, line = model.driven
    nodes = np.unique(model.bodies[body].lines[line])
    for node in nodes:
        number = node + model.starts[body] + 1
        x, y = model.bodies[body].points[node] - np.asarray(model.centre)
        if model.lever is None:
            yield f"*EQUATION\n2\n{number}, 2, 1., {driver}, 1, 1."
            yield f"*BOUNDARY\n{number}, 1, 1"
            continue
        yield f"*EQUATION\n2\n{number}, 1, 1., {driver}, 1, {-y / model.lever:.14g}"
        yield f"*EQUATION\n2\n{number}, 2, 1., {driver}, 1, {x / model.lever:.14g}"


def _output(model: PlaneModel, *, last: bool) -> Iterator[str]:
    yield "*NODE PRINT, NSET=DRIVER\nU"
    for pair in model.pairs:
        yield f"*CONTACT PRINT, SLAVE=S{pair.name}, MASTER=M{pair.name}\nCF"
    if last:
        yield "*NODE FILE, OUTPUT=2D\nU\n*EL FILE, OUTPUT=2D\nS\n*CONTACT FILE\nCDIS"
    yield "*END STEP"


def _read(model: PlaneModel, folder: Path, seconds: float) -> PlaneResult:
    approach, forces = _printed(folder / "job.dat", [pair.name for pair in model.pairs])
    n_nodes = int(model.starts[-1])
    displacement = nodal_values(folder / "job.frd", "DISP", 2, n_nodes)
    stress = nodal_values(folder / "job.frd", "STRESS", 4, n_nodes)
    pressure = nodal_values(folder / "job.frd", "CONTACT", 4, n_nodes)[:, 3]
    return PlaneResult(
        approach=approach,
        forces=forces,
        displacement=displacement,
        stress=stress,
        pressure_at=pressure,
        pressure={pair.name: _largest(model, pair, pressure) for pair in model.pairs},
        seconds=seconds,
    )


def _largest(model: PlaneModel, pair: ContactPair, pressure: Array) -> float:
    body, names = pair.slave
    nodes = np.concatenate([model.bodies[body].lines[name] for name in names]) + model.starts[body]
    return float(pressure[nodes].max())


def _printed(path: Path, names: Sequence[str]) -> tuple[float, dict[str, tuple[Array, float]]]:
    """Last motion of the driver and last force and moment of every pair."""
    lines = path.read_text().splitlines()
    approach, forces = float("nan"), {}
    for k, line in enumerate(lines):
        if "set DRIVER" in line:
            approach = float(lines[k + 2].split()[1])
        elif "total surface force" in line:
            name = (
                next(word for word in reversed(lines[:k]) if "slave set" in word)
                .split("set S")[1]
                .split(",")[0]
            )
            values = [float(word) for word in lines[k + 2].split()]
            forces[name] = (np.array(values[:2]), values[5])
    assert set(forces) == set(names), f"{path} lacks the forces of {set(names) - set(forces)}"
    return approach, forces


def nodal_values(path: Path, block: str, columns: int, n_nodes: int) -> Array:
    """(n_nodes, columns) values of the last block of this name in a result file; nodes beyond are left out."""
    return nodal_blocks(path, block, columns, n_nodes)[-1]


def nodal_blocks(path: Path, block: str, columns: int, n_nodes: int) -> list[Array]:
    """(n_nodes, columns) values of every block of this name, step after step."""
    found: list[Array] = []
    inside = False
    with path.open() as text:
        for line in text:
            if line.startswith(" -4"):
                inside = line.split()[1] == block
                if inside:
                    found.append(np.full((n_nodes, columns), np.nan))
            elif inside and line.startswith(" -1"):
                node = int(line[3:13]) - 1
                if node < n_nodes:
                    found[-1][node] = [float(line[13 + 12 * k : 25 + 12 * k]) for k in range(columns)]
    assert found and np.isfinite(found).all(), f"{path} lacks {block} at some nodes"
    return found
