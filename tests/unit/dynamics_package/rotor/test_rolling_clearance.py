"""Radial internal clearance changed by fits and temperatures."""

import math

import pytest

from dynamics.rotor.bearing import BearingError
from dynamics.rotor.rolling_catalogue import catalogue_bearing
from dynamics.rotor.rolling_clearance import (
    REFERENCE_TEMPERATURE,
    RING,
    Fit,
    RingTemperatures,
    SeatMaterial,
    class_clearance,
    inner_raceway_expansion,
    operating_clearance,
    outer_raceway_contraction,
)

BEARING = catalogue_bearing("6208")
STEEL = SeatMaterial(expansion=RING.expansion)


@pytest.mark.parametrize("shaft_bore", [0.0, 0.02, 0.03])
def test_inner_raceway_by_the_one_material_formula(shaft_bore: float) -> None:
    """NSK 15.2 (1): k (1 - k_0^2) / (1 - k^2 k_0^2)."""
    bore, race = 0.04, 0.048
    k, k_0 = bore / race, shaft_bore / bore
    share = k * (1.0 - k_0**2) / (1.0 - k**2 * k_0**2)
    assert inner_raceway_expansion(10e-6, bore, race, Fit(shaft_bore=shaft_bore)) == pytest.approx(
        10e-6 * share
    )


@pytest.mark.parametrize("outside", [0.1, 0.2, math.inf])
def test_outer_raceway_by_the_one_material_formula(outside: float) -> None:
    """NSK 15.2 (1): h (1 - h_0^2) / (1 - h^2 h_0^2)."""
    race, seat = 0.072, 0.08
    h, h_0 = race / seat, seat / outside
    share = h * (1.0 - h_0**2) / (1.0 - h**2 * h_0**2)
    assert outer_raceway_contraction(10e-6, seat, race, Fit(housing_outside=outside)) == pytest.approx(
        10e-6 * share
    )


def test_seven_to_nine_tenths_of_the_interference_reach_the_raceway() -> None:
    """The rule of the NSK catalogue (p. 90), for solid shafts."""
    for designation in ("6208", "6309", "NU 208", "30208"):
        bearing = catalogue_bearing(designation)
        found = operating_clearance(bearing, 20e-6, Fit(shaft_interference=10e-6))
        assert 0.7 < found.fit_inner / 10e-6 < 0.9


def test_aluminium_housing_lets_go_when_hot() -> None:
    fit = Fit(
        housing_interference=20e-6,
        housing_outside=0.12,
        housing=SeatMaterial(young_modulus=7e10, poisson_ratio=0.33, expansion=23e-6),
    )
    cold = operating_clearance(BEARING, 20e-6, fit)
    hot = operating_clearance(
        BEARING, 20e-6, fit,
        RingTemperatures(shaft=363.15, inner_ring=363.15, elements=363.15, outer_ring=363.15, housing=363.15),
    )  # fmt: skip
    assert cold.fit_outer > 0.0
    assert hot.housing_interference == 0.0
    assert hot.fit_outer == 0.0
    assert hot.clearance > cold.clearance


def test_one_temperature_of_one_material_changes_next_to_nothing() -> None:
    temperature = 373.15
    found = operating_clearance(
        BEARING, 20e-6, Fit(shaft=STEEL, housing=STEEL),
        RingTemperatures(
            shaft=temperature, inner_ring=temperature, elements=temperature, outer_ring=temperature, housing=temperature
        ),
    )  # fmt: skip
    assert found.thermal == pytest.approx(0.0, abs=1e-12)
    assert found.clearance == pytest.approx(20e-6)


def test_warm_inner_ring_by_hand() -> None:
    """Inner ring and balls 10 K warmer: alpha 10 K (D_i + 2 D_w) = alpha 10 K D_e (NSK equation 9.6)."""
    warm = REFERENCE_TEMPERATURE + 10.0
    found = operating_clearance(
        BEARING, 20e-6, Fit(shaft=STEEL), RingTemperatures(shaft=warm, inner_ring=warm, elements=warm)
    )
    assert 20e-6 - found.clearance == pytest.approx(12.5e-6 * 10.0 * BEARING.elements.outer_raceway, rel=1e-9)


def test_clearance_class_of_a_6208() -> None:
    assert class_clearance(BEARING, "CN") == pytest.approx((6e-6, 20e-6))


def test_impossible_seats_are_refused() -> None:
    with pytest.raises(BearingError, match=r"shaft_bore = 0\.05 m: must lie between 0 and the bore"):
        operating_clearance(BEARING, 0.0, Fit(shaft_bore=0.05))
    with pytest.raises(BearingError, match=r"housing_outside = 0\.08 m: must be above"):
        operating_clearance(BEARING, 0.0, Fit(housing_outside=0.08))
