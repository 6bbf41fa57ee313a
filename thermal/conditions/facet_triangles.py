"""The named surfaces of a mesh as flat triangles between corner nodes, with their place in the facets."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from thermal.fe.mesh import FloatArray, IndexArray
from thermal.fe.reference_elements import SIDES


@dataclass(frozen=True)
class FacetTriangles:
    """n flat triangles of a surface.

    facet : (n,) facet each belongs to; corners : (n, 3, 3) [m]; reference : (n, 3, 2) corners in the facet
    """

    facet: IndexArray
    corners: FloatArray
    reference: FloatArray

    @classmethod
    def of(cls, points: FloatArray, facets: IndexArray) -> "FacetTriangles":
        """Triangles of (n_f, n_local) ``facets`` of a mesh with ``points`` (n_nodes, 3)."""
        shape = SIDES[facets.shape[1]]
        local = np.array([[0, k, k + 1] for k in range(1, shape.n_corners - 1)])
        places = shape.corners[local]
        facet = np.repeat(np.arange(len(facets), dtype=np.int32), len(local))
        corners = points[facets[:, local].reshape(-1, 3)]
        return cls(facet, corners, np.tile(places, (len(facets), 1, 1)))

    @cached_property
    def _doubled(self) -> FloatArray:
        """(n, 3) normal times twice the area [m2]."""
        return np.cross(self.corners[:, 1] - self.corners[:, 0], self.corners[:, 2] - self.corners[:, 0])

    @cached_property
    def area(self) -> FloatArray:
        """(n,) [m2]"""
        return np.asarray(0.5 * np.linalg.norm(self._doubled, axis=1))

    @cached_property
    def normal(self) -> FloatArray:
        """(n, 3) unit normal out of the body."""
        return np.asarray(0.5 * self._doubled / self.area[:, None])

    @cached_property
    def centre(self) -> FloatArray:
        """(n, 3) [m]"""
        return np.asarray(self.corners.mean(axis=1))

    @cached_property
    def radius(self) -> FloatArray:
        """(n,) distance of the furthest corner from the centre [m]."""
        return np.asarray(np.linalg.norm(self.corners - self.centre[:, None], axis=2).max(axis=1))

    @cached_property
    def frame(self) -> FloatArray:
        """(n, 3, 3) two unit vectors in the plane, counter-clockwise about the third, the normal."""
        along = self.corners[:, 1] - self.corners[:, 0]
        along = along / np.linalg.norm(along, axis=1)[:, None]
        return np.stack([along, np.cross(self.normal, along), self.normal], axis=1)

    @cached_property
    def reference_area(self) -> FloatArray:
        """(n,) area of the triangle in reference coordinates, per unit of the facet's own measure."""
        edges = self.reference[:, 1:] - self.reference[:, :1]
        return np.asarray(0.5 * np.abs(np.linalg.det(edges)))
