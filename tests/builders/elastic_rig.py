"""The prototype in six degrees of freedom: dimensions of its case, bearings of P2, Table 1."""

import math
from dataclasses import replace

import numpy as np

from dynamics.rotor.assembly import ElasticModel
from dynamics.rotor.bearing_state import BearingCoefficients, RunningState, isotropic_bearing
from dynamics.rotor.graph import Drivetrain
from dynamics.rotor.parts import BearingPlace, GearBody, JointStiffness, Motor
from dynamics.rotor.rotor_model import AxialLocation, ElasticRig, ShaftPlacement
from dynamics.rotor.shaft import STEEL_DENSITY, Disc, Section, Shaft
from tests.builders.rig import CENTRE_DISTANCE, SHAFTS, prototype

BEARINGS = {
    "test_pinion": (67.58, 307.78),
    "test_wheel": (14.88, 255.08),
    "reference_pinion": (32.03, 277.93),
    "reference_wheel": (48.13, 294.03),
}
"""Middles of the journal bearings [mm], cases/uhcf_prototype."""
GEARS = {
    "test_pinion": (99.0, 41.92, 7.0),
    "test_wheel": (101.0, 57.54, 15.0),
    "reference_pinion": (98.0, 51.64, 40.0),
    "reference_wheel": (101.0, 43.70, 40.0),
}
"""Outer diameter, seat and width of the gear bodies [mm], fit_shafts.py."""
PINION_COUPLING, WHEEL_COUPLING = 0.040, 0.070
"""Distances between the shaft ends [m], fit_shafts.py."""
BEARING_STIFFNESS, BEARING_DAMPING = 1e8, 4e4
"""P2, Table 1 [N/m], [N s/m]."""
DISC_COUPLING = JointStiffness(axial=2e5, lateral=5e6, angular=5e3)
"""Disc coupling with spacer of this torque, of the size of catalogue values."""


def ring_mass(name: str) -> float:
    outer, inner, width = (1e-3 * value for value in GEARS[name])
    return 0.25 * math.pi * STEEL_DENSITY * width * (outer**2 - inner**2)


def prototype_drivetrain(element_length: float = 0.010) -> Drivetrain:
    """The torsional prototype with masses, bearing places of the case, and couplings that yield in all directions."""
    torsional = prototype(element_length)
    return replace(
        torsional,
        shafts=tuple(
            replace(s, discs=tuple(replace(d, mass=0.35, width=0.015) for d in s.discs))
            for s in torsional.shafts
        ),
        gears=tuple(
            replace(g, mass=ring_mass(g.shaft), width=GEARS[g.shaft][2] * 1e-3) for g in torsional.gears
        ),
        couplings=tuple(replace(c, flexibility=DISC_COUPLING) for c in torsional.couplings),
        bearings=tuple(
            BearingPlace(name=f"{name} {end}", shaft=name, position=place * 1e-3)
            for name, places in BEARINGS.items()
            for end, place in zip(("front", "rear"), places)
        ),
    )


def placements() -> tuple[ShaftPlacement, ...]:
    """Pinion line at y = -a/2 turning about +x, wheel line at +a/2; gears of a gearbox in one plane."""
    length = {name: 1e-3 * math.fsum(a for a, _ in parts[0]) for name, parts in SHAFTS.items()}
    gear = {name: 1e-3 * parts[2][0] for name, parts in SHAFTS.items()}
    wheel = gear["test_pinion"] - gear["test_wheel"]
    starts = {
        "test_pinion": 0.0,
        "test_wheel": wheel,
        "reference_pinion": length["test_pinion"] + PINION_COUPLING,
        "reference_wheel": wheel + length["test_wheel"] + WHEEL_COUPLING,
    }
    return tuple(
        ShaftPlacement(
            shaft=name,
            y=(-0.5 if "pinion" in name else 0.5) * CENTRE_DISTANCE,
            z=0.0,
            sense=1 if "pinion" in name else -1,
            start=start,
        )
        for name, start in starts.items()
    )


def prototype_rig(element_length: float = 0.010) -> ElasticRig:
    """Four shafts, two meshes; each line held along x at one bearing."""
    return ElasticRig(
        drivetrain=prototype_drivetrain(element_length),
        placements=placements(),
        axial_locations=tuple(
            AxialLocation(bearing=f"{name} rear", stiffness=1e8)
            for name in ("reference_pinion", "reference_wheel")
        ),
    )


def bearings(
    rig: ElasticRig, stiffness: float = BEARING_STIFFNESS, damping: float = BEARING_DAMPING
) -> dict[str, BearingCoefficients]:
    """The same isotropic bearing everywhere."""
    return {place.name: isotropic_bearing(stiffness, damping) for place in rig.drivetrain.bearings}


def running(rig: ElasticRig, speed: float = 0.0) -> RunningState:
    return RunningState(speed=speed, bearings=bearings(rig))


def single_shaft(
    sections: tuple[Section, ...],
    bearing_positions: tuple[float, ...],
    element_length: float,
    discs: tuple[Disc, ...] = (),
    **shaft: float,
) -> ElasticRig:
    """One shaft on its x axis that turns about +x, bearings ``b0``, ``b1``, ..., located along x at the first."""
    rotor = Shaft(name="rotor", sections=sections, discs=discs, element_length=element_length, **shaft)
    return ElasticRig(
        drivetrain=Drivetrain(
            shafts=(rotor,),
            gears=(),
            meshes=(),
            motor=Motor(shaft="rotor", position=0.0),
            bearings=tuple(
                BearingPlace(name=f"b{i}", shaft="rotor", position=position)
                for i, position in enumerate(bearing_positions)
            ),
        ),
        placements=(ShaftPlacement(shaft="rotor", y=0.0, z=0.0, sense=1),),
        axial_locations=(AxialLocation(bearing="b0", stiffness=1e9),),
    )


def motion_of_all(model: ElasticModel, shift: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """Displacement of all freedoms when the whole rig moves as one rigid body, turn counted in each shaft's sense."""
    motion = np.zeros(model.size)
    for shaft, nodes in model.freedoms.nodes.items():
        placement = model.rig.placement(shaft)
        for i, x in enumerate(nodes.x):
            here = shift + np.cross(rotation, [x, placement.y, placement.z])
            first = nodes.first + 6 * i
            motion[first : first + 6] = [*here, placement.sense * rotation[0], rotation[1], rotation[2]]
    for gear in model.rig.drivetrain.gears:
        place = model.freedoms.place(gear.name)
        motion[place.turn] = model.rig.placement(gear.shaft).sense * rotation[0]
    return motion


def gear_on(name: str, shaft: str, position: float, inertia: float, mass: float) -> GearBody:
    """Gear as good as shrunk on."""
    return GearBody(name=name, shaft=shaft, position=position, inertia=inertia, stiffness=1e9, mass=mass)
