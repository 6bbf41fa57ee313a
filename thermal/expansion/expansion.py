"""Thermal expansion of a gearbox: displacement field, rigid placement of the shafts, clearances.

Pieces that share no nodes are solved together but supported each for itself: the housing on its foot, every
shaft at its locating bearing. The housing is then placed so that its foot does not shift or turn on average
(in a foot joint the field is, and the foot follows its seat on average and slides on it without friction),
and every shaft as a rigid body so that its axis passes through the displaced centres of its bearing bores and
its locating journal sits axially in its bore. Bearing clearance and film position are not part of this: the
axis runs through the middle of the bores.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from thermal.expansion.alignment import (
    BearingExpansion,
    CentreDistance,
    GearExpansion,
    SealExpansion,
    ShaftAxis,
    ShaftExpansion,
    concentric_gap_change,
    free_expansion,
    length_mean,
    misalignment,
    roundness,
    shaft_axis,
)
from thermal.expansion.elastic import ElasticError, Known, rigid_motion
from thermal.expansion.setup import ROUND, CylinderMotion, ExpansionSetup, axial_range
from thermal.fe.mesh import FloatArray
from thermal.housing.stations import BearingStation, GearStation, Point, SealStation, ShaftStation

__all__ = ["Expansion", "ExpansionSetup", "expand"]


@dataclass(frozen=True, kw_only=True)
class Expansion:
    """Deformed geometry of a gearbox."""

    displacement: FloatArray
    """(n_nodes, 3) [m], relative to the foot, shafts placed in their bearings."""
    known: tuple[Known, ...]
    """Solutions from which that of a neighbouring temperature field starts."""
    bearings: dict[str, BearingExpansion]
    seals: dict[str, SealExpansion]
    shafts: dict[str, ShaftExpansion]
    gears: dict[str, GearExpansion]
    axes: dict[str, ShaftAxis]
    """Hot axis of every shaft, through its bearing bores."""
    centre_distances: tuple[CentreDistance, ...]
    """Every two gears of different shafts whose widths overlap."""
    largest_reaction: float
    """Of the statically determinate supports [N]; zero but for the tolerance of the solver."""
    iterations: int


def expand(
    setup: ExpansionSetup,
    temperature: FloatArray,
    reference_temperature: float,
    *,
    tolerance: float = 1e-8,
    start: Expansion | None = None,
) -> Expansion:
    """Expand a gearbox from ``reference_temperature`` [K], at which the model's dimensions hold.

    setup : gearbox and materials; temperature : (n_nodes,) [K]
    tolerance : of the linear solve's residual
    start : expansion under a neighbouring temperature field, which saves iterations

    Raises ElasticError (a ValueError) for input that cannot be computed, NotConverged (a RuntimeError with
    its residuals) if the linear solve stalls.
    """
    n_nodes = len(setup.model.mesh.points)
    if temperature.shape != (n_nodes,) or not np.isfinite(temperature).all():
        raise ElasticError(
            f"temperature of shape {temperature.shape}: need one finite value per node, ({n_nodes},)"
        )
    solution = setup.elastic.solve(
        temperature, reference_temperature, tolerance, () if start is None else start.known
    )
    return read_expansion(
        setup,
        temperature,
        reference_temperature,
        solution.values,
        largest_reaction=float(np.abs(solution.reactions).max()),
        known=solution.known,
        iterations=solution.iterations,
    )


def read_expansion(
    setup: ExpansionSetup,
    temperature: FloatArray,
    reference_temperature: float,
    supported: FloatArray,
    *,
    largest_reaction: float = 0.0,
    known: tuple[Known, ...] = (),
    iterations: int = 0,
) -> Expansion:
    """Place the shafts and read every clearance from a displacement on the supports of the solve.

    temperature : (n_nodes,) [K]; supported : (n_nodes, 3) [m], of this temperature
    """
    model = setup.model
    shape = DeformedGeometry(setup, temperature, reference_temperature, supported)
    return Expansion(
        displacement=shape.displacement,
        known=known,
        bearings={b.name: shape.bearing(b) for b in model.bearings},
        seals={s.name: shape.seal(s) for s in model.seals},
        shafts={s.name: shape.shaft(s) for s in model.shafts},
        gears={g.name: shape.gear(g) for g in model.gears},
        axes=shape.axes,
        centre_distances=shape.centre_distances(),
        largest_reaction=largest_reaction,
        iterations=iterations,
    )


# Deformed geometries of many temperature fields for the price of a few solves.
#
# Displacement is linear in temperature. The fields of a time run differ by few patterns: the leading ones are
# found from the fields themselves, each is expanded once, and the expansion under any field is their sum. What the
# patterns miss of a temperature is measured and kept below a limit.
# Source of the patterns (snapshots): Sirovich, Quart. Appl. Math. 45 (1987) 561.

MISSED = 0.5
"""Greatest temperature [K] that the patterns may miss at any node: 0.6 um on 100 mm of steel, were it everywhere."""

LEAST_SHARE = 1e-14
"""Patterns below this share of the strongest are rounding."""


@dataclass(frozen=True, eq=False)
class ExpansionBasis:
    """Patterns of temperature rise with their displacements.

    patterns : (k, n_nodes) [K], orthonormal; displacements : (k, n_nodes, 3) [m]
    """

    setup: ExpansionSetup
    reference: float
    patterns: FloatArray
    displacements: FloatArray
    missed: float
    """Greatest rise of the fields that the patterns do not hold [K]."""

    @classmethod
    def of(
        cls,
        setup: ExpansionSetup,
        reference: float,
        fields: Sequence[FloatArray],
        *,
        missed: float = MISSED,
        tolerance: float = 1e-5,
    ) -> "ExpansionBasis":
        """Find the patterns of ``fields`` (n_nodes,) [K] and expand them from ``reference`` [K].

        missed : limit of what they may miss [K]; tolerance : of the linear solves
        Raises ElasticError without a field, NotConverged if a solve stalls.
        """
        if not fields:
            raise ElasticError("no temperature field to expand; give at least one")
        rises = np.array([field - reference for field in fields])
        patterns, left = _patterns(rises, missed)
        shapes = [setup.elastic.solve(reference + p, reference, tolerance).values for p in patterns]
        return cls(setup, reference, patterns, np.array(shapes).reshape(*patterns.shape, 3), left)

    def shape(self, temperature: FloatArray) -> Expansion:
        """Expansion under a field (n_nodes,) [K] among or between those the basis was made of."""
        shares = self.patterns @ (temperature - self.reference)
        supported = np.tensordot(shares, self.displacements, axes=1)
        return read_expansion(self.setup, temperature, self.reference, supported)


def _patterns(rises: FloatArray, limit: float) -> tuple[FloatArray, float]:
    """Orthonormal patterns (k, n) of ``rises`` (m, n) and the greatest rise they miss."""
    sizes, turns = np.linalg.eigh(rises @ rises.T)
    order = np.argsort(sizes)[::-1]
    usable = [i for i in order if sizes[i] > LEAST_SHARE * max(float(sizes[order[0]]), 1e-300)]
    patterns = np.empty((0, rises.shape[1]))
    left = rises.copy()
    for i in usable:
        if np.abs(left).max(initial=0.0) <= limit:
            break
        pattern = turns[:, i] @ rises
        for _ in range(2):
            pattern = pattern - (patterns @ pattern) @ patterns
        pattern /= np.linalg.norm(pattern)
        patterns = np.vstack([patterns, pattern])
        left -= np.outer(left @ pattern, pattern)
    return patterns, float(np.abs(left).max(initial=0.0))


# The hot gearbox: shafts placed in their bearings, clearances read from the displacement field.


class DeformedGeometry:
    """Places the shafts and reads clearances from one displacement field."""

    def __init__(
        self, setup: ExpansionSetup, temperature: FloatArray, reference: float, displacement: FloatArray
    ) -> None:
        self.setup = setup
        self.model = setup.model
        self.points = setup.model.mesh.points
        self.surfaces = setup.elements.surfaces
        self.temperature = temperature
        self.reference = reference
        self.strain = setup.elastic.free_strain(temperature, reference)
        self.displacement = displacement.copy()
        self._place_housing()
        self.bores = {b.name: self._motion(b.bore_surface, b.centre) for b in self.model.bearings}
        self.axes = {shaft.name: self._axis(shaft.name) for shaft in self.model.shafts}
        for shaft in self.model.shafts:
            self._place_shaft(shaft)

    def _motion(self, surface: str, centre: Point) -> CylinderMotion:
        return self.setup.cylinder(surface, centre).motion(self.displacement, self.strain)

    def _place_housing(self) -> None:
        """Take out the mean shift and rotation of the foot; what stands in a foot joint follows its seat."""
        centre, shift, rotation = self._rigid(self.model.foot_surface)
        self._move(self.setup.housing, centre, -shift, -rotation)
        joint, standing = self.model.joint, self.setup.standing
        if joint is not None and standing is not None:
            _, shift, rotation = self._rigid(joint.foot_surface)
            centre, to, turn = self._rigid(joint.seat_surface)
            self._move(standing, centre, to - shift, turn - rotation)

    def _rigid(self, surface: str) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Centre, mean shift [m] and rotation [rad] of a surface."""
        face = self.surfaces[surface]
        places = face.at_points(self.points).reshape(-1, 3)
        moved = face.at_points(self.displacement).reshape(-1, 3)
        return rigid_motion(places, moved, face.weights.ravel())

    def _move(self, piece: int, centre: FloatArray, shift: FloatArray, rotation: FloatArray) -> None:
        """Add a small rigid motion about ``centre`` to one piece."""
        nodes = np.flatnonzero(self.setup.elements.piece_of_node == piece)
        self.displacement[nodes] += shift + np.cross(rotation, self.points[nodes] - centre)

    def _bearings(self, shaft: str) -> list[BearingStation]:
        return [b for b in self.model.bearings if b.shaft == shaft]

    def _place_shaft(self, shaft: ShaftStation) -> None:
        """Move a shaft and what shares its nodes until its axis passes through its bore centres."""
        locating = self.setup.locating[shaft.name]
        bearings = self._bearings(shaft.name)
        gaps, turn = [], 0.0
        for bearing in bearings:
            journal = self._motion(bearing.journal_surface, bearing.centre)
            gaps.append(np.subtract(self.bores[bearing.name].shift, journal.shift))
            if bearing is locating:
                turn = journal.turn
        gap = shaft_axis(
            shaft.name, [b.centre[0] for b in bearings], [(float(y), float(z)) for _, y, z in gaps]
        )
        shift = np.array([gaps[bearings.index(locating)][0], *gap.shift(locating.centre[0])])
        rotation = np.array([-turn, -gap.slope[1], gap.slope[0]])
        self._move(self.setup.piece[shaft.name], np.array(locating.centre), shift, rotation)

    def bearing(self, station: BearingStation) -> BearingExpansion:
        """Read one bearing."""
        bore = self.bores[station.name]
        journal = self._motion(station.journal_surface, station.centre)
        first, last = axial_range(self.surfaces[station.bore_surface], self.points)
        places = (first, 0.5 * (first + last), last)
        return BearingExpansion(
            name=station.name,
            bore_shift=bore.shift,
            bore_expansion=2.0 * bore.radius_expansion,
            bore_ovality=bore.ovality,
            bore_roundness=roundness(ROUND, self._radial(station.bore_surface, station.centre, *places)),
            bore_tilt=bore.tilt,
            misalignment=misalignment(self.axes[station.shaft], bore.tilt),
            journal_expansion=2.0 * journal.radius_expansion,
        )

    def _radial(self, surface: str, centre: Point, *places: float) -> FloatArray:
        """(len(places), n) radial displacement [m] of a cylinder at the angles `ROUND` in sections x [m]."""
        sections = (self.setup.section(surface, centre, x) for x in places)
        return np.array([section.radial(self.displacement, self.strain) for section in sections])

    def seal(self, station: SealStation) -> SealExpansion:
        """Read one seal: bore minus shaft at fixed angles in three sections."""
        bore, shaft = self.surfaces[station.bore_surface], self.surfaces[station.shaft_surface]
        ranges = np.array([axial_range(bore, self.points), axial_range(shaft, self.points)])
        first, last = float(ranges[:, 0].max()), float(ranges[:, 1].min())
        if last <= first:
            raise ElasticError(
                f"seal {station.name!r}: bore and shaft surface do not face each other along x"
            )
        places = (first, 0.5 * (first + last), last)
        gaps = (
            station.radial_gap
            + self._radial(station.bore_surface, station.centre, *places)
            - self._radial(station.shaft_surface, station.centre, *places)
        )
        axial = (
            self._motion(station.shaft_surface, station.centre).shift[0]
            - self._motion(station.bore_surface, station.centre).shift[0]
        )
        by_hand = concentric_gap_change(
            0.5 * station.shaft_diameter,
            (self.setup.expansion_of(station.bore_surface), bore.mean(self.temperature)),
            (self.setup.expansion_of(station.shaft_surface), shaft.mean(self.temperature)),
            self.reference,
        )
        return SealExpansion(
            name=station.name,
            undeformed_gap=station.radial_gap,
            angles=ROUND,
            gaps=gaps,
            axial_shift=axial,
            gap_by_hand=station.radial_gap + by_hand,
        )

    def shaft(self, station: ShaftStation) -> ShaftExpansion:
        """Read the lengthening of one shaft."""
        locating = self.setup.locating[station.name]
        datum = self._motion(locating.journal_surface, locating.centre).shift[0]
        others = [b for b in self._bearings(station.name) if b is not locating]
        shaft = housing = 0.0
        if others:
            far = max(others, key=lambda b: abs(b.centre[0] - locating.centre[0]))
            sign = np.sign(far.centre[0] - locating.centre[0])
            shaft = float(sign * (self._motion(far.journal_surface, far.centre).shift[0] - datum))
            housing = float(sign * (self.bores[far.name].shift[0] - self.bores[locating.name].shift[0]))
        alpha = self.setup.elastic.elastic[station.body].expansion
        by_hand = []
        for end in (station.start, station.end):
            mean = length_mean(self.setup.elements, self.temperature, station.body, locating.centre[0], end)
            by_hand.append(free_expansion(alpha, abs(end - locating.centre[0]), mean, self.reference))
        return ShaftExpansion(
            name=station.name,
            start=datum - self._axial(station.start_surface),
            end=self._axial(station.end_surface) - datum,
            datum=datum,
            start_by_hand=by_hand[0],
            end_by_hand=by_hand[1],
            between_bearings=shaft,
            housing_between_bearings=housing,
        )

    def gear(self, station: GearStation) -> GearExpansion:
        """Read one gear body."""
        return GearExpansion(
            name=station.name,
            bulk_temperature=self.setup.elements.body_mean(self.temperature, station.body),
            rim_expansion=self._motion(station.rim_surface, station.centre).radius_expansion,
        )

    def centre_distances(self) -> tuple[CentreDistance, ...]:
        """Read the axes of all pairs of gears that face each other."""
        distances = []
        for a, b in combinations(self.model.gears, 2):
            overlap = 0.5 * (a.face_width + b.face_width) - abs(a.centre[0] - b.centre[0])
            if a.shaft != b.shaft and overlap > 0.0:
                distances.append(self._centre_distance(a, b))
        return tuple(distances)

    def _centre_distance(self, a: GearStation, b: GearStation) -> CentreDistance:
        plane = 0.5 * (a.centre[0] + b.centre[0])
        axis_a, axis_b = self.axes[a.shaft], self.axes[b.shaft]
        undeformed = np.subtract(b.centre, a.centre)[1:]
        distance = float(np.hypot(*undeformed))
        along = undeformed / distance
        opening = np.subtract(axis_b.slope, axis_a.slope)
        apart = np.subtract(axis_b.shift(plane), axis_a.shift(plane))
        return CentreDistance(
            gear_a=a.name,
            gear_b=b.name,
            undeformed=distance,
            hot=float(np.hypot(*(undeformed + apart))),
            inclination=float(opening @ along),
            skew=float(along[0] * opening[1] - along[1] * opening[0]),
        )

    def _axis(self, shaft: str) -> ShaftAxis:
        """Hot axis of a shaft, from its bore centres."""
        bearings = self._bearings(shaft)
        shifts = [self.bores[b.name].shift for b in bearings]
        return shaft_axis(shaft, [b.centre[0] for b in bearings], [(y, z) for _, y, z in shifts])

    def _axial(self, surface: str) -> float:
        return self.surfaces[surface].mean(self.displacement[:, 0])
