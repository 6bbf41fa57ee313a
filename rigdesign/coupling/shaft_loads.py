"""Mean forces on the shafts of a rig: teeth with the hand of their helix, weight of shafts, discs and gears, couplings
out of line.

In the frame of the rig (`rigdesign.rig.shaft_axes`): x along the shafts, y across, z up.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.case.rotation import has_hands, helix_hands, pinion_hand
from rigdesign.coupling.misalignment import coupling_forces
from rigdesign.coupling.state import CouplingState
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]

GRAVITY = 9.80665
"""Standard acceleration of fall [m/s2]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ShaftLoad:
    """A force on a shaft.

    position : along the shaft [m]; None where the case states none
    force : (2,) in the plane (y, z) [N]
    axial : along x [N]; arm : (2,) from the axis to where the axial force acts [m]
    gear : whose teeth press, None for a weight
    sure : False where the case states no hand: ``axial`` is that of a right-hand pinion, its sign is open
    """

    position: float | None
    force: Array
    axial: float
    arm: Array
    gear: str | None = None
    sure: bool = True


def shaft_loads(rig: Rig, name: str, shaft: str, coupling_state: CouplingState) -> list[ShaftLoad]:
    """Loads on a shaft of the gearbox ``name`` under the mean torques of a coupling state."""
    box = rig.case.gearboxes[name]
    teeth = [
        tooth_load(rig, f"{name}.{mesh}", gear, coupling_state)
        for mesh, entry in box.meshes.items()
        for gear in (entry.pinion, entry.wheel)
        if box.gears[gear].shaft == shaft
    ]
    couplings = [
        ShaftLoad(position=place, force=force, axial=0.0, arm=np.zeros(2))
        for place, force in coupling_forces(rig, shaft, coupling_state)
    ]
    return [*_weights(rig, name, shaft), *teeth, *couplings]


def tooth_load(rig: Rig, mesh: str, gear: str, coupling_state: CouplingState) -> ShaftLoad:
    """Mean force of the teeth of the mesh ``gearbox.mesh`` on one of its gears, by its own name.

    The pinion of hand h that turns in the sense sigma about x presses its wheel with its front flanks along
    -h sigma tan(beta_b) times the transverse force; with its back flanks the other way.
    """
    box, own = rig.mesh(mesh)
    entry, pair, torque = box.meshes[own], rig.pairs[mesh], coupling_state.mesh_torque[mesh]
    side = 0 if gear == entry.pinion else 1
    line = rig.line_of_action(mesh)
    transverse = abs(torque) / pair.base_radii[0]
    normal = line.normal(pair.working_pressure_angle, math.copysign(1.0, torque))
    onto = (-1.0, 1.0)[side]  # what presses the wheel presses the pinion back
    sense = rig.axes[box.gears[entry.pinion].shaft].sense
    axial = -pinion_hand(box, own) * sense * math.tan(pair.base_helix_angle) * torque / pair.base_radii[0]
    return ShaftLoad(
        position=box.gears[gear].position,
        force=onto * transverse * normal,
        axial=onto * axial,
        arm=-onto * pair.working_radii[side] * line.centres,
        gear=gear,
        sure=not has_hands(entry) or entry.pinion in helix_hands(box),
    )


def _weights(rig: Rig, name: str, shaft: str) -> Iterator[ShaftLoad]:
    """Weight of the shaft, of its discs and of its gears; of the bodies that the dynamics have where it has any."""
    drivetrain = rig.drivetrain
    box = rig.case.gearboxes[name]
    for gear, (mesh, side) in box.first_meshes().items():
        if box.gears[gear].shaft == shaft:
            mass = (
                box.halves(gear) * rig.pairs[f"{name}.{mesh}"].masses[side]
                if drivetrain is None
                else drivetrain.gear(f"{name}.{gear}").mass
            )
            yield _weight(box.gears[gear].position, mass)
    if drivetrain is None or shaft not in (one.name for one in drivetrain.shafts):
        return
    part = drivetrain.shaft(shaft)
    start = 0.0
    for section in part.sections:
        area = 0.25 * math.pi * (section.outer_diameter**2 - section.inner_diameter**2)
        yield _weight(start + 0.5 * section.length, part.density * area * section.length)
        start += section.length
    for disc in part.discs:
        yield _weight(disc.position, disc.mass)


def _weight(position: float | None, mass: float) -> ShaftLoad:
    return ShaftLoad(position=position, force=np.array([0.0, -GRAVITY * mass]), axial=0.0, arm=np.zeros(2))
