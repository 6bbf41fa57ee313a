"""Gear body with a few teeth in space: its transverse section drawn out over the face in layers of bricks.

A helical gear is turned from layer to layer. Positive z is the end of the face that comes into mesh last, for a gear
whose right flank drives; see `GearSegment.lead`.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.influence.gear_body import GearBody
from dynamics.influence.section import Section

Array = NDArray[np.float64]
IndexArray = NDArray[np.int32]

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
        held = np.flatnonzero((places >= -slack) & (places <= 1.0 + slack))
        return [(int(layer), float(np.clip(places[layer], 0.0, 1.0))) for layer in held]

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
