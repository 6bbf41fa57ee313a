"""Equivalent loads, rating life, static safety, least load and speed limits of a rolling bearing.

Sources: ISO 281 and ISO 76 with the factors of the catalogues (SKF General Catalogue 6000, chapters of the four kinds;
NSK for the same factors of angular contact ball bearings).
"""

import math
from dataclasses import dataclass
from itertools import pairwise

from dynamics.rotor.bearing import BearingError
from dynamics.rotor.rolling_catalogue import RPM, CatalogueBearing
from dynamics.standards import iso281_2007

DEEP_GROOVE_FACTORS = (
    (0.172, 0.19, 2.30), (0.345, 0.22, 1.99), (0.689, 0.26, 1.71), (1.03, 0.28, 1.55), (1.38, 0.30, 1.45),
    (2.07, 0.34, 1.31), (3.45, 0.38, 1.15), (5.17, 0.42, 1.04), (6.89, 0.44, 1.00),
)  # fmt: skip
"""f_0 F_a / C_0, e, Y of deep groove ball bearings with normal clearance, X = 0.56 (SKF 6000 table 5 p. 299)."""
LARGEST_AXIAL_SHARE = 0.5
"""F_a / F_r that flanges of a cylindrical roller bearing, F_a / C_0 that a deep groove ball bearing should carry."""


@dataclass(frozen=True, kw_only=True)
class RatingLife:
    """Life and safety of a bearing at one load.

    equivalent_load, static_equivalent_load : P, P_0 [N]
    basic_life, modified_life : at the reliability asked for [h]; infinite at rest or without load
    life_modification : a_1 a_ISO [-]
    viscosity_ratio : kappa [-]; 0 at rest
    static_safety : C_0 / P_0 [-]
    """

    equivalent_load: float
    static_equivalent_load: float
    basic_life: float
    modified_life: float
    life_modification: float
    viscosity_ratio: float
    static_safety: float


def equivalent_load(bearing: CatalogueBearing, radial: float, axial: float) -> float:
    """Dynamic equivalent load P [N] of a single bearing; the axial force is the one inside it, the induced included.

    Raises BearingError for axial load on a bearing that carries none.
    """
    check_axial(bearing, axial)
    if bearing.kind == "deep_groove_ball":
        limit, factor = deep_groove_factors(bearing, axial)
        return radial if axial <= limit * radial else max(radial, 0.56 * radial + factor * axial)
    if bearing.kind == "cylindrical_roller":
        limit, factor = (0.2, 0.6) if bearing.series in ("10", "2", "3", "4") else (0.3, 0.4)
        return radial if axial <= limit * radial else 0.92 * radial + factor * axial
    share = 0.4 if bearing.kind == "tapered_roller" else 0.35
    return radial if axial <= bearing.axial_limit * radial else share * radial + bearing.axial_factor * axial


def deep_groove_factors(bearing: CatalogueBearing, axial: float) -> tuple[float, float]:
    """e and Y of a deep groove ball bearing, linear between the printed values and constant outside them."""
    f_0 = 14.0 if bearing.f_0 is None else bearing.f_0
    relative = f_0 * axial / bearing.static_rating
    first, last = DEEP_GROOVE_FACTORS[0], DEEP_GROOVE_FACTORS[-1]
    if relative <= first[0]:
        return first[1], first[2]
    for low, high in pairwise(DEEP_GROOVE_FACTORS):
        if relative <= high[0]:
            share = (relative - low[0]) / (high[0] - low[0])
            return low[1] + share * (high[1] - low[1]), low[2] + share * (high[2] - low[2])
    return last[1], last[2]


def static_equivalent_load(bearing: CatalogueBearing, radial: float, axial: float) -> float:
    """Static equivalent load P_0 [N] of a single bearing."""
    if bearing.kind == "deep_groove_ball":
        return max(radial, 0.6 * radial + 0.5 * axial)
    if bearing.kind == "cylindrical_roller":
        return radial
    return max(radial, 0.5 * radial + bearing.static_axial_factor * axial)


def check_axial(bearing: CatalogueBearing, axial: float) -> None:
    """Raises BearingError for axial load on a bearing that cannot carry it."""
    if axial > 0.0 and not bearing.locating:
        raise BearingError(
            f"rolling bearing {bearing.designation}: axial_load = {axial:.6g} N: its rings move past each other and "
            "carry none; take the axial load up in the other bearing or choose NJ, NUP or a locating kind"
        )


def induced_axial_load(bearing: CatalogueBearing, radial: float) -> float:
    """Axial force that the radial load of a tapered or angular contact bearing produces [N]; 0 for other kinds.

    F_r / (2 Y) for tapered roller bearings (SKF 6000 table 3 p. 613), e F_r for angular contact ball bearings of 40
    degrees (the value at high load; less below it).
    """
    if bearing.kind == "tapered_roller":
        return radial / (2.0 * bearing.axial_factor)
    return bearing.axial_limit * radial if bearing.kind == "angular_contact_ball" else 0.0


def minimum_load(bearing: CatalogueBearing, speed: float, viscosity: float) -> float:
    """Radial load below which rolling elements may slide [N]; kinematic viscosity [m2/s], speed [rad/s].

    Balls k_r (nu n / 1000)^(2/3) (d_m / 100)^2, cylindrical rollers k_r (6 + 4 n / n_r) (d_m / 100)^2 in kN, tapered
    rollers 0.02 C (SKF General Catalogue 6000 pp. 299, 414, 518, 611).
    """
    if bearing.kind == "tapered_roller":
        return 0.02 * bearing.dynamic_rating
    size = (bearing.mean_diameter * 10.0) ** 2
    if bearing.kind == "cylindrical_roller":
        return 1e3 * bearing.minimum_load_factor * (6.0 + 4.0 * speed / bearing.reference_speed) * size
    product = viscosity * 1e6 * speed / RPM / 1000.0
    load: float = 1e3 * bearing.minimum_load_factor * product ** (2.0 / 3.0) * size
    return load


@dataclass(frozen=True, kw_only=True)
class LifeConditions:
    """What the life of a bearing depends on besides the bearing.

    radial, axial : load, not negative [N]
    speed : magnitude [rad/s]
    viscosity : kinematic, at the bearing temperature [m2/s]
    contamination : factor e_C of ISO 281, 0 to 1
    reliability : 0.90 to 0.99
    """

    radial: float
    axial: float
    speed: float
    viscosity: float
    contamination: float
    reliability: float


def rating_life(bearing: CatalogueBearing, conditions: LifeConditions) -> RatingLife:
    """Basic and modified rating life at constant load and speed (ISO 281)."""
    load = equivalent_load(bearing, conditions.radial, conditions.axial)
    static = static_equivalent_load(bearing, conditions.radial, conditions.axial)
    n = conditions.speed / RPM
    kappa = conditions.viscosity * 1e6 / iso281_2007.nu_1(n, bearing.elements.pitch_diameter * 1e3)
    modification = iso281_2007.a_1(conditions.reliability)
    if load > 0.0:
        modification *= iso281_2007.a_ISO(
            kappa, conditions.contamination * bearing.fatigue_load / load, bearing.contact
        )
    revolutions = iso281_2007.L_10(bearing.dynamic_rating, load, bearing.contact)
    hours = revolutions * 1e6 / (60.0 * n) if n > 0.0 else math.inf
    return RatingLife(
        equivalent_load=load,
        static_equivalent_load=static,
        basic_life=hours,
        modified_life=modification * hours,
        life_modification=modification,
        viscosity_ratio=kappa,
        static_safety=bearing.static_rating / static if static > 0.0 else math.inf,
    )
