"""Conductance between two surfaces that touch, whatever their meshes: bearing shell, foot, shrink fit.

The jump of temperature is integrated over the common part of the facets of both sides (a mortar without
multipliers),

    Q_ab = int h (T_a - T_b) dA,      heat that leaves node i:  int h (T_a - T_b) (N_i^a - N_i^b) dA,

so the matrix is symmetric, a uniform temperature gives no heat, what leaves one side enters the other, and a
uniform flux through a flat joint is passed on exactly. Facets are taken flat for the overlap, curved for
their area.
"""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.spatial import cKDTree

from thermal.conditions.boundary import ConditionError
from thermal.conditions.ray_view_factors import FacetTriangles
from thermal.fe.elements import FiniteElements, SurfaceElements
from thermal.fe.mesh import FloatArray, IndexArray
from thermal.fe.reference_elements import SIDES, TRIANGLE_6
from thermal.films.law import ExchangeLaw

OPPOSED = -0.5
"""Greatest product of the normals of two facets that are taken to face each other."""

COVERED = 0.02
"""Share of a surface with other conditions that may touch before it is worth a sentence."""

REACH = 0.25
"""Distance to which facets touch where none is given, as a share of the facets' size."""

SLIVER = 1e-10
"""Common parts below this share of a facet are dropped."""


@dataclass(frozen=True, kw_only=True)
class Contact:
    """Heat between two named surfaces that lie on each other: q = h (T_b - T_a) point by point.

    Outside of the common part the surfaces pass no heat by this condition. Another condition on the same
    surface acts on all of it, the common part included: `covered` says where that is much. Surfaces that
    share nodes conduct already and need no contact. A conductance of 1e6 W/(m2 K) is as good as none between.
    """

    surface_a: str
    surface_b: str
    kind: str
    """Row name in the heat balance."""
    law: ExchangeLaw
    """Conductance [W/(m2 K)] from the mean temperatures of both sides of the joint [K]."""
    reach: float | None = None
    """Greatest distance of the two sides [m]; a quarter of the facets' size if None."""
    least_coverage: float = 0.5
    """Share of the smaller surface that must find the other side; below it the contact is refused."""


@dataclass(frozen=True)
class SurfaceJoint:
    """Quadrature on the common part of two surfaces: n points."""

    weights: FloatArray
    """(n,) area [m2]"""
    side_a: sparse.csr_array
    """(n, n_nodes): temperature of side a at the points from the nodal temperatures"""
    side_b: sparse.csr_array
    coverage_a: float
    """Share of surface a that touches [-]."""
    coverage_b: float

    @property
    def area(self) -> float:
        """Area of the joint [m2]."""
        return float(self.weights.sum())

    @property
    def jump(self) -> sparse.csr_array:
        """(n, n_nodes): T_a - T_b at the points."""
        return sparse.csr_array(self.side_a - self.side_b)

    def mean(self, side: sparse.csr_array) -> FloatArray:
        """(n_nodes,) area mean of one side over the joint as a functional of the nodal temperatures."""
        return np.asarray(side.T @ self.weights) / self.area


def join(elements: FiniteElements, contact: Contact) -> SurfaceJoint:
    """Find the common part of both surfaces of ``contact``.

    Raises ConditionError if less than ``least_coverage`` of the smaller surface touches the other.
    """
    a, b = elements.surfaces[contact.surface_a], elements.surfaces[contact.surface_b]
    points = elements.mesh.points
    first, second = FacetTriangles.of(points, a.facets), FacetTriangles.of(points, b.facets)
    size = np.sqrt(max(a.area / len(a.facets), b.area / len(b.facets)))
    reach = REACH * float(size) if contact.reach is None else contact.reach
    if not (np.isfinite(reach) and reach > 0.0):
        raise ConditionError(f"{_place(contact)}: reach = {reach:g} m must be above 0 m")
    pairs = _candidates(first, second, reach)
    index, ref_a, ref_b, weights = _common_points(first, second, pairs, reach)
    weights = weights * _stretch(points, a.facets, first, index[:, 0], ref_a)
    touching = float(weights.sum())
    smaller = min(a.area, b.area)
    if touching < contact.least_coverage * smaller or touching == 0.0:
        raise ConditionError(
            f"{_place(contact)}: {touching / smaller:.3g} of the smaller surface touches the other within "
            f"{reach:.3g} m, below the limit of {contact.least_coverage:g}; name two surfaces that touch"
        )
    n_nodes = len(points)
    return SurfaceJoint(
        weights,
        _interpolation(a, first.facet[index[:, 0]], ref_a, n_nodes),
        _interpolation(b, second.facet[index[:, 1]], ref_b, n_nodes),
        touching / a.area,
        touching / b.area,
    )


def covered(contact: Contact, joint: SurfaceJoint, others: Collection[str]) -> tuple[str, ...]:
    """A sentence for each side of a joint that carries other conditions (surfaces ``others``) as well."""
    shares = ((contact.surface_a, joint.coverage_a), (contact.surface_b, joint.coverage_b))
    return tuple(
        f"{name}: {100.0 * share:.3g} % touches ({contact.kind}), above {100.0 * COVERED:g} %, and its other "
        "conditions act there too; split the surface along the joint"
        for name, share in shares
        if name in others and share > COVERED
    )


def _place(contact: Contact) -> str:
    return f"contact of {contact.surface_a} and {contact.surface_b}"


def _candidates(first: FacetTriangles, second: FacetTriangles, reach: float) -> IndexArray:
    """(k, 2) pairs of triangles that are near and face each other."""
    radius = first.radius + second.radius.max() + reach
    near = cKDTree(second.centre).query_ball_point(first.centre, radius, return_sorted=True)
    i = np.repeat(np.arange(len(near)), [len(others) for others in near])
    j = np.concatenate([np.asarray(others, dtype=np.int64) for others in near] or [np.empty(0, np.int64)])
    facing = np.einsum("nd,nd->n", first.normal[i], second.normal[j]) < OPPOSED
    return np.column_stack([i[facing], j[facing]]).astype(np.int32)


def _common_points(
    first: FacetTriangles, second: FacetTriangles, pairs: IndexArray, reach: float
) -> tuple[IndexArray, FloatArray, FloatArray, FloatArray]:
    """Pairs (n, 2), reference points (n, 2) in both facets and flat area (n,) of every quadrature point."""
    i, j = pairs.T
    frame = first.frame[i]
    origin = first.corners[i, 0]
    flat_a = np.einsum("nkd,ncd->nck", frame[:, :2], first.corners[i] - origin[:, None])
    other = np.einsum("nkd,ncd->nck", frame, second.corners[j] - origin[:, None])
    flat_b, height = other[:, :, :2], other[:, :, 2]
    parts = fan(intersect(flat_a, flat_b[:, ::-1])).reshape(-1, 3, 2)
    area = 0.5 * cross(parts[:, 1] - parts[:, 0], parts[:, 2] - parts[:, 0])
    owner = np.repeat(np.arange(len(pairs)), len(parts) // max(len(pairs), 1))
    kept = area > SLIVER * first.area[i[owner]]
    parts, area, owner = parts[kept], area[kept], owner[kept]
    rule = TRIANGLE_6.load_rule
    inner = np.column_stack([1.0 - rule.points.sum(axis=1), rule.points])
    places = np.einsum("qc,ncd->nqd", inner, parts).reshape(-1, 2)
    weights = (2.0 * area[:, None] * rule.weights).ravel()
    owner = np.repeat(owner, len(rule.weights))
    in_a, in_b = _barycentric(flat_a[owner], places), _barycentric(flat_b[owner], places)
    close = np.abs(np.einsum("nc,nc->n", in_b, height[owner])) <= reach
    in_a, in_b, owner = in_a[close], in_b[close], owner[close]
    ref_a = np.einsum("nc,ncd->nd", in_a, first.reference[i[owner]])
    ref_b = np.einsum("nc,ncd->nd", in_b, second.reference[j[owner]])
    return pairs[owner], ref_a, ref_b, weights[close]


def _barycentric(triangles: FloatArray, places: FloatArray) -> FloatArray:
    """(n, 3) barycentric coordinates of (n, 2) places in (n, 3, 2) triangles of either orientation."""
    a, b, c = (triangles[:, k] for k in range(3))
    whole = cross(b - a, c - a)
    second = cross(places - a, c - a) / whole
    third = cross(b - a, places - a) / whole
    return np.column_stack([1.0 - second - third, second, third])


def _stretch(
    points: FloatArray,
    facets: IndexArray,
    triangles: FacetTriangles,
    index: IndexArray,
    reference: FloatArray,
) -> FloatArray:
    """(n,) area of the curved facet over the area of its flat triangle, at reference points."""
    slopes = SIDES[facets.shape[1]].gradients(reference)
    tangents = np.einsum("nak,nad->nkd", slopes, points[facets[triangles.facet[index]]])
    curved = np.linalg.norm(np.cross(tangents[:, 0], tangents[:, 1]), axis=1)
    return np.asarray(curved * triangles.reference_area[index] / triangles.area[index])


def _interpolation(
    surface: SurfaceElements, facet: IndexArray, reference: FloatArray, n_nodes: int
) -> sparse.csr_array:
    """(n, n_nodes) shape functions of ``surface`` at reference points of its facets."""
    nodes = surface.facets[facet]
    values = SIDES[nodes.shape[1]].values(reference)
    start = np.arange(0, nodes.size + 1, nodes.shape[1])
    return sparse.csr_array((values.ravel(), nodes.ravel(), start), shape=(len(nodes), n_nodes))


# Convex polygons by the thousand: cut at half-spaces, split into triangles.
#
# A batch of n polygons is an array (n, m, d) of vertices in order. Polygons with fewer than m corners repeat
# their last vertex, so that every edge beyond the last has no length and every triangle no area.


def clip(vertices: FloatArray, heights: FloatArray) -> FloatArray:
    """Keep the part of every polygon where ``heights`` is not negative.

    vertices : (n, m, d); heights : (n, m), linear over each polygon
    Return (n, m + 1, d). A polygon that lies below shrinks to its first vertex.

    Source: Sutherland, Hodgman, Reentrant polygon clipping, Comm. ACM 17 (1974) 32.
    """
    n, m, d = vertices.shape
    following = np.roll(vertices, -1, axis=1)
    after = np.roll(heights, -1, axis=1)
    inside = heights >= 0.0
    crossing = inside != (after >= 0.0)
    share = np.where(crossing, heights, 0.0) / np.where(crossing, heights - after, 1.0)
    cuts = vertices + share[:, :, None] * (following - vertices)
    listed = np.stack([vertices, cuts], axis=2).reshape(n, 2 * m, d)
    kept = np.stack([inside, crossing], axis=2).reshape(n, 2 * m)
    order = np.argsort(~kept, axis=1, kind="stable")
    last = np.maximum(kept.sum(axis=1) - 1, 0)
    chosen = np.take_along_axis(order, np.minimum(np.arange(m + 1), last[:, None]), axis=1)
    chosen[~kept.any(axis=1)] = 0
    return np.take_along_axis(listed, chosen[:, :, None], axis=1)


def intersect(subjects: FloatArray, windows: FloatArray) -> FloatArray:
    """Common part of pairs of convex polygons in the plane.

    subjects : (n, m, 2); windows : (n, k, 2), counter-clockwise. Return (n, m + k, 2).
    """
    for corner in range(windows.shape[1]):
        start = windows[:, corner, None]
        edge = windows[:, (corner + 1) % windows.shape[1], None] - start
        subjects = clip(subjects, cross(edge, subjects - start))
    return subjects


def fan(polygons: FloatArray) -> FloatArray:
    """Triangles (n, m - 2, 3, d) from the first vertex of every polygon (n, m, d)."""
    m = polygons.shape[1]
    corners = [[0, k, k + 1] for k in range(1, m - 1)]
    return polygons[:, corners]


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Component of a x b normal to the plane, for vectors (..., 2)."""
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
