"""Separation margins of API 617 at hand values."""

import pytest

from dynamics.standards.api617_2014 import separation_above, separation_below


@pytest.mark.parametrize(("factor", "below"), [(2.4, 0.0), (2.5, 0.0), (4.0, 0.102), (1e9, 0.17)])
def test_margins_grow_with_the_amplification(factor: float, below: float) -> None:
    assert separation_below(factor) == pytest.approx(below, abs=1e-9)
    above = below + 0.10 if factor >= 2.5 else 0.0
    assert separation_above(factor) == pytest.approx(above, abs=1e-9)
