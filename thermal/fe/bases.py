"""scikit-fem on a named mesh: bases on which any weak form is assembled in our numbering.

Unknowns are our nodes, 3 node + direction for vectors, corners for the linear space, so that what scikit-fem
assembles adds to what the compiled assembly makes. A basis over all cells keeps the gradients of every shape
function at every point, up to 0.6 kB each: `in_blocks` goes through a large mesh in parts.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import skfem
from numpy.typing import NDArray
from skfem.assembly import Dofs
from skfem.generic_utils import OrientedBoundary
from skfem.mapping import MappingIsoparametric

from thermal.fe.arrays import FloatArray, IndexArray
from thermal.fe.mesh import NamedMesh, facet_keys
from thermal.fe.reference_elements import CellElement, QuadratureRule

BLOCK = 1000
"""Cells of a block: their gradients stay in the processor's cache."""


@dataclass(repr=False)
class MeshHexS2(skfem.MeshHex1):  # type: ignore[misc]
    """Isoparametric mesh of 20-node bricks, the one kind of ours that scikit-fem has as an element only."""

    elem: type[Any] = skfem.ElementHexS2


MESHES = {"tetra10": skfem.MeshTet2, "hexahedron20": MeshHexS2, "hexahedron27": skfem.MeshHex2}
"""Name of a cell -> scikit-fem's mesh of it."""


class NodeNumbers(Dofs):  # type: ignore[misc]
    """Degrees of freedom that carry the numbers of nodes.

    nodes : (n_local, n_cells) in scikit-fem's order of local nodes; size : number of unknowns
    """

    def __init__(self, topo: Any, element: Any, nodes: IndexArray, size: int) -> None:
        self.topo, self.element, self.element_dofs, self.N = topo, element, nodes, size


class SurfaceMapping(MappingIsoparametric):  # type: ignore[misc]
    """The cells behind a surface, its quadrature points those of `SurfaceElements`.

    The places of the points in the cells follow from the corners of the facets. scikit-fem searches them by Newton's
    method to 1e-12, which small cells far from the origin do not reach.

    facets : (n_f, n_local) nodes; cells : (n_f, n_local) nodes of the cell behind each
    """

    def __init__(self, mesh: Any, shape: CellElement, facets: IndexArray, cells: IndexArray) -> None:
        super().__init__(mesh, shape.element)
        side = shape.side
        points, _ = side.load_rule
        corners = facets[:, : side.n_corners]
        local = np.argmax(cells[:, None, : shape.n_corners] == corners[:, :, None], axis=2)
        self._inside = np.einsum("qc,fcd->dfq", side.corner_values(points), shape.corners[local])
        tangents = np.einsum("qak,ifa->kfqi", side.gradients(points), mesh.p[:, facets])
        self._places = np.einsum("qa,ifa->ifq", side.values(points), mesh.p[:, facets])
        self._stretched = np.cross(*tangents)

    def invF(self, x: FloatArray, tind: IndexArray) -> FloatArray:  # noqa: N802
        """(3, n_f, n_q) reference coordinates of the quadrature points in their cells."""
        return np.asarray(self._inside)

    def G(self, X: FloatArray, find: IndexArray) -> FloatArray:  # noqa: N802
        """(3, n_f, n_q) quadrature points."""
        return np.asarray(self._places)

    def detDG(self, X: FloatArray, find: IndexArray) -> FloatArray:  # noqa: N802
        """(n_f, n_q) area per area of the reference side."""
        return np.asarray(np.linalg.norm(self._stretched, axis=2))

    def normals(self, X: FloatArray, tind: IndexArray, find: IndexArray, t2f: IndexArray) -> FloatArray:
        """(3, n_f, n_q) unit normals out of the body that the surface bounds."""
        return np.moveaxis(self._stretched / self.detDG(X, find)[:, :, None], 2, 0)


@dataclass(frozen=True)
class Space:
    """What a basis is made of.

    linear : the linear sub-space, on the same curved cells
    vector : three components
    """

    linear: bool = False
    vector: bool = False


SCALAR, VECTOR, LINEAR = Space(), Space(vector=True), Space(linear=True)


class Bases:
    """Bases of a mesh; corners : (n_corners,) nodes of the linear space."""

    def __init__(self, mesh: NamedMesh, corners: IndexArray) -> None:
        self._named, self._corners, self._shape = mesh, corners, mesh.shape
        self._elements: dict[Space, tuple[Any, NodeNumbers]] = {}

    @cached_property
    def mesh(self) -> Any:
        """The mesh in scikit-fem, with our nodes and the bodies as its subdomains."""
        cells = self._theirs(self._named.cells, self._shape.n_nodes)
        bodies = {name: np.sort(members) for name, members in self._named.bodies.items()}
        points, n_corners = np.ascontiguousarray(self._named.points.T), self._shape.n_corners
        mesh = MESHES[self._shape.name](points, cells[:n_corners], _subdomains=bodies)
        mesh._dofs = NodeNumbers(mesh, self._shape.element, cells, points.shape[1])
        return mesh

    def cells(
        self, cells: IndexArray | str | None = None, space: Space = SCALAR, rule: QuadratureRule | None = None
    ) -> Any:
        """Basis over ``cells`` (k,), the cells of a body by its name, or all.

        rule : quadrature; that of loads if None
        """
        element, dofs = self._element(space)
        points, weights = self._shape.load_rule if rule is None else rule
        # a mapping keeps all it computes; one for each basis goes with it
        mapping = MappingIsoparametric(self.mesh, self._shape.element)
        return skfem.CellBasis(
            self.mesh, element, mapping, elements=cells, quadrature=(points.T, weights), dofs=dofs,
            disable_doflocs=True,
        )  # fmt: skip

    def in_blocks(self, space: Space = SCALAR, rule: QuadratureRule | None = None) -> Iterator[Any]:
        """Bases over all cells, one block after the other."""
        n_cells = len(self._named.cells)
        for start in range(0, n_cells, BLOCK):
            yield self.cells(np.arange(start, min(start + BLOCK, n_cells), dtype=np.int32), space, rule)

    def surface(self, name: str, space: Space = SCALAR) -> Any:
        """Basis over a named surface at the points of its `SurfaceElements`, normals out of the body it bounds."""
        element, dofs = self._element(space)
        points, weights = self._shape.side.load_rule
        boundary, facets = self._boundary(name), self._named.surfaces[name]
        cells = self._named.cells[self.mesh.f2t[boundary.ori, boundary]]
        return skfem.FacetBasis(
            self.mesh, element, SurfaceMapping(self.mesh, self._shape, facets, cells), facets=boundary,
            quadrature=(points.T, weights), dofs=dofs, disable_doflocs=True,
        )  # fmt: skip

    def _theirs(self, cells: IndexArray, n_local: int) -> IndexArray:
        """(n_local, n_cells) nodes in scikit-fem's order of local nodes."""
        return np.ascontiguousarray(cells[:, np.argsort(self._shape.order[:n_local])].T)

    def _element(self, space: Space) -> tuple[Any, NodeNumbers]:
        """scikit-fem's element with the numbers of its unknowns, made once."""
        if space not in self._elements:
            self._elements[space] = self._made(space)
        return self._elements[space]

    def _made(self, space: Space) -> tuple[Any, NodeNumbers]:
        if space.linear:
            element, size, n_local = self._shape.linear, len(self._corners), self._shape.n_corners
            corners = np.searchsorted(self._corners, self._named.cells[:, :n_local])
            nodes = self._theirs(corners.astype(np.int32), n_local)
        else:
            element, size = self._shape.element, len(self._named.points)
            nodes = self.mesh.dofs.element_dofs
        if space.vector:
            element, size = skfem.ElementVector(element), 3 * size
            nodes = (3 * nodes[:, None] + np.arange(3, dtype=np.int32)[:, None]).reshape(-1, nodes.shape[1])
        return element, NodeNumbers(self.mesh, element, nodes, size)

    @cached_property
    def _facets(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Keys of scikit-fem's facets in ascending order, and the numbers of the facets."""
        keys = facet_keys(self.mesh.facets.T, len(self._named.points))
        order = np.argsort(keys)
        return keys[order], order

    def _boundary(self, name: str) -> OrientedBoundary:
        """scikit-fem's numbers of the facets of a surface, and on which side the body lies that it bounds."""
        n_corners, n_nodes = self._shape.side.n_corners, len(self._named.points)
        wanted = self._named.surfaces[name]
        keys, order = self._facets
        facets = order[np.searchsorted(keys, facet_keys(wanted[:, :n_corners], n_nodes))]
        body = self.mesh.f2t[0, facets]
        middle = self._named.points[self._named.cells[body, : self._shape.n_corners]].mean(axis=1)
        a, b, c = self._named.points[wanted[:, :3]].swapaxes(0, 1)
        behind = np.einsum("ni,ni->n", np.cross(b - a, c - a), middle - a) > 0.0
        return OrientedBoundary(facets, behind.astype(np.int32))
