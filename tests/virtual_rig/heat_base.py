"""Clamping field under a housing: layers that thicken downwards, cells that widen outwards."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tests.virtual_rig.heat_network import OUTSIDE
from tests.virtual_rig.heat_parts import STEEL, Face, middle_of

if TYPE_CHECKING:
    from tests.virtual_rig.heat_box import Box


def add_field(box: "Box", inner_x: Sequence[float]) -> None:
    """Cells of the plate under the housing, joined to its floor where that stands.

    inner_x : lines under the box [m]
    """
    plate = box.house.get("field")
    floor = box.belt["floor"]
    fx, fy = box.lines.x, np.concatenate([[-box.width / 2], box.lines.y[1:-1], [box.width / 2]])
    if plate is None:
        return
    r = box.refine
    steel = STEEL[plate["material"]]
    inner_y = [-box.width / 2, -box.width / 4, 0.0, box.width / 4, box.width / 2]
    x = _apron(inner_x, box.length / 2.0, plate["length"], r)
    y = _apron(inner_y, 0.0, plate["width"], r)
    z = -plate["thickness"] * np.concatenate([[0.0], np.cumsum(np.array([0.2, 0.33, 0.47]))])
    z = -np.interp(np.linspace(0, 3, 3 * r + 1), np.arange(4), -z)
    dx, dy, dz = np.diff(x), np.diff(y), -np.diff(z)
    cells = np.empty((len(dx), len(dy), len(dz)), dtype=int)
    films = np.full(cells.shape[:2], -1)
    for i, j, k in np.ndindex(cells.shape):
        cells[i, j, k] = box.solid("field", dx[i] * dy[j] * dz[k], steel)
    for i, j, k in np.ndindex(cells.shape):
        here = cells[i, j, k]
        if i + 1 < len(dx):
            box.net.join(here, cells[i + 1, j, k], dx[i] / 2, dx[i + 1] / 2, dy[j] * dz[k])
        if j + 1 < len(dy):
            box.net.join(here, cells[i, j + 1, k], dy[j] / 2, dy[j + 1] / 2, dx[i] * dz[k])
        if k + 1 < len(dz):
            box.net.join(here, cells[i, j, k + 1], dz[k] / 2, dz[k + 1] / 2, dx[i] * dy[j])
        for edge, area, reach in (
            (i in (0, len(dx) - 1), dy[j] * dz[k], dx[i] / 2),
            (j in (0, len(dy) - 1), dx[i] * dz[k], dy[j] / 2),
        ):
            if edge:
                box.wet("field_sides", here, OUTSIDE, area, reach, "field_sides")
        if k == len(dz) - 1:
            box.wet("field_bottom", here, OUTSIDE, dx[i] * dy[j], dz[k] / 2, "field_bottom")
    for i, j in np.ndindex(cells.shape[:2]):
        covered = 0.0
        for a in range(floor.shape[0]):
            wide = _overlap(x[i], x[i + 1], fx[a], fx[a + 1])
            for b in range(floor.shape[1]) if wide > 0.0 else ():
                area = wide * _overlap(y[j], y[j + 1], fy[b], fy[b + 1])
                if area > 1e-12:
                    covered += area
                    box.net.join(floor[a, b], cells[i, j, 0], box.t["floor"] / 2, dz[0] / 2, area, "foot")
        free = dx[i] * dy[j] - covered
        if free > 1e-9:
            films[i, j] = box.wet("field_top", cells[i, j, 0], OUTSIDE, free, dz[0] / 2, "field_top")
    box.faces["field_top"] = Face((0, 1), 2, 0.0, middle_of(x), middle_of(y), films)


def _overlap(a: float, b: float, c: float, d: float) -> float:
    return max(0.0, min(b, d) - max(a, c))


def _apron(inner: Sequence[float], centre: float, total: float, refine: int) -> np.ndarray:
    """Lines of the field: those under the box and three widening steps to each edge."""
    low, high = centre - total / 2.0, centre + total / 2.0
    marks = np.array([0.0, 0.22, 0.55, 1.0])
    left = inner[0] + marks[:0:-1] * (low - inner[0])
    right = inner[-1] + marks[1:] * (high - inner[-1])
    lines = np.concatenate([left, inner, right])
    return np.interp(
        np.linspace(0, len(lines) - 1, (len(lines) - 1) * refine + 1), np.arange(len(lines)), lines
    )
