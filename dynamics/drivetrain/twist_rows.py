"""Where torque passes through a drivetrain, shaft elements and joints, and the twist that tells how much.

The torque of a spring and damper is k (w - offset) + c w' with the twist w = row . q; inside a section it changes from
element to element by the inertia between them.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.graph import Drivetrain, assemble, joints, shaft_chains
from dynamics.drivetrain.shaft import Section, Shaft

Array = NDArray[np.float64]
SectionKind = Literal["shaft", "spline", "coupling", "motor"]


@dataclass(frozen=True, kw_only=True)
class TorqueSection:
    """Section of a shaft between two steps of its diameter, or a joint.

    part : shaft, or name of the joint; start, end : on the shaft [m], 0 of a joint; section : None of a joint
    """

    kind: SectionKind
    part: str
    start: float = 0.0
    end: float = 0.0
    section: Section | None = None

    @property
    def name(self) -> str:
        """As it is called in tables: part and place [mm], or kind and part."""
        if self.kind != "shaft":
            return f"{self.kind} {self.part}"
        return f"{self.part} {1e3 * self.start:.0f} to {1e3 * self.end:.0f} mm"

    @property
    def shear_per_torque(self) -> float:
        """Nominal shear stress at the surface per torque [Pa/(N m)]; 0 of a joint."""
        if self.section is None:
            return 0.0
        return 0.5 * self.section.outer_diameter / self.section.polar_moment


@dataclass(frozen=True, kw_only=True)
class TwistRows:
    """Springs through which torque passes; several of one section stand one after the other.

    sections : (r,) of each
    rows : (r, n) twist per freedom; stiffness [N m/rad], damping [N m s/rad] : (r,)
    bracing : (r,) offset of the twist per bracing twist [-]
    """

    sections: tuple[TorqueSection, ...]
    rows: Array
    stiffness: Array
    damping: Array
    bracing: Array


@dataclass(frozen=True)
class TwistSpring:
    """One spring: row (n,) with its stiffness and damping."""

    section: TorqueSection
    row: Array
    stiffness: float
    damping: float


def twist_rows(springs: Sequence[TwistSpring], braced: str | None) -> TwistRows:
    """Rows of springs; braced : name of the coupling that makes the bracing twist."""
    return TwistRows(
        sections=tuple(spring.section for spring in springs),
        rows=np.array([spring.row for spring in springs]),
        stiffness=np.array([spring.stiffness for spring in springs]),
        damping=np.array([spring.damping for spring in springs]),
        bracing=np.array([float(s.section.kind == "coupling" and s.section.part == braced) for s in springs]),
    )


def torsional_twist_rows(drivetrain: Drivetrain) -> TwistRows:
    """Rows on the freedoms of `assemble`: elements of the shafts from left to right, then splines and couplings."""
    size = len(assemble(drivetrain).inertia)
    chains = shaft_chains(drivetrain)
    places = {
        shaft.name: iter(section_of_elements(shaft, chains[shaft.name].positions))
        for shaft in drivetrain.shafts
    }
    springs = []
    for joint in joints(drivetrain):
        if joint.kind == "mesh":
            continue
        row = np.zeros(size)
        row[joint.dof_a], row[joint.dof_b] = 1.0, -1.0
        section = (
            next(places[joint.name])
            if joint.kind == "shaft"
            else TorqueSection(kind=joint.kind, part=joint.name)
        )
        springs.append(TwistSpring(section, row, joint.stiffness, joint.damping))
    return twist_rows(springs, drivetrain.bracing_coupling)


def section_of_elements(shaft: Shaft, positions: Array) -> Iterator[TorqueSection]:
    """Section of each element between neighbouring positions (n,) [m] of a chain."""
    ends = np.cumsum([0.0, *(section.length for section in shaft.sections)])
    found = [
        TorqueSection(kind="shaft", part=shaft.name, start=float(a), end=float(b), section=section)
        for a, b, section in zip(ends[:-1], ends[1:], shaft.sections)
    ]
    middle = 0.5 * (positions[:-1] + positions[1:])
    index = np.clip(np.searchsorted(ends, middle) - 1, 0, len(found) - 1)
    return (found[i] for i in index)
