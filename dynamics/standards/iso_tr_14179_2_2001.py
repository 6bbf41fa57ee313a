"""ISO/TR 14179-2:2001, thermal load carrying capacity of gears: losses of mesh, seals and dipped gears.

Symbols and units as printed (N, mm, m/s, mPa s, um, 1/min, W). Confidence: the friction formula and the seal
constant were found in two public programs that cite the document; the limits of validity are from the field's
textbooks (Schlenk 1994; Niemann/Winter II) and should be compared with a copy before they decide a verdict. Churning
torque and heat balance are from memory throughout: compare every digit with a copy.
"""

import math
from typing import NamedTuple

from dynamics.errors import DynamicsInputError

LINE_LOAD_MINIMUM = 150.0
"""F_bt/b [N/mm] below which the value at 150 is used."""
SPEED_MAXIMUM = 50.0
"""Pitch line velocity v_t [m/s] above which the value at 50 is used."""
SPEED_MINIMUM = 1.0
"""Pitch line velocity v_t [m/s] below which the value at 1 is used: boundary friction is not described."""


class PitchPointContact(NamedTuple):
    """Contact at the pitch point as the mean friction coefficient reads it."""

    F_bt_b: float
    """Tooth force in the transverse base tangent plane per face width [N/mm]."""
    v_SigmaC: float
    """Sum of the surface speeds, 2 v_t sin(alpha_wt) [m/s]."""
    rho_redC: float
    """Relative radius of curvature [mm]."""
    eta_oil: float
    """Dynamic viscosity at the oil temperature [mPa s]."""
    Ra: float
    """Mean roughness of both flanks [um]."""


def mu_mz(contact: PitchPointContact, X_L: float) -> float:
    """Mean friction coefficient of the mesh (Schlenk), X_L the lubricant factor [-].

    mu_mz = 0.048 (F_bt/b / (v_SigmaC rho_redC))^0.2 eta_oil^-0.05 Ra^0.25 X_L
    """
    F_bt_b, v_SigmaC, rho_redC, eta_oil, Ra = contact
    mu: float = 0.048 * (F_bt_b / (v_SigmaC * rho_redC)) ** 0.2 * eta_oil**-0.05 * Ra**0.25 * X_L
    return mu


def mu_mz_michaelis(contact: PitchPointContact, d_1: float, X_L: float) -> float:
    """Mean friction coefficient of the mesh (Michaelis; Niemann/Winter II).

    mu_mz = 0.045 (F_bt/b / (v_SigmaC rho_redC))^0.2 eta_oil^-0.05 X_R X_L , X_R = 3.8 (Ra / d_1)^0.25

    d_1 : reference diameter of the pinion [mm]; X_L : lubricant factor [-]
    """
    F_bt_b, v_SigmaC, rho_redC, eta_oil, Ra = contact
    X_R = 3.8 * (Ra / d_1) ** 0.25
    mu: float = 0.045 * (F_bt_b / (v_SigmaC * rho_redC)) ** 0.2 * eta_oil**-0.05 * X_R * X_L
    return mu


def H_V(z_1: int, u: float, beta_b: float, eps_1: float, eps_2: float) -> float:
    """Tooth-loss factor after Ohlendorf, rigid teeth, half the load in double contact [-].

    H_V = pi (u + 1) / (z_1 u cos beta_b) (1 - eps_alpha + eps_1^2 + eps_2^2)

    beta_b [rad]. Raises DynamicsInputError where the formula does not hold: pitch point outside the path of contact
    (eps_1 or eps_2 negative) or eps_alpha outside 1 to 2.
    """
    eps_alpha = eps_1 + eps_2
    if eps_1 < 0.0 or eps_2 < 0.0:
        raise DynamicsInputError(
            f"addendum contact ratios {eps_1:.4g}, {eps_2:.4g}: must not be negative, the pitch point lies "
            "outside the path of contact; use the integrated tooth-loss factor"
        )
    if not 1.0 <= eps_alpha <= 2.0:
        raise DynamicsInputError(
            f"transverse contact ratio {eps_alpha:.4g}: must lie within 1 to 2 for Ohlendorf's formula; use "
            "the integrated tooth-loss factor"
        )
    return math.pi * (u + 1.0) / (z_1 * u * math.cos(beta_b)) * (1.0 - eps_alpha + eps_1**2 + eps_2**2)


def P_VD(d_sh: float, n: float) -> float:
    """Loss of one radial lip seal [W]: 7.69e-6 d_sh^2 n; shaft diameter [mm], speed [1/min]."""
    return 7.69e-6 * d_sh**2 * n


H_E0 = 10.0
"""Reference immersion h_e0 [mm]."""
B_0 = 10.0
"""Reference face width b_0 [mm]."""
V_T0 = 10.0
"""Reference circumferential speed v_t0 [m/s]."""


class DippedStage(NamedTuple):
    """Gear stage in an oil bath as the churning torque reads it; the oil is at rest for all heights."""

    h_e1: float
    """Immersion of the tip circle of gear 1 [mm]."""
    h_e2: float
    """Immersion of the tip circle of gear 2 [mm]."""
    h_C: float
    """Height of the point of contact above the lowest point of the deeper gear [mm]."""
    l_h: float
    """Hydraulic length of the housing [mm]."""
    b: float
    """Face width [mm]."""


def l_h(A_G: float, U_M: float) -> float:
    """Hydraulic length 4 A_G/U_M [mm]; inner plan area [mm2] and perimeter [mm] of the housing."""
    return 4.0 * A_G / U_M


def C_Sp(stage: DippedStage) -> float:
    """Splash factor (4 h_e,max/(3 h_C))^1.5 2 h_C/l_h of dip lubrication [-]."""
    h_emax = max(stage.h_e1, stage.h_e2)
    splash: float = (4.0 * h_emax / (3.0 * stage.h_C)) ** 1.5 * 2.0 * stage.h_C / stage.l_h
    return splash


def C_1(stage: DippedStage) -> float:
    """Factor 0.063 (h_e1 + h_e2)/h_e0 + 0.0128 (b/b_0)^3 [N m]."""
    return 0.063 * (stage.h_e1 + stage.h_e2) / H_E0 + 0.0128 * (stage.b / B_0) ** 3


def C_2(stage: DippedStage) -> float:
    """Exponent (h_e1 + h_e2)/(80 h_e0) + 0.2 [-]."""
    return (stage.h_e1 + stage.h_e2) / (80.0 * H_E0) + 0.2


def T_H(stage: DippedStage, v_t: float) -> float:
    """Hydraulic (churning) torque of a dipped stage, C_Sp C_1 exp(C_2 v_t/v_t0) [N m]; v_t [m/s] (Mauz 1987).

    The viscosity of the oil does not enter. The shaft it acts on is read here as that of the deeper gear. From memory;
    no digit was found in a public source.
    """
    return C_Sp(stage) * C_1(stage) * math.exp(C_2(stage) * v_t / V_T0)
