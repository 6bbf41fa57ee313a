"""Shaft orders near the dwells of a rig: those of the modes at the nearest of them, of the tracked modes elsewhere."""

from types import SimpleNamespace
from typing import Any

from rigdesign.postprocessing.dwell_speeds import _orders
from rigdesign.postprocessing.nearest_resonance import NearDwell
from rigdesign.results.vibration import AvoidedResonance, CampbellCrossing


def order(speed: float, mode: str) -> AvoidedResonance:
    return AvoidedResonance(
        kind="shaft order", where=mode, speed=speed, share=None, low=0.9 * speed, high=1.1 * speed
    )


def tracked(speed: float) -> CampbellCrossing:
    return CampbellCrossing(
        mode=1, kind="shaft", of=("a",), harmonic=1.0, speed=speed, frequency=10.0, damping_ratio=0.01, gain=0.0
    )  # fmt: skip


def test_every_dwell_has_the_orders_of_its_own_modes() -> None:
    """Dwells at 100 and 300 rad/s; a mode that bearings stiffen is met at 105 by the first, at 95 by the second."""
    near = {
        100.0: NearDwell(100.0, 0.1, (), (order(105.0, "at 100"), order(290.0, "at 100"))),
        300.0: NearDwell(300.0, 0.1, (), (order(95.0, "at 300"), order(310.0, "at 300"))),
    }
    diagram: Any = SimpleNamespace(
        modes=[SimpleNamespace(number=1, name="bow")], crossings=[tracked(98.0), tracked(200.0)]
    )
    found = list(_orders(diagram, near, 0.1))
    assert [one.speed for one in found] == [200.0, 105.0, 310.0]
    assert "(bow)" in found[0].where
