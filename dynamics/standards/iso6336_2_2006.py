"""ISO 6336-2:2006, surface durability (pitting) by method B. Printed symbols; mm, N, N/mm2, degrees, mm2/s, m/s.

Confidence: Z_H, Z_E, Z_epsilon, Z_beta, Z_B/Z_D, Z_L, Z_v, Z_R and Z_NT agree with the printed digits of ISO/TR 6336-30
example 1 (`tests/verification/test_flank_rating.py`). Z_W and Z_X are from memory; that example has both at 1.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from math import cos, log, pi, radians, sin, sqrt

from dynamics.errors import DynamicsInputError
from dynamics.standards.iso6336_1_2006 import RunIn
from dynamics.standards.iso6336_3_2006 import transverse_sharing

LIFE: Mapping[RunIn, tuple[tuple[float, float], ...]] = {
    "case_hardened": ((1e5, 1.6), (5e7, 1.0), (1e10, 0.85)),
    "through_hardened": ((1e5, 1.6), (5e7, 1.0), (1e10, 0.85)),
    "nitrided": ((1e5, 1.3), (2e6, 1.0), (1e10, 0.85)),
}
"""(N_L, Z_NT) of clause 11.2 where no pitting is permitted; straight on log scales, level beyond both ends."""


def Z_H(alpha_t: float, alpha_wt: float, beta_b: float) -> float:
    """Zone factor (clause 6.2): flank curvature at the pitch point; transverse and base helix angles [deg]."""
    working = radians(alpha_wt)
    return sqrt(2.0 * cos(radians(beta_b)) * cos(working) / (cos(radians(alpha_t)) ** 2 * sin(working)))


def Z_E(E_1: float, nu_1: float, E_2: float, nu_2: float) -> float:
    """Elasticity factor (clause 7) [(N/mm2)^0.5]."""
    return sqrt(1.0 / (pi * ((1.0 - nu_1**2) / E_1 + (1.0 - nu_2**2) / E_2)))


def Z_epsilon(epsilon_alpha: float, epsilon_beta: float) -> float:
    """Contact ratio factor (clause 8.2); epsilon_beta = 0 is a spur gear."""
    wide = 1.0 / epsilon_alpha
    if epsilon_beta >= 1.0:
        return sqrt(wide)
    return sqrt((4.0 - epsilon_alpha) / 3.0 * (1.0 - epsilon_beta) + epsilon_beta * wide)


def Z_beta(beta: float) -> float:
    """Helix angle factor (clause 9), 1/sqrt(cos beta), as the technical corrigendum of 2008 has it."""
    return 1.0 / sqrt(cos(radians(beta)))


def Z_BD(M: float, epsilon_alpha: float, epsilon_beta: float) -> float:
    """Single pair tooth contact factor Z_B or Z_D (clause 6.3) from M_1 or M_2, at least 1.

    M = sqrt(rho_C / rho_B): curvature at the pitch point over that at the inner point of single contact of the gear.
    """
    if epsilon_alpha <= 1.0 or epsilon_beta >= 1.0 or M <= 1.0:
        return 1.0
    return M - epsilon_beta * (M - 1.0)


def C_ZL(sigma_Hlim: float) -> float:
    """Constant of Z_L (clause 12.3.1) for the softer gear of the pair."""
    return min(max(sigma_Hlim, 850.0), 1200.0) / 4375.0 + 0.6357


def Z_L(nu_40: float, sigma_Hlim: float) -> float:
    """Lubricant factor (clause 12.3.1); nu_40 [mm2/s]."""
    C = C_ZL(sigma_Hlim)
    return C + 4.0 * (1.0 - C) / (1.2 + 134.0 / nu_40) ** 2


def Z_v(v: float, sigma_Hlim: float) -> float:
    """Velocity factor (clause 12.3.2); pitch line velocity v above 0 [m/s]."""
    C = C_ZL(sigma_Hlim) + 0.02
    return C + 2.0 * (1.0 - C) / sqrt(0.8 + 32.0 / v)


def Z_R(R_z: float, rho_red: float, sigma_Hlim: float) -> float:
    """Roughness factor (clause 12.3.3); mean R_z of both flanks [um], rho_red = rho_1 rho_2/(rho_1 + rho_2) [mm]."""
    R_z10 = R_z * (10.0 / rho_red) ** (1.0 / 3.0)
    exponent = 0.32 - 2e-4 * min(max(sigma_Hlim, 850.0), 1200.0)
    return float((3.0 / R_z10) ** exponent)


def Z_NT(N_L: float, treatment: RunIn) -> float:
    """Life factor (clause 11.2) after N_L load cycles; of steel by its treatment, no pitting permitted."""
    knots = LIFE[treatment]
    cycles = min(max(N_L, knots[0][0]), knots[-1][0])
    (n_1, z_1), (n_2, z_2) = next((low, high) for low, high in pairwise(knots) if cycles <= high[0])
    return float(z_1 * (cycles / n_1) ** (log(z_2 / z_1) / log(n_2 / n_1)))


def Z_W(HB: float | None, R_zH: float = 3.0) -> float:
    """Work hardening factor (clause 13.2) of a soft gear against a surface-hardened one.

    HB : Brinell hardness of the softer gear; None: both gears equally hard, 1
    R_zH : equivalent roughness of the pair [um]
    """
    if HB is None:
        return 1.0
    return float((1.2 - (min(max(HB, 130.0), 470.0) - 130.0) / 1700.0) * (3.0 / R_zH) ** 0.15)


def Z_X(m_n: float, treatment: RunIn) -> float:
    """Size factor (clause 14); m_n [mm]. DIN 3990-2 and the class rules have these lines."""
    if treatment == "case_hardened":
        return min(max(1.05 - 0.005 * m_n, 0.9), 1.0)
    if treatment == "nitrided":
        return min(max(1.08 - 0.011 * m_n, 0.75), 1.0)
    return 1.0


def K_Halpha(
    epsilon_alpha: float, epsilon_gamma: float, Z_epsilon: float, c_gamma_alpha: float, f_pb_eff: float,
    specific_load: float,
) -> float:  # fmt: skip
    """Transverse load factor for contact (ISO 6336-1:2006, 8.3.2 and 8.3.4), 1 .. epsilon_gamma/(epsilon_alpha Z^2).

    Arguments as `iso6336_3_2006.K_Falpha`.
    """
    factor = transverse_sharing(epsilon_gamma, c_gamma_alpha * f_pb_eff / specific_load)
    return min(max(factor, 1.0), K_Halpha_limit(epsilon_alpha, epsilon_gamma, Z_epsilon))


def K_Halpha_limit(epsilon_alpha: float, epsilon_gamma: float, Z_epsilon: float) -> float:
    """Largest transverse load factor for contact (ISO 6336-1:2006, 8.3.4): one pair carries the whole load."""
    return max(epsilon_gamma / (epsilon_alpha * Z_epsilon**2), 1.0)


def K_Hbeta(K_Fbeta: float, b_over_h: float) -> float:
    """Face load factor for contact that `iso6336_3_2006.K_Fbeta` turns into the given one for the root."""
    r = max(b_over_h, 3.0)
    return float(K_Fbeta ** ((1.0 + r + r**2) / r**2))


def sigma_H0(Z: float, F_t: float, d_1: float, b: float, u: float) -> float:
    """Nominal contact stress at the pitch point (clause 5.2), Z = Z_H Z_E Z_epsilon Z_beta [N/mm2].

    Raises DynamicsInputError for a load, diameter, width or ratio that is not positive.
    """
    for name, value in (("F_t", F_t), ("d_1", d_1), ("b", b), ("u", u)):
        if not value > 0.0:
            raise DynamicsInputError(
                f"{name} = {value:g}: must be above 0; correct the gear data or the load"
            )
    return Z * sqrt(F_t * (u + 1.0) / (d_1 * b * u))


@dataclass(frozen=True, kw_only=True)
class PermissibleFactors:
    """Factors that turn sigma_Hlim into sigma_HG (clause 5.3)."""

    Z_NT: float
    Z_L: float
    Z_v: float
    Z_R: float
    Z_W: float
    Z_X: float

    @property
    def product(self) -> float:
        """sigma_HG / sigma_Hlim."""
        return self.Z_NT * self.Z_L * self.Z_v * self.Z_R * self.Z_W * self.Z_X
