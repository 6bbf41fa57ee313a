"""Friction of the teeth of a mesh: the coefficient that the case states or its oil gives."""

from dataclasses import replace

from dynamics.gear.pair import GearPair
from dynamics.losses.mesh_loss import ToothPath
from dynamics.mesh.friction import (
    Doleschel,
    FrictionCoefficient,
    FrictionLaw,
    GivenFriction,
    Michaelis,
    Schlenk,
    friction_coefficient,
)
from rigdesign.coupling.state import LEAST_TORQUE, CouplingState, OperatingPoint
from rigdesign.properties.oil import Oil
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import gear_feed


def mesh_friction(
    rig: Rig, name: str, pair: GearPair, point: OperatingPoint, coupling_state: CouplingState
) -> FrictionCoefficient:
    """Friction coefficient of a mesh: one source for the torque in the loop and the heat in the box."""
    box, mesh = rig.mesh(name)
    entry = box.meshes[mesh]
    gears = box.gears[entry.pinion], box.gears[entry.wheel]
    box_name = name.split(".")[0]
    chamber = coupling_state.oil_outlet[f"{box_name}.gear_oil"]
    feed = gear_feed(rig, box_name, chamber, coupling_state.oil_supply)
    temperature = feed.mean(chamber)
    contact = ToothPath.of_pair(pair).contact(
        max(abs(coupling_state.mesh_torque[name]) / entry.sharing, LEAST_TORQUE),
        rig.shaft_speed(gears[0].shaft, point.speed),
        reference_diameter_1=2.0 * pair.reference_radii[0],
        roughness=0.5 * (gears[0].flank_roughness + gears[1].flank_roughness),
        viscosity=feed.oil.dynamic_viscosity(temperature),
    )
    own = friction_coefficient(contact, friction_law(rig, feed.oil))
    return scaled_friction(own, box.loss_factors.mesh * entry.friction_factor)


def scaled_friction(own: FrictionCoefficient, factor: float) -> FrictionCoefficient:
    """A friction coefficient times a factor that its inputs show unless it is 1."""
    if factor == 1.0:
        return own
    return replace(own, value=factor * own.value, inputs=own.inputs | {"loss_factor": factor})


def friction_law(rig: Rig, oil: Oil) -> FrictionLaw:
    """The friction law of the case for this oil."""
    friction = rig.case.losses.friction
    factor = oil.lubricant_factor if friction.lubricant_factor is None else friction.lubricant_factor
    match friction.law:
        case "constant":
            assert friction.coefficient is not None
            return GivenFriction(value=friction.coefficient)
        case "michaelis":
            return Michaelis(lubricant_factor=factor)
        case "doleschel":
            assert friction.doleschel is not None
            return Doleschel(**dict(friction.doleschel), pressure_viscosity=oil.pressure_viscosity)
    return Schlenk(lubricant_factor=factor)
