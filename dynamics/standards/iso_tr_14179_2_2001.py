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


# ISO/TR 14179-2:2001, thermal load carrying capacity of gears, part 2: losses of rolling bearings.
#
# Symbols and units as printed (N, mm, mm2/s, 1/min), torques in N mm. The document takes the torque of a bearing apart
# into a load-independent part T_VL0, a load-dependent part T_VL1 and, for cylindrical roller bearings that carry axial
# load, T_VL2: the form of A. Palmgren. Confidence: the form, f_0 and f_1 are those of DIN 732-2 / ISO 15312 as the KRW
# catalogue (pp. 57, 62, 117) and the Timken engineering manual (table 114) print them, with worked examples; the table
# of the document itself could not be seen. From memory: twice f_0 for jet oil, f_2, and the load P_1 of tapered
# bearings.

SPLIT = 2000.0
"""nu n [mm2/s 1/min] below which the load-independent torque does not depend on viscosity and speed."""

LUBRICATION_FACTOR = {"oil_bath": 1.0, "oil_jet": 2.0, "oil_spot": 0.5, "grease": 2.0 / 3.0}
"""Multiplies f_0, which is tabled for an oil bath up to the middle of the lowest rolling element (KRW p. 117; jet
oil from memory, the old rule of SKF's catalogue of 1989)."""

F_2 = {"oil": 0.006, "grease": 0.009}
"""f_2 of cylindrical roller bearings with cage (from memory; optimised flange contacts have about a third)."""


class Coefficients(NamedTuple):
    """f_0 and f_1 = f_1 (P_0 / C_0)^exponent of a series of bearings."""

    f_0: float
    f_1: float
    exponent: float = 0.0


DEEP_GROOVE_BALL: dict[str, Coefficients] = {
    "618": Coefficients(1.5, 0.00045, 0.5),
    "619": Coefficients(1.75, 0.00067, 0.5),
    "160": Coefficients(1.75, 0.00067, 0.5),
    "60": Coefficients(1.75, 0.00067, 0.5),
    "62": Coefficients(2.0, 0.00089, 0.5),
    "63": Coefficients(2.0, 0.00089, 0.5),
    "64": Coefficients(2.0, 0.00089, 0.5),
}
ANGULAR_CONTACT_BALL: dict[str, Coefficients] = {
    "72B": Coefficients(2.0, 0.00067, 0.33),
    "73B": Coefficients(2.0, 0.00094, 0.33),
}
CYLINDRICAL_ROLLER: dict[str, Coefficients] = {
    "10": Coefficients(2.0, 0.00020),
    "2": Coefficients(2.0, 0.00030),
    "3": Coefficients(2.0, 0.00035),
    "4": Coefficients(2.0, 0.00040),
    "22": Coefficients(3.0, 0.00040),
    "23": Coefficients(4.0, 0.00040),
}
TAPERED_ROLLER: dict[str, Coefficients] = {
    "302": Coefficients(3.0, 0.00040),
    "303": Coefficients(3.0, 0.00040),
    "313": Coefficients(3.0, 0.00040),
    "320": Coefficients(4.5, 0.00040),
    "322": Coefficients(4.5, 0.00040),
    "323": Coefficients(4.5, 0.00040),
    "329": Coefficients(4.5, 0.00040),
    "330": Coefficients(6.0, 0.00040),
    "331": Coefficients(6.0, 0.00040),
    "332": Coefficients(6.0, 0.00040),
}


def T_VL0(f_0: float, nu: float, n: float, d_m: float) -> float:
    """Load-independent torque [N mm]: 1e-7 f_0 (nu n)^(2/3) d_m^3, below nu n = 2000 160e-7 f_0 d_m^3; 0 at rest."""
    if n <= 0.0:
        return 0.0
    product = nu * n
    speed_term: float = product ** (2.0 / 3.0) if product >= SPLIT else 160.0
    return 1e-7 * f_0 * speed_term * d_m**3


def T_VL1(f_1: float, P_1: float, d_m: float) -> float:
    """Load-dependent torque [N mm]: f_1 P_1 d_m (exponents a = b = 1 of all kinds tabled here)."""
    return f_1 * P_1 * d_m


def T_VL2(f_2: float, F_a: float, d_m: float) -> float:
    """Torque of the flange contacts of an axially loaded cylindrical roller bearing [N mm]: f_2 F_a d_m."""
    return f_2 * F_a * d_m


def f_1(row: Coefficients, P_0: float, C_0: float) -> float:
    """f_1 at a static equivalent load P_0 and a static rating C_0 of the same unit."""
    value: float = row.f_1 * (P_0 / C_0) ** row.exponent if row.exponent else row.f_1
    return value
