"""Constants of the heat part: what no data sheet of a rig knows better than some per cent, with spreads."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Constant:
    """Nominal value and spread; ``spread`` is relative (1 sigma) unless ``absolute``."""

    value: float
    spread: float
    absolute: bool = False
    widened: float = 1.0
    """Factor on the spread in the shifted part of the test split."""
    moved: float = 0.0
    """Relative (or absolute) move of the mean there."""


# fmt: off
CONSTANTS: Mapping[str, Constant] = {
    "k_housing": Constant(1.0, 0.05), "k_field": Constant(1.0, 0.08), "k_shafts": Constant(1.0, 0.05),
    "k_slope": Constant(-4.5e-4, 0.10), "shell_contact": Constant(4.0e4, 0.10), "foot_contact": Constant(4.0e3, 0.10),
    "seat_contact": Constant(2.0e4, 0.10),
    # films inside at full speed and the flow of the case [W/(m2 K)], and their exponents
    "film_chamber": Constant(320.0, 0.08), "film_sump": Constant(280.0, 0.10), "film_cold": Constant(290.0, 0.08),
    "film_cold_end": Constant(320.0, 0.10), "film_cold_floor": Constant(270.0, 0.10),
    "film_seal_bore": Constant(260.0, 0.10), "film_rim": Constant(650.0, 0.08),
    "film_shaft_cold": Constant(1.0, 0.08),
    "film_disc": Constant(0.95, 0.08), "film_drum": Constant(0.9, 0.08), "film_seal_gap": Constant(110.0, 0.10),
    "nusselt_bearing": Constant(4.0, 0.07),
    "exponent_chamber": Constant(0.12, 0.04, True, 2.0, 0.05), "exponent_cold": Constant(0.10, 0.04, True, 2.0, 0.04),
    "exponent_rim": Constant(0.18, 0.04, True, 2.0, -0.04), "exponent_flow": Constant(0.15, 0.04, True, 2.0),
    "exponent_viscosity": Constant(0.05, 0.02, True, 2.0),
    # room
    "free_wall": Constant(1.15, 0.06), "free_top": Constant(1.10, 0.06), "free_field": Constant(0.95, 0.06),
    "draught": Constant(1.0, 0.10, False, 1.5, 0.25), "draught_speed": Constant(0.15, 0.05, True, 2.0),
    "emissivity_housing": Constant(1.0, 0.05), "emissivity_field": Constant(1.0, 0.03),
    "emissivity_shaft": Constant(1.0, 0.08), "film_overhang": Constant(1.0, 0.08),
    "room_layers": Constant(1.0, 0.3, True, 2.0, 2.0),
    # losses
    "friction": Constant(1.0, 0.06), "friction_load": Constant(0.20, 0.02, True, 1.5, 0.02),
    "friction_speed": Constant(0.0, 0.03, True, 1.5, -0.03), "friction_viscosity": Constant(0.05, 0.01, True, 1.5),
    "film_fill": Constant(0.97, 0.04), "clearance_test": Constant(1.0, 0.03),
    "clearance_reference": Constant(1.0, 0.03),
    "film_weight": Constant(0.60, 0.05), "rim_drag": Constant(0.055, 0.08), "mist_density": Constant(1.0, 0.08),
    "mist_exponent": Constant(0.0, 0.05, True, 2.0, 0.05), "jet_carried": Constant(0.97, 0.03),
    "squeeze": Constant(1.0, 0.10), "seal_drag": Constant(1.0, 0.10), "into_gears": Constant(1.0, 0.06),
    "mesh_damping": Constant(1.0, 0.22),
    "pinion_share": Constant(1.0, 0.04),
    # oil
    "oil_viscosity": Constant(1.0, 0.04), "oil_index": Constant(1.0, 0.02), "oil_heat_capacity": Constant(1.0, 0.02),
    "oil_density": Constant(1.0, 0.01), "oil_conductivity": Constant(1.0, 0.04),
    "mist_share": Constant(0.35, 0.10), "straight_to_sump": Constant(0.20, 0.10),
    "spray_front": Constant(0.5, 0.03, True, 2.0, 0.05), "feed_front": Constant(1.0, 0.04),
    "feed_pinion": Constant(1.0, 0.04),
    "layers": Constant(4.0, 1.5, True, 1.5, 6.0),
    # gearboxes without a field: heat from each oil through the walls [W/K]
    "wall_loss_test": Constant(0.8, 0.10), "wall_loss_reference": Constant(0.8, 0.10),
}
# fmt: on
"""``layers``: how much warmer the oil at the top of the chamber wall is than at the bottom [K];
``room_layers``: the same of the room air over the height of the box [K]; ``draught``: [m/s]."""


def nominal() -> dict[str, float]:
    """Every constant at its nominal value."""
    return {name: constant.value for name, constant in CONSTANTS.items()}


def draw_constants(rng: np.random.Generator, shift: bool = False) -> dict[str, float]:
    """One rig: every constant drawn (lognormal where relative, within 3 sigma).

    shift : another population: other draught, layered air and oil, wider exponents; for part of the test split
    """
    return {name: drawn(constant, rng, shift) for name, constant in CONSTANTS.items()}


def sigma(name: str) -> float:
    """Spread of a constant in its own unit, for sensitivities (1 sigma about the nominal value)."""
    return step_of(CONSTANTS[name])


def step_of(constant: Constant) -> float:
    """One standard deviation of a constant in its own unit."""
    return constant.spread if constant.absolute else abs(constant.value) * constant.spread


def drawn(constant: Constant, rng: np.random.Generator, shift: bool) -> float:
    """A value of a constant."""
    step = (
        float(np.clip(rng.standard_normal(), -3.0, 3.0))
        * constant.spread
        * (constant.widened if shift else 1.0)
    )
    move = constant.moved if shift else 0.0
    if constant.absolute:
        return constant.value + move + step
    return constant.value * (1.0 + move) * float(np.exp(step))
