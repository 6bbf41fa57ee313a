"""Films of the heat part: still and moving room air, radiation, rotating parts in mist, and those wetted by oil."""

import math

import numpy as np

SIGMA = 5.670374e-8
PRANDTL = 0.707


def air(temperature: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Conductivity [W/(m K)] and kinematic viscosity [m2/s] of air at a film temperature [K], power laws."""
    ratio = temperature / 300.0
    return 0.0263 * ratio**0.84, 15.9e-6 * ratio**1.77


def rayleigh(surface: np.ndarray, room: np.ndarray, length: float) -> np.ndarray:
    """Ra of a plate [-]."""
    film = 0.5 * (surface + room)
    _, nu = air(film)
    return 9.81 / film * np.abs(surface - room) * length**3 / nu**2 * PRANDTL


def vertical(surface: np.ndarray, room: np.ndarray, height: float) -> np.ndarray:
    """Churchill and Chu, all Ra [W/(m2 K)]."""
    k, _ = air(0.5 * (surface + room))
    ra = rayleigh(surface, room, height)
    factor = (1.0 + (0.492 / PRANDTL) ** (9.0 / 16.0)) ** (-8.0 / 27.0)
    return k / height * (0.825 + 0.387 * ra ** (1.0 / 6.0) * factor) ** 2


def upward(surface: np.ndarray, room: np.ndarray, length: float) -> np.ndarray:
    """Plate facing up: McAdams 0.54 Ra^1/4 and 0.15 Ra^1/3, the larger if hot; a quarter root law if cold."""
    k, _ = air(0.5 * (surface + room))
    ra = np.maximum(rayleigh(surface, room, length), 1.0)
    hot = np.maximum(0.54 * ra**0.25, 0.15 * ra ** (1.0 / 3.0))
    return k / length * np.where(surface >= room, hot, 0.27 * ra**0.25)


def draught(speed: float, length: float, room: float) -> float:
    """Laminar plate in a draught [W/(m2 K)]."""
    k, nu = air(np.array(room + 20.0))
    return float(0.664 * math.sqrt(speed * length / nu) * PRANDTL ** (1.0 / 3.0) * k / length)


def mixed(free: np.ndarray, forced: float) -> np.ndarray:
    """Third-power blend of free and forced convection."""
    return np.cbrt(free**3 + forced**3)


def radiation(emissivity: float, surface: np.ndarray, room: np.ndarray) -> np.ndarray:
    """Secant coefficient to surroundings at room temperature [W/(m2 K)]."""
    return emissivity * SIGMA * (surface**2 + room**2) * (surface + room)


def disc(speed: float, radius: float, density: float) -> float:
    """Face of a disc in gas or mist [W/(m2 K)]: laminar core and turbulent rim, mean."""
    reynolds = density * speed * radius**2 / 2.1e-5
    nusselt = max(0.36 * math.sqrt(reynolds), 0.015 * reynolds**0.8 - 100.0 * min(1.0, reynolds / 2.5e5))
    return max(nusselt, 2.0) * 0.032 / radius


def drum(speed: float, diameter: float, density: float, warmer: float = 30.0) -> float:
    """Turning cylinder in gas or mist [W/(m2 K)], Kays and Bjorklund."""
    nu = 2.1e-5 / density
    reynolds = speed * diameter**2 / (2.0 * nu)
    grashof = 9.81 / 330.0 * warmer * diameter**3 / nu**2
    return 0.11 * ((0.5 * reynolds**2 + grashof) * PRANDTL) ** 0.35 * 0.032 / diameter
