"""Stiffness, supports and measuring points of a gearbox, made once for all its temperature fields."""

from collections.abc import Mapping

import numpy as np

from thermal.expansion.cylinders import Cylinder, CylinderSection
from thermal.expansion.elastic import ElasticError, ElasticSetup, three_two_one
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import FloatArray
from thermal.fe.solver import BoolArray
from thermal.housing.stations import BearingStation, GearboxModel, Point, ShaftStation

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
        found = self._cylinders.get((surface, centre))
        if found is None:
            face, points = self.elements.surfaces[surface], self.model.mesh.points
            found = self._cylinders[surface, centre] = Cylinder.of(face, points, centre)
        return found

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
        found = self._sections.get((surface, centre, x))
        if found is None:
            face, points = self.elements.surfaces[surface], self.model.mesh.points
            found = self._sections[surface, centre, x] = CylinderSection.of(face, points, centre, ROUND, x)
        return found

    def _piece_of(self, body: str) -> int:
        found = np.unique(self.elements.components[self.model.mesh.bodies[body]])
        if len(found) > 1:
            raise ElasticError(f"body {body!r} falls into {len(found)} pieces; make them separate bodies")
        return int(found[0])

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
    found = [b for b in model.bearings if b.shaft == shaft.name and b.locating]
    if len(found) != 1:
        raise ElasticError(f"shaft {shaft.name!r} has {len(found)} locating bearings; it needs exactly one")
    return found[0]


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
