"""Torsion of the shafts under the torques a case asks for: where the elastic model of them ends.

Round a loop every mesh carries the same tooth force, so a shaft line carries force times base radius between its
gears, and what the motor gives between the motor and the first gear. Static torques; vibration comes on top.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from dynamics.drivetrain.graph import Drivetrain
from dynamics.drivetrain.shaft import Shaft
from rigdesign.base.errors import CaseError, Fault
from rigdesign.base.units import show

LARGEST_STRAIN = 0.015
"""Shear strain at the surface beyond which no steel stays elastic (1200 MPa)."""
DOUBTFUL_STRAIN = 0.005
"""Shear strain at which heat-treated shaft steel begins to yield (400 MPa)."""


@dataclass(frozen=True, kw_only=True)
class SectionTorsion:
    """Static torsion of one section of a shaft: torque [N m] and shear strain at its surface [-]."""

    path: str
    """Case path of its outer diameter."""
    outer_diameter: float
    torque: float
    strain: float

    @property
    def finding(self) -> str:
        """What there is to say of a doubtful section; empty for a sound one."""
        if self.strain <= DOUBTFUL_STRAIN:
            return ""
        return (
            f"{self.path} = {show(self.outer_diameter, 'length')}: shear strain {100.0 * self.strain:.2g} % under "
            f"{self.torque:.3g} N m, limit {100.0 * DOUBTFUL_STRAIN:g} %, where shaft steel begins to yield; "
            "enlarge the section or lower the torque"
        )


def section_torsions(
    drivetrain: Drivetrain, tooth_force: float, motor_torque: float
) -> tuple[SectionTorsion, ...]:
    """Torsion of every section that carries torque.

    tooth_force : force along the transverse line of action in every mesh [N]
    motor_torque : largest torque of the motor [N m]
    """
    found: list[SectionTorsion] = []
    for shaft in drivetrain.shafts:
        spans = [
            (_loop_span(drivetrain, shaft), tooth_force * _largest_radius(drivetrain, shaft.name)),
            (_motor_span(drivetrain, shaft), motor_torque),
        ]
        start = 0.0
        for index, section in enumerate(shaft.sections):
            end = start + section.length
            torque = max((t for (low, high), t in spans if start < high and low < end), default=0.0)
            radius = 0.5 * section.outer_diameter
            if torque > 0.0:
                found.append(
                    SectionTorsion(
                        path=f"drivetrain.shafts.{shaft.name}.sections.{index}.outer_diameter",
                        outer_diameter=section.outer_diameter,
                        torque=torque,
                        strain=torque * radius / (shaft.shear_modulus * section.polar_moment),
                    )
                )
            start = end
    return tuple(found)


def refuse_broken_shafts(torsions: tuple[SectionTorsion, ...], source: str) -> None:
    """Raise CaseError for every section that no steel would carry."""
    faults = [
        Fault(
            torsion.path,
            show(torsion.outer_diameter, "length"),
            f"its shear strain is {100.0 * torsion.strain:.2g} % under {torsion.torque:.3g} N m, limit "
            f"{100.0 * LARGEST_STRAIN:g} %: no steel stays elastic there",
            "enlarge the section, or lower test torque or motor torque",
        )
        for torsion in torsions
        if torsion.strain > LARGEST_STRAIN
    ]
    if faults:
        raise CaseError(faults, source)


def _loop_span(drivetrain: Drivetrain, shaft: Shaft) -> tuple[float, float]:
    """Part of a shaft between the gears of its line [m]: torque goes on through couplings with gears beyond."""
    points = [gear.position for gear in drivetrain.gears if gear.shaft == shaft.name]
    points += _coupled_ends(drivetrain, shaft, with_gears=True)
    return (min(points), max(points)) if points else (0.0, 0.0)


def _motor_span(drivetrain: Drivetrain, shaft: Shaft) -> tuple[float, float]:
    """Part of the motor's shaft between the motor and what it drives [m]."""
    motor = drivetrain.motor
    points = [gear.position for gear in drivetrain.gears if gear.shaft == shaft.name]
    points += _coupled_ends(drivetrain, shaft, with_gears=False)
    if motor.shaft != shaft.name or not points:
        return 0.0, 0.0
    driven = min(points, key=lambda point: abs(point - motor.position))
    return min(driven, motor.position), max(driven, motor.position)


def _coupled_ends(drivetrain: Drivetrain, shaft: Shaft, *, with_gears: bool) -> Iterator[float]:
    """Ends of a shaft that a coupling joins to others; only those with a gear beyond, if asked."""
    for coupling in drivetrain.couplings:
        for here, end, there in zip(coupling.shafts, coupling.ends, coupling.shafts[::-1]):
            if here == shaft.name and not (with_gears and not _gear_beyond(drivetrain, there, {here})):
                yield 0.0 if end == "left" else shaft.length


def _gear_beyond(drivetrain: Drivetrain, shaft: str, seen: set[str]) -> bool:
    """Whether a gear sits on a shaft or on those joined to it, the seen ones left out."""
    if any(gear.shaft == shaft for gear in drivetrain.gears):
        return True
    others = {name for c in drivetrain.couplings if shaft in c.shafts for name in c.shafts} - seen - {shaft}
    return any(_gear_beyond(drivetrain, other, seen | {shaft}) for other in sorted(others))


def _largest_radius(drivetrain: Drivetrain, shaft: str) -> float:
    """Largest base radius of the gears on the line of a shaft [m]."""
    lines = drivetrain.lines()
    radii = (
        radius
        for mesh in drivetrain.meshes
        for gear, radius in zip((mesh.pinion, mesh.wheel), mesh.base_radii)
        if lines[drivetrain.gear(gear).shaft] == lines[shaft]
    )
    return max(radii, default=0.0)
