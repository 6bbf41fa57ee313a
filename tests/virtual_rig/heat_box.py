"""Cells of a gearbox with housing: plates, patches round the holes, shafts and gears, clamping field, oil.

x along the shafts from the front face, y across from the middle, z up from the foot. A plate is one cell thick; its
surface temperature follows from the heat through half of it. ``refine`` divides every cell edge.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tests.virtual_rig.heat_network import OUTSIDE, Network

STEEL = {
    "structural_steel": (50.0, 7850.0 * 475.0),
    "case_hardened_steel": (42.0, 7830.0 * 475.0),
    "grey_iron": (48.0, 7200.0 * 480.0),
    "ductile_iron": (36.0, 7100.0 * 500.0),
    "aluminium": (170.0, 2700.0 * 900.0),
}
"""Conductivity at 100 degC [W/(m K)] and heat capacity by volume [J/(m3 K)]."""
OIL_FILM = 150.0
"""Heat capacity of the oil a mixing cell holds [J/K]: about 70 g."""
SIDES = ("front", "rear")


@dataclass
class Face:
    """Outer face for reading temperatures: films on a grid, and patches inside it."""

    axes: tuple[int, int]
    """Coordinates (0 x, 1 y, 2 z) that run over the grid."""
    normal: int
    level: float
    u: np.ndarray
    v: np.ndarray
    films: np.ndarray
    """(n_u, n_v) film numbers; -1 inside a patch."""
    patches: list[tuple[float, float, float, np.ndarray, np.ndarray]] = field(default_factory=list)
    """Centre u, v, half side, ring radii (n_rings,), films (n_rings, n_sectors)."""


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
        self._field()
        for shaft in self.shafts:
            self._shaft(shaft)
        self._hidden_ways()
        self.net.finish()

    # ---------------------------------------------------------------- sizes and lines

    def _shapes(self) -> None:
        h, r = self.house, self.refine
        end, part = h["end_wall_thickness"], h["partition_thickness"]
        stations = np.cumsum(
            [0.0, end, h["cold_length_front"], part, h["warm_length"], part, h["cold_length_rear"], end]
        )
        names = (
            "end_front",
            "cold_front",
            "partition_front",
            "warm",
            "partition_rear",
            "cold_rear",
            "end_rear",
        )
        counts = (1, 2 * r, 1, 3 * r, 1, 2 * r, 1)
        x, parts, first = [np.zeros(1)], {}, 0
        for name, low, high, count in zip(names, stations[:-1], stations[1:], counts, strict=True):
            x.append(np.linspace(low, high, count + 1)[1:])
            parts[name] = (first, first + count)
            first += count
        self.length, self.width, self.height = float(stations[-1]), h["width"], h["height"]
        wall, floor, top = h["wall_thickness"], h["floor_thickness"], h["top_thickness"]
        at = {s: h["shafts"][s]["lateral_position"] for s in self.shafts}
        order = sorted(self.shafts, key=lambda s: at[s])
        gap = min((at[b] - at[a] for a, b in zip(order, order[1:], strict=False)), default=0.1)
        half = 0.32 * gap
        marks = [-self.width / 2.0 + wall, *(at[s] + sign * half for s in order for sign in (-1, 1)),
                 self.width / 2.0 - wall]  # fmt: skip
        y, first_y = [np.array([marks[0]])], {}
        for index, (low, high) in enumerate(zip(marks, marks[1:], strict=False)):
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

    def _solid(self, body: str, volume: float, steel: tuple[float, float]) -> int:
        number = self.net.cell(steel[0], steel[1] * volume)
        self.bodies.setdefault(body, []).append(number)
        return number

    def _wet(self, surface: str, solid: int, fluid: int, area: float, reach: float, group: str,
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
                    cells[i, j] = cell = self._solid("housing", dx[i] * d[j] * t, self.steel)
                    if wall != "floor":
                        height = (
                            (0.5 * (cross[j] + cross[j + 1]) / self.height - 0.5) if wall != "top" else 0.5
                        )
                        films[i, j] = self._wet(
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
                self.faces[wall] = Face((0, axis), 3 - axis, level, _middle(x), _middle(cross), films)
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
                    self._wet("chamber_floor", cell, self.oil["sump"], area, reach, "sump", height)
                elif wall == "top":
                    self._wet("chamber_top", cell, self.oil["top"], area, reach, "chamber", height)
                else:
                    oil = self.rows[wall][len(cross) - 2 - j]
                    self._wet("chamber_wall", cell, oil, area, reach, "chamber", height)
                continue
            side = part.removeprefix("cold_")
            oil = self.oil[f"drain_{side}" if wall == "floor" else f"splash_{side}"]
            name = f"cold_floor_{side}" if wall == "floor" else f"cold_wall_{side}"
            self._wet(name, cell, oil, area, reach, "cold_floor" if wall == "floor" else "cold", height)

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
        for plate in ("end_front", "partition_front", "partition_rear", "end_rear"):
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
                cells[i, j] = cell = self._solid("housing", dy[i] * dz[j] * t, self.steel)
                height = 0.5 * (z[j] + z[j + 1]) / self.height - 0.5
                films[i, j] = self._both_sides(plate, cell, dy[i] * dz[j], outer_y[i] * outer_z[j], t, height)
            self._grid(cells, dy, dz, t)
            self._edges(cells, row, dy, dz, t)
            if plate.startswith("end"):
                level = 0.0 if plate == "end_front" else self.length
                self.faces[plate] = Face((1, 2), 0, level, _middle(y), _middle(z), films)
            for shaft in self.shafts:
                self._patch(plate, shaft, cells, t, dy, dz)

    def _both_sides(self, plate: str, cell: int, inner: float, outer: float, t: float, height: float) -> int:
        kind, side = plate.split("_")
        if kind == "end":
            self._wet(f"cold_wall_{side}", cell, self.oil[f"end_{side}"], inner, t / 2.0, "cold_end", height)
            return self._wet(f"outer_cold_{side}", cell, OUTSIDE, outer, t / 2.0, f"out_{plate}", height)
        levels = len(self.rows[plate])
        row = min(max(int((0.5 - height) * levels), 0), levels - 1)
        oil = self.rows[plate][row]
        self._wet(f"partition_warm_{side}", cell, oil, inner, t / 2.0, "chamber", height)
        self._wet(f"partition_cold_{side}", cell, self.oil[f"splash_{side}"], inner, t / 2.0, "cold", height)
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
            ring[a, b] = self._solid("housing", area * t, self.steel)
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
                self._wet(f"bearing_bore_{shaft}_{side}", cell, oil, area, reach, "bearing")
            else:
                self._wet(
                    f"seal_bore_{shaft}_{side}", cell, self.oil["mist"], angle * bore * t, reach, "seal_bore"
                )

    # ---------------------------------------------------------------- clamping field

    def _field(self) -> None:
        plate = self.house.get("field")
        floor = self.belt["floor"]
        fx, fy = self.lines.x, np.concatenate([[-self.width / 2], self.lines.y[1:-1], [self.width / 2]])
        if plate is None:
            return
        r = self.refine
        steel = STEEL[plate["material"]]
        parts = self.lines.parts
        inner_x = [fx[0], fx[1], fx[parts["cold_front"][1]], 0.5 * self.length, fx[parts["cold_rear"][0]],
                   fx[-2], fx[-1]]  # fmt: skip
        inner_y = [-self.width / 2, -self.width / 4, 0.0, self.width / 4, self.width / 2]
        x = _apron(inner_x, self.length / 2.0, plate["length"], r)
        y = _apron(inner_y, 0.0, plate["width"], r)
        z = -plate["thickness"] * np.concatenate([[0.0], np.cumsum(np.array([0.2, 0.33, 0.47]))])
        z = -np.interp(np.linspace(0, 3, 3 * r + 1), np.arange(4), -z)
        dx, dy, dz = np.diff(x), np.diff(y), -np.diff(z)
        cells = np.empty((len(dx), len(dy), len(dz)), dtype=int)
        films = np.full(cells.shape[:2], -1)
        for i, j, k in np.ndindex(cells.shape):
            cells[i, j, k] = self._solid("field", dx[i] * dy[j] * dz[k], steel)
        for i, j, k in np.ndindex(cells.shape):
            here = cells[i, j, k]
            if i + 1 < len(dx):
                self.net.join(here, cells[i + 1, j, k], dx[i] / 2, dx[i + 1] / 2, dy[j] * dz[k])
            if j + 1 < len(dy):
                self.net.join(here, cells[i, j + 1, k], dy[j] / 2, dy[j + 1] / 2, dx[i] * dz[k])
            if k + 1 < len(dz):
                self.net.join(here, cells[i, j, k + 1], dz[k] / 2, dz[k + 1] / 2, dx[i] * dy[j])
            for edge, area, reach in (
                (i in (0, len(dx) - 1), dy[j] * dz[k], dx[i] / 2),
                (j in (0, len(dy) - 1), dx[i] * dz[k], dy[j] / 2),
            ):
                if edge:
                    self._wet("field_sides", here, OUTSIDE, area, reach, "field_sides")
            if k == len(dz) - 1:
                self._wet("field_bottom", here, OUTSIDE, dx[i] * dy[j], dz[k] / 2, "field_bottom")
        for i, j in np.ndindex(cells.shape[:2]):
            covered = 0.0
            for a in range(floor.shape[0]):
                wide = _overlap(x[i], x[i + 1], fx[a], fx[a + 1])
                for b in range(floor.shape[1]) if wide > 0.0 else ():
                    area = wide * _overlap(y[j], y[j + 1], fy[b], fy[b + 1])
                    if area > 1e-12:
                        covered += area
                        self.net.join(
                            floor[a, b], cells[i, j, 0], self.t["floor"] / 2, dz[0] / 2, area, "foot"
                        )
            free = dx[i] * dy[j] - covered
            if free > 1e-9:
                films[i, j] = self._wet("field_top", cells[i, j, 0], OUTSIDE, free, dz[0] / 2, "field_top")
        self.faces["field_top"] = Face((0, 1), 2, 0.0, _middle(x), _middle(y), films)

    def _hidden_ways(self) -> None:
        """Ways that carry nothing on a healthy rig: a feed gallery in the partitions, barrier air at their seals."""
        bores = [
            cell for (plate, _), cells in self.bore.items() if plate.startswith("partition") for cell in cells
        ]
        films = [self.oil[f"film_{bearing}"] for bearing in self.box["bearings"]]
        for index, cell in enumerate(bores):
            self._wet("gallery", cell, films[index % len(films)], 1.0 / len(bores), 0.0, "gallery")
            self._wet("barrier", cell, OUTSIDE, 1.0 / len(bores), 0.0, "barrier")

    # ---------------------------------------------------------------- shafts and gears

    def _shaft(self, shaft: str) -> None:
        entry = self.house["shafts"][shaft]
        steel = STEEL[entry.get("material", "case_hardened_steel")]
        gear = next((n for n, g in self.box["gears"].items() if g["shaft"] == shaft), None)
        seat = self.box["gears"][gear]["bore_diameter"] if gear else entry["seal_diameter"]
        previous: tuple[int, float, float] | None = None
        for zone, side, length, diameter, count in self._zones(shaft, entry, seat, gear):
            area, radius = math.pi * diameter**2 / 4.0, diameter / 2.0
            for _ in range(count):
                step = length / count
                cell = self._solid(f"shaft_{shaft}", area * step, steel)
                if previous is not None:
                    self.net.join(previous[0], cell, previous[1], step / 2.0, min(area, previous[2]))
                elif zone == "outside":
                    self._wet(f"shaft_{shaft}_end_front", cell, OUTSIDE, area, step / 2.0, "shaft_end")
                previous = (cell, step / 2.0, area)
                self._shaft_film(shaft, zone, side, cell, math.pi * diameter * step, radius / 4.0)
                if zone == "gear":
                    self._gear(shaft, str(gear), cell, seat)
        if previous is not None and entry.get("overhang_rear", 0.0) > 0.0:
            self._wet(f"shaft_{shaft}_end_rear", previous[0], OUTSIDE, previous[2], previous[1], "shaft_end")
        if previous is not None:
            self.ends[shaft] = previous[0]

    def _zones(self, shaft: str, entry: Mapping[str, Any], seat: float, gear: str | None) -> list[tuple]:
        h, r = self.house, self.refine
        width = self.box["gears"][gear]["face_width"] if gear else 0.0
        land = (h["warm_length"] - width) / 2.0
        outside, seal = entry["outside_diameter"], entry["seal_diameter"]
        bearings = {side: self.box["bearings"][self.bearing(shaft, side)] for side in SIDES}

        def half(side: str) -> list[tuple]:
            over = entry.get(f"overhang_{side}", 0.0)
            gap = h["end_wall_thickness"] - bearings[side]["width"]
            zones = (
                [("outside", side, over, outside, 2 * r), ("end_seal", side, gap, outside, 1)] if over else []
            )
            return [
                *zones,
                ("journal", side, bearings[side]["width"], bearings[side]["diameter"], 2 * r),
                ("cold", side, h[f"cold_length_{side}"], seal, 2 * r),
                ("seal", side, h["partition_thickness"], seal, 2 * r),
                ("warm", side, land, seat, 2 * r),
            ]

        middle = [("gear", "", width, seat, 1)] if gear else []
        return [*half("front"), *middle, *reversed(half("rear"))]

    def _shaft_film(self, shaft: str, zone: str, side: str, cell: int, area: float, reach: float) -> None:
        name = f"shaft_{shaft}_{zone}_{side}".removesuffix("_")
        if zone == "outside":
            self._wet(name, cell, OUTSIDE, area, reach, "shaft_out")
        elif zone == "end_seal":
            self._wet(name, cell, self.oil[f"end_{side}"], area, reach, "end_seal")
        elif zone == "journal":
            oil = self.oil[f"film_{self.bearing(shaft, side)}"]
            self._wet(f"shaft_{shaft}_journal_{side}", cell, oil, area, reach, "journal")
        elif zone == "cold":
            self._wet(name, cell, self.oil[f"splash_{side}"], area, reach, "shaft_cold")
        elif zone == "warm":
            self._wet(f"shaft_{shaft}_warm", cell, self.oil["mist"], area, reach, "shaft_warm")
        elif zone == "seal":
            self.seal_cells.setdefault(shaft, []).append(cell)
            targets = self.bore[f"partition_{side}", shaft]
            for target in targets:
                share = area / len(targets)
                self.net.join(cell, target, reach, 0.0, share, "seal_gap")

    def _gear(self, shaft: str, gear: str, seat_cell: int, seat: float) -> None:
        entry = self.box["gears"][gear]
        mesh = next(m for m in self.box["meshes"].values() if gear in (m["pinion"], m["wheel"]))
        steel = STEEL[entry.get("material", "case_hardened_steel")]
        tip = mesh["normal_module"] / math.cos(mesh.get("helix_angle", 0.0)) * entry["teeth"] / 2.0
        width = entry["face_width"]
        radii = np.linspace(seat / 2.0, tip, 4 * self.refine + 1)
        previous = None
        for low, high in zip(radii, radii[1:], strict=False):
            area = math.pi * (high**2 - low**2)
            cell = self._solid(f"gear_{shaft}", area * width, steel)
            middle = math.sqrt(low * high)
            face = 2.0 * math.pi * low * width
            if previous is None:
                self.net.join(seat_cell, cell, seat / 8.0, low * math.log(middle / low), face, "seat")
            else:
                self.net.join(
                    previous[0], cell, low * math.log(low / previous[1]), low * math.log(middle / low), face
                )
            for side in SIDES:
                self._wet(
                    f"gear_{shaft}_side_{side}",
                    cell,
                    self.oil["mist"],
                    area,
                    width / 4.0,
                    f"gear_side_{gear}",
                )
            previous = (cell, middle)
        assert previous is not None
        reach = tip * math.log(tip / previous[1])
        self._wet(
            f"gear_{shaft}_rim", previous[0], self.oil["jet"], 2.0 * math.pi * tip * width, reach, "rim"
        )
        self.rim[gear] = previous[0]


def _middle(lines: np.ndarray) -> np.ndarray:
    return 0.5 * (lines[1:] + lines[:-1])


def _overlap(a: float, b: float, c: float, d: float) -> float:
    return max(0.0, min(b, d) - max(a, c))


def _apron(inner: list[float], centre: float, total: float, refine: int) -> np.ndarray:
    """Lines of the field: those under the box and three widening steps to each edge."""
    low, high = centre - total / 2.0, centre + total / 2.0
    marks = np.array([0.0, 0.22, 0.55, 1.0])
    left = inner[0] + marks[:0:-1] * (low - inner[0])
    right = inner[-1] + marks[1:] * (high - inner[-1])
    lines = np.concatenate([left, inner, right])
    return np.interp(
        np.linspace(0, len(lines) - 1, (len(lines) - 1) * refine + 1), np.arange(len(lines)), lines
    )
