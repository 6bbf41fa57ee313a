"""Series of the properties of air against the equation of state they were fitted to."""

import numpy as np
import pytest

from thermal.air import HIGHEST, LOWEST, AirRangeError, air, air_by_equation_of_state

PROPERTIES = ("density", "specific_heat", "conductivity", "viscosity")


@pytest.mark.parametrize("name", PROPERTIES)
def test_series_reproduce_the_equation_of_state(name: str) -> None:
    """A kink of 1.5e-7 in the conductivity, where its critical enhancement is cut off, is all they miss."""
    for temperature in np.linspace(LOWEST, HIGHEST, 173):
        exact = getattr(air_by_equation_of_state(float(temperature)), name)
        assert getattr(air(float(temperature)), name) == pytest.approx(exact, rel=2e-7)


def test_room_air_is_that_of_the_tables() -> None:
    """VDI Heat Atlas, D2.2, dry air at 1 bar and 20 degC, scaled to one atmosphere."""
    found = air(293.15)
    assert found.density == pytest.approx(1.1884 * 1.01325, rel=1e-3)
    assert found.specific_heat == pytest.approx(1006.4, rel=1e-3)
    assert found.conductivity == pytest.approx(0.02587, rel=1e-2)
    assert found.viscosity == pytest.approx(18.205e-6, rel=5e-3)


@pytest.mark.parametrize("temperature", [199.9, 1000.1, float("nan")])
def test_outside_the_range_both_refuse(temperature: float) -> None:
    for properties in (air, air_by_equation_of_state):
        with pytest.raises(AirRangeError, match="200 to 1000 K"):
            properties(temperature)
