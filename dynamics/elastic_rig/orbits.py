"""Ellipse of a lateral motion that repeats once a period."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, kw_only=True)
class Orbit:
    """Ellipse of a lateral motion: half axes [m], the minor negative for backward whirl; angle of the major [rad]."""

    major: float
    minor: float
    angle: float


def orbit(across: complex, up: complex, sense: float = 1.0) -> Orbit:
    """Ellipse of u_y = Re(across e^{iwt}), u_z = Re(up e^{iwt}) on a shaft that turns about ``sense`` x."""
    forward = 0.5 * (across + 1j * sense * up)
    backward = 0.5 * np.conj(across - 1j * sense * up)
    angle = sense * 0.5 * (np.angle(forward) + np.angle(backward))
    return Orbit(
        major=float(abs(forward) + abs(backward)),
        minor=float(abs(forward) - abs(backward)),
        angle=float(angle),
    )
