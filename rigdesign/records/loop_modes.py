"""Natural modes of the closed loop at a held point, with its bearings as they run."""

from dynamics.drivetrain.modes import LoopMode, loop_modes
from dynamics.elastic_rig.mode_shapes import elastic_loop_modes
from dynamics.response.modal_model import DEFAULT_CUTOFF
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.loop_system import running_state
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.rig.model import Rig


def held_modes(rig: Rig, held: PointResult) -> tuple[LoopMode, ...]:
    """Modes up to the highest that is followed: rigid rotation first, then by frequency."""
    assert rig.drivetrain is not None
    last, laws = held.last, laws_of(held.last.models)
    if rig.shaft_model == "torsional":
        return loop_modes(rig.drivetrain, laws, DEFAULT_CUTOFF)
    state = running_state(rig, held.point, last.coupling_state, last.bearings)
    return elastic_loop_modes(rig.elastic.seen, state, laws, DEFAULT_CUTOFF)
