"""What is measured on the rig at rest, at the reference temperature: natural frequencies by hammer, backlash by hand.

The loop stands braced with its first torque, its journals on the shells: no film, no friction of rotation. The teeth
carry by that torque alone, so that the mesh is as stiff as the pairs it presses together, mean over the places where
the teeth may have come to rest.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from dynamics.drivetrain.loop_load import LoopLoad
from dynamics.drivetrain.modes import LoopMode, loop_modes
from dynamics.drivetrain.static_loop import port_model, solve_static
from dynamics.mesh.flank import alike_teeth
from dynamics.mesh.force import evaluate_mesh
from dynamics.mesh.law import MeshLaw
from rigdesign.base.errors import UsageError
from rigdesign.coupling.braced_loop import brace_initial, shifted_laws, signed_torque
from rigdesign.coupling.initial_state import initial_state
from rigdesign.coupling.mesh_models import mesh_models
from rigdesign.coupling.state import OperatingPoint
from rigdesign.prediction.model import Channel
from rigdesign.rig.model import Rig

HIGHEST_FREQUENCY = 20e3
"""Natural frequencies are counted up to here [Hz]."""


def standing_value(rig: Rig, channel: Channel, modes: Sequence[LoopMode] | None = None) -> float:
    """Natural frequency [Hz] or circumferential backlash on the working pitch circle [m] of the rig at rest.

    modes : `standing_modes`, where they are known

    Raises
    ------
    UsageError
        A number beyond the natural frequencies, a mesh that the case does not have, another quantity.
    NotConverged
        The standstill torque leaves the flanks open.
    """
    if channel.quantity == "backlash":
        return assembly_backlash(rig, channel.place)
    if channel.quantity != "natural_frequency":
        raise UsageError(f"channel {channel.name!r}: {channel.quantity} is not measured on the rig at rest")
    modes = standing_modes(rig) if modes is None else modes
    number = int(channel.place) if channel.place.isdecimal() else 0
    if not 1 <= number <= len(modes):
        raise UsageError(
            f"channel {channel.name!r}: place = {channel.place!r}: natural frequencies at rest are counted from 1 to "
            f"{len(modes)}"
        )
    return modes[number - 1].frequency


def assembly_backlash(rig: Rig, mesh: str) -> float:
    """Circumferential backlash of a mesh at the temperature of the drawings [m]; UsageError for an unknown mesh."""
    if mesh not in rig.pairs:
        raise UsageError(f"backlash of {mesh!r}: no such mesh; the case has {', '.join(rig.pairs)}")
    return rig.pairs[mesh].transverse_backlash


def standing_modes(rig: Rig) -> tuple[LoopMode, ...]:
    """Oscillating modes of the braced loop at rest, by rising frequency.

    Raises UsageError for a case without drivetrain.
    """
    if rig.drivetrain is None:
        raise UsageError("natural frequencies need the drivetrain, which this case leaves out")
    drivetrain = replace(
        rig.drivetrain,
        bearings=tuple(replace(bearing, linear_drag=0.0) for bearing in rig.drivetrain.bearings),
    )
    modes = loop_modes(drivetrain, standing_laws(rig), HIGHEST_FREQUENCY)
    return tuple(mode for mode in modes if mode.frequency > 0.0)


def standing_laws(rig: Rig) -> list[MeshLaw]:
    """Mesh laws of the rig at rest with the mean stiffness that the standstill torque makes, all teeth alike."""
    assert rig.system is not None
    point = OperatingPoint(stage="standstill", speed=0.0, torque=standstill_torque(rig))
    initial = initial_state(rig, point)
    laws = [
        alike_teeth(law)
        for law in shifted_laws(rig, mesh_models(rig, point, initial), brace_initial(rig, point, initial))
    ]
    loop = port_model(rig.system, laws)
    state = solve_static(loop, LoopLoad(torque=signed_torque(rig, point)))
    found = []
    for m, (law, packed) in enumerate(zip(laws, loop.packed)):
        pinion = loop.pinions[m]
        angle = loop.ratios[pinion] * state.angles + state.ports[:, pinion]
        reaction = evaluate_mesh(packed, angle, state.approach[:, m], 0.0, 0.0)
        stiffness = -float(np.mean(reaction.torque_1_per_approach)) / law.base_radius_1
        found.append(law._replace(mean_stiffness=stiffness))
    return found


def standstill_torque(rig: Rig) -> float:
    """Bracing torque at rest: end of the first stage that loads, else the least that a ramp wants, else the test's."""
    for stage in rig.case.schedule.resolved():
        if stage.kind == "load" and stage.torque_end:
            return stage.torque_end
    ramp = rig.case.limits.ramp.standstill_torque
    return rig.case.schedule.test_torque if ramp is None else ramp
