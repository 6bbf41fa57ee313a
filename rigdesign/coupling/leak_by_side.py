"""Gear oil that leaks into the cold chamber of one side more than into the other: what the oil there is warmer by.

The oil of the bearings leaves as one stream; its mean temperature is that of `rigdesign.coupling.oil`. On each side the
oil of its own bearings, all warmed alike, mixes with the part of the leak that arrives there.
"""

from rigdesign.coupling.state import CouplingState
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import bearing_feed, gear_feed
from thermal.housing.measures import SIDES

EVEN = 0.5
"""Share of a leak that reaches the front where it divides evenly."""


def side_excess(rig: Rig, name: str, state: CouplingState, surface: str, fluid: str) -> float:
    """How much warmer the oil at a surface is than the mixed oil of the bearings [K]; zero for other fluids.

    name : gearbox; fluid : as the case names it, ``bearing_oil_outlet`` or ``bearing_oil_mean``
    """
    box = rig.case.gearboxes[name]
    share, in_front = box.oil_paths.leak_warm_cold, box.oil_paths.leak_front_share
    side = next((side for side in SIDES if side in surface.split("_")), None)
    follows = {"bearing_oil_outlet": 1.0, "bearing_oil_mean": 0.5}.get(fluid, 0.0)
    if not (share and follows) or side is None or in_front == EVEN or box.fed_bearings is None:
        return 0.0
    warm, mixed = (state.oil_outlet[f"{name}.{kind}"] for kind in ("gear_oil", "bearing_oil"))
    leak = share * gear_feed(rig, name, warm, state.oil_supply).capacity_rate
    each = bearing_feed(rig, name, warm, state.oil_supply).capacity_rate
    cold = mixed + leak / (each * len(box.bearings)) * (mixed - warm)
    part = leak * (in_front if side == "front" else 1.0 - in_front)
    own = each * sum(bearing.side == side for bearing in box.bearings.values())
    return follows * ((own * cold + part * warm) / (own + part) - mixed) if own + part else 0.0
