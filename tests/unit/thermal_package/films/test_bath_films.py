"""Films in a dip-lubricated box: hand values, limits, warnings."""

import math

import pytest

from thermal.films.bath import (
    above_bath,
    dipped_face_film,
    dipped_rim_film,
    dipped_shaft_film,
    wetted_wall_film,
)
from thermal.films.convection import constant
from thermal.films.flank import FilmOil, ToothRing, Wetting, fling_off
from thermal.films.law import FilmError

OIL = FilmOil(
    conductivity=lambda _: 0.13,
    density=lambda _: 840.0,
    heat_capacity=lambda _: 2000.0,
    kinematic_viscosity=lambda _: 14e-6,
)
RING = ToothRing(
    root_radius=31.2e-3, tip_radius=41.2e-3, flank_area=5e-3, tooth_thickness=7e-3, conductivity=45.0
)
WALL, SUMP = 350.0, 363.15


def test_splashed_wall_is_a_constant_with_range_and_source() -> None:
    film = wetted_wall_film()(WALL, SUMP)
    assert film.value == 200.0
    assert film.warnings == ()
    assert "14179-2" in film.source
    assert "outside 100 to 300" in wetted_wall_film(500.0)(WALL, SUMP).warnings[0]
    with pytest.raises(FilmError, match="must be greater than 0"):
        wetted_wall_film(0.0)


def test_dipped_face_by_hand_and_limits() -> None:
    """Pr = 14e-6 x 1.68e6/0.13 = 180.9: Nu = 0.6205 x 5.656/(1 + 0.0527 + 0.0045) = 3.319; root(omega/nu) 4027 1/m."""
    film = dipped_face_film(227.0, 41e-3, 0.5, OIL)(WALL, SUMP)
    assert film.inputs["prandtl"] == pytest.approx(180.9, rel=1e-3)
    assert film.value == pytest.approx(0.5 * 3.319 * 0.13 * 4027.0, rel=1e-3)
    assert film.warnings == ()
    assert dipped_face_film(0.0, 41e-3, 0.5, OIL)(WALL, SUMP).value == 0.0
    assert dipped_face_film(227.0, 41e-3, 0.0, OIL)(WALL, SUMP).value == 0.0
    assert "Reynolds number of the face" in dipped_face_film(3000.0, 41e-3, 0.5, OIL)(WALL, SUMP).warnings[0]
    with pytest.raises(FilmError, match=r"wetted share of the face = 1\.2"):
        dipped_face_film(227.0, 41e-3, 1.2, OIL)


def test_dipped_shaft_by_hand_and_against_becker_in_water() -> None:
    """Re = 227 x 0.03^2/2/14e-6 = 7296: Nu = 0.0791 x 506.0 x 6.364; in water Becker's 0.133 Re^(2/3) Pr^(1/3)."""
    film = dipped_shaft_film(227.0, 30e-3, 0.5, OIL)(WALL, SUMP)
    assert film.value == pytest.approx(0.5 * 0.0791 * 506.0 * 6.364 * 0.13 / 30e-3, rel=1e-3)
    assert film.warnings == ()
    reynolds, prandtl = film.inputs["reynolds"], film.inputs["prandtl"]
    becker = 0.133 * reynolds ** (2.0 / 3.0) * prandtl ** (1.0 / 3.0) * 0.13 / 30e-3
    assert film.value == pytest.approx(0.5 * becker, rel=0.15)
    assert "Reynolds number of the shaft" in dipped_shaft_film(10.0, 30e-3, 0.5, OIL)(WALL, SUMP).warnings[0]
    with pytest.raises(FilmError, match=r"wetted share of the shaft = -0\.1"):
        dipped_shaft_film(227.0, 30e-3, -0.1, OIL)


def test_a_part_half_in_oil_has_air_on_its_other_half() -> None:
    wet, dry = dipped_face_film(227.0, 41e-3, 0.5, OIL), constant(30.0, "air")
    half = above_bath(wet, dry, 0.5)(WALL, SUMP)
    assert half.value == pytest.approx(wet(WALL, SUMP).value + 15.0)
    assert above_bath(wet, dry, 0.0)(WALL, SUMP).value == 30.0


def test_dipped_rim_is_one_flooding_a_turn() -> None:
    flow = 30e-3 / 60
    whole = dipped_rim_film(RING, 227.0, 20e-3, flow, OIL)(WALL, SUMP)
    assert whole == fling_off(RING, Wetting(speed=227.0, per_turn=1, flow=flow), OIL)(WALL, SUMP)
    half = dipped_rim_film(RING, 227.0, 0.5 * RING.height, flow, OIL)(WALL, SUMP)
    assert half.inputs["wetted_share"] == pytest.approx(0.5)
    assert 0.0 < half.value < whole.value
    assert dipped_rim_film(RING, 227.0, 0.0, flow, OIL)(WALL, SUMP).value == 0.0
    assert dipped_rim_film(RING, 0.0, 20e-3, flow, OIL)(WALL, SUMP).value == 0.0
    with pytest.raises(FilmError, match="immersion of the tooth tips"):
        dipped_rim_film(RING, 227.0, -math.inf, flow, OIL)
