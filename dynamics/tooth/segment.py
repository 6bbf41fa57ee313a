"""Gear body with a few teeth in space: its transverse section drawn out over the face in layers of bricks.

A helical gear is turned from layer to layer. Positive z is the end of the face that comes into mesh last, for a gear
whose right flank drives; see `GearSegment.lead`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import ceil, cos, log, pi, radians, sin
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.gear.tooth_form import ToothForm
from dynamics.tooth.influence_numbers import STANDARD, TEETH, GearBody, SectionDivision
from thermal.fe.gmsh_session import gmsh_session
from thermal.fe.reference_elements import QUAD_8

Array = NDArray[np.float64]
IndexArray = NDArray[np.int32]


# Transverse section of a gear body with a few teeth in second-order quadrilaterals, as gmsh divides its drawing.

# Transverse section of a gear body with a few teeth as a drawing in gmsh, all of it in rows of quadrilaterals.
#
# Every gear that can be drawn can so be divided. Elements grow from the ring below the teeth towards the bore and the
# other side of the body; teeth further away carry nothing and are left out, the body ends on the root circle there.

GROWTH = 2.2
"""Size of an element of the body against its neighbour nearer to the teeth, about."""
FAR = 3.0
"""The same along the root circle, away from the teeth."""
WIDEST = radians(30.0)
"""Widest element round the gear [rad]."""
FOOT = 25
"""Point of the fillet, of 121 from the root circle up, above which the mesh is that of the tooth."""
RING = 0.5
"""Depth of the ring under the teeth in modules."""


@dataclass(frozen=True, kw_only=True)
class Ring:
    """Radii of the circles under the teeth [m]."""

    root: float
    depth: float
    rim: float | None
    bore: float

    @classmethod
    def of(cls, form: ToothForm, body: GearBody) -> "Ring":
        """Circles of a gear; raises DynamicsInputError for a body that leaves no steel under the teeth."""
        root, module = form.root_radius, form.gear.normal_module
        rim = None if body.rim_thickness is None else root - body.rim_thickness
        inner = body.bore_radius if rim is None else rim
        if body.web_thickness is not None and rim is None:
            raise DynamicsInputError(
                f"web_thickness = {1e3 * body.web_thickness:.3f} mm without rim_thickness: a web begins inside of a "
                "rim; give the rim or leave the web out"
            )
        enough = inner < root - 0.2 * module and (rim is None or rim > body.bore_radius)
        if not (0.0 < body.bore_radius < root and enough):
            raise DynamicsInputError(
                f"bore_radius = {1e3 * body.bore_radius:.3f} mm, rim_thickness = "
                f"{'none' if body.rim_thickness is None else f'{1e3 * body.rim_thickness:.3f} mm'}: a root circle of "
                f"{1e3 * root:.3f} mm needs at least 0.2 modules of steel under it; correct bore or rim"
            )
        depth = max(root - RING * module, 0.5 * (root + inner))
        return cls(root=root, depth=depth, rim=rim, bore=body.bore_radius)


@dataclass(frozen=True)
class Arc:
    """Arc of a circle about the gear: gmsh's curve, ends and their angles [rad], elements and how they grow."""

    curve: int
    first: int
    last: int
    angles: tuple[float, float]
    n: int
    ratio: float = 1.0

    def turned(self) -> "Arc":
        """The same arc from its other end."""
        return Arc(-self.curve, self.last, self.first, self.angles[::-1], self.n, 1.0 / self.ratio)


def _growing(length: float, first: float, growth: float) -> int:
    """Elements over a length that start with a size and grow."""
    return max(1, ceil(log(1.0 + (growth - 1.0) * length / first) / log(growth)))


def _even(points: Array, n: int = 31) -> Array:
    """(n, 2) points at equal distances along points (m, 2): gmsh's middles of sides are then in the middle."""
    length = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    wanted = np.linspace(0.0, length[-1], n)
    return np.column_stack([np.interp(wanted, length, points[:, k]) for k in (0, 1)])


def _far_parts(start: float, first: float) -> list[tuple[float, int, float]]:
    """Parts of the half circle from an angle on: where each ends [rad], its elements and how they grow.

    Elements grow from a first angle up to the widest, which then stays.
    """
    n = max(1, ceil(log(WIDEST / first) / log(FAR)))
    end = start + first * (FAR**n - 1.0) / (FAR - 1.0)
    if end > pi - 0.5 * WIDEST:
        return [(pi, _growing(pi - start, first, FAR), FAR)]
    return [(end, n, FAR), (pi, ceil((pi - end) / WIDEST), 1.0)]


class SectionDrawing:
    """The section in gmsh, and what it is called there.

    curves : name -> curves that follow each other, of which loads and results need the nodes
    patches : surfaces, those of the teeth and their ring first, those inside of a rim last
    of_teeth, of_web : how many patches these are; a solid body has no web
    """

    def __init__(self, geo: Any, form: ToothForm, ring: Ring, division: SectionDivision) -> None:
        self._geo = geo
        self._form, self._ring, self._division = form, ring, division
        self._pitch = 2.0 * pi / form.gear.teeth
        self.curves: dict[str, list[int]] = {}
        self._centre = self._geo.addPoint(0.0, 0.0, 0.0)
        self.patches: list[int] = []
        self.of_teeth = 0
        self.of_web = 0

    def _point(self, x: float, y: float, turn: float) -> int:
        """A point of a tooth that stands at an angle ``turn``, clockwise."""
        return int(self._geo.addPoint(x * cos(turn) + y * sin(turn), y * cos(turn) - x * sin(turn), 0.0))

    def _mirrored(self, point: Array, side: int, turn: float) -> int:
        """A point (2,) of the right half of a tooth, or its mirror image."""
        return self._point(side * float(point[0]), float(point[1]), turn)

    def _polar(self, radius: float, angle: float) -> int:
        return self._point(0.0, radius, angle)

    def _spline(self, points: Array, ends: tuple[int, int], turn: float, n: int) -> int:
        inner = [self._point(x, y, turn) for x, y in points[1:-1].tolist()]
        return self._counted(self._geo.addSpline([ends[0], *inner, ends[1]]), n)

    def _counted(self, curve: int, n: int, ratio: float = 1.0) -> int:
        """Divide a curve in n parts, each ``ratio`` times as long as the one before."""
        self._geo.mesh.setTransfiniteCurve(curve, n + 1, "Progression", ratio)
        return int(curve)

    def _line(self, first: int, last: int, n: int) -> int:
        return self._counted(self._geo.addLine(first, last), n)

    def _arc(self, first: int, last: int, n: int, ratio: float = 1.0) -> int:
        return self._counted(self._geo.addCircleArc(first, self._centre, last), n, ratio)

    def _patch(self, loop: list[int], corners: list[int]) -> None:
        surface = self._geo.addPlaneSurface([self._geo.addCurveLoop(loop)])
        self._geo.mesh.setTransfiniteSurface(surface, cornerTags=corners)
        self._geo.mesh.setRecombine(2, surface)
        self.patches.append(surface)

    def draw(self) -> None:
        """Teeth, ring under them and the rest of the body."""
        n = len(TEETH) // 2
        ends: list[tuple[int, int]] = []
        for place in range(-n, n + 2):
            angle = (place - 0.5) * self._pitch
            ends.append((self._polar(self._ring.root, angle), self._polar(self._ring.depth, angle)))
        sides = [self._wall(high, low) for high, low in ends]
        under: list[Arc] = []
        for number, tooth in enumerate(TEETH):
            under += self._tooth(tooth, (ends[number], ends[number + 1]), (sides[number], sides[number + 1]))
        self.of_teeth = len(self.patches)
        self._body([*under, *self._far_ring((ends[0], ends[-1]), (sides[0], sides[-1]))])

    def _tooth(
        self, tooth: int, ends: tuple[tuple[int, int], tuple[int, int]], sides: tuple[int, int]
    ) -> "list[Arc]":
        """One tooth with its ring, from space to space; the arcs on the inner circle of the ring, left to right."""
        form, division, turn = self._form, self._division, tooth * self._pitch
        profile, thickness, n_fillet = division.of_tooth(tooth)
        low_part = n_fillet // 4
        high_part = n_fillet - low_part
        fillet = form.fillet(121)
        qx, qy = fillet[FOOT].tolist()
        axis_low = self._polar(float(np.hypot(qx, qy)), turn)
        axis_deep = self._polar(self._ring.depth, turn)
        tip = form.tip_points()
        axis_top = self._point(0.0, float(tip[-1, 1]), turn)
        axis_form = self._polar(form.form_radius, turn)
        foot, stem = self._line(axis_low, axis_form, high_part), self._line(axis_form, axis_top, profile)
        deep = self._counted(self._geo.addLine(axis_deep, axis_low), division.depth, division.grading)
        self.curves[f"axis {tooth}"] = [deep, foot, stem]
        under: list[Arc] = []
        for side in (-1, 1):
            (root, low), wall = (ends[0], sides[0]) if side < 0 else (ends[1], sides[1])
            mirror = np.array([side, 1.0])
            q = self._mirrored(fillet[FOOT], side, turn)
            foot_angle = float(np.arctan2(qx, qy))
            c = self._polar(self._ring.depth, turn + side * foot_angle)
            f, t = (self._mirrored(point, side, turn) for point in (fillet[-1], tip[0]))
            space = 0.5 * self._pitch
            arc = np.linspace(space, float(np.arctan2(fillet[0, 0], fillet[0, 1])), 5)[:-1]
            ground = np.concatenate(
                [form.root_radius * np.column_stack([np.sin(arc), np.cos(arc)]), fillet[: FOOT + 1]]
            )
            lower = self._spline(mirror * _even(ground), (root, q), turn, low_part)
            upper = self._spline(mirror * fillet[FOOT:], (q, f), turn, high_part)
            rolls = np.linspace(
                form.gear.roll_length(form.form_radius), form.gear.roll_length(form.flank_tip_radius), 61
            )
            flank = self._spline(mirror * form.flank_point(rolls), (f, t), turn, profile)
            top = self._tip(mirror * tip, (t, axis_top), turn, thickness)
            foot_line = self._arc(axis_low, q, thickness, division.grading)
            column = self._counted(self._geo.addLine(c, q), division.depth, division.grading)
            under_tooth = self._arc(axis_deep, c, thickness, division.grading)
            under_root = self._arc(c, low, low_part)
            self.curves[f"flank {tooth} {side}"] = [flank]
            self.curves[f"fillet {tooth} {side}"] = [lower, upper]
            across = self._arc(axis_form, f, thickness, division.grading)
            self._patch([foot_line, upper, -across, -foot], [axis_low, q, f, axis_form])
            self._patch([across, flank, *top, -stem], [axis_form, f, t, axis_top])
            self._patch([under_tooth, column, -foot_line, -deep], [axis_deep, c, q, axis_low])
            self._patch([under_root, wall, lower, -column], [c, low, root, q])
            inner = Arc(
                under_tooth, axis_deep, c, (turn, turn + side * foot_angle), thickness, division.grading
            )
            outer = Arc(
                under_root, c, low, (turn + side * foot_angle, turn + side * 0.5 * self._pitch), low_part
            )
            under = [*under, inner, outer] if side > 0 else [outer.turned(), inner.turned()]
        return under

    def _tip(self, tip: Array, ends: tuple[int, int], turn: float, n: int) -> list[int]:
        """Curves from the end of the flank to the tooth axis, in n elements.

        The edge between flank and tip is drawn as its chord; that of a tooth one element wide runs to the axis.
        """
        start, end = ends
        corner = self._form.tip_edge_points
        if corner == 1:
            return [self._arc(start, end, n, 1.0 / self._division.grading)]
        if n == 1:
            return [self._line(start, end, 1)]
        middle = self._mirrored(tip[corner - 1], 1, turn)
        return [self._line(start, middle, 1), self._arc(middle, end, n - 1, 1.0 / self._division.grading)]

    def _far_ring(self, ends: tuple[tuple[int, int], tuple[int, int]], sides: tuple[int, int]) -> "list[Arc]":
        """The ring where no teeth are drawn, right and left half; its arcs on the inner circle, left to right."""
        ring, division = self._ring, self._division
        last = 0.5 * len(TEETH) * self._pitch
        _, thickness, fillet = division.neighbours
        parts = _far_parts(last, self._pitch / (2 * thickness + fillet // 2))
        opposite = (self._polar(ring.root, pi), self._polar(ring.depth, pi))
        across = self._wall(*opposite)
        ring_arcs = []
        for side, (root, low), wall in ((1, ends[1], sides[1]), (-1, ends[0], sides[0])):
            arcs, rim, angle = [], [], last
            for number, (end, n, ratio) in enumerate(parts):
                further = (self._polar(ring.root, side * end), self._polar(ring.depth, side * end))
                next_wall = self._wall(*further) if number < len(parts) - 1 else across
                further = further if number < len(parts) - 1 else opposite
                outer, inner = self._arc(root, further[0], n, ratio), self._arc(low, further[1], n, ratio)
                self._patch([inner, next_wall, -outer, -wall], [low, further[1], further[0], root])
                arcs.append(Arc(inner, low, further[1], (side * angle, side * end), n, ratio))
                rim.append(outer)
                (root, low), wall, angle = further, next_wall, end
            self.curves[f"rim {side}"] = rim
            ring_arcs += arcs if side > 0 else [arc.turned() for arc in reversed(arcs)]
        return ring_arcs

    def _wall(self, root: int, low: int) -> int:
        """Line across the ring, from its inner circle to the root circle."""
        return self._counted(self._geo.addLine(low, root), self._division.depth, self._division.grading)

    def _body(self, outer: "list[Arc]") -> None:
        """What is inside of the ring, rim and web or solid, in rows from arc to arc of a closed circle."""
        ring = self._ring
        size = ring.root - ring.depth
        upper = ring.depth
        for radius in [ring.bore] if ring.rim is None else [ring.rim, ring.bore]:
            n = _growing(upper - radius, size, GROWTH)
            points = [self._polar(radius, arc.angles[0]) for arc in outer]
            spokes = [
                self._counted(self._geo.addLine(arc.first, point), n, GROWTH)
                for arc, point in zip(outer, points, strict=True)
            ]
            inner = []
            for k, arc in enumerate(outer):
                after = (k + 1) % len(outer)
                curve = self._arc(points[k], points[after], arc.n, arc.ratio)
                self._patch(
                    [spokes[k], curve, -spokes[after], -arc.curve],
                    [arc.first, points[k], points[after], arc.last],
                )
                inner.append(Arc(curve, points[k], points[after], arc.angles, arc.n, arc.ratio))
            self.of_web = 0 if ring.rim is None else len(outer)
            outer, size, upper = inner, size * GROWTH ** (n - 1), radius
        self.curves["bore"] = [arc.curve for arc in outer]


# Quadrilaterals of eight nodes in the plane: their sense and whether they fold.


def anticlockwise(points: Array, cells: IndexArray) -> IndexArray:
    """Cells (n, 8) on points (n_points, 2) with their corners anticlockwise."""
    a, b, c = (points[cells[:, k]] for k in range(3))
    turned = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0] < 0.0
    cells = cells.copy()
    cells[turned] = cells[turned][:, [0, 3, 2, 1, 7, 6, 5, 4]]
    return cells


def on_circles(points: Array, cells: IndexArray) -> Array:
    """Points with the middles of the sides of cells (n, 8) on circles about the origin instead of on chords.

    gmsh leaves sides inside of a plane surface straight; wide and thin cells on an arc would fold.
    """
    points = points.copy()
    for side in range(4):
        first, last = points[cells[:, side]], points[cells[:, (side + 1) % 4]]
        middle = 0.5 * (first + last)
        radius = 0.5 * (np.hypot(*first.T) + np.hypot(*last.T))
        points[cells[:, 4 + side]] = middle * (radius / np.hypot(*middle.T))[:, None]
    return points


def least_jacobian(points: Array, cells: IndexArray) -> float:
    """Smallest determinant of the Jacobian at nodes of anticlockwise cells, over the area of the cell about it [-].

    Not positive: the cell folds.
    """
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    places = np.concatenate([corners, 0.5 * (corners + np.roll(corners, -1, axis=0))])
    gradients = QUAD_8.gradients(places)
    jacobian = np.einsum("nka,qkb->nqab", points[cells], gradients)
    determinant = jacobian[..., 0, 0] * jacobian[..., 1, 1] - jacobian[..., 0, 1] * jacobian[..., 1, 0]
    return float((determinant / np.abs(determinant).mean(axis=1, keepdims=True)).min())


GMSH_QUAD_8 = 16
"""gmsh's number of the element."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Section:
    """Quadrilaterals of the section and the nodes that loads and results need.

    The axis of tooth 0 is y. Tooth k stands k pitches on, clockwise as the right flank faces.
    """

    points: Array
    """(n, 2) [m]"""
    cells: IndexArray
    """(n_cells, 8) corners anticlockwise, then the middles of the sides."""
    flanks: Mapping[int, IndexArray]
    """Tooth -> (2 profile + 1,) nodes of its right flank from fillet to tip, corners and middles of elements."""
    axes: Mapping[int, IndexArray]
    """Tooth -> nodes on its axis from the ring below it to the tip, corners and middles."""
    fillets: Mapping[tuple[int, int], IndexArray]
    """(tooth, +1 right or -1 left) -> nodes from the middle of the tooth space to the flank, corners and middles."""
    rims: Mapping[int, IndexArray]
    """+1 right or -1 left -> nodes on the root circle from the last tooth drawn to the other side of the gear."""
    bore: IndexArray
    """Nodes on the bore."""
    web: IndexArray
    """Cells inside of the rim; none in a solid body."""


def gear_section(form: ToothForm, body: GearBody, division: SectionDivision = STANDARD) -> Section:
    """Divide the section of a gear.

    Raises DynamicsInputError for a bore or rim that leaves no body under the teeth and for a tip edge or protuberance
    that elements cannot follow; OSError or ImportError where gmsh is missing.
    """
    ring = Ring.of(form, body)
    with gmsh_session() as gmsh:
        drawing = SectionDrawing(gmsh.model.geo, form, ring, division)
        drawing.draw()
        gmsh.model.geo.synchronize()
        gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(2)
        section = _section(gmsh, drawing)
    if not least_jacobian(section.points, section.cells) > 0.0:
        raise DynamicsInputError(
            f"section of the gear with {form.gear.teeth} teeth and module {1e3 * form.gear.normal_module:g} mm: "
            f"elements fold; a tip edge (rounding {1e3 * form.tip_edge.rounding:.3f} mm, chamfer "
            f"{1e3 * form.tip_edge.chamfer:.3f} mm) or protuberance ({1e3 * form.protuberance:.3f} mm) of a tenth of "
            "the module is usual, reduce them"
        )
    return section


def _section(gmsh: ModuleType, drawing: SectionDrawing) -> Section:
    """The mesh of everything drawn."""
    blocks = [_quadrilaterals(gmsh, patch) for patch in drawing.patches]
    numbered = np.concatenate(blocks)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    used = np.unique(numbered)
    place = np.full(int(tags.max()) + 1, -1, dtype=np.int32)
    place[used] = np.arange(len(used), dtype=np.int32)
    row = np.full(int(tags.max()) + 1, -1, dtype=np.int64)
    row[tags.astype(np.int64)] = np.arange(len(tags))
    points = coordinates.reshape(-1, 3)[row[used], :2]
    cells = anticlockwise(points, place[numbered])
    of_teeth = sum(len(block) for block in blocks[: drawing.of_teeth])
    of_web = sum(len(block) for block in blocks[len(blocks) - drawing.of_web :])
    ordered = {name: place[_along(gmsh, curves)] for name, curves in drawing.curves.items()}
    return Section(
        points=on_circles(points, cells[of_teeth:]),
        cells=cells,
        flanks={tooth: ordered[f"flank {tooth} 1"] for tooth in TEETH},
        axes={tooth: ordered[f"axis {tooth}"] for tooth in TEETH},
        fillets={(tooth, side): ordered[f"fillet {tooth} {side}"] for tooth in TEETH for side in (-1, 1)},
        rims={side: ordered[f"rim {side}"] for side in (1, -1)},
        bore=np.unique(ordered["bore"]),
        web=np.arange(len(cells) - of_web, len(cells), dtype=np.int32),
    )


def _quadrilaterals(gmsh: ModuleType, surface: int) -> NDArray[np.int64]:
    """(n, 8) node tags of a surface."""
    kinds, _, nodes = gmsh.model.mesh.getElements(2, surface)
    assert list(kinds) == [GMSH_QUAD_8], f"gmsh left elements of kinds {kinds}"
    return np.asarray(nodes[0].reshape(-1, 8).astype(np.int64))


def _along(gmsh: ModuleType, curves: list[int]) -> NDArray[np.int64]:
    """Node tags of curves that follow each other, in order, corners and middles."""
    tags: list[int] = []
    for curve in curves:
        nodes = gmsh.model.mesh.getElements(1, curve)[2][0].reshape(-1, 3).astype(np.int64)
        steps = nodes[:, [0, 2]].ravel().tolist()
        tags += steps if not tags else steps[1:]
        tags.append(int(nodes[-1, 1]))
    return np.array(tags)


NOWHERE = -1
"""Number of a node that is not there."""


@dataclass(frozen=True, kw_only=True, eq=False)
class GearSegment:
    """Bricks of 20 nodes and where a node of the section lies in space.

    section : transverse, teeth upwards along y
    heights : (n_planes,) positions of the planes between layers over the face, growing [m]
    lead : turn of the section per z, clockwise positive [rad/m]: tan(beta) / r
    points : (n, 3) [m]; cells : (n_cells, 20)
    planes : (n_planes, n_section) node of a section node in a plane
    middles : (n_planes - 1, n_section) node halfway between planes, corners of the section only
    """

    section: Section
    heights: Array
    lead: float
    points: Array
    cells: IndexArray
    planes: IndexArray
    middles: IndexArray

    @classmethod
    def of(
        cls, section: Section, heights: Array, lead: float = 0.0, body: GearBody | None = None
    ) -> "GearSegment":
        """Draw a section out over the face.

        heights : (n_planes,) growing [m], at least two
        body : the rim of a gear with a web reaches over the whole face, the web over its own width only

        Raises DynamicsInputError for a web that holds no layer.
        """
        if len(heights) < 2 or not np.all(np.diff(heights) > 0.0):
            raise DynamicsInputError(f"heights = {heights}: needs at least two growing positions")
        n, layers = len(section.points), len(heights) - 1
        corner = np.zeros(n, dtype=bool)
        corner[section.cells[:, :4]] = True
        whole = np.arange((layers + 1) * n, dtype=np.int32).reshape(layers + 1, n)
        between = np.full((layers, n), NOWHERE, dtype=np.int32)
        between[:, corner] = (whole.size + np.arange(layers * int(corner.sum()), dtype=np.int32)).reshape(
            layers, -1
        )
        low, high, middle = whole[:-1], whole[1:], between
        quads = section.cells
        bricks = np.concatenate(
            [
                low[:, quads[:, :4]], high[:, quads[:, :4]],
                low[:, quads[:, 4:]], high[:, quads[:, 4:]], middle[:, quads[:, :4]],
            ],
            axis=2,
        )  # fmt: skip
        kept = _kept_layers(section, heights, body)
        cells = bricks[kept]
        over_face = np.concatenate(
            [np.repeat(heights, n), np.repeat(0.5 * (heights[:-1] + heights[1:]), corner.sum())]
        )
        flat = np.concatenate(
            [np.tile(section.points, (layers + 1, 1)), np.tile(section.points[corner], (layers, 1))]
        )
        points = np.column_stack([turned(flat, lead * over_face), over_face])
        used = np.unique(cells)
        number = np.full(len(points), NOWHERE, dtype=np.int32)
        number[used] = np.arange(len(used), dtype=np.int32)
        return cls(
            section=section,
            heights=heights,
            lead=lead,
            points=points[used],
            cells=number[cells],
            planes=number[whole],
            middles=np.where(between == NOWHERE, NOWHERE, number[between]),
        )

    def layers_at(self, position: float) -> list[tuple[int, float]]:
        """Layers that hold a position over the face and the place in each, 0 to 1; both that meet in a plane."""
        places = (position - self.heights[:-1]) / np.diff(self.heights)
        slack = self.slack / np.diff(self.heights)
        layers = np.flatnonzero((places >= -slack) & (places <= 1.0 + slack))
        return [(int(layer), float(np.clip(places[layer], 0.0, 1.0))) for layer in layers]

    @property
    def straight(self) -> Array:
        """(n, 3) points as if the gear had no helix: its planes do not turn [m]."""
        height = self.points[:, 2]
        return np.column_stack([turned(self.points[:, :2], -self.lead * height), height])

    @property
    def slack(self) -> float:
        """Length below which heights are the same [m]."""
        return 1e-9 * float(self.heights[-1] - self.heights[0])

    @cached_property
    def mirror(self) -> IndexArray | None:
        """(n,) node on the other side of mid-face; None where the halves differ or no plane parts them."""
        even = len(self.heights) % 2 == 0 or np.abs(self.heights + self.heights[::-1]).max() > self.slack
        if even or self.lead != 0.0:
            return None
        mirrored = np.empty(len(self.points), dtype=np.int32)
        for nodes in (self.planes, self.middles):
            there = nodes != NOWHERE
            if (there != there[::-1]).any():
                return None
            mirrored[nodes[there]] = nodes[::-1][there]
        return mirrored

    @cached_property
    def bore(self) -> IndexArray:
        """Nodes on the bore, where the shaft holds the gear."""
        nodes = np.concatenate(
            [self.planes[:, self.section.bore].ravel(), self.middles[:, self.section.bore].ravel()]
        )
        return np.unique(nodes[nodes != NOWHERE])


def turned(points: Array, angle: Array) -> Array:
    """(n, 2) points turned clockwise by (n,) angles [rad]."""
    x, y = points[:, 0], points[:, 1]
    return np.column_stack([x * np.cos(angle) + y * np.sin(angle), y * np.cos(angle) - x * np.sin(angle)])


def _kept_layers(section: Section, heights: Array, body: GearBody | None) -> NDArray[np.bool_]:
    """(n_layers, n_quads) which bricks are there."""
    layers, quads = len(heights) - 1, len(section.cells)
    kept = np.ones((layers, quads), dtype=bool)
    if body is None or body.web_thickness is None:
        return kept
    middle = 0.5 * (heights[:-1] + heights[1:])
    off = np.abs(middle) > 0.5 * body.web_thickness
    if off.all():
        raise DynamicsInputError(
            f"web_thickness = {1e3 * body.web_thickness:.3f} mm is thinner than a layer of "
            f"{1e3 * np.diff(heights).min():.3f} mm; divide the face finer"
        )
    kept[np.ix_(off, section.web)] = False
    return kept
