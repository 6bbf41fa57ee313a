"""What the parts of the box share: steels, oil held in a mixing cell, outer faces."""

from dataclasses import dataclass, field

import numpy as np

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


def middle_of(lines: np.ndarray) -> np.ndarray:
    """Centres between grid lines."""
    return 0.5 * (lines[1:] + lines[:-1])
