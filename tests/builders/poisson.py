"""Poisson's equation with a known solution."""

import numpy as np

from tests.builders.direct_solution import solve_direct
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import FloatArray, NamedMesh
from thermal.fe.solver import constrain


def solved(
    mesh: NamedMesh, exact: FloatArray, source: FloatArray, insulated: tuple[str, ...] = ()
) -> tuple[FiniteElements, FloatArray]:
    """-lap u = source, k = 1, with u given on all surfaces but the ``insulated`` ones."""
    elements = FiniteElements(mesh)
    level = elements.fine
    matrix = level.matrix(level.conduction(np.ones(len(mesh.cells))))
    values, weights = elements.at_points(source)
    per_point = values.reshape(len(mesh.cells), -1) * weights.reshape(len(mesh.cells), -1)
    load = np.zeros(len(mesh.points))
    np.add.at(load, mesh.cells, per_point @ elements.shape.values(elements.shape.load_rule.points))
    held = np.zeros(len(mesh.points), dtype=bool)
    for name, nodes in mesh.surfaces.items():
        held[nodes] |= name not in insulated
    u = np.where(held, exact, 0.0)
    right = np.where(held, u * matrix.diagonal(), load - matrix @ u)
    return elements, solve_direct(constrain(matrix, held), right)
