"""Thermo-elastic displacement of a mesh: K u = int B^T D alpha (T - T0).

Every connected piece must be supported; `three_two_one` gives a statically determinate support, under which a
piece expands freely: the supports carry nothing whatever its temperature field. Such a piece is solved without
its supports, which would strain the three nodes they hold, and then moved as a rigid body onto them.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy import sparse
from scipy.linalg import LinAlgError

from thermal.errors import ThermalInputError, ThermalNotConverged
from thermal.fe.aggregation import rigid_modes
from thermal.fe.curved import linear_stiffness
from thermal.fe.direct_factor import DirectFactor
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import FloatArray, IndexArray
from thermal.fe.solver import (
    BoolArray,
    HeldMatrix,
    LinearSolution,
    TwoLevelMultigrid,
    conjugate_gradient,
    constrain,
)
from thermal.housing.stations import GearboxModel

__all__ = [
    "Displacement",
    "Elastic",
    "ElasticError",
    "ElasticSetup",
    "check_elastic",
    "rigid_motion",
    "three_two_one",
]

DIRECT = 100_000
"""Unknowns up to which a direct solution steps in where conjugate gradients stall."""


MOST_KNOWN = 4
"""Solutions from which the next one starts."""
INDEPENDENT = 1e-3
"""Least eigenvalue of the energies of their steps, over the largest, that counts."""


class Elastic(NamedTuple):
    """Isotropic elastic material."""

    young: float
    """[Pa]"""
    poisson: float
    expansion: float
    """Mean coefficient of linear expansion between the reference temperature and the hot one [1/K]."""


class Known(NamedTuple):
    """A right-hand side (n,) [N] of held degrees of freedom zero, and what it gave (n,) [m]."""

    load: FloatArray
    values: FloatArray


@dataclass(frozen=True)
class Displacement:
    """Displacement (n_nodes, 3) [m], support reactions (n_nodes, 3) [N] and residuals of the linear solve."""

    values: FloatArray
    reactions: FloatArray
    residuals: tuple[float, ...]
    known: tuple[Known, ...] = ()
    """This solution and some before it, from which the next one starts."""

    @property
    def iterations(self) -> int:
        """Iterations of conjugate gradients."""
        return len(self.residuals) - 1


def _combination(known: Sequence[Known], load: FloatArray) -> FloatArray | None:
    """The last solution and what of the steps that led there brings it nearest in energy; None without any."""
    if not known:
        return None
    last = known[-1]
    steps = np.array([after.values - before.values for before, after in pairwise(known)])
    if not len(steps):
        return last.values
    forces = np.array([after.load - before.load for before, after in pairwise(known)])
    work = steps @ forces.T
    size = np.sqrt(np.maximum(np.diag(work), 1e-300))
    matrix = 0.5 * (work + work.T) / np.outer(size, size)
    shares = np.linalg.lstsq(matrix, steps @ (load - last.load) / size, rcond=INDEPENDENT)[0]
    return np.asarray(last.values + (shares / size) @ steps)


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
        check_held(elements, fixed)
        young = elements.per_cell({body: m.young for body, m in self.elastic.items()})
        poisson = elements.per_cell({body: m.poisson for body, m in self.elastic.items()})
        alpha = elements.per_cell({body: m.expansion for body, m in self.elastic.items()})
        self._alpha = np.empty(len(elements.mesh.points))
        self._alpha[elements.mesh.cells] = alpha[:, None]
        self._factor = alpha * young / (1.0 - 2.0 * poisson)
        fine = elements.fine.elasticity(young, poisson)
        self.free = FreePieces.of(elements, fixed)
        """Pieces on six determinate supports, solved without them."""
        constrained = fixed & ~self.free.nodes[:, None]
        self._constrained_rows = _rows_of(elements, fine, constrained)
        self._constrained = constrained.ravel()
        fixed_corners = constrained[elements.corners].ravel()
        self.matrix = constrain(elements.fine.block_matrix(fine), self._constrained, overwrite=True)
        coarse_matrix = constrain(linear_stiffness(elements, young, poisson), fixed_corners, overwrite=True)
        modes = rigid_modes(elements.mesh.points[elements.corners])
        self.multigrid = TwoLevelMultigrid(
            HeldMatrix(self.matrix, self._constrained),
            HeldMatrix(coarse_matrix, fixed_corners),
            elements.prolongation,
            modes,
        )

    def load(self, temperature: FloatArray, reference: float) -> FloatArray:
        """Nodal forces (n_nodes, 3) [N] that free expansion from ``reference`` [K] calls for."""
        return self.elements.fine.expansion_load(self._factor, temperature - reference)

    def free_strain(self, temperature: FloatArray, reference: float) -> FloatArray:
        """(n_nodes,) alpha (T - T0); a node between bodies takes one of their alphas."""
        return self._alpha * (temperature - reference)

    def solve(
        self,
        temperature: FloatArray,
        reference: float,
        tolerance: float = 1e-8,
        known: Sequence[Known] = (),
    ) -> Displacement:
        """Displacement under a nodal temperature (n_nodes,) [K]; raises ThermalNotConverged with its residuals.

        known : of neighbouring temperature fields; the solve starts from the combination of them that is nearest in
            energy (Fischer, Comput. Methods Appl. Mech. Eng. 163 (1998) 193)
        """
        load = self.load(temperature, reference)
        right = np.where(self._constrained, 0.0, load.ravel())
        solution = self._solved(right, _combination(known, right), tolerance)
        values = self.free.onto_supports(solution.values.reshape(-1, 3))
        rows, columns, blocks = self._constrained_rows
        forces = np.zeros_like(values)
        np.add.at(forces, rows, np.einsum("kij,kj->ki", blocks, values[columns]))
        reactions = np.where(self._constrained.reshape(-1, 3), forces - load, 0.0)
        reactions += self.free.reactions(load)
        latest = (*known, Known(right, solution.values))[-MOST_KNOWN:]
        return Displacement(values, reactions, solution.residuals, latest)

    def deflection(self, load: FloatArray, tolerance: float = 1e-8) -> FloatArray:
        """Displacement (n_nodes, 3) [m] under nodal forces (n_nodes, 3) [N]; those on free pieces must balance.

        Raises ThermalNotConverged with its residuals.
        """
        solution = self._solved(np.where(self._constrained, 0.0, load.ravel()), None, tolerance)
        return self.free.onto_supports(solution.values.reshape(-1, 3))

    def _solved(self, load: FloatArray, start: FloatArray | None, tolerance: float) -> LinearSolution:
        """Conjugate gradients; where they stall on a small mesh, of very flat cells say, a direct solution."""
        try:
            return conjugate_gradient(self.matrix, load, self.multigrid, start=start, tolerance=tolerance)
        except ThermalNotConverged as stalled:
            if len(load) > DIRECT:
                raise
            constrained = self._constrained | self.free.pins.ravel()
            matrix = sparse.csr_array(constrain(self.matrix, constrained))
            try:
                factor = DirectFactor(matrix, self.elements.mesh.points, np.arange(0, len(load), 3))
            except LinAlgError:
                raise stalled from None
            values = factor(np.where(constrained, 0.0, load))
            left = float(np.linalg.norm(load - self.matrix @ values) / np.linalg.norm(load))
            return LinearSolution(values, (*stalled.residuals, left))


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


def _rows_of(
    elements: FiniteElements, blocks: FloatArray, fixed: BoolArray
) -> tuple[IndexArray, IndexArray, FloatArray]:
    """Rows, columns and blocks of the matrix entries whose row has a held direction."""
    level = elements.fine
    rows = np.repeat(np.arange(level.n_nodes, dtype=np.int32), np.diff(level.indptr))
    constrained: BoolArray = np.asarray(fixed.any(axis=1))
    chosen = np.flatnonzero(constrained[rows])
    return rows[chosen], level.indices[chosen], blocks[chosen]


# Stiffness and mass of a housing at its bearing seats, condensed from its finite-element mesh.
#
# A seat moves by the area mean of its bore's displacement, across the axis and along it; a force on it is spread evenly
# over the bore, which is the same condition read as a load, so that the compliance is symmetric. So does the thrust of
# a bearing that locates its shaft press on the whole bore, not on the ring of its shoulder. The housing stands bolted:
# every node of its foot is held. The mass is that of the static shapes (R. J. Guyan, AIAA J. 3 (1965) 380).

SEAT_MOTIONS = (1, 2, 0)
"""Directions of a seat: y, z across the axis, x along it."""


@dataclass(frozen=True, kw_only=True, eq=False)
class CondensedSeats:
    """Seats of k bearings on one housing.

    names : of the bearing stations; stiffness, mass : (3 k, 3 k) in the order y, z, x of each [N/m], [kg]
    """

    names: tuple[str, ...]
    stiffness: FloatArray
    mass: FloatArray


def condense_seats(
    model: GearboxModel,
    elastic: Mapping[str, tuple[float, float, float]],
    densities: Mapping[str, float],
    elements: FiniteElements | None = None,
    *,
    tolerance: float = 1e-8,
) -> CondensedSeats:
    """Condense a housing to its bearing seats.

    elastic : body -> (Young's modulus [Pa], Poisson's ratio, expansion coefficient [1/K])
    densities : body -> [kg/m3]; elements : spaces on the mesh of the model; tolerance : of the linear solves

    Raises ElasticError for a model without bearings or bad materials, ThermalNotConverged if a solve stalls.
    """
    if not model.bearings:
        raise ElasticError(
            f"no bearing seat to condense to: {model.no_expansion or 'give a model with bearings'}"
        )
    spaces = FiniteElements(model.mesh) if elements is None else elements
    setup = ElasticSetup(spaces, elastic, _bolted(model, spaces))
    loads = _seat_loads(model, spaces)
    shapes = np.array([setup.deflection(load, tolerance) for load in loads])
    compliance = np.einsum("ina,jna->ij", loads, shapes)
    stiffness = np.linalg.inv(0.5 * (compliance + compliance.T))
    modes = np.einsum("ij,jna->nai", stiffness, shapes)
    density = spaces.per_cell(dict(densities))
    values, volumes = spaces.at_points(modes)
    points = len(volumes) // len(density)
    weighted = values * (volumes * np.repeat(density, points))[:, None, None]
    mass = np.einsum("qai,qaj->ij", weighted, values)
    return CondensedSeats(
        names=tuple(bearing.name for bearing in model.bearings),
        stiffness=0.5 * (stiffness + stiffness.T),
        mass=0.5 * (mass + mass.T),
    )


def _bolted(model: GearboxModel, spaces: FiniteElements) -> np.ndarray[tuple[int, int], np.dtype[np.bool_]]:
    """(n_nodes, 3) supports: the foot of the housing held all over, other pieces held determinate."""
    fixed = np.zeros((len(model.mesh.points), 3), dtype=np.bool_)
    foot = model.foot_surface if model.joint is None else model.joint.foot_surface
    fixed[spaces.surfaces[foot].nodes] = True
    loose = [b.journal_surface for b in model.bearings if b.locating]
    loose += [] if model.joint is None else [model.foot_surface]
    for name in loose:
        nodes = np.intersect1d(spaces.surfaces[name].nodes, spaces.corners)
        for node, directions in three_two_one(model.mesh.points, nodes.astype(np.int32)):
            fixed[node, list(directions)] = True
    return fixed


def _seat_loads(model: GearboxModel, spaces: FiniteElements) -> FloatArray:
    """(3 k, n_nodes, 3) nodal forces of 1 N on every seat in y, z and x [N]."""
    size = len(SEAT_MOTIONS)
    loads = np.zeros((size * len(model.bearings), len(model.mesh.points), 3))
    for i, bearing in enumerate(model.bearings):
        bore = spaces.surfaces[bearing.bore_surface]
        for j, direction in enumerate(SEAT_MOTIONS):
            loads[size * i + j, :, direction] = bore.shares / bore.area
    return loads


# Supports of elastic bodies, and the pieces that could do without them.
#
# Six supports that let a piece expand freely carry nothing under a load in equilibrium, as free expansion is.
# Held at three nodes, though, a fine mesh is so soft there that an iteration wastes its steps on it. So such a
# piece is solved floating, in the space its rigid motions leave, and afterwards moved onto its supports.

DETERMINATE = 1e-6
"""Least over largest singular value of what six supports say about a rigid motion."""


class ElasticError(ThermalInputError):
    """Elastic data or supports that cannot be computed; the message names body, value, limit and remedy."""


def three_two_one(points: FloatArray, nodes: IndexArray) -> list[tuple[int, tuple[int, ...]]]:
    """Statically determinate support on three of ``nodes`` (k,): (node, held directions) three times.

    points : (n_nodes, 3) [m]. The first node is held in x, y and z, the second across its line to the first,
    the third across the plane of the three. Raises ElasticError if all nodes lie on one line.
    """
    places = points[nodes]
    first = int(np.argmax(np.linalg.norm(places - places.mean(axis=0), axis=1)))
    second = int(np.argmax(np.linalg.norm(places - places[first], axis=1)))
    a, b = places[first], places[second]
    normals = np.cross(b - a, places - a)
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
    count = np.bincount(piece, fixed.sum(axis=1), minlength=int(piece.max()) + 1)
    for number in np.flatnonzero(count < 6):
        names = [b for b, cells in mesh.bodies.items() if (elements.components[cells] == number).any()]
        raise ElasticError(
            f"body {', '.join(names)} is held in {count[number]:.0f} directions; a piece needs at least six"
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
        count = np.bincount(piece, fixed.sum(axis=1), minlength=int(piece.max()) + 1)
        points = elements.mesh.points
        members = (np.flatnonzero(piece == number).astype(np.int32) for number in np.flatnonzero(count == 6))
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
            modes, fixed = _motions(self.points[nodes]), self.fixed[nodes].ravel()
            shares = np.linalg.solve(modes[fixed], displacement[nodes].ravel()[fixed])
            moved[nodes] -= (modes @ shares).reshape(-1, 3)
        return np.where(self.pins, 0.0, moved)

    def reactions(self, load: FloatArray) -> FloatArray:
        """Forces (n_nodes, 3) [N] with which six supports balance what ``load`` lacks to equilibrium."""
        result = np.zeros_like(load)
        for nodes in self.members:
            modes, fixed = _motions(self.points[nodes]), self.fixed[nodes]
            forces = np.zeros(fixed.shape)
            forces[fixed] = np.linalg.solve(modes[fixed.ravel()].T, -(modes.T @ load[nodes].ravel()))
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
