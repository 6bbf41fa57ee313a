"""Memory that heat and expansion take at most, by node of the mesh, as tracemalloc sees it."""

import tracemalloc
from collections.abc import Callable

import numpy as np
import pytest

from tests.builders.two_blocks import law
from thermal.conditions.boundary import BoundaryCondition, Film, Radiation
from thermal.conduction.setup import ConductionSetup
from thermal.conduction.steady import solve_steady
from thermal.expansion.elastic import ElasticSetup, three_two_one
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import NamedMesh, box_mesh


def peak_by_node(work: Callable[[NamedMesh], object]) -> float:
    """Greatest memory [byte] taken at a time by ``work`` on a box, what numba loads left out."""
    mesh = box_mesh((1.0, 1.0, 1.0), (14, 14, 14))
    work(mesh)
    tracemalloc.start()
    try:
        work(mesh)
        return tracemalloc.get_traced_memory()[1] / len(mesh.points)
    finally:
        tracemalloc.stop()


def heat(mesh: NamedMesh) -> None:
    conditions: list[BoundaryCondition] = [
        Film(surface=name, kind="film", fluid_temperature=300.0 + 40.0 * k, law=law(200.0))
        for k, name in enumerate(mesh.surfaces)
    ]
    conditions.append(Radiation(surface="z_max", emissivity=0.6, surroundings_temperature=300.0))
    solve_steady(ConductionSetup(mesh, {"box": 45.0}), conditions)


def expansion(mesh: NamedMesh, clamped: bool) -> None:
    """On six supports, or with one face clamped."""
    elements = FiniteElements(mesh)
    held = np.zeros((len(mesh.points), 3), dtype=bool)
    for node, directions in three_two_one(mesh.points, elements.corners):
        held[node, list(directions)] = True
    if clamped:
        held[elements.surfaces["z_min"].nodes] = True
    setup = ElasticSetup(elements, {"box": (210e9, 0.3, 1e-5)}, held)
    setup.solve(300.0 + 100.0 * np.sin(9.0 * mesh.points).sum(axis=1), 293.0)


def test_heat_holds_no_krylov_basis_and_no_matrix_of_the_step_before() -> None:
    # the matrix takes 220 byte a node, its copy in single precision 110; 2050 with a basis and two old matrices
    assert peak_by_node(heat) < 1900.0


@pytest.mark.parametrize("clamped", [False, True])
def test_expansion_holds_the_stiffness_once_in_each_precision(clamped: bool) -> None:
    # the stiffness takes 1950 byte a node, its copy in single precision 980; 5290 where the linear space is made
    # after it, 7340 where a clamped face needs a second stiffness
    assert peak_by_node(lambda mesh: expansion(mesh, clamped)) < 4950.0
