"""Cells of a gearbox with housing: plates, patches round the holes, shafts and gears, clamping field, oil.

x along the shafts from the front face, y across from the middle, z up from the foot. A plate is one cell thick; its
surface temperature follows from the heat through half of it. ``refine`` divides every cell edge.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from tests.virtual_rig.heat_base import add_field
from tests.virtual_rig.heat_network import OUTSIDE, Network
from tests.virtual_rig.heat_parts import OIL_FILM, SIDES, STEEL, Face, middle_of
from tests.virtual_rig.heat_rotors import Zone, add_shaft, cold_zones


@dataclass(frozen=True)
class Lines:
    """Grid lines of the box."""

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    parts: dict[str, tuple[int, int]]
    """First and last interval of x by part."""
    half: float
    """Half side of the squares round the shafts."""
    squares: dict[str, tuple[int, int]]
    """First interval of y and of z of each shaft's square."""


class Box:
    """Network of one gearbox, with the numbers of its cells and films by meaning."""

    plates = ("end_front", "partition_front", "partition_rear", "end_rear")
    square = 0.32
    """Half side of the squares round the shafts over the least distance of two."""

    def __init__(self, tree: Mapping[str, Any], name: str, refine: int = 1) -> None:
        self.name, self.refine = name, refine
        self.box = tree["gearboxes"][name]
        self.house = self.box["housing"]
        self.net = Network()
        self.steel = STEEL[self.house["material"]]
        self.bodies: dict[str, list[int]] = {"housing": []}
        self.films: dict[str, list[int]] = {}
        """Film numbers by surface name of the rig."""
        self.faces: dict[str, Face] = {}
        self.oil: dict[str, int] = {}
        self.rows: dict[str, list[int]] = {}
        """Oil cells that run down a wall, from the top."""
        self.shafts = list(self.house["shafts"])
        self.rim: dict[str, int] = {}
        """Outermost cell by gear."""
        self.seal_cells: dict[str, list[int]] = {}
        """Cells of a shaft in the partitions."""
        self.ends: dict[str, int] = {}
        """Rearmost cell of a shaft."""
        self._shapes()
        self._oil_cells()
        self._belts()
        self._transverse()
        add_field(self, self._field_lines())
        for shaft in self.shafts:
            add_shaft(self, shaft, self._zones(shaft))
        self._hidden_ways()
        self.net.finish()

    # ---------------------------------------------------------------- sizes and lines

    def _stations(self) -> tuple[tuple[str, ...], tuple[float, ...], tuple[int, ...]]:
        """Parts along the shafts, their lengths [m] and intervals."""
        h, r = self.house, self.refine
        end, part = h["end_wall_thickness"], h["partition_thickness"]
        names = (
            "end_front",
            "cold_front",
            "partition_front",
            "warm",
            "partition_rear",
            "cold_rear",
            "end_rear",
        )
        lengths = (end, h["cold_length_front"], part, h["warm_length"], part, h["cold_length_rear"], end)
        return names, lengths, (1, 2 * r, 1, 3 * r, 1, 2 * r, 1)

    def _field_lines(self) -> list[float]:
        """Lines along the shafts that the field under the box takes over."""
        x, parts = self.lines.x, self.lines.parts
        return [
            x[0],
            x[1],
            x[parts["cold_front"][1]],
            0.5 * self.length,
            x[parts["cold_rear"][0]],
            x[-2],
            x[-1],
        ]

    def _zones(self, shaft: str) -> list[Zone]:
        """Stretches of a shaft from the front."""
        return cold_zones(self, shaft)

    def _shapes(self) -> None:
        h, r = self.house, self.refine
        names, lengths, counts = self._stations()
        stations = np.cumsum([0.0, *lengths])
        x, parts, first = [np.zeros(1)], {}, 0
        for name, low, high, count in zip(names, stations[:-1], stations[1:], counts, strict=True):
            x.append(np.linspace(low, high, count + 1)[1:])
            parts[name] = (first, first + count)
            first += count
        self.length, self.width, self.height = float(stations[-1]), h["width"], h["height"]
        wall, floor, top = h["wall_thickness"], h["floor_thickness"], h["top_thickness"]
        at = {s: h["shafts"][s]["lateral_position"] for s in self.shafts}
        order = sorted(self.shafts, key=lambda s: at[s])
        gap = min((at[b] - at[a] for a, b in pairwise(order)), default=0.1)
        half = self.square * gap
        marks = [-self.width / 2.0 + wall, *(at[s] + sign * half for s in order for sign in (-1, 1)),
                 self.width / 2.0 - wall]  # fmt: skip
        y, first_y = [np.array([marks[0]])], {}
        for index, (low, high) in enumerate(pairwise(marks)):
            edge = index in (0, len(marks) - 2)
            if index % 2:
                first_y[order[index // 2]] = sum(len(part) for part in y) - 1
            y.append(np.linspace(low, high, (2 if edge else 1) * r + 1)[1:])
        centre = h["shaft_height"]
        z = [np.linspace(floor, centre - half, 2 * r + 1), np.linspace(centre - half, centre + half, r + 1)[1:],
             np.linspace(centre + half, self.height - top, 2 * r + 1)[1:]]  # fmt: skip
        squares = {s: (first_y[s], 2 * r) for s in self.shafts}
        self.lines = Lines(np.concatenate(x), np.concatenate(y), np.concatenate(z), parts, half, squares)
        self.t = {"left": wall, "right": wall, "top": top, "floor": floor}

    def solid(self, body: str, volume: float, steel: tuple[float, float]) -> int:
        """New cell of a body; its number."""
        number = self.net.cell(steel[0], steel[1] * volume)
        self.bodies.setdefault(body, []).append(number)
        return number

    def wet(self, surface: str, solid: int, fluid: int, area: float, reach: float, group: str,
             height: float = 0.0) -> int:  # fmt: skip
        if area <= 0.0:
            return -1
        self.net.wet(solid, fluid, area, reach, group, height)
        number = len(self.net.films) - 1
        self.films.setdefault(surface, []).append(number)
        return number

    # ---------------------------------------------------------------- oil

    def _oil_cells(self) -> None:
        levels = len(self.lines.z) - 1
        for name in ("jet", "mist", "top", "sump"):
            self.oil[name] = self.net.cell(0.0, OIL_FILM)
        for wall in ("left", "right", "partition_front", "partition_rear"):
            self.rows[wall] = [self.net.cell(0.0, OIL_FILM / levels) for _ in range(levels)]
        for side in SIDES:
            for name in ("end", "splash", "drain"):
                self.oil[f"{name}_{side}"] = self.net.cell(0.0, OIL_FILM)
        for bearing in self.box["bearings"]:
            self.oil[f"film_{bearing}"] = self.net.cell(0.0, 10.0)

    # ---------------------------------------------------------------- walls along the shafts

    def _belts(self) -> None:
        x = self.lines.x
        dx = np.diff(x)
        self.belt: dict[str, np.ndarray] = {}
        for wall in ("left", "right", "top", "floor"):
            cross = self.lines.z if wall in ("left", "right") else self.lines.y
            d, t = np.diff(cross), self.t[wall]
            limits = (
                (0.0, self.height) if wall in ("left", "right") else (-self.width / 2.0, self.width / 2.0)
            )
            outer = np.diff(np.concatenate([[limits[0]], cross[1:-1], [limits[1]]]))
            cells = np.empty((len(dx), len(d)), dtype=int)
            films = np.full(cells.shape, -1)
            for i in range(len(dx)):
                for j in range(len(d)):
                    cells[i, j] = cell = self.solid("housing", dx[i] * d[j] * t, self.steel)
                    if wall != "floor":
                        height = (
                            (0.5 * (cross[j] + cross[j + 1]) / self.height - 0.5) if wall != "top" else 0.5
                        )
                        films[i, j] = self.wet(
                            self._outer_name(i),
                            cell,
                            OUTSIDE,
                            dx[i] * outer[j],
                            t / 2.0,
                            f"out_{wall}",
                            height,
                        )
                    self._inside(wall, i, j, cell, dx[i] * d[j], t / 2.0, cross)
            self._grid(cells, dx, d, t)
            self.belt[wall] = cells
            if wall != "floor":
                axis = 2 if wall in ("left", "right") else 1
                level = {"left": -self.width / 2.0, "right": self.width / 2.0, "top": self.height}[wall]
                self.faces[wall] = Face((0, axis), 3 - axis, level, middle_of(x), middle_of(cross), films)
        for side, index in (("left", 0), ("right", -1)):
            for end, row in (("floor", 0), ("top", -1)):
                self._corner(self.belt[side][:, row], self.belt[end][:, index], side, end, dx)

    def _corner(self, one: np.ndarray, two: np.ndarray, side: str, end: str, dx: np.ndarray) -> None:
        dz, dy = np.diff(self.lines.z), np.diff(self.lines.y)
        row, column = (0 if end == "floor" else -1), (0 if side == "left" else -1)
        reach = 0.5 * (dz[row] + self.t[end]), 0.5 * (dy[column] + self.t[side])
        for i, width in enumerate(dx):
            thickness = 0.5 * (self.t[side] + self.t[end])
            self.net.join(one[i], two[i], *reach, width * thickness)

    def _outer_name(self, i: int) -> str:
        part = next(name for name, (a, b) in self.lines.parts.items() if a <= i < b)
        if part == "warm":
            return "outer_warm"
        return f"outer_cold_{part.rsplit('_', 1)[1]}" if not part.startswith("partition") else f"outer_{part}"

    def _inside(
        self, wall: str, i: int, j: int, cell: int, area: float, reach: float, cross: np.ndarray
    ) -> None:
        for part, (first, last) in self.lines.parts.items():
            if not first <= i < last or not (part == "warm" or part.startswith("cold")):
                continue
            height = 0.5 * (cross[j] + cross[j + 1]) / self.height - 0.5
            height = {"top": 0.5, "floor": -0.5}.get(wall, height)
            if part == "warm":
                if wall == "floor":
                    self.wet("chamber_floor", cell, self.oil["sump"], area, reach, "sump", height)
                elif wall == "top":
                    self.wet("chamber_top", cell, self.oil["top"], area, reach, "chamber", height)
                else:
                    oil = self.rows[wall][len(cross) - 2 - j]
                    self.wet("chamber_wall", cell, oil, area, reach, "chamber", height)
                continue
            side = part.removeprefix("cold_")
            oil = self.oil[f"drain_{side}" if wall == "floor" else f"splash_{side}"]
            name = f"cold_floor_{side}" if wall == "floor" else f"cold_wall_{side}"
            self.wet(name, cell, oil, area, reach, "cold_floor" if wall == "floor" else "cold", height)

    def _grid(self, cells: np.ndarray, du: np.ndarray, dv: np.ndarray, t: float) -> None:
        for i, j in np.ndindex(cells.shape):
            if cells[i, j] < 0:
                continue
            if i + 1 < cells.shape[0] and cells[i + 1, j] >= 0:
                self.net.join(cells[i, j], cells[i + 1, j], du[i] / 2, du[i + 1] / 2, dv[j] * t)
            if j + 1 < cells.shape[1] and cells[i, j + 1] >= 0:
                self.net.join(cells[i, j], cells[i, j + 1], dv[j] / 2, dv[j + 1] / 2, du[i] * t)

    # ---------------------------------------------------------------- end walls and partitions

    def _transverse(self) -> None:
        y, z, r = self.lines.y, self.lines.z, self.refine
        dy, dz = np.diff(y), np.diff(z)
        outer_y = np.diff(np.concatenate([[-self.width / 2.0], y[1:-1], [self.width / 2.0]]))
        outer_z = np.diff(np.concatenate([[0.0], z[1:-1], [self.height]]))
        self.bore: dict[tuple[str, str], list[int]] = {}
        """Innermost cells of the patch of a shaft in a plate."""
        for plate in self.plates:
            row = self.lines.parts[plate][0]
            t = float(np.diff(self.lines.x)[row])
            cells = np.full((len(dy), len(dz)), -1)
            films = np.full(cells.shape, -1)
            holes = {
                (a + i, b + j) for a, b in self.lines.squares.values() for i in range(r) for j in range(r)
            }
            for i, j in np.ndindex(cells.shape):
                if (i, j) in holes:
                    continue
                cells[i, j] = cell = self.solid("housing", dy[i] * dz[j] * t, self.steel)
                height = 0.5 * (z[j] + z[j + 1]) / self.height - 0.5
                films[i, j] = self._both_sides(plate, cell, dy[i] * dz[j], outer_y[i] * outer_z[j], t, height)
            self._grid(cells, dy, dz, t)
            self._edges(cells, row, dy, dz, t)
            if plate.startswith("end"):
                level = 0.0 if plate == "end_front" else self.length
                self.faces[plate] = Face((1, 2), 0, level, middle_of(y), middle_of(z), films)
            for shaft in self.shafts:
                self._patch(plate, shaft, cells, t, dy, dz)

    def _both_sides(self, plate: str, cell: int, inner: float, outer: float, t: float, height: float) -> int:
        """New film of a surface; its number, -1 without area."""
        kind, side = plate.split("_")
        if kind == "end":
            self.wet(f"cold_wall_{side}", cell, self.oil[f"end_{side}"], inner, t / 2.0, "cold_end", height)
            return self.wet(f"outer_cold_{side}", cell, OUTSIDE, outer, t / 2.0, f"out_{plate}", height)
        levels = len(self.rows[plate])
        row = min(max(int((0.5 - height) * levels), 0), levels - 1)
        oil = self.rows[plate][row]
        self.wet(f"partition_warm_{side}", cell, oil, inner, t / 2.0, "chamber", height)
        self.wet(f"partition_cold_{side}", cell, self.oil[f"splash_{side}"], inner, t / 2.0, "cold", height)
        return -1

    def _edges(self, cells: np.ndarray, row: int, dy: np.ndarray, dz: np.ndarray, t: float) -> None:
        for j, d in enumerate(dz):
            self.net.join(cells[0, j], self.belt["left"][row, j], dy[0] / 2, self.t["left"] / 2, t * d)
            self.net.join(cells[-1, j], self.belt["right"][row, j], dy[-1] / 2, self.t["right"] / 2, t * d)
        for i, d in enumerate(dy):
            self.net.join(cells[i, 0], self.belt["floor"][row, i], dz[0] / 2, self.t["floor"] / 2, t * d)
            self.net.join(cells[i, -1], self.belt["top"][row, i], dz[-1] / 2, self.t["top"] / 2, t * d)

    def hole_radius(self, plate: str, shaft: str) -> float:
        """Radius of the bore of a shaft in a plate [m]."""
        kind, side = plate.split("_")
        if kind == "end":
            bearing = self.bearing(shaft, side)
            return self.box["bearings"][bearing]["diameter"] / 2.0
        gap = next((s["radial_gap"] for s in self.box["seals"].values() if s["shaft"] == shaft), 6e-4)
        return self.house["shafts"][shaft]["seal_diameter"] / 2.0 + gap

    def bearing(self, shaft: str, side: str) -> str:
        """Name of the bearing of a shaft at one side."""
        return next(n for n, b in self.box["bearings"].items() if b["shaft"] == shaft and b["side"] == side)

    def _patch(
        self, plate: str, shaft: str, cells: np.ndarray, t: float, dy: np.ndarray, dz: np.ndarray
    ) -> None:
        """Annulus of the area of the square it fills, in rings and sectors; the bearing's shell is its inner half."""
        r = self.refine
        i0, j0 = self.lines.squares[shaft]
        bore = self.hole_radius(plate, shaft)
        outer = 2.0 * self.lines.half / math.sqrt(math.pi)
        radii = np.geomspace(bore, outer, 2 * r + 1)
        middle = np.sqrt(radii[:-1] * radii[1:])
        sectors, angle = 4 * r, 2.0 * math.pi / (4 * r)
        ring = np.empty((2 * r, sectors), dtype=int)
        films = np.full(ring.shape, -1)
        shell = plate.startswith("end")
        for a, b in np.ndindex(ring.shape):
            area = 0.5 * angle * (radii[a + 1] ** 2 - radii[a] ** 2)
            ring[a, b] = self.solid("housing", area * t, self.steel)
            films[a, b] = self._both_sides(plate, ring[a, b], area, area, t, 0.0)
        for a, b in np.ndindex(ring.shape):
            along = angle * middle[a] / 2.0
            self.net.join(ring[a, b], ring[a, (b + 1) % sectors], along, along, (radii[a + 1] - radii[a]) * t)
            if a + 1 < 2 * r:
                face = radii[a + 1]
                reach = face * math.log(face / middle[a]), face * math.log(middle[a + 1] / face)
                contact, on = (
                    ("shell", self._bearing_width(plate, shaft) * angle * bore)
                    if shell and a + 1 == r
                    else ("", 0.0)
                )
                self.net.join(ring[a, b], ring[a + 1, b], *reach, angle * face * t, contact, on)
        sides = (
            [(i0 + r, j0 + k) for k in range(r)],
            [(i0 + r - 1 - k, j0 + r) for k in range(r)],
            [(i0 - 1, j0 + r - 1 - k) for k in range(r)],
            [(i0 + k, j0 - 1) for k in range(r)],
        )  # sectors count from -45 degrees, against the clock
        reach = outer * math.log(outer / middle[-1])
        ratio = (2.0 * self.lines.half / r) / (angle * outer)
        for b in range(sectors):
            i, j = sides[b // r][b % r]
            step = dy[i] if b // r % 2 == 0 else dz[j]
            self.net.join(ring[-1, b], cells[i, j], reach * ratio, step / 2.0, 2.0 * self.lines.half / r * t)
        self._bore(plate, shaft, ring[0], bore, middle[0], angle, t)
        if shell:
            centre = self.house["shafts"][shaft]["lateral_position"], self.house["shaft_height"]
            self.faces[plate].patches.append((*centre, self.lines.half, middle, films))

    def _bearing_width(self, plate: str, shaft: str) -> float:
        return float(self.box["bearings"][self.bearing(shaft, plate.split("_")[1])]["width"])

    def _bore(self, plate: str, shaft: str, cells: np.ndarray, bore: float, middle: float, angle: float,
              t: float) -> None:  # fmt: skip
        kind, side = plate.split("_")
        self.bore[plate, shaft] = list(cells)
        reach = bore * math.log(middle / bore)
        for cell in cells:
            if kind == "end":
                name = self.bearing(shaft, side)
                width = self.box["bearings"][name]["width"]
                oil, area = self.oil[f"film_{name}"], angle * bore * width
                self.wet(f"bearing_bore_{shaft}_{side}", cell, oil, area, reach, "bearing")
            else:
                self.wet(
                    f"seal_bore_{shaft}_{side}", cell, self.oil["mist"], angle * bore * t, reach, "seal_bore"
                )

    def _hidden_ways(self) -> None:
        """Ways that carry nothing on a healthy rig: a feed gallery in the partitions, barrier air at their seals."""
        bores = [
            cell for (plate, _), cells in self.bore.items() if plate.startswith("partition") for cell in cells
        ]
        films = [self.oil[f"film_{bearing}"] for bearing in self.box["bearings"]]
        for index, cell in enumerate(bores):
            self.wet("gallery", cell, films[index % len(films)], 1.0 / len(bores), 0.0, "gallery")
            self.wet("barrier", cell, OUTSIDE, 1.0 / len(bores), 0.0, "barrier")
