"""The bearing film against published solutions and the analytic limits."""

import math

import pytest

from dynamics.kernels.journal import short_bearing_load
from dynamics.rotor.journal_film import (
    characteristic,
    short_bearing_attitude,
    short_bearing_side_flow,
    solve_film,
)

# A. A. Raimondi, J. Boyd, A solution for the finite journal bearing III, ASLE Trans. 1 (1958), full bearing:
# L/D, eps, S = (r/c)^2 mu N / P, friction f r/c, attitude angle [deg], flow Q/(r c N L), share of side flow
RAIMONDI_BOYD = [
    (1.0, 0.2, 0.631, 12.8, 74.02, 3.59, 0.280),
    (1.0, 0.6, 0.121, 3.22, 50.58, 4.33, 0.680),
    (1.0, 0.8, 0.0446, 1.70, 36.24, 4.62, 0.842),
    (1.0, 0.9, 0.0188, 1.05, 26.45, 4.74, 0.919),
    (0.5, 0.2, 2.03, 40.9, 74.94, 3.72, 0.318),
    (0.5, 0.6, 0.319, 8.10, 48.14, 4.85, 0.730),
    (0.5, 0.8, 0.0923, 3.26, 33.31, 5.41, 0.874),
    (0.5, 0.9, 0.0313, 1.60, 23.66, 5.69, 0.939),
    (0.25, 0.2, 7.57, 153.0, 75.18, 3.76, 0.330),
    (0.25, 0.6, 1.07, 26.7, 46.72, 4.99, 0.746),
    (0.25, 0.8, 0.261, 8.80, 31.04, 5.60, 0.884),
]


@pytest.mark.parametrize(("width", "eps", "s", "friction", "attitude", "flow", "share"), RAIMONDI_BOYD)
def test_raimondi_and_boyd(width, eps, s, friction, attitude, flow, share):
    film = solve_film(eps, width)
    assert film.sommerfeld == pytest.approx(1.0 / (2.0 * math.pi * s), rel=0.02)
    assert math.degrees(film.attitude_angle) == pytest.approx(attitude, abs=0.6)
    assert film.shear_torque / film.sommerfeld == pytest.approx(friction, rel=0.02)
    side_flow = flow * share * width / (8.0 * math.pi)  # Q / (r c N L) to Q / (D^3 psi omega)
    assert film.side_flow == pytest.approx(side_flow, rel=0.01)


@pytest.mark.parametrize("eps", [0.05, 0.3, 0.7, 0.95])
@pytest.mark.parametrize("width", [0.3, 1.0])
def test_friction_by_wall_shear_is_the_formula_of_iso_7902(eps, width):
    """f/psi = pi / (So sqrt(1 - eps^2)) + (eps/2) sin beta follows from the moment balance of the film."""
    film = solve_film(eps, width)
    formula = math.pi / (film.sommerfeld * math.sqrt(1.0 - eps**2)) + 0.5 * eps * math.sin(
        film.attitude_angle
    )
    assert film.shear_torque / film.sommerfeld == pytest.approx(formula, rel=2e-4)


@pytest.mark.parametrize("eps", [0.1, 0.5, 0.8])
def test_narrow_bearing_tends_to_ocvirk(eps):
    """Short-bearing theory (NACA TN 2808) is the limit of B/D going to zero; the defect falls with it."""
    defects = []
    for width in (0.1, 0.05, 0.025):
        film = solve_film(eps, width, n_theta=360, n_zeta=40)
        defects.append(abs(film.sommerfeld / short_bearing_load(eps, width) - 1.0))
        assert film.side_flow == pytest.approx(short_bearing_side_flow(eps, width), rel=0.02)
    assert defects[0] > defects[1] > defects[2]
    assert defects[2] < 0.02
    assert film.attitude_angle == pytest.approx(short_bearing_attitude(eps), abs=0.02)


@pytest.mark.parametrize("eps", [0.3, 0.6])
def test_wide_bearing_tends_to_the_infinite_one(eps):
    """B/D 40 against the one-dimensional film, integrated in closed form with the Reynolds condition.

    With phi from the widest gap: dP/dphi = 6 (H - H_m) / H^3, P(0) = 0 and P = dP/dphi = 0 at phi_2 > pi,
    where H = H_m; the end angle follows from P(phi_2) = 0.
    """
    from scipy.integrate import quad, solve_ivp
    from scipy.optimize import brentq

    def slope(phi, end):
        gap, last = 1.0 + eps * math.cos(phi), 1.0 + eps * math.cos(end)
        return 6.0 * (gap - last) / gap**3

    end = brentq(lambda phi: quad(slope, 0.0, phi, args=(phi,))[0], math.pi + 0.01, 1.49 * math.pi)
    course = solve_ivp(
        lambda phi, p: [slope(phi, end)], (0.0, end), [0.0], dense_output=True, rtol=1e-9, atol=1e-12
    )
    along = -0.5 * quad(lambda phi: course.sol(phi)[0] * math.cos(phi), 0.0, end)[0]
    across = 0.5 * quad(lambda phi: course.sol(phi)[0] * math.sin(phi), 0.0, end)[0]
    film = solve_film(eps, 40.0)
    # both ends leak over a length of the order of D: a few per cent of B at B/D = 40
    assert film.sommerfeld == pytest.approx(math.hypot(along, across), rel=0.05)
    assert film.sommerfeld < math.hypot(along, across)
    assert film.attitude_angle == pytest.approx(math.atan2(across, along), abs=0.03)


def test_film_converges_at_second_order():
    fine = solve_film(0.7, 0.75, 480, 48).sommerfeld
    errors = [abs(solve_film(0.7, 0.75, n, n // 10).sommerfeld / fine - 1.0) for n in (60, 120)]
    assert math.log2(errors[0] / errors[1]) > 1.7
    assert errors[1] < 5e-3


def test_pressure_carries_only_behind_the_widest_gap():
    """Attitude goes to 90 degrees for a light load on a narrow bearing and to 0 near contact."""
    light, heavy = solve_film(0.01, 0.25), solve_film(0.985, 0.25)
    assert math.degrees(light.attitude_angle) > 85.0
    assert math.degrees(heavy.attitude_angle) < 12.0


@pytest.mark.parametrize("width", [0.25, 0.75, 1.5])
@pytest.mark.parametrize("eps", [0.03, 0.33, 0.66, 0.88, 0.975])
def test_characteristic_interpolates_the_film(width, eps):
    curve, film = characteristic(width), solve_film(eps, width)
    assert curve.sommerfeld(eps) == pytest.approx(film.sommerfeld, rel=1e-3)
    assert curve.attitude_angle(eps) == pytest.approx(film.attitude_angle, abs=1e-3)
    assert curve.side_flow(eps) == pytest.approx(film.side_flow, rel=1e-3)
    assert curve.eccentricity(curve.sommerfeld(eps)) == pytest.approx(eps, rel=1e-9)


def test_characteristic_is_solved_once_per_width():
    assert characteristic(0.7502) is characteristic(0.7498)
    with pytest.raises(ValueError, match=r"0\.1 to 2"):
        characteristic(0.05)


@pytest.mark.parametrize(("eps", "width"), [(0.0, 0.5), (1.0, 0.5), (0.5, 0.0)])
def test_impossible_film(eps, width):
    with pytest.raises(ValueError, match="must"):
        solve_film(eps, width)
