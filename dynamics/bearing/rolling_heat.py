"""Heat paths of a rolling bearing from its oil and rolling elements to shaft and housing.

One node (rolling elements with their lubricant) is joined to each seat by three resistances in series: the raceway
film, the ring and the joint of the fit. Ring conduction is that of a cylinder; the two film coefficients are
assumptions for want of a formula that holds for all kinds and are to be replaced where the bearing was measured.
"""

import math
from dataclasses import dataclass

from dynamics.bearing.protocol import BearingError
from dynamics.bearing.rolling_catalogue import CatalogueBearing

RACEWAY_FILM = 1000.0
"""Rolling contacts and carried oil between rolling elements and raceway [W/(m2 K)], on the raceway area; assumed,
300 to 3000."""
SEAT_JOINT = 5000.0
"""Joint of ring and seat [W/(m2 K)]: ground steel, interference fit; assumed, 2000 (loose) to 20000."""
RING_CONDUCTIVITY = 46.0
"""Rolling bearing steel, hardened [W/(m K)]."""


@dataclass(frozen=True, kw_only=True)
class HeatPath:
    """Series of resistances from the rolling elements to one seat [K/W]."""

    film: float
    ring: float
    joint: float

    @property
    def conductance(self) -> float:
        """[W/K]."""
        return 1.0 / (self.film + self.ring + self.joint)

    @property
    def ring_share(self) -> float:
        """Share of the temperature difference between bearing and seat down to the middle of the ring [-]."""
        return (self.film + 0.5 * self.ring) / (self.film + self.ring + self.joint)


@dataclass(frozen=True, kw_only=True)
class SeatConductances:
    """Conductances between the bearing and its seats, measured or from a finer model; they replace the default ones.

    shaft, housing : [W/K], not negative

    Raises BearingError for a negative one.
    """

    shaft: float
    housing: float

    def __post_init__(self) -> None:
        for name in ("shaft", "housing"):
            value = getattr(self, name)
            if not (value >= 0.0 and math.isfinite(value)):
                raise BearingError(
                    f"seat conductance: {name} = {value:.6g} W/K: must be finite and not negative; 0 keeps the heat in"
                )


def shaft_path(bearing: CatalogueBearing) -> HeatPath:
    """Inner raceway, inner ring and its seat."""
    return _path(bearing.elements.inner_raceway, bearing.bore, bearing.width)


def housing_path(bearing: CatalogueBearing) -> HeatPath:
    """Outer raceway, outer ring and its seat."""
    return _path(bearing.elements.outer_raceway, bearing.outside_diameter, bearing.width)


def _path(raceway: float, seat: float, width: float) -> HeatPath:
    return HeatPath(
        film=1.0 / (RACEWAY_FILM * math.pi * raceway * width),
        ring=abs(math.log(raceway / seat)) / (2.0 * math.pi * RING_CONDUCTIVITY * width),
        joint=1.0 / (SEAT_JOINT * math.pi * seat * width),
    )
