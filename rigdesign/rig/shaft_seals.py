"""Seals that a shaft has: a gap in each wall of a chamber, and one seal wherever it leaves the gearbox."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rigdesign.case.drivetrain import DrivetrainInput, ShaftInput
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.model import Case
from thermal.housing.shaft_geometry import SIDES

if TYPE_CHECKING:
    from rigdesign.rig.model import Rig


@dataclass(frozen=True, kw_only=True)
class ShaftSeal:
    """One seal of a shaft.

    diameter : of the shaft in it [m]
    length : of its bore [m]; None where no wall is stated
    leaves : whether the shaft leaves the gearbox there; the other seals are gaps in the walls of the chamber
    """

    diameter: float
    length: float | None
    leaves: bool


def shaft_seals(rig: Rig, box_name: str, shaft_name: str) -> list[ShaftSeal]:
    """Seals of a shaft in one gearbox, those in the walls of the chamber first.

    With a housing its geometry decides: a shaft that is not in it has none, and one chamber has none inside. Without a
    housing the chamber has no walls, and a shaft leaves the gearbox on the side where a coupling, the motor or a part
    of another gearbox sits beyond its bearings; the seal then has the diameter of the shaft at the outer edge of that
    bearing.
    """
    geometry = rig.geometries.get(box_name)
    if geometry is None:
        return list(_exits(rig.case, box_name, shaft_name))
    shaft = next((shaft for shaft in geometry.shafts if shaft.name == shaft_name), None)
    if shaft is None:
        return []
    partitions = 0 if geometry.one_chamber else 2
    walls = [ShaftSeal(diameter=shaft.seal_diameter, length=geometry.partition_thickness, leaves=False)]
    walls *= partitions
    exits = [
        ShaftSeal(
            diameter=shaft.overhang_diameter,
            length=geometry.bearing_depths(shaft.bearing(side))[0],
            leaves=True,
        )
        for side in SIDES
        if shaft.overhang(side) > 0.0
    ]
    return [*walls, *exits]


def _exits(case: Case, box_name: str, shaft_name: str) -> Iterator[ShaftSeal]:
    """Where a shaft of the drivetrain leaves a gearbox without a housing; none without a drivetrain or bearings."""
    if case.drivetrain is None:
        return
    edges = _bearing_edges(case.gearboxes[box_name], shaft_name)
    if not edges:
        return
    shaft = case.power_circuit.shafts[shaft_name]
    ends = _joined_ends(case.drivetrain, shaft_name)
    beyond = [
        place
        for name, box in case.gearboxes.items()
        if name != box_name
        for place in _places(box, shaft_name)
    ]
    low, high = min(edges), max(edges)
    if "start" in ends or any(place < low for place in beyond):
        yield ShaftSeal(diameter=_diameter(shaft, low), length=None, leaves=True)
    if "end" in ends or any(place > high for place in beyond):
        yield ShaftSeal(diameter=_diameter(shaft, high), length=None, leaves=True)


def _bearing_edges(box: Gearbox, shaft_name: str) -> list[float]:
    """Edges of the bearings of a shaft, from its start [m]."""
    return [
        bearing.position + side * bearing.width
        for bearing in box.bearings.values()
        if bearing.shaft == shaft_name and bearing.position is not None
        for side in (-0.5, 0.5)
    ]


def _places(box: Gearbox, shaft_name: str) -> list[float]:
    """Places of the gears and bearings of a gearbox on a shaft, from its start [m]."""
    gears = [gear.position for gear in box.gears.values() if gear.shaft == shaft_name]
    bearings = [bearing.position for bearing in box.bearings.values() if bearing.shaft == shaft_name]
    return [place for place in (*gears, *bearings) if place is not None]


def _joined_ends(train: DrivetrainInput, shaft_name: str) -> set[str]:
    """Ends of a shaft that a coupling or the motor holds."""
    ends: set[str] = {
        end
        for coupling in train.couplings.values()
        for name, end in zip(coupling.shafts, coupling.ends, strict=True)
        if name == shaft_name
    }
    return ends | ({train.motor.end} if train.motor.shaft == shaft_name else set())


def _diameter(shaft: ShaftInput, place: float) -> float:
    """Diameter of a stepped shaft at a place from its start [m]; beyond its ends that of its end."""
    passed = 0.0
    for section in shaft.sections:
        passed += section.length
        if place < passed:
            return section.outer_diameter
    return shaft.sections[-1].outer_diameter
