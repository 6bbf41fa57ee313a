"""Memoised parts of an iteration: bearing films, meshes, matrices of the circuit, responses and bracing met before.

A memoised part is the same numbers, only not computed twice. Each is known by all numbers that enter it and by
nothing else of the case, so that a change finds again whatever it leaves alone. Gaps of the teeth count as the same
within a tenth of a picometre: the mean over teeth that deviate is zero only to rounding.
"""

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from dynamics.errors import DynamicsNotConverged
from dynamics.rotor.bearing import Bearing, BearingOperation, BearingState
from dynamics.rotor.damped_modes import NamedMode
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.static_loop import LoopLoad, StaticState, port_model
from dynamics.tooth.friction import ToothPath
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_laws import alike_teeth
from dynamics.vibration.harmonic_balance import HarmonicSolution
from dynamics.vibration.response_curve import CurvePoint, quasi_static_point
from dynamics.vibration.speed_continuation import LEAST_HARMONICS, MOST_HARMONICS, highest_mode, mesh_cells
from rigdesign.base.part_name import MeshName
from rigdesign.coupling.alignment import axes_in_mesh
from rigdesign.coupling.bearing_loads import solve_bearing, solve_bearings
from rigdesign.coupling.iteration import SOLVED, IterationParts, IterationResult
from rigdesign.coupling.loop_system import loop_system, running_state
from rigdesign.coupling.mesh_models import (
    MeshModel,
    laws_of,
    mesh_damping,
    mesh_friction,
    mesh_model,
    mesh_phase,
)
from rigdesign.coupling.preloaded_loop import (
    BracingState,
    LoadedCircuit,
    brace_initial,
    periodic_laws,
    respond,
    shifted_laws,
    signed_torque,
)
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.prediction.static_tests import modes_at_rest, rig_at_rest
from rigdesign.rig.model import Rig
from thermal.fe.mesh import FloatArray

MOST = {
    "films": 20000,
    "meshes": 2000,
    "responses": 1000,
    "bracings": 1000,
    "modes at rest": 1000,
    "elastic systems": 60,
    "elastic responses": 60,
}
"""Entries kept of each kind; all of a kind are forgotten when one more comes."""
SAME_GAP = 13
"""Decimal places of a gap [m] that count."""


class Memoisation:
    """What iterations of one rig and its variants found out."""

    def __init__(self) -> None:
        self._known: dict[str, dict[Any, Any]] = {kind: {} for kind in MOST}
        self._states: dict[str, HarmonicSolution] = {}
        self._braced: dict[str, StaticState] = {}

    @property
    def parts(self) -> IterationParts:
        """The memoised parts of an iteration."""
        return IterationParts(
            models=self.models, bearings=self.bearings, system=self.system, response=self.response
        )

    def bearings(
        self, rig: Rig, point: OperatingPoint, coupling_state: CouplingState
    ) -> dict[str, BearingState]:
        """As `solve_bearings`."""
        return solve_bearings(rig, point, coupling_state, self._film)

    def _film(self, bearing: Bearing, operation: BearingOperation) -> BearingState:
        key = (bearing, operation)
        known = self._room("films")
        if key not in known:
            known[key] = solve_bearing(bearing, operation)
        found: BearingState = known[key]
        return found

    def models(self, rig: Rig, point: OperatingPoint, coupling_state: CouplingState) -> tuple[MeshModel, ...]:
        """As `mesh_models`; of a mesh that differs in friction and damping alone all arrays are shared."""
        return tuple(self._model(rig, name, point, coupling_state) for name in rig.mesh_names)

    def _model(
        self, rig: Rig, name: MeshName, point: OperatingPoint, coupling_state: CouplingState
    ) -> MeshModel:
        key = shape_key(rig, name, point, coupling_state)
        known = self._room("meshes")
        if key not in known:
            known[key] = mesh_model(rig, name, point, coupling_state)
        model: MeshModel = known[key]
        friction = mesh_friction(rig, name, model.pair, point, coupling_state)
        box, mesh = rig.mesh(name)
        entry, law = box.meshes[mesh], model.law
        damped = mesh_damping(rig, name, law), entry.damping_acts_on
        if friction == model.friction and damped == (law.damping, law.damping_acts_on):
            return model
        along = ToothPath.of_pair(model.pair).transverse_friction(friction.value)
        law = law._replace(friction=along, damping=damped[0], damping_acts_on=damped[1])
        return replace(model, friction=friction, law=law)

    def system(
        self,
        rig: Rig,
        point: OperatingPoint,
        coupling_state: CouplingState,
        bearings: Mapping[str, BearingState],
    ) -> LinearSystem:
        """As `loop_system`."""
        if rig.shaft_model == "torsional":
            return loop_system(rig, point, coupling_state, bearings)
        state = running_state(rig, point, coupling_state, bearings)
        key = (
            id(rig.elastic),
            state.speed,
            tuple(
                (name, one.stiffness.tobytes(), one.damping.tobytes()) for name, one in state.bearings.items()
            ),
            tuple(state.torques.items()),
        )
        known = self._room("elastic systems")
        if key not in known:
            known[key] = rig.elastic, rig.elastic.seen.system(state)
        found: LinearSystem = known[key][1]
        return found

    def bracing(self, rig: Rig, point: OperatingPoint, initial: CouplingState) -> BracingState | None:
        """As `brace_initial`; None without a drivetrain."""
        if rig.case.drivetrain is None:
            return None
        if rig.case.power_circuit.bracing.mode == "torque_controlled":
            return BracingState(mode="torque_controlled")
        models = self.models(rig, point, initial)
        system = self.system(rig, point, initial, self.bearings(rig, point, initial))
        at_rest = [alike_teeth(law)._replace(friction=0.0, damping=0.0) for law in laws_of(models)]
        key = (
            _digest(system.stiffness, system.twist_load),
            tuple(map(law_key, at_rest)),
            signed_torque(rig, point),
            rig.case.power_circuit.bracing,
        )
        known = self._room("bracings")
        if key not in known:
            near = self._braced.get(point.stage)
            made = brace_initial(rig, point, initial, models, system, near)
            if made.static is not None:
                self._braced.setdefault(point.stage, made.static)
            known[key] = made
        found: BracingState = known[key]
        return found

    def standing_modes(self, rig: Rig, point: OperatingPoint | None = None) -> tuple[NamedMode, ...]:
        """As `rigdesign.prediction.static_tests.standing_modes`."""
        rest = rig_at_rest(rig, self.parts, point)
        system = rest.system
        key = (
            _digest(system.inertia, system.damping, system.stiffness),
            tuple(map(law_key, rest.laws)),
            signed_torque(rig, rest.point),
        )
        known = self._room("modes at rest")
        if key not in known:
            known[key] = modes_at_rest(rig, rest)
        found: tuple[NamedMode, ...] = known[key]
        return found

    def response(self, rig: Rig, circuit: LoadedCircuit) -> CurvePoint:
        """As `respond_at_any_speed`."""
        point, setting = circuit.point, circuit.bracing
        laws = periodic_laws(rig, shifted_laws(rig, circuit.models, setting))
        asked = signed_torque(rig, point) if setting.mode == "torque_controlled" else setting.twist
        key = (
            id(circuit.system),
            tuple(map(law_key, laws)),
            rig.pinion_speed(point.speed),
            (setting.mode, asked),
            rig.case.numerics.response_period,
            tuple(circuit.drags.items()),
        )
        known = self._room("responses" if rig.shaft_model == "torsional" else "elastic responses")
        if key not in known:
            made = respond_at_any_speed(rig, circuit, self._states.get(point.stage))
            if made.solution is not None:
                self._states.setdefault(point.stage, made.solution)
            known[key] = circuit.system, made
        found: tuple[LinearSystem, CurvePoint] = known[key]
        return found[1]

    def start_from(self, converged: Iterable[IterationResult]) -> None:
        """Let responses at operating points start from those of their last iterations."""
        for last in converged:
            if last.response is not None and last.response.solution is not None:
                self._states[last.point.stage] = last.response.solution

    def _room(self, kind: str) -> dict[Any, Any]:
        """What is known of a kind, with room for one more."""
        known = self._known[kind]
        if len(known) >= MOST[kind]:
            known.clear()
        return known


def _digest(*matrices: FloatArray) -> bytes:
    """What matrices are known by."""
    return hashlib.sha256(b"".join(matrix.tobytes() for matrix in matrices)).digest()


def shape_key(
    rig: Rig, name: MeshName, point: OperatingPoint, coupling_state: CouplingState
) -> tuple[object, ...]:
    """What a mesh is known by: all that enters it but its friction and damping."""
    box, own = rig.mesh(name)
    mesh, numerics = box.meshes[own], rig.case.numerics
    pinion, wheel = rig.mesh_gears(name)
    gears = box.gears[mesh.pinion], box.gears[mesh.wheel]
    return (
        name,
        rig.coarsening.slices,
        rig.pairs[name],
        rig.mesh_stiffness,
        rig.tooth_influence,
        numerics.slices_spur,
        numerics.slices_helical,
        rig.case.ambient.reference_temperature,
        tuple((gear.teeth, gear.flank, rig.materials[gear.material].expansion_coefficient) for gear in gears),
        (mesh.application_factor, mesh.low_load_factor, mesh.stiffness_factor, mesh.tooth_offset),
        mesh_phase(rig, name),
        axes_in_mesh(rig, name, coupling_state),
        rig.shaft_speed(gears[0].shaft, point.speed),
        coupling_state.gear_temperature[pinion],
        coupling_state.gear_temperature[wheel],
        coupling_state.centre_distance[name],
        coupling_state.axial_expansion[name],
        coupling_state.flank_approach.get(name, 0.0),
        coupling_state.mesh_torque[name],
    )


def law_key(law: MeshLaw) -> tuple[object, ...]:
    """What a mesh law is known by."""
    return tuple(
        (np.round(value, SAME_GAP) + 0.0).tobytes() if isinstance(value, np.ndarray) else value
        for value in law
    )


# The response behind a prediction: as in a check, but for points so slow that harmonic balance has too many harmonics
# below the highest mode, and for the number of harmonics of rigs with root gauges.
#
# An excitation that slow hardly moves the modes: the loop follows quasi-statically, as P1 takes its 100 rpm. Following
# it in time instead takes minutes and as a rule does not settle; it is what remains where friction leaves no
# quasi-static state. Loads that alternate with a shaft are left out there.

REACH = 1.5
"""Harmonics go up to this times the highest mode that counts (`dynamics.vibration.speed_sweep`)."""
GAUGE_HARMONICS = 192
"""Harmonics of the common mesh period of a rig with root gauges at least: the highest stress answers to their number
by some tenths of a per cent, which a mode that just counts or does not would change from rig to rig."""
FOLLOWED = 2.0
"""Times the harmonics that harmonic balance takes at most from which a point is quasi-static; nearer to them it is
followed in time, as in a check."""


def respond_at_any_speed(
    rig: Rig, circuit: LoadedCircuit, near: HarmonicSolution | None = None
) -> CurvePoint:
    """As `rigdesign.coupling.preloaded_loop.respond`, slow points quasi-static.

    Raises
    ------
    DynamicsNotConverged
        Neither harmonic balance nor time integration converges.
    """
    period = rig.case.numerics.response_period
    ports = port_model(circuit.system, laws_of(circuit.models))
    _, cell_angle = mesh_cells(ports, period, 0)
    cells_a_second = rig.drive_speed(circuit.point.speed) / cell_angle
    highest = highest_mode(ports, circuit.system.form, rig.highest_mode)
    if REACH * highest <= FOLLOWED * MOST_HARMONICS * cells_a_second:
        return respond(rig, circuit, near, GAUGE_HARMONICS if rig.strain_gauges else LEAST_HARMONICS)
    try:
        return _quasi_static(rig, circuit)
    except DynamicsNotConverged:
        return respond(rig, circuit, near)


def _quasi_static(rig: Rig, circuit: LoadedCircuit) -> CurvePoint:
    """Raises DynamicsNotConverged where an angle has no state, as when friction reverses at the pitch point."""
    setting = circuit.bracing
    controlled = setting.mode == "torque_controlled"
    return quasi_static_point(
        circuit.system,
        periodic_laws(rig, shifted_laws(rig, circuit.models, setting)),
        rig.pinion_speed(circuit.point.speed),
        LoopLoad(
            torque=signed_torque(rig, circuit.point) if controlled else None,
            twist=None if controlled else setting.twist,
        ),
        circuit.drags,
        rig.case.numerics.response_period,
    )


AT_ANY_SPEED = replace(SOLVED, response=respond_at_any_speed)
"""Parts of an iteration, every one solved in full, with that response."""
