"""A gearbox of the prototype's size, and areas of its surfaces."""

from dataclasses import replace

import numpy as np

from thermal.fe.mesh import NamedMesh
from thermal.housing.gearbox import (
    ClampingField,
    EndBearing,
    GearDisc,
    HousingGeometry,
    ShaftGeometry,
)

BEARING = EndBearing(journal_diameter=0.040, width=0.024)

PINION = ShaftGeometry(
    name="pinion", y=-0.04975, front=BEARING, rear=BEARING, seal_diameter=0.045, seat_diameter=0.050,
    overhang_diameter=0.036, seal_gap=0.6e-3, locating="front", overhang_rear=0.06,
    gear=GearDisc(outer_diameter=0.101, width=0.007),
)  # fmt: skip

WHEEL = replace(
    PINION, name="wheel", y=0.04975, locating="rear", overhang_front=0.05,
    gear=GearDisc(outer_diameter=0.101, width=0.015),
)  # fmt: skip

PROTOTYPE = HousingGeometry(
    chamber_length=0.1, cold_length_front=0.09, cold_length_rear=0.09, height=0.28, width=0.32,
    wall_thickness=0.013, floor_thickness=0.015, top_thickness=0.012, partition_thickness=0.015,
    end_wall_thickness=0.03, shaft_height=0.14, shafts=(PINION, WHEEL),
    field=ClampingField(length=0.8, width=1.2, thickness=0.15),
)  # fmt: skip

WIDE, LOOSE = replace(BEARING, width=0.04), replace(BEARING, clearance=5e-5)

ONE_CHAMBER = replace(
    PROTOTYPE,
    cold_length_front=0.0, cold_length_rear=0.0, partition_thickness=0.0,
    shafts=(
        replace(PINION, seal_diameter=0.0, front=WIDE, rear=WIDE),
        replace(WHEEL, seal_diameter=0.0, front=BEARING, rear=LOOSE, overhang_diameter=0.044),
    ),
)  # fmt: skip
"""The same without partitions: bosses that stand in the chamber, a blind end, an overhang thicker than its journal."""


def area(mesh: NamedMesh, surface: str) -> float:
    return sum(size for size, _ in _triangles(mesh.points, mesh.surfaces[surface]))


def _triangles(points: np.ndarray, facets: np.ndarray) -> list[tuple[float, float]]:
    """(area, flux of position) of all six-node triangles, one entry a point of the six-point rule."""
    found = []
    for a, weight in ((0.445948490915965, 0.223381589678011), (0.091576213509771, 0.109951743655322)):
        for r, s in ((a, a), (a, 1 - 2 * a), (1 - 2 * a, a)):
            t = 1 - r - s
            shape = np.array(
                [t * (2 * t - 1), r * (2 * r - 1), s * (2 * s - 1), 4 * t * r, 4 * r * s, 4 * s * t]
            )
            along_r = np.array([1 - 4 * t, 4 * r - 1, 0.0, 4 * (t - r), 4 * s, -4 * s])
            along_s = np.array([1 - 4 * t, 0.0, 4 * s - 1, -4 * r, 4 * r, 4 * (t - s)])
            nodes = points[facets]
            place = np.einsum("fni,n->fi", nodes, shape)
            normal = np.cross(np.einsum("fni,n->fi", nodes, along_r), np.einsum("fni,n->fi", nodes, along_s))
            found.append(
                (
                    0.5 * weight * float(np.linalg.norm(normal, axis=1).sum()),
                    0.5 * weight * float(np.einsum("fi,fi->", place, normal)),
                )
            )
    return found
