"""View factors between named surfaces of a fine mesh, by rays that each surface gives off at random places.

Every surface gives off the same number of rays, by area over its facets and by the cosine law over directions, from
one Sobol sequence: the same mesh gives the same factors. The exchange area A_i F_ij is the mean of both
directions, weighted by the number of rays per area (the estimate with the least variance), so that the factors are
reciprocal. Cost grows with the number of rays and hardly with that of facets; what stands between two surfaces is
every surface of the mesh.

Sources: Siegel, Howell, Thermal Radiation Heat Transfer, 4th ed., ch. 10 (rays); Niederreiter, Random Number
Generation and Quasi-Monte Carlo Methods, SIAM 1992, ch. 4.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from thermal.conditions.boundary import ConditionError
from thermal.fe.mesh import FloatArray, IndexArray, NamedMesh
from thermal.fe.reference_elements import SIDES

# The named surfaces of a mesh as flat triangles between corner nodes, with their place in the facets.


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


RAYS = 16384
"""Rays of every surface: factors of a room of six walls come to 0.002, sums of rows to 0.2 %."""


@dataclass(frozen=True)
class RayExchange:
    """What rays say of the surfaces of a chamber."""

    factors: tuple[tuple[float, ...], ...]
    """Rows as Enclosure.view_factors takes them: reciprocal, not closed."""
    areas: tuple[float, ...]
    """Of the flat triangles between the corners of the facets [m2]."""
    elsewhere: Mapping[str, float]
    """Surface that is no member -> greatest share of the rays of a member that arrive there [-]."""


def ray_view_factors(mesh: NamedMesh, surfaces: Sequence[str], rays: int = RAYS) -> RayExchange:
    """View factors F_ij between ``surfaces`` of ``mesh``, hidden by all other surfaces of the mesh.

    rays : of every surface; the error of a factor F is about sqrt(F (1 - F) / rays) at most

    Raises ConditionError for an unknown surface, and for a number of rays below 100.
    """
    for name in surfaces:
        if name not in mesh.surfaces:
            raise ConditionError(
                f"view factors: unknown surface {name!r}; known: {', '.join(sorted(mesh.surfaces))}"
            )
    if rays < 100:
        raise ConditionError(f"view factors by {rays} rays a surface, the limit is 100; take more")
    from thermal.conditions.ray_kernel import (
        first_hits,
        grid_of,
        sorted_in,
    )  # numba, only where rays are cast

    names = [*surfaces, *(name for name in mesh.surfaces if name not in surfaces)]
    parts = {name: FacetTriangles.of(mesh.points, mesh.surfaces[name]) for name in names}
    corners, owner = _in_reach(parts, len(surfaces))
    grid = grid_of(corners)
    cells = sorted_in(corners, *grid)
    n = len(surfaces)
    exchange, per_area = np.zeros((n, n)), np.empty(n)
    elsewhere: dict[str, float] = {}
    for i, name in enumerate(surfaces):
        origins, directions = _rays_of(parts[name], rays)
        hits = first_hits(origins, directions, corners, grid, cells)
        counts = np.bincount(owner[hits[hits >= 0]], minlength=len(names))
        exchange[i], per_area[i] = counts[:n], rays / parts[name].area.sum()
        for other in np.flatnonzero(counts[n:]) + n:
            elsewhere[names[other]] = max(elsewhere.get(names[other], 0.0), counts[other] / rays)
    exchange = (exchange + exchange.T) / (per_area[:, None] + per_area[None, :])
    area = rays / per_area
    rows = (exchange / area[:, None]).tolist()
    return RayExchange(tuple(tuple(row) for row in rows), tuple(area.tolist()), elsewhere)


def _in_reach(parts: Mapping[str, FacetTriangles], members: int) -> tuple[FloatArray, FloatArray]:
    """Triangles (m, 3, 3) of all surfaces within the bounds of the first ``members``, and the surface of each."""
    owner = np.repeat(np.arange(len(parts)), [len(part.facet) for part in parts.values()])
    corners = np.concatenate([part.corners for part in parts.values()])
    inner = corners[owner < members]
    low, high = inner.min(axis=(0, 1)), inner.max(axis=(0, 1))
    near = ((corners.max(axis=1) >= low) & (corners.min(axis=1) <= high)).all(axis=1)
    return np.ascontiguousarray(corners[near]), owner[near]


def _rays_of(part: FacetTriangles, rays: int) -> tuple[FloatArray, FloatArray]:
    """Origins and directions (rays, 3) of a surface: even over its area, cosine law over directions."""
    numbers = _sequence(rays, 5)
    reached = np.cumsum(part.area)
    triangle = np.minimum(np.searchsorted(reached, numbers[:, 0] * reached[-1]), len(reached) - 1)
    root, second = np.sqrt(numbers[:, 1]), numbers[:, 2]
    shares = np.column_stack([1.0 - root, root * (1.0 - second), root * second])
    origins = np.einsum("nk,nkd->nd", shares, part.corners[triangle])
    radius, angle = np.sqrt(numbers[:, 3]), 2.0 * np.pi * numbers[:, 4]
    local = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.sqrt(1.0 - numbers[:, 3])])
    return origins, np.einsum("nk,nkd->nd", local, part.frame[triangle])


def _sequence(count: int, dimensions: int) -> FloatArray:
    """(count, dimensions) numbers of the Sobol sequence between 0 and 1, in the middle of their steps."""
    from scipy.stats.qmc import Sobol

    whole = Sobol(dimensions, scramble=False).random_base2(math.ceil(math.log2(count)))
    return np.asarray(whole[:count] + 0.5 / len(whole))
