"""Forced air along a wall and ribs on it: hand values, limits, monotonicity, refusals."""

import math

import numpy as np
import pytest
from scipy.linalg import solve_banded

from thermal.films import convection
from thermal.films.convection import RibArray
from thermal.films.law import FilmError
from thermal.films.still import air

WALL, ROOM = 353.15, 293.15
CAST_IRON = 50.0
RIBS = RibArray(height=0.03, thickness=0.006, pitch=0.03)


def test_a_fan_of_three_metres_a_second_by_hand() -> None:
    """Air at 50 degC: Re = 3 x 0.5/1.798e-5 = 83.4e3, laminar part 9.5 and turbulent part 15.0 W/(m2 K)."""
    film = convection.forced_air_plate(3.0, 0.5, 0.3)(WALL, ROOM)
    gas = air(323.15)
    reynolds = 3.0 * 0.5 / 1.798e-5
    laminar = 0.664 * math.sqrt(reynolds) * 0.704 ** (1 / 3)
    turbulent = 0.037 * reynolds**0.8 * 0.704 / (1 + 2.443 * reynolds**-0.1 * (0.704 ** (2 / 3) - 1))
    assert film.inputs["reynolds"] == pytest.approx(reynolds, rel=0.01)
    assert film.inputs["forced"] == pytest.approx(math.hypot(laminar, turbulent) * 0.0278 / 0.5, rel=0.02)
    assert film.inputs["free"] == convection.vertical_plate_churchill(0.3)(WALL, ROOM).value
    assert film.value**3 == pytest.approx(film.inputs["forced"] ** 3 + film.inputs["free"] ** 3)
    assert gas.prandtl == pytest.approx(0.704, rel=0.01)


def test_still_air_leaves_the_free_film_and_a_gale_the_forced_one() -> None:
    free = convection.vertical_plate_churchill(0.3)(WALL, ROOM)
    assert convection.forced_air_plate(0.0, 0.5, 0.3)(WALL, ROOM).value == pytest.approx(free.value)
    gale = convection.forced_air_plate(30.0, 0.5, 0.3)(WALL, ROOM)
    assert gale.value == pytest.approx(gale.inputs["forced"], rel=1e-3)


def test_the_film_grows_with_the_velocity_and_falls_with_the_length() -> None:
    speeds = [
        convection.forced_air_plate(v, 0.5, 0.3)(WALL, ROOM).value for v in np.geomspace(0.01, 30.0, 12)
    ]
    lengths = [convection.forced_air_plate(5.0, x, 0.3)(WALL, ROOM).value for x in np.linspace(0.05, 2.0, 8)]
    assert np.all(np.diff(speeds) > 0.0)
    assert np.all(np.diff(lengths) < 0.0)


def test_a_stream_beyond_the_correlation_is_said() -> None:
    (warning,) = convection.forced_air_plate(400.0, 1.0, 0.3)(WALL, ROOM).warnings
    assert "Reynolds number of the air stream" in warning


def test_ribs_of_metal_without_resistance_count_with_their_whole_area() -> None:
    """Gap 24 mm and two sides of 30 mm plus the tip of 6 mm on each pitch of 30 mm: ratio 3."""
    assert RIBS.factor(10.0, 1e9) == pytest.approx((24 + 60 + 6) / 30, rel=1e-6)
    assert RIBS.factor(0.0, CAST_IRON) == pytest.approx((24 + 60 + 6) / 30)


def test_a_rib_by_the_fin_equation_integrated() -> None:
    """theta'' = m^2 theta between wall (1) and insulated tip, by finite differences: heat into the foot."""
    film, n = 40.0, 4000
    long = 0.03 + 0.003
    step = long / n
    m2 = 2 * film / (CAST_IRON * 0.006)
    main = np.full(n, 2.0 + m2 * step**2)
    main[-1] = 1.0 + 0.5 * m2 * step**2
    bands = np.vstack([np.r_[0.0, np.full(n - 1, -1.0)], main, np.r_[np.full(n - 1, -1.0), 0.0]])
    theta = solve_banded((1, 1), bands, np.r_[1.0, np.zeros(n - 1)])
    mean = (0.5 + theta[:-1].sum() + 0.5 * theta[-1]) * step / long
    assert RIBS.efficiency(film, CAST_IRON) == pytest.approx(mean, rel=1e-5)


def test_a_ribbed_film_refers_to_the_bare_wall() -> None:
    bare = convection.vertical_plate_churchill(0.3)
    film = convection.ribbed(bare, RIBS, CAST_IRON)(WALL, ROOM)
    assert film.value == pytest.approx(bare(WALL, ROOM).value * film.inputs["rib_factor"])
    assert 0.95 * 3.0 < film.inputs["rib_factor"] < 3.0
    assert film.warnings == ()
    assert "Incropera" in film.source


def test_what_ribs_do_not_do_is_said() -> None:
    radiating = convection.ribbed(convection.niemann_winter(0.3), RIBS, CAST_IRON)(WALL, ROOM)
    assert any("contains radiation" in text for text in radiating.warnings)
    narrow = RibArray(height=0.03, thickness=0.006, pitch=0.009)
    close = convection.ribbed(convection.vertical_plate_churchill(0.3), narrow, CAST_IRON)(WALL, ROOM)
    assert any("gap between ribs = 0.003 m" in text for text in close.warnings)


def test_impossible_ribs_and_streams_are_refused() -> None:
    with pytest.raises(FilmError, match=r"thickness = 0\.02 m must be below the pitch"):
        RibArray(height=0.03, thickness=0.02, pitch=0.02)
    with pytest.raises(FilmError, match=r"rib height = 0\.0 m must be greater"):
        RibArray(height=0.0, thickness=0.02, pitch=0.03)
    with pytest.raises(FilmError, match="air velocity = -1"):
        convection.forced_air_plate(-1.0, 0.3, 0.3)
