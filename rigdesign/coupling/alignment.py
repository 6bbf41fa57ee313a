"""Alignment of the hot rig by the names of the case: bearings, bores, gear axes, couplings. SI units."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from dynamics.gear.flank import AxisMisalignment
from dynamics.standards.iso1328_1_2013 import tolerances
from rigdesign.base.part_name import MeshName
from rigdesign.case.bearings import BearingInput
from rigdesign.case.drivetrain import CouplingInput
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.rotation import last_end, pinion_sense
from rigdesign.coupling.expansion import axes_of, bearing_expansion
from rigdesign.coupling.state import CouplingState
from rigdesign.rig.model import Rig
from thermal.expansion.alignment import Across, ShaftAxis, ShaftPair, axis_tolerances, shaft_pair
from thermal.expansion.expansion import Expansion

AlignmentQuantity = Literal["bearing_tilt", "bore_out_of_round", "axis_inclination", "axis_skew"]
ALIGNMENT: tuple[AlignmentQuantity, ...] = get_args(AlignmentQuantity)
Alignment = Mapping[AlignmentQuantity, Mapping[str, float]]
"""Quantity -> place -> size: tilt of a shaft in its bore [rad], out of round of a bore as a share of the radial
clearance, deviation of the axes of a mesh over the face width [m]."""
UNDEFORMED: tuple[Across, Across] = ((0.0, 0.0), (0.0, 0.0))
"""Shift and slope of an axis at the reference temperature."""


def alignment(rig: Rig, name: str, shape: Expansion, clearances: Mapping[str, float]) -> Alignment:
    """Sizes of all misalignments in the housing of gearbox ``name``.

    clearances : hot diametral clearance by ``gearbox.bearing`` [m]
    """
    box = rig.case.gearboxes[name]
    tilts, rounds = {}, {}
    for part, entry in box.bearings.items():
        full = f"{name}.{part}"
        expansion = bearing_expansion(rig, name, shape, entry)
        tilts[full] = expansion.tilt
        clearance = held_clearance(entry, clearances[full])
        rounds[full] = clearance_share(expansion.bore_roundness.peak_to_valley, clearance)
    deviations = {mesh: axis_deviation(rig, name, mesh, shape) for mesh in box.meshes}
    return {
        "bearing_tilt": tilts,
        "bore_out_of_round": rounds,
        "axis_inclination": {f"{name}.{mesh}": abs(found.inclination) for mesh, found in deviations.items()},
        "axis_skew": {f"{name}.{mesh}": abs(found.skew) for mesh, found in deviations.items()},
    }


def held_clearance(entry: BearingInput, hot: float) -> float:
    """Clearance against which a bore counts as out of round [m]: the hot one of a film, that of an unmounted rolling
    bearing, whose fits use it up; boundless for one that is set without clearance."""
    return hot if entry.has_film else entry.drawn_clearance or math.inf


def clearance_share(peak_to_valley: float, clearance: float) -> float:
    """Out of round of a bore as a share of its hot radial clearance, at most 10: there no clearance is left."""
    return min(2.0 * peak_to_valley / clearance, 10.0) if clearance > 0.0 else 10.0


@dataclass(frozen=True, kw_only=True)
class AxisAngles:
    """Angles between the axes of wheel and pinion [rad], over x from front to rear.

    inclination : in their common plane, positive when they open towards the rear
    skew : across it, positive along x cross the direction from pinion to wheel: the wheel's axis turns about that of
        the pinion in the right-hand sense about x
    """

    inclination: float
    skew: float


def axis_angles(rig: Rig, name: str, mesh: str, shape: Expansion | None) -> AxisAngles:
    """Angles between the axes of a mesh: as made, and as the expansion of its housing adds, where there is one."""
    box = rig.case.gearboxes[name]
    entry = box.meshes[mesh]
    width = min(box.gears[gear].face_width for gear in (entry.pinion, entry.wheel))
    made = AxisAngles(inclination=entry.axis_inclination / width, skew=entry.axis_skew / width)
    if shape is None:
        return made
    warm = axes_of(rig, name, shape, (box.gears[entry.pinion].shaft, box.gears[entry.wheel].shaft))
    return AxisAngles(inclination=made.inclination + warm.inclination, skew=made.skew + warm.skew)


@dataclass(frozen=True, kw_only=True)
class AxisDeviation:
    """Hot axes of a mesh over its face width, as made and expanded, with what is recommended for its gears [m]."""

    face_width: float
    inclination: float
    """In the plane of the axes; positive when they open towards the rear."""
    skew: float
    """Across that plane."""
    recommended_inclination: float
    """From the coarser quality grade of the two gears."""
    recommended_skew: float


def axis_deviation(rig: Rig, name: str, mesh: str, shape: Expansion) -> AxisDeviation:
    """Deviation of the axes of a mesh over the narrower of its faces, one half of a double-helical one.

    Source: ISO/TR 10064-3:1996 for the recommended values, with F_beta of ISO 1328-1:2013.
    """
    box = rig.case.gearboxes[name]
    entry = box.meshes[mesh]
    gears = box.gears[entry.pinion], box.gears[entry.wheel]
    axes = axis_angles(rig, name, mesh, shape)
    width = min(gear.face_width for gear in gears)
    recommended = axis_tolerances(_helix_tolerance(rig, name, mesh))
    return AxisDeviation(
        face_width=width,
        inclination=axes.inclination * width,
        skew=axes.skew * width,
        recommended_inclination=recommended[0],
        recommended_skew=recommended[1],
    )


def _helix_tolerance(rig: Rig, name: str, mesh: str) -> float:
    """Total helix tolerance F_beta [m] of the coarser gear of a mesh."""
    box, pair = rig.case.gearboxes[name], rig.pairs[MeshName(name, mesh)]
    entry = box.meshes[mesh]
    found = []
    for key, member in zip((entry.pinion, entry.wheel), pair.gears, strict=True):
        gear = box.gears[key]
        allowed = tolerances(
            member.teeth, 2e3 * member.reference_radius, 1e3 * entry.normal_module, 1e3 * gear.face_width,
            gear.quality_grade,
        )  # fmt: skip
        found.append(1e-6 * float(np.hypot(allowed.f_HbetaT, allowed.f_fbetaT)))
    return max(found)


@dataclass(frozen=True, kw_only=True)
class CouplingEnd:
    """End of a shaft at a coupling."""

    shaft: str
    gearbox: str | None
    """Whose housing carries it; None where nothing is known of it: it does not move."""
    x: float = 0.0
    """Of its end face in the model of that housing [m]."""
    outward: float = 1.0
    """Direction along x of that model in which the shaft leaves its machine there."""
    direction: float = 1.0
    """1 where that gearbox stands in the rig front ahead, -1 the other way round, turned about z."""


@dataclass(frozen=True, kw_only=True)
class CouplingPlace:
    """A coupling between two shaft ends, at least one of them in a housing."""

    name: str
    first: CouplingEnd
    second: CouplingEnd
    offset: Across
    """In y and z, at which the first is set against the second at the reference temperature [m]."""

    @property
    def gearbox(self) -> str:
        """The gearbox that tells of it: the housing of the first shaft, else that of the second."""
        found = self.first.gearbox or self.second.gearbox
        assert found is not None
        return found


def coupling_places(rig: Rig) -> Iterator[CouplingPlace]:
    """Every coupling that a housing moves."""
    for name, coupling in rig.case.power_circuit.couplings.items():
        first, second = (_end(rig, coupling, side) for side in (0, 1))
        if first.gearbox or second.gearbox:
            offset = coupling.cold_offset_lateral, coupling.cold_offset_vertical
            yield CouplingPlace(name=name, first=first, second=second, offset=offset)


def _end(rig: Rig, coupling: CouplingInput, side: int) -> CouplingEnd:
    shaft, end = coupling.shafts[side], coupling.ends[side]
    for name, model in rig.models.items():
        for station in model.shafts:
            if station.name == shaft:
                x, outward = (station.start, -1.0) if end == "start" else (station.end, 1.0)
                return CouplingEnd(
                    shaft=shaft, gearbox=name, x=x, outward=outward, direction=rig.axes[shaft].direction
                )
    return CouplingEnd(shaft=shaft, gearbox=None)


def end_motion(end: CouplingEnd, axes: Mapping[str, Mapping[str, ShaftAxis]]) -> tuple[Across, Across]:
    """Shift [m] and slope [rad] of a shaft end in the frame of the rig; axes : gearbox -> shaft -> hot axis, each in
    the frame of its housing.

    A gearbox that stands the other way round is turned about z: x and y change their sign.
    """
    if end.gearbox is None or end.gearbox not in axes:
        return UNDEFORMED
    axis, turned = axes[end.gearbox][end.shaft], end.direction
    lateral, vertical = axis.shift(end.x)
    return (turned * lateral, vertical), (axis.slope[0], turned * axis.slope[1])


def coupled_ends(place: CouplingPlace, axes: Mapping[str, Mapping[str, ShaftAxis]]) -> ShaftPair:
    """Alignment at a coupling, its offset included; axes : gearbox -> shaft -> hot axis."""
    return shaft_pair(end_motion(place.first, axes), end_motion(place.second, axes), place.offset)


def axial_closing(place: CouplingPlace, shapes: Mapping[str, Expansion]) -> float:
    """How much the two shaft ends come nearer along x [m]; shapes : by gearbox."""
    total = 0.0
    for end in (place.first, place.second):
        if end.gearbox is not None and end.gearbox in shapes:
            total += _outward_travel(end, shapes[end.gearbox])
    return total


def _outward_travel(end: CouplingEnd, shape: Expansion) -> float:
    """Travel of an end face out of its machine [m]: thermal expansion from the locating bearing and travel of that
    bearing."""
    shaft = shape.shafts[end.shaft]
    return (shaft.end if end.outward > 0.0 else shaft.start) + end.outward * shaft.datum


# Misalignment of a mesh over its face from the angles between the axes of its gears in the housing.
#
# Signs. Pinion and wheel turn in planes across x, which runs through the housing from front to rear. With e the
# direction from pinion to wheel and the pinion turning in the sense sigma about x (+1: clockwise seen from the front),
# its teeth pass the mesh towards t = sigma x cross e. Its front flanks look that way and drive the wheel there. Axes
# part over x by their inclination along e and by their skew along x cross e, the wheel against the pinion, so that
#
#     gap of the front flanks = x (inclination sin(alpha_wt) + sigma skew cos(alpha_wt))
#     gap of the back flanks  = x (inclination sin(alpha_wt) - sigma skew cos(alpha_wt))
#
# The face position z is positive at the end that comes into mesh last. A right-hand tooth lies further on in the sense
# of rotation about +x at larger x: a right-hand pinion that turns about +x (sigma = 1) comes into mesh first at the
# rear, and z = -x; in general z = -sigma h x with h = 1 for a right-hand pinion and -1 for a left-hand one. Spur gears
# have z = x. Derived here.


def misalignment(box: Gearbox, mesh: str, axes: AxisAngles) -> AxisMisalignment:
    """Axes of a mesh of a housing, counted over x from front to rear, over z of its face."""
    last = last_end(box, mesh)
    return AxisMisalignment(
        inclination=last * axes.inclination,
        skew=last * pinion_sense(box, mesh) * axes.skew,
    )


def axes_in_mesh(
    rig: Rig, name: MeshName, coupling_state: CouplingState, shape: Expansion | None = None
) -> AxisMisalignment:
    """Misalignment of a mesh: as made, by the tilt of its shafts, and of a housing of this shape."""
    box, mesh = rig.mesh(name)
    made = axis_angles(rig, name.gearbox, mesh, shape)
    tilt = coupling_state.axis_tilt
    return misalignment(
        box,
        mesh,
        AxisAngles(
            inclination=made.inclination + tilt.get(f"{name}.inclination", 0.0),
            skew=made.skew + tilt.get(f"{name}.skew", 0.0),
        ),
    )
