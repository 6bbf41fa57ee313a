"""One heat or expansion problem as a process of its own: reads the mesh, solves, writes the nodal values.

    python fe_process.py heat|expansion folder

folder/problem.npz holds the mesh, folder/given.json the conditions; folder/values.npy and folder/times.json
are written. Compilation is taken from numba's cache.
"""

import json
import sys
import time
from pathlib import Path

import numpy as np

from thermal.boundary import Adiabatic, BoundaryCondition, Film, FilmCoefficient, FilmLaw, Radiation
from thermal.conduction import ConductionSetup, solve_steady
from thermal.elastic import ElasticSetup
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import NamedMesh


def load_mesh(folder: Path) -> tuple[NamedMesh, dict[str, np.ndarray]]:
    with np.load(folder / "problem.npz") as stored:
        arrays = dict(stored)
    parts: dict[str, dict[str, np.ndarray]] = {"body": {}, "surface": {}}
    for key in list(arrays):
        kind, _, name = key.partition("/")
        if kind in parts:
            parts[kind][name] = arrays.pop(key)
    mesh = NamedMesh(arrays.pop("points"), arrays.pop("cells"), parts["body"], parts["surface"])
    return mesh, arrays


def save_mesh(folder: Path, mesh: NamedMesh, **more: np.ndarray) -> None:
    named = {f"body/{name}": cells for name, cells in mesh.bodies.items()}
    named |= {f"surface/{name}": nodes for name, nodes in mesh.surfaces.items()}
    np.savez(folder / "problem.npz", points=mesh.points, cells=mesh.cells, **named, **more)


def constant(value: float) -> FilmLaw:
    record = FilmCoefficient(value=value, formula="given", inputs={}, valid_range="any", source="benchmark")
    return lambda wall, fluid: record


def conditions(mesh: NamedMesh, films: dict[str, tuple[float, float]], radiating: dict[str, tuple[float, float]],
               warmer: float = 0.0) -> list[BoundaryCondition]:  # fmt: skip
    """Films (coefficient, fluid temperature) and radiation (emissivity, surroundings) by surface."""
    found: list[BoundaryCondition] = []
    for name in mesh.surfaces:
        if name in films:
            value, fluid = films[name]
            fluid += warmer if fluid > 400.0 else 0.0
            found.append(Film(surface=name, kind="film", fluid_temperature=fluid, law=constant(value)))
        if name in radiating:
            emissivity, room = radiating[name]
            found.append(Radiation(surface=name, emissivity=emissivity, surroundings_temperature=room))
        if name not in films and name not in radiating:
            found.append(Adiabatic(surface=name))
    return found


def main(what: str, folder: Path) -> None:
    mesh, arrays = load_mesh(folder)
    given = json.loads((folder / "given.json").read_text())
    marks = [time.process_time()]
    elements = FiniteElements(mesh)
    marks.append(time.process_time())
    if what == "heat":
        conductivity = dict.fromkeys(mesh.bodies, given["conductivity"])
        setup = ConductionSetup(mesh, conductivity, elements)
        marks.append(time.process_time())
        first = solve_steady(
            mesh, conductivity, conditions(mesh, given["films"], given["radiating"]), reuse=setup
        )
        marks.append(time.process_time())
        warmer = conditions(mesh, given["films"], given["radiating"], warmer=5.0)
        again = solve_steady(mesh, conductivity, warmer, near=first, reuse=setup)
        marks.append(time.process_time())
        values, iterations = first.temperature, [first.linear_iterations, again.linear_iterations]
    else:
        elastic = ElasticSetup(elements, dict.fromkeys(mesh.bodies, given["elastic"]), arrays["held"])
        marks.append(time.process_time())
        solution = elastic.solve(arrays["temperature"], given["cold"])
        marks.append(time.process_time())
        again_solution = elastic.solve(arrays["temperature"] + 5.0, given["cold"], start=solution.values)
        marks.append(time.process_time())
        values, iterations = solution.values, [(solution.iterations,), (again_solution.iterations,)]
    np.save(folder / "values.npy", values)
    spaces, setting, solving, repeating = np.diff(marks)
    times = {
        "spaces": spaces,
        "setup": setting,
        "solve": solving,
        "again": repeating,
        "iterations": iterations,
    }
    (folder / "times.json").write_text(json.dumps(times))


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
