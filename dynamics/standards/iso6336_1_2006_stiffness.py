"""ISO 6336-1:2006, tooth and mesh stiffness by method B (clause 9).

Printed symbols and the document's units: mm, N, N/(mm um), mm um/N, degrees.
"""

from dataclasses import dataclass
from math import cos, exp, log, radians

from dynamics.errors import DynamicsInputError

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
    found = []
    total = data.x_1 + data.x_2
    if data.x_1 < data.x_2:
        found.append(
            f"x1 = {data.x_1:.4f} below x2 = {data.x_2:.4f}: outside the range x1 >= x2 of the stiffness "
            "regression (clause 9.3.1.1); confirm the stiffness by contact analysis"
        )
    if not -0.5 <= total <= 2.0:
        found.append(
            f"x1 + x2 = {total:.4f} outside -0.5..2 of the stiffness regression (clause 9.3.1.1); "
            "confirm the stiffness by contact analysis"
        )
    return tuple(found)
