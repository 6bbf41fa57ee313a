"""ISO/TS 6336-22:2018 (formerly ISO/TR 15144-1), micropitting load capacity: bulk temperature of the teeth.

Symbols and units as printed (kW, mm, degC). Confidence: the formula is Michaelis' (diss. TUM 1987; Oster 1982 before)
and from memory. It gives the 126 degC found by hand for FZG-C gears at 372.6 N m, 2250 rpm and a sump of 90 degC; the
lubrication factors are those of ISO/TR 13989. Compare with a copy before it decides a verdict.
"""

from dynamics.errors import DynamicsInputError

X_S = {"injection": 1.2, "dip": 1.0, "submerged": 0.2}
"""Lubrication factor by oil supply [-]."""


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
