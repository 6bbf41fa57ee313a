"""Thermo-elastic displacement of a mesh: K u = int B^T D alpha (T - T0).

Every connected piece must be supported; `three_two_one` gives a statically determinate support, under which a
piece swells freely: the supports carry nothing whatever its temperature field.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from typing import NamedTuple

import numpy as np

from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import FloatArray, IndexArray
from thermal.fe.solver import BoolArray, TwoLevelMultigrid, conjugate_gradient, constrain


class ElasticError(ValueError):
    """Elastic data or supports that cannot be computed; the message names body, value, limit and remedy."""


class Elastic(NamedTuple):
    """Isotropic elastic material."""

    young: float
    """[Pa]"""
    poisson: float
    expansion: float
    """Mean coefficient of linear expansion between cold and hot [1/K]."""


@dataclass(frozen=True)
class Displacement:
    """Displacement (n_nodes, 3) [m], support reactions (n_nodes, 3) [N] and residuals of the linear solve."""

    values: FloatArray
    reactions: FloatArray
    residuals: tuple[float, ...]

    @property
    def iterations(self) -> int:
        """Iterations of conjugate gradients."""
        return len(self.residuals) - 1


class ElasticSetup:
    """Stiffness and multigrid of a supported mesh, made once and used for every temperature field.

    elements : spaces on the mesh
    elastic : body -> (Young's modulus [Pa], Poisson's ratio, expansion coefficient [1/K])
    fixed : (n_nodes, 3) True where a displacement is held at zero; must hold every piece
    Raises ElasticError for missing, unknown or impossible materials, and for a piece without six held
    directions.
    """

    def __init__(
        self, elements: FiniteElements, elastic: Mapping[str, tuple[float, float, float]], fixed: BoolArray
    ) -> None:
        self.elements = elements
        self.elastic = check_elastic(elements, elastic)
        self.fixed = fixed
        _check_held(elements, fixed)
        young = elements.per_cell({body: m.young for body, m in self.elastic.items()})
        poisson = elements.per_cell({body: m.poisson for body, m in self.elastic.items()})
        alpha = elements.per_cell({body: m.expansion for body, m in self.elastic.items()})
        self._alpha = np.empty(len(elements.mesh.points))
        self._alpha[elements.mesh.cells] = alpha[:, None]
        self._factor = alpha * young / (1.0 - 2.0 * poisson)
        fine = elements.elasticity(young, poisson, elements.fine)
        coarse = elements.elasticity(young, poisson, elements.coarse)
        self._held_rows = _rows_of(elements, fine, fixed)
        self._flat = fixed.ravel()
        held_corners = fixed[elements.corners].ravel()
        self.matrix = constrain(elements.fine.block_matrix(fine), self._flat)
        coarse_matrix = constrain(elements.coarse.block_matrix(coarse), held_corners)
        self.multigrid = TwoLevelMultigrid(
            self.matrix, coarse_matrix, elements.prolongation, self._flat, held_corners
        )

    def load(self, temperature: FloatArray, reference: float) -> FloatArray:
        """Nodal forces (n_nodes, 3) [N] that free expansion from ``reference`` [K] calls for."""
        return self.elements.expansion_load(self._factor, temperature - reference)

    def free_strain(self, temperature: FloatArray, reference: float) -> FloatArray:
        """(n_nodes,) alpha (T - T0); a node between bodies takes one of their alphas."""
        return self._alpha * (temperature - reference)

    def solve(
        self,
        temperature: FloatArray,
        reference: float,
        tolerance: float = 1e-8,
        start: FloatArray | None = None,
    ) -> Displacement:
        """Displacement under a nodal temperature (n_nodes,) [K]; raises NotConverged with its residuals.

        start : (n_nodes, 3) displacement of a neighbouring temperature field [m]
        """
        load = self.load(temperature, reference)
        right = np.where(self.fixed, 0.0, load).ravel()
        first = None if start is None else start.ravel()
        solution = conjugate_gradient(self.matrix, right, self.multigrid, start=first, tolerance=tolerance)
        values = solution.values.reshape(-1, 3)
        rows, columns, blocks = self._held_rows
        forces = np.zeros_like(values)
        np.add.at(forces, rows, np.einsum("kij,kj->ki", blocks, values[columns]))
        reactions = np.where(self.fixed, forces - load, 0.0)
        return Displacement(values, reactions, solution.residuals)


def check_elastic(
    elements: FiniteElements, elastic: Mapping[str, tuple[float, float, float]]
) -> dict[str, Elastic]:
    """Elastic data of every body, checked (ElasticError)."""
    bodies = elements.mesh.bodies
    for name in elastic:
        if name not in bodies:
            near = get_close_matches(name, bodies, n=3, cutoff=0.4) or sorted(bodies)
            raise ElasticError(f"unknown body {name!r}; nearest: {', '.join(near)}")
    if missing := sorted(set(bodies) - set(elastic)):
        raise ElasticError(
            f"no elastic data for body {', '.join(missing)}; give E, nu and alpha for every body"
        )
    materials = {name: Elastic(*values) for name, values in elastic.items()}
    for name, material in materials.items():
        if not (math.isfinite(material.young) and material.young > 0.0):
            raise ElasticError(f"body {name!r}: Young's modulus {material.young} Pa must be positive")
        if not -1.0 < material.poisson < 0.5:
            raise ElasticError(f"body {name!r}: Poisson's ratio {material.poisson} is outside of -1 to 0.5")
        if not math.isfinite(material.expansion):
            raise ElasticError(f"body {name!r}: expansion coefficient {material.expansion} 1/K is no number")
    return materials


def three_two_one(points: FloatArray, nodes: IndexArray) -> list[tuple[int, tuple[int, ...]]]:
    """Statically determinate support on three of ``nodes`` (k,): (node, held directions) three times.

    points : (n_nodes, 3) [m]. The first node is held in x, y and z, the second across its line to the first,
    the third across the plane of the three. Raises ElasticError if all nodes lie on one line.
    """
    at = points[nodes]
    first = int(np.argmax(np.linalg.norm(at - at.mean(axis=0), axis=1)))
    second = int(np.argmax(np.linalg.norm(at - at[first], axis=1)))
    a, b = at[first], at[second]
    normals = np.cross(b - a, at - a)
    third = int(np.argmax(np.linalg.norm(normals, axis=1)))
    if np.linalg.norm(normals[third]) <= 1e-9 * float((b - a) @ (b - a)):
        raise ElasticError("support surface: all its nodes lie on one line; choose a surface with an extent")
    along = int(np.argmax(np.abs(b - a)))
    across = int(np.argmax(np.abs(normals[third])))
    return [
        (int(nodes[first]), (0, 1, 2)),
        (int(nodes[second]), tuple(i for i in range(3) if i != along)),
        (int(nodes[third]), (across,)),
    ]


def rigid_motion(
    points: FloatArray, displacement: FloatArray, weights: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Rigid part of a displacement: centre (3,) [m], shift (3,) [m] and rotation (3,) [rad] about the centre.

    points, displacement : (n, 3) [m]; weights : (n,) of the least-squares fit.
    """
    centre = weights @ points / weights.sum()
    arm = points - centre
    basis = np.zeros((len(points), 3, 6))
    basis[:, :, :3] = np.eye(3)
    for axis in range(3):
        basis[:, :, 3 + axis] = np.cross(np.eye(3)[axis], arm)
    root = np.sqrt(weights)[:, None]
    matrix = (basis * root[:, :, None]).reshape(-1, 6)
    motion = np.asarray(np.linalg.lstsq(matrix, (displacement * root).ravel())[0])
    return centre, motion[:3], motion[3:]


def _check_held(elements: FiniteElements, fixed: BoolArray) -> None:
    mesh = elements.mesh
    piece = elements.piece_of_node
    held = np.bincount(piece, fixed.sum(axis=1), minlength=int(piece.max()) + 1)
    for number in np.flatnonzero(held < 6):
        names = [b for b, cells in mesh.bodies.items() if (elements.components[cells] == number).any()]
        raise ElasticError(
            f"body {', '.join(names)} is held in {held[number]:.0f} directions; a piece needs at least six"
        )


def _rows_of(
    elements: FiniteElements, blocks: FloatArray, fixed: BoolArray
) -> tuple[IndexArray, IndexArray, FloatArray]:
    """Rows, columns and blocks of the matrix entries whose row has a held direction."""
    level = elements.fine
    rows = np.repeat(np.arange(level.n_nodes, dtype=np.int32), np.diff(level.indptr))
    held: BoolArray = np.asarray(fixed.any(axis=1))
    chosen = np.flatnonzero(held[rows])
    return rows[chosen], level.indices[chosen], blocks[chosen]
