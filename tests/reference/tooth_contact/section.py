"""Plane mesh of a gear: teeth on a full ring down to the bore, six-node triangles with edges on the true outline.

Millimetres. Tooth 0 stands on the x axis; its working flank, the right one of ``ToothForm``, looks to negative y.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import ceil, cos, hypot, pi, sin

import gmsh
import numpy as np
from numpy.typing import NDArray

from dynamics.gear.tooth_form import ToothForm

Array = NDArray[np.float64]
Integers = NDArray[np.int64]
Curve = Callable[[Array], Array]
MM = 1e3


@dataclass(frozen=True, kw_only=True)
class EdgeSizes:
    """Lengths of element edges on the outline of a tooth, in modules.

    flank, fillet : of the working side; corner : at both tip corners; coarse : back of the tooth; bore : in bore radii
    """

    flank: float = 0.025
    fillet: float = 0.025
    corner: float = 0.006
    coarse: float = 0.1
    bore: float = 0.08

    def scaled(self, factor: float) -> "EdgeSizes":
        """All edges times ``factor`` but for the bore."""
        return replace(
            self,
            flank=self.flank * factor,
            fillet=self.fillet * factor,
            corner=self.corner * factor,
            coarse=self.coarse * factor,
        )


@dataclass(frozen=True, kw_only=True)
class PlaneMesh:
    """Nodes (n, 2) [mm]; cells (m, 6), corners then mid-sides; sides: name -> (k, 2) cell and side 0, 1, 2;
    lines: name -> nodes in the order of the outline."""

    points: Array
    cells: Integers
    sides: dict[str, Integers]
    lines: dict[str, Integers]

    def placed(self, angle: float, centre: tuple[float, float]) -> "PlaneMesh":
        """Turned by an angle [rad] about its origin, then moved to ``centre`` [mm]."""
        c, s = cos(angle), sin(angle)
        return replace(self, points=self.points @ np.array([[c, s], [-s, c]]) + np.asarray(centre))


@dataclass(frozen=True)
class Piece:
    """Part of the outline: curve over 0..1 (n,) -> (n, 2), place of its nodes, name under which its edges are kept."""

    curve: Curve
    places: Array
    name: str


def gear_section(
    form: ToothForm,
    bore_radius: float,
    *,
    teeth: int = 5,
    sizes: EdgeSizes | None = None,
    removed: Callable[[Array], Array] | None = None,
    flank_nodes: Sequence[float] = (),
) -> PlaneMesh:
    """Mesh of ``teeth`` neighbouring teeth on a ring whose rest is smooth at the root circle.

    bore_radius [m]; removed : metal taken off the working flanks along their normal [m] over their roll length [m];
    flank_nodes : roll lengths [m] at which the working flanks have a node.
    Names: ``bore``; ``flank_j``, ``fillet_j``, ``tip_j``, ``back_j`` of tooth j, j = 0 in the middle.
    """
    sizes = sizes or EdgeSizes()
    pitch = 2.0 * pi / form.gear.teeth
    half = teeth // 2
    tooth = _tooth_pieces(form, sizes, removed)
    tooth[1] = replace(tooth[1], places=_with_nodes(form, tooth[1].places, flank_nodes))
    root = form.root_radius * MM
    gap_start = float(np.arctan2(*tooth[-1].curve(np.array([1.0]))[0]))
    pieces: list[Piece] = []
    for j in range(-half, half + 1):
        pieces += [Piece(_turned(p.curve, j * pitch - 0.5 * pi), p.places, f"{p.name}_{j}") for p in tooth]
        # root land to the next tooth, or the smooth rest of the ring behind the last one
        first = j * pitch - gap_start
        land = pitch + 2.0 * gap_start
        if j < half:
            n = max(1, ceil(land * root / (sizes.fillet * 2.0 * form.gear.normal_module * MM)))
            places = np.linspace(0.0, 1.0, n + 1)
        else:
            land = 2.0 * pi - (teeth - 1) * pitch + 2.0 * gap_start
            places = _graded(land * root, sizes.coarse * form.gear.normal_module * MM, 0.08 * root)
        pieces.append(Piece(_arc(root, first, first + land), places, f"land_{j}"))
    n = max(24, ceil(2.0 * pi / sizes.bore))
    ring = Piece(_arc(bore_radius * MM, 0.0, 2.0 * pi), np.linspace(0.0, 1.0, n + 1), "bore")
    return plane_mesh([pieces, [ring]])


def _with_nodes(form: ToothForm, places: Array, rolls: Sequence[float]) -> Array:
    """The places on the flank with the nearest one inside moved to every roll length."""
    places = places.copy()
    for roll in rolls:
        radius = hypot(form.gear.base_radius, roll)
        wanted = (radius - form.form_radius) / (form.flank_tip_radius - form.form_radius)
        inside = 1 + int(np.argmin(np.abs(places[1:-1] - wanted)))
        places[inside] = wanted
    assert np.all(np.diff(places) > 0.0), f"roll lengths {rolls} lie too close to each other or off the flank"
    return places


def _tooth_pieces(form: ToothForm, sizes: EdgeSizes, removed: Callable[[Array], Array] | None) -> list[Piece]:
    """Fillet, flank, tip, back flank and back fillet with the tooth on the y axis, from the right root to the left."""
    module = form.gear.normal_module * MM
    fillet = form.fillet(4001) * MM
    arc = np.linspace(0.0, 1.0, len(fillet))
    low, high = form.gear.roll_length(form.form_radius), form.flank_tip_roll

    def flank(t: Array) -> Array:
        # nearly even along the flank: the radius runs evenly, the roll length follows
        radius = form.form_radius + t * (form.flank_tip_radius - form.form_radius)
        roll = np.clip(np.sqrt(np.maximum(radius**2 - form.gear.base_radius**2, 0.0)), low, high)
        cut = np.zeros_like(roll) if removed is None else removed(roll)
        return np.asarray((form.flank_point(roll) - cut[:, None] * form.flank_normal(roll)) * MM)

    def root(t: Array) -> Array:
        return np.column_stack([np.interp(t, arc, fillet[:, k]) for k in (0, 1)])

    top = form.tip_points() * MM
    top = np.concatenate([top, np.column_stack([-top[-2::-1, 0], top[-2::-1, 1]])])
    corner = flank(np.array([1.0]))[0]
    angles = np.arctan2(top[:, 0], top[:, 1])
    radii = np.hypot(*top.T)
    edge = form.tip_edge_points
    assert edge == 1, "the tip edge is sharp here"
    angles[0], radii[0] = np.arctan2(*corner), hypot(*corner)
    share = (angles[0] - angles) / (angles[0] - angles[-1])

    def tip(t: Array) -> Array:
        a, r = angles[0] + t * (angles[-1] - angles[0]), np.interp(t, share, radii)
        return np.column_stack([r * np.sin(a), r * np.cos(a)])

    def length(curve: Curve) -> float:
        return float(np.hypot(*np.diff(curve(np.linspace(0.0, 1.0, 400)), axis=0).T).sum())

    def mirrored(curve: Curve) -> Curve:
        return lambda t: curve(1.0 - t) * np.array([-1.0, 1.0])

    corner_size, coarse = sizes.corner * module, sizes.coarse * module
    on_flank = _graded_from_end(length(flank), sizes.flank * module, corner_size)
    on_root = _even(length(root), sizes.fillet * module)
    back_root = _even(length(root), 2.0 * sizes.fillet * module)
    back = np.linspace(0.0, 1.0, 1 + ceil(length(flank) / coarse))
    on_tip = _graded(length(tip), corner_size, coarse)
    return [
        Piece(root, on_root, "fillet"),
        Piece(flank, on_flank, "flank"),
        Piece(tip, on_tip, "tip"),
        Piece(mirrored(flank), back, "back"),
        Piece(mirrored(root), back_root, "back_fillet"),
    ]


def _even(length: float, size: float) -> Array:
    return np.linspace(0.0, 1.0, 1 + max(2, ceil(length / size)))


def _graded_from_end(length: float, size: float, end_size: float, growth: float = 1.15) -> Array:
    """Places of nodes whose distance falls from ``size`` to ``end_size`` at the end."""
    steps, at = [], end_size
    while sum(steps) < length:
        steps.append(min(at, size))
        at *= growth
    return 1.0 - np.concatenate([[0.0], np.cumsum(steps)])[::-1] / sum(steps)


def _graded(length: float, end_size: float, size: float, growth: float = 1.25) -> Array:
    """Places of nodes whose distance grows from both ends to ``size``."""
    half = 1.0 - _graded_from_end(0.5 * length, size, end_size, growth)[::-1]
    return np.concatenate([0.5 * half, 1.0 - 0.5 * half[-2::-1]])


def _turned(curve: Curve, angle: float) -> Curve:
    c, s = cos(angle), sin(angle)
    return lambda t: curve(t) @ np.array([[c, s], [-s, c]])


def _arc(radius: float, start: float, end: float) -> Curve:
    return lambda t: (
        radius * np.column_stack([np.cos(start + t * (end - start)), np.sin(start + t * (end - start))])
    )


def plane_mesh(loops: list[list[Piece]]) -> PlaneMesh:
    """Triangles inside the first loop of pieces and outside of the others; every edge of the outline as given."""
    corners, middles, names = [], [], []
    ends = []
    for loop in loops:
        start = len(corners)
        for piece in loop:
            corners += list(piece.curve(piece.places[:-1]))
            middles += list(piece.curve(0.5 * (piece.places[1:] + piece.places[:-1])))
            names += [piece.name] * (len(piece.places) - 1)
        ends.append((start, len(corners)))
    points, triangles = _triangulate(np.array(corners), ends)
    return _second_order(points, triangles, np.array(middles), names, ends)


def _triangulate(corners: Array, ends: list[tuple[int, int]]) -> tuple[Array, Integers]:
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.Algorithm", 6)
        gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 1)
        geo, loops = gmsh.model.geo, []
        for tag, (x, y) in enumerate(corners, start=1):
            geo.addPoint(x, y, 0.0, tag=tag)
        for start, end in ends:
            around = [*range(start, end), start]
            lines = [geo.addLine(a + 1, b + 1) for a, b in pairwise(around)]
            for line in lines:
                geo.mesh.setTransfiniteCurve(line, 2)
            loops.append(geo.addCurveLoop(lines))
        geo.addPlaneSurface(loops)
        geo.synchronize()
        gmsh.model.mesh.generate(2)
        tags, xyz, _ = gmsh.model.mesh.getNodes()
        _, cells = gmsh.model.mesh.getElementsByType(2)
    finally:
        gmsh.finalize()
    order = np.argsort(tags)
    points = xyz.reshape(-1, 3)[order, :2]
    triangles = np.searchsorted(tags[order], cells).reshape(-1, 3).astype(np.int64)
    assert np.allclose(points[: len(corners)], corners), "gmsh renumbered the outline"
    a, b, c = (points[triangles[:, k]] for k in range(3))
    turned = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0] < 0.0
    triangles[turned] = triangles[turned][:, [0, 2, 1]]
    return points, triangles


def _second_order(
    points: Array, triangles: Integers, middles: Array, names: list[str], ends: list[tuple[int, int]]
) -> PlaneMesh:
    n = len(points)
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    keys, inverse = np.unique(edges[:, 0] * n + edges[:, 1], return_inverse=True)
    between = 0.5 * (points[keys // n] + points[keys % n])
    first = np.arange(len(names))
    after = first + 1
    for start, end in ends:
        after[end - 1] = start
    outline = np.minimum(first, after) * n + np.maximum(first, after)
    at = np.searchsorted(keys, outline)
    assert np.array_equal(keys[at], outline), "an edge of the outline is not in the mesh"
    between[at] = middles
    owner = np.zeros(len(keys), np.int64)
    owner[inverse] = np.arange(len(edges))
    label = np.array(names)
    sides, lines = {}, {}
    for name in dict.fromkeys(names):
        chosen = np.flatnonzero(label == name)
        sides[name] = np.column_stack([owner[at[chosen]] // 3, owner[at[chosen]] % 3])
        pairs = np.column_stack([first[chosen], n + at[chosen]]).ravel()
        lines[name] = np.append(pairs, after[chosen[-1]])
    return PlaneMesh(
        points=np.concatenate([points, between]),
        cells=np.hstack([triangles, n + inverse.reshape(-1, 3)]),
        sides=sides,
        lines=lines,
    )
