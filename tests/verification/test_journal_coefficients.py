"""Stiffness and damping of journal films against published tables, closed forms, another code and finite differences.

Axes and scale of Lund and Thomsen throughout: x along the load, y a quarter turn ahead of it in the direction of
rotation; K = k c / W, B = b c omega / W, S = eta N L D (R/c)^2 / W = 1 / (2 pi So), c the radial clearance.
"""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from dynamics.kernels.journal import short_bearing_load
from dynamics.rotor.bearing import LateralCoefficients, LateralOperation
from dynamics.rotor.journal import (
    RunningFilm,
    coefficient_table,
    film_coefficients,
    journal_lateral,
)
from dynamics.rotor.journal_feed import film_arcs
from dynamics.rotor.journal_film import film_grid, short_bearing_attitude, solve_arc, solve_film
from tests.builders.rotor_stability import rotor_stability, threshold_speed

# J. W. Lund, K. K. Thomsen, A calculation method and data for the dynamic coefficients of oil-lubricated journal
# bearings, ASME 1978, two-axial-groove bearing: two shells of 160 degrees, load on the middle of the lower one.
# S, eps, attitude [deg], Kxx, Kxy, Kyx, Kyy, Bxx, Bxy = Byx, Byy. L/D 0.5 as printed in the course files of DTU 41524
# (I. F. Santos), L/D 1 and five rows of L/D 0.5 as in the literature tests of ROSS.
LUND_THOMSEN = {
    0.5: [
        (6.430, 0.071, 81.89, 1.55, 14.41, -6.60, 1.88, 28.75, 1.89, 13.31),
        (3.937, 0.114, 77.32, 1.57, 9.27, -4.20, 1.89, 18.44, 1.93, 8.58),
        (2.634, 0.165, 72.36, 1.61, 6.74, -3.01, 1.91, 13.36, 2.00, 6.28),
        (2.030, 0.207, 68.75, 1.65, 5.67, -2.50, 1.93, 11.18, 2.07, 5.33),
        (1.656, 0.244, 65.85, 1.69, 5.06, -2.20, 1.95, 9.93, 2.15, 4.80),
        (0.917, 0.372, 57.45, 2.12, 4.01, -1.30, 1.85, 7.70, 2.06, 3.23),
        (0.580, 0.477, 51.01, 2.67, 3.70, -0.78, 1.75, 6.96, 1.94, 2.40),
        (0.378, 0.570, 45.43, 3.33, 3.64, -0.43, 1.68, 6.76, 1.87, 1.89),
        (0.244, 0.655, 40.25, 4.21, 3.74, -0.13, 1.64, 6.87, 1.82, 1.54),
        (0.194, 0.695, 37.72, 4.78, 3.84, 0.01, 1.62, 7.03, 1.80, 1.40),
        (0.151, 0.734, 35.20, 5.48, 3.98, 0.15, 1.61, 7.26, 1.79, 1.27),
        (0.086, 0.809, 30.04, 7.51, 4.42, 0.47, 1.59, 8.03, 1.79, 1.03),
        (0.042, 0.879, 24.41, 11.45, 5.23, 0.92, 1.60, 9.48, 1.80, 0.82),
    ],
    1.0: [
        (0.991, 0.150, 70.58, 1.56, 7.29, -2.16, 1.52, 14.66, 1.58, 4.49),
        (0.635, 0.224, 63.54, 1.62, 5.33, -1.57, 1.56, 10.80, 1.70, 3.41),
        (0.235, 0.460, 49.27, 2.19, 3.57, -0.80, 1.55, 7.36, 1.89, 2.19),
        (0.159, 0.559, 44.33, 2.73, 3.36, -0.48, 1.48, 6.94, 1.78, 1.74),
        (0.108, 0.650, 39.72, 3.45, 3.34, -0.23, 1.44, 6.89, 1.72, 1.43),
    ],
}
ROSS = json.loads((Path(__file__).parents[1] / "reference" / "journal" / "ross.json").read_text())


def at(width_ratio, s, feed):
    """Eccentricity, attitude [deg], K and B of a bearing at Lund and Thomsen's S."""
    table, load = coefficient_table(width_ratio, feed), 1.0 / (2.0 * math.pi * s)
    eps = table.characteristic.eccentricity(load)
    attitude = table.characteristic.attitude_angle(eps)
    found = table.at(eps).turned(attitude)
    return eps, math.degrees(attitude), found.stiffness / load, found.damping / load


def scaled(film):
    """K and B of a solved film."""
    found = film_coefficients(film).turned(film.attitude_angle)
    return np.stack([found.stiffness, found.damping]) / film.sommerfeld


def of(stiffness, damping):
    return LateralCoefficients(
        stiffness=np.array(stiffness), damping=np.array(damping), position=np.zeros(2), regime="constant"
    )


@pytest.mark.parametrize(
    ("width", "row"), [(width, row) for width, rows in LUND_THOMSEN.items() for row in rows]
)
def test_lund_and_thomsen(width, row):
    """Within 1.5 % of the largest entry: their grid; ROSS allows itself 6 % on the same table."""
    s, eps, attitude, kxx, kxy, kyx, kyy, bxx, bxy, byy = row
    found = at(width, s, "two_axial_grooves")
    assert found[0] == pytest.approx(eps, abs=1e-3)
    assert found[1] == pytest.approx(attitude, abs=0.12)
    stiffness, damping = np.array([[kxx, kxy], [kyx, kyy]]), np.array([[bxx, bxy], [bxy, byy]])
    assert found[2] == pytest.approx(stiffness, abs=0.015 * stiffness.max())
    assert found[3] == pytest.approx(damping, abs=0.015 * damping.max())


def test_lund_and_thomsen_at_a_sommerfeld_number_of_058():
    """The row that issue 20 names; our film on 480 x 48 cells moves by less than 0.1 % from this."""
    eps, attitude, stiffness, damping = at(0.5, 0.580, "two_axial_grooves")
    assert (eps, attitude) == (pytest.approx(0.477, abs=1e-3), pytest.approx(51.01, abs=0.1))
    assert stiffness == pytest.approx(np.array([[2.67, 3.70], [-0.78, 1.75]]), abs=0.026)
    assert damping == pytest.approx(np.array([[6.96, 1.94], [1.94, 2.40]]), abs=0.055)


@pytest.mark.parametrize("row", LUND_THOMSEN[0.5])
def test_lund_and_thomsens_own_damping_obeys_the_law_of_tangential_motion(row):
    """B (0, eps) = 2 F on the axes r and t holds for their table too (rounded to 0.005): it fixes axes and scale."""
    _, eps, attitude, *_, bxx, bxy, byy = row
    phi = math.radians(attitude)
    tangential = eps * np.array([-math.sin(phi), math.cos(phi)])
    force = np.array([[bxx, bxy], [bxy, byy]]) @ tangential
    assert force == pytest.approx([-2.0, 0.0], abs=0.02)


@pytest.mark.parametrize("kind", ["two_axial_grooves", "widest_gap"])
def test_ross(kind):
    """Finite elements; ROSS moves by up to 2 % of the largest entry on its own mesh (README of the reference)."""
    for case in ROSS[kind]:
        eps, attitude, stiffness, damping = at(case["width_ratio"], case["S"], kind)
        assert eps == pytest.approx(case["eccentricity"], abs=1e-3)
        assert attitude == pytest.approx(case["attitude_deg"], abs=0.3)
        assert stiffness == pytest.approx(np.array(case["stiffness"]), abs=0.021 * stiffness.max())
        assert damping == pytest.approx(np.array(case["damping"]), abs=0.021 * damping.max())


def ocvirk(e):
    """K and B of the short bearing (F. W. Ocvirk; as in Friswell et al., Dynamics of Rotating Machines, 5.5)."""
    pi, rest = math.pi, 1.0 - e * e
    h = (pi**2 * rest + 16.0 * e**2) ** -1.5
    skew = h * pi / (e * math.sqrt(rest))
    stiffness = [
        [4.0 * h * (pi**2 * (2.0 - e**2) + 16.0 * e**2), skew * (pi**2 * rest**2 - 16.0 * e**4)],
        [
            -skew * (pi**2 * rest * (1.0 + 2.0 * e**2) + 32.0 * e**2 * (1.0 + e**2)),
            4.0 * h * (pi**2 * (1.0 + 2.0 * e**2) + 32.0 * e**2 * (1.0 + e**2) / rest),
        ],
    ]
    inner = pi**2 * (1.0 + 2.0 * e**2) - 16.0 * e**2
    cross = -8.0 * h * inner
    damping = [
        [2.0 * pi * h * math.sqrt(rest) * inner / e, cross],
        [cross, 2.0 * skew * (pi**2 * rest**2 + 48.0 * e**2)],
    ]
    return np.array([stiffness, damping])


def across_first(coefficients):
    """From the axes of Friswell (first across the load, against the way rotation carries the journal) to ours."""
    turn = np.array([[0.0, 1.0], [-1.0, 0.0]])
    return np.stack([turn @ each @ turn.T for each in coefficients])


def test_closed_form_is_that_of_the_textbook():
    """Friswell et al., example 5.5.1: 525 N, 100 mm, 30 mm, c 0.1 mm, 0.1 Pa s, 1500 rpm, eps 0.2663."""
    stiffness, damping = ocvirk(0.2663) * 525.0 / 1e-4
    assert stiffness / 1e6 == pytest.approx(np.array([[12.81, 16.39], [-25.06, 8.815]]), rel=1e-3)
    assert damping / 157.08e3 == pytest.approx(np.array([[232.9, -81.92], [-81.92, 294.9]]), rel=1e-3)
    psi = 1e-4 / 0.05
    load = 525.0 * psi**2 / (0.03 * 0.1 * 0.1 * 157.08)
    assert short_bearing_load(0.2663, 0.3) == pytest.approx(load, rel=1e-3)


@pytest.mark.parametrize("eps", [0.1, 0.4, 0.7])
def test_narrow_bearing_tends_to_ocvirk(eps):
    """The defect is of the order of B/D: the film is led to ambient pressure at its feed and its break-up."""
    exact = across_first(ocvirk(eps))
    defects = []
    for width in (0.1, 0.05, 0.025):
        film = solve_film(eps, width, n_theta=480, n_zeta=32)
        defects.append(np.abs(scaled(film) - exact).max(axis=(1, 2)) / np.abs(exact).max(axis=(1, 2)))
    assert np.all(defects[0] > defects[1]) and np.all(defects[1] > defects[2])
    assert defects[2] == pytest.approx(0.0, abs=0.03)
    assert film.attitude_angle == pytest.approx(short_bearing_attitude(eps), abs=0.02)


def force(position, velocity, arcs, grid):
    """Force of the film on a journal anywhere, in fixed axes along the widest gap at rest and across it."""
    eps, width, n, m = math.hypot(*position), *grid
    wide = math.atan2(-position[1], -position[0])
    total = np.zeros(2)
    for start, end in arcs:
        cells = film_grid(eps, width, (start - wide, end - wide), n, m)
        angle = cells.theta + wide
        squeeze = -(velocity[0] * np.cos(angle) + velocity[1] * np.sin(angle))[1:-1]
        mean = np.trapezoid(solve_arc(cells, squeeze).pressure, cells.zeta, axis=1)
        total -= 0.5 * np.trapezoid(mean * np.stack([np.cos(angle), np.sin(angle)]), angle, axis=1)
    return total


@pytest.mark.parametrize(
    ("eps", "width", "feed"),
    [(0.2, 1.0, "widest_gap"), (0.477, 0.5, "two_axial_grooves"), (0.8, 0.75, "widest_gap")],
)
def test_linearised_film_is_the_derivative_of_the_force(eps, width, feed):
    """Central differences of the whole cavitated film with its feed held; their own error is h^2 and the grid's."""
    film = solve_film(eps, width, feed=feed)
    arcs = film_arcs(feed, film.attitude_angle)
    grid, step = (width, 240 // len(arcs), 24), 0.02 * min(eps, 1.0 - eps)
    rest, still = np.array([-eps, 0.0]), np.zeros(2)
    sides = [step * axis for axis in np.eye(2)]
    stiffness = [force(rest + d, still, arcs, grid) - force(rest - d, still, arcs, grid) for d in sides]
    damping = [force(rest, d, arcs, grid) - force(rest, -d, arcs, grid) for d in sides]
    found = film_coefficients(film)
    for exact, differences in ((found.stiffness, stiffness), (found.damping, damping)):
        assert -np.array(differences).T / (2.0 * step) == pytest.approx(exact, abs=2e-3 * np.abs(exact).max())


@pytest.mark.parametrize("eps", [0.05, 0.5, 0.9])
@pytest.mark.parametrize("width", [0.3, 1.0])
def test_radial_stiffness_is_the_slope_of_the_static_load(eps, width):
    """Along the line of centres the characteristic itself is the displaced film."""
    step = 1e-3 * (1.0 - eps)
    loads = []
    for e in (eps - step, eps + step):
        film = solve_film(e, width)
        loads.append(
            film.sommerfeld * np.array([math.cos(film.attitude_angle), -math.sin(film.attitude_angle)])
        )
    slope = (loads[1] - loads[0]) / (2.0 * step)
    found = film_coefficients(solve_film(eps, width)).stiffness[:, 0]
    assert found == pytest.approx(slope, abs=3e-3 * np.abs(slope).max())


@pytest.mark.parametrize("feed", ["widest_gap", "two_axial_grooves"])
@pytest.mark.parametrize("eps", [0.01, 0.6, 0.97])
def test_damping_is_symmetric_and_tangential_motion_scales_the_static_film(eps, feed):
    """Symmetric to rounding, as the operator is. To the film a journal that goes round with v is one at rest with the
    speed lower by 2 v / eps: C (0, eps) = 2 F, here to the error of the grid in the place of the film's edge."""
    film = solve_film(eps, 0.75, feed=feed)
    damping = film_coefficients(film).damping
    assert damping[0, 1] == pytest.approx(damping[1, 0], rel=1e-12)
    static = 2.0 * film.sommerfeld * np.array([-math.cos(film.attitude_angle), math.sin(film.attitude_angle)])
    assert eps * damping[:, 1] == pytest.approx(static, abs=1e-3 * abs(static).max())


@pytest.mark.parametrize(("eps", "width"), [(0.477, 0.5), (0.7, 0.75)])
def test_coefficients_converge_at_second_order(eps, width):
    """The edge of the film between the nodes is where it belongs; on the nodes the order would be 1."""
    fine = scaled(solve_film(eps, width, 480, 48))
    errors = [np.abs(scaled(solve_film(eps, width, n, n // 10)) - fine).max() for n in (60, 120, 240)]
    assert errors[2] < 1e-3
    assert 0.5 * math.log2(errors[0] / errors[2]) > 1.7


@pytest.mark.parametrize("width", [0.25, 0.75, 1.5])
@pytest.mark.parametrize("eps", [0.0003, 0.03, 0.33, 0.66, 0.88, 0.975])
def test_table_interpolates_the_film(width, eps):
    found, exact = coefficient_table(width).at(eps), film_coefficients(solve_film(eps, width))
    for mine, its in ((found.stiffness, exact.stiffness), (found.damping, exact.damping)):
        assert mine == pytest.approx(its, abs=5e-4 * np.abs(its).max())


@pytest.mark.parametrize("feed", ["widest_gap", "two_axial_grooves"])
def test_centred_journal_has_the_stiffness_of_half_the_speed(feed):
    """K = (omega / 2) C [[0, 1], [-1, 0]]: standing off the centre is to the film moving round it at half the speed."""
    found = coefficient_table(0.75, feed).at(0.0)
    skew = np.array([[0.0, 1.0], [-1.0, 0.0]])
    assert found.stiffness == pytest.approx(0.5 * found.damping @ skew, abs=1e-4 * found.damping.max())


def test_threshold_of_the_short_bearing_without_load():
    """m c omega^2 / W = 24 / pi and a whirl ratio of 1/2, from Ocvirk's coefficients at eps going to 0."""
    found = rotor_stability(of(*ocvirk(1e-4)))
    assert found.critical_mass == pytest.approx(24.0 / math.pi, rel=1e-4)
    assert found.whirl_frequency == pytest.approx(0.5, rel=1e-4)
    ours = rotor_stability(of(*at(0.1, 500.0, "widest_gap")[2:]))
    assert ours.whirl_frequency == pytest.approx(0.5, abs=1e-3)
    assert ours.critical_mass == pytest.approx(24.0 / math.pi, rel=0.02)


@pytest.mark.parametrize("s", [5.3, 4.3])
def test_threshold_of_two_axial_grooves(s):
    """omega sqrt(m c / W) = 2.1 at L/D 1 (Nicholas, Barrett, Leader 1980, table 6, set A; 2.05 in Nicholas 1994)."""
    found = rotor_stability(of(*at(1.0, s, "two_axial_grooves")[2:]))
    assert math.sqrt(found.critical_mass) == pytest.approx(2.1, rel=0.02)
    assert found.whirl_frequency == pytest.approx(0.5, abs=2e-3)


@pytest.mark.parametrize("row", LUND_THOMSEN[0.5][:9])
def test_critical_mass_of_lund_and_thomsens_table(row):
    """From their rounded coefficients; near eps 0.66 the threshold rises steeply and rounding counts 2 %."""
    s, _, _, kxx, kxy, kyx, kyy, bxx, bxy, byy = row
    theirs = rotor_stability(of([[kxx, kxy], [kyx, kyy]], [[bxx, bxy], [bxy, byy]]))
    ours = rotor_stability(of(*at(0.5, s, "two_axial_grooves")[2:]))
    assert ours.critical_mass == pytest.approx(theirs.critical_mass, rel=0.025)
    assert ours.whirl_frequency == pytest.approx(theirs.whirl_frequency, rel=0.015)


@pytest.mark.parametrize(("revolutions", "stable"), [(66.3218, True), (119.7697, False)])
def test_worked_example_of_a_rotor_on_lund_and_thomsens_bearing(revolutions, stable):
    """DTU 41524, Journal bearing dynamics and stability: D 100, L 50 mm, c 0.1 mm, 0.0271 Pa s, 500 kg under 2450 N."""
    film = RunningFilm(
        diameter=0.1,
        width=0.05,
        diametral_clearance=2e-4,
        viscosity=0.0271,
        omega=2.0 * math.pi * revolutions,
        feed="two_axial_grooves",
    )
    found = rotor_stability(journal_lateral(film, LateralOperation(force=(0.0, -2450.0))))
    assert (found.critical_mass > 500.0) is stable


@pytest.mark.parametrize(
    ("tangential", "published", "feed", "tolerance"),
    [
        (0.0, 12000.0, "two_axial_grooves", 0.02),
        (10.0 / 46.5e-3, 28000.0, "two_axial_grooves", 0.06),
        (0.0, 12000.0, "widest_gap", 0.16),
        (10.0 / 46.5e-3, 28000.0, "widest_gap", 0.20),
    ],
)
def test_rotor_that_loses_its_torque(tangential, published, feed, tolerance):
    """Physics sheet m: 4 kg, 30 um: 12,000 rpm with weight alone, 28,000 rpm at 10 N m ("about").

    Assumed: rigid rotor on two bearings, half of mass and load each, journal 40 x 30 mm, 8 mPa s (it does not count:
    eps is near 0), tooth force 10 N m over 46.5 mm across the weight. A bearing fed at its widest gap holds 14 % more.
    """
    load = (0.5 * tangential, -0.5 * 4.0 * 9.81)

    def running(omega):
        film = RunningFilm(
            diameter=0.04, width=0.03, diametral_clearance=60e-6, viscosity=8e-3, omega=omega, feed=feed
        )
        return journal_lateral(film, LateralOperation(force=load))

    threshold = threshold_speed(running, 2.0, 50.0, 2e4)
    assert threshold * 30.0 / math.pi == pytest.approx(published, rel=tolerance)
    assert rotor_stability(running(threshold)).whirl_ratio(threshold) == pytest.approx(0.5, abs=2e-3)
