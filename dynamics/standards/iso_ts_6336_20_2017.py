"""ISO/TS 6336-20:2017 (formerly ISO/TR 13989-1), scuffing load capacity by the flash temperature method.

Printed symbols. Confidence: written from memory of ISO/TR 13989-1:2000 and DIN 3990-4; no public copy was found to
compare with. What other evidence there is:
 - Theta_fl is Blok's formula; its closed form for cylindrical gears, 0.51 X_alphabeta X_M ... (clause 10), follows from
   it to 0.2 % (`tests/verification/test_flank_rating.py`), so both forms are right.
 - Theta_S follows the FZG test A/8.3/90: its term 1.4 X_L S^2 stands for the flash temperature of those gears at load
   stage S. Theta_fl gives 1.18 to 1.24 times that from stage 8 to 12 at Ra = 0.4 um (same test): the right size.
 - X_Gamma, X_J, mu_m and the safety S_B are from memory alone.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError

Array = NDArray[np.float64]

SPEED_LIMIT = 50.0
"""Pitch line velocity above which mu_m is held [m/s]."""
COARSEST_OF_TEST, GRADE_STEP = 7, 15.0
BUTTRESS, BUTTRESS_LENGTH = 0.3, 0.2
"""Excess of the load at the ends of the contact lines of helical gears, and how far it reaches over sin(beta_b)."""


@dataclass(frozen=True, kw_only=True)
class PathParameters:
    """Parameters Gamma of the points on the path (clause 8), 0 at the pitch point, -1 at T1."""

    A: float
    B: float
    D: float
    E: float
    AU: float
    """How far the buttressing of helical teeth reaches from A and from E."""


@dataclass(frozen=True, kw_only=True)
class Sharing:
    """What decides the load sharing factor (clause 9).

    epsilon_alpha, epsilon_beta : contact ratios
    grade : flank tolerance class; coarser than 7 puts more load on the ends of the path
    relief : tip relief of the wheel and of the pinion over the optimum C_eff, 0 to 1: acts at A and at E
    """

    epsilon_alpha: float
    epsilon_beta: float
    grade: int
    relief: tuple[float, float] = (0.0, 0.0)


def X_Gamma(Gamma: Array, at: PathParameters, sharing: Sharing) -> Array:
    """Load sharing factor over the path, shape of ``Gamma``; 0 outside A .. E.

    Spur gears: in the zones of double contact from (Q - 2)/15 to 1/3 more (unmodified), or from 0 to 1 (tips relieved
    by C_eff); between both straight in C_a/C_eff, which is this tool's, the document has the two ends only. Helical
    gears with epsilon_beta < 1 : the same times the buttressing factor; wider ones: X_but / epsilon_alpha, tip relief
    not counted.

    Raises DynamicsInputError for epsilon_alpha of 2 or more, which the factors do not cover.
    """
    if sharing.epsilon_alpha >= 2.0:
        raise DynamicsInputError(
            f"epsilon_alpha = {sharing.epsilon_alpha:.3f}: the load sharing of ISO/TS 6336-20 is for contact ratios "
            "below 2; take the load from a tooth contact analysis"
        )
    inside = (Gamma >= at.A) & (Gamma <= at.E)
    if sharing.epsilon_beta >= 1.0:
        return np.where(inside, _buttressing(Gamma, at, 1.0) / sharing.epsilon_alpha, 0.0)
    low = (max(sharing.grade, COARSEST_OF_TEST) - 2.0) / GRADE_STEP
    start = (Gamma - at.A) / (at.B - at.A) if at.B > at.A else np.ones_like(Gamma)
    end = (at.E - Gamma) / (at.E - at.D) if at.E > at.D else np.ones_like(Gamma)
    load_share = np.ones_like(Gamma)
    for share, relief, reached in (
        (start, sharing.relief[0], Gamma < at.B),
        (end, sharing.relief[1], Gamma > at.D),
    ):
        plain = low + share / 3.0
        load_share = np.where(reached, (1.0 - relief) * plain + relief * share, load_share)
    factor = _buttressing(Gamma, at, sharing.epsilon_beta) if sharing.epsilon_beta > 0.0 else 1.0
    return np.where(inside, np.clip(load_share, 0.0, 1.0) * factor, 0.0)


def _buttressing(Gamma: Array, at: PathParameters, epsilon_beta: float) -> Array:
    """X_but (clause 9.4): 1.3 at A and E of wide helical gears, falling to 1 over Gamma_AU."""
    excess = BUTTRESS * min(epsilon_beta, 1.0)
    if at.AU <= 0.0:
        return np.ones_like(Gamma)
    near = np.minimum(Gamma - at.A, at.E - Gamma) / at.AU
    return 1.0 + excess * np.clip(1.0 - near, 0.0, 1.0)


def X_J(Gamma: Array, at: PathParameters, excess: float, pinion_drives: bool) -> Array:
    """Approach factor (clause 10.4): more friction heat where teeth come into contact.

    excess : C_eff less the tip relief C_a of the driven gear [um]; below 0 counts as 0
    """
    before = -Gamma if pinion_drives else Gamma
    share = np.clip(before, 0.0, None) / (at.E - at.A)
    return 1.0 + max(excess, 0.0) / 50.0 * share**3


@dataclass(frozen=True, kw_only=True)
class FrictionContact:
    """What mu_m needs: w_Bt [N/mm], v_t [m/s], v_gSigmaC / v_t [-], rho_relC [mm], eta_oil [mPa s], Ra [um]."""

    w_Bt: float
    v_t: float
    sum_over_pitch: float
    rho_relC: float
    eta_oil: float
    Ra: float


def lubricant_factor(kind_factor: float, eta_oil: float) -> float:
    """X_L (clause 6.3): factor of the kind of oil (mineral 1, PAO 0.8) times eta_oil^-0.05; eta_oil [mPa s]."""
    return float(kind_factor * eta_oil**-0.05)


def mu_m(contact: FrictionContact, kind_factor: float) -> float:
    """Mean coefficient of friction (clause 6.3), 0.06 (w_Bt/(v_gSigmaC rho_relC))^0.2 X_L X_R, X_R = Ra^0.25.

    v_t counts up to 50 m/s.
    """
    v_gSigmaC = contact.sum_over_pitch * min(contact.v_t, SPEED_LIMIT)
    X_L, X_R = lubricant_factor(kind_factor, contact.eta_oil), contact.Ra**0.25
    return float(0.06 * (contact.w_Bt / (v_gSigmaC * contact.rho_relC)) ** 0.2 * X_L * X_R)


def Theta_fl(mu: float, w_Bn: Array, v_r: tuple[Array, Array], b_H: Array, B_M: tuple[float, float]) -> Array:
    """Flash temperature of a band contact (clause 5.3, Blok) [K]; SI throughout.

    w_Bn : normal load per length of contact [N/m]; v_r : rolling speeds of both flanks [m/s]
    b_H : half width of the contact band [m]; B_M : thermal contact coefficients sqrt(lambda rho c) [W s^0.5/(m2 K)]
    """
    v_1, v_2 = (np.maximum(v, 0.0) for v in v_r)
    conducted = (B_M[0] * np.sqrt(v_1) + B_M[1] * np.sqrt(v_2)) * np.sqrt(2.0 * b_H)
    heat = 1.11 * mu * w_Bn * np.abs(v_1 - v_2)
    return np.asarray(np.divide(heat, conducted, out=np.zeros_like(heat), where=conducted > 0.0))


def Theta_S(S_FZG: float, X_L: float, X_W: float = 1.0) -> float:
    """Scuffing temperature from the FZG test A/8.3/90 [degC], 80 + (0.85 + 1.4 X_W) X_L S_FZG^2 (clause 11).

    S_FZG : load stage at which the test gears scuffed; X_L : `lubricant_factor`; X_W : structural factor of the gears,
    1 for case-hardened steel with 20 to 30 % of retained austenite, 1.5 for nitrided, 0.45 for stainless steel

    Raises DynamicsInputError for a load stage outside 1 to 14.
    """
    if not 1.0 <= S_FZG <= 14.0:
        raise DynamicsInputError(
            f"S_FZG = {S_FZG:g}: must lie within 1 to 14; give the damage load stage of the oil"
        )
    return 80.0 + (0.85 + 1.4 * X_W) * X_L * S_FZG**2


def S_B(Theta_S: float, Theta_oil: float, Theta_Bmax: float) -> float:
    """Safety against scuffing (clause 4.2), (Theta_S - Theta_oil)/(Theta_Bmax - Theta_oil); all [degC].

    Raises DynamicsInputError where the contact is not warmer than the oil.
    """
    if not Theta_Bmax > Theta_oil:
        raise DynamicsInputError(
            f"Theta_Bmax = {Theta_Bmax:.1f} degC: must be above the oil, {Theta_oil:.1f} degC; "
            "check the bulk temperature"
        )
    return (Theta_S - Theta_oil) / (Theta_Bmax - Theta_oil)


def band_half_width(w_Bn: Array, rho: Array, E_r: float) -> Array:
    """b_H of two cylinders (Hertz) [m]; w_Bn [N/m], rho relative radius [m], E_r = 2/sum((1 - nu^2)/E) [Pa]."""
    return np.sqrt(8.0 * w_Bn * rho / (np.pi * E_r))
