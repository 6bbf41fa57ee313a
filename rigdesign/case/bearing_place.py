"""What surrounds a bearing, for the kinds of bearings of the case. SI units."""

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, kw_only=True)
class BearingPlace:
    """Place of a bearing at one iteration.

    clearance : on the diameter as it runs [m]; of a rolling bearing negative as preload
    lubrication : how its oil comes
    sump_level : of the oil at rest above the shaft axes [m]; None without a sump
    seat_factors : on the conductances to the seats on the shaft and in the housing
    """

    clearance: float
    lubrication: Literal["fed", "splash", "grease"]
    sump_level: float | None = None
    seat_factors: tuple[float, float] = (1.0, 1.0)


@dataclass(frozen=True, kw_only=True)
class BearingSeats:
    """Warm seats of a bearing.

    bore_less_journal : thermal expansion of the diameter of the bore less that of the journal [m]
    spin : expansion of the journal diameter by rotation [m]
    shaft, bearing, housing : temperatures of the seats and of the bearing between them [K]
    shaft_expansion, housing_expansion : coefficients of linear expansion [1/K]
    shaft_bore : of a hollow shaft [m]
    """

    bore_less_journal: float
    spin: float
    shaft: float
    bearing: float
    housing: float
    shaft_expansion: float
    housing_expansion: float
    shaft_bore: float = 0.0
