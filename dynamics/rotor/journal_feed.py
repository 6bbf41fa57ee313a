"""Where oil enters a plain journal bearing, and the arcs of film that this leaves.

``widest_gap``: at ambient pressure where the static gap is widest (ISO 7902-1); one arc, ended by the break-up of the
film. ``two_axial_grooves``: two grooves of 20 degrees across the load, at ambient pressure, between them two shells of
160 degrees, the load on the middle of one (J. W. Lund, K. K. Thomsen 1978).
"""

import math
from typing import Literal

Feed = Literal["widest_gap", "two_axial_grooves"]
FEEDS: tuple[Feed, ...] = ("widest_gap", "two_axial_grooves")

FILM_END = 1.5 * math.pi
"""Angle behind the widest gap at which the grid ends [rad]: beyond any break-up of the film (257 deg)."""
GROOVE = math.radians(20.0)
"""Angle that an axial groove covers [rad]."""


def film_arcs(feed: Feed, attitude: float) -> tuple[tuple[float, float], ...]:
    """Start and end of every arc of film [rad], from the widest gap in the direction of rotation.

    attitude : from the load to the line of centres [rad]; grooves stand still while it changes
    """
    if feed == "widest_gap":
        return ((0.0, FILM_END),)
    length = math.pi - GROOVE
    starts = (0.5 * math.pi + 0.5 * GROOVE - attitude, 1.5 * math.pi + 0.5 * GROOVE - attitude)
    return tuple((start, start + length) for start in starts)
