"""ISO/TS 6336-22:2018 (formerly ISO/TR 15144-1), micropitting load capacity: bulk temperature, film thickness ratio.

Symbols and units as printed (kW, mm, degC, N/mm2, N s/m2, um). Confidence: from memory of ISO/TR 15144-1:2014; no
public copy of the formulas or of the worked examples (ISO/TR 15144-2, now ISO/TR 6336-31) was found to compare with.
 - theta_M is Michaelis' (diss. TUM 1987; Oster 1982 before). It gives the 126 degC found by hand for FZG-C gears at
   372.6 N m, 2250 rpm and a sump of 90 degC; the lubrication factors are those of ISO/TR 13989.
 - h_Y is the line-contact film of Dowson and Higginson in its dimensionless groups, which the form used here equals
   (`tests/verification/test_flank_rating.py`); the exponent 0.22 of S_GF is the document's.
 - alpha(theta) is Gold's pressure-viscosity over temperature, mu_m Michaelis' mean coefficient of friction.
"""

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError

Array = NDArray[np.float64]

X_S = {"injection": 1.2, "dip": 1.0, "submerged": 0.2}
"""Lubrication factor by oil supply [-]."""
LEAST_ALPHA = 0.05
"""Share of alpha_38 below which the fit over temperature is not followed: it crosses zero at 510 degC."""


def theta_M(theta_oil: float, P_VZP: float, a_b: float, supply: str, X_Ca: float = 1.0) -> float:
    """Bulk temperature of both gears, theta_oil + 7400 (P_VZP/(a b))^0.72 X_S/(1.2 X_Ca) [degC].

    theta_oil : injection or sump [degC]; P_VZP : load-dependent loss of the mesh [kW];
    a_b : centre distance times face width [mm2]; supply : key of `X_S`; X_Ca : tip relief factor, 1 without relief [-]

    Raises DynamicsInputError for an unknown supply, a negative loss, or a_b or X_Ca that are not positive.
    """
    if supply not in X_S:
        raise DynamicsInputError(f"oil supply = {supply!r}: unknown; give one of {', '.join(X_S)}")
    if P_VZP < 0.0:
        raise DynamicsInputError(f"P_VZP = {P_VZP:g} kW: must not be negative; give the loss as a magnitude")
    for name, value in (("a b", a_b), ("X_Ca", X_Ca)):
        if not value > 0.0:
            raise DynamicsInputError(f"{name} = {value:g}: must be above 0; correct the gear data")
    rise: float = 7400.0 * (P_VZP / a_b) ** 0.72 * X_S[supply] / (1.2 * X_Ca)
    return theta_oil + rise


def alpha_theta(alpha_38: float, theta: Array) -> Array:
    """Pressure-viscosity coefficient at theta [degC] from that at 38 degC, unit of ``alpha_38`` (clause 5.6, Gold)."""
    share = 1.0 + 516.0 * (1.0 / (theta + 273.0) - 1.0 / 311.0)
    return alpha_38 * np.maximum(share, LEAST_ALPHA)


def alpha_38(alpha: float, theta: float) -> float:
    """The other way round: alpha_38 of an oil whose coefficient ``alpha`` is known at ``theta`` [degC]."""
    return alpha / float(alpha_theta(1.0, np.asarray(theta)))


def K_Bgamma(epsilon_gamma: float) -> float:
    """Helical load factor of mu_m (clause 7.4)."""
    if epsilon_gamma <= 2.0:
        return 1.0
    return (
        1.3
        if epsilon_gamma >= 3.5
        else 1.0 + 0.2 * float(np.sqrt((epsilon_gamma - 2.0) * (5.0 - epsilon_gamma)))
    )


def mu_m(w_t: float, v_SigmaC: float, rho_nC: float, eta_oil: float, Ra: float, X_L: float) -> float:
    """Mean coefficient of friction (clause 7.4), 0.045 (w_t/(v_SigmaC rho_nC))^0.2 (10^3 eta)^-0.05 X_R X_L.

    w_t : tangential load in the base circle with all K factors and K_Bgamma over b [N/mm]; v_SigmaC [m/s];
    rho_nC [mm]; eta_oil [N s/m2]; Ra : mean of both flanks [um], X_R = 2.2 (Ra/rho_nC)^0.25; X_L : of the kind of oil
    """
    X_R = 2.2 * (Ra / rho_nC) ** 0.25
    return float(0.045 * (w_t / (v_SigmaC * rho_nC)) ** 0.2 * (1e3 * eta_oil) ** -0.05 * X_R * X_L)


def h_Y(rho_n: Array, G_M: float, U: Array, W: Array, S_GF: Array) -> Array:
    """Local film thickness, 1600 rho_n G_M^0.6 U^0.7 W^-0.13 S_GF^0.22 [um] (clause 5.1); rho_n [mm]."""
    return np.asarray(1600.0 * rho_n * G_M**0.6 * U**0.7 * W**-0.13 * S_GF**0.22)


def theta_fl(
    mu: float, p_dyn: Array, v_r: tuple[Array, Array], rho_n: Array, E_r: float, B_M: tuple[float, float]
) -> Array:
    """Local flash temperature (clause 7.2) [K].

    p_dyn : local Hertzian pressure with all K factors [N/mm2]; v_r : rolling speeds of both flanks [m/s];
    rho_n [mm]; E_r [N/mm2]; B_M : thermal contact coefficients [N/(m s^0.5 K)]
    """
    v_1, v_2 = (np.maximum(v, 0.0) for v in v_r)
    conducted = B_M[0] * np.sqrt(v_1) + B_M[1] * np.sqrt(v_2)
    heat = 0.5 * np.sqrt(np.pi) * 1e6 * mu * p_dyn * np.abs(v_1 - v_2)
    spread = np.sqrt(8.0 * rho_n * p_dyn / (1000.0 * E_r))
    return np.asarray(np.divide(heat * spread, conducted, out=np.zeros_like(heat), where=conducted > 0.0))
