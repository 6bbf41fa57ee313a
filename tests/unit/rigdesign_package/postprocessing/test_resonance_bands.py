"""Bands around the peaks of a response, and what they leave."""

import numpy as np
import pytest

from rigdesign.postprocessing.resonances import DynamicShare, bands, nearest_safe, resonances, safe_windows
from rigdesign.results.vibration import AvoidedResonance

LIMIT, MARGIN = 0.2, 0.1


def share(*peaks: tuple[float, float], width: float = 20.0) -> DynamicShare:
    """Triangular peaks: speed and height."""
    speed = np.linspace(0.0, 2000.0, 2001)
    values = np.zeros(speed.size)
    for at, height in peaks:
        values = np.maximum(values, height * (1.0 - np.abs(speed - at) / width))
    return DynamicShare("dynamic factor", "test", speed, values)


def found(quantity: DynamicShare) -> list[AvoidedResonance]:
    return list(resonances(quantity, LIMIT, MARGIN))


def test_a_narrow_peak_is_avoided_by_the_margin() -> None:
    (one,) = found(share((1000.0, 0.5)))
    assert one.speed == 1000.0
    assert one.share == pytest.approx(0.5)
    assert [one.low, one.high] == pytest.approx([1000.0 / 1.1, 1000.0 / 0.9])


def test_a_wide_peak_is_avoided_as_far_as_it_exceeds_the_limit() -> None:
    """0.5 (1 - d / 500) = 0.2 at d = 300."""
    (one,) = found(share((1000.0, 0.5), width=500.0))
    assert [one.low, one.high] == pytest.approx([700.0, 1300.0])


def test_a_peak_below_the_limit_is_none() -> None:
    assert not found(share((1000.0, 0.19)))


def test_a_response_that_rises_to_the_end_is_avoided_to_the_end() -> None:
    (one,) = found(share((2000.0, 0.5)))
    assert one.high == pytest.approx(2000.0 / 0.9)


@pytest.mark.parametrize("width", [20.0, 500.0])
@pytest.mark.parametrize("speed", np.linspace(600.0, 1500.0, 37))
def test_a_speed_is_in_the_band_of_a_peak_just_where_it_is_nearer_than_the_limit(
    speed: float, width: float
) -> None:
    """The checks and the ramp ask the same: 900 rpm is 11 % off a peak at 1000, 1100 rpm 9 %."""
    (one,) = found(share((1000.0, 0.5), width=width))
    assert (one.distance(speed, MARGIN) < MARGIN) == (one.low < speed < one.high)


def test_bands_that_touch_are_one() -> None:
    merged = bands(found(share((1000.0, 0.5), (1150.0, 0.4), (1800.0, 0.3))))
    assert [(round(b.low), round(b.high), len(b.resonances)) for b in merged] == [
        (909, 1278, 2),
        (1636, 2000, 1),
    ]


def test_what_is_left_is_safe() -> None:
    avoided = bands(found(share((1000.0, 0.5), (1800.0, 0.3))))
    windows = safe_windows(avoided, 500.0, 1900.0)
    assert [end for window in windows for end in window] == pytest.approx(
        [500.0, 1000.0 / 1.1, 1000.0 / 0.9, 1800.0 / 1.1]
    )
    assert nearest_safe(windows, 1050.0) == pytest.approx(1000.0 / 0.9)
    assert nearest_safe(windows, 700.0) == 700.0
    assert nearest_safe((), 700.0) is None
