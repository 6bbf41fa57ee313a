"""ISO 76:2006, rolling bearings: static load ratings.

Symbols and units as printed (N, mm). Confidence: the roller formula is from memory and reproduces catalogue roller
sizes, the factor f_0 is from memory and reproduces the f_0 that a catalogue prints for deep groove ball bearings
(14 for series 62, 13 for series 63).
"""

import math
from collections.abc import Sequence

from dynamics.errors import DynamicsInputError

F_0: Sequence[float] = (
    14.7, 14.9, 15.1, 15.3, 15.5, 15.7, 15.9, 16.1, 16.3, 16.5, 16.4, 16.1, 15.9, 15.6, 15.4, 15.2, 14.9, 14.7, 14.4,
    14.2, 14.0, 13.7, 13.5, 13.2, 13.0, 12.8, 12.5, 12.3, 12.1, 11.8, 11.6, 11.4, 11.2, 10.9, 10.7, 10.5, 10.3, 10.0,
    9.8, 9.6, 9.4,
)  # fmt: skip
"""f_0 of radial and angular contact groove ball bearings at D_w cos(alpha) / D_pw = 0, 0.01 .. 0.40 (table 1)."""


def f_0(gamma: float) -> float:
    """Factor f_0 at gamma = D_w cos(alpha) / D_pw, linear between the printed values.

    Raises DynamicsInputError outside 0 to 0.4.
    """
    if not 0.0 <= gamma <= 0.4:
        raise DynamicsInputError(
            f"D_w cos(alpha) / D_pw = {gamma:.4g}: must lie within 0 to 0.4 (ISO 76 table 1); correct the size of "
            "the rolling elements"
        )
    index = min(int(gamma * 100.0), 39)
    return F_0[index] + (F_0[index + 1] - F_0[index]) * (gamma * 100.0 - index)


def C_0r_ball(Z: int, D_w: float, alpha: float, f0: float) -> float:
    """Static radial rating of one row of balls [N]: f_0 Z D_w^2 cos(alpha), alpha [rad]."""
    return f0 * Z * D_w**2 * math.cos(alpha)


def C_0r_roller(Z: int, D_we: float, L_we: float, D_pw: float, alpha: float) -> float:
    """Static radial rating of one row of rollers [N]: 44 (1 - D_we cos(alpha) / D_pw) Z L_we D_we cos(alpha)."""
    return 44.0 * (1.0 - D_we * math.cos(alpha) / D_pw) * Z * L_we * D_we * math.cos(alpha)
