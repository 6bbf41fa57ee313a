"""Rolling elements of one row: number, sizes and contact angle, given or as many as the static rating tells."""

import math
from dataclasses import dataclass

from dynamics.rotor.bearing import BearingError
from dynamics.standards import iso76_2006

ROLLER_FILL = 0.82
"""Share of the pitch circle filled with rollers of a bearing with cage; assumed."""


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
    def straight(self) -> bool:
        """Rollers without contact angle: they leave axial load to flanges, which have no stiffness here."""
        return self.roller and self.contact_angle == 0.0

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


def ball_diameter(
    count: int, pitch: float, static_rating: float, angle: float, f_0: float | None
) -> float | None:
    """Diameter [m] at which ``count`` balls have the static rating; None where there is none."""

    def excess(diameter: float) -> float:
        factor = iso76_2006.f_0(diameter * math.cos(angle) / pitch) if f_0 is None else f_0
        return iso76_2006.C_0r_ball(count, diameter * 1e3, angle, factor) - static_rating

    from scipy.optimize import brentq

    smallest, largest = 1e-3 * pitch, 0.39 * pitch
    if excess(smallest) > 0.0 or excess(largest) < 0.0:
        return None
    root: float = brentq(excess, smallest, largest, xtol=1e-9)
    return root


def rollers(
    pitch: float, diameter: float, static_rating: float, angle: float, source: str
) -> RollingElements:
    """Rollers of a diameter [m] that fill `ROLLER_FILL` of the pitch circle [m], as long as C_0 [N] makes them."""
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
