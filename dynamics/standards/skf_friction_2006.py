"""SKF model of the frictional moment: M = phi_ish phi_rs M_rr + M_sl + M_seal + M_drag, without that of contact seals.

Symbols and units as printed (N, mm, mm2/s, 1/min), moments in N mm. Sources: SKF General Catalogue 6000, pp. 87-105
(equations, tables 2a, 3, 3a, 3c, 3d, 5 and the worked example were read), this edition alone: later ones (10000,
17000) have 0.4 of its drag plus a turbulent term, mu_bl = 0.12 in motion and other constants. The curve of V_M exists
as a diagram only: the points below are from memory of it, +-30 %, tied to the two values that are printed or quoted
(roller 0.3e-4 at H/d_m = 0.041; ball 0.0012 when submerged).
"""

import math
from bisect import bisect_right
from typing import NamedTuple

STABILISED_TEMPERATURE = 393.15
"""Rings keep their size up to here (120 degC) [K]."""
MU_BL = 0.15
"""Sliding friction coefficient of mixed lubrication, by additive package (p. 100: about 0.15); also at the start."""
MU_EHL = {"mineral": 0.05, "synthetic": 0.04, "transmission": 0.1}
"""Sliding friction coefficient in full film by lubricant; cylindrical and tapered bearings have their own."""

K_RS = {"oil_bath": 3e-8, "oil_jet": 3e-8, "oil_spot": 6e-8, "grease": 6e-8}
"""Starvation constant; in an oil bath only below the centre of the lowest rolling element, above it none."""


class KindConstants(NamedTuple):
    """Constants of a kind, single row, with cage: those of table 5, and mu_EHL of kinds with their own (p. 91).

    K_L is None for balls, mu_EHL for kinds that take that of the lubricant.
    """

    K_Z: float
    K_L: float | None = None
    mu_EHL: float | None = None


class BallConstants(NamedTuple):
    """Table 3a: deep groove ball bearings."""

    R_1: float
    R_2: float
    S_1: float
    S_2: float


class AngularConstants(NamedTuple):
    """Table 3: angular contact ball bearings; R_3, S_3 centrifugal."""

    R_1: float
    R_2: float
    R_3: float
    S_1: float
    S_2: float
    S_3: float


class CylindricalConstants(NamedTuple):
    """Table 3c: cylindrical roller bearings with cage."""

    R_1: float
    S_1: float
    S_2: float


class TaperedConstants(NamedTuple):
    """Table 3d: tapered roller bearings."""

    R_1: float
    R_2: float
    S_1: float
    S_2: float


DEEP_GROOVE = {
    "60": BallConstants(4.1e-7, 1.7, 3.73e-3, 14.6),
    "62": BallConstants(3.9e-7, 1.7, 3.23e-3, 36.5),
    "63": BallConstants(3.7e-7, 1.7, 2.84e-3, 92.8),
    "64": BallConstants(3.6e-7, 1.7, 2.43e-3, 198.0),
    "160": BallConstants(4.3e-7, 1.7, 4.63e-3, 4.25),
    "618": BallConstants(4.7e-7, 1.7, 6.50e-3, 0.78),
    "619": BallConstants(4.3e-7, 1.7, 4.75e-3, 3.6),
}
ANGULAR_CONTACT = AngularConstants(5.03e-7, 1.97, 1.90e-12, 1.30e-2, 0.68, 1.91e-12)
CYLINDRICAL = {
    "2": CylindricalConstants(1.09e-6, 0.16, 0.0015),
    "3": CylindricalConstants(1.09e-6, 0.16, 0.0015),
    "4": CylindricalConstants(1.00e-6, 0.16, 0.0015),
    "10": CylindricalConstants(1.12e-6, 0.17, 0.0015),
    "20": CylindricalConstants(1.23e-6, 0.16, 0.0015),
    "22": CylindricalConstants(1.40e-6, 0.16, 0.0015),
    "23": CylindricalConstants(1.48e-6, 0.16, 0.0015),
}
TAPERED = {
    "302": TaperedConstants(1.76e-6, 10.9, 0.017, 2.0),
    "303": TaperedConstants(1.69e-6, 10.9, 0.017, 2.0),
    "313": TaperedConstants(1.84e-6, 10.9, 0.048, 2.0),
    "320": TaperedConstants(2.38e-6, 10.9, 0.014, 2.0),
    "322": TaperedConstants(2.27e-6, 10.9, 0.018, 2.0),
    "323": TaperedConstants(2.38e-6, 10.9, 0.019, 2.0),
    "329": TaperedConstants(2.31e-6, 10.9, 0.009, 2.0),
    "330": TaperedConstants(2.71e-6, 11.3, 0.010, 2.0),
    "331": TaperedConstants(2.71e-6, 10.9, 0.015, 2.0),
    "332": TaperedConstants(2.71e-6, 10.9, 0.018, 2.0),
}

V_M_LEVEL = (0.0, 0.041, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2)
V_M_BALL = (0.0, 0.5e-4, 1.2e-4, 2.4e-4, 4.8e-4, 7.2e-4, 9.4e-4, 11.0e-4, 12.0e-4)
V_M_ROLLER = (0.0, 0.3e-4, 0.7e-4, 1.2e-4, 2.2e-4, 3.0e-4, 3.6e-4, 4.0e-4, 4.2e-4)
"""Drag variable over H / d_m; see the head of the module for what stands behind it."""


class Moments(NamedTuple):
    """G_rr and G_sl of table 2a: the variables of rolling and sliding."""

    G_rr: float
    G_sl: float


class Size(NamedTuple):
    """Main dimensions as the equations read them."""

    d: float
    D: float
    B: float

    @property
    def d_m(self) -> float:
        """Mean diameter 0.5 (d + D) [mm]."""
        return 0.5 * (self.d + self.D)


def deep_groove(row: BallConstants, d_m: float, F_r: float, F_a: float, C_0: float) -> Moments:
    """Table 2a, deep groove ball bearings; contact angle alpha_F = 24.6 (F_a / C_0)^0.24 degrees."""
    if F_a <= 0.0:
        return Moments(row.R_1 * d_m**1.96 * F_r**0.54, row.S_1 * d_m**-0.26 * F_r ** (5.0 / 3.0))
    sine = math.sin(math.radians(24.6 * (F_a / C_0) ** 0.24))
    rolling = row.R_1 * d_m**1.96 * (F_r + row.R_2 * F_a / sine) ** 0.54
    sliding = row.S_1 * d_m**-0.145 * (F_r**5 + row.S_2 * d_m**1.5 * F_a**4 / sine) ** (1.0 / 3.0)
    return Moments(rolling, sliding)


def angular_contact(row: AngularConstants, d_m: float, F_r: float, F_a: float, n: float) -> Moments:
    """Table 2a, single row angular contact ball bearings, with the centrifugal load F_g = R_3 d_m^4 n^2."""
    rolling = row.R_1 * d_m**1.97 * (F_r + row.R_3 * d_m**4 * n**2 + row.R_2 * F_a) ** 0.54
    radial = F_r + row.S_3 * d_m**4 * n**2
    return Moments(rolling, row.S_1 * d_m**0.26 * (radial ** (4.0 / 3.0) + row.S_2 * F_a ** (4.0 / 3.0)))


def cylindrical(row: CylindricalConstants, d_m: float, F_r: float, F_a: float) -> Moments:
    """Table 2a, cylindrical roller bearings."""
    return Moments(row.R_1 * d_m**2.41 * F_r**0.31, row.S_1 * d_m**0.9 * F_a + row.S_2 * d_m * F_r)


def tapered(row: TaperedConstants, d_m: float, F_r: float, F_a: float, Y: float) -> Moments:
    """Table 2a, single row tapered roller bearings; F_a is the external axial force."""
    rolling = row.R_1 * d_m**2.38 * (F_r + row.R_2 * Y * F_a) ** 0.31
    return Moments(rolling, row.S_1 * d_m**0.82 * (F_r + row.S_2 * Y * F_a))


def phi_ish(n: float, nu: float, d_m: float) -> float:
    """Inlet shear heating factor [-]: 1 / (1 + 1.84e-9 (n d_m)^1.28 nu^0.64)."""
    factor: float = 1.0 / (1.0 + 1.84e-9 * (n * d_m) ** 1.28 * nu**0.64)
    return factor


def phi_rs(K_rs: float, K_z: float, n: float, nu: float, size: Size) -> float:
    """Kinematic replenishment / starvation factor [-]: exp(-K_rs nu n (d + D) sqrt(K_Z / (2 (D - d))))."""
    return math.exp(-K_rs * nu * n * (size.d + size.D) * math.sqrt(K_z / (2.0 * (size.D - size.d))))


def M_rr(G_rr: float, n: float, nu: float) -> float:
    """Rolling frictional moment of a flooded contact [N mm]: G_rr (nu n)^0.6."""
    moment: float = G_rr * (nu * n) ** 0.6
    return moment


def mu_sl(n: float, nu: float, d_m: float, mu_EHL: float) -> float:
    """Sliding friction coefficient [-]: phi_bl mu_bl + (1 - phi_bl) mu_EHL, phi_bl = exp(-2.6e-8 (n nu)^1.4 d_m)."""
    phi_bl = math.exp(-2.6e-8 * (n * nu) ** 1.4 * d_m)
    return phi_bl * MU_BL + (1.0 - phi_bl) * mu_EHL


def V_M(level: float, roller: bool) -> float:
    """Drag variable at H / d_m, constant above 1.2."""
    values = V_M_ROLLER if roller else V_M_BALL
    if level >= V_M_LEVEL[-1]:
        return values[-1]
    right = bisect_right(V_M_LEVEL, max(level, 0.0))
    share = (level - V_M_LEVEL[right - 1]) / (V_M_LEVEL[right] - V_M_LEVEL[right - 1])
    return values[right - 1] + max(share, 0.0) * (values[right] - values[right - 1])


def M_drag(constants: KindConstants, size: Size, H: float, n: float) -> float:
    """Drag moment of a bearing in an oil bath whose level stands H [mm] above the lowest point of the outer raceway.

    Balls V_M K_ball d_m^5 n^2, rollers 10 V_M K_roll B d_m^4 n^2 (pp. 98-100).
    """
    d_m = size.d_m
    K_ball = constants.K_Z * (size.d + size.D) / (size.D - size.d) * 1e-12
    if constants.K_L is None:
        return V_M(H / d_m, roller=False) * K_ball * d_m**5 * n**2
    return 10.0 * V_M(H / d_m, roller=True) * constants.K_L * K_ball * size.B * d_m**4 * n**2
