"""Clearances of one housing at one moment: seals, shafts, bearings and meshes."""

from collections.abc import Mapping
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from rigdesign.coupling.bearing_seats import WarmBearing
from rigdesign.coupling.expansion import hot_clearances, named_expansion
from rigdesign.rig.model import Rig
from thermal.expansion.expansion import Expansion

Quantity = Literal["seal_gap", "axial_play", "bearing_clearance", "backlash", "tip_clearance"]
QUANTITIES: tuple[Quantity, ...] = get_args(Quantity)
Clearances = Mapping[Quantity, Mapping[str, float]]
"""Quantity -> place -> clearance [m]."""


def clearances(
    rig: Rig,
    name: str,
    temperature: NDArray[np.float64],
    shape: Expansion,
    speed: float,
    seated: Mapping[str, WarmBearing] | None = None,
) -> Clearances:
    """Every clearance of the housing of gearbox ``name``.

    speed : where the case counts it [rad/s]; seated : bearings that conduct heat to their seats, by ``gearbox.bearing``

    Gears grow with the mean temperature of their bodies and with their speed, journals with theirs.
    """
    expansion = named_expansion(rig, name, shape)
    box = rig.case.gearboxes[name]
    bulk = {
        gear: rig.conduction[name].elements.body_mean(temperature, f"gear_{entry.shaft}")
        for gear, entry in box.gears.items()
    }
    backlash, tip = {}, {}
    for own, mesh in box.meshes.items():
        full = f"{name}.{own}"
        gears = box.gears[mesh.pinion], box.gears[mesh.wheel]
        first, second = (rig.materials[gear.material].expansion_coefficient for gear in gears)
        pair = rig.pairs[full].warm(
            bulk[mesh.pinion],
            bulk[mesh.wheel],
            expansion.centre_distance[full],
            reference_temperature=rig.case.ambient.reference_temperature,
            expansion_coefficients=(first, second),
            speed=rig.shaft_speed(gears[0].shaft, speed),
        )
        backlash[full], tip[full] = pair.transverse_backlash, min(pair.tip_clearances)
    play = {b.shaft: b.axial_play for b in box.bearings.values() if b.locating}
    bearings = hot_clearances(rig, speed, {name: expansion}, seated)
    return {
        "seal_gap": {seal.name: seal.minimum for seal in shape.seals.values()},
        "axial_play": {s.name: play[s.name] - s.axial_play_change for s in shape.shafts.values()},
        "bearing_clearance": {key: value for key, value in bearings.items() if key.split(".")[0] == name},
        "backlash": backlash,
        "tip_clearance": tip,
    }


def smallest(found: Clearances, quantity: Quantity) -> tuple[float, str]:
    """Least clearance of a kind [m] and where it is."""
    place = min(found[quantity], key=lambda key: found[quantity][key])
    return found[quantity][place], place
