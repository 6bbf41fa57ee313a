"""Influence numbers of a gear from a finite-element model of its body with three teeth.

Normal forces on hat functions over the face load the flank of the middle tooth, profile position by profile position;
one factor of the stiffness serves them all. Displacements are read on the tooth axis under the points of the flank:
what lies between is the local approach, which the contact adds analytically (Weber, and `local_excess`).
Source: gears.md e; Weber, Banaschek, Formaenderung und Profilruecknahme, 1953; hat functions as in Vedmar 1981.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import atan, cos, pi, sin
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from dynamics.tooth.elastic_segment import Elastic, GearModel, solve_segment
from dynamics.tooth.influence_numbers import TEETH, InfluenceNumbers, RootFillet, SectionDivision
from dynamics.tooth.segment import GearSegment, gear_section, turned
from thermal.fe.reference_elements import QUAD_8

Array = NDArray[np.float64]


SIDES = (1, -1)
OFFSETS = range(-3, 4)
"""Teeth whose displacement is read; those beyond the neighbours are carried by the body."""


def influence_numbers(model: GearModel) -> InfluenceNumbers:
    """Influence numbers of a gear whose face at positive z comes into mesh last as a driven gear on its right flank.

    Those of a driving gear are `InfluenceNumbers.reversed_face`.

    Raises DynamicsInputError for a body that leaves nothing under the teeth; OSError or ImportError without gmsh.
    """
    section = gear_section(model.form, model.body, model.division)
    segment = GearSegment.of(section, model.face, model.lead, model.body)
    reading = SegmentReading(model, segment)
    size = 3 * len(segment.points)
    moved = solve_segment(segment, model.material, rows(reading.loads(), size), model.plane_strain)
    raw = {k: rows(reading.axis(k) if k in TEETH else reading.carried(k), size) @ moved for k in OFFSETS}
    deflection = {k: 0.5 * (raw[k] + raw[-k].T) for k in OFFSETS}
    scale = float(np.abs(raw[0]).max())
    young, poisson = model.material.young, model.material.poisson
    return InfluenceNumbers(
        profile=reading.rolls,
        face=model.face,
        axis_depth=model.form.axis_depth(reading.rolls),
        local_excess=local_excess(model, reading.rolls),
        deflection=deflection,
        body=rows(reading.carried(0), size) @ moved,
        fillet=reading.fillet,
        stress={
            (k, side): young / (1.0 - poisson**2) * (rows(reading.root(k, side), size) @ moved)
            for k in TEETH
            for side in SIDES
        },
        asymmetry=max(float(np.abs(raw[k] - raw[-k].T).max()) for k in OFFSETS) / scale,
        n_nodes=len(segment.points),
    )


# What a tooth gives under a contact beyond the half space: its local part on a fine slice.
#
# Between the flank and the tooth axis a tooth is softer than a half space: its other flank is free, it tapers, its tip
# is near. The addition to Weber's logarithm is read as the difference of the displacements of flank and axis, at a
# distance from a line load that is small against the depth and spans some elements, less the same difference of the
# half space (Flamant). It is about 0.6, 3 to 4 % of the approach of a pair, and grows towards a tip edge. Source of the
# half space: Johnson, Contact Mechanics, 2.2; addition: loaded contact in CalculiX agrees with it.


FINE = SectionDivision(profile=40, thickness=10, fillet=12, depth=2, grading=0.85, neighbours=(2, 2, 4))
APART = 2
"""Elements between load and reading."""


def local_excess(model: GearModel, rolls: Array) -> Array:
    """Addition to 2 ln(2 h / a) - nu / (1 - nu) of a flank at roll lengths (n,) [-].

    h : distance to the tooth axis, a : half width of the contact; the local approach is (1 - nu^2) F' / (pi E) times it
    """
    nu = model.material.poisson
    fine = replace(
        model, material=Elastic(young=1.0, poisson=nu), face_width=1.0, division=FINE, plane_strain=True
    )
    segment = GearSegment.of(gear_section(fine.form, fine.body, fine.division), fine.face)
    reading = SegmentReading(fine, segment)
    size = 3 * len(segment.points)
    loads = rows(reading.loads(), size)
    moved = solve_segment(segment, fine.material, loads, plane_strain=True)
    local = _even(loads @ moved) - _even(rows(reading.axis(0), size) @ moved)
    points, depth = fine.form.flank_point(reading.rolls), fine.form.axis_depth(reading.rolls)
    n = len(reading.rolls)
    excess = np.zeros(n)
    for load in range(n):
        places = [place for place in (load - APART, load + APART) if 0 <= place < n]
        apart = [
            np.pi / (1.0 - nu**2) * local[place, load]
            - _half_space(float(np.hypot(*(points[place] - points[load]))), float(depth[place]), nu)
            for place in places
        ]
        excess[load] = np.mean(apart)
    return np.asarray(np.interp(rolls, reading.rolls, excess))


def _even(block: Array) -> Array:
    """Mean over the two faces of the slice under a load on both."""
    n = len(block) // 2
    return np.asarray(np.asarray(block).reshape(n, 2, n, 2).mean(axis=(1, 3)))


def _half_space(distance: float, depth: float, nu: float) -> float:
    """Displacement at a distance from a line load less that at a depth below, over (1 - nu^2) F' / (pi E)."""
    squared = distance**2 + depth**2
    surface = -2.0 * np.log(distance) - 1.0 / (1.0 - nu)
    below = -np.log(squared) - (1.0 - depth**2 / squared) / (1.0 - nu)
    return float(surface - below)


# Loads on the flank of a gear segment and what is read of it, as rows that multiply its displacements.

# Loads on lines over the face of a segment, and what is read on them: rows that multiply the displacements.
#
# A strip is drawn out over the face from a curve of the section. Between planes its sides are quadrilaterals of eight
# nodes. A hat function over the face is 1 at a position and 0 at its neighbours, which lie in planes or within layers.

IndexArray = NDArray[np.int32]

GAUSS = (0.5 - np.sqrt(0.15), 0.5, 0.5 + np.sqrt(0.15))
"""Three points of Gauss between 0 and 1 and their weights."""
GAUSS_WEIGHTS = (5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0)
BEST = (0.5 - 0.5 / np.sqrt(3.0), 0.5 + 0.5 / np.sqrt(3.0))
"""Where the strain along a side of three nodes is most accurate, from 0 to 1."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Strip:
    """Strip over a curve of the section.

    curve : nodes of the section along it, corners and middles in turn
    face : (n_face,) positions of the hat functions over the face [m]
    """

    segment: GearSegment
    curve: IndexArray
    face: Array

    @property
    def n_elements(self) -> int:
        """Elements along the curve."""
        return len(self.curve) // 2

    @cached_property
    def points(self) -> Array:
        """(n, 2) points of the curve in the section [m]."""
        return self.segment.section.points[self.curve]

    def at(self, element: int, along: float | Array) -> Array:
        """Points (..., 2) in the section at places (...,) along an element, 0 to 1 [m]."""
        place = np.asarray(along)
        shape = np.stack(
            [(1.0 - place) * (1.0 - 2.0 * place), 4.0 * place * (1.0 - place), place * (2.0 * place - 1.0)],
            axis=-1,
        )
        return np.asarray(shape @ self.points[2 * element : 2 * element + 3])

    def nodes(self, element: int, layer: int) -> IndexArray:
        """(8,) nodes of a side: first coordinate along the curve, second over the face."""
        first, middle, last = self.curve[2 * element : 2 * element + 3]
        low, high, between = (
            self.segment.planes[layer],
            self.segment.planes[layer + 1],
            self.segment.middles[layer],
        )
        corners = [low[first], low[last], high[last], high[first]]
        return np.array([*corners, low[middle], between[last], high[middle], between[first]])

    def shares(self, element: int, along: float, hat: int) -> list[tuple[float, IndexArray, Array]]:
        """Quadrature of a place on the curve under a hat: position over the face [m], nodes and shares.

        The shares sum to one over the list.
        """
        quadrature, width = [], 0.0
        for first, rising in ((hat - 1, True), (hat, False)):
            if not 0 <= first < len(self.face) - 1:
                continue
            low, high = self.face[first], self.face[first + 1]
            width += 0.5 * (high - low)
            for part, weight in zip(GAUSS, GAUSS_WEIGHTS, strict=True):
                position = low + part * (high - low)
                layer, across = self.segment.layers_at(position)[0]
                shape = QUAD_8.values(np.array([[along, across]]))[0]
                share = weight * (high - low) * (part if rising else 1.0 - part)
                quadrature.append((position, self.nodes(element, layer), share * shape))
        return [(position, nodes, shares / width) for position, nodes, shares in quadrature]


Entry = tuple[IndexArray, Array]
"""Unknowns (n,) and their weights in one row."""


def displacement_row(strip: Strip, place: tuple[int, float], hat: int, normal: Array) -> Entry:
    """Row of the displacement along a normal under a hat, or the load of a unit force along it.

    place : element along the curve and position in it, 0 to 1
    normal : (3,) in the section [-]; it turns with the helix
    """
    unknowns, weights = [], []
    for position, nodes, shares in strip.shares(*place, hat):
        turn = np.array([strip.segment.lead * position])
        direction = np.append(turned(normal[None, :2], turn)[0], normal[2])
        unknowns.append((3 * nodes[:, None] + np.arange(3)).ravel())
        weights.append((shares[:, None] * direction).ravel())
    return np.concatenate(unknowns), np.concatenate(weights)


def stress_row(
    strip: Strip, place: tuple[int, float], position: float, poisson: float, *, free_ends: bool
) -> Entry:
    """Row of the stress across the tooth at the free surface, over E / (1 - nu^2), at a position over the face [m].

    Plane stress in the surface: strain across the helix line plus nu times strain along it, in a plane the mean of both
    layers that meet there. On free ends of the face there is no stress along the helix line, which leaves E times the
    strain across.
    """
    element, along = place
    layers = strip.segment.layers_at(position)
    at_end = free_ends and position in (strip.face[0], strip.face[-1])
    unknowns, weights = [], []
    for layer, across in layers:
        nodes = strip.nodes(element, layer)
        slopes = QUAD_8.gradients(np.array([[along, across]]))[0]  # (8, 2)
        points = strip.segment.points[nodes]
        by_curve, by_face = slopes.T @ points  # (3,) each
        helix = by_face / np.linalg.norm(by_face)
        part = by_curve @ helix
        rest = by_curve - part * helix
        size = np.linalg.norm(rest)
        tangent = rest / size
        along_helix = slopes[:, 1] / np.linalg.norm(by_face)
        along_tangent = (slopes[:, 0] - part * along_helix) / size
        row = (1.0 - poisson**2 if at_end else 1.0) * along_tangent[:, None] * tangent
        if not at_end:
            row = row + poisson * along_helix[:, None] * helix
        unknowns.append((3 * nodes[:, None] + np.arange(3)).ravel())
        weights.append(row.ravel() / len(layers))
    return np.concatenate(unknowns), np.concatenate(weights)


def rows(entries: Sequence[Entry], n_unknowns: int) -> sparse.csr_array:
    """(n, n_unknowns) matrix of rows."""
    counts = [len(unknowns) for unknowns, _ in entries]
    row = np.repeat(np.arange(len(entries)), counts)
    column = np.concatenate([unknowns for unknowns, _ in entries])
    weight = np.concatenate([weights for _, weights in entries])
    return sparse.csr_array(sparse.coo_array((weight, (row, column)), shape=(len(entries), n_unknowns)))


Place = TypeVar("Place")


class SegmentReading:
    """Rows of loads and readings of a segment.

    rolls : (n_p,) roll lengths of the loaded places of the right flank of tooth 0, from fillet to tip [m]
    """

    def __init__(self, model: GearModel, segment: GearSegment) -> None:
        self._form, self._poisson, self._segment = model.form, model.material.poisson, segment
        gear = model.form.gear
        self._pitch = 2.0 * pi / gear.teeth
        self._slope = atan(model.lead * gear.base_radius)
        section = segment.section
        corners = section.points[section.flanks[0]][::2]
        self.rolls = np.array([gear.roll_length(radius) for radius in np.hypot(*corners.T).tolist()])
        self._face, self._free_ends = model.face, not model.plane_strain
        self._hats = range(len(model.face))
        self._positions = model.face.tolist()

    def _strip(self, curves: Mapping[Place, IndexArray], key: Place) -> Strip:
        return Strip(segment=self._segment, curve=curves[key], face=self._face)

    def _inwards(self, roll: float, tooth: int) -> Array:
        """(3,) normal of the right flank of a tooth into it, at mid-face."""
        normal = turned(self._form.flank_normal(roll)[None, :], np.array([tooth * self._pitch]))[0]
        return -np.append(cos(self._slope) * normal, -sin(self._slope))

    def loads(self) -> list[Entry]:
        """Unit normal forces on the flank of tooth 0."""
        flank = self._strip(self._segment.section.flanks, 0)
        entries = []
        for number, roll in enumerate(self.rolls.tolist()):
            place = (number, 0.0) if number < flank.n_elements else (number - 1, 1.0)
            entries += [displacement_row(flank, place, hat, self._inwards(roll, 0)) for hat in self._hats]
        return entries

    def axis(self, tooth: int) -> list[Entry]:
        """Displacement of a tooth on its axis under the points of its right flank, along their normals."""
        axis = self._strip(self._segment.section.axes, tooth)
        height = np.hypot(*axis.points.T)
        entries = []
        for roll in self.rolls.tolist():
            place = _element_at(height, float(self._form.axis_point(roll)[1]))
            entries += [displacement_row(axis, place, hat, self._inwards(roll, tooth)) for hat in self._hats]
        return entries

    def carried(self, tooth: int) -> list[Entry]:
        """Displacement of a tooth at the points of its right flank if it moved with its foot as a rigid body.

        The foot moves as the ground of the tooth spaces on either side of it.
        """
        ends = [self._ground(tooth + 0.5), self._ground(tooth - 0.5)]
        right, left = (strip.at(*place) for strip, place in ends)
        chord = right - left
        across = chord / np.linalg.norm(chord)
        upwards = np.array([-across[1], across[0]])
        middle = 0.5 * (right + left)
        entries = []
        for roll in self.rolls.tolist():
            normal = self._inwards(roll, tooth)
            point = self._form.axis_point(roll)
            arm = turned(point[None, :], np.array([tooth * self._pitch]))[0] - middle
            # the foot turns clockwise by the difference of its ends over its length
            lever = (normal[0] * arm[1] - normal[1] * arm[0]) / np.linalg.norm(chord)
            turning = lever * np.append(upwards, 0.0)
            entries += [
                _joined(
                    displacement_row(*ends[0], hat, 0.5 * normal - turning),
                    displacement_row(*ends[1], hat, 0.5 * normal + turning),
                )
                for hat in self._hats
            ]
        return entries

    def _ground(self, place: float) -> tuple[Strip, tuple[int, float]]:
        """Middle of the tooth space at ``place`` pitches, and where it lies on a strip."""
        side = 1 if place > 0.0 else -1
        drawn = TEETH[-1]
        if abs(place) <= drawn:
            return self._strip(self._segment.section.fillets, (round(place - 0.5 * side), side)), (0, 0.0)
        strip = self._strip(self._segment.section.rims, side)
        angle = np.unwrap(np.abs(np.arctan2(*strip.points.T)))
        return strip, _element_at(angle, min(abs(place) * self._pitch, pi))

    # -- root ---------------------------------------------------------------------------------------------------
    def _stress(self, strip: Strip, place: tuple[int, float], position: float) -> Entry:
        return stress_row(strip, place, position, self._poisson, free_ends=self._free_ends)

    def root(self, tooth: int, side: int) -> list[Entry]:
        """Stress at the points of a fillet over the face; that of a neighbour between its own points."""
        strip = self._strip(self._segment.section.fillets, (tooth, side))
        points = [
            [self._stress(strip, place, position) for position in self._positions]
            for place in _stress_points(strip.n_elements)
        ]
        if tooth == 0:
            return [entry for place in points for entry in place]
        arcs = _arcs(strip)[1]
        entries = []
        for arc in self.fillet.arc.tolist():
            upper = int(np.clip(np.searchsorted(arcs, arc), 1, len(arcs) - 1))
            share = float(np.clip((arc - arcs[upper - 1]) / (arcs[upper] - arcs[upper - 1]), 0.0, 1.0))
            entries += [_mixed(pair, share) for pair in zip(points[upper - 1], points[upper], strict=True)]
        return entries

    @cached_property
    def fillet(self) -> RootFillet:
        """Root points of tooth 0 under its loaded flank."""
        strip = self._strip(self._segment.section.fillets, (0, 1))
        points, arcs, tangents = _arcs(strip)
        return RootFillet(point=points, arc=arcs, tangent=tangents)


def _stress_points(n_elements: int) -> list[tuple[int, float]]:
    return [(element, along) for element in range(n_elements) for along in BEST]


def _arcs(strip: Strip) -> tuple[Array, Array, Array]:
    """Points (n, 2), arc lengths (n,) and angles (n,) against the tooth axis of the stress points of a fillet."""
    fine = np.linspace(0.0, 1.0, 65)
    points, arcs, tangents, start = [], [], [], 0.0
    for element in range(strip.n_elements):
        course = strip.at(element, fine)
        length = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(course, axis=0).T))])
        angle = np.abs(np.arctan2(*np.gradient(course, axis=0).T))
        for along in BEST:
            points.append([np.interp(along, fine, course[:, k]) for k in (0, 1)])
            arcs.append(start + np.interp(along, fine, length))
            tangents.append(np.interp(along, fine, angle))
        start += length[-1]
    return np.array(points), np.array(arcs), np.array(tangents)


def _mixed(pair: tuple[Entry, Entry], share: float) -> Entry:
    (low, low_weight), (high, high_weight) = pair
    return _joined((low, (1.0 - share) * low_weight), (high, share * high_weight))


def _joined(first: Entry, second: Entry) -> Entry:
    return np.concatenate([first[0], second[0]]), np.concatenate([first[1], second[1]])


def _element_at(height: Array, wanted: float) -> tuple[int, float]:
    """Element of a straight curve with corners and middles at growing ``height`` and the place in it, 0 to 1."""
    corners = height[::2]
    element = int(np.clip(np.searchsorted(corners, wanted) - 1, 0, len(corners) - 2))
    share = (wanted - corners[element]) / (corners[element + 1] - corners[element])
    return element, float(np.clip(share, 0.0, 1.0))
