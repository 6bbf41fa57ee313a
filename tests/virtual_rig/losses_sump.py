"""Losses of parts that run in a sump: roller bearings, churning gears, lip seals.

All three by laws that the checker does not take for this rig, written from memory of the sources named; the checks of
their numbers stand in `tests/verification/test_virtual_rig_sump.py`.
"""

import math
from dataclasses import dataclass

LEAST_CHORD = 1e-9


@dataclass(frozen=True, kw_only=True)
class Dipped:
    """A gear as a disc that dips into oil; lengths in metres."""

    radius: float
    """Pitch radius: of the speed and of the circle that is wetted."""
    width: float
    level: float
    """Height of the oil over the axis; below it negative."""

    @property
    def half_angle(self) -> float:
        """Half of the angle of the rim that is wetted [rad]."""
        return math.acos(min(max(-self.level / self.radius, -1.0), 1.0))

    @property
    def chord(self) -> float:
        """Width of the disc at the surface of the oil."""
        return 2.0 * self.radius * math.sin(self.half_angle)

    @property
    def wetted_area(self) -> float:
        """Both faces and the rim in the oil [m2]."""
        angle = self.half_angle
        return self.radius**2 * (2.0 * angle - math.sin(2.0 * angle)) + 2.0 * angle * self.radius * self.width


def roller_bearing_torque(
    load: float, speed: float, viscosity: float, mean_diameter: float, f_0: float, f_1: float
) -> float:
    """Friction torque of a cylindrical roller bearing without axial load [N m]: Palmgren's two parts.

    load [N], speed [rad/s], kinematic viscosity [m2/s] at the temperature of the bearing, mean of bore and outside
    diameter [m]. M_0 = 1e-7 f_0 (nu n)^(2/3) d_m^3 (160e-7 f_0 d_m^3 where nu n < 2000) and M_1 = f_1 F d_m, in N mm,
    mm2/s, 1/min, mm. f_0, f_1 by series (DIN 732-2): 2 and 0.0004 for the heavy one, in a bath up to the lowest roller.
    Source: A. Palmgren, Ball and Roller Bearing Engineering, 3rd ed. 1959; T. A. Harris, Rolling Bearing Analysis.
    Holds for bearings that do not skid (load over 0.02 of the rating) below the limiting speed.
    """
    if speed <= 0.0:
        return 0.0
    d_m, nu_n = 1e3 * mean_diameter, 1e6 * viscosity * speed * 30.0 / math.pi
    free = 1e-7 * f_0 * (nu_n ** (2.0 / 3.0) if nu_n >= 2000.0 else 160.0) * d_m**3
    return 1e-3 * (free + f_1 * load * d_m)


def drag_coefficient(reynolds: float) -> float:
    """C_m of a disc that dips into oil: 20/Re, 8.6e-4 Re^(1/3), 5e8/Re^2.

    Re = omega R L/nu with the chord L at the surface. The branches are those of R. J. Boness, Churning losses of discs
    and gears running partially submerged in oil, Proc. ASME Int. Power Transm. and Gearing Conf., Chicago 1989, p. 355,
    printed to meet near Re = 2000 and 1e5; here they meet where they cross (1900 and 1.1e5), so that no jump is left.
    """
    return min(max(20.0 / reynolds, 8.6e-4 * reynolds ** (1.0 / 3.0)), 5e8 / reynolds**2)


def churning_power(gear: Dipped, speed: float, density: float, viscosity: float) -> float:
    """Power a dipped gear loses to the oil [W]: rho omega^3 R^3 S C_m / 2, S the wetted area.

    speed [rad/s], density [kg/m3], kinematic viscosity [m2/s]. Boness tested discs and gears in water and thin oils;
    on gears in transmission oil his law is known to lie high, so a rig has a factor on it (`sump_constants`).
    """
    if speed <= 0.0 or gear.chord < LEAST_CHORD:
        return 0.0
    reynolds = speed * gear.radius * gear.chord / viscosity
    return 0.5 * density * speed**3 * gear.radius**3 * gear.wetted_area * drag_coefficient(reynolds)


def lip_seal_power(diameter: float, speed: float, oil: float, nu_40: float) -> float:
    """Radial lip seal [W] at an oil temperature [K]: 1e-7 (145 - 1.6 T + 350 lg lg(nu_40 + 0.8)) d^2 n.

    Temperature in degC, viscosity at 40 degC in mm2/s, d in mm, n in 1/min. Source: H. Linke, Stirnradverzahnung, 1996.
    For rubber lips on ground shafts, oil at 20 to 120 degC; below a third of the value at 90 degC it is cut off.
    """
    level = 145.0 - 1.6 * (oil - 273.15) + 350.0 * math.log10(math.log10(1e6 * nu_40 + 0.8))
    return 1e-7 * max(level, 35.0) * (1e3 * diameter) ** 2 * speed * 30.0 / math.pi


def roller_stiffness(load: float, rollers: int, roller_length: float) -> float:
    """Radial stiffness [N/m] of a cylindrical roller bearing at a load [N], without clearance.

    Palmgren's line contact delta = 7.68e-5 Q^0.9 / l^0.8 (mm, N, both raceways) with Q = 4.6 F / Z on the lowest roller
    (Stribeck); the slope dF/ddelta.
    """
    force = max(load, 50.0)
    deflection = 1e-3 * 7.68e-5 * (4.6 * force / rollers) ** 0.9 / (1e3 * roller_length) ** 0.8
    return force / (0.9 * deflection)
