"""Axial forces of bearings that press each other: catalogue cases, a worked problem, balance, elastic pairs."""

import math
from dataclasses import replace
from itertools import product

import pytest
from scipy.optimize import brentq

from dynamics.rotor.rolling_catalogue import catalogue_bearing
from dynamics.rotor.rolling_row import RowOfElements, contact_law
from dynamics.rotor.rolling_stiffness import bearing_stiffness, force_on_first, pair_axial_loads


@pytest.mark.parametrize(
    ("induced", "pressing_b", "expected"),
    [
        # K_a presses B (cases 1), then A (cases 2); a: F_iA >= F_iB, b: smaller and K_a makes up for it, c: it does not
        ((900.0, 400.0), 500.0, (900.0, 1400.0)),
        ((400.0, 900.0), 700.0, (400.0, 1100.0)),
        ((400.0, 900.0), 300.0, (600.0, 900.0)),
        ((400.0, 900.0), -500.0, (1400.0, 900.0)),
        ((900.0, 400.0), -700.0, (1100.0, 400.0)),
        ((900.0, 400.0), -300.0, (900.0, 600.0)),
    ],
)
def test_the_six_cases_of_the_catalogue(
    induced: tuple[float, float], pressing_b: float, expected: tuple[float, float]
) -> None:
    """SKF, axial load for bearings mounted singly: F_aA = F_iA, F_aB = F_aA + K_a in 1a and 1b; F_aA = F_aB - K_a,
    F_aB = F_iB in 1c; the same with A and B changed over in 2a to 2c."""
    assert pair_axial_loads(induced, -pressing_b) == pytest.approx(expected)


def test_a_worked_problem() -> None:
    """Shigley, Mechanical Engineering Design, problem 11-43: two tapered bearings with K = 1.5, 12 and 25 kN radially,
    5 kN on the first. F_i = 0.47 F_r / K = 3.76 and 7.83 kN; the first carries 12.83 kN, so that
    F_e = 0.4 * 12 + 1.5 * 12.83 = 24.05 kN."""
    induced = (0.47 * 12e3 / 1.5, 0.47 * 25e3 / 1.5)
    first, second = pair_axial_loads(induced, 5e3)
    assert (first, second) == pytest.approx((12.83e3, 7.83e3), rel=1e-3)
    assert 0.4 * 12e3 + 1.5 * first == pytest.approx(24.05e3, rel=1e-3)


def test_a_pair_of_tapered_bearings_with_catalogue_factors() -> None:
    """30206 (Y = 1.6) under 3200 N, 30306 (Y = 1.9) under 1900 N, 2 kN on the second: by hand 1000, 3000 N;
    P = 3200 N as 1000 < 0.37 * 3200, and 0.4 * 1900 + 1.9 * 3000 = 6460 N."""
    small, large = catalogue_bearing("30206"), catalogue_bearing("30306")
    induced = (small.rules.induced_axial_load(small, 3200.0), large.rules.induced_axial_load(large, 1900.0))
    assert induced == pytest.approx((1000.0, 500.0))
    axial = pair_axial_loads(induced, -2000.0)
    assert axial == pytest.approx((1000.0, 3000.0))
    assert small.rules.equivalent_load(small, 3200.0, axial[0]) == pytest.approx(3200.0)
    assert large.rules.equivalent_load(large, 1900.0, axial[1]) == pytest.approx(6460.0)


def test_forces_balance_and_either_bearing_has_what_it_induces() -> None:
    for first, second, external in product(
        (0.0, 300.0, 900.0), (0.0, 500.0), (-2000.0, -100.0, 0.0, 250.0, 3000.0)
    ):
        found = pair_axial_loads((first, second), external)
        assert found[0] - found[1] == pytest.approx(external)
        assert found[0] >= first and found[1] >= second
        assert found[0] == first or found[1] == second  # no more than needed
        assert pair_axial_loads((second, first), -external) == pytest.approx(found[::-1])


def test_which_bearing_takes_the_thrust() -> None:
    """A force from A to B is taken by A back to back, by B face to face."""
    pressed = pair_axial_loads((0.0, 0.0), force_on_first("back_to_back", 700.0))
    assert pressed == (700.0, 0.0)
    assert pair_axial_loads((0.0, 0.0), force_on_first("face_to_face", 700.0)) == (0.0, 700.0)


def _row(designation: str) -> RowOfElements:
    elements = catalogue_bearing(designation).elements
    return RowOfElements(elements=elements, law=contact_law(elements))


def _elastic_pair(
    designations: tuple[str, str], radial: tuple[float, float], external: float
) -> tuple[float, float]:
    """Axial forces of two bearings without play on a rigid shaft, from their load and deflection alone.

    The shaft moves axially by w: A is pressed by +w, B by -w; each finds the radial displacement that carries its load.
    """
    rows = tuple(_row(designation) for designation in designations)

    def forces(shift: float) -> tuple[float, float]:
        first, second = (
            bearing_stiffness(replace(row, axial_offset=sign * shift), load, 0.0).axial_load
            for row, load, sign in zip(rows, radial, (1.0, -1.0), strict=True)
        )
        return first, second

    def excess(shift: float) -> float:
        first, second = forces(shift)
        return first - second - external

    return forces(brentq(excess, -2e-4, 2e-4, xtol=1e-13))


@pytest.mark.parametrize(("designations", "margin"), [(("30206", "30306"), 1.2), (("7208 B", "7208 B"), 1.4)])
@pytest.mark.parametrize("radial", [(2000.0, 2000.0), (3000.0, 1500.0)])
@pytest.mark.parametrize("external", [0.0, 600.0, 3000.0, -3000.0])
def test_an_elastic_pair_shares_the_axial_force_like_the_catalogue(
    designations: tuple[str, str], margin: float, radial: tuple[float, float], external: float
) -> None:
    """The catalogue is on the safe side: it keeps the relieved bearing half loaded, whose zone shrinks elastically,
    down to F_r tan(alpha), and takes 1.14 F_r for balls at 40 degrees, 0.98 F_r elastically."""
    elastic = _elastic_pair(designations, radial, external)
    assert elastic[0] - elastic[1] == pytest.approx(external, abs=1e-3)
    data = [catalogue_bearing(designation) for designation in designations]
    induced = [one.rules.induced_axial_load(one, load) for one, load in zip(data, radial, strict=True)]
    found = pair_axial_loads((induced[0], induced[1]), external)
    assert all(real < own < margin * real for own, real in zip(found, elastic, strict=True))
    relieved = min((0, 1), key=lambda index: elastic[index] / radial[index])
    assert elastic[relieved] > 0.97 * radial[relieved] * math.tan(data[relieved].contact_angle)
