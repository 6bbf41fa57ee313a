"""The warm meshes of the rig at an operating point: gears, teeth and laws of the mesh force."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from dynamics.gear.flank import AxisMisalignment
from dynamics.gear.microgeometry import Microgeometry, cumulative_pitch, pitch_waves
from dynamics.gear.pair import GearPair
from dynamics.rating.iso_rating import RatingOptions, mesh_stiffness
from dynamics.tooth.elastic_pair import ContactLines, ElasticPair, contact_lines, influence_law
from dynamics.tooth.friction import (
    Doleschel,
    FrictionCoefficient,
    FrictionLaw,
    GivenFriction,
    Michaelis,
    Schlenk,
    ToothPath,
    friction_coefficient,
)
from dynamics.tooth.law import MeshLaw, in_parallel
from dynamics.tooth.mesh_laws import (
    ContactDiscretisation,
    MeshDissipation,
    MeshPosition,
    PairStiffness,
    default_slices,
    mesh_law,
    pair_stiffness,
)
from rigdesign.base.part_name import MeshName
from rigdesign.case.drivetrain import MeshStiffness
from rigdesign.case.gears import Gear
from rigdesign.coupling.alignment import axes_in_mesh
from rigdesign.coupling.state import LEAST_TORQUE, CouplingState, OperatingPoint
from rigdesign.properties.oil import Oil
from rigdesign.rig.drivetrain import gear_inertia
from rigdesign.rig.gears import NOT_MEASURED, FlankTopographies
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import gear_feed
from rigdesign.rig.tooth_influence import ToothInfluence
from thermal.fe.kept_results import kept


@dataclass(frozen=True, kw_only=True)
class MeshModel:
    """One mesh, warm, at one operating point.

    stiffness, law : of one half of a double-helical mesh; halves : that share its torque
    """

    name: MeshName
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


def warm_pair(rig: Rig, name: MeshName, speed: float, coupling_state: CouplingState) -> GearPair:
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
    name: MeshName,
    point: OperatingPoint,
    coupling_state: CouplingState,
    stiffness: MeshStiffness | None = None,
) -> MeshModel:
    """One warm mesh and its law; ``stiffness`` as in `mesh_models`.

    The flanks that carry the mean torque see the axes as made, ``axis_inclination`` and ``axis_skew``, and as bending
    shafts and journals tilt them. Not in the law: what the expansion of the warm housing adds to them, which the loaded
    contact at the held points has (`rigdesign.postprocessing.loaded_contact`).
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


def mesh_phase(rig: Rig, name: MeshName) -> float:
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


# Mesh law of a warm mesh: tooth pairs as the analytic model or as influence numbers have them.


@dataclass(frozen=True, kw_only=True)
class WarmMesh:
    """A warm gear pair, how it stands and what it is asked with.

    torque : on the pinion [N m], above 0
    micro, cold_micro : modifications and deviations of the flanks of the warm and of the cold pair
    """

    name: MeshName
    pair: GearPair
    torque: float
    micro: tuple[Microgeometry, Microgeometry]
    cold_micro: tuple[Microgeometry, Microgeometry]
    position: MeshPosition
    dissipation: MeshDissipation
    discretisation: ContactDiscretisation


def springs_of(rig: Rig, mesh: WarmMesh, kind: MeshStiffness) -> tuple[PairStiffness, MeshLaw]:
    """Stiffness of one tooth pair over the path, and the mesh law, not yet damped."""
    box, name = rig.mesh(mesh.name)
    factor = box.meshes[name].stiffness_factor
    if kind == "influence_numbers":
        return _from_influence(rig, mesh, factor)
    shape = _analytic(rig, mesh, kind)
    shape = shape if factor == 1.0 else shape.scaled(factor)
    law = mesh_law(
        mesh.pair,
        shape,
        micro=mesh.micro,
        position=mesh.position,
        dissipation=mesh.dissipation,
        discretisation=mesh.discretisation,
    )
    return shape, law


def _analytic(rig: Rig, mesh: WarmMesh, kind: MeshStiffness) -> PairStiffness:
    pair = mesh.pair
    shape = pair_stiffness(pair, mesh.torque / pair.base_radii[0] / pair.face_width)
    if kind != "iso_6336_scaled":
        return shape.scaled(0.8)
    box, name = rig.mesh(mesh.name)
    entry = box.meshes[name]
    options = RatingOptions(
        application_factor=entry.application_factor, low_load_factor=entry.low_load_factor
    )
    return shape.scaled_to(mesh_stiffness(rig.pairs[mesh.name], mesh.torque, options))


def _from_influence(rig: Rig, mesh: WarmMesh, factor: float) -> tuple[PairStiffness, MeshLaw]:
    """Teeth as drawn and cold; thermal expansion is in their gaps and centre distance."""
    pair = mesh.pair
    cold = rig.pairs[mesh.name]
    law = influence_law(
        ElasticPair(
            pair=pair, gears=rig.tooth_influence.compliances(cold), force=mesh.torque / pair.base_radii[0]
        ),
        mesh.micro,
        position=mesh.position,
        dissipation=mesh.dissipation,
        discretisation=mesh.discretisation,
        lines=_lines(rig.tooth_influence, cold, mesh.cold_micro, mesh.discretisation),
    )
    law = law._replace(
        stiffness=factor * law.stiffness,
        body_compliance=law.body_compliance / factor,
        mean_stiffness=factor * law.mean_stiffness,
    )
    places = law.path_start + law.path_step * np.arange(law.stiffness.shape[1], dtype=np.float64)
    on_path = (places >= pair.path.start) & (places <= pair.path.end)
    # in series with the whole body: what a pair on its own gives
    alone = 1.0 / (1.0 / law.stiffness.sum(axis=0) + law.body_compliance)
    shape = PairStiffness(
        path=places[on_path], value=alone[on_path] / pair.face_width, base_pitch=pair.base_pitch
    )
    return shape, law


@kept
def _lines(
    influence: ToothInfluence,
    pair: GearPair,
    micro: tuple[Microgeometry, Microgeometry],
    discretisation: ContactDiscretisation,
) -> ContactLines:
    """Contact lines of a cold pair: the displacements of its slices, the same at every temperature."""
    return contact_lines(pair, influence.compliances(pair), micro, discretisation=discretisation)


# Damping of a mesh: a constant of the case, or a share of the critical damping of its two gear bodies.


def mesh_damping(rig: Rig, name: MeshName, law: MeshLaw) -> float:
    """Damping along the line of action, of one half of a double-helical mesh [N s/m].

    c = 2 zeta sqrt(k m_red), k the mean stiffness of the mesh and m_red = 1 / (r_b1^2/J_1 + r_b2^2/J_2) the gear
    bodies reduced to the line of action: the ratio that the damping audit of `dynamics.rotor.torsional_modes` reports.

    law : with mean stiffness and base radii
    """
    mesh = rig.case.gearboxes[name.gearbox].meshes[name.part]
    if mesh.damping is not None:
        return mesh.damping
    assert mesh.damping_ratio is not None
    first, second = (
        gear_inertia(rig.case, name.gearbox, gear, rig.pairs, rig.materials)
        for gear in (mesh.pinion, mesh.wheel)
    )
    mobility = mesh.sharing * (law.base_radius_1**2 / first + law.base_radius_2**2 / second)
    return 2.0 * mesh.damping_ratio * math.sqrt(law.mean_stiffness / mobility)


# Friction of the teeth of a mesh: the coefficient that the case states or its oil gives.


def mesh_friction(
    rig: Rig, name: MeshName, pair: GearPair, point: OperatingPoint, coupling_state: CouplingState
) -> FrictionCoefficient:
    """Friction coefficient of a mesh: one source for the torque in the loop and the heat in the box."""
    box, mesh = rig.mesh(name)
    entry = box.meshes[mesh]
    gears = box.gears[entry.pinion], box.gears[entry.wheel]
    chamber = coupling_state.oil_outlet[f"{name.gearbox}.gear_oil"]
    feed = gear_feed(rig, name.gearbox, chamber, coupling_state.oil_supply)
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


# Modifications and deviations of the gears of a case as the mesh law reads them.


def mesh_microgeometry(rig: Rig, name: MeshName, pair: GearPair) -> tuple[Microgeometry, Microgeometry]:
    """Modifications and deviations of pinion and wheel of a mesh as the mesh law reads them."""
    box, mesh = rig.mesh(name)
    entry = box.meshes[mesh]
    first, second = rig.mesh_gears(name)
    return (
        microgeometry(box.gears[entry.pinion], pair, 0, measured=rig.topography(first)),
        microgeometry(box.gears[entry.wheel], pair, 1, entry.tooth_offset, rig.topography(second)),
    )


def microgeometry(
    gear: Gear,
    pair: GearPair,
    index: int,
    tooth_offset: int = 0,
    measured: FlankTopographies = NOT_MEASURED,
) -> Microgeometry:
    """Modifications and deviations of one gear as the mesh law reads them.

    The law counts an eccentricity from the shaft; here it belongs to the teeth, and goes with them where the gear is
    put on its shaft ``tooth_offset`` teeth further.
    """
    flank = gear.flank
    relieved = {"both": (1.0, 1.0), "front": (1.0, 0.0), "rear": (0.0, 1.0)}[flank.end_relief_at]
    return Microgeometry(
        tip_relief=flank.tip_relief,
        tip_relief_length=_tip_path(flank.tip_relief_length, pair, index),
        tip_relief_exponent=flank.tip_relief_exponent,
        root_relief=flank.root_relief,
        root_relief_length=_root_path(flank.root_relief_length, pair, index),
        root_relief_exponent=flank.root_relief_exponent,
        end_relief=(relieved[0] * flank.end_relief, relieved[1] * flank.end_relief),
        end_relief_length=flank.end_relief_length,
        end_relief_exponent=flank.end_relief_exponent,
        profile_crowning=flank.profile_crowning,
        lead_crowning=flank.lead_crowning,
        lead_crowning_form=flank.lead_crowning_form,
        manufacturing_twist=flank.manufacturing_twist,
        profile_slope=flank.profile_slope,
        helix_slope=flank.helix_slope,
        profile_twist=0.25 * flank.twist,
        topography=measured[0],
        back_topography=measured[1],
        pitch_deviations=_tooth_places(gear),
        run_out=0.5 * flank.run_out,
        run_out_phase=flank.run_out_phase - 2.0 * math.pi * tooth_offset / gear.teeth,
        profile_slopes=flank.profile_slope_scatter,
        tooth_stiffness=_tooth_stiffness(gear),
    )


def _tooth_places(gear: Gear) -> tuple[float, ...]:
    """Place of each tooth ahead of its ideal one [m], from single pitch and waves; empty for an ideal pitch."""
    flank = gear.flank
    single = cumulative_pitch(flank.single_pitch) if flank.single_pitch else ()
    if not flank.pitch_waves:
        return single
    waves = pitch_waves(gear.teeth, ((wave.order, wave.amplitude, wave.phase) for wave in flank.pitch_waves))
    return tuple(map(sum, zip(single, waves))) if single else waves


def _tooth_stiffness(gear: Gear) -> tuple[float, ...]:
    """Stiffness share of each tooth [-]; empty for equal teeth."""
    weak, shares = gear.flank.weak_tooth, gear.flank.tooth_stiffness
    if weak.stiffness == 1.0:
        return shares
    shares = shares or (1.0,) * gear.teeth
    return tuple(share * (weak.stiffness if i == weak.tooth else 1.0) for i, share in enumerate(shares))


def _tip_path(height: float, pair: GearPair, index: int) -> float:
    """Path length of a tip relief from its radial height [m]."""
    gear = pair.gears[index]
    tip = pair.flanks[index].tip_radius
    return gear.roll_length(tip) - gear.roll_length(tip - height)


def _root_path(height: float, pair: GearPair, index: int) -> float:
    """Path length of a root relief from its radial height above the start of the active profile [m]."""
    gear = pair.gears[index]
    start = pair.rolling_radii[index] + (pair.path.start if index == 0 else -pair.path.end)
    return gear.roll_length(math.hypot(gear.base_radius, start) + height) - start
