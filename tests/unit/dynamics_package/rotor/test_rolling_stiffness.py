"""Load distribution and stiffness against a published program, closed forms and a second way."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, minimize

from dynamics.rotor.bearing import BearingError
from dynamics.rotor.rolling_catalogue import catalogue_bearing, tabled_designations
from dynamics.rotor.rolling_elements import RollingElements
from dynamics.rotor.rolling_row import BallGroove, RowOfElements, contact_law, ellipse_ratio
from dynamics.rotor.rolling_stiffness import (
    bearing_stiffness,
)

BALLS = RollingElements(count=7, diameter=11.5e-3, pitch_diameter=43.5e-3)
"""6305-like, the example of the published comparison."""


def row(designation: str, clearance: float = 0.0) -> RowOfElements:
    elements = catalogue_bearing(designation).elements
    return RowOfElements(elements=elements, law=contact_law(elements), clearance=clearance)


@pytest.mark.parametrize(
    ("clearance", "radial", "axial"), [(0.0, 15.1101e-6, 133.5381e-6), (10e-6, 21.223e-6, 149.1717e-6)]
)
def test_displacement_against_the_values_of_masta(clearance: float, radial: float, axial: float) -> None:
    """ISO/TS 16281 ball bearing, Z = 7, D_w = 11.5, D_pw = 43.5, E = 210 GPa, 1 kN; MASTA's figures are published with
    the test cases of the program ISO16281 of minzhun."""
    law = contact_law(BALLS, BallGroove(young_modulus=2.1e11))
    bearing = RowOfElements(elements=BALLS, law=law, clearance=clearance)
    assert bearing_stiffness(bearing, 1000.0, 0.0).radial_displacement == pytest.approx(radial, rel=2e-5)
    assert bearing_stiffness(bearing, 0.0, 1000.0).axial_displacement == pytest.approx(axial, rel=2e-5)


def test_contact_ellipse_of_two_crossed_cylinders_is_a_circle() -> None:
    assert ellipse_ratio(0.0) == 1.0
    assert ellipse_ratio(0.9) > ellipse_ratio(0.5) > 1.0


@pytest.mark.parametrize(("designation", "factor"), [("6208", 4.37), ("NU 208", 4.08)])
def test_largest_element_load_at_zero_clearance(designation: str, factor: float) -> None:
    """Stribeck / Harris: Q_max = 4.37 F / Z (point), 4.08 F / Z (line); the sum over few elements is near it."""
    bearing = row(designation)
    found = bearing_stiffness(bearing, 5000.0, 0.0)
    assert found.largest_element_load == pytest.approx(factor * 5000.0 / bearing.elements.count, rel=0.015)


@pytest.mark.parametrize(
    ("designation", "clearance"), [("6208", 0.0), ("6208", 15e-6), ("NU 208", 25e-6), ("NU 208", -5e-6)]
)
def test_radial_displacement_against_sjoevalls_integral(designation: str, clearance: float) -> None:
    """Many elements: the integral over the load zone, solved for the displacement on its own."""
    elements = catalogue_bearing(designation).elements
    law = contact_law(elements)
    load = 4000.0

    def carried(displacement: float) -> float:
        def share(angle: float) -> float:
            approach = displacement * math.cos(angle) - 0.5 * clearance
            return law.stiffness * max(approach, 0.0) ** law.exponent * math.cos(angle)

        limit = 0.5 * clearance / displacement
        zone = math.acos(limit) if abs(limit) < 1.0 else math.pi
        return elements.count / math.pi * quad(share, 0.0, zone, limit=200)[0]

    displacement = brentq(lambda value: carried(value) - load, 1e-9 + max(clearance, 0.0) / 2.0, 1e-3)
    bearing = RowOfElements(elements=elements, law=law, clearance=clearance)
    assert bearing_stiffness(bearing, load, 0.0).radial_displacement == pytest.approx(displacement, rel=0.02)


def explicit_sum(bearing: RowOfElements, radial: float, axial: float) -> tuple[float, float]:
    """Forces at a displacement of an angular contact ball bearing, written out."""
    distance, angle = bearing.law.groove_distance, bearing.elements.contact_angle
    total = np.zeros(2)
    for index in range(bearing.elements.count):
        azimuth = 2.0 * math.pi * index / bearing.elements.count
        vector = np.array(
            [distance * math.cos(angle) + radial * math.cos(azimuth), distance * math.sin(angle) + axial]
        )
        stretch = float(np.linalg.norm(vector))
        load = bearing.law.stiffness * max(stretch - distance, 0.0) ** 1.5
        total += load * vector / stretch * (math.cos(azimuth), 1.0)
    return float(total[0]), float(total[1])


def test_angular_contact_against_an_explicit_sum_solved_otherwise() -> None:
    bearing = row("7208 B")
    found = bearing_stiffness(bearing, 2000.0, 4000.0)

    def miss(place: np.ndarray) -> float:
        radial, axial = explicit_sum(bearing, place[0] * 1e-6, place[1] * 1e-6)
        return ((radial - 2000.0) / 2000.0) ** 2 + ((axial - 4000.0) / 4000.0) ** 2

    other = minimize(
        miss, [10.0, 10.0], method="Nelder-Mead", options={"xatol": 1e-8, "fatol": 1e-18, "maxiter": 4000}
    )
    assert found.radial_displacement == pytest.approx(other.x[0] * 1e-6, rel=1e-5)
    assert found.axial_displacement == pytest.approx(other.x[1] * 1e-6, rel=1e-5)


@pytest.mark.parametrize(
    ("designation", "radial", "axial"),
    [
        ("6208", 2000.0, 0.0), ("6208", 2000.0, 800.0), ("7208 B", 2000.0, 4000.0), ("30208", 2000.0, 2000.0),
        ("NU 208", 2000.0, 0.0),
    ],
)  # fmt: skip
def test_stiffness_is_the_derivative_of_the_load(designation: str, radial: float, axial: float) -> None:
    """d(load) / d(displacement) by central differences, through the compliance of the free solution."""
    bearing = row(designation)
    found = bearing_stiffness(bearing, radial, axial)
    step = 1e-4 * radial
    low, high = (bearing_stiffness(bearing, radial + sign * step, axial) for sign in (-1.0, 1.0))
    compliance = (high.radial_displacement - low.radial_displacement) / (2.0 * step)
    condensed = found.radial
    if axial > 0.0:
        condensed -= found.coupling**2 / found.axial
    assert 1.0 / compliance == pytest.approx(condensed, rel=1e-3)


def test_every_tabled_bearing_has_a_solution_over_its_loads() -> None:
    for designation in tabled_designations():
        data = catalogue_bearing(designation)
        for share in (1e-4, 0.02, 0.3):
            load = share * data.dynamic_rating
            axials = (0.0,) if data.kind == "cylindrical_roller" else (0.0, 0.3 * load, 3.0 * load)
            for clearance in (-5e-6, 0.0, 20e-6):
                for axial in axials:
                    found = bearing_stiffness(row(designation, clearance), load, axial)
                    assert found.radial_load == pytest.approx(load, rel=1e-8)
                    assert found.axial_load >= axial * (1.0 - 1e-8)
                    assert found.radial > 0.0


def test_stiffness_grows_with_load_and_falls_with_clearance() -> None:
    loads = [bearing_stiffness(row("6208"), load, 0.0).radial for load in (500.0, 1000.0, 2000.0, 4000.0)]
    assert loads == sorted(loads)
    gaps = [bearing_stiffness(row("6208", gap), 2000.0, 0.0).radial for gap in (0.0, 10e-6, 20e-6, 40e-6)]
    assert gaps == sorted(gaps, reverse=True)


def test_too_little_axial_load_leaves_the_bearing_to_its_partner() -> None:
    """Half the elements loaded: a tapered bearing needs about F_r tan(alpha) 1.2, F_r / (2 Y) in the catalogue."""
    bearing = row("30208")
    held = bearing_stiffness(bearing, 4000.0, 0.0)
    assert held.held_axially
    assert held.axial_displacement == 0.0
    assert held.axial_load == pytest.approx(4000.0 / (2.0 * 1.6), rel=0.05)
    free = bearing_stiffness(bearing, 4000.0, 3000.0)
    assert not free.held_axially
    assert free.axial_load == pytest.approx(3000.0)


def test_what_has_no_axial_stiffness_is_refused() -> None:
    with pytest.raises(BearingError, match=r"axial load = 100 N.*flanges"):
        bearing_stiffness(row("NJ 208"), 1000.0, 100.0)


def test_no_load_is_no_stiffness() -> None:
    found = bearing_stiffness(row("6208", 10e-6), 0.0, 0.0)
    assert found.radial == 0.0
    assert found.loaded_elements == 0


def test_displacement_against_palmgrens_formulas() -> None:
    """T. A. Harris, Rolling Bearing Analysis, radial displacement at zero clearance, N and mm.

    Ball 4.36e-4 Q^(2/3) / D_w^(1/3) (all conformities in one number), roller 7.68e-5 Q^0.9 / L^0.8.
    """
    ball, roller = row("6208"), row("NU 208")
    found = bearing_stiffness(ball, 2000.0, 0.0)
    formula = (
        4.36e-7 * found.largest_element_load ** (2.0 / 3.0) / (ball.elements.diameter * 1e3) ** (1.0 / 3.0)
    )
    assert found.radial_displacement == pytest.approx(formula, rel=0.1)
    found = bearing_stiffness(roller, 2000.0, 0.0)
    formula = 7.68e-8 * found.largest_element_load**0.9 / (roller.elements.length * 1e3) ** 0.8
    assert found.radial_displacement == pytest.approx(formula, rel=1e-6)


@pytest.mark.parametrize("load", [1e-4, 1e-2, 1.0, 1e4])
@pytest.mark.parametrize(("designation", "clearance"), [("6208", 0.0), ("6208", -10e-6), ("7208 B", 0.0)])
@pytest.mark.parametrize(("radial", "axial"), [(1.0, 0.0), (0.3, 0.7), (0.0, 1.0)])
def test_loads_over_eight_decades_are_carried(
    designation: str, clearance: float, radial: float, axial: float, load: float
) -> None:
    """The iteration ends above the round-off of a light load on a preloaded or angled bearing."""
    found = bearing_stiffness(row(designation, clearance), radial * load, axial * load)
    assert found.radial_load == pytest.approx(radial * load, rel=1e-5, abs=1e-9 * load)
