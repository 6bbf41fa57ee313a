"""Load against approach of a rolling element between both raceways.

Balls: Hertz point contact of a ball in a groove, the ellipse from the complete elliptic integrals (T. A. Harris,
Rolling Bearing Analysis, chapter 6). Rollers: line contact after A. Palmgren, delta = 3.84e-5 Q^0.9 / L^0.8 (N, mm)
for each of the two contacts. Steel on steel.
"""

import math
from dataclasses import dataclass

from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from dynamics.bearing.rolling_elements import RollingElements

YOUNG_MODULUS = 2.08e11
"""Rolling bearing steel [Pa]."""
POISSON_RATIO = 0.3
INNER_CONFORMITY = 0.52
OUTER_CONFORMITY = 0.53
"""Groove radius over ball diameter, the largest that ISO 281 rates in full; assumed where not known."""
POINT_EXPONENT = 1.5
LINE_EXPONENT = 10.0 / 9.0
PALMGREN_COMPLIANCE = 3.84e-5
"""One line contact, N and mm."""


@dataclass(frozen=True, kw_only=True)
class ContactLaw:
    """Q = stiffness delta^exponent of one rolling element between both raceways.

    stiffness : [N/m^exponent]
    exponent : 3/2 point, 10/9 line
    groove_distance : distance of the groove centres of a ball bearing, r_i + r_o - D_w [m]; 0 for rollers
    inner_groove_offset : of the groove centre of the inner ring from the ball centre, r_i - D_w / 2 [m]; 0 for rollers
    """

    stiffness: float
    exponent: float
    groove_distance: float = 0.0
    inner_groove_offset: float = 0.0


@dataclass(frozen=True, kw_only=True)
class BallGroove:
    """Conformities and elasticity of balls and grooves.

    inner, outer : groove radius over ball diameter, above 0.5 [-]
    young_modulus : [Pa]
    poisson_ratio : [-]
    """

    inner: float = INNER_CONFORMITY
    outer: float = OUTER_CONFORMITY
    young_modulus: float = YOUNG_MODULUS
    poisson_ratio: float = POISSON_RATIO


COMMON_GROOVE = BallGroove()


def contact_law(elements: RollingElements, groove: BallGroove = COMMON_GROOVE) -> ContactLaw:
    """Contact law of the rolling elements; ``groove`` is read for balls."""
    if elements.roller:
        length = elements.length * 1e3
        one = (1.0 / PALMGREN_COMPLIANCE) ** LINE_EXPONENT * length ** (8.0 / 9.0)
        both = one / 2.0**LINE_EXPONENT
        return ContactLaw(stiffness=both * 1e3**LINE_EXPONENT, exponent=LINE_EXPONENT)
    ball, gamma = elements.diameter, elements.gamma
    inner = _point_stiffness(ball, 2.0 * gamma / (1.0 - gamma), groove.inner, groove)
    outer = _point_stiffness(ball, -2.0 * gamma / (1.0 + gamma), groove.outer, groove)
    both = (inner ** (-2.0 / 3.0) + outer ** (-2.0 / 3.0)) ** -1.5
    return ContactLaw(
        stiffness=both,
        exponent=POINT_EXPONENT,
        groove_distance=(groove.inner + groove.outer - 1.0) * ball,
        inner_groove_offset=(groove.inner - 0.5) * ball,
    )


def _point_stiffness(ball: float, rolling: float, conformity: float, groove: BallGroove) -> float:
    """Q / delta^1.5 of a ball on one raceway [N/m^1.5].

    rolling : curvature of the raceway in the rolling direction times the ball diameter; of the groove -1 / conformity
    """
    sum_rho = (4.0 - 1.0 / conformity + rolling) / ball
    difference = (1.0 / conformity + rolling) / ball / sum_rho
    kappa = ellipse_ratio(difference)
    modulus = 1.0 - 1.0 / kappa**2
    first, second = float(ellipk(modulus)), float(ellipe(modulus))
    approach = 2.0 * first / math.pi * (math.pi / (2.0 * kappa**2 * second)) ** (1.0 / 3.0)
    compliance = 2.0 * (1.0 - groove.poisson_ratio**2) / groove.young_modulus
    unit = approach * (1.5 / sum_rho * compliance) ** (2.0 / 3.0) * 0.5 * sum_rho
    stiffness: float = unit**-1.5
    return stiffness


def ellipse_ratio(difference: float) -> float:
    """Ratio a / b of the contact ellipse at the curvature difference F(rho), 0 to below 1.

    F = ((kappa^2 + 1) E - 2 K) / ((kappa^2 - 1) E) with the complete elliptic integrals of modulus 1 - 1 / kappa^2
    """
    if difference < 1e-9:
        return 1.0

    def excess(log_kappa: float) -> float:
        square = math.exp(2.0 * log_kappa)
        modulus = 1.0 - 1.0 / square
        second = float(ellipe(modulus))
        return ((square + 1.0) * second - 2.0 * float(ellipk(modulus))) / (
            (square - 1.0) * second
        ) - difference

    return math.exp(float(brentq(excess, 1e-5, math.log(1e4), xtol=1e-13)))
