"""Residual unbalance of a shaft by its balance quality grade, in its two bearing planes (ISO 21940-11).

The grade G is the speed of the centre of mass, e_per Omega; the permissible unbalance is U_per = m G / Omega with the
mass m and highest service speed Omega of the rotor. It goes to the bearing planes by the lever rule, with 0.3 to 0.7 of
it in either of them where the centre of mass lies between, and up to 1.3 where it overhangs.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from dynamics.drivetrain.graph import Drivetrain
from dynamics.drivetrain.shaft import DrivetrainError
from dynamics.elastic_rig.rotating_parts import ShaftUnbalance

LEAST_SHARE = 0.3
MOST_INSIDE, MOST_BEYOND = 0.7, 1.3
"""Share of the unbalance in one bearing plane: centre of mass between the bearings, and beyond them."""


@dataclass(frozen=True, kw_only=True)
class BalanceGrade:
    """Grade [m/s] (G 2.5 is 2.5e-3), speed for which it holds [rad/s], angles in the two planes [rad].

    Equal angles are a static unbalance, angles that differ by half a turn a couple.
    """

    grade: float
    speed: float
    angles: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        if not (self.grade >= 0.0 and self.speed > 0.0):
            raise DrivetrainError(
                f"balance grade = {self.grade} m/s at {self.speed} rad/s: must not be negative, at a speed above 0; "
                "correct them"
            )

    @property
    def eccentricity(self) -> float:
        """Permissible of the centre of mass, e_per [m]."""
        return self.grade / self.speed


@dataclass(frozen=True, kw_only=True)
class Rotor:
    """Mass [kg] of a shaft with its discs and gears, and its centre from the left end [m]."""

    mass: float
    centre: float


def rotor_of(drivetrain: Drivetrain, shaft: str) -> Rotor:
    """A shaft with discs, gears and a motor rotor that it carries."""
    parts = list(_masses(drivetrain, shaft))
    mass = math.fsum(mass for mass, _ in parts)
    return Rotor(mass=mass, centre=math.fsum(mass * at for mass, at in parts) / mass)


def residual_unbalances(
    drivetrain: Drivetrain, shaft: str, grade: BalanceGrade
) -> tuple[ShaftUnbalance, ...]:
    """What the grade leaves in the planes of the outer two bearings of a shaft; at its centre of mass where it has one
    bearing or none."""
    rotor = rotor_of(drivetrain, shaft)
    whole = rotor.mass * grade.eccentricity
    planes = sorted({bearing.position for bearing in drivetrain.bearings if bearing.shaft == shaft})
    if len(planes) < 2:
        return (ShaftUnbalance(shaft=shaft, position=rotor.centre, moment=whole, angle=grade.angles[0]),)
    first, second = planes[0], planes[-1]
    levers = (second - rotor.centre) / (second - first), (rotor.centre - first) / (second - first)
    most = MOST_INSIDE if first <= rotor.centre <= second else MOST_BEYOND
    return tuple(
        ShaftUnbalance(
            shaft=shaft, position=plane, moment=whole * min(max(abs(lever), LEAST_SHARE), most), angle=angle
        )
        for plane, lever, angle in zip((first, second), levers, grade.angles)
    )


def _masses(drivetrain: Drivetrain, shaft: str) -> Iterator[tuple[float, float]]:
    """(mass [kg], position [m]) of sections, discs, gears and motor of a shaft."""
    own = next(one for one in drivetrain.shafts if one.name == shaft)
    start = 0.0
    for section in own.sections:
        area = 0.25 * math.pi * (section.outer_diameter**2 - section.inner_diameter**2)
        yield own.density * area * section.length, start + 0.5 * section.length
        start += section.length
    yield from ((disc.mass, disc.position) for disc in own.discs)
    for gear in drivetrain.gears:
        if gear.shaft == shaft:
            yield gear.mass, gear.position + gear.offset
    motor = drivetrain.motor
    if motor.shaft == shaft and motor.diametral_inertia is not None:
        yield motor.mass, motor.position
