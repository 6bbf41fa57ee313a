"""ISO 6336-3:2006, tooth root stress by method B. Printed symbols; mm, N, N/mm2, degrees.

Clause 6 gives the form factor Y_F, clause 7 the stress correction factor Y_S, both for the load on the outer
point of single pair contact of the virtual spur gear; ``d_en`` may be any load point instead.
"""

from dataclasses import dataclass
from math import asin, cos, inf, log, pi, radians, sin, sqrt, tan

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.standards.iso6336_1_2006 import RunIn

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class ToothRoot:
    """One external gear as clause 6 reads it; rack data in modules."""

    z: int
    m_n: float
    alpha_n: float
    beta: float
    x: float
    h_fP: float
    rho_fP: float
    d_a: float
    s_pr: float = 0.0
    """Residual fillet undercut of a protuberance tool, in modules."""

    @property
    def beta_b(self) -> float:
        """Base helix angle [rad]."""
        return asin(sin(radians(self.beta)) * cos(radians(self.alpha_n)))

    @property
    def z_n(self) -> float:
        """Virtual number of teeth."""
        return self.z / (cos(self.beta_b) ** 2 * cos(radians(self.beta)))

    @property
    def d(self) -> float:
        """Reference diameter."""
        return self.z * self.m_n / cos(radians(self.beta))

    @property
    def d_n(self) -> float:
        """Reference diameter of the virtual gear."""
        return self.m_n * self.z_n

    @property
    def d_bn(self) -> float:
        """Base diameter of the virtual gear."""
        return self.d_n * cos(radians(self.alpha_n))

    @property
    def d_an(self) -> float:
        """Tip diameter of the virtual gear."""
        return self.d_n + self.d_a - self.d

    @property
    def p_bn(self) -> float:
        """Normal base pitch."""
        return pi * self.m_n * cos(radians(self.alpha_n))


@dataclass(frozen=True, kw_only=True)
class RootSection:
    """Section at the 30 degree tangents of the virtual gear (clause 6.2), lengths over m_n, angle [rad]."""

    E: float
    G: float
    H: float
    theta: float
    s_Fn: float
    rho_F: float
    y_F: float
    """Height of the section above the gear centre."""


def root_section(root: ToothRoot) -> RootSection:
    """Critical section of clause 6.2.1; raises DynamicsInputError if the tangent cannot be found."""
    alpha = radians(root.alpha_n)
    E = (
        pi / 4.0
        - root.h_fP * tan(alpha)
        + root.s_pr / cos(alpha)
        - (1.0 - sin(alpha)) * root.rho_fP / cos(alpha)
    )
    G = root.rho_fP - root.h_fP + root.x
    H = 2.0 / root.z_n * (pi / 2.0 - E) - pi / 3.0
    theta = pi / 6.0
    for _ in range(100):
        step = _tangent_residual(theta, G, H, root.z_n)
        theta -= step
        if abs(step) < 1e-14:
            break
    else:
        raise DynamicsInputError(
            f"30 degree tangent not found for z_n = {root.z_n:.2f}, x = {root.x:.3f}, h_fP = "
            f"{root.h_fP:.3f}, rho_fP = {root.rho_fP:.3f}; check the rack"
        )
    s_Fn = root.z_n * sin(pi / 3.0 - theta) + sqrt(3.0) * (G / cos(theta) - root.rho_fP)
    rho_F = root.rho_fP + 2.0 * G**2 / (cos(theta) * (root.z_n * cos(theta) ** 2 - 2.0 * G))
    y_F = 0.5 * (root.z_n * cos(pi / 3.0 - theta) + G / cos(theta) - root.rho_fP)
    return RootSection(E=E, G=G, H=H, theta=theta, s_Fn=s_Fn, rho_F=rho_F, y_F=y_F)


def _tangent_residual(theta: float, G: float, H: float, z_n: float) -> float:
    """Newton step of theta = (2 G / z_n) tan(theta) - H."""
    ratio = 2.0 * G / z_n
    return (theta - ratio * tan(theta) + H) / (1.0 - ratio / cos(theta) ** 2)


def d_en(root: ToothRoot, epsilon_alpha: float) -> float:
    """Diameter of the outer point of single pair contact of the virtual gear (clause 6.2.2)."""
    epsilon_an = epsilon_alpha / cos(root.beta_b) ** 2
    roll = sqrt((root.d_an / 2.0) ** 2 - (root.d_bn / 2.0) ** 2) - root.p_bn * (epsilon_an - 1.0)
    return 2.0 * sqrt(roll**2 + (root.d_bn / 2.0) ** 2)


@dataclass(frozen=True, kw_only=True)
class LoadedRoot:
    """Bending lever, angle and factors for loads at the diameters d_en; arrays of one shape."""

    alpha_Fen: Array
    """[rad]"""
    h_Fe: Array
    """Over m_n."""
    Y_F: Array
    Y_S: Array
    q_s: float


def loaded_root(root: ToothRoot, section: RootSection, diameters: Array) -> LoadedRoot:
    """Y_F and Y_S (clauses 6.1, 7.2) for loads at virtual-gear diameters.

    diameters : (n,) [mm]; one below the base diameter counts as the base diameter
    """
    alpha = radians(root.alpha_n)
    ratio = np.minimum(root.d_bn / np.asarray(diameters, dtype=float), 1.0)
    alpha_en = np.arccos(ratio)
    half_tooth = (pi / 2.0 + 2.0 * root.x * tan(alpha)) / root.z_n
    gamma_e = half_tooth + (tan(alpha) - alpha) - (np.tan(alpha_en) - alpha_en)
    alpha_Fen = alpha_en - gamma_e
    lever = (np.cos(gamma_e) - np.sin(gamma_e) * np.tan(alpha_Fen)) * diameters / root.m_n
    h_Fe = 0.5 * lever - section.y_F
    q_s = section.s_Fn / (2.0 * section.rho_F)
    Y_F = 6.0 * h_Fe * np.cos(alpha_Fen) / (section.s_Fn**2 * cos(alpha))
    L = section.s_Fn / h_Fe
    Y_S = (1.2 + 0.13 * L) * q_s ** (1.0 / (1.21 + 2.3 / L))
    return LoadedRoot(alpha_Fen=alpha_Fen, h_Fe=h_Fe, Y_F=Y_F, Y_S=Y_S, q_s=q_s)


def Y_beta(epsilon_beta: float, beta: float) -> float:
    """Helix angle factor (clause 8): overlap ratio at most 1, ``beta`` [deg] at most 30."""
    return 1.0 - min(epsilon_beta, 1.0) * min(beta, 30.0) / 120.0


def Y_B(s_R: float, h_t: float) -> float:
    """Rim thickness factor of an external gear (clause 9); ``s_R = inf`` is a solid body.

    Raises DynamicsInputError for s_R <= 0.5 h_t, which the clause excludes.
    """
    ratio = s_R / h_t
    if ratio >= 1.2:
        return 1.0
    if ratio <= 0.5:
        raise DynamicsInputError(
            f"rim thickness s_R / h_t = {ratio:.3f} must exceed 0.5 (ISO 6336-3:2006, 9); thicken the rim"
        )
    return 1.6 * log(2.242 / ratio)


def Y_DT(epsilon_an: float, grade: int) -> float:
    """Deep tooth factor (clause 10) for the virtual contact ratio and the ISO 1328-1 grade."""
    if epsilon_an <= 2.05 or grade > 4:
        return 1.0
    return 0.7 if epsilon_an > 2.5 else 2.366 - 0.666 * epsilon_an


def Y_NT(N_L: float) -> float:
    """Life factor of steel (clause 12) beyond the knee at 3e6 load cycles: 1 down to 0.85 at 1e10.

    1 below the knee, where the clause would allow more by material.
    """
    return float((3e6 / min(max(N_L, 3e6), 1e10)) ** 0.02)


def Y_deltarelT(section: RootSection) -> float:
    """Relative notch sensitivity factor (clause 13, method C): sharper notches than the test gears' count as them."""
    return 1.0 if section.s_Fn / (2.0 * section.rho_F) >= 1.5 else 0.95


def Y_X(m_n: float) -> float:
    """Size factor (clause 15) of case-hardened and nitrided gears, the lowest of the steels; m_n [mm]."""
    return min(max(1.05 - 0.01 * m_n, 0.8), 1.0)


def K_Fbeta(K_Hbeta: float, b_over_h: float) -> float:
    """Face load factor for root stress from that for contact (ISO 6336-1:2006, 7.3); b/h at least 3."""
    r = max(b_over_h, 3.0)
    return float(K_Hbeta ** (r**2 / (1.0 + r + r**2)))


def K_Falpha(
    epsilon_alpha: float, epsilon_gamma: float, c_gamma_alpha: float, f_pb_eff: float, specific_load: float
) -> float:
    """Transverse load factor (ISO 6336-1:2006, 8.3.2) for F_tH / b = ``specific_load`` [N/mm].

    c_gamma_alpha [N/(mm um)], f_pb_eff = f_pb - y_alpha [um]; limited to 1 ..
    epsilon_gamma / (0.25 epsilon_alpha + 0.75).
    """
    K = transverse_sharing(epsilon_gamma, c_gamma_alpha * f_pb_eff / specific_load)
    return min(max(K, 1.0), K_Falpha_limit(epsilon_alpha, epsilon_gamma))


def K_Falpha_limit(epsilon_alpha: float, epsilon_gamma: float) -> float:
    """Largest transverse load factor for root stress (ISO 6336-1:2006, 8.3.5): one pair carries the whole load."""
    return epsilon_gamma / (0.25 * epsilon_alpha + 0.75)


def transverse_sharing(epsilon_gamma: float, X: float) -> float:
    """K_Halpha = K_Falpha of ISO 6336-1:2006, 8.3.2 before their limits; X = c_gamma_alpha f_pb_eff / (F_tH/b)."""
    if epsilon_gamma <= 2.0:
        return epsilon_gamma / 2.0 * (0.9 + 0.4 * X)
    return 0.9 + 0.4 * sqrt(2.0 * (epsilon_gamma - 1.0) / epsilon_gamma) * X


@dataclass(frozen=True, kw_only=True)
class RootStress:
    """Root stress of one gear with all factors [N/mm2]."""

    d_en: float
    s_Fn: float
    h_Fe: float
    rho_F: float
    q_s: float
    alpha_Fen: float
    """[deg]"""
    Y_F: float
    Y_S: float
    Y_beta: float
    Y_B: float
    Y_DT: float
    sigma_F0: float
    K_A: float
    K_V: float
    K_Fbeta: float
    K_Falpha: float
    sigma_F: float
    warnings: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class ToothLoad:
    """F_t [N] on the width b [mm], and the contact ratios that share it."""

    F_t: float
    b: float
    epsilon_alpha: float
    epsilon_beta: float = 0.0


@dataclass(frozen=True, kw_only=True)
class LoadFactors:
    """K factors of ISO 6336 for root stress: application, dynamic, face load and transverse load factor."""

    K_A: float = 1.0
    K_V: float = 1.0
    K_Fbeta: float = 1.0
    K_Falpha: float = 1.0


NOMINAL_LOAD = LoadFactors()


def root_stress(
    root: ToothRoot,
    load: ToothLoad,
    factors: LoadFactors = NOMINAL_LOAD,
    *,
    grade: int = 5,
    s_R: float = inf,
) -> RootStress:
    """Nominal stress sigma_F0 (clause 5.2) and local stress sigma_F (5.1).

    grade : ISO 1328-1 tolerance grade, for Y_DT; s_R : rim thickness [mm]

    Raises DynamicsInputError as `Y_B` and `root_section`.
    """
    F_t, b, epsilon_alpha, epsilon_beta = load.F_t, load.b, load.epsilon_alpha, load.epsilon_beta
    section = root_section(root)
    diameter = d_en(root, epsilon_alpha)
    loaded = loaded_root(root, section, np.array([diameter]))
    Y_F, Y_S = float(loaded.Y_F[0]), float(loaded.Y_S[0])
    h_t = 0.5 * (root.d_a - root.d) - root.m_n * (root.x - root.h_fP)
    shares = (
        Y_beta(epsilon_beta, root.beta),
        Y_B(s_R, h_t),
        Y_DT(epsilon_alpha / cos(root.beta_b) ** 2, grade),
    )
    sigma_F0 = F_t / (b * root.m_n) * Y_F * Y_S * shares[0] * shares[1] * shares[2]
    warnings = []
    if not 1.0 <= loaded.q_s < 8.0:
        warnings.append(
            f"q_s = {loaded.q_s:.3f} outside 1..8 of Y_S (ISO 6336-3:2006, 7.2); use a larger tool tip radius"
        )
    if epsilon_alpha / cos(root.beta_b) ** 2 >= 2.0:
        warnings.append(
            f"virtual contact ratio {epsilon_alpha / cos(root.beta_b) ** 2:.3f} is 2 or more: the load "
            "point of method B is conservative; use contact analysis"
        )
    if root.beta > 30.0:
        warnings.append(f"beta = {root.beta:.2f} deg above 30 deg: Y_beta taken at 30 deg; confirm by test")
    return RootStress(
        d_en=diameter,
        s_Fn=section.s_Fn * root.m_n,
        h_Fe=float(loaded.h_Fe[0]) * root.m_n,
        rho_F=section.rho_F * root.m_n,
        q_s=loaded.q_s,
        alpha_Fen=float(np.degrees(loaded.alpha_Fen[0])),
        Y_F=Y_F,
        Y_S=Y_S,
        Y_beta=shares[0],
        Y_B=shares[1],
        Y_DT=shares[2],
        sigma_F0=sigma_F0,
        K_A=factors.K_A,
        K_V=factors.K_V,
        K_Fbeta=factors.K_Fbeta,
        K_Falpha=factors.K_Falpha,
        sigma_F=sigma_F0 * factors.K_A * factors.K_V * factors.K_Fbeta * factors.K_Falpha,
        warnings=tuple(warnings),
    )


def mean_stress_ratio(treatment: RunIn, Y_S: float) -> float:
    """M of Table B.1 (endurance): how far static stress uses up the strength of a surface treatment [-].

    Case-hardened 0.8 - 0.15 Y_S, nitrided and not hardened at the surface 0.3. From memory of the standard; for
    Y_S = 2 and R = -1.2 the case-hardened value gives Y_M = 0.714, the 0.7 that ISO 6336-5 has for reversed bending.
    """
    return 0.8 - 0.15 * Y_S if treatment == "case_hardened" else 0.3


IDLER_RATIO = 1.2
"""Compression in the fillet behind the loaded flank over the tension in that under it (Formula B.2)."""
MOST_R = 0.5
"""Stress ratio up to which Y_M is taken; above, that at this ratio."""


def Y_M(R: float, M: float) -> float:
    """Mean stress influence factor (Formula B.1) on the highest stress that a root stands.

    R : lowest over highest stress. The formula is the straight line of the Haigh diagram with the slope M, referred to
    R = 0: sigma_max (1 - R) / 2 + M sigma_max (1 + R) / 2 is the same for all R.
    """
    return 1.0 / (1.0 - min(R, MOST_R) * (1.0 - M) / (1.0 + M))
