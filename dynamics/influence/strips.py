"""Loads on lines over the face of a segment, and what is read on them: rows that multiply the displacements.

A strip is drawn out over the face from a curve of the section. Between planes its sides are quadrilaterals of eight
nodes. A hat function over the face is 1 at a position and 0 at its neighbours, which lie in planes or within layers.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from dynamics.influence.segment import GearSegment, turned
from thermal.fe.reference_elements import QUAD_8

Array = NDArray[np.float64]
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
        found, width = [], 0.0
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
                found.append((position, self.nodes(element, layer), share * shape))
        return [(position, nodes, shares / width) for position, nodes, shares in found]


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
