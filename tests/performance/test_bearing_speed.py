"""Time of one state of a rolling bearing with its heat, against a journal bearing.

Times are processor times of one thread; a figure that is missed is printed, not failed. Run with
``pytest -m performance -s tests/performance/test_bearing_speed.py``.
"""

from time import process_time

import pytest

from dynamics.rotor.bearing import Bearing, BearingOperation, OilSupply
from dynamics.rotor.journal import JournalBearing
from dynamics.rotor.rolling import RollingBearing
from dynamics.rotor.rolling_catalogue import catalogue_bearing

pytestmark = pytest.mark.performance

STATES = 200
WANTED = 2e-3
"""Seconds a state."""
INLET = 343.15


def operation(axial_load: float) -> BearingOperation:
    """2 kN radial, 3000 rpm, oil of 11 mm2/s."""
    oil = OilSupply(
        inlet_temperature=INLET,
        flow=1e-5,
        viscosity=lambda temperature: 11e-6 * (INLET / temperature) ** 9,
        density=850.0,
        heat_capacity=2000.0,
    )
    return BearingOperation(
        load=2000.0,
        speed=314.16,
        oil=oil,
        axial_load=axial_load,
        shaft_temperature=345.0,
        housing_temperature=340.0,
    )


def time_of_a_state(bearing: Bearing, point: BearingOperation) -> float:
    """Seconds."""
    bearing.operating_state(point)
    start = process_time()
    for _ in range(STATES):
        bearing.operating_state(point)
    return (process_time() - start) / STATES


def test_one_state_of_a_taper_roller_bearing() -> None:
    rolling = time_of_a_state(RollingBearing(data=catalogue_bearing("30208")), operation(axial_load=1500.0))
    journal = time_of_a_state(
        JournalBearing(diameter=0.06, width=0.03, diametral_clearance=90e-6), operation(axial_load=0.0)
    )
    print(
        f"\nstate of a 30208 with its heat {rolling * 1e3:.2f} ms (wanted {WANTED * 1e3:.0f} ms), "
        f"{rolling / journal:.1f} times that of a journal bearing ({journal * 1e3:.2f} ms)"
    )
