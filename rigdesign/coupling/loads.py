"""Dynamic loads of the rig at an operating point: warm gears, mesh laws, periodic response."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from dynamics.drivetrain.bracing import LoopBracing, Mode, ShiftedGear, brace
from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.loop_load import LoopLoad
from dynamics.errors import DynamicsNotConverged
from dynamics.flank.axes import AxisMisalignment
from dynamics.flank.microgeometry import Microgeometry, cumulative_pitch, pitch_waves
from dynamics.gear.pair import GearPair
from dynamics.losses.mesh_loss import ToothPath
from dynamics.mesh.flank import (
    ContactDiscretisation,
    MeshDissipation,
    MeshPosition,
    alike_teeth,
    default_slices,
)
from dynamics.mesh.friction import (
    Doleschel,
    FrictionCoefficient,
    FrictionLaw,
    GivenFriction,
    Michaelis,
    Schlenk,
    friction_coefficient,
)
from dynamics.mesh.law import MeshLaw
from dynamics.mesh.stiffness import PairStiffness
from dynamics.response.speed_sweep import CurvePoint, SweepSettings, periodic_response
from rigdesign.case.drivetrain import MeshStiffness
from rigdesign.case.gears import Gear
from rigdesign.coupling.mesh_axes import axes_in_mesh
from rigdesign.coupling.mesh_damping import mesh_damping
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.coupling.tooth_deviations import periodic_laws
from rigdesign.coupling.tooth_springs import WarmMesh, springs_of
from rigdesign.properties.oil import Oil
from rigdesign.rig.flank_topography import NOT_MEASURED, FlankTopographies
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import gear_feed

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
        torque=max(abs(coupling_state.mesh_torque[name]), LEAST_TORQUE),
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
    return MeshModel(name=name, pair=pair, stiffness=shape, friction=friction, law=law)


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
        max(abs(coupling_state.mesh_torque[name]), LEAST_TORQUE),
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


def mesh_microgeometry(rig: Rig, name: str, pair: GearPair) -> tuple[Microgeometry, Microgeometry]:
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


def laws_of(models: Sequence[MeshModel]) -> list[MeshLaw]:
    """The mesh laws in the order of the drivetrain."""
    return [model.law for model in models]


def locked_share(rig: Rig) -> float:
    """Torque that is locked in, as a share of the stated one: bracing drifts with the temperature of the gear oil."""
    power = rig.case.drivetrain
    if power is None or power.bracing.temperature_drift == 0.0:
        return 1.0
    box = rig.case.gearboxes[power.torque_at.split(".")[0]]
    fed = box.gear_oil_temperature
    assert fed is not None
    warmer = fed - rig.case.ambient.reference_temperature
    return 1.0 + power.bracing.temperature_drift * warmer


def signed_torque(rig: Rig, point: OperatingPoint) -> float:
    """Torque asked of the control mesh at its pinion [N m]; positive on the front flank."""
    return rig.torque_ratio * point.torque * locked_share(rig)


def first_torques(rig: Rig, point: OperatingPoint) -> Mapping[str, float]:
    """Mesh torques before any response: every shaft line in balance without losses."""
    force = signed_torque(rig, point) / rig.pairs[rig.control_mesh].base_radii[0]
    return {name: rig.mesh_forces[name] * force * pair.base_radii[0] for name, pair in rig.pairs.items()}


@dataclass(frozen=True, kw_only=True)
class BracingState:
    """How the loop is braced: the torque that is controlled, or the twist [rad] or shift [m] that is held."""

    mode: Mode
    twist: float = 0.0
    shift: float = 0.0


def shifted_gear(rig: Rig) -> ShiftedGear | None:
    """The helical gear whose axial shift braces the loop; None if the case names none."""
    power = rig.case.drivetrain
    if power is None or power.bracing.shifted_gear is None:
        return None
    box_name, gear = power.bracing.shifted_gear.split(".")
    for index, name in enumerate(rig.mesh_names):
        if name.split(".")[0] != box_name:
            continue
        box, mesh = rig.mesh(name)
        entry = box.meshes[mesh]
        if gear in (entry.pinion, entry.wheel):
            pair = rig.pairs[name]
            return ShiftedGear(
                mesh=index,
                helix_angle=pair.helix_angle,
                base_helix_angle=pair.base_helix_angle,
                working_radius=pair.working_radii[0 if gear == entry.pinion else 1],
                halves=2 if entry.double_helical else 1,
                floating_partner=power.bracing.partner_floats,
                spline_friction=power.bracing.spline_friction_coefficient,
                spline_radius=power.bracing.spline_pitch_radius or 0.0,
            )
    raise ValueError(
        f"drivetrain.bracing.shifted_gear = {power.bracing.shifted_gear}: this gear is in no mesh"
    )


def brace_initial(
    rig: Rig,
    point: OperatingPoint,
    initial: CouplingState,
    models: Sequence[MeshModel] | None = None,
    system: LinearSystem | None = None,
) -> BracingState:
    """Bracing that makes the demanded torque in the initial state; kept from then on in the held modes.

    The torque is the mean over all places where teeth that are not alike may come to rest.

    models : the meshes in that state, where they are known; system : of the drivetrain, the torsional one when left out
    """
    system = rig.system if system is None else system
    assert rig.case.drivetrain is not None and system is not None
    mode = rig.case.drivetrain.bracing.mode
    if mode == "torque_controlled":
        return BracingState(mode=mode)
    met = mesh_models(rig, point, initial) if models is None else models
    laws = [alike_teeth(law) for law in laws_of(met)]
    state = brace(system, laws, signed_torque(rig, point), LoopBracing(mode=mode, gear=shifted_gear(rig)))
    return BracingState(mode=mode, twist=state.twist if mode == "twist_held" else 0.0, shift=state.shift)


@dataclass(frozen=True)
class LoadedCircuit:
    """The warm meshes of a braced power circuit at an operating point, and the torques that brake it."""

    point: OperatingPoint
    models: tuple[MeshModel, ...]
    drags: Mapping[str, float]
    """By place of the drivetrain [N m]."""
    bracing: BracingState
    system: LinearSystem
    """Of the drivetrain without its meshes."""


def respond(rig: Rig, circuit: LoadedCircuit) -> CurvePoint:
    """Periodic response at one operating point.

    Raises
    ------
    DynamicsNotConverged
        Neither harmonic balance nor time integration converges.
    """
    point, setting = circuit.point, circuit.bracing
    controlled = setting.mode == "torque_controlled"
    curve = periodic_response(
        circuit.system,
        periodic_laws(rig, shifted_laws(rig, circuit.models, setting)),
        [rig.pinion_speed(point.speed)],
        LoopLoad(
            torque=signed_torque(rig, point) if controlled else None,
            twist=None if controlled else setting.twist,
        ),
        drag_torques=circuit.drags,
        settings=SweepSettings(period=rig.case.numerics.response_period, cutoff=rig.highest_mode),
    )
    if curve.failed:
        raise DynamicsNotConverged(f"periodic response at stage {point.stage!r}: {curve.failed[0][1]}")
    return curve.points[0]


def shifted_laws(rig: Rig, models: Sequence[MeshModel], setting: BracingState) -> list[MeshLaw]:
    """Mesh laws with the held axial shift in the mesh of the shifted gear."""
    laws = laws_of(models)
    gear = shifted_gear(rig)
    if gear is not None and setting.shift:
        law = laws[gear.mesh]
        laws[gear.mesh] = law._replace(offset=law.offset + gear.approach_per_shift * setting.shift)
    return laws
