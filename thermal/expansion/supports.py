"""Supports of elastic bodies, and the pieces that could do without them.

Six supports that let a piece expand freely carry nothing under a load in equilibrium, as free expansion is.
Held at three nodes, though, a fine mesh is so soft there that an iteration wastes its steps on it. So such a
piece is solved floating, in the space its rigid motions leave, and afterwards moved onto its supports.
"""

from dataclasses import dataclass

import numpy as np

from thermal.errors import ThermalInputError
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import FloatArray, IndexArray
from thermal.fe.solver import BoolArray

DETERMINATE = 1e-6
"""Least over largest singular value of what six supports say about a rigid motion."""


class ElasticError(ThermalInputError):
    """Elastic data or supports that cannot be computed; the message names body, value, limit and remedy."""


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


def check_held(elements: FiniteElements, fixed: BoolArray) -> None:
    """Check that every connected piece has six held directions or more (ElasticError)."""
    mesh = elements.mesh
    piece = elements.piece_of_node
    held = np.bincount(piece, fixed.sum(axis=1), minlength=int(piece.max()) + 1)
    for number in np.flatnonzero(held < 6):
        names = [b for b, cells in mesh.bodies.items() if (elements.components[cells] == number).any()]
        raise ElasticError(
            f"body {', '.join(names)} is held in {held[number]:.0f} directions; a piece needs at least six"
        )


@dataclass(frozen=True, eq=False)
class FreePieces:
    """Pieces on exactly six supports that determine their rigid motion.

    points : (n_nodes, 3) [m]; fixed : (n_nodes, 3) supports; members : nodes of every such piece
    """

    points: FloatArray
    fixed: BoolArray
    members: tuple[IndexArray, ...]

    @classmethod
    def of(cls, elements: FiniteElements, fixed: BoolArray) -> "FreePieces":
        """Find them; fixed : (n_nodes, 3) held directions."""
        piece = elements.piece_of_node
        held = np.bincount(piece, fixed.sum(axis=1), minlength=int(piece.max()) + 1)
        points = elements.mesh.points
        members = (np.flatnonzero(piece == number).astype(np.int32) for number in np.flatnonzero(held == 6))
        determinate = (nodes for nodes in members if _is_determinate(points[nodes], fixed[nodes]))
        return cls(points, fixed, tuple(determinate))

    @property
    def nodes(self) -> BoolArray:
        """(n_nodes,) True for nodes of these pieces."""
        result = np.zeros(len(self.points), dtype=np.bool_)
        for nodes in self.members:
            result[nodes] = True
        return result

    @property
    def pins(self) -> BoolArray:
        """(n_nodes, 3) the supports of these pieces."""
        return np.asarray(self.fixed & self.nodes[:, None])

    def onto_supports(self, displacement: FloatArray) -> FloatArray:
        """Displacement (n_nodes, 3) [m] with every piece moved rigidly so that its supports stand still."""
        moved = displacement.copy()
        for nodes in self.members:
            modes, held = _motions(self.points[nodes]), self.fixed[nodes].ravel()
            shares = np.linalg.solve(modes[held], displacement[nodes].ravel()[held])
            moved[nodes] -= (modes @ shares).reshape(-1, 3)
        return np.where(self.pins, 0.0, moved)

    def reactions(self, load: FloatArray) -> FloatArray:
        """Forces (n_nodes, 3) [N] with which six supports balance what ``load`` lacks to equilibrium."""
        result = np.zeros_like(load)
        for nodes in self.members:
            modes, held = _motions(self.points[nodes]), self.fixed[nodes]
            forces = np.zeros(held.shape)
            forces[held] = np.linalg.solve(modes[held.ravel()].T, -(modes.T @ load[nodes].ravel()))
            result[nodes] = forces
        return result


def _motions(points: FloatArray) -> FloatArray:
    """(3 n, 6) shifts and turns about the middle, turns scaled with the size of the piece."""
    arm = points - points.mean(axis=0)
    arm = arm / max(float(np.abs(arm).max()), 1e-300)
    modes = np.zeros((len(points), 3, 6))
    modes[:, :, :3] = np.eye(3)
    for axis in range(3):
        modes[:, :, 3 + axis] = np.cross(np.eye(3)[axis], arm)
    return modes.reshape(-1, 6)


def _is_determinate(points: FloatArray, fixed: BoolArray) -> bool:
    sizes = np.linalg.svd(_motions(points)[fixed.ravel()], compute_uv=False)
    return bool(sizes[-1] > DETERMINATE * sizes[0])
