"""ISO 281:2007, rolling bearings: dynamic load ratings and rating life.

Symbols and units as printed (N, mm, mm2/s, 1/min, millions of revolutions). Confidence: the coefficients of equations
(27) to (36) and the simplified fatigue load limit were found in public programs that cite the equation numbers, the
mean contamination factors of table 13 in a bearing manual; the reliability factors of table 12 are from memory.
"""

import math
from itertools import pairwise
from typing import Literal, NamedTuple

from dynamics.errors import DynamicsInputError

Contact = Literal["ball", "roller"]

LIFE_EXPONENT: dict[Contact, float] = {"ball": 3.0, "roller": 10.0 / 3.0}
"""p in L_10 = (C / P)^p."""
KAPPA_MINIMUM = 0.1
"""Lubrication below which the equations of a_ISO are not stated; there a_ISO = 0.1."""
KAPPA_MAXIMUM = 4.0
"""Lubrication above which the value at 4 is used."""
A_ISO_MAXIMUM = 50.0
A_1 = {0.90: 1.0, 0.95: 0.64, 0.96: 0.55, 0.97: 0.47, 0.98: 0.37, 0.99: 0.25}
"""Life factor for reliability by reliability (table 12; from memory)."""

E_C = {
    "extreme cleanliness": (1.0, 1.0),
    "high cleanliness": (0.7, 0.85),
    "normal cleanliness": (0.55, 0.7),
    "slight contamination": (0.4, 0.5),
    "typical contamination": (0.2, 0.3),
    "severe contamination": (0.05, 0.05),
    "very severe contamination": (0.0, 0.0),
}
"""Middle of the printed range of the contamination factor below and from D_pw = 100 mm (table 13)."""


class _Branch(NamedTuple):
    kappa_below: float
    coefficient: float
    exponent: float


class _LifeModification(NamedTuple):
    """a_ISO = 0.1 [1 - (first - coefficient / kappa^exponent)^inner (e_C C_u / P)^load]^outer."""

    first: float
    inner: float
    load: float
    outer: float
    branches: tuple[_Branch, _Branch, _Branch]


_A_ISO: dict[Contact, _LifeModification] = {
    "ball": _LifeModification(
        2.5671, 0.83, 1.0 / 3.0, -9.3,
        (_Branch(0.4, 2.2649, 0.054381), _Branch(1.0, 1.9987, 0.19087), _Branch(math.inf, 1.9987, 0.071739)),
    ),
    "roller": _LifeModification(
        1.5859, 1.0, 0.4, -9.185,
        (_Branch(0.4, 1.3993, 0.054381), _Branch(1.0, 1.2348, 0.19087), _Branch(math.inf, 1.2348, 0.071739)),
    ),
}  # fmt: skip


def L_10(C: float, P: float, contact: Contact) -> float:
    """Basic rating life [1e6 rev]: (C / P)^p; infinite without load."""
    if P <= 0.0:
        return math.inf
    life: float = (C / P) ** LIFE_EXPONENT[contact]
    return life


def nu_1(n: float, D_pw: float) -> float:
    """Reference kinematic viscosity [mm2/s], equations (28) and (29); infinite at standstill.

    45000 n^-0.83 D_pw^-0.5 below 1000 1/min, 4500 n^-0.5 D_pw^-0.5 from there
    """
    if n <= 0.0:
        return math.inf
    speed_term: float = 45000.0 * n**-0.83 if n < 1000.0 else 4500.0 * n**-0.5
    return speed_term / math.sqrt(D_pw)


def a_ISO(kappa: float, contamination_load: float, contact: Contact) -> float:
    """Life modification factor of a radial bearing, equations (31) to (33) ball, (34) to (36) roller.

    kappa : viscosity ratio nu / nu_1, above 4 taken as 4, below 0.1 the factor is 0.1
    contamination_load : e_C C_u / P
    """
    if kappa <= KAPPA_MINIMUM:
        return 0.1
    capped = min(kappa, KAPPA_MAXIMUM)
    law = _A_ISO[contact]
    branch = next(branch for branch in law.branches if capped < branch.kappa_below)
    lubrication = max(law.first - branch.coefficient / capped**branch.exponent, 0.0) ** law.inner
    bracket = 1.0 - lubrication * contamination_load**law.load
    if bracket <= 0.0:
        return A_ISO_MAXIMUM
    factor: float = min(0.1 * bracket**law.outer, A_ISO_MAXIMUM)
    return factor


def a_1(reliability: float) -> float:
    """Life factor for reliability, linear between the printed values.

    Raises DynamicsInputError outside 0.90 to 0.99.
    """
    levels = sorted(A_1)
    if not levels[0] <= reliability <= levels[-1]:
        raise DynamicsInputError(
            f"reliability = {reliability:.4g}: must lie within {levels[0]} to {levels[-1]} (ISO 281 table 12); "
            "give one of these or multiply the life by your own factor"
        )
    for low, high in pairwise(levels):
        if reliability <= high:
            return A_1[low] + (A_1[high] - A_1[low]) * (reliability - low) / (high - low)
    return A_1[levels[-1]]


def e_C(level: str, D_pw: float) -> float:
    """Contamination factor of a level of cleanliness, the middle of its printed range (table 13).

    Raises DynamicsInputError for an unknown level.
    """
    if level not in E_C:
        raise DynamicsInputError(
            f"contamination level = {level!r}: not in table 13 of ISO 281; give one of {', '.join(E_C)} or a number"
        )
    return E_C[level][0 if D_pw < 100.0 else 1]


def C_u(C_0: float, D_pw: float, contact: Contact) -> float:
    """Fatigue load limit by the simplified way [unit of C_0]: C_0 / 22 ball, C_0 / 8.2 roller, smaller above 100 mm."""
    divisor, exponent = (22.0, 0.5) if contact == "ball" else (8.2, 0.3)
    limit: float = C_0 / divisor * min(1.0, 100.0 / D_pw) ** exponent
    return limit
