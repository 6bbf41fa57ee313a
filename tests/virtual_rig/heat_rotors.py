"""Shafts in one dimension along x, gears in one along the radius."""

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from tests.virtual_rig.heat_network import OUTSIDE
from tests.virtual_rig.heat_parts import SIDES, STEEL

if TYPE_CHECKING:
    from tests.virtual_rig.heat_box import Box


Zone = tuple[str, str, float, float, int]
"""What is round a stretch of shaft, its side, length and diameter [m], cells."""


def gear_on(box: "Box", shaft: str) -> str | None:
    """Gear of a shaft."""
    return next((n for n, g in box.box["gears"].items() if g["shaft"] == shaft), None)


def add_shaft(box: "Box", shaft: str, zones: Sequence[Zone]) -> None:
    """Cells of a shaft along x and of its gear along the radius, with their films."""
    entry = box.house["shafts"][shaft]
    steel = STEEL[entry.get("material", "case_hardened_steel")]
    gear = gear_on(box, shaft)
    seat = box.box["gears"][gear]["bore_diameter"] if gear else entry["seal_diameter"]
    previous: tuple[int, float, float] | None = None
    for zone, side, length, diameter, count in zones:
        area, radius = math.pi * diameter**2 / 4.0, diameter / 2.0
        for _ in range(count):
            step = length / count
            cell = box.solid(f"shaft_{shaft}", area * step, steel)
            if previous is not None:
                box.net.join(previous[0], cell, previous[1], step / 2.0, min(area, previous[2]))
            elif zone == "outside":
                box.wet(f"shaft_{shaft}_end_front", cell, OUTSIDE, area, step / 2.0, "shaft_end")
            previous = (cell, step / 2.0, area)
            _shaft_film(box, shaft, zone, side, cell, math.pi * diameter * step, radius / 4.0)
            if zone == "gear":
                _gear(box, shaft, str(gear), cell, seat)
    if previous is not None and entry.get("overhang_rear", 0.0) > 0.0:
        box.wet(f"shaft_{shaft}_end_rear", previous[0], OUTSIDE, previous[2], previous[1], "shaft_end")
    if previous is not None:
        box.ends[shaft] = previous[0]


def cold_zones(box: "Box", shaft: str) -> list[Zone]:
    """Of a shaft that passes partitions and cold sections to its bearings."""
    h, r, entry, gear = box.house, box.refine, box.house["shafts"][shaft], gear_on(box, shaft)
    seat = box.box["gears"][gear]["bore_diameter"] if gear else entry["seal_diameter"]
    width = box.box["gears"][gear]["face_width"] if gear else 0.0
    land = (h["warm_length"] - width) / 2.0
    outside, seal = entry["outside_diameter"], entry["seal_diameter"]
    bearings = {side: box.box["bearings"][box.bearing(shaft, side)] for side in SIDES}

    def half(side: str) -> list[Zone]:
        over = entry.get(f"overhang_{side}", 0.0)
        gap = h["end_wall_thickness"] - bearings[side]["width"]
        zones = [("outside", side, over, outside, 2 * r), ("end_seal", side, gap, outside, 1)] if over else []
        return [
            *zones,
            ("journal", side, bearings[side]["width"], bearings[side]["diameter"], 2 * r),
            ("cold", side, h[f"cold_length_{side}"], seal, 2 * r),
            ("seal", side, h["partition_thickness"], seal, 2 * r),
            ("warm", side, land, seat, 2 * r),
        ]

    middle = [("gear", "", width, seat, 1)] if gear else []
    return [*half("front"), *middle, *reversed(half("rear"))]


def _shaft_film(box: "Box", shaft: str, zone: str, side: str, cell: int, area: float, reach: float) -> None:
    name = f"shaft_{shaft}_{zone}_{side}".removesuffix("_")
    if zone == "outside":
        box.wet(name, cell, OUTSIDE, area, reach, "shaft_out")
    elif zone == "end_seal":
        box.wet(name, cell, box.oil[f"end_{side}"], area, reach, "end_seal")
    elif zone == "journal":
        oil = box.oil[f"film_{box.bearing(shaft, side)}"]
        box.wet(f"shaft_{shaft}_journal_{side}", cell, oil, area, reach, "journal")
    elif zone == "cold":
        box.wet(name, cell, box.oil[f"splash_{side}"], area, reach, "shaft_cold")
    elif zone == "warm":
        box.wet(f"shaft_{shaft}_warm", cell, box.oil["mist"], area, reach, "shaft_warm")
    elif zone == "seal":
        box.seal_cells.setdefault(shaft, []).append(cell)
        targets = box.bore[f"partition_{side}", shaft]
        for target in targets:
            share = area / len(targets)
            box.net.join(cell, target, reach, 0.0, share, "seal_gap")


def _gear(box: "Box", shaft: str, gear: str, seat_cell: int, seat: float) -> None:
    entry = box.box["gears"][gear]
    mesh = next(m for m in box.box["meshes"].values() if gear in (m["pinion"], m["wheel"]))
    steel = STEEL[entry.get("material", "case_hardened_steel")]
    tip = mesh["normal_module"] / math.cos(mesh.get("helix_angle", 0.0)) * entry["teeth"] / 2.0
    width = entry["face_width"]
    radii = np.linspace(seat / 2.0, tip, 4 * box.refine + 1)
    previous = None
    for low, high in pairwise(radii):
        area = math.pi * (high**2 - low**2)
        cell = box.solid(f"gear_{shaft}", area * width, steel)
        middle = math.sqrt(low * high)
        face = 2.0 * math.pi * low * width
        if previous is None:
            box.net.join(seat_cell, cell, seat / 8.0, low * math.log(middle / low), face, "seat")
        else:
            box.net.join(
                previous[0], cell, low * math.log(low / previous[1]), low * math.log(middle / low), face
            )
        for side in SIDES:
            box.wet(
                f"gear_{shaft}_side_{side}",
                cell,
                box.oil["mist"],
                area,
                width / 4.0,
                f"gear_side_{gear}",
            )
        previous = (cell, middle)
    assert previous is not None
    reach = tip * math.log(tip / previous[1])
    box.wet(f"gear_{shaft}_rim", previous[0], box.oil["jet"], 2.0 * math.pi * tip * width, reach, "rim")
    box.rim[gear] = previous[0]
