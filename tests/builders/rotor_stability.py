"""Stability of a rigid rotor on bearings with given stiffness and damping: critical mass, whirl frequency, threshold.

Every bearing carries the mass m; small motions follow det(m s^2 + C s + K) = 0. On the limit of stability s = i nu,

    m nu^2 = k_eq = (k_yy c_zz + k_zz c_yy - k_yz c_zy - k_zy c_yz) / (c_yy + c_zz)
    nu^2 = ((k_eq - k_yy)(k_eq - k_zz) - k_yz k_zy) / (c_yy c_zz - c_yz c_zy)

Below the critical mass k_eq / nu^2 it is stable (Routh and Hurwitz; J. W. Lund, K. K. Thomsen 1978). Shafts that bend,
different bearings and gyroscopic moments need the eigenvalues of the whole rotor.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from dynamics.errors import DynamicsInputError
from dynamics.rotor.bearing import LateralCoefficients

SPEEDS = 60
"""At which a range is searched for the first instability, in equal ratios."""


@dataclass(frozen=True, kw_only=True)
class RotorStability:
    """Stability of a rigid rotor on one bearing."""

    equivalent_stiffness: float
    """k_eq that the whirling rotor feels [N/m]."""
    whirl_frequency: float
    """nu at the limit of stability [rad/s]; 0 where there is none."""
    critical_mass: float
    """Mass on the bearing above which it is unstable [kg]; infinite where every mass is stable, 0 where none is."""

    def whirl_ratio(self, omega: float) -> float:
        """nu over the shaft speed [rad/s]; about 0.5 for a plain bearing with little load."""
        return self.whirl_frequency / omega


def rotor_stability(coefficients: LateralCoefficients) -> RotorStability:
    """Critical mass and whirl frequency of a rigid rotor.

    Raises DynamicsInputError for coefficients without damping, which have no limit of stability.
    """
    stiffness, damping = coefficients.stiffness, coefficients.damping
    trace, determinant = float(np.trace(damping)), float(np.linalg.det(damping))
    if not (trace > 0.0 and determinant > 0.0):
        raise DynamicsInputError(
            f"stability: determinant of the damping = {determinant:.3g} (N s/m)^2: must be above 0; give the bearing a "
            "damping"
        )
    mixed = np.trace(stiffness) * trace - float(np.sum(stiffness * damping.T))
    equivalent = float(mixed) / trace
    if equivalent <= 0.0 or float(np.linalg.det(stiffness)) <= 0.0:
        return RotorStability(equivalent_stiffness=equivalent, whirl_frequency=0.0, critical_mass=0.0)
    rest = equivalent * np.eye(2) - stiffness
    squared = float(np.linalg.det(rest)) / determinant
    if squared <= 0.0:
        return RotorStability(equivalent_stiffness=equivalent, whirl_frequency=0.0, critical_mass=math.inf)
    return RotorStability(
        equivalent_stiffness=equivalent,
        whirl_frequency=math.sqrt(squared),
        critical_mass=equivalent / squared,
    )


def threshold_speed(
    coefficients: Callable[[float], LateralCoefficients], mass: float, slowest: float, fastest: float
) -> float | None:
    """Lowest speed at which a rigid rotor becomes unstable [rad/s]; None where it is stable over the whole range.

    coefficients : of a bearing at a speed [rad/s], with load and temperature there
    mass : on the bearing [kg]
    slowest, fastest : range, above 0 [rad/s]; ``slowest`` comes back where it is unstable already

    Raises DynamicsInputError for a range that is none.
    """
    if not 0.0 < slowest < fastest:
        raise DynamicsInputError(
            f"stability: speeds = {slowest:.6g} to {fastest:.6g} rad/s: must rise from above 0; correct the range"
        )

    def stable(omega: float) -> bool:
        return mass < rotor_stability(coefficients(omega)).critical_mass

    below = slowest
    for above in np.geomspace(slowest, fastest, SPEEDS):
        if not stable(float(above)):
            return _bisected(stable, below, float(above))
        below = float(above)
    return None


def _bisected(stable: Callable[[float], bool], below: float, above: float) -> float:
    while above - below > 1e-6 * above:
        middle = 0.5 * (below + above)
        below, above = (middle, above) if stable(middle) else (below, middle)
    return above
