"""ISO 5753-1:2009, rolling bearings: radial internal clearance.

Units as printed (bore in mm, clearance in um). The values are those two bearing catalogues print: NSK table 9.9 for
deep groove ball bearings, SKF General Catalogue 6000 p. 513 for cylindrical roller bearings.
"""

from typing import Literal

from dynamics.errors import DynamicsInputError

ClearanceClass = Literal["C2", "CN", "C3", "C4", "C5"]
CLASSES: tuple[ClearanceClass, ...] = ("C2", "CN", "C3", "C4", "C5")

Table = tuple[tuple[float, tuple[tuple[int, int], ...]], ...]

DEEP_GROOVE_BALL: Table = (
    (10.0, ((0, 7), (2, 13), (8, 23), (14, 29), (20, 37))),
    (18.0, ((0, 9), (3, 18), (11, 25), (18, 33), (25, 45))),
    (24.0, ((0, 10), (5, 20), (13, 28), (20, 36), (28, 48))),
    (30.0, ((1, 11), (5, 20), (13, 28), (23, 41), (30, 53))),
    (40.0, ((1, 11), (6, 20), (15, 33), (28, 46), (40, 64))),
    (50.0, ((1, 11), (6, 23), (18, 36), (30, 51), (45, 73))),
    (65.0, ((1, 15), (8, 28), (23, 43), (38, 61), (55, 90))),
    (80.0, ((1, 15), (10, 30), (25, 51), (46, 71), (65, 105))),
    (100.0, ((1, 18), (12, 36), (30, 58), (53, 84), (75, 120))),
    (120.0, ((2, 20), (15, 41), (36, 66), (61, 97), (90, 140))),
    (140.0, ((2, 23), (18, 48), (41, 81), (71, 114), (105, 160))),
    (160.0, ((2, 23), (18, 53), (46, 91), (81, 130), (120, 180))),
    (180.0, ((2, 25), (20, 61), (53, 102), (91, 147), (135, 200))),
    (200.0, ((2, 30), (25, 71), (63, 117), (107, 163), (150, 230))),
)
"""Upper end of the bore range, then (minimum, maximum) of C2, CN, C3, C4, C5."""

CYLINDRICAL_ROLLER: Table = (
    (24.0, ((0, 25), (20, 45), (35, 60), (50, 75), (65, 90))),
    (30.0, ((0, 25), (20, 45), (35, 60), (50, 75), (70, 95))),
    (40.0, ((5, 30), (25, 50), (45, 70), (60, 85), (80, 105))),
    (50.0, ((5, 35), (30, 60), (50, 80), (70, 100), (95, 125))),
    (65.0, ((10, 40), (40, 70), (60, 90), (80, 110), (110, 140))),
    (80.0, ((10, 45), (40, 75), (65, 100), (90, 125), (130, 165))),
    (100.0, ((15, 50), (50, 85), (75, 110), (105, 140), (155, 190))),
    (120.0, ((15, 55), (50, 90), (85, 125), (125, 165), (180, 220))),
    (140.0, ((15, 60), (60, 105), (100, 145), (145, 190), (200, 245))),
    (160.0, ((20, 70), (70, 120), (115, 165), (165, 215), (225, 275))),
    (180.0, ((25, 75), (75, 125), (120, 170), (170, 220), (250, 300))),
    (200.0, ((35, 90), (90, 145), (140, 195), (195, 250), (275, 330))),
)
"""As above; the first row is for bores up to 24 mm."""


def radial_internal_clearance(table: Table, d: float, clearance_class: ClearanceClass) -> tuple[float, float]:
    """Least and largest radial internal clearance of an unmounted bearing [um]; bore d [mm].

    Raises DynamicsInputError for a bore outside the table.
    """
    if clearance_class not in CLASSES:
        raise DynamicsInputError(
            f"clearance class = {clearance_class!r}: unknown; give one of {', '.join(CLASSES)}"
        )
    column = CLASSES.index(clearance_class)
    for upper, ranges in table:
        if 0.0 < d <= upper:
            least, largest = ranges[column]
            return float(least), float(largest)
    raise DynamicsInputError(
        f"bore = {d:.6g} mm: clearance classes are tabled up to {table[-1][0]:.0f} mm; give the clearance itself"
    )
