"""Mean stress of a root against hand numbers and limits of the disc formulas, and Y_M of ISO 6336-3."""

from dataclasses import replace

import numpy as np
import pytest

from dynamics.errors import DynamicsInputError
from dynamics.rating.root_stress import (
    GearDisc,
    PressFit,
    Solid,
    mean_root_stress,
    mean_stress_factor,
    seat_pressure,
)
from dynamics.standards import iso6336_3_2006 as iso

STEEL = Solid(young=206e9, poisson=0.3, density=7830.0)
SPEED = 12000.0 * np.pi / 30.0
IDLER = GearDisc(bore=50e-3, root=106.25e-3, tip=117.5e-3, solid=STEEL)
"""Pinion of the main rig: 45 teeth of 5 mm on a seat of 100 mm."""


def test_hoop_stress_of_the_idler_by_hand() -> None:
    """rho omega^2 = 1.23646e10 N/m4; disc 0.825 * that * (0.0025 + 0.7/3.3 * 0.011289) = 49.93 MPa.

    The teeth pull with 0.5 * that * (0.1175^3 - 0.10625^3) / 3 / 0.10625 = 8.20 MPa, times (1 + q) / (1 - q) with
    q = (50 / 106.25)^2 = 0.22145: 12.87 MPa.
    """
    stress = mean_root_stress(IDLER, SPEED)
    assert stress.disc == pytest.approx(49.93e6, rel=1e-3)
    assert stress.teeth == pytest.approx(12.87e6, rel=1e-3)
    assert stress.press_fit == 0.0
    assert stress.total == stress.centrifugal == stress.disc + stress.teeth


def test_thin_ring_holds_rho_v_squared() -> None:
    ring = GearDisc(bore=0.9999e-1, root=1e-1, tip=1.0000001e-1, solid=STEEL)
    assert mean_root_stress(ring, SPEED).disc == pytest.approx(7830.0 * (SPEED * 0.1) ** 2, rel=2e-4)


def test_solid_disc_has_a_quarter_of_one_less_poisson_at_its_rim() -> None:
    disc = GearDisc(bore=0.0, root=0.1, tip=0.11, solid=STEEL)
    assert mean_root_stress(disc, SPEED).disc == pytest.approx(0.7 / 4.0 * 7830.0 * (SPEED * 0.1) ** 2)


def test_rim_holds_at_least_what_a_free_ring_holds() -> None:
    """Rim of 20 mm: rho omega^2 (96.25 mm)^2 = 114.5 MPa; teeth 8.20 MPa (1 + q) / (1 - q), q = (86.25 / 106.25)^2."""
    stress, q = mean_root_stress(replace(IDLER, rim=20e-3), SPEED), (86.25 / 106.25) ** 2
    assert stress.disc == pytest.approx(114.55e6, rel=1e-3)
    assert stress.teeth == pytest.approx(8.20e6 * (1.0 + q) / (1.0 - q), rel=1e-3)
    down_to_bore = mean_root_stress(replace(IDLER, rim=80e-3), SPEED)
    assert down_to_bore == mean_root_stress(IDLER, SPEED)


def test_press_fit_at_rest_is_that_of_lame() -> None:
    """Solid shaft of the same steel: p = E delta / (2 d) (1 - q); hoop at the root 2 p q / (1 - q)."""
    fit = PressFit(interference=80e-6, shaft=STEEL)
    q = (50.0 / 106.25) ** 2
    pressure = 206e9 * 80e-6 / (2.0 * 100e-3) * (1.0 - q)
    assert seat_pressure(IDLER, 0.0, fit) == pytest.approx(pressure, rel=1e-12)
    assert mean_root_stress(IDLER, 0.0, fit).press_fit == pytest.approx(2.0 * pressure * q / (1.0 - q))


def test_speed_loosens_the_seat_until_it_carries_nothing() -> None:
    fit = PressFit(interference=80e-6, shaft=STEEL, shaft_bore=10e-3)
    pressures = [seat_pressure(IDLER, speed, fit) for speed in (0.0, SPEED, 3.0 * SPEED)]
    assert pressures[0] > pressures[1] > pressures[2] == 0.0
    lost = (pressures[0] - pressures[1]) / pressures[0]
    # hoop at the bore 120.6 MPa of the disc and 21.1 MPa of the teeth, at the surface of the shaft 6.4 MPa
    assert lost == pytest.approx(100e-3 * (120.6e6 + 21.1e6 - 6.4e6) / 206e9 / 80e-6, rel=2e-3)


@pytest.mark.parametrize(("bore", "shaft_bore"), [(0.0, 0.0), (50e-3, 50e-3)])
def test_a_seat_without_metal_is_refused(bore: float, shaft_bore: float) -> None:
    gear = GearDisc(bore=bore, root=106.25e-3, tip=117.5e-3, solid=STEEL)
    with pytest.raises(DynamicsInputError, match="bore_diameter"):
        mean_root_stress(gear, SPEED, PressFit(interference=1e-5, shaft=STEEL, shaft_bore=shaft_bore))


def test_radii_must_grow() -> None:
    with pytest.raises(DynamicsInputError, match="bore diameter"):
        GearDisc(bore=0.11, root=0.1, tip=0.12, solid=STEEL)


def test_mean_stress_factor_is_one_for_pulses_and_0_7_for_a_case_hardened_idler() -> None:
    M = iso.mean_stress_ratio("case_hardened", 2.0)
    assert pytest.approx(0.5) == M
    assert iso.Y_M(0.0, M) == 1.0
    assert iso.Y_M(-1.2, M) == pytest.approx(1.0 / 1.4)
    assert iso.mean_stress_ratio("nitrided", 2.0) == iso.mean_stress_ratio("through_hardened", 2.0) == 0.3


@pytest.mark.parametrize("R", [-2.0, -1.2, -0.5, 0.0, 0.3, 0.5])
def test_mean_stress_factor_is_the_straight_line_of_the_haigh_diagram(R: float) -> None:
    """Amplitude plus M times mean is the same at every stress ratio."""
    M, highest = 0.45, iso.Y_M(R, 0.45)
    amplitude, mean = 0.5 * highest * (1.0 - R), 0.5 * highest * (1.0 + R)
    assert amplitude + M * mean == pytest.approx(0.5 * (1.0 + M))
    assert iso.Y_M(0.9, M) == iso.Y_M(0.5, M)


@pytest.mark.parametrize("M", [0.3, 0.5])
def test_below_the_end_of_annex_b_the_amplitude_is_that_of_its_end(M: float) -> None:
    """Lower than Y_M of -1.2 and than its straight line; the fillet under the higher load still governs."""
    assert [mean_stress_factor(R, M) for R in (-1.2, -0.5, 0.3)] == [iso.Y_M(R, M) for R in (-1.2, -0.5, 0.3)]
    end = 0.5 * 2.2 * iso.Y_M(-1.2, M)
    for R in (-1.3, -2.4, -12.0):
        factor = mean_stress_factor(R, M)
        assert 0.5 * (1.0 - R) * factor == pytest.approx(end)
        assert factor < iso.Y_M(R, M) < iso.Y_M(-1.2, M)
    for lower in (0.9, 0.5, 0.1):
        governing = 1.0 / iso.Y_M(-1.2 * lower, M)
        assert lower / mean_stress_factor(-1.2 / lower, M) < governing
