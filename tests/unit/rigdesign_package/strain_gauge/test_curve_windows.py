"""Numbers of the curve of a root gauge."""

import numpy as np
import pytest

from rigdesign.strain_gauge.turn_average import curve_windows

PITCH = 2.0 * np.pi / 18


def bell(angle, centre=0.1):
    """Strain of a tooth with its maximum at ``centre``."""
    place = (angle - centre) / (0.35 * PITCH)
    return 5e-4 * np.exp(-(place**2))


ANGLE = np.linspace(-np.pi, np.pi, 1440, endpoint=False)


def test_a_shift_of_the_angle_and_a_zero_leave_entry_maximum_and_exit() -> None:
    here = curve_windows(ANGLE, bell(ANGLE), PITCH)
    there = curve_windows(ANGLE, bell(ANGLE, centre=0.17) + 4e-5, PITCH)
    assert there["unloaded"] == pytest.approx(4e-5, rel=1e-6)
    assert here["unloaded"] == pytest.approx(0.0, abs=1e-9)
    for window in ("entry", "maximum", "exit"):
        assert there[window] == pytest.approx(here[window], rel=2e-3)


def test_the_maximum_lies_a_little_below_the_highest_strain() -> None:
    found = curve_windows(ANGLE, bell(ANGLE), PITCH)["maximum"]
    assert 0.98 * 5e-4 < found < 5e-4


def test_the_mirrored_curve_exchanges_entry_and_exit() -> None:
    late = bell(ANGLE, centre=0.0) + 0.5 * bell(ANGLE, centre=0.4 * PITCH)
    found = curve_windows(ANGLE, late, PITCH)
    mirrored = curve_windows(-ANGLE[::-1], late[::-1], PITCH)
    assert abs(found["exit"] - found["entry"]) > 0.05 * found["maximum"]
    assert (mirrored["entry"], mirrored["exit"]) == pytest.approx((found["exit"], found["entry"]), rel=2e-3)


def test_a_curve_of_one_tooth_alone_has_no_strain_of_the_unloaded_tooth() -> None:
    short = ANGLE[np.abs(ANGLE) < 1.4 * PITCH]
    assert curve_windows(short, bell(short), PITCH)["unloaded"] == 0.0


def test_a_fillet_that_is_pressed_has_its_lowest_strain_as_maximum() -> None:
    pulled, pressed = (curve_windows(ANGLE, sign * bell(ANGLE), PITCH) for sign in (1.0, -1.0))
    assert pressed["maximum"] == pytest.approx(-pulled["maximum"])
    assert pressed["entry"] == pytest.approx(-pulled["entry"])
