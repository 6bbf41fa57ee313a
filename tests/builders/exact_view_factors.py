"""View factors between named surfaces of a mesh, by integration over facets with occlusion.

F_dA-polygon is exact for a flat polygon (Lambert's formula, the polygon cut at the horizon of dA); it is
integrated over the emitting facet by a rule of degree 5. What stands between two facets is found by rays from
the points of one facet to the centre of the other, against every facet named as an obstacle. The result is
the mean over both directions and is not closed: see `thermal.conditions.view_factor_closure.close_view_factors`.

Cost grows with the square of the number of facets, with occlusion with its third power: take a coarse mesh
of the same surfaces; the result belongs to the names and not to the mesh.

Source: Siegel, Howell, Thermal Radiation Heat Transfer, 4th ed., sec. 6-3.7 (contour form for an element).
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from thermal.conditions.boundary import ConditionError
from thermal.conditions.contact import clip
from thermal.conditions.ray_view_factors import FacetTriangles
from thermal.fe.mesh import FloatArray, NamedMesh
from thermal.fe.reference_elements import TRIANGLE_6

MOST_TRIANGLES = 3000
"""Greatest number of triangles of an enclosure."""

EDGE = 1e-9
"""Share of a ray at either end where nothing is taken to stand in its way."""


def view_factors(
    mesh: NamedMesh, surfaces: Sequence[str], obstacles: Sequence[str] = ()
) -> tuple[tuple[float, ...], ...]:
    """View factors F_ij between ``surfaces`` of ``mesh``, rows as Enclosure.view_factors takes them.

    obstacles : further surfaces that stand between them; the surfaces themselves always do

    Raises ConditionError for an unknown surface and for more than 3000 triangles.
    """
    for name in (*surfaces, *obstacles):
        if name not in mesh.surfaces:
            raise ConditionError(
                f"view factors: unknown surface {name!r}; known: {', '.join(sorted(mesh.surfaces))}"
            )
    seen = _triangles(mesh, surfaces)
    owner = np.repeat(np.arange(len(surfaces)), [len(_triangles(mesh, [name]).facet) for name in surfaces])
    if len(owner) > MOST_TRIANGLES:
        raise ConditionError(
            f"view factors of {len(owner)} triangles, the limit is {MOST_TRIANGLES}; take a coarser mesh with the "
            "same surface names"
        )
    others = [name for name in obstacles if name not in surfaces]
    walls = Walls(_triangles(mesh, [*surfaces, *others]))
    exchange = np.zeros((len(surfaces), len(surfaces)))
    for i in range(len(owner)):
        per_triangle = seen.area[i] * _from_triangle(seen, walls, i)
        exchange[owner[i]] += np.bincount(owner, per_triangle, minlength=len(surfaces))
    area = np.bincount(owner, seen.area, minlength=len(surfaces))
    factors = 0.5 * (exchange + exchange.T) / area[:, None]
    return tuple(tuple(row) for row in factors.tolist())


def _triangles(mesh: NamedMesh, surfaces: Sequence[str]) -> FacetTriangles:
    parts = [FacetTriangles.of(mesh.points, mesh.surfaces[name]) for name in surfaces]
    return FacetTriangles(
        np.concatenate([part.facet for part in parts]),
        np.concatenate([part.corners for part in parts]),
        np.concatenate([part.reference for part in parts]),
    )


def _from_triangle(seen: FacetTriangles, walls: "Walls", i: int) -> FloatArray:
    """(n,) view factors from triangle ``i`` to every triangle, what is hidden left out."""
    rule = TRIANGLE_6.load_rule
    inner = np.column_stack([1.0 - rule.points.sum(axis=1), rule.points])
    places = inner @ seen.corners[i]
    size = float(seen.radius[i])
    ahead = ((seen.corners - seen.centre[i]) @ seen.normal[i]).max(axis=1) > 1e-9 * size
    behind = np.einsum("nkd,nd->nk", seen.corners[i] - seen.corners[:, :1], seen.normal).max(axis=1)
    facing = np.flatnonzero(ahead & (behind > 1e-9 * size))
    result = np.zeros(len(seen.facet))
    if not len(facing):
        return result
    factors = np.stack([_from_point(place, seen.normal[i], seen.corners[facing]) for place in places])
    factors = factors * _visible(places, seen, walls, i, facing)
    result[facing] = 2.0 * rule.weights @ factors
    return result


def _from_point(place: FloatArray, normal: FloatArray, corners: FloatArray) -> FloatArray:
    """(n,) view factors from an element at ``place`` to triangles (n, 3, 3) that turn their normal to it."""
    rays = corners - place
    polygon = clip(rays, rays @ normal)
    following = np.roll(polygon, -1, axis=1)
    turn = np.cross(polygon, following)
    sine = np.linalg.norm(turn, axis=2)
    angle = np.arctan2(sine, np.einsum("nkd,nkd->nk", polygon, following))
    share = np.divide(angle, sine, out=np.zeros_like(sine), where=sine > 0.0)
    total = np.einsum("nk,nkd,d->n", share, turn, normal) / (2.0 * np.pi)
    return np.asarray(np.maximum(-total, 0.0))


def _visible(
    places: FloatArray, seen: FacetTriangles, walls: "Walls", i: int, facing: NDArray[np.int64]
) -> FloatArray:
    """(n_places, n) 1 where the ray from each place to the centre of each triangle is free, else 0."""
    ends = seen.centre[facing]
    ahead = ends @ walls.normal.T - walls.offset
    behind = seen.corners[i] @ walls.normal.T - walls.offset
    able = ((ahead < 0.0) & (behind.max(axis=0) > 0.0)) | ((ahead > 0.0) & (behind.min(axis=0) < 0.0))
    able[:, i] = False
    able[np.arange(len(facing)), facing] = False
    ray, wall = np.nonzero(able)
    near = _near(seen.centre[i], ends[ray], walls.centre[wall], walls.radius[wall] + seen.radius[i])
    ray, wall = ray[near], wall[near]
    beyond = ahead[ray, wall]
    free = np.ones((len(places), len(facing)))
    for p, place in enumerate(places):
        before = walls.normal @ place - walls.offset
        height = before[wall]
        apart = np.abs(height - beyond)
        crossing = (height * beyond < 0.0) & (np.minimum(np.abs(height), np.abs(beyond)) > EDGE * apart)
        r, w = ray[crossing], wall[crossing]
        share = np.abs(height[crossing]) / apart[crossing]
        u, v = walls.barycentric(place + share[:, None] * (ends[r] - place), w)
        free[p, r[(u >= 0.0) & (v >= 0.0) & (u + v <= 1.0)]] = 0.0
    return free


def _near(start: FloatArray, ends: FloatArray, centres: FloatArray, widths: FloatArray) -> NDArray[np.bool_]:
    """(n,) whether (n, 3) centres lie within (n,) widths of the lines from ``start`` to (n, 3) ends."""
    along, to_centre = ends - start, centres - start
    share = np.einsum("nd,nd->n", to_centre, along) / np.einsum("nd,nd->n", along, along)
    off = to_centre - np.clip(share, 0.0, 1.0)[:, None] * along
    return np.asarray(np.einsum("nd,nd->n", off, off) < widths**2)


class Walls:
    """What may stand in the way of rays: n triangles with their planes."""

    def __init__(self, triangles: FacetTriangles) -> None:
        self.centre, self.radius, self.normal = triangles.centre, triangles.radius, triangles.normal
        self.offset = np.einsum("nd,nd->n", self.normal, self.centre)
        """(n,) normal times place in the plane [m]."""
        self._corner = triangles.corners[:, 0]
        first, second = (triangles.corners[:, k] - self._corner for k in (1, 2))
        doubled = 2.0 * triangles.area[:, None]
        self._by_first = np.cross(second, self.normal) / doubled
        self._by_second = np.cross(self.normal, first) / doubled

    def barycentric(self, places: FloatArray, wall: NDArray[np.int64]) -> tuple[FloatArray, FloatArray]:
        """Two coordinates (k,) of (k, 3) places in the planes of triangles ``wall`` (k,)."""
        off = places - self._corner[wall]
        return (
            np.asarray(np.einsum("nd,nd->n", off, self._by_first[wall])),
            np.asarray(np.einsum("nd,nd->n", off, self._by_second[wall])),
        )
