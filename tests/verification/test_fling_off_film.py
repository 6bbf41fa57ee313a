"""The fling-off film against its energy equation, solved here.

Model: Blok and DeWinter (J. Eng. Ind. 96 (1974) 60): a film thinning under centrifugal force on a flank of one
temperature. Heights in sqrt(a t*), times in t* at the upper edge, x over the wetted height.
"""

from itertools import pairwise

import numpy as np
import pytest
from scipy.linalg import solve_banded
from scipy.special import erfc

from rigdesign.properties.oil import MIL_PRF_23699
from thermal.films.flank import FilmOil, ToothRing, Wetting, fling_off, heat_flung_off


def _diffusion(edges: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Second and first differences at the inner points of an uneven grid."""
    below, above = np.diff(edges)[:-1], np.diff(edges)[1:]
    both = below + above
    return (
        2.0 / (below * both),
        2.0 / (above * both),
        -above / (below * both),
        below / (above * both),
        (above - below) / (below * above),
    )


def _wall_slope(edges: np.ndarray, temperature: np.ndarray) -> float:
    a, b = np.diff(edges)[:2]
    return float(
        (2 * a + b) / (a * (a + b)) * temperature[0]
        - (a + b) / (a * b) * temperature[1]
        + a / (b * (a + b)) * temperature[2]
    )


def _step(edges, old, mass, inflow, diffusion, drift):  # type: ignore[no-untyped-def]
    """One implicit step: mass T - inflow = diffusion T'' - drift T'; wall 1, surface insulated."""
    lower, upper, left, right, centre = _diffusion(edges)
    n = len(edges) - 1
    low, mid, high, rhs = np.zeros(n + 1), np.zeros(n + 1), np.zeros(n + 1), np.zeros(n + 1)
    mid[0] = rhs[0] = 1.0
    inner = slice(1, n)
    low[inner] = -lower * diffusion + drift[inner] * left
    high[inner] = -upper * diffusion + drift[inner] * right
    mid[inner] = mass[inner] + (lower + upper) * diffusion + drift[inner] * centre
    rhs[inner] = inflow[inner]
    surface = 2.0 / np.diff(edges)[-1] ** 2 * diffusion
    low[n], mid[n], rhs[n] = -surface, mass[n] + surface, inflow[n]
    band = np.zeros((3, n + 1))
    band[0, 1:], band[1], band[2, :-1] = high[:-1], mid, low[1:]
    return solve_banded((1, 1), band, rhs)


def test_table_against_the_similar_energy_equation() -> None:
    edges = (np.exp(6.0 * np.linspace(0.0, 1.0, 401)) - 1.0) / (np.exp(6.0) - 1.0)
    times = np.geomspace(1e-3, 5.0, 3000)
    carried, drift = 1.0 - edges / 2.0 + edges**2 / 4.0, edges * (1.0 - edges) * (2.0 - edges) / 4.0
    temperature = erfc(edges / (2.0 * times[0]))
    heat, flux = 2.0 * np.sqrt(times[0] / np.pi), _wall_slope(edges, temperature) * np.sqrt(times[0])
    heats = [heat]
    for before, now in pairwise(times):
        mass = now * carried / (now - before)
        temperature = _step(edges, temperature, mass, mass * temperature, now**2, drift)
        previous, flux = flux, _wall_slope(edges, temperature) * np.sqrt(now)
        heat += 0.5 * (previous + flux) * (now - before)
        heats.append(heat)
    table = np.array([heat_flung_off(float(time)) for time in times])
    late = times > 0.1
    assert np.abs(table[late] / np.array(heats)[late] - 1.0).max() < 0.01
    assert np.abs(table / np.array(heats) - 1.0).max() < 0.02
    assert heats[-1] == pytest.approx(1.2267, rel=1e-3)


@pytest.mark.parametrize("laid", [0.5, 1.0])
def test_thin_films_against_the_energy_equation_in_two_dimensions(laid: float) -> None:
    """Film min(h_0, sqrt(x/t)) on the whole flank: the join of both limits is good to 6 %."""
    stations, layers, steps, end = 24, 40, 150, 3.0
    edges = (np.exp(4.0 * np.linspace(0.0, 1.0, layers + 1)) - 1.0) / (np.exp(4.0) - 1.0)
    places = (np.arange(stations) + 0.5) / stations
    times = np.concatenate([[0.0], np.geomspace(1e-4, end, steps)])
    field = np.zeros((stations, layers + 1))
    field[:, 0] = 1.0
    heat = 0.0
    for before, now in pairwise(times):
        step = now - before
        below = np.ones(layers + 1)
        for j, place in enumerate(places):
            thinned = place < laid**2 * now
            height = np.sqrt(place / now) if thinned else laid
            drift = edges * (1.0 - edges) * (2.0 - edges) / (4.0 * now) * thinned
            along = height**2 * (edges - edges**2 / 2.0) * stations
            along = along * (2.0 if thinned else 0.0) if j == 0 else along
            mass = 1.0 / step + along
            inflow = field[j] / step + along * below
            below = field[j] = _step(edges, field[j], mass, inflow, height**-2, drift)
            heat += _wall_slope(edges, below) / height * step / stations
    # the law with k = rho c = 1, a tooth 1 high on a large radius, one wetting every ``end``
    oil = FilmOil(
        conductivity=lambda _: 1.0,
        density=lambda _: 1.0,
        heat_capacity=lambda _: 1.0,
        kinematic_viscosity=lambda _: 1e6,
    )
    ring = ToothRing(
        root_radius=1e6, tip_radius=1e6 + 1.0, flank_area=1.0, tooth_thickness=1.0, conductivity=1.0
    )
    speed = 2.0 * np.pi / end
    film_time = 1.0 / speed  # t* at the tip; a turn is 2 pi of them: both films have taken all they can
    wetting = Wetting(speed=speed, per_turn=1, flow=laid * np.sqrt(film_time) / end)
    found = fling_off(ring, wetting, oil)(300.0, 300.0).value
    assert found * end / np.sqrt(film_time) == pytest.approx(heat, rel=0.06)


def test_size_for_an_ester_at_141_metres_a_second() -> None:
    """By hand at 175 degC film: a 7.0e-8 m2/s, nu 1.9e-6 m2/s, t* 1.3 ms, 9.4 um, 3.6 kW/(m2 K) when flooded."""
    oil = MIL_PRF_23699
    film = FilmOil(
        conductivity=oil.conductivity,
        density=oil.density,
        heat_capacity=oil.heat_capacity,
        kinematic_viscosity=oil.kinematic_viscosity,
    )
    ring = ToothRing(
        root_radius=0.10625, tip_radius=0.1175, flank_area=0.0506, tooth_thickness=0.0085, conductivity=42.0
    )
    found = fling_off(ring, Wetting(speed=1256.6, per_turn=1, flow=5.4e-4), film)(480.0, 415.0)
    assert found.value == pytest.approx(3600.0, rel=0.03)
    assert found.inputs["thickness_warmed"] == pytest.approx(9.4e-6, rel=0.02)
