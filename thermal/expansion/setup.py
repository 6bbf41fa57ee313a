"""Stiffness, supports and measuring points of a gearbox, made once for all its temperature fields."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from thermal.expansion.elastic import ElasticError, ElasticSetup, three_two_one
from thermal.fe.elements import FiniteElements, SurfaceElements
from thermal.fe.mesh import FloatArray, IndexArray
from thermal.fe.reference_elements import TRIANGLE_6
from thermal.fe.solver import BoolArray
from thermal.housing.stations import BearingStation, GearboxModel, Point, ShaftStation

# How cylinders about an axis along x move and expand: bores, journals, seals, gear rims.
#
# Facets of a coarse mesh may lie off the cylinder they stand for. The displacement read there is carried to the
# cylinder with the free strain, so uniform heating gives the same expansion on every mesh.


@dataclass(frozen=True)
class CylinderMotion:
    """Displacement of a cylinder in the first harmonics of its circumference.

    The radial displacement is fitted by u_r = a0 + a1 cos(p) + b1 sin(p) + a2 cos(2p) + b2 sin(2p),
    area-weighted, with the angle p from +y towards +z: to first order it alone makes the new shape. The terms
    a0, a1, b1 may vary linearly along the axis, and u_x along and across it; values are those at the centre.
    """

    shift: tuple[float, float, float]
    """Of the centre [m]: u_x, and the first harmonic of u_r in y and z."""
    radius_expansion: float
    """Expansion of the mean radius, a0 [m]."""
    ovality: float
    """Largest minus smallest diameter of the second harmonic [m]."""
    tilt: tuple[float, float]
    """Slope of the axis in y and z along x [rad]."""
    turn: float
    """Mean rotation about the axis [rad]."""


@dataclass(frozen=True, eq=False)
class Cylinder:
    """A whole cylinder about an x-line, its fit found once and read for any displacement.

    cos, sin : (n_q,) of the angle of the quadrature points; off : (n_q,) their distance inside the cylinder [m]
    radial : (8, n_q) makes the harmonics of the radial displacement, axial : (4, n_q) those of the axial one
    turn : (n_q,) makes the mean rotation
    """

    surface: SurfaceElements
    cos: FloatArray
    sin: FloatArray
    off: FloatArray
    radial: FloatArray
    axial: FloatArray
    turn: FloatArray

    @classmethod
    def of(cls, surface: SurfaceElements, points: FloatArray, centre: Point) -> "Cylinder":
        """Prepare the fit about the x-line through ``centre``; points : (n_nodes, 3) [m] undeformed coordinates."""
        area = surface.weights.ravel()
        along, *rest = (surface.at_points(points) - np.array(centre)).reshape(-1, 3).T
        across = np.column_stack(rest)
        radius = np.hypot(across[:, 0], across[:, 1])
        cos, sin = (across / radius[:, None]).T
        unit = np.ones_like(cos)
        basis = np.column_stack([unit, cos, sin, cos * cos - sin * sin, 2.0 * sin * cos])
        basis = np.hstack([basis, along[:, None] * basis[:, :3]])
        return cls(
            surface=surface,
            cos=cos,
            sin=sin,
            off=_radius(surface, points, centre) - radius,
            radial=_fit(basis, area),
            axial=_fit(np.column_stack([unit, along, cos, sin]), area),
            turn=area / radius / area.sum(),
        )

    def motion(self, displacement: FloatArray, strain: FloatArray) -> CylinderMotion:
        """Motion from the displacement of the nodes (n_nodes, 3) [m] and their free thermal strain (n_nodes,)."""
        moved = self.surface.at_points(displacement).reshape(-1, 3)
        outwards = moved[:, 1] * self.cos + moved[:, 2] * self.sin
        outwards += self.surface.at_points(strain).ravel() * self.off
        a0, a1, b1, a2, b2, _, tilt_y, tilt_z = (self.radial @ outwards).tolist()
        tangential = moved[:, 2] * self.cos - moved[:, 1] * self.sin
        return CylinderMotion(
            shift=(float(self.axial[0] @ moved[:, 0]), a1, b1),
            radius_expansion=a0,
            ovality=4.0 * float(np.hypot(a2, b2)),
            tilt=(tilt_y, tilt_z),
            turn=float(self.turn @ tangential),
        )


def _fit(basis: FloatArray, area: FloatArray) -> FloatArray:
    """(k, n) that makes the coefficients of a ``basis`` (n, k) from values (n,), least squares weighted by area."""
    root = np.sqrt(area)
    return np.asarray(np.linalg.pinv(basis * root[:, None]) * root)


def axial_range(surface: SurfaceElements, points: FloatArray) -> tuple[float, float]:
    """Least and greatest x of a surface [m]; points : (n_nodes, 3)."""
    x = points[surface.nodes, 0]
    return float(x.min()), float(x.max())


@dataclass(frozen=True, eq=False)
class CylinderSection:
    """Points round a cylinder in one cross-section, found once in its mesh and read for any displacement.

    nodes : (n, 6) of the facet that covers each point of the unrolled cylinder; shapes : (n, 6) functions there
    off : (n,) distance of the facet inside the cylinder [m]; cos, sin : (n,) of the angles, +y to +z
    """

    nodes: IndexArray
    shapes: FloatArray
    off: FloatArray
    cos: FloatArray
    sin: FloatArray

    @classmethod
    def of(
        cls, surface: SurfaceElements, points: FloatArray, centre: Point, angles: FloatArray, x: float
    ) -> "CylinderSection":
        """Find the points at ``angles`` (n,) [rad] in section ``x`` [m] of a cylinder about an axis along x."""
        corners = points[surface.facets[:, :3]] - np.array(centre)
        phi = np.arctan2(corners[:, :, 2], corners[:, :, 1])
        start = phi[:, :1]
        phi = start + np.remainder(phi - start + np.pi, 2.0 * np.pi) - np.pi
        middle = phi.mean(axis=1)
        turned = middle + np.remainder(angles[:, None] - middle + np.pi, 2.0 * np.pi) - np.pi
        radius = _radius(surface, points, centre)
        edge_1 = np.column_stack([radius * (phi[:, 1] - phi[:, 0]), corners[:, 1, 0] - corners[:, 0, 0]])
        edge_2 = np.column_stack([radius * (phi[:, 2] - phi[:, 0]), corners[:, 2, 0] - corners[:, 0, 0]])
        det = edge_1[:, 0] * edge_2[:, 1] - edge_1[:, 1] * edge_2[:, 0]
        to_1 = radius * (turned - phi[:, 0])
        to_2 = x - centre[0] - corners[:, 0, 0]
        xi = (to_1 * edge_2[:, 1] - to_2 * edge_2[:, 0]) / det
        eta = (to_2 * edge_1[:, 0] - to_1 * edge_1[:, 1]) / det
        best = np.argmax(np.minimum(np.minimum(xi, eta), 1.0 - xi - eta), axis=1)
        rows = np.arange(len(angles))
        shapes = TRIANGLE_6.values(np.column_stack([xi[rows, best], eta[rows, best]]))
        nodes = surface.facets[best]
        place = np.einsum("na,nai->ni", shapes, points[nodes] - np.array(centre))
        off = radius - np.hypot(place[:, 1], place[:, 2])
        return cls(nodes, shapes, off, np.cos(angles), np.sin(angles))

    def radial(self, displacement: FloatArray, strain: FloatArray) -> FloatArray:
        """Radial displacement (n,) [m] from that of the nodes (n_nodes, 3) [m] and their free strain (n_nodes,)."""
        moved = np.einsum("na,nai->ni", self.shapes, displacement[self.nodes])
        widened = np.einsum("na,na->n", self.shapes, strain[self.nodes]) * self.off
        return np.asarray(moved[:, 1] * self.cos + moved[:, 2] * self.sin + widened)


def _radius(surface: SurfaceElements, points: FloatArray, centre: Point) -> float:
    """Radius [m] of the cylinder: mean distance of its corner nodes from the axis."""
    corners = points[surface.facets[:, :3]] - np.array(centre)
    return float(np.hypot(corners[:, :, 1], corners[:, :, 2]).mean())


ROUND: FloatArray = np.linspace(0.0, 2.0 * np.pi, 72, endpoint=False)
"""(72,) angles round a seal or bore at which it is measured [rad], from +y towards +z."""


class ExpansionSetup:
    """Stiffness, supports and multigrid of a gearbox, made once and used for every temperature field.

    elastic : body -> (Young's modulus [Pa], Poisson's ratio, expansion coefficient [1/K])
    elements : share the spaces of a ConductionSetup on the same mesh
    Raises MeshError for a bad mesh and ElasticError for bad materials, stations that name unknown shafts,
    bodies or surfaces, a shaft without exactly one locating bearing, and loose pieces.
    """

    def __init__(
        self,
        model: GearboxModel,
        elastic: Mapping[str, tuple[float, float, float]],
        elements: FiniteElements | None = None,
    ) -> None:
        _check_stations(model)
        self.model = model
        self.elements = FiniteElements(model.mesh) if elements is None else elements
        self.locating = {s.name: _locating(model, s) for s in model.shafts}
        self.housing = self._piece_of(model.fixed_body)
        """Number of the piece that stands on the floor: the housing's, or that of a field under a foot joint."""
        self.standing = None if model.joint is None else self._piece_of(model.joint.body)
        """Number of the piece that stands on it in a foot joint."""
        self.piece = self._pieces()
        """Shaft name -> number of its piece."""
        self.elastic = ElasticSetup(self.elements, elastic, self._supports())
        self._sections: dict[tuple[str, Point, float], CylinderSection] = {}
        self._cylinders: dict[tuple[str, Point], Cylinder] = {}
        self._expansions: dict[str, float] = {}

    def cylinder(self, surface: str, centre: Point) -> Cylinder:
        """A cylindrical surface about ``centre``, its fit found once."""
        cylinder = self._cylinders.get((surface, centre))
        if cylinder is None:
            face, points = self.elements.surfaces[surface], self.model.mesh.points
            cylinder = self._cylinders[surface, centre] = Cylinder.of(face, points, centre)
        return cylinder

    def expansion_of(self, surface: str) -> float:
        """Expansion coefficient [1/K] of the body a surface bounds."""
        if surface not in self._expansions:
            facet = self.model.mesh.surfaces[surface][0, :3]
            cell = np.flatnonzero(np.isin(self.model.mesh.cells, facet).sum(axis=1) == 3)[0]
            body = next(name for name, cells in self.model.mesh.bodies.items() if cell in cells)
            self._expansions[surface] = self.elastic.elastic[body].expansion
        return self._expansions[surface]

    def section(self, surface: str, centre: Point, x: float) -> CylinderSection:
        """Cross-section ``x`` [m] of a cylindrical surface about ``centre``, at the angles `ROUND`."""
        section = self._sections.get((surface, centre, x))
        if section is None:
            face, points = self.elements.surfaces[surface], self.model.mesh.points
            section = self._sections[surface, centre, x] = CylinderSection.of(face, points, centre, ROUND, x)
        return section

    def _piece_of(self, body: str) -> int:
        pieces = np.unique(self.elements.components[self.model.mesh.bodies[body]])
        if len(pieces) > 1:
            raise ElasticError(f"body {body!r} falls into {len(pieces)} pieces; make them separate bodies")
        return int(pieces[0])

    def _pieces(self) -> dict[str, int]:
        """Shaft name -> piece; every piece must be the housing's, what stands on it, or one shaft's."""
        pieces = {shaft.name: self._piece_of(shaft.body) for shaft in self.model.shafts}
        owners = [self.housing, *([] if self.standing is None else [self.standing]), *pieces.values()]
        if len(set(owners)) < len(owners):
            raise ElasticError(
                "a shaft shares nodes with another shaft or the housing, or the two sides of a foot joint with each "
                "other; mesh them separately"
            )
        for body in self.model.mesh.bodies:
            if self._piece_of(body) not in owners:
                raise ElasticError(
                    f"body {body!r} shares no nodes with the housing or a shaft; join it to what carries it"
                )
        return pieces

    def _supports(self) -> BoolArray:
        joint = self.model.joint
        surfaces = [self.model.foot_surface, *(b.journal_surface for b in self.locating.values())]
        surfaces += [] if joint is None else [joint.foot_surface]
        fixed = np.zeros((len(self.model.mesh.points), 3), dtype=np.bool_)
        for name in surfaces:
            nodes = np.intersect1d(self.elements.surfaces[name].nodes, self.elements.corners)
            for node, directions in three_two_one(self.model.mesh.points, nodes.astype(np.int32)):
                fixed[node, list(directions)] = True
        return fixed


def _locating(model: GearboxModel, shaft: ShaftStation) -> BearingStation:
    bearings = [b for b in model.bearings if b.shaft == shaft.name and b.locating]
    if len(bearings) != 1:
        raise ElasticError(
            f"shaft {shaft.name!r} has {len(bearings)} locating bearings; it needs exactly one"
        )
    return bearings[0]


def _check_stations(model: GearboxModel) -> None:
    """Check that all names in the stations exist."""
    surfaces, bodies = model.mesh.surfaces, model.mesh.bodies
    shafts = {shaft.name for shaft in model.shafts}
    wanted = [("surface", model.foot_surface, surfaces), ("body", model.fixed_body, bodies)]
    if model.joint is not None:
        wanted += [("body", model.joint.body, bodies)]
        wanted += [
            ("surface", name, surfaces) for name in (model.joint.foot_surface, model.joint.seat_surface)
        ]
    for s in model.shafts:
        wanted += [("body", s.body, bodies)]
        wanted += [("surface", name, surfaces) for name in (s.start_surface, s.end_surface)]
    for b in model.bearings:
        wanted += [("surface", name, surfaces) for name in (b.bore_surface, b.journal_surface)]
    for seal in model.seals:
        wanted += [("surface", name, surfaces) for name in (seal.bore_surface, seal.shaft_surface)]
    for gear in model.gears:
        wanted += [("body", gear.body, bodies), ("surface", gear.rim_surface, surfaces)]
    for kind, name, known in wanted:
        if name not in known:
            raise ElasticError(f"a station names {kind} {name!r}, which the mesh does not have")
    named = [(b.name, b.shaft) for b in model.bearings]
    named += [(s.name, s.shaft) for s in model.seals] + [(g.name, g.shaft) for g in model.gears]
    for name, of_shaft in named:
        if of_shaft not in shafts:
            raise ElasticError(f"station {name!r} names shaft {of_shaft!r}, which does not exist")
