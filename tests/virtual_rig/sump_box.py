"""Cells of a housing over a sump: one chamber between two end walls, roller bearings in these, gears half in the oil.

The sump is held at a temperature, so it is no unknown: every film of oil ends there. Only the oil in a bearing has a
cell of its own.
"""

import numpy as np

from tests.virtual_rig.heat_box import Box
from tests.virtual_rig.heat_network import OUTSIDE
from tests.virtual_rig.heat_parts import SIDES
from tests.virtual_rig.heat_rotors import Zone, gear_on

BEARING_OIL = 60.0
"""Heat capacity of the oil in a bearing, with rollers and cage [J/K]."""


class SumpBox(Box):
    """Network of a gearbox with a sump."""

    plates = ("end_front", "end_rear")
    square = 0.45

    def _stations(self) -> tuple[tuple[str, ...], tuple[float, ...], tuple[int, ...]]:
        end = self.house["end_wall_thickness"]
        return (
            ("end_front", "warm", "end_rear"),
            (end, self.house["warm_length"], end),
            (1, 4 * self.refine, 1),
        )

    def _field_lines(self) -> list[float]:
        x = self.lines.x
        return [x[0], x[1], 0.5 * self.length, x[-2], x[-1]]

    def _zones(self, shaft: str) -> list[Zone]:
        """Journals in the end walls, and the shaft in the chamber; outside where it leaves."""
        house, entry, r = self.house, self.house["shafts"][shaft], self.refine
        width = self.box["gears"][gear_on(self, shaft)]["face_width"]
        land, d = (house["warm_length"] - width) / 2.0, entry["outside_diameter"]

        def half(side: str) -> list[Zone]:
            over, bearing = (
                entry[f"overhang_{side}"],
                self.box["bearings"][self.bearing(shaft, side)]["width"],
            )
            gap = house["end_wall_thickness"] - bearing
            ends: list[Zone] = (
                [("outside", side, over, d, 2 * r), ("end_seal", side, gap, d, 1)] if over else []
            )
            return [*ends, ("journal", side, bearing, d, 2 * r), ("warm", side, land, d, 2 * r)]

        return [*half("front"), ("gear", "", width, d, 1), *reversed(half("rear"))]

    def _oil_cells(self) -> None:
        self.oil = dict.fromkeys(("jet", "mist", "sump", *(f"end_{side}" for side in SIDES)), OUTSIDE)
        for bearing in self.box["bearings"]:
            self.oil[f"film_{bearing}"] = self.net.cell(0.0, BEARING_OIL)

    def _outer_name(self, i: int) -> str:
        part = next(name for name, (a, b) in self.lines.parts.items() if a <= i < b)
        return f"outer_{part}"

    def _inside(
        self, wall: str, i: int, j: int, cell: int, area: float, reach: float, cross: np.ndarray
    ) -> None:
        first, last = self.lines.parts["warm"]
        if not first <= i < last:
            return
        height = {"top": 0.5, "floor": -0.5}.get(wall, 0.5 * (cross[j] + cross[j + 1]) / self.height - 0.5)
        surface = f"chamber_{wall}" if wall in ("top", "floor") else "chamber_wall"
        self.wet(surface, cell, OUTSIDE, area, reach, self.wetting(height), height)

    def wetting(self, height: float) -> str:
        """Film of an inner wall at a height (share of the box, from its middle): in the bath or over it."""
        level = self.house["shaft_height"] + self.box["oil"]["level"]
        return "bath" if height < level / self.height - 0.5 else "splash"

    def _both_sides(self, plate: str, cell: int, inner: float, outer: float, t: float, height: float) -> int:
        side = plate.split("_")[1]
        self.wet(f"end_wall_{side}", cell, OUTSIDE, inner, t / 2.0, self.wetting(height), height)
        return self.wet(f"outer_{plate}", cell, OUTSIDE, outer, t / 2.0, f"out_{plate}", height)

    def hole_radius(self, plate: str, shaft: str) -> float:
        """Seat of the outer ring of a bearing [m]."""
        return float(self.box["bearings"][self.bearing(shaft, plate.split("_")[1])]["outside"]) / 2.0

    def _hidden_ways(self) -> None:
        """None; but gears in mesh touch."""
        for mesh in self.box["meshes"].values():
            self.net.join(self.rim[mesh["pinion"]], self.rim[mesh["wheel"]], 0.0, 0.0, 1.0, "flank")
