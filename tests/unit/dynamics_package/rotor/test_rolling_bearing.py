"""Rolling bearing behind the bearing protocol: friction, heat balance, life, warnings."""

import math
import re
from dataclasses import replace
from itertools import pairwise

import pytest

from dynamics.rotor.bearing import (
    Bearing,
    BearingError,
    BearingNotConvergedError,
    BearingOperation,
    BearingState,
    OilSupply,
)
from dynamics.rotor.journal import JournalBearing
from dynamics.rotor.rolling import RollingBearing, SeatConductances, shaft_path
from dynamics.rotor.rolling_catalogue import catalogue_bearing
from dynamics.rotor.rolling_friction import LAWS, FrictionLaw
from dynamics.rotor.rolling_state import RollingState

RPM = math.pi / 30.0
DENSITY, HEAT_CAPACITY, INLET = 860.0, 2000.0, 343.15


def viscosity(temperature: float) -> float:
    """VG 68 mineral oil: 68 and 8.7 mm2/s at 40 and 100 degC, Ubbelohde-Walther."""
    low, high = (math.log10(math.log10(value + 0.7)) for value in (68.0, 8.7))
    slope = (low - high) / (math.log10(373.15) - math.log10(313.15))
    inner = low - slope * (math.log10(temperature) - math.log10(313.15))
    return (10.0 ** (10.0**inner) - 0.7) * 1e-6 * DENSITY


def oil(flow: float = 0.6) -> OilSupply:
    """``flow`` in l/min."""
    return OilSupply(
        inlet_temperature=INLET,
        flow=flow / 6e4,
        viscosity=viscosity,
        density=DENSITY,
        heat_capacity=HEAT_CAPACITY,
    )


def operation(
    load: float = 2000.0, rpm: float = 3000.0, flow: float = 0.6, **more: float
) -> BearingOperation:
    given = {"shaft_temperature": 345.0, "housing_temperature": 340.0} | more
    return BearingOperation(load=load, speed=rpm * RPM, oil=oil(flow), **given)


def bearing(designation: str = "6208", **more: object) -> RollingBearing:
    return RollingBearing(data=catalogue_bearing(designation), **more)


def isothermal(designation: str, law: FrictionLaw, load: float, axial: float = 0.0) -> RollingState:
    """At 70 degC: oil in plenty."""
    plenty = operation(load, axial_load=axial, flow=1e6, shaft_temperature=INLET, housing_temperature=INLET)
    return bearing(designation, law=law).operating_state(plenty)


def test_it_is_a_bearing() -> None:
    kind: Bearing = bearing()
    state: BearingState = kind.operating_state(operation())
    assert state.drag_torque > 0.0
    assert state.specific_load is None
    assert state.transition_speed is None


def test_torque_of_a_6208_by_both_laws_by_hand() -> None:
    """2 kN, 3000 rpm, VG 68 at 70 degC, oil to the middle of the lowest ball."""
    nu = viscosity(INLET) / DENSITY * 1e6
    palmgren = isothermal("6208", "iso_tr_14179_2", 2000.0)
    assert palmgren.friction.drag == pytest.approx(
        1e-10 * 2.0 * (nu * 3000.0) ** (2.0 / 3.0) * 60.0**3, rel=1e-6
    )
    f_1 = 0.00089 * math.sqrt(2000.0 / 19000.0)
    assert palmgren.friction.rolling == pytest.approx(1e-3 * f_1 * 2000.0 * 60.0, rel=1e-6)
    skf = isothermal("6208", "skf", 2000.0)
    shear = 1.0 / (1.0 + 1.84e-9 * (3000.0 * 60.0) ** 1.28 * nu**0.64)
    rolling = shear * 3.9e-7 * 60.0**1.96 * 2000.0**0.54 * (nu * 3000.0) ** 0.6
    assert skf.friction.rolling == pytest.approx(1e-3 * rolling, rel=1e-6)
    sliding = 3.23e-3 * 60.0**-0.26 * 2000.0 ** (5.0 / 3.0)
    weight = math.exp(-2.6e-8 * (3000.0 * nu) ** 1.4 * 60.0)
    assert skf.friction.sliding == pytest.approx(
        1e-3 * sliding * (0.15 * weight + 0.05 * (1.0 - weight)), rel=1e-6
    )


@pytest.mark.parametrize(("designation", "constant"), [("6208", 0.0015), ("NU 208", 0.0011)])
@pytest.mark.parametrize("law", LAWS)
def test_order_of_magnitude_of_the_constant_friction_coefficient(
    designation: str, constant: float, law: FrictionLaw
) -> None:
    """SKF 6000 table 1: M = 0.5 mu P d holds at P = 0.1 C, good lubrication, ordinary speed: within a factor of two."""
    load = 0.1 * catalogue_bearing(designation).dynamic_rating
    found = isothermal(designation, law, load).drag_torque
    assert 0.5 < found / (0.5 * constant * load * 0.04) < 2.0


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("designation", ["6208", "NJ 208", "30208", "7208 B"])
def test_friction_grows_with_radial_and_axial_load(designation: str, law: FrictionLaw) -> None:
    radial = [isothermal(designation, law, load, 500.0).drag_torque for load in (500.0, 2000.0, 8000.0)]
    axial = [isothermal(designation, law, 2000.0, load).drag_torque for load in (0.0, 900.0, 4000.0)]
    assert all(low <= high for low, high in (*pairwise(radial), *pairwise(axial)))
    assert radial[0] < radial[-1]


@pytest.mark.parametrize("law", LAWS)
def test_rest_makes_no_heat(law: FrictionLaw) -> None:
    state = bearing(law=law).operating_state(operation(rpm=0.0))
    assert state.power == 0.0
    assert state.torsional_damping == 0.0
    assert state.drag_torque > 0.0
    assert state.life.basic_life == math.inf


@pytest.mark.parametrize("law", LAWS)
def test_idle_bearing_drags_only_in_its_oil(law: FrictionLaw) -> None:
    state = bearing(law=law).operating_state(operation(load=0.0))
    assert state.friction.rolling == state.friction.sliding == 0.0
    assert state.friction.drag == state.drag_torque > 0.0
    assert state.life.modified_life == math.inf


def test_direction_of_rotation_does_not_matter() -> None:
    forward, backward = (bearing().operating_state(operation(rpm=sign * 3000.0)) for sign in (1.0, -1.0))
    assert forward == backward


@pytest.mark.parametrize(
    ("lubrication", "flow"), [("oil_bath", 0.6), ("oil_jet", 2.0), ("oil_spot", 0.01), ("grease", 0.0)]
)
def test_heat_goes_where_it_can(lubrication: str, flow: float) -> None:
    state = bearing(lubrication=lubrication).operating_state(operation(flow=flow, heat_from_bodies=3.0))
    oil_heat = state.capacity_rate * (state.outlet_temperature - INLET)
    assert state.power + 3.0 == pytest.approx(
        oil_heat + state.heat_to_shaft + state.heat_to_housing, rel=1e-8
    )
    assert state.power + state.heat_from_bodies == pytest.approx(oil_heat, abs=1e-6)
    assert state.heat_to_shaft == pytest.approx(state.shaft_conductance * (state.film_temperature - 345.0))


def test_grease_gives_all_heat_to_the_seats_and_drags_nothing() -> None:
    state = bearing(lubrication="grease").operating_state(operation(flow=0.0))
    assert state.friction.drag == 0.0
    assert state.heat_to_shaft + state.heat_to_housing == pytest.approx(state.power)
    only_shaft = bearing(lubrication="grease").operating_state(
        BearingOperation(load=2000.0, speed=3000.0 * RPM, oil=oil(0.0), shaft_temperature=345.0)
    )
    assert only_shaft.heat_to_shaft == pytest.approx(only_shaft.power)
    assert only_shaft.housing_conductance == 0.0
    assert only_shaft.outer_ring_temperature == only_shaft.film_temperature


def test_starvation_lowers_rolling_friction_without_a_bath() -> None:
    bath, grease = (
        bearing(lubrication=kind).operating_state(operation(rpm=9000.0)).friction
        for kind in ("oil_bath", "grease")
    )
    low_bath = bearing(oil_level=1e-3).operating_state(operation(rpm=9000.0)).friction
    assert grease.rolling < low_bath.rolling < bath.rolling
    assert low_bath.drag < bath.drag


def test_rings_stand_between_bearing_and_seats() -> None:
    state = bearing().operating_state(operation(shaft_temperature=330.0, housing_temperature=320.0))
    assert 330.0 < state.inner_ring_temperature < state.film_temperature
    assert 320.0 < state.outer_ring_temperature < state.film_temperature
    path = shaft_path(bearing().data)
    assert path.conductance == pytest.approx(1.0 / (path.film + path.ring + path.joint))


def test_given_conductances_take_the_place_of_the_default_ones() -> None:
    closed = bearing(seats=SeatConductances(shaft=0.0, housing=0.0)).operating_state(operation())
    assert closed.heat_from_bodies == 0.0
    rise = closed.power / closed.capacity_rate
    assert closed.outlet_temperature - INLET == pytest.approx(rise)


def test_measured_friction_heat_takes_part_only_in_the_heat() -> None:
    own, measured = (bearing().operating_state(operation(**more)) for more in ({}, {"friction_heat": 500.0}))
    assert measured.film_temperature > own.film_temperature + 10.0
    assert measured.drag_torque < own.drag_torque
    none = bearing().operating_state(operation(friction_factor=0.0))
    assert none.drag_torque == 0.0


def test_seals_add_their_torque() -> None:
    open_bearing, sealed = (
        bearing(seal_torque=torque).operating_state(operation()) for torque in (0.0, 0.05)
    )
    assert sealed.friction.seals == 0.05
    assert sealed.power > open_bearing.power


def test_equivalent_loads_by_kind() -> None:
    """X, Y, e of the catalogue chapters."""
    ball = catalogue_bearing("6208")
    axial = 0.689 * 19000.0 / 14.0
    assert ball.rules.equivalent_load(ball, 1000.0, axial) == pytest.approx(0.56 * 1000.0 + 1.71 * axial)
    assert ball.rules.equivalent_load(ball, 10000.0, axial) == 10000.0
    assert ball.rules.static_equivalent_load(ball, 1000.0, 4000.0) == pytest.approx(2600.0)
    roller = catalogue_bearing("NJ 208")
    assert roller.rules.equivalent_load(roller, 1000.0, 150.0) == 1000.0
    assert roller.rules.equivalent_load(roller, 1000.0, 400.0) == pytest.approx(920.0 + 240.0)
    taper = catalogue_bearing("30208")
    assert taper.rules.equivalent_load(taper, 1000.0, 1000.0) == pytest.approx(400.0 + 1600.0)
    assert taper.rules.static_equivalent_load(taper, 1000.0, 1000.0) == pytest.approx(500.0 + 900.0)
    assert taper.rules.induced_axial_load(taper, 3200.0) == pytest.approx(1000.0)
    angular = catalogue_bearing("7208 B")
    assert angular.rules.equivalent_load(angular, 1000.0, 2000.0) == pytest.approx(350.0 + 1140.0)


def test_life_of_the_printed_6309() -> None:
    """SKF 6000 p. 78 by ISO 281: 940 h; kappa and a_ISO by the formula instead of the diagram of the make."""
    oil_of_20 = OilSupply(
        inlet_temperature=INLET,
        flow=1.0,
        viscosity=lambda _: 20e-6 * DENSITY,
        density=DENSITY,
        heat_capacity=2000.0,
    )
    state = bearing("6309", contamination=0.8).operating_state(
        BearingOperation(load=10e3, speed=3000.0 * RPM, oil=oil_of_20)
    )
    assert state.life.basic_life == pytest.approx(940.0, rel=2e-3)
    assert state.life.viscosity_ratio == pytest.approx(20.0 / (4500.0 / math.sqrt(3000.0 * 72.5)))
    assert state.life.modified_life == pytest.approx(state.life.life_modification * state.life.basic_life)
    assert 4.0 < state.life.life_modification < 5.5
    assert state.load_utilisation == pytest.approx(10.0 / 55.3)
    assert state.life.static_safety == pytest.approx(3.15)


def test_minimum_loads_by_hand() -> None:
    ball, roller, taper = (catalogue_bearing(name) for name in ("6208", "NU 208", "30208"))
    assert ball.rules.minimum_load(ball, 3000.0 * RPM, 20e-6) == pytest.approx(
        25.0 * 60.0 ** (2.0 / 3.0) * 0.36
    )
    assert roller.rules.minimum_load(roller, 9500.0 * RPM, 20e-6) == pytest.approx(150.0 * 10.0 * 0.36)
    assert taper.rules.minimum_load(taper, 0.0, 20e-6) == pytest.approx(0.02 * 61600.0)


@pytest.mark.parametrize(
    ("designation", "point", "warning"),
    [
        ("6208", {"rpm": 12000.0}, "speed = 12000 rpm: above the limiting speed 11000 rpm"),
        ("NU 208", {"rpm": 10000.0}, "speed = 10000 rpm: above the reference speed 9500 rpm"),
        ("NU 208", {"load": 100.0}, "radial load = 100 N: below the least load"),
        ("6208", {"load": 17000.0}, "equivalent load = 17000 N: above half the dynamic rating 16250 N"),
        ("6208", {"load": 20000.0}, "static safety = 0.95: below 1"),
        ("6208", {"rpm": 20.0}, "viscosity ratio = 0.0"),
        ("NJ 208", {"axial_load": 1500.0}, "axial load = 1500 N: above half the radial load 2000 N"),
        ("6208", {"axial_load": 10000.0}, "axial load = 10000 N: above half the static rating 19000 N"),
        ("30208", {"axial_load": 100.0}, "axial load = 100 N: below the"),
        ("6208", {"heat_from_bodies": 2000.0}, "degC: above 120 degC"),
    ],
)
def test_what_lies_outside_is_told(designation: str, point: dict[str, float], warning: str) -> None:
    state = bearing(designation).operating_state(operation(**point))
    assert any(warning in found for found in state.warnings), state.warnings


def test_the_law_that_knows_one_oil_level_says_so() -> None:
    low, high = (
        bearing(law="iso_tr_14179_2", lubrication="oil_bath", oil_level=level).operating_state(operation())
        for level in (None, 0.04)
    )
    assert low.friction.drag == pytest.approx(high.friction.drag, rel=1e-2)
    assert low.warnings == ()
    assert "oil level = 40.0 mm: ISO/TR 14179-2 has f_0" in high.warnings[0]


def test_a_bearing_within_its_limits_says_nothing() -> None:
    for designation in ("6208", "NU 208", "7208 B"):
        assert (
            bearing(designation)
            .operating_state(operation(axial_load=0.0 if "NU" in designation else 2600.0))
            .warnings
            == ()
        )


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"law": "coulomb"}, "law = 'coulomb': must be one of iso_tr_14179_2, skf"),
        ({"lubrication": "air"}, "lubrication = 'air': must be one of oil_bath"),
        ({"oil_level": 0.2}, "oil_level = 0.2 m: must lie within 0 to the outside diameter 0.08 m"),
        ({"contamination": 2.0}, "contamination = 2: must lie within 0 to 1"),
        ({"seal_torque": -1.0}, "seal_torque = -1 N m"),
    ],
)
def test_impossible_bearings_are_refused(more: dict[str, object], message: str) -> None:
    with pytest.raises(BearingError, match=re.escape(message)):
        bearing(**more)


def test_impossible_operations_are_refused() -> None:
    with pytest.raises(BearingError, match=r"axial_load = 10 N: its rings move past each other"):
        bearing("NU 208").operating_state(operation(axial_load=10.0))
    with pytest.raises(BearingError, match="nothing carries the friction heat"):
        bearing().operating_state(BearingOperation(load=1.0, speed=1.0, oil=oil(0.0)))
    with pytest.raises(BearingNotConvergedError, match=r"by more than \+400 K"):
        bearing().operating_state(operation(heat_from_bodies=1e6))
    with pytest.raises(BearingError, match=r"oil flow = -1.* must not be negative"):
        replace(oil(), flow=-1.0)
    with pytest.raises(BearingError, match="shaft_temperature = 0"):
        operation(shaft_temperature=0.0)
    with pytest.raises(BearingError, match="axial_load = -1"):
        operation(axial_load=-1.0)
    with pytest.raises(BearingError, match="seat conductance: shaft = -1"):
        SeatConductances(shaft=-1.0, housing=0.0)


def test_a_journal_bearing_still_needs_oil_and_carries_no_axial_load() -> None:
    journal = JournalBearing(diameter=0.06, width=0.03, diametral_clearance=90e-6)
    with pytest.raises(BearingError, match=r"oil flow = 0\.0 m3/s: must be above 0"):
        journal.operating_state(operation(flow=0.0))
    with pytest.raises(BearingError, match="axial_load = 5 N: a plain cylindrical bearing carries none"):
        journal.operating_state(operation(axial_load=5.0))
