"""ISO 6336-1:2006, dynamic factor K_V by method B (clause 6.5) with the stiffness of clause 9.

Printed symbols and the document's units: mm, N, um, N/(mm um), kg/mm, 1/min, degrees.
"""

from dataclasses import dataclass
from math import pi, sin, sqrt
from typing import Literal

from dynamics.errors import DynamicsInputError
from dynamics.standards.iso6336_1_2006_stiffness import (
    DEFAULT_CHOICES,
    MeshData,
    Stiffness,
    StiffnessChoices,
    stiffness,
)

RunIn = Literal["case_hardened", "nitrided", "through_hardened"]
Range = Literal["subcritical", "main resonance", "intermediate", "supercritical"]


@dataclass(frozen=True, kw_only=True)
class DynamicFactor:
    """K_V by method B with every factor that made it."""

    stiffness: Stiffness
    F_t: float
    v: float
    K_A: float
    specific_load: float
    """F_t K_A / b [N/mm]."""
    f_pb_eff: float
    f_falpha_eff: float
    y_p: float
    y_f: float
    C_a: float
    m_red: float
    n_1: float
    n_E1: float
    N: float
    N_S: float
    B_p: float
    B_f: float
    B_k: float
    C_v1: float
    C_v2: float
    C_v3: float
    C_v4: float
    C_v5: float
    C_v6: float
    C_v7: float
    range: Range
    K_V: float
    warnings: tuple[str, ...]


def m_red(data: MeshData) -> float:
    """Reduced mass of the pair per face width at the line of action [kg/mm] (clause 6.5.3, solid or ring)."""
    ratio = (data.d_m1 / data.d_b1) ** 2
    pinion = 1.0 / ((1.0 - data.q_1**4) * data.rho_1)
    wheel = 1.0 / ((1.0 - data.q_2**4) * data.rho_2 * data.u**2)
    return pi / 8.0 * ratio * data.d_m1**2 / (pinion + wheel)


def m_red_exact(J_1: float, J_2: float, r_b1: float, r_b2: float, b: float) -> float:
    """Reduced mass per common face width b [kg/mm] from the moments of inertia of both bodies [kg mm2].

    m* = J / (b r_b^2) of each gear (clause 6.5.3); a wheel wider than the mesh counts with all its width.
    """
    m_1, m_2 = J_1 / (b * r_b1**2), J_2 / (b * r_b2**2)
    return m_1 * m_2 / (m_1 + m_2)


def run_in(f: float, v: float, run_in_class: RunIn, sigma_Hlim: float | None) -> float:
    """Running-in allowance y [um] for a deviation f [um] (clauses 6.5.4, 8.3.5).

    Case-hardened and nitrided: 0.075 f, at most 3 um. Through-hardened: 160 f / sigma_Hlim [N/mm2] with the
    caps 12800 / sigma_Hlim for 5 < v <= 10 m/s and 6400 / sigma_Hlim above.
    """
    if run_in_class != "through_hardened":
        return min(0.075 * f, 3.0)
    if sigma_Hlim is None or not sigma_Hlim > 0.0:
        raise DynamicsInputError(
            f"sigma_Hlim = {sigma_Hlim} must be positive for a through-hardened gear; give N/mm2"
        )
    y = 160.0 * f / sigma_Hlim
    if v > 10.0:
        return min(y, 6400.0 / sigma_Hlim, f)
    if v > 5.0:
        return min(y, 12800.0 / sigma_Hlim, f)
    return min(y, f)


def C_ay(sigma_Hlim_1: float, sigma_Hlim_2: float) -> float:
    """Tip relief by running-in [um], mean of both gears; sigma_Hlim [N/mm2] (clause 6.5.4)."""
    return 0.5 * sum((s / 97.0 - 18.45) ** 2 / 18.0 + 1.5 for s in (sigma_Hlim_1, sigma_Hlim_2))


def C_v(epsilon_gamma: float) -> tuple[float, float, float, float, float, float, float]:
    """C_v1 .. C_v7 (table 8)."""
    e = epsilon_gamma
    if e <= 2.0:
        first = (0.32, 0.34, 0.23, 0.90, 0.47, 0.47)
    else:
        first = (
            0.32,
            0.57 / (e - 0.3),
            0.096 / (e - 1.56),
            (0.57 - 0.05 * e) / (e - 1.44),
            0.47,
            0.12 / (e - 1.74),
        )
    if e <= 1.5:
        last = 0.75
    elif e <= 2.5:
        last = 0.125 * sin(pi * (e - 2.0)) + 0.875
    else:
        last = 1.0
    return (*first, last)


def N_S(specific_load: float) -> float:
    """Lower limit of the main resonance range for F_t K_A / b [N/mm] (clause 6.5.3)."""
    return 0.85 if specific_load >= 100.0 else 0.5 + 0.35 * sqrt(specific_load / 100.0)


def range_of(N: float, limit: float) -> Range:
    """Running range of the resonance ratio N with the lower main resonance limit N_S."""
    if limit >= N:
        return "subcritical"
    if N <= 1.15:
        return "main resonance"
    return "intermediate" if N < 1.5 else "supercritical"


def K_V(
    N: float,
    limit: float,
    B: tuple[float, float, float],
    C: tuple[float, float, float, float, float, float, float],
) -> float:
    """Dynamic factor at the resonance ratio N for B = (B_p, B_f, B_k), C = C_v1 .. C_v7 (6.5.5 to 6.5.8)."""
    B_p, B_f, B_k = B
    where = range_of(N, limit)
    if where == "subcritical":
        return N * (C[0] * B_p + C[1] * B_f + C[2] * B_k) + 1.0
    main = C[0] * B_p + C[1] * B_f + C[3] * B_k + 1.0
    if where == "main resonance":
        return main
    above = C[4] * B_p + C[5] * B_f + C[6]
    if where == "supercritical":
        return above
    return above + (main - above) * (1.5 - N) / 0.35


@dataclass(frozen=True, kw_only=True)
class GearLoad:
    """Operating point: F_t [N] transverse tangential force at d_1, n_1 [1/min], K_A [-].

    Raises DynamicsInputError for a force or factor that is not positive or a negative speed.
    """

    F_t: float
    n_1: float
    K_A: float = 1.0

    def __post_init__(self) -> None:
        for name, value, unit in (("F_t", self.F_t, "N"), ("K_A", self.K_A, "")):
            if not value > 0.0:
                raise DynamicsInputError(f"{name} = {value} {unit} must be positive; method B needs a load")
        if self.n_1 < 0.0:
            raise DynamicsInputError(
                f"n_1 = {self.n_1} 1/min must not be negative; give the amount of the speed"
            )


@dataclass(frozen=True, kw_only=True)
class ToothDeviations:
    """f_pb and f_falpha [um], larger of both gears, and their tolerance grade.

    relief_grade : coarsest tolerance grade whose tip relief counts; deviations of a coarser gear drown it, B_k = 1
    """

    f_pb: float
    f_falpha: float
    grade: int
    relief_grade: int = 6


@dataclass(frozen=True, kw_only=True)
class RunningIn:
    """C_a [um] designed tip relief or None for the running-in relief C_ay; sigma_Hlim [N/mm2] of both gears."""

    C_a: float | None = None
    sigma_Hlim: tuple[float, float] = (1500.0, 1500.0)
    run_in_class: RunIn = "case_hardened"


NOT_RELIEVED = RunningIn()


def dynamic_factor(
    data: MeshData,
    load: GearLoad,
    deviations: ToothDeviations,
    running_in: RunningIn = NOT_RELIEVED,
    choices: StiffnessChoices = DEFAULT_CHOICES,
    exact_m_red: float | None = None,
) -> DynamicFactor:
    """K_V by method B (clause 6.5), every factor with it.

    exact_m_red : reduced mass [kg/mm] in place of the disc formula

    Raises DynamicsInputError where the stiffness regression fails or a through-hardened gear has no sigma_Hlim.
    """
    F_t, n_1, K_A = load.F_t, load.n_1, load.K_A
    f_pb, f_falpha, grade = deviations.f_pb, deviations.f_falpha, deviations.grade
    relief_grade = deviations.relief_grade
    C_a, sigma_Hlim, run_in_class = running_in.C_a, running_in.sigma_Hlim, running_in.run_in_class
    specific_load = F_t * K_A / data.b
    tooth = stiffness(data, specific_load, choices)
    warnings = list(tooth.warnings)
    v = pi * data.d_1 * n_1 / 60000.0
    y_p = run_in(f_pb, v, run_in_class, min(sigma_Hlim))
    y_f = run_in(f_falpha, v, run_in_class, min(sigma_Hlim))
    relief = C_ay(*sigma_Hlim) if C_a is None else C_a
    B_p = tooth.c_prime * (f_pb - y_p) / specific_load
    B_f = tooth.c_prime * (f_falpha - y_f) / specific_load
    B_k = abs(1.0 - tooth.c_prime * relief / specific_load)
    if grade > relief_grade:
        warnings.append(
            f"tolerance grade {grade} coarser than {relief_grade}: tip relief is not counted, B_k = 1 instead of "
            f"{B_k:.3f}; a finer grade would let it count"
        )
        B_k = 1.0
    mass = m_red(data) if exact_m_red is None else exact_m_red
    n_E1 = 30000.0 / (pi * data.z_1) * sqrt(tooth.c_gamma_alpha / mass)
    N, limit = n_1 / n_E1, N_S(specific_load)
    C = C_v(data.epsilon_gamma)
    if data.epsilon_gamma > 11.4:
        warnings.append(
            f"epsilon_gamma = {data.epsilon_gamma:.2f} above 11.4: C_v4 is negative; use method A"
        )
    lever = (v * data.z_1 / 100.0) * sqrt(data.u**2 / (1.0 + data.u**2))
    if lever < 3.0:
        warnings.append(
            f"(v z1/100) sqrt(u^2/(1+u^2)) = {lever:.3f} m/s below 3 m/s, where method B is meant to start; "
            "method C serves there"
        )
    return DynamicFactor(
        stiffness=tooth,
        F_t=F_t,
        v=v,
        K_A=K_A,
        specific_load=specific_load,
        f_pb_eff=f_pb - y_p,
        f_falpha_eff=f_falpha - y_f,
        y_p=y_p,
        y_f=y_f,
        C_a=relief,
        m_red=mass,
        n_1=n_1,
        n_E1=n_E1,
        N=N,
        N_S=limit,
        B_p=B_p,
        B_f=B_f,
        B_k=B_k,
        C_v1=C[0],
        C_v2=C[1],
        C_v3=C[2],
        C_v4=C[3],
        C_v5=C[4],
        C_v6=C[5],
        C_v7=C[6],
        range=range_of(N, limit),
        K_V=K_V(N, limit, (B_p, B_f, B_k), C),
        warnings=tuple(warnings),
    )
