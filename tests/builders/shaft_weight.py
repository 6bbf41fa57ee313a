"""Weight of a shaft with its discs by hand, from the case."""

import math

from rigdesign.rig.model import Rig

GRAVITY = 9.80665


def shaft_weight(rig: Rig, shaft: str) -> float:
    """Of sections and discs [N], without gears."""
    return _moments(rig, shaft)[0]


def weight_on_bearing(rig: Rig, bearing: str, gear_mass: float) -> float:
    """Share of ``gearbox.bearing`` in the weight of its shaft, discs and one gear [N], by moments about the other."""
    box = rig.case.gearboxes[bearing.split(".")[0]]
    entry = rig.bearing(bearing)
    other = next(b.position for b in box.bearings.values() if b.shaft == entry.shaft and b is not entry)
    gear = next(g.position for g in box.gears.values() if g.shaft == entry.shaft)
    assert other is not None and entry.position is not None and gear is not None
    weight, moment = _moments(rig, entry.shaft)
    weight, moment = weight + GRAVITY * gear_mass, moment + GRAVITY * gear_mass * gear
    return (other * weight - moment) / (other - entry.position)


def _moments(rig: Rig, shaft: str) -> tuple[float, float]:
    """Weight [N] and its moment about the start of the shaft [N m]."""
    power = rig.case.drivetrain
    assert power is not None and rig.drivetrain is not None
    part = power.shafts[shaft]
    density = rig.materials[part.material].density
    weight = moment = start = 0.0
    for section in part.sections:
        area = 0.25 * math.pi * (section.outer_diameter**2 - section.inner_diameter**2)
        own = GRAVITY * density * area * section.length
        weight, moment = weight + own, moment + own * (start + 0.5 * section.length)
        start += section.length
    for disc in rig.drivetrain.shaft(shaft).discs:
        weight, moment = weight + GRAVITY * disc.mass, moment + GRAVITY * disc.mass * disc.position
    return weight, moment
