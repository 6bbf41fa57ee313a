"""Two rollers in the same contact, elements and penalty as the teeth: line contact against Hertz."""

from dataclasses import dataclass
from math import asin, ceil, pi, sqrt
from pathlib import Path

import numpy as np

from tests.reference.tooth_contact.deck import PENALTY, STEEL, ContactPair, PlaneModel, solve
from tests.reference.tooth_contact.section import Piece, PlaneMesh, plane_mesh


@dataclass(frozen=True, kw_only=True)
class LineContact:
    """Half width [mm] and largest pressure [N/mm2] of rollers of radii [mm] under a line load [N/mm]."""

    radii: tuple[float, float]
    line_load: float

    @property
    def half_width(self) -> float:
        """Hertz: b = sqrt(4 F' rho / (pi E*))."""
        radius = self.radii[0] * self.radii[1] / sum(self.radii)
        modulus = STEEL[0] / (2.0 * (1.0 - STEEL[1] ** 2))
        return sqrt(4.0 * self.line_load * radius / (pi * modulus))

    @property
    def pressure(self) -> float:
        """Hertz: p = 2 F' / (pi b)."""
        return 2.0 * self.line_load / (pi * self.half_width)


def solve_rollers(
    contact: LineContact, edge: float, folder: Path, *, thickness: float = 1.0, penalty: float = PENALTY
) -> tuple[float, float]:
    """Half width [mm] (touching nodes) and largest pressure [N/mm2] with edges of length ``edge`` [mm] in contact."""
    bodies = [
        _half_disc(contact.radii[0], edge, 4.0 * contact.half_width, upper=True),
        _half_disc(contact.radii[1], edge, 4.0 * contact.half_width, upper=False),
    ]
    model = PlaneModel(
        bodies=bodies,
        thickness=thickness,
        pairs=[ContactPair(name="R", slave=(0, ("touch",)), master=(1, ("touch",)))],
        driven=(0, "flat"),
        held=(1, "flat"),
        lever=None,
        penalty=penalty,
    )
    result = solve(
        model,
        folder,
        first=[0.2 * contact.half_width**2 / min(contact.radii)],
        force=contact.line_load * thickness,
    )
    line = bodies[0].lines["touch"]
    touching = line[result.pressure_at[line] > 0.02 * contact.pressure]
    x = bodies[0].points[touching, 0]
    return float(np.ptp(x)) / 2.0, result.pressure["R"]


def _half_disc(radius: float, edge: float, reach: float, *, upper: bool) -> PlaneMesh:
    """Half disc whose round side touches the x axis in the origin, with its flat side a radius away."""
    half = asin(reach / radius)
    sign = 1.0 if upper else -1.0

    def arc(start: float, end: float):
        def curve(t):
            angle = start + t * (end - start)
            return np.column_stack([radius * np.sin(angle), sign * radius * (1.0 - np.cos(angle))])

        return curve

    def flat(t):
        return np.column_stack([radius * (1.0 - 2.0 * t), np.full(len(t), sign * radius)])

    n = ceil(2.0 * reach / edge)
    growing = np.cumsum(np.concatenate([[0.0], edge * 1.12 ** np.arange(200)]))
    length = radius * (0.5 * pi - half)
    places = growing[growing < length]
    places = np.append(places[:-1], length) / length
    pieces = [
        Piece(arc(-0.5 * pi, -half), 1.0 - places[::-1], "side"),
        Piece(arc(-half, half), np.linspace(0.0, 1.0, n + 1), "touch"),
        Piece(arc(half, 0.5 * pi), places, "other"),
        Piece(flat, np.linspace(0.0, 1.0, 21), "flat"),
    ]
    return plane_mesh([pieces])
