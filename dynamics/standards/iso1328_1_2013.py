"""ISO 1328-1:2013, Cylindrical gears, flank tolerance classification. Lengths [mm], tolerances [um].

Tolerance values follow clause 5.3; each grows with sqrt(2) per grade A from grade 5 and is rounded by 5.2.3.
"""

from dataclasses import dataclass
from math import floor, sqrt

from dynamics.errors import DynamicsInputError

GRADES = range(1, 12)


def rounded(value: float) -> float:
    """Round a tolerance [um]: above 10 to 1, from 5 to 10 to 0.5, below 5 to 0.1 (clause 5.2.3)."""
    step = 1.0 if value > 10.0 else 0.5 if value >= 5.0 else 0.1
    return round(floor(value / step + 0.5 + 1e-9) * step, 1)


def _graded(value: float, A: int) -> float:
    if A not in GRADES:
        raise DynamicsInputError(
            f"tolerance grade A = {A} must lie in 1..11 (ISO 1328-1:2013, 5.1); choose a grade"
        )
    return rounded(value * sqrt(2.0) ** (A - 5))


def f_pT(d: float, m_n: float, A: int) -> float:
    """Single pitch tolerance [um]."""
    return _graded(0.001 * d + 0.4 * m_n + 5.0, A)


def F_pT(d: float, m_n: float, A: int) -> float:
    """Total cumulative pitch tolerance [um]."""
    return _graded(0.002 * d + 0.55 * sqrt(d) + 0.7 * m_n + 12.0, A)


def F_rT(d: float, m_n: float, A: int) -> float:
    """Run-out tolerance, 0.9 of the unrounded F_pT [um] (annex D)."""
    return _graded(0.9 * (0.002 * d + 0.55 * sqrt(d) + 0.7 * m_n + 12.0), A)


def f_falphaT(m_n: float, A: int) -> float:
    """Profile form tolerance [um]."""
    return _graded(0.55 * m_n + 5.0, A)


def f_HalphaT(d: float, m_n: float, A: int) -> float:
    """Profile slope tolerance, one side [um]."""
    return _graded(0.4 * m_n + 0.001 * d + 4.0, A)


def f_HbetaT(d: float, b: float, A: int) -> float:
    """Helix slope tolerance, one side [um]."""
    return _graded(0.05 * sqrt(d) + 0.35 * sqrt(b) + 4.0, A)


def f_fbetaT(d: float, b: float, A: int) -> float:
    """Helix form tolerance [um]."""
    return _graded(0.07 * sqrt(d) + 0.45 * sqrt(b) + 4.0, A)


@dataclass(frozen=True, kw_only=True)
class Tolerances:
    """Flank tolerances of one gear [um], printed symbols; ``warnings`` lists what lies outside clause 1."""

    A: int
    f_pT: float
    F_pT: float
    F_rT: float
    f_falphaT: float
    f_HalphaT: float
    f_HbetaT: float
    f_fbetaT: float
    warnings: tuple[str, ...]


def tolerances(z: int, d: float, m_n: float, b: float, A: int, beta: float = 0.0) -> Tolerances:
    """All tolerances of a gear of ``z`` teeth, ``d``, ``m_n``, ``b`` [mm], grade ``A``, ``beta`` [deg].

    Raises DynamicsInputError for a grade outside 1..11; sizes outside the scope of clause 1 give warnings.
    """
    scope: tuple[tuple[str, float, float, float], ...] = (
        ("z", z, 5, 1000),
        ("d", d, 5.0, 15000.0),
        ("m_n", m_n, 0.5, 70.0),
        ("b", b, 4.0, 1200.0),
        ("beta", beta, 0.0, 45.0),
    )
    warnings = tuple(
        f"{name} = {value:g} outside {low:g}..{high:g} of ISO 1328-1:2013; agree tolerances with the maker"
        for name, value, low, high in scope
        if not low <= value <= high
    )
    return Tolerances(
        A=A,
        f_pT=f_pT(d, m_n, A),
        F_pT=F_pT(d, m_n, A),
        F_rT=F_rT(d, m_n, A),
        f_falphaT=f_falphaT(m_n, A),
        f_HalphaT=f_HalphaT(d, m_n, A),
        f_HbetaT=f_HbetaT(d, b, A),
        f_fbetaT=f_fbetaT(d, b, A),
        warnings=warnings,
    )
