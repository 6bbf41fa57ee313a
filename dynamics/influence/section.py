"""Transverse section of a gear body with a few teeth, divided into second-order quadrilaterals by gmsh.

The teeth round the loaded one and the ring below them are divided in rows, the rest of the body freely and coarser
towards the bore; teeth further away carry nothing and are left out, the body ends on the root circle there.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, pi, sin
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.gear.tooth_form import ToothForm
from thermal.fe.gmsh_session import gmsh_session

Array = NDArray[np.float64]
IndexArray = NDArray[np.int32]
QUAD_8 = 16
"""gmsh's number of the element."""
GROWTH = 0.5
"""Growth of free elements per distance from the teeth [-]."""
COARSEST = 0.5
"""Largest element as a share of the root radius [-]."""


@dataclass(frozen=True, kw_only=True)
class GearBody:
    """Body under the teeth; lengths [m].

    bore_radius : at which it is held
    rim_thickness : from the root circle inwards; None: solid down to the bore
    web_thickness : axial, in the middle of the face, where there is a rim
    """

    bore_radius: float
    rim_thickness: float | None = None
    web_thickness: float | None = None


@dataclass(frozen=True, kw_only=True)
class SectionDivision:
    """Elements of the section.

    profile : over the flank; thickness : over half the tooth, even; fillet : over each fillet, even
    depth : between root circle and free mesh
    teeth : in detail to either side of the loaded one
    growth : size of an element on the tip against that on the fillet end of the flank
    """

    profile: int = 8
    thickness: int = 2
    fillet: int = 8
    depth: int = 2
    teeth: int = 1

    def finer(self, factor: float) -> "SectionDivision":
        """The same in elements smaller by a factor."""
        return SectionDivision(
            **{
                name: max(1, round(factor * getattr(self, name)))
                for name in ("profile", "thickness", "depth")
            },
            fillet=2 * max(1, round(0.5 * factor * self.fillet)),
            teeth=self.teeth,
        )


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
    bore: IndexArray
    """Nodes on the bore."""


def gear_section(form: ToothForm, body: GearBody, division: SectionDivision = SectionDivision()) -> Section:
    """Divide the section of a gear.

    Raises DynamicsInputError for a bore or rim that leaves no body under the teeth; OSError or ImportError where gmsh
    is missing.
    """
    ring = _Ring.of(form, body, division)
    with gmsh_session() as gmsh:
        drawing = _Drawing(gmsh, form, ring, division)
        drawing.draw(body)
        return drawing.divided()


@dataclass(frozen=True, kw_only=True)
class _Ring:
    """Radii of the circles under the teeth [m]."""

    root: float
    depth: float
    rim: float | None
    bore: float

    @classmethod
    def of(cls, form: ToothForm, body: GearBody, division: SectionDivision) -> "_Ring":
        root, module = form.root_radius, form.gear.normal_module
        rim = None if body.rim_thickness is None else root - body.rim_thickness
        inner = body.bore_radius if rim is None else rim
        if not 0.0 < body.bore_radius < root or not inner < root - 0.2 * module or inner < body.bore_radius:
            raise DynamicsInputError(
                f"bore_radius = {1e3 * body.bore_radius:.3f} mm, rim_thickness = "
                f"{'none' if body.rim_thickness is None else f'{1e3 * body.rim_thickness:.3f} mm'}: a root circle of "
                f"{1e3 * root:.3f} mm needs at least 0.2 modules of steel under it; correct bore or rim"
            )
        depth = max(root - 1.5 * module, 0.5 * (root + inner))
        return cls(root=root, depth=depth, rim=rim, bore=body.bore_radius)


class _Drawing:
    """The section in gmsh, and what it is called there."""

    def __init__(self, gmsh: ModuleType, form: ToothForm, ring: _Ring, division: SectionDivision) -> None:
        self._gmsh, self._geo = gmsh, gmsh.model.geo
        self._form, self._ring, self._division = form, ring, division
        self._pitch = 2.0 * pi / form.gear.teeth
        self._curves: dict[str, list[int]] = {}
        self._centre = self._geo.addPoint(0.0, 0.0, 0.0)
        self._patches: list[int] = []

    def _point(self, x: float, y: float, turn: float, size: float = 0.0) -> int:
        """A point of a tooth that stands at an angle ``turn``, clockwise."""
        return int(
            self._geo.addPoint(x * cos(turn) + y * sin(turn), y * cos(turn) - x * sin(turn), 0.0, size)
        )

    def _polar(self, radius: float, angle: float, size: float = 0.0) -> int:
        return self._point(0.0, radius, angle, size)

    def _spline(self, points: Array, ends: tuple[int, int], turn: float, n: int) -> int:
        inner = [self._point(x, y, turn) for x, y in points[1:-1].tolist()]
        return self._counted(self._geo.addSpline([ends[0], *inner, ends[1]]), n)

    def _counted(self, curve: int, n: int) -> int:
        self._geo.mesh.setTransfiniteCurve(curve, n + 1)
        return int(curve)

    def _line(self, first: int, last: int, n: int) -> int:
        return self._counted(self._geo.addLine(first, last), n)

    def _arc(self, first: int, last: int, n: int) -> int:
        return self._counted(self._geo.addCircleArc(first, self._centre, last), n)

    def _patch(self, loop: list[int], corners: list[int]) -> None:
        surface = self._geo.addPlaneSurface([self._geo.addCurveLoop(loop)])
        self._geo.mesh.setTransfiniteSurface(surface, cornerTags=corners)
        self._geo.mesh.setRecombine(2, surface)
        self._patches.append(surface)

    def draw(self, body: GearBody) -> None:
        """Teeth, ring and free part."""
        n = self._division.teeth
        ends: list[tuple[int, int]] = []
        for place in range(-n, n + 2):
            angle = (place - 0.5) * self._pitch
            ends.append((self._polar(self._ring.root, angle), self._polar(self._ring.depth, angle)))
        sides = [self._line(low, high, self._division.depth) for high, low in ends]
        under: list[int] = []
        for number, tooth in enumerate(range(-n, n + 1)):
            under += self._tooth(tooth, (ends[number], ends[number + 1]), (sides[number], sides[number + 1]))
        self._free(body, under, (ends[0], ends[-1]), (sides[0], sides[-1]))

    def _tooth(
        self, tooth: int, ends: tuple[tuple[int, int], tuple[int, int]], sides: tuple[int, int]
    ) -> list[int]:
        """One tooth with its ring, from space to space; the curves on the inner circle of the ring, left to right."""
        form, division, turn = self._form, self._division, tooth * self._pitch
        half = division.fillet // 2
        fillet = form.fillet(121)
        foot = 60
        qx, qy = fillet[foot].tolist()
        axis_low = self._polar(float(np.hypot(qx, qy)), turn)
        axis_deep = self._polar(self._ring.depth, turn)
        tip = form.tip_points()
        axis_top = self._point(0.0, float(tip[-1, 1]), turn)
        rows = half + division.profile
        stem = self._line(axis_low, axis_top, rows)
        deep = self._line(axis_deep, axis_low, division.depth)
        self._curves[f"axis {tooth}"] = [deep, stem]
        under: list[int] = []
        for side in (-1, 1):
            (root, low), wall = (ends[0], sides[0]) if side < 0 else (ends[1], sides[1])
            mirror = np.array([side, 1.0])
            q = self._point(side * qx, qy, turn)
            c = self._polar(self._ring.depth, turn + side * float(np.arctan2(qx, qy)))
            f = self._point(*(mirror * fillet[-1]).tolist(), turn)
            t = self._point(*(mirror * tip[0]).tolist(), turn)
            space = 0.5 * self._pitch
            arc = np.linspace(space, float(np.arctan2(fillet[0, 0], fillet[0, 1])), 5)[:-1]
            ground = np.concatenate(
                [form.root_radius * np.column_stack([np.sin(arc), np.cos(arc)]), fillet[: foot + 1]]
            )
            lower = self._spline(mirror * ground, (root, q), turn, half)
            upper = self._spline(mirror * fillet[foot:], (q, f), turn, half)
            rolls = np.linspace(
                form.gear.roll_length(form.form_radius), form.gear.roll_length(form.flank_tip_radius), 61
            )
            flank = self._spline(mirror * form.flank_point(rolls), (f, t), turn, division.profile)
            top = self._tip(mirror * tip, t, axis_top, turn)
            foot_line = self._arc(axis_low, q, division.thickness)
            column = self._line(c, q, division.depth)
            under_tooth = self._arc(axis_deep, c, division.thickness)
            under_root = self._arc(c, low, half)
            self._curves[f"flank {tooth} {side}"] = [flank]
            self._curves[f"fillet {tooth} {side}"] = [lower, upper]
            self._patch([foot_line, upper, flank, *top, -stem], [axis_low, q, t, axis_top])
            self._patch([under_tooth, column, -foot_line, -deep], [axis_deep, c, q, axis_low])
            self._patch([under_root, wall, lower, -column], [c, low, root, q])
            under = [*under, under_tooth, under_root] if side > 0 else [-under_root, -under_tooth]
        return under

    def _tip(self, tip: Array, start: int, end: int, turn: float) -> list[int]:
        """Curves from the end of the flank to the tooth axis."""
        n = self._division.thickness
        corner = self._form.tip_edge_points
        if corner == 1:
            return [self._arc(start, end, n)]
        middle = self._point(*tip[corner - 1].tolist(), turn)
        return [
            self._spline(tip[:corner], (start, middle), turn, 1),
            self._arc(middle, end, n - 1),
        ]

    def _free(
        self,
        body: GearBody,
        under: list[int],
        ends: tuple[tuple[int, int], tuple[int, int]],
        sides: tuple[int, int],
    ) -> None:
        """The rest of the body down to the bore, free quadrilaterals that grow with the distance from the teeth."""
        ring, geo = self._ring, self._geo
        last = (self._division.teeth + 0.5) * self._pitch
        far = [self._polar(ring.root, angle) for angle in np.linspace(last, 2.0 * pi - last, 4)[1:-1]]
        stops = [ends[1][0], *far, ends[0][0]]
        arcs = [geo.addCircleArc(a, self._centre, b) for a, b in zip(stops, stops[1:])]
        outer = [*under, sides[1], *arcs, -sides[0]]
        loop = geo.addCurveLoop(outer)
        for radius in [ring.bore] if ring.rim is None else [ring.rim, ring.bore]:
            corners = [self._polar(radius, 0.5 * pi * k) for k in range(4)]
            circle = [geo.addCircleArc(corners[k], self._centre, corners[(k + 1) % 4]) for k in range(4)]
            hole = geo.addCurveLoop(circle)
            surface = geo.addPlaneSurface([loop, hole])
            geo.mesh.setRecombine(2, surface)
            self._patches.append(surface)
            loop = hole
            self._curves["bore"] = circle
        self._under = [abs(curve) for curve in under]

    def _grade(self) -> None:
        """Elements of the free part grow with their distance from the ring under the teeth."""
        field = self._gmsh.model.mesh.field
        distance = field.add("Distance")
        field.setNumbers(distance, "CurvesList", self._under)
        field.setNumber(distance, "Sampling", 40)
        growing = field.add("MathEval")
        columns = 2 * self._division.thickness + self._division.fillet
        first = self._pitch * self._ring.depth / columns
        field.setString(
            growing, "F", f"Min({first:.9g} + {GROWTH} * F{distance}, {COARSEST * self._ring.root:.9g})"
        )
        field.setAsBackgroundMesh(growing)

    def divided(self) -> Section:
        """The mesh of everything drawn."""
        gmsh = self._gmsh
        self._geo.synchronize()
        for name, value in (
            ("Algorithm", 8),
            ("RecombinationAlgorithm", 3),
            ("SecondOrderIncomplete", 1),
            ("MeshSizeExtendFromBoundary", 0),
        ):
            gmsh.option.setNumber(f"Mesh.{name}", value)
        self._grade()
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(2)
        blocks = []
        for surface in self._patches:
            kinds, _, nodes = gmsh.model.mesh.getElements(2, surface)
            if list(kinds) != [QUAD_8]:
                raise DynamicsInputError(
                    f"section of {self._form.gear.teeth} teeth: gmsh left elements that are no quadrilaterals; divide it finer"
                )
            blocks.append(nodes[0].reshape(-1, 8))
        cells = np.concatenate(blocks).astype(np.int64)
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        used = np.unique(cells)
        place = np.full(int(tags.max()) + 1, -1, dtype=np.int32)
        place[used] = np.arange(len(used), dtype=np.int32)
        row = np.full(int(tags.max()) + 1, -1, dtype=np.int64)
        row[tags.astype(np.int64)] = np.arange(len(tags))
        points = coordinates.reshape(-1, 3)[row[used], :2]
        cells = _anticlockwise(points, place[cells])
        teeth = range(-self._division.teeth, self._division.teeth + 1)
        ordered = {name: place[self._along(curves)] for name, curves in self._curves.items()}
        return Section(
            points=points,
            cells=cells,
            flanks={tooth: ordered[f"flank {tooth} 1"] for tooth in teeth},
            axes={tooth: ordered[f"axis {tooth}"] for tooth in teeth},
            fillets={(tooth, side): ordered[f"fillet {tooth} {side}"] for tooth in teeth for side in (-1, 1)},
            bore=np.unique(ordered["bore"]),
        )

    def _along(self, curves: list[int]) -> NDArray[np.int64]:
        """Node tags of curves that follow each other, in order, corners and middles."""
        found: list[int] = []
        for curve in curves:
            nodes = self._gmsh.model.mesh.getElements(1, curve)[2][0].reshape(-1, 3).astype(np.int64)
            steps = nodes[:, [0, 2]].ravel().tolist()
            found += steps if not found else steps[1:]
            found.append(int(nodes[-1, 1]))
        return np.array(found)


def _anticlockwise(points: Array, cells: IndexArray) -> IndexArray:
    """Cells with their corners anticlockwise."""
    a, b, c = (points[cells[:, k]] for k in range(3))
    turned = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0] < 0.0
    cells = cells.copy()
    cells[turned] = cells[turned][:, [0, 3, 2, 1, 7, 6, 5, 4]]
    return cells
