"""The warm meshes of the rig at an operating point: gears, teeth and laws of the mesh force."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from dynamics.flank.axes import AxisMisalignment
from dynamics.flank.microgeometry import Microgeometry
from dynamics.gear.pair import GearPair
from dynamics.losses.mesh_loss import ToothPath
from dynamics.mesh.flank import ContactDiscretisation, MeshDissipation, MeshPosition, default_slices
from dynamics.mesh.friction import FrictionCoefficient
from dynamics.mesh.law import MeshLaw, in_parallel
from dynamics.mesh.stiffness import PairStiffness
from rigdesign.case.drivetrain import MeshStiffness
from rigdesign.coupling.mesh_axes import axes_in_mesh
from rigdesign.coupling.mesh_damping import mesh_damping
from rigdesign.coupling.mesh_friction import mesh_friction
from rigdesign.coupling.microgeometry import mesh_microgeometry
from rigdesign.coupling.state import LEAST_TORQUE, CouplingState, OperatingPoint
from rigdesign.coupling.tooth_springs import WarmMesh, springs_of
from rigdesign.rig.model import Rig


@dataclass(frozen=True, kw_only=True)
class MeshModel:
    """One mesh, warm, at one operating point.

    stiffness, law : of one half of a double-helical mesh; halves : that share its torque
    """

    name: str
    pair: GearPair
    stiffness: PairStiffness
    friction: FrictionCoefficient
    law: MeshLaw
    halves: int = 1

    @property
    def whole(self) -> MeshLaw:
        """The law of all halves that carry, as the loop has it."""
        return in_parallel(self.law, self.halves)


def mesh_models(
    rig: Rig, point: OperatingPoint, coupling_state: CouplingState, stiffness: MeshStiffness | None = None
) -> tuple[MeshModel, ...]:
    """Warm gears and mesh laws of the whole rig.

    stiffness : tooth model; that of the rig when left out
    """
    return tuple(mesh_model(rig, name, point, coupling_state, stiffness) for name in rig.mesh_names)


def warm_pair(rig: Rig, name: str, speed: float, coupling_state: CouplingState) -> GearPair:
    """Gear pair at the bulk temperatures, centre distance and speed [rad/s] of this iteration."""
    box, mesh = rig.mesh(name)
    pinion, wheel = rig.mesh_gears(name)
    entry = box.meshes[mesh]
    gears = box.gears[entry.pinion], box.gears[entry.wheel]
    first, second = (rig.materials[gear.material].expansion_coefficient for gear in gears)
    return rig.pairs[name].warm(
        coupling_state.gear_temperature[pinion],
        coupling_state.gear_temperature[wheel],
        coupling_state.centre_distance[name],
        reference_temperature=rig.case.ambient.reference_temperature,
        expansion_coefficients=(first, second),
        speed=rig.shaft_speed(gears[0].shaft, speed),
    )


def mesh_model(
    rig: Rig,
    name: str,
    point: OperatingPoint,
    coupling_state: CouplingState,
    stiffness: MeshStiffness | None = None,
) -> MeshModel:
    """One warm mesh and its law; ``stiffness`` as in `mesh_models`.

    The flanks that carry the mean torque see the axes as made, ``axis_inclination`` and ``axis_skew``, and as bending
    shafts and journals tilt them. Not in the law: what the expansion of the warm housing adds to them, which the loaded
    contact at the held points has (`rigdesign.records.contact_gap`).
    """
    box, mesh = rig.mesh(name)
    entry = box.meshes[mesh]
    gears = box.gears[entry.pinion], box.gears[entry.wheel]
    pair = warm_pair(rig, name, point.speed, coupling_state)
    friction = mesh_friction(rig, name, pair, point, coupling_state)
    micro, axes = mesh_microgeometry(rig, name, pair), axes_in_mesh(rig, name, coupling_state)
    warm = WarmMesh(
        name=name,
        pair=pair,
        torque=max(abs(coupling_state.mesh_torque[name]) / entry.sharing, LEAST_TORQUE),
        micro=micro,
        cold_micro=mesh_microgeometry(rig, name, rig.pairs[name]),
        position=MeshPosition(
            offset=coupling_state.axial_expansion[name] * math.tan(pair.base_helix_angle)
            + flank_expansion(rig.pairs[name], pair)
            + coupling_state.flank_approach.get(name, 0.0),
            axes=axes,
            flank="back" if coupling_state.mesh_torque[name] < 0.0 else "front",
            phase=mesh_phase(rig, name),
            tooth_offset_2=entry.tooth_offset % gears[1].teeth,
        ),
        dissipation=MeshDissipation(
            damping_acts_on=entry.damping_acts_on,
            friction=ToothPath.of_pair(pair).transverse_friction(friction.value),
        ),
        discretisation=ContactDiscretisation(n_slices=_slices(rig, pair, micro, axes)),
    )
    shape, law = springs_of(rig, warm, stiffness or rig.mesh_stiffness)
    law = law._replace(damping=mesh_damping(rig, name, law))
    return MeshModel(name=name, pair=pair, stiffness=shape, friction=friction, law=law, halves=entry.sharing)


def mesh_phase(rig: Rig, name: str) -> float:
    """Path position of tooth pair 0 at zero angle [m]: as the case states, and by the teeth an idler turns on.

    Between two wheels on opposite sides a pinion shows its second mesh the teeth of half a turn later.
    """
    box, own = rig.mesh(name)
    mesh, pair = box.meshes[own], rig.pairs[name]
    stated = mesh.phase * pair.base_pitch
    first = next(entry for entry in box.meshes.values() if mesh.pinion in (entry.pinion, entry.wheel))
    if first is mesh or first.pinion != mesh.pinion or box.housing is None:
        return stated
    shafts = box.housing.shafts
    here = shafts[box.gears[mesh.pinion].shaft].lateral_position
    sides = [shafts[box.gears[entry.wheel].shaft].lateral_position > here for entry in (first, mesh)]
    return stated - (math.pi * pair.base_radii[0] if sides[0] != sides[1] else 0.0)


def _slices(
    rig: Rig, pair: GearPair, micro: tuple[Microgeometry, Microgeometry], axes: AxisMisalignment
) -> int:
    """Slices over the face width: those of the case, or of the rule where it states none."""
    numerics = rig.case.numerics
    stated = numerics.slices_helical if pair.helix_angle else numerics.slices_spur
    return math.ceil((stated or default_slices(pair, micro, axes)) / rig.coarsening.slices)


def flank_expansion(reference: GearPair, warm: GearPair) -> float:
    """Approach by which the front flanks of a warm pair touch earlier than at the reference temperature [m].

    Teeth grow on both sides of their middle, so half of the lost backlash comes off each flank; in a held
    bracing mode it winds up the loop. A pair that jams has lost no more than the backlash it had.
    """
    return 0.5 * (max(reference.backlash_along_path, 0.0) - max(warm.backlash_along_path, 0.0))


def laws_of(models: Sequence[MeshModel]) -> list[MeshLaw]:
    """The mesh laws in the order of the drivetrain."""
    return [model.whole for model in models]
