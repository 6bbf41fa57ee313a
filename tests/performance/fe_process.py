"""One heat or expansion problem as a process of its own: reads the mesh, solves, writes the nodal values.

    python fe_process.py heat|expansion folder [again]

folder/mesh.msh holds the mesh, folder/given.json the conditions, folder/problem.npz supports and temperature of
an expansion; folder/values.npy and folder/times.json are written. With ``again`` the problem is solved a second
time with the oil 5 K warmer, from the first solution. Compilation is taken from numba's cache. Dense linear algebra
runs on one thread, as in every run of a case: its other threads would only wait, at 3 s of processor time.
"""

import json
import sys
import time
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from thermal.conditions.boundary import Adiabatic, BoundaryCondition, Film, Radiation
from thermal.conduction.steady import ConductionSetup, solve_steady
from thermal.expansion.elastic import ElasticSetup
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import NamedMesh
from thermal.films.law import FilmCoefficient, FilmLaw
from thermal.housing.mesh_file import read_mesh


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


def main(what: str, folder: Path, again: bool) -> None:
    given = json.loads((folder / "given.json").read_text())
    marks = [time.process_time()]
    mesh = read_mesh(folder / "mesh.msh")
    marks.append(time.process_time())
    elements = FiniteElements(mesh)
    marks.append(time.process_time())
    iterations: list[tuple[int, ...]]
    if what == "heat":
        conductivity = dict.fromkeys(mesh.bodies, given["conductivity"])
        setup = ConductionSetup(mesh, conductivity, elements)
        marks.append(time.process_time())
        first = solve_steady(setup, conditions(mesh, given["films"], given["radiating"]))
        marks.append(time.process_time())
        values, iterations = first.temperature, [first.linear_iterations]
        if again:
            warmer = conditions(mesh, given["films"], given["radiating"], warmer=5.0)
            second = solve_steady(setup, warmer, near=first)
            iterations.append(second.linear_iterations)
    else:
        with np.load(folder / "problem.npz") as stored:
            held, temperature = stored["held"], stored["temperature"]
        elastic = ElasticSetup(elements, dict.fromkeys(mesh.bodies, given["elastic"]), held)
        marks.append(time.process_time())
        solution = elastic.solve(temperature, given["cold"])
        marks.append(time.process_time())
        values, iterations = solution.values, [(solution.iterations,)]
        if again:
            second_solution = elastic.solve(temperature + 5.0, given["cold"])
            iterations.append((second_solution.iterations,))
    marks.append(time.process_time())
    np.save(folder / "values.npy", values)
    names = ("reading", "spaces", "setup", "solve", "again")
    times = dict(zip(names, np.diff(marks).tolist(), strict=True)) | {"iterations": iterations}
    (folder / "times.json").write_text(json.dumps(times))


if __name__ == "__main__":
    with threadpool_limits(limits=1, user_api="blas"):
        main(sys.argv[1], Path(sys.argv[2]), "again" in sys.argv[3:])
