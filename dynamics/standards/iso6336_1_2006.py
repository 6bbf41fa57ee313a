"""ISO 6336-1:2006, dynamic factor K_V by method B (clause 6.5) with the stiffness of clause 9.

Printed symbols and the document's units: mm, N, um, N/(mm um), kg/mm, 1/min, degrees.
"""

from dataclasses import dataclass
from math import cos, exp, log, pi, radians, sin, sqrt
from typing import Literal

from dynamics.errors import DynamicsInputError

# ISO 6336-1:2006, tooth and mesh stiffness by method B (clause 9).
#
# Printed symbols and the document's units: mm, N, N/(mm um), mm um/N, degrees.

E_ST = 206000.0
"""Young's modulus of the steel pair behind the stiffness regression [N/mm2]."""


@dataclass(frozen=True, kw_only=True)
class MeshData:
    """A gear pair as clause 6 and 9 read it."""

    z_1: int
    z_2: int
    z_n1: float
    z_n2: float
    m_n: float
    alpha_Pn: float
    alpha_t: float
    beta: float
    x_1: float
    x_2: float
    h_fP1: float
    """Rack dedendum in modules, h_fP1 / m_n."""
    h_fP2: float
    b: float
    d_1: float
    d_b1: float
    d_m1: float
    d_m2: float
    epsilon_alpha: float
    epsilon_beta: float
    rho_1: float = 7.83e-6
    rho_2: float = 7.83e-6
    q_1: float = 0.0
    """d_i1 / d_m1 (0: solid)."""
    q_2: float = 0.0
    E_1: float = E_ST
    E_2: float = E_ST
    b_s_over_b: tuple[float | None, float | None] = (None, None)
    """Web thickness over face width; None: solid disc gears."""
    s_R_over_m_n: tuple[float, float] = (1.0, 1.0)

    @property
    def u(self) -> float:
        """Gear ratio z_2 / z_1."""
        return self.z_2 / self.z_1

    @property
    def epsilon_gamma(self) -> float:
        """Total contact ratio."""
        return self.epsilon_alpha + self.epsilon_beta


@dataclass(frozen=True, kw_only=True)
class Stiffness:
    """Tooth and mesh stiffness of clause 9 with its factors [N/(mm um)], q_prime [mm um/N]."""

    q_prime: float
    c_prime_th: float
    C_M: float
    C_R: float
    C_B: float
    C_L: float
    """Low-load factor (F_t K_A / b / 100)^0.25, at most 1; 1 if switched off."""
    c_prime: float
    c_gamma_alpha: float
    c_gamma_beta: float
    warnings: tuple[str, ...]


def q_prime(z_n1: float, z_n2: float, x_1: float, x_2: float) -> float:
    """Minimum flexibility of a tooth pair q' [mm um/N] (clause 9.3.1.1, series with C_1 .. C_9)."""
    return (
        0.04723
        + 0.15551 / z_n1
        + 0.25791 / z_n2
        - 0.00635 * x_1
        - 0.11654 * x_1 / z_n1
        - 0.00193 * x_2
        - 0.24188 * x_2 / z_n2
        + 0.00529 * x_1**2
        + 0.00182 * x_2**2
    )


def C_B(h_fP: float, alpha_Pn: float) -> float:
    """Basic rack factor (clause 9.3.1.4); ``h_fP`` in modules, ``alpha_Pn`` [deg]."""
    return (1.0 + 0.5 * (1.2 - h_fP)) * (1.0 - 0.02 * (20.0 - alpha_Pn))


def C_R(b_s_over_b: float | None, s_R_over_m_n: float) -> float:
    """Gear blank factor (clause 9.3.1.3); None is a solid disc, 1.0."""
    if b_s_over_b is None:
        return 1.0
    web = min(max(b_s_over_b, 0.2), 1.2)
    rim = max(s_R_over_m_n, 1.0)
    return 1.0 + log(web) / (5.0 * exp(rim / 5.0))


@dataclass(frozen=True, kw_only=True)
class StiffnessChoices:
    """Choices of clause 9: whether c' falls with loads below 100 N/mm, and the measured correction C_M."""

    low_load_factor: bool = True
    C_M: float = 0.8


DEFAULT_CHOICES = StiffnessChoices()


def stiffness(data: MeshData, specific_load: float, choices: StiffnessChoices = DEFAULT_CHOICES) -> Stiffness:
    """Single and mesh stiffness of clause 9 at ``specific_load`` = F_t K_A / b [N/mm].

    Raises DynamicsInputError where the regression of q' gives nothing positive.
    """
    C_M = choices.C_M
    warnings = list(_regression_warnings(data))
    q = q_prime(data.z_n1, data.z_n2, data.x_1, data.x_2)
    if not q > 0.0:
        raise DynamicsInputError(
            f"q' = {q:.5f} mm um/N must be positive: the stiffness regression fails for x1 = {data.x_1:.3f}, "
            f"x2 = {data.x_2:.3f}; use measured or finite-element stiffness"
        )
    C_B_mean = 0.5 * (C_B(data.h_fP1, data.alpha_Pn) + C_B(data.h_fP2, data.alpha_Pn))
    C_R_value = 0.5 * sum(map(C_R, data.b_s_over_b, data.s_R_over_m_n))
    C_L = min(specific_load / 100.0, 1.0) ** 0.25 if choices.low_load_factor else 1.0
    E = 2.0 * data.E_1 * data.E_2 / (data.E_1 + data.E_2)
    c_prime = C_M * C_R_value * C_B_mean * cos(radians(data.beta)) / q * (E / E_ST) * C_L
    c_gamma_alpha = c_prime * (0.75 * data.epsilon_alpha + 0.25)
    if data.epsilon_alpha < 1.2:
        c_gamma_alpha *= 0.9
        warnings.append(
            f"epsilon_alpha = {data.epsilon_alpha:.4f} below 1.2: c_gamma_alpha taken 10 % lower "
            "(clause 9.3.2); confirm the mesh stiffness by contact analysis"
        )
    return Stiffness(
        q_prime=q,
        c_prime_th=1.0 / q,
        C_M=C_M,
        C_R=C_R_value,
        C_B=C_B_mean,
        C_L=C_L,
        c_prime=c_prime,
        c_gamma_alpha=c_gamma_alpha,
        c_gamma_beta=0.85 * c_gamma_alpha,
        warnings=tuple(warnings),
    )


def _regression_warnings(data: MeshData) -> tuple[str, ...]:
    warnings = []
    total = data.x_1 + data.x_2
    if data.x_1 < data.x_2:
        warnings.append(
            f"x1 = {data.x_1:.4f} below x2 = {data.x_2:.4f}: outside the range x1 >= x2 of the stiffness "
            "regression (clause 9.3.1.1); confirm the stiffness by contact analysis"
        )
    if not -0.5 <= total <= 2.0:
        warnings.append(
            f"x1 + x2 = {total:.4f} outside -0.5..2 of the stiffness regression (clause 9.3.1.1); "
            "confirm the stiffness by contact analysis"
        )
    return tuple(warnings)


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
