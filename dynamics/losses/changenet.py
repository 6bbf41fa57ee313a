"""Coefficient of the churning torque of one gear after Changenet and Velex, from tests on single gears in a bath.

    T = rho omega^2 R^3 S_m C_m / 2 ,   R pitch radius, S_m wetted surface (`immersion.wetted_area`)

C_m is a product of powers of h/D, V_0/D^3, b/D, Froude and Reynolds number. The form of 2007 tells the regimes apart by
Re_c = omega R b/nu, that of 2011 by a centrifugal acceleration and by Re_c. All digits are from memory, no public copy
of them was found. One check speaks for those of 2011: the formulas meet in pairs, 1.366 to 0.239 and 20.797 to 3.644,
both at a Reynolds number of 4000 within 1 %.
"""

from typing import NamedTuple

from dynamics.losses.immersion import OilBath, RunningGear, immersion

GRAVITY = 9.81
SLOW, FAST = 750.0, 1250.0
"""Centrifugal accelerations [m/s2] between which the 2011 laws are joined."""
VISCOUS_LIMIT = 4000.0
"""Re_c above which viscosity drops out of the 2011 laws."""
LOW_RE, HIGH_RE = 6000.0, 9000.0
"""Re_c between which the 2007 laws are joined."""


class BathNumbers(NamedTuple):
    """Dimensionless numbers of a dipped gear, lengths at its pitch circle."""

    depth: float
    """h/D"""
    oil: float
    """V_0/D^3"""
    width: float
    """b/D"""
    froude: float
    """omega^2 R/g"""
    reynolds: float
    """omega R b/nu, the number that separates the regimes"""
    acceleration: float
    """gamma = omega^2 (b R m)^(1/3) [m/s2]"""


def bath_numbers(running: RunningGear, bath: OilBath) -> BathNumbers:
    """Dimensionless numbers of a gear in a bath; the depth is that of the pitch circle."""
    gear, speed = running.gear, abs(running.speed)
    diameter = 2.0 * gear.pitch_radius
    size: float = (gear.face_width * gear.pitch_radius * gear.normal_module) ** (1.0 / 3.0)
    return BathNumbers(
        depth=immersion(gear, bath, gear.pitch_radius).depth / diameter,
        oil=bath.volume / diameter**3,
        width=gear.face_width / diameter,
        froude=speed**2 * gear.pitch_radius / GRAVITY,
        reynolds=speed * gear.pitch_radius * gear.face_width / bath.kinematic_viscosity,
        acceleration=speed**2 * size,
    )


def coefficient_2007(numbers: BathNumbers) -> float:
    """C_m of Changenet and Velex, J. Mech. Des. 129 (2007) 128 [-], from memory.

    Re_c <= 6000: 1.366 (h/D)^0.45 (V_0/D^3)^0.1 Fr^-0.6 Re^-0.21, Re = omega R^2/nu
    Re_c >= 9000: 3.644 (h/D)^0.1 (V_0/D^3)^-0.35 Fr^-0.88 (b/D)^0.85; straight in Re_c between
    """
    share = _between(numbers.reynolds, LOW_RE, HIGH_RE)
    slow: float = 1.366 * _slow_shape(numbers) * numbers.reynolds**-0.21
    return (1.0 - share) * slow + share * 3.644 * _fast_shape(numbers)


def coefficient_2011(numbers: BathNumbers) -> float:
    """C_m of Changenet, Leprince, Ville and Velex, J. Mech. Des. 133 (2011) 121009 [-], from memory.

    gamma <= 750 m/s2: 1.366 (h/D)^0.45 (V_0/D^3)^0.1 Fr^-0.6 Re_c^-0.21 (b/R)^0.21, without Re_c: 0.239
    gamma >= 1250 m/s2: 20.797 (h/D)^0.1 (V_0/D^3)^-0.35 Fr^-0.88 Re_c^-0.21 (b/D)^0.85, without Re_c: 3.644

    Straight in gamma between. Viscosity acts below Re_c = 4000, where both forms of a line meet: the constants 0.239
    and 3.644 are 1.366 and 20.797 times 4000^-0.21.
    """
    share = _between(numbers.acceleration, SLOW, FAST)
    viscous: float = min(numbers.reynolds, VISCOUS_LIMIT) ** -0.21
    slow, fast = 1.366 * _slow_shape(numbers), 20.797 * _fast_shape(numbers)
    return viscous * ((1.0 - share) * slow + share * fast)


def _slow_shape(numbers: BathNumbers) -> float:
    """(h/D)^0.45 (V_0/D^3)^0.1 Fr^-0.6 (b/R)^0.21; the last turns Re_c^-0.21 into Re^-0.21."""
    shape: float = (
        numbers.depth**0.45 * numbers.oil**0.1 * numbers.froude**-0.6 * (2.0 * numbers.width) ** 0.21
    )
    return shape


def _fast_shape(numbers: BathNumbers) -> float:
    shape: float = numbers.depth**0.1 * numbers.oil**-0.35 * numbers.froude**-0.88 * numbers.width**0.85
    return shape


def _between(value: float, low: float, high: float) -> float:
    return min(1.0, max(0.0, (value - low) / (high - low)))
