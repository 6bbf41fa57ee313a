"""Natural modes of the closed loop at a held point or another speed, with its bearings as they run there."""

from dynamics.drivetrain.modes import LoopMode, loop_modes
from dynamics.elastic_rig.mode_shapes import elastic_loop_modes
from dynamics.response.modal_model import DEFAULT_CUTOFF
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.records.loop_states import state_at
from rigdesign.rig.model import Rig


def held_modes(rig: Rig, held: PointResult) -> tuple[LoopMode, ...]:
    """Modes up to the highest that is followed: rigid rotation first, then by frequency."""
    return modes_at(rig, held, held.point.speed)


def modes_at(rig: Rig, held: PointResult, speed: float) -> tuple[LoopMode, ...]:
    """As `held_modes`, with the bearings as they run at a stated speed [rad/s] under the torque of the held point."""
    assert rig.drivetrain is not None
    laws = laws_of(held.last.models)
    state = state_at(rig, held, speed).state
    if state is None:
        return loop_modes(rig.drivetrain, laws, DEFAULT_CUTOFF)
    return elastic_loop_modes(rig.elastic.seen, state, laws, DEFAULT_CUTOFF)
