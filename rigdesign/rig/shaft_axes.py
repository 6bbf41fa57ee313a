"""Where the axes of all shafts stand, which way each shaft is drawn and turns: one frame for the whole rig.

x runs along the shafts, from the front to the rear of the gearbox whose torque is stated, y across and z up. The axes
of one gearbox stand as its housing says, else side by side at their centre distances; shafts that a coupling joins
are on one axis. Along x, gears that mesh stand at one place; coupled ends meet where that leaves them free to, else
the coupling is as long as the way between them.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from dynamics.gear.pair import GearPair
from rigdesign.base.part_name import MeshName
from rigdesign.case.model import Case
from rigdesign.case.rotation import pinion_sense

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class ShaftAxis:
    """Axis of one shaft.

    lateral, vertical : y and z [m]; start : x of the start of the shaft [m]
    direction : 1 where the shaft is drawn towards the rear, -1 towards the front
    sense : 1 where it turns about +x, clockwise seen from the front; -1 the other way
    """

    lateral: float
    vertical: float
    start: float
    direction: float
    sense: float

    def place(self, position: float) -> float:
        """x of a place of the shaft [m]."""
        return self.start + self.direction * position


@dataclass(frozen=True, kw_only=True)
class LineOfAction:
    """Unit vectors across a mesh, in the plane (y, z), both (2,).

    centres : from the axis of the pinion to that of the wheel
    tangent : in which the teeth of the pinion pass the mesh
    """

    centres: Array
    tangent: Array

    def normal(self, working_pressure_angle: float, flank: float) -> Array:
        """Direction in which the pinion presses the wheel by its front flanks (flank 1) or its back flanks (-1)."""
        sine, cosine = math.sin(working_pressure_angle), math.cos(working_pressure_angle)
        return np.asarray(flank * cosine * self.tangent + sine * self.centres)


def shaft_axes(case: Case, pairs: Mapping[MeshName, GearPair]) -> dict[str, ShaftAxis]:
    """Axes of all shafts with gears, and of those that couplings join to them, by name.

    The first pair of ``pairs`` is that of the stated torque. Gearboxes that nothing joins stand each for itself.
    """
    found: dict[str, ShaftAxis] = {}
    for name in pairs:
        box = case.gearboxes[name.gearbox]
        pinion = box.gears[box.meshes[name.part].pinion].shaft
        lateral = 0.0 if box.housing is None else box.housing.shafts[pinion].lateral_position
        sense = pinion_sense(box, name.part)
        found.setdefault(
            pinion, ShaftAxis(lateral=lateral, vertical=0.0, start=0.0, direction=1.0, sense=sense)
        )
        # a coupling settles an axis, a mesh leaves its side open: couplings first
        while (more := next(chain(_coupled(case, found), _meshing(case, pairs, found)), None)) is not None:
            found[more[0]] = more[1]
    return found


def line_of_action(pinion: ShaftAxis, wheel: ShaftAxis) -> LineOfAction:
    """Directions of a mesh between two axes."""
    y, z = wheel.lateral - pinion.lateral, wheel.vertical - pinion.vertical
    centres = np.array([y, z]) / math.hypot(y, z)
    return LineOfAction(centres=centres, tangent=pinion.sense * np.array([-centres[1], centres[0]]))


def _coupled(case: Case, found: Mapping[str, ShaftAxis]) -> Iterator[tuple[str, ShaftAxis]]:
    """Shafts that a coupling joins to one that is known, with their axes."""
    for coupling in case.power_circuit.couplings.values():
        for here, there in ((0, 1), (1, 0)):
            known, other = coupling.shafts[here], coupling.shafts[there]
            if known in found and other not in found:
                axis, ends = found[known], coupling.ends
                direction = axis.direction * (-1.0 if ends[0] == ends[1] else 1.0)
                start = _start_by_mesh(case, other, direction, found)
                if start is None:
                    meeting = axis.place(_end(case, known, ends[here]))
                    start = meeting - direction * _end(case, other, ends[there])
                yield other, replace(axis, start=start, direction=direction)


def _start_by_mesh(case: Case, shaft: str, direction: float, found: Mapping[str, ShaftAxis]) -> float | None:
    """x of the start of a shaft [m] at which its gear meets its partner on a known shaft; None without one."""
    for box in case.gearboxes.values():
        for mesh in box.meshes.values():
            gears = box.gears[mesh.pinion], box.gears[mesh.wheel]
            for own, partner in (gears, gears[::-1]):
                if own.shaft == shaft and partner.shaft in found:
                    x = found[partner.shaft].place(partner.position or 0.0)
                    return x - direction * (own.position or 0.0)
    return None


def _meshing(
    case: Case, pairs: Mapping[MeshName, GearPair], found: Mapping[str, ShaftAxis]
) -> Iterator[tuple[str, ShaftAxis]]:
    """Shafts whose gears mesh with one that is known, with their axes."""
    for name, pair in pairs.items():
        box = case.gearboxes[name.gearbox]
        mesh = box.meshes[name.part]
        gears = box.gears[mesh.pinion], box.gears[mesh.wheel]
        for known, other in (gears, gears[::-1]):
            if known.shaft in found and other.shaft not in found:
                axis = found[known.shaft]
                side = _side(case, pairs, name.gearbox, (known.shaft, other.shaft), found)
                yield (
                    other.shaft,
                    ShaftAxis(
                        lateral=axis.lateral + side * pair.centre_distance,
                        vertical=axis.vertical,
                        start=axis.place(known.position or 0.0) - axis.direction * (other.position or 0.0),
                        direction=axis.direction,
                        sense=-axis.sense,
                    ),
                )


def _end(case: Case, shaft: str, end: str) -> float:
    """Position of an end of a shaft [m]."""
    sections = case.power_circuit.shafts[shaft].sections
    return 0.0 if end == "start" else math.fsum(section.length for section in sections)


def _side(
    case: Case,
    pairs: Mapping[MeshName, GearPair],
    box_name: str,
    shafts: tuple[str, str],
    found: Mapping[str, ShaftAxis],
) -> float:
    """Side of a known axis on which its neighbour stands, 1 towards y: as the housing says, else where it meets all
    its known partners, and where room is."""
    box, (known, other) = case.gearboxes[box_name], shafts
    if box.housing is not None:
        own = box.housing.shafts
        return math.copysign(1.0, own[other].lateral_position - own[known].lateral_position)
    distances = {}
    for name, mesh in box.meshes.items():
        pair = box.gears[mesh.pinion].shaft, box.gears[mesh.wheel].shaft
        if other in pair:
            distances[pair[0] if pair[1] == other else pair[1]] = pairs[
                MeshName(box_name, name)
            ].centre_distance

    def miss(side: float) -> tuple[float, bool]:
        y = found[known].lateral + side * distances[known]
        partners = [abs(abs(y - found[p].lateral) - d) for p, d in distances.items() if p in found]
        return round(sum(partners), 6), any(
            abs(axis.lateral - y) < distances[known] / 2 for axis in found.values()
        )

    return min((1.0, -1.0), key=miss)
