"""Dynamic loads of the rig at an operating point: warm gears, mesh laws, periodic response."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from dynamics.flank import Microgeometry, cumulative_pitch, mesh_law
from dynamics.gear import GearPair
from dynamics.iso_rating import RatingOptions, mesh_stiffness
from dynamics.losses import ToothPath
from dynamics.mesh_law import MeshLaw
from dynamics.tooth_friction import (
    FrictionCoefficient,
    FrictionLaw,
    GivenFriction,
    Michaelis,
    Schlenk,
    friction_coefficient,
)
from dynamics.tooth_stiffness import PairStiffness, pair_stiffness
from rigdesign.case.gears import FlankModification, Gear
from rigdesign.rig.model import Rig
from rigdesign.state import Feedback, OperatingPoint

LEAST_TORQUE = 1.0
"""Pinion torque [N m] below which stiffness and friction are taken at this torque."""


@dataclass(frozen=True, kw_only=True)
class MeshModel:
    """One mesh, warm, at one operating point."""

    name: str
    pair: GearPair
    stiffness: PairStiffness
    friction: FrictionCoefficient
    law: MeshLaw


def mesh_models(
    rig: Rig, point: OperatingPoint, feedback: Feedback, stiffness: str | None = None
) -> tuple[MeshModel, ...]:
    """Warm gears and mesh laws of the whole rig.

    stiffness : ``iso_6336_scaled`` or ``weber_banaschek_0.8``; that of the case when left out
    """
    kind = stiffness or (rig.case.drivetrain.mesh_stiffness if rig.case.drivetrain else "iso_6336_scaled")
    return tuple(_mesh_model(rig, name, point, feedback, kind) for name in rig.mesh_names)


def warm_pair(rig: Rig, name: str, speed: float, feedback: Feedback) -> GearPair:
    """Gear pair at the bulk temperatures, centre distance and speed [rad/s] of this pass."""
    box, mesh = rig.mesh(name)
    pinion, wheel = rig.mesh_gears(name)
    entry = box.meshes[mesh]
    gears = box.gears[entry.pinion], box.gears[entry.wheel]
    first, second = (rig.materials[gear.material].expansion_coefficient for gear in gears)
    return rig.pairs[name].warm(
        feedback.gear_temperature[pinion],
        feedback.gear_temperature[wheel],
        feedback.centre_distance[name],
        reference_temperature=rig.case.ambient.temperature,
        expansion_coefficients=(first, second),
        speed=rig.shaft_speed(gears[0].shaft, speed),
    )


def tooth_path(pair: GearPair) -> ToothPath:
    """The path of contact as the loss integral needs it."""
    return ToothPath(
        base_radius_1=pair.base_radii[0],
        base_radius_2=pair.base_radii[1],
        start=pair.path.start,
        end=pair.path.end,
        base_pitch=pair.base_pitch,
        working_pressure_angle=pair.working_pressure_angle,
        face_width=pair.face_width,
        base_helix_angle=pair.base_helix_angle,
    )


def _mesh_model(
    rig: Rig, name: str, point: OperatingPoint, feedback: Feedback, kind: str
) -> MeshModel:
    box, mesh = rig.mesh(name)
    entry = box.meshes[mesh]
    gears = box.gears[entry.pinion], box.gears[entry.wheel]
    pair = warm_pair(rig, name, point.speed, feedback)
    torque = max(abs(feedback.mesh_torque[name]), LEAST_TORQUE)
    friction = mesh_friction(rig, name, pair, point, feedback)
    shape = pair_stiffness(pair, torque / pair.base_radii[0] / pair.face_width)
    if kind == "iso_6336_scaled":
        options = RatingOptions(
            application_factor=entry.application_factor, low_load_factor=entry.low_load_factor
        )
        shape = shape.scaled_to(mesh_stiffness(rig.pairs[name], torque, options))
    else:
        shape = shape.scaled(0.8)
    numerics = rig.case.numerics
    law = mesh_law(
        pair,
        stiffness=shape,
        micro=(microgeometry(gears[0], pair, 0), microgeometry(gears[1], pair, 1)),
        n_slices=numerics.slices_helical if pair.helix_angle else numerics.slices_spur,
        damping=entry.damping,
        friction=tooth_path(pair).transverse_friction(friction.value),
        offset=feedback.tooth_growth[name] * math.tan(pair.base_helix_angle),
    )
    return MeshModel(name=name, pair=pair, stiffness=shape, friction=friction, law=law)


def mesh_friction(
    rig: Rig, name: str, pair: GearPair, point: OperatingPoint, feedback: Feedback
) -> FrictionCoefficient:
    """Friction coefficient of a mesh: one source for the torque in the loop and the heat in the box."""
    box, mesh = rig.mesh(name)
    entry = box.meshes[mesh]
    gears = box.gears[entry.pinion], box.gears[entry.wheel]
    oil = rig.oils[box.oil.oil]
    stream = f"{name.split('.')[0]}.gear_oil"
    temperature = 0.5 * (box.oil.inlet_temperature + feedback.oil_outlet[stream])
    contact = tooth_path(pair).contact(
        max(abs(feedback.mesh_torque[name]), LEAST_TORQUE),
        rig.shaft_speed(gears[0].shaft, point.speed),
        reference_diameter_1=2.0 * pair.reference_radii[0],
        roughness=0.5 * (gears[0].flank_roughness + gears[1].flank_roughness),
        viscosity=oil.dynamic_viscosity(temperature),
    )
    return friction_coefficient(contact, friction_law(rig))


def friction_law(rig: Rig) -> FrictionLaw:
    """The friction law of the case."""
    friction = rig.case.losses.friction
    if friction.law == "constant":
        assert friction.coefficient is not None
        return GivenFriction(value=friction.coefficient)
    if friction.law == "michaelis":
        return Michaelis(lubricant_factor=friction.lubricant_factor)
    return Schlenk(lubricant_factor=friction.lubricant_factor)


def microgeometry(gear: Gear, pair: GearPair, index: int) -> Microgeometry:
    """Modifications and deviations of one gear as the mesh law reads them."""
    flank = gear.flank
    return Microgeometry(
        tip_relief=flank.tip_relief,
        tip_relief_length=_relief_path(flank, pair, index),
        profile_crowning=flank.profile_crowning,
        lead_crowning=flank.lead_crowning,
        helix_slope=flank.helix_slope,
        profile_twist=0.25 * flank.twist,
        pitch_deviations=cumulative_pitch(flank.single_pitch) if flank.single_pitch else (),
        run_out=0.5 * flank.run_out,
        run_out_phase=flank.run_out_phase,
    )


def _relief_path(flank: FlankModification, pair: GearPair, index: int) -> float:
    """Path length of a tip relief from its radial height [m]."""
    gear = pair.gears[index]
    return gear.roll_length(gear.tip_radius) - gear.roll_length(gear.tip_radius - flank.tip_relief_length)


def laws_of(models: Sequence[MeshModel]) -> list[MeshLaw]:
    """The mesh laws in the order of the drivetrain."""
    return [model.law for model in models]


def signed_torque(rig: Rig, point: OperatingPoint) -> float:
    """Torque asked of the control mesh at its pinion [N m]; positive on the front flank."""
    return rig.torque_ratio * point.torque


def first_torques(rig: Rig, point: OperatingPoint) -> Mapping[str, float]:
    """Mesh torques before any response: the same tooth force in every mesh of the loop."""
    force = signed_torque(rig, point) / rig.pairs[rig.control_mesh_name].base_radii[0]
    return {name: force * pair.base_radii[0] for name, pair in rig.pairs.items()}
