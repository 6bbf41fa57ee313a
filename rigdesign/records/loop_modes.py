"""Natural modes of the closed loop at a held point or another speed, with its bearings as they run there."""

from dynamics.drivetrain.modes import LoopMode, loop_modes
from dynamics.elastic_rig.mode_shapes import elastic_loop_modes
from dynamics.elastic_rig.running_state import RunningState
from dynamics.response.modal_model import DEFAULT_CUTOFF
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.loop_system import running_state
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.records.loop_states import state_at
from rigdesign.rig.model import Rig


def held_modes(rig: Rig, held: PointResult) -> tuple[LoopMode, ...]:
    """Modes up to the highest that is followed: rigid rotation first, then by frequency."""
    return warm_modes(rig, held.last)


def warm_modes(rig: Rig, last: IterationResult) -> tuple[LoopMode, ...]:
    """As `held_modes`, of the last iteration at a point."""
    twists = rig.shaft_model == "torsional"
    state = None if twists else running_state(rig, last.point, last.coupling_state, last.bearings)
    return _modes(rig, last, state)


def modes_at(rig: Rig, held: PointResult, speed: float) -> tuple[LoopMode, ...]:
    """As `held_modes`, with the bearings as they run at a stated speed [rad/s] under the torque of the held point."""
    return _modes(rig, held.last, state_at(rig, held, speed).state)


def _modes(rig: Rig, last: IterationResult, state: RunningState | None) -> tuple[LoopMode, ...]:
    assert rig.drivetrain is not None
    laws = laws_of(last.models)
    if state is None:
        return loop_modes(rig.drivetrain, laws, DEFAULT_CUTOFF)
    return elastic_loop_modes(rig.elastic.seen, state, laws, DEFAULT_CUTOFF)
