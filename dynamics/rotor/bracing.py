"""Bracing of the power loop: twist or axial shift that makes the torque, and how it changes with temperature.

Three modes. *Twist held* (P1): two shafts are turned against each other and bolted. *Shift held*: the helical
gear of the reference gearbox is moved along its shaft and stays there. *Torque controlled* (P2): the shift
follows the torque. In a held mode every change of backlash, stiffness or axial position changes the torque.
"""

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError, DynamicsNotConverged
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.static_loop import (
    LoopLoad,
    PortModel,
    StaticState,
    loaded_share,
    port_model,
    solve_static,
)
from dynamics.tooth.law import MeshLaw

Array = NDArray[np.float64]
Mode = Literal["twist_held", "shift_held", "torque_controlled"]

OPEN_SHARE = 0.02
"""Share of the asked torque below which a setting counts as lost in the play: crowned flanks touch one by one."""


@dataclass(frozen=True, kw_only=True)
class ShiftedGear:
    """Helical gear that is moved along its axis to brace the loop.

    mesh : index of its mesh; helix_angle [rad] at the pitch cylinder; working_radius [m] of the shifted gear
    base_helix_angle [rad]; a shift s moves the flanks s tan(beta_b) along the transverse line of action
    halves : 2 for a double helical gear of which one half moves: each half carries half the torque, and
        a partner that floats axially follows by half the shift
    floating_partner : True if the mating double helical gear floats
    spline_friction, spline_radius : of the seat the gear slides on [-], [m]
    """

    mesh: int
    helix_angle: float
    base_helix_angle: float
    working_radius: float
    halves: int = 1
    floating_partner: bool = False
    spline_friction: float = 0.0
    spline_radius: float = 0.0

    def __post_init__(self) -> None:
        if self.helix_angle == 0.0:
            raise DynamicsInputError(
                "shifted gear: helix_angle = 0 rad: a spur gear braces nothing; use the twist"
            )
        if self.halves not in (1, 2):
            raise DynamicsInputError(f"shifted gear: halves = {self.halves}: must be 1 or 2; correct it")

    @property
    def approach_per_shift(self) -> float:
        """Approach along the transverse line of action per axial shift of the gear [-]."""
        share = 0.5 if self.halves == 2 and self.floating_partner else 1.0
        return share * math.tan(self.base_helix_angle)

    def rotation(self, shift: float) -> float:
        """Rotation of the loop by a shift [rad]: s tan(beta) / r_w, half of it with a floating partner."""
        share = 0.5 if self.halves == 2 and self.floating_partner else 1.0
        return share * shift * math.tan(self.helix_angle) / self.working_radius

    def actuator_force(self, torque: float) -> float:
        """Axial force on the moved half at a torque of this gear [N m], without friction [N]."""
        return abs(torque) / self.halves / self.working_radius * math.tan(abs(self.helix_angle))

    def friction_force(self, torque: float) -> float:
        """Force that the spline of the moved half holds back by friction [N]."""
        if self.spline_radius == 0.0:
            return 0.0
        return self.spline_friction * abs(torque) / self.halves / self.spline_radius


@dataclass(frozen=True, kw_only=True)
class LoopBracing:
    """How the loop is braced.

    mode : what is held or controlled
    gear : the one that is shifted; a controlled torque without one is made by the twist
    twist : of the assembled loop in the two modes with a shift [rad]; there the offset of the shifted mesh's law is
        the unknown
    control_mesh : index of the mesh whose torque is asked for

    Raises DynamicsInputError if a held shift has no gear.
    """

    mode: Mode
    gear: ShiftedGear | None = None
    twist: float = 0.0
    control_mesh: int = 0

    def __post_init__(self) -> None:
        if self.gear is None and self.mode == "shift_held":
            raise DynamicsInputError(
                f"bracing mode {self.mode!r}: needs the shifted helical gear; give it or use 'twist_held'"
            )

    @property
    def moved_gear(self) -> ShiftedGear | None:
        """Gear whose shift makes the torque; None where the twist makes it."""
        return None if self.mode == "twist_held" else self.gear


@dataclass(frozen=True, kw_only=True)
class BracedLoop:
    """Result of one stage.

    torque : (n_meshes,) mean torque at every pinion [N m]; twist [rad]; shift [m] of the gear, 0 without one
    rotation : of the loop that stands for the shift [rad]
    actuator_force, friction_force : on the moved half [N]; 0 where nothing is moved
    loop_stiffness : torque of the control mesh per twist (or per rotation by the shift) at this state [N
    m/rad]
    """

    mode: Mode
    torque: Array
    twist: float
    shift: float
    rotation: float
    actuator_force: float
    friction_force: float
    loop_stiffness: float
    static: StaticState


@dataclass(frozen=True, kw_only=True)
class BracingDrift:
    """The same setting in the initial state and warm; ``torque_change`` [N m] of the control mesh, 0 if controlled."""

    initial: BracedLoop
    warm: BracedLoop
    torque_change: float


def brace(system: LinearSystem, laws: Sequence[MeshLaw], torque: float, bracing: LoopBracing) -> BracedLoop:
    """Twist or shift that makes a mean torque at the pinion of the control mesh [N m], without friction.

    Raises DynamicsNotConverged if no setting makes the torque.
    """
    shift, state = braced_state(system, laws, torque, bracing)
    gear = bracing.moved_gear
    return _state(system, laws if gear is None else _shifted(laws, gear, shift), bracing, state, shift)


def braced_state(
    system: LinearSystem,
    laws: Sequence[MeshLaw],
    torque: float,
    bracing: LoopBracing,
    near: StaticState | None = None,
) -> tuple[float, StaticState]:
    """Shift [m], 0 where the twist makes the torque, and static state of a braced loop.

    near : state of a loop that differs little, to start from; arguments and errors else as of `brace`
    """
    load = LoopLoad(torque=torque, control_mesh=bracing.control_mesh)
    gear = bracing.moved_gear
    if gear is None:
        return 0.0, _static(port_model(system, laws), load, near)
    return _solve_shift(system, laws, load, gear, bracing.twist)


def drift(
    system: LinearSystem,
    initial_laws: Sequence[MeshLaw],
    warm_laws: Sequence[MeshLaw],
    torque: float,
    bracing: LoopBracing,
    axial_expansion: float = 0.0,
) -> BracingDrift:
    """Brace in the initial state, then warm up.

    Parameters
    ----------
    initial_laws, warm_laws : of every mesh when the loop is braced, and at temperature
    torque : asked of the control mesh [N m]
    axial_expansion : thermal expansion that moves the shifted gear [m]: the uncompensated one, of one half against
        the other; equal expansion of both halves is none

    Raises DynamicsNotConverged as `brace`. A warm setting that lies within the backlash carries nothing.
    """
    initial = brace(system, initial_laws, torque, bracing)
    if bracing.mode == "torque_controlled":
        warm = brace(system, warm_laws, torque, bracing)
        warm = replace(warm, shift=warm.shift - axial_expansion)
        return BracingDrift(initial=initial, warm=warm, torque_change=0.0)
    moved = initial.shift + axial_expansion
    laws = warm_laws if bracing.gear is None else _shifted(warm_laws, bracing.gear, moved)
    mesh = bracing.control_mesh
    try:
        state = solve_static(port_model(system, laws), LoopLoad(twist=initial.twist))
    except DynamicsNotConverged:
        if loaded_share(port_model(system, laws), torque, initial.twist, mesh) > OPEN_SHARE:
            raise
        state = _open_loop(initial.static)
    if float(np.abs(state.torque).max()) <= 1e-9 * abs(torque):
        state = _open_loop(state)
    warm = _state(system, laws, bracing, state, initial.shift)
    change = float(warm.torque[mesh] - initial.torque[mesh])
    return BracingDrift(initial=initial, warm=warm, torque_change=change)


def _static(model: PortModel, load: LoopLoad, near: StaticState | None) -> StaticState:
    """State from one nearby, where that leads there."""
    if near is not None:
        with suppress(DynamicsNotConverged):
            return solve_static(model, load, start=near)
    return solve_static(model, load)


def _open_loop(state: StaticState) -> StaticState:
    """No flank carries: the setting lies within the backlash."""
    return replace(state, torque=np.zeros_like(state.torque), drive=np.zeros_like(state.drive))


def _shifted(laws: Sequence[MeshLaw], gear: ShiftedGear, shift: float) -> tuple[MeshLaw, ...]:
    law = laws[gear.mesh]
    moved = law._replace(offset=law.offset + gear.approach_per_shift * shift)
    return (*laws[: gear.mesh], moved, *laws[gear.mesh + 1 :])


def _solve_shift(
    system: LinearSystem, laws: Sequence[MeshLaw], load: LoopLoad, gear: ShiftedGear, twist: float
) -> tuple[float, StaticState]:
    """Shift that needs no other twist than the one given.

    Twist and shift both only add to the windup of the loop: secant steps on the twist that the torque still
    needs.
    """
    per_shift = gear.rotation(1.0)
    shift, known = 0.0, solve_static(port_model(system, laws), load)
    excess = known.twist - twist
    scale = max(abs(excess), 1e-9)
    trial = excess / per_shift
    for _ in range(30):
        state = solve_static(port_model(system, _shifted(laws, gear, trial)), load)
        new_excess = state.twist - twist
        if abs(new_excess) < 1e-10 * scale:
            return trial, state
        derivative = (new_excess - excess) / (trial - shift)
        shift, excess = trial, new_excess
        trial = shift - excess / derivative
    raise DynamicsNotConverged(
        f"bracing by shift: twist left over = {excess:.3e} rad after 30 steps, limit {1e-10 * scale:.1e}; "
        "check the helix angle and the torque"
    )


def _state(
    system: LinearSystem, laws: Sequence[MeshLaw], bracing: LoopBracing, state: StaticState, shift: float
) -> BracedLoop:
    gear = bracing.moved_gear
    torque = state.mean_torque
    at_gear = 0.0
    if gear is not None:
        law = laws[gear.mesh]
        ratio = gear.working_radius * math.cos(_working_angle(law)) / law.base_radius_1
        at_gear = float(torque[gear.mesh]) * ratio
    return BracedLoop(
        mode=bracing.mode,
        torque=torque,
        twist=state.twist,
        shift=shift,
        rotation=0.0 if gear is None else gear.rotation(shift),
        actuator_force=0.0 if gear is None else gear.actuator_force(at_gear),
        friction_force=0.0 if gear is None else gear.friction_force(at_gear),
        loop_stiffness=_loop_stiffness(system, laws, state, bracing.control_mesh),
        static=state,
    )


def _working_angle(law: MeshLaw) -> float:
    """Working pressure angle from the base tangent points: tan alpha_wt = T1C / r_b1."""
    return math.atan2(law.rolling_radius_1, law.base_radius_1)


def _loop_stiffness(
    system: LinearSystem, laws: Sequence[MeshLaw], state: StaticState, control_mesh: int
) -> float:
    """Change of the torque per twist round this state, by a step of 1e-4 of the torque; 0 in open flanks."""
    torque = float(state.mean_torque[control_mesh])
    if torque == 0.0:
        return 0.0
    load = LoopLoad(torque=torque * (1.0 + 1e-4), control_mesh=control_mesh)
    stepped = solve_static(port_model(system, laws), load, start=state)
    return torque * 1e-4 / (stepped.twist - state.twist)
