"""Prototype-like rig for the tests of the drivetrain: four shafts, two meshes, synthetic mesh laws."""

import math

import numpy as np

from dynamics.rotor.graph import Drivetrain
from dynamics.rotor.parts import BearingPlace, Coupling, GearBody, MeshConnection, Motor
from dynamics.rotor.shaft import Disc, Section, Shaft
from dynamics.tooth.law import MeshLaw

TABLE_2 = {
    "test_pinion": (4022.7, 5657.2, 7776.4),
    "test_wheel": (5926.7, 9482.0, 12831.0),
    "reference_pinion": (4887.5, 7763.9, 9646.9),
    "reference_wheel": (3563.9, 5092.0, 6895.0),
}
"""P2, Table 2 [Hz]."""

# (length, diameter) in mm, flange (position in mm, inertia), gear (position in mm, inertia); fit_shafts.py
SHAFTS = {
    "test_pinion": (
        ((82.46, 40.00), (65.92, 40.16), (63.08, 41.92), (81.44, 60.56), (75.80, 40.00)),
        (368.70, 0.000191),
        (179.92, 5.015539e-04),
    ),
    "test_wheel": (
        ((53.06, 40.00), (53.02, 53.16), (42.28, 57.54), (58.84, 56.88), (62.80, 40.00)),
        (270.00, 0.000133),
        (127.22, 1.076228e-03),
    ),
    "reference_pinion": (
        ((61.16, 40.00), (63.78, 56.14), (70.06, 51.64), (47.60, 48.48), (56.80, 40.00)),
        (0.0, 0.000169),
        (159.97, 2.624156e-03),
    ),
    "reference_wheel": (
        ((65.52, 40.00), (70.42, 59.66), (80.26, 43.70), (61.92, 42.58), (79.12, 40.00)),
        (0.0, 0.000267),
        (176.07, 3.095434e-03),
    ),
}
TEETH = (99, 102)
CENTRE_DISTANCE = 0.0995
BASE_RADIUS_TEST = 0.5 * 99e-3 * math.cos(math.radians(20.0))
TRANSVERSE_ANGLE = math.atan(math.tan(math.radians(20.0)) / math.cos(math.radians(18.0)))
BASE_RADIUS_REFERENCE = 0.5 * 99 * 0.95e-3 / math.cos(math.radians(18.0)) * math.cos(TRANSVERSE_ANGLE)


def shaft(name: str, element_length: float = 0.010) -> Shaft:
    sections, flange, _ = SHAFTS[name]
    return Shaft(
        name=name,
        sections=tuple(Section(length=a * 1e-3, outer_diameter=b * 1e-3) for a, b in sections),
        discs=(Disc(name="coupling flange", position=flange[0] * 1e-3, inertia=flange[1]),),
        element_length=element_length,
    )


def gear(name: str, damping: float = 1e3) -> GearBody:
    position, inertia = SHAFTS[name][2]
    return GearBody(
        name=f"{name}_gear",
        shaft=name,
        position=position * 1e-3,
        inertia=inertia,
        stiffness=1e6,
        damping=damping,
    )


def mesh(name: str, base_radius: float, teeth: tuple[int, int] = TEETH) -> MeshConnection:
    return MeshConnection(
        name=name,
        pinion=f"{name}_pinion_gear",
        wheel=f"{name}_wheel_gear",
        base_radii=(base_radius, base_radius * teeth[1] / teeth[0]),
        teeth=teeth,
        centre_distance=CENTRE_DISTANCE,
    )


def prototype(element_length: float = 0.010, linear_drag: float = 0.0) -> Drivetrain:
    """Stiffness and damping of P2, Table 1; bearings with linear drag [N m s/rad] if wanted."""
    shafts = tuple(shaft(name, element_length) for name in SHAFTS)
    return Drivetrain(
        shafts=shafts,
        gears=tuple(gear(name) for name in SHAFTS),
        couplings=(
            Coupling(
                name="pinion side", shafts=("test_pinion", "reference_pinion"), stiffness=138e3, damping=300.0
            ),
            Coupling(
                name="wheel side", shafts=("test_wheel", "reference_wheel"), stiffness=290e3, damping=600.0
            ),
        ),
        bearings=tuple(
            BearingPlace(
                name=f"{s.name} {end}", shaft=s.name, position=place * s.length, linear_drag=linear_drag
            )
            for s in shafts
            for end, place in (("left", 0.1), ("right", 0.9))
        ),
        meshes=(mesh("test", BASE_RADIUS_TEST), mesh("reference", BASE_RADIUS_REFERENCE)),
        motor=Motor(shaft="reference_wheel", position=shafts[3].length, inertia=0.01),
        bracing_coupling="pinion side",
    )


def synthetic_law(
    base_radius: float,
    *,
    stiffness: float,
    contact_ratio: float,
    slices: int = 5,
    relief: float = 7e-6,
    crowning: float = 2e-6,
    lag: float = 0.0,
    damping: float = 1e3,
    friction: float = 0.04,
    backlash: float = 60e-6,
    teeth: tuple[int, int] = TEETH,
    points: int = 121,
) -> MeshLaw:
    """Mesh with rounded pair stiffness, profile and face crowning, and a tip corner that opens outside.

    stiffness : mean of the mesh [N/m]; lag : of the last slice behind the middle one [m]
    """
    pitch = 2.0 * math.pi * base_radius / teeth[0]
    length = contact_ratio * pitch
    start, end = -0.2 * length - 0.25 * pitch, 0.8 * length + 0.25 * pitch
    path = np.linspace(start, end, points)
    place = (path - 0.3 * length) / (0.5 * length)
    shape = 1.0 - 0.35 * np.clip(np.abs(place), 0.0, 1.3) ** 2
    whole = np.trapezoid(np.where(np.abs(place) <= 1.0, shape, 0.0), path) / pitch
    opening = np.clip(np.abs(place) - 1.0, 0.0, None) * 0.5 * length
    profile = relief * np.clip(np.abs(place), 0.0, 1.0) ** 2 + 200.0 * opening**2
    face = (np.arange(slices) + 0.5) / slices * 2.0 - 1.0
    radius_2 = base_radius * teeth[1] / teeth[0]
    slope = math.tan(math.radians(18.35))
    return MeshLaw(
        base_radius_1=base_radius,
        base_radius_2=radius_2,
        base_pitch=pitch,
        teeth_1=teeth[0],
        teeth_2=teeth[1],
        tooth_offset_2=0,
        path_start=float(path[0]),
        path_step=float(path[1] - path[0]),
        stiffness=np.tile(shape * stiffness / whole / slices, (slices, 1)),
        gap=profile[None, :] + crowning * face[:, None] ** 2,
        slice_shift=lag * face,
        deviation_1=np.zeros((1, points)),
        deviation_2=np.zeros((1, points)),
        scale_1=np.ones(1),
        scale_2=np.ones(1),
        backlash=backlash,
        offset=0.0,
        phase=0.0,
        back_phase=0.5 * pitch,
        damping=damping,
        mean_stiffness=stiffness,
        friction=friction,
        rolling_radius_1=base_radius * slope,
        rolling_radius_2=radius_2 * slope,
        friction_reversal_speed=0.05,
    )


def prototype_laws(friction: float = 0.04, damping: float = 1e3) -> tuple[MeshLaw, MeshLaw]:
    """Laws of the size of P2: test mesh 1.14e8 N/m, reference mesh 7.09e8 N/m with overlap."""
    return (
        synthetic_law(
            BASE_RADIUS_TEST, stiffness=1.14e8, contact_ratio=1.26, friction=friction, damping=damping
        ),
        synthetic_law(
            BASE_RADIUS_REFERENCE,
            stiffness=7.09e8,
            contact_ratio=1.448,
            slices=12,
            relief=5e-6,
            crowning=5e-6,
            lag=0.02 * math.tan(math.radians(16.88)),
            friction=friction,
            damping=damping,
        ),
    )
