"""The braced power circuit at an operating point: torque or shift that is held, periodic response under it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from dynamics.errors import DynamicsNotConverged
from dynamics.rotor.bracing import LoopBracing, Mode, ShiftedGear, braced_state
from dynamics.rotor.craig_bampton import TURNING
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.parts import left_out
from dynamics.rotor.static_loop import LoopLoad, StaticState
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_laws import alike_teeth
from dynamics.tooth.packed_laws import has_individual_teeth
from dynamics.vibration.harmonic_balance import HarmonicSolution
from dynamics.vibration.initial_state import pinion_ratios
from dynamics.vibration.response_curve import CurvePoint
from dynamics.vibration.speed_continuation import LEAST_HARMONICS
from dynamics.vibration.speed_sweep import SweepSettings, periodic_response
from dynamics.vibration.steady_motion import period_length
from rigdesign.base.part_name import GearName, MeshName
from rigdesign.coupling.mesh_models import MeshModel, laws_of, mesh_models
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.rig.model import Rig


def locked_share(rig: Rig) -> float:
    """Torque that is locked in, as a share of the stated one: bracing drifts with the temperature of the gear oil."""
    power = rig.case.power_circuit
    if power.bracing.temperature_drift == 0.0:
        return 1.0
    box = rig.case.gearboxes[power.counting_gear.gearbox]
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
    static: StaticState | None = field(default=None, repr=False, compare=False)
    """Of the loop as it was braced, from which a neighbour may start."""


def shifted_gear(rig: Rig) -> ShiftedGear | None:
    """The helical gear whose axial shift braces the loop; None if the case names none."""
    bracing = rig.case.power_circuit.bracing
    if bracing.shifted_gear is None:
        return None
    gear = GearName.read(bracing.shifted_gear)
    for index, name in enumerate(rig.mesh_names):
        if name.gearbox != gear.gearbox:
            continue
        box, mesh = rig.mesh(name)
        entry = box.meshes[mesh]
        if gear.part in (entry.pinion, entry.wheel):
            pair = rig.pairs[name]
            return ShiftedGear(
                mesh=index,
                helix_angle=pair.helix_angle,
                base_helix_angle=pair.base_helix_angle,
                working_radius=pair.working_radii[0 if gear.part == entry.pinion else 1],
                halves=2 if entry.double_helical else 1,
                floating_partner=bracing.partner_floats,
                spline_friction=bracing.spline_friction_coefficient,
                spline_radius=bracing.spline_pitch_radius or 0.0,
            )
    raise ValueError(f"drivetrain.bracing.shifted_gear = {bracing.shifted_gear}: this gear is in no mesh")


def brace_initial(
    rig: Rig,
    point: OperatingPoint,
    initial: CouplingState,
    models: Sequence[MeshModel] | None = None,
    system: LinearSystem | None = None,
    near: StaticState | None = None,
) -> BracingState:
    """Bracing that makes the demanded torque in the initial state; kept from then on in the held modes.

    The torque is the mean over all places where teeth that are not alike may come to rest.

    models : the meshes in that state, where they are known; system : of the drivetrain, the torsional one when left out
    near : state of a loop that differs little, to start from
    """
    system = rig.system if system is None else system
    mode = rig.case.power_circuit.bracing.mode
    if mode == "torque_controlled":
        return BracingState(mode=mode)
    met = mesh_models(rig, point, initial) if models is None else models
    laws = [alike_teeth(law) for law in laws_of(met)]
    bracing = LoopBracing(mode=mode, gear=shifted_gear(rig))
    shift, state = braced_state(system, laws, signed_torque(rig, point), bracing, near)
    twist = state.twist if mode == "twist_held" else 0.0
    return BracingState(mode=mode, twist=twist, shift=shift, static=state)


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


NEAR_TOLERANCE = 1e-7
"""Tolerance of a harmonic balance that starts next to its solution: its small changes are what is asked for [-]."""


def respond(
    rig: Rig,
    circuit: LoadedCircuit,
    near: HarmonicSolution | None = None,
    harmonics: int = LEAST_HARMONICS,
    traced: bool = True,
) -> CurvePoint:
    """Periodic response at one operating point.

    harmonics : of the common mesh period at least
    near : state of a circuit that differs little, to start from
    traced : seek it on branches from other speeds where it is not found at once; else what a time integration comes to,
        which tells sooner

    Raises
    ------
    DynamicsNotConverged
        Neither harmonic balance nor time integration converges.
    """
    point, setting = circuit.point, circuit.bracing
    controlled = setting.mode == "torque_controlled"
    settings = SweepSettings(
        period=rig.case.numerics.response_period,
        cutoff=rig.highest_mode,
        harmonics=harmonics,
        branches=traced,
    )
    if near is not None:
        settings = replace(settings, start=near, tolerance=NEAR_TOLERANCE)
    curve = periodic_response(
        circuit.system,
        periodic_laws(rig, shifted_laws(rig, circuit.models, setting)),
        [rig.pinion_speed(point.speed)],
        LoopLoad(
            torque=signed_torque(rig, point) if controlled else None,
            twist=None if controlled else setting.twist,
        ),
        drag_torques=circuit.drags,
        settings=settings,
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


# Teeth that differ from each other, and the period over which a periodic response is sought.
#
# A response over one mesh cannot tell one tooth from another, one over a turn of the pinion can tell those of the
# wheel only if it ends the turn on the same tooth. Gears whose differences the period cannot hold are taken with
# the mean of their teeth; the run in time and a response over the hunting cycle have them all.


def periodic_laws(rig: Rig, laws: Sequence[MeshLaw]) -> list[MeshLaw]:
    """Mesh laws with alike teeth on every gear that does not end the period of the response where it began."""
    return [
        alike_teeth(law, *(not whole for whole in back)) if has_individual_teeth(law) else law
        for law, back in zip(laws, _whole_turns(rig, laws))
    ]


def averaged_gears(rig: Rig, laws: Sequence[MeshLaw]) -> list[str]:
    """Gears ``gearbox.gear`` whose teeth differ and are taken with their mean in the periodic response."""
    found = []
    for name, law, back in zip(rig.mesh_names, laws, _whole_turns(rig, laws)):
        for gear, own, whole in zip(rig.mesh_gears(name), _differ(law), back):
            if own and not whole:
                found.append(gear)
    return list(dict.fromkeys(found))


def _differ(law: MeshLaw) -> tuple[bool, bool]:
    """Whether the teeth of pinion and wheel differ from each other."""
    return (
        bool(np.ptp(law.deviation_1, axis=0).any() or np.ptp(law.scale_1)),
        bool(np.ptp(law.deviation_2, axis=0).any() or np.ptp(law.scale_2)),
    )


def _whole_turns(rig: Rig, laws: Sequence[MeshLaw]) -> list[tuple[bool, bool]]:
    """Whether pinion and wheel of each mesh make whole turns in the period of the response."""
    kind = rig.case.numerics.response_period
    if kind != "revolution":
        return [(kind == "hunting_cycle",) * 2] * len(laws)
    speeds = [rig.shaft_speed(_pinion_shaft(rig, name), 1.0) for name in rig.mesh_names]
    turns = [speed / speeds[0] for speed in speeds]
    return [(_whole(own), _whole(own * law.teeth_1 / law.teeth_2)) for own, law in zip(turns, laws)]


def _pinion_shaft(rig: Rig, name: MeshName) -> str:
    box, mesh = rig.mesh(name)
    return box.gears[box.meshes[mesh].pinion].shaft


def _whole(turns: float) -> bool:
    return abs(turns - round(turns)) < 1e-6


# Loads that alternate with a shaft, as the response holds them or leaves them out.


def loads_left_out(rig: Rig, laws: Sequence[MeshLaw], system: LinearSystem | None = None) -> list[str]:
    """Part and order of every oscillating torque that the period of the response cannot hold.

    system : of the drivetrain; that of shafts that only twist when left out
    """
    return [name for name in _left_out(rig, laws, system) if not name.startswith(TURNING)]


def lines_left_out(rig: Rig, laws: Sequence[MeshLaw], system: LinearSystem | None) -> list[str]:
    """Shaft lines, by their first loaded shaft, whose unbalance, bow and run-out the period cannot hold."""
    found = (name for name in _left_out(rig, laws, system) if name.startswith(TURNING))
    return list(dict.fromkeys(name.partition(" of ")[2].partition(" order ")[0] for name in found))


def _left_out(rig: Rig, laws: Sequence[MeshLaw], system: LinearSystem | None) -> list[str]:
    system = rig.system if system is None else system
    if not system.periodic_loads:
        return []
    ratios = pinion_ratios(system, laws)
    pinions = [float(ratios[port]) for port in system.mesh_ports[:, 0]]
    return left_out(
        system.periodic_loads, ratios, period_length(laws, pinions, rig.case.numerics.response_period)
    )
