"""Losses beside the teeth: journal bearings, discs and rims in mist, oil jets, gap seals."""

import math
from functools import cache

import numpy as np


@cache
def _carried(slenderness: float) -> tuple[np.ndarray, np.ndarray]:
    """ln of W / (eta omega R B (R/c)^2) over eccentricity: short and long bearing in series."""
    eps = np.concatenate([np.linspace(1e-4, 0.9, 400), 1.0 - np.geomspace(0.1, 1e-4, 200)[1:]])
    short = slenderness**2 * eps * np.sqrt(16.0 * eps**2 + math.pi**2 * (1.0 - eps**2)) / (1.0 - eps**2) ** 2
    long = 6.0 * eps * np.sqrt(math.pi**2 - eps**2 * (math.pi**2 - 4.0)) / ((2.0 + eps**2) * (1.0 - eps**2))
    return np.log(short * long / (short + long)), eps


def eccentricity(load: float, slenderness: float) -> float:
    """Relative eccentricity from W / (eta omega R B (R/c)^2) and B/D.

    Ocvirk's short bearing and half of Sommerfeld's long one, loads added as in series: right at both ends.
    """
    logs, eps = _carried(round(slenderness, 6))
    return float(np.interp(math.log(load), logs, eps))


def bearing_power(eta: float, speed: float, diameter: float, width: float, clearance: float, load: float,
                  fill: float = 0.9) -> float:  # fmt: skip
    """Drag of a journal bearing [W]: Petroff over the eccentric gap, and the turned pressure force.

    clearance : radial [m]; fill : share of the circumference that is full of oil
    """
    if speed <= 0.0:
        return 0.0
    radius = diameter / 2.0
    capacity = eta * speed * radius * width * (radius / clearance) ** 2
    eps = eccentricity(max(load, 1.0) / capacity, width / diameter)
    petroff = 2.0 * math.pi * eta * speed * radius**3 * width / clearance
    attitude = math.atan2(math.pi * math.sqrt(1.0 - eps * eps), 4.0 * eps)
    turned = 0.5 * clearance * eps * load * math.sin(attitude)
    return (fill * petroff / math.sqrt(1.0 - eps * eps) + turned) * speed


def windage_power(speed: float, radius: float, width: float, density: float, teeth: float) -> float:
    """Gear in mist [W]: both faces as turbulent discs (von Karman), the rim as a drum with drag ``teeth``."""
    viscosity = 2.1e-5
    reynolds = max(density * speed * radius**2 / viscosity, 1.0)
    disc = max(3.87 / math.sqrt(reynolds), 0.146 * reynolds**-0.2)
    faces = 0.5 * disc * density * speed**3 * radius**5
    rim = 0.5 * teeth * density * (speed * radius) ** 3 * 2.0 * math.pi * radius * width
    return faces + rim


def jet_power(flow: float, density: float, surface_speed: float, jet_speed: float, direction: str) -> float:
    """Momentum given to the injected oil [W]; below zero where the jet is faster than the teeth."""
    along = {"into_mesh": 1.0, "out_of_mesh": -1.0}.get(direction, 0.0)
    return density * flow * surface_speed * (surface_speed - along * jet_speed)


def gap_seal_power(speed: float, diameter: float, length: float, gap: float, density: float) -> float:
    """Contactless seal [W]: turbulent shear of mist in the gap, Blasius' coefficient of half the surface speed."""
    wall = speed * diameter / 2.0
    if wall <= 0.0:
        return 0.0
    reynolds = max(density * wall * gap / (2.0 * 2.1e-5), 1.0)
    shear = max(2.1e-5 * wall / gap, 0.5 * 0.079 * reynolds**-0.25 * density * (wall / 2.0) ** 2)
    return shear * math.pi * diameter * length * wall
