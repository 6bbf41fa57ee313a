"""View factors between named surfaces of a mesh, by integration over facets with occlusion.

F_dA-polygon is exact for a flat polygon (Lambert's formula, the polygon cut at the horizon of dA); it is
integrated over the emitting facet by a rule of degree 5. What stands between two facets is found by rays from
the points of one facet to the centre of the other, against every facet named as an obstacle. The result is
the mean over both directions and is not closed: see `thermal.enclosure.close_view_factors`.

Cost grows with the square of the number of facets, with occlusion with its third power: take a coarse mesh
of the same surfaces; the result belongs to the names and not to the mesh.

Source: Siegel, Howell, Thermal Radiation Heat Transfer, 4th ed., sec. 6-3.7 (contour form for an element).
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from thermal.boundary import ConditionError
from thermal.clipping import clip
from thermal.facet_triangles import FacetTriangles
from thermal.fe.mesh import FloatArray, NamedMesh
from thermal.fe.reference import TRIANGLE_7

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
    walls = _triangles(mesh, [*surfaces, *others])
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


def _from_triangle(seen: FacetTriangles, walls: FacetTriangles, i: int) -> FloatArray:
    """(n,) view factors from triangle ``i`` to every triangle, what is hidden left out."""
    rule = TRIANGLE_7
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
    places: FloatArray, seen: FacetTriangles, walls: FacetTriangles, i: int, facing: NDArray[np.int64]
) -> FloatArray:
    """(n_places, n) 1 where the ray from each place to the centre of each triangle is free, else 0."""
    free = np.ones((len(places), len(facing)))
    start = seen.centre[i]
    along = seen.centre[facing] - start
    length = np.linalg.norm(along, axis=1)
    unit = along / length[:, None]
    to_wall = walls.centre - start
    at = unit @ to_wall.T
    distance = np.einsum("kd,kd->k", to_wall, to_wall) - at**2
    width = walls.radius + seen.radius[i]
    near = (distance < width**2) & (at > -width) & (at < length[:, None] + walls.radius)
    near[:, i] = False
    near[np.arange(len(facing)), facing] = False
    ray, wall = np.nonzero(near)
    for p, place in enumerate(places):
        hit = _hits(place, seen.centre[facing[ray]] - place, walls, wall)
        free[p, ray[hit]] = 0.0
    return free


def _hits(
    place: FloatArray, rays: FloatArray, walls: FacetTriangles, wall: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """(n,) whether a ray from ``place`` meets a triangle before its end.

    Source: Möller, Trumbore, J. Graphics Tools 2 (1997) 21.
    """
    corner = walls.corners[wall]
    first, second = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    side = np.cross(rays, second)
    det = np.einsum("nd,nd->n", first, side)
    crossing = np.abs(det) > 0.0
    inverse = np.divide(1.0, det, out=np.zeros_like(det), where=crossing)
    off = place - corner[:, 0]
    u = np.einsum("nd,nd->n", off, side) * inverse
    turned = np.cross(off, first)
    v = np.einsum("nd,nd->n", rays, turned) * inverse
    t = np.einsum("nd,nd->n", second, turned) * inverse
    return np.asarray(crossing & (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (t > EDGE) & (t < 1.0 - EDGE))
