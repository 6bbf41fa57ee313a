"""Rolling elements of a bearing: known, or derived from what catalogues print.

Catalogues give neither number nor size of the rolling elements. What is derived here gives the printed static rating
C_0 again by the formula of ISO 76, so that number, size and length fit each other; every other assumption is named in
`RollingElements.source`:

- pitch diameter: middle of bore and outside diameter, of both raceways where they are printed
- balls, deep groove: as many as a Conrad assembly takes (at most `FILLING_ANGLE` from first to last ball)
- balls, angular contact: as many as leave a tenth of the pitch circle for the cage
- rollers, cylindrical: diameter half of the difference of the printed raceways; `ROLLER_FILL` of the pitch circle
- rollers, tapered: mean diameter `TAPERED_ROLLER_SHARE` of D - d; `ROLLER_FILL` of the pitch circle filled
"""

import math
from dataclasses import dataclass

from scipy.optimize import brentq

from dynamics.bearing.protocol import BearingError
from dynamics.standards import iso76_2006

FILLING_ANGLE = math.radians(198.0)
"""Largest arc between the first and the last ball centre of a Conrad assembly [rad]; assumed. It gives the known ball
numbers of the series 62 and 63."""
BALL_FILL = 0.9
"""Share of the pitch circle filled with balls of an angular contact bearing; assumed."""
ROLLER_FILL = 0.82
"""Share of the pitch circle filled with rollers of a bearing with cage; assumed."""
TAPERED_ROLLER_SHARE = 0.24
"""Mean roller diameter over D - d of a tapered roller bearing; assumed."""
MOST_BALLS = 40


@dataclass(frozen=True, kw_only=True)
class RollingElements:
    """Rolling elements of one row.

    count : Z
    diameter : D_w, of a tapered roller in the middle of its length [m]
    pitch_diameter : D_pw [m]
    contact_angle : nominal [rad]
    length : effective length L_we of a roller, 0 for a ball [m]
    source : what they are known from

    Raises BearingError for sizes that do not fit into each other.
    """

    count: int
    diameter: float
    pitch_diameter: float
    contact_angle: float = 0.0
    length: float = 0.0
    source: str = "given"

    def __post_init__(self) -> None:
        if not self.count >= 3:
            raise BearingError(
                f"rolling elements: count = {self.count}: must be at least 3; give Z of one row"
            )
        if not 0.0 < self.diameter < self.pitch_diameter:
            raise BearingError(
                f"rolling elements: diameter = {self.diameter:.6g} m: must lie between 0 and the pitch diameter "
                f"{self.pitch_diameter:.6g} m; correct one of them"
            )
        if self.count * math.asin(self.diameter / self.pitch_diameter) > math.pi:
            raise BearingError(
                f"rolling elements: count = {self.count} of {self.diameter:.6g} m: do not fit on the pitch diameter "
                f"{self.pitch_diameter:.6g} m; give fewer or smaller ones"
            )
        if not 0.0 <= self.contact_angle < math.radians(60.0):
            raise BearingError(
                f"rolling elements: contact angle = {self.contact_angle:.4g} rad: must lie within 0 to 60 degrees "
                "(radial bearing)"
            )
        if self.length < 0.0:
            raise BearingError(
                f"rolling elements: length = {self.length:.6g} m: must not be negative; 0 is a ball"
            )

    @property
    def roller(self) -> bool:
        """Line contact; else point contact."""
        return self.length > 0.0

    @property
    def gamma(self) -> float:
        """D_w cos(alpha) / D_pw [-]."""
        return self.diameter * math.cos(self.contact_angle) / self.pitch_diameter

    @property
    def inner_raceway(self) -> float:
        """Mean diameter of the inner raceway [m]."""
        return self.pitch_diameter - self.diameter * math.cos(self.contact_angle)

    @property
    def outer_raceway(self) -> float:
        """Mean diameter of the outer raceway [m]."""
        return self.pitch_diameter + self.diameter * math.cos(self.contact_angle)


def deep_groove_balls(pitch_diameter: float, static_rating: float, f_0: float | None) -> RollingElements:
    """Balls of a deep groove ball bearing from C_0 [N] and the factor f_0 a catalogue prints, else that of ISO 76.

    Of all numbers of balls that give C_0 the largest that can be filled in.
    """
    best = None
    for count in range(5, MOST_BALLS):
        diameter = _ball_diameter(count, pitch_diameter, static_rating, 0.0, f_0)
        if diameter is None:
            continue
        arc = 2.0 * (count - 1) * math.asin(diameter / pitch_diameter)
        if arc <= FILLING_ANGLE:
            best = (count, diameter)
    if best is None:
        raise _no_balls(static_rating)
    return _balls(best, pitch_diameter, 0.0, "C_0 by ISO 76 and a filling angle of 198 degrees (assumed)")


def angular_contact_balls(
    pitch_diameter: float, static_rating: float, contact_angle: float
) -> RollingElements:
    """Balls of an angular contact ball bearing from C_0 [N] and its contact angle [rad]."""
    best = None
    for count in range(5, MOST_BALLS):
        diameter = _ball_diameter(count, pitch_diameter, static_rating, contact_angle, None)
        if diameter is not None and count * diameter <= BALL_FILL * math.pi * pitch_diameter:
            best = (count, diameter)
    if best is None:
        raise _no_balls(static_rating)
    return _balls(
        best,
        pitch_diameter,
        contact_angle,
        "C_0 by ISO 76 and nine tenths of the pitch circle filled (assumed)",
    )


def cylindrical_rollers(inner_raceway: float, outer_raceway: float, static_rating: float) -> RollingElements:
    """Rollers from the printed raceway diameters F, E [m] and C_0 [N]."""
    pitch, diameter = 0.5 * (inner_raceway + outer_raceway), 0.5 * (outer_raceway - inner_raceway)
    return _rollers(
        pitch, diameter, static_rating, 0.0,
        "raceways, C_0 by ISO 76 and 82 % of the pitch circle filled (assumed)",
    )  # fmt: skip


def tapered_rollers(
    bore: float, outside_diameter: float, static_rating: float, contact_angle: float
) -> RollingElements:
    """Rollers of a tapered roller bearing from its main dimensions [m], C_0 [N] and contact angle [rad]."""
    pitch, diameter = 0.5 * (bore + outside_diameter), TAPERED_ROLLER_SHARE * (outside_diameter - bore)
    return _rollers(
        pitch, diameter, static_rating, contact_angle,
        "C_0 by ISO 76, roller diameter 0.24 (D - d) and 82 % of the pitch circle filled (assumed)",
    )  # fmt: skip


def _ball_diameter(
    count: int, pitch: float, static_rating: float, angle: float, f_0: float | None
) -> float | None:
    """Diameter [m] at which ``count`` balls have the static rating; None where there is none."""

    def excess(diameter: float) -> float:
        factor = iso76_2006.f_0(diameter * math.cos(angle) / pitch) if f_0 is None else f_0
        return iso76_2006.C_0r_ball(count, diameter * 1e3, angle, factor) - static_rating

    smallest, largest = 1e-3 * pitch, 0.39 * pitch
    if excess(smallest) > 0.0 or excess(largest) < 0.0:
        return None
    root: float = brentq(excess, smallest, largest, xtol=1e-9)
    return root


def _no_balls(static_rating: float) -> BearingError:
    return BearingError(
        f"rolling elements: static_rating = {static_rating:.6g} N: no number of balls from 5 to {MOST_BALLS - 1} has "
        "it between bore and outside diameter; correct C_0, bore and outside diameter or give the rolling elements "
        "themselves"
    )


def _balls(best: tuple[int, float], pitch: float, angle: float, source: str) -> RollingElements:
    count, diameter = best
    return RollingElements(
        count=count, diameter=diameter, pitch_diameter=pitch, contact_angle=angle, source=source
    )


def _rollers(
    pitch: float, diameter: float, static_rating: float, angle: float, source: str
) -> RollingElements:
    count = int(ROLLER_FILL * math.pi * pitch / diameter)
    per_length = iso76_2006.C_0r_roller(count, diameter * 1e3, 1.0, pitch * 1e3, angle)
    return RollingElements(
        count=count,
        diameter=diameter,
        pitch_diameter=pitch,
        contact_angle=angle,
        length=1e-3 * static_rating / per_length,
        source=source,
    )
