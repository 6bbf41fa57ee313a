"""Torque of a press fit by hand."""

import math

import pytest

from dynamics.rating.root_stress import GearDisc, PressFit, Solid, seat_pressure
from rigdesign.postprocessing.press_fits import slip_torque

STEEL = Solid(young=206e9, poisson=0.3, density=7850.0)


def test_slip_torque_of_a_seat_of_one_steel() -> None:
    """DIN 7190-1 with a solid shaft of the same material: p = E (1 - Q^2) U / (2 D), T = mu p pi D^2 L / 2.

    40 um on 40 mm in a disc of 100 mm: 206e9 * 0.84 * 40e-6 / 0.08 = 86.52 N/mm2; with mu 0.12 over 20 mm 522 N m.
    """
    disc = GearDisc(bore=0.020, root=0.050, tip=0.0501, solid=STEEL)
    pressure = seat_pressure(disc, 0.0, PressFit(interference=40e-6, shaft=STEEL))
    assert pressure == pytest.approx(86.52e6, rel=1e-6)
    assert slip_torque(pressure, 0.040, 0.020, 0.12) == pytest.approx(
        0.12 * 86.52e6 * math.pi * 0.040**2 * 0.020 / 2.0, rel=1e-6
    )
    assert slip_torque(86.52e6, 0.040, 0.020, 0.12) == pytest.approx(521.9, rel=1e-3)
