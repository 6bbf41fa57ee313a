"""What is measured on the rig at rest, at the reference temperature: natural frequencies by hammer, backlash by hand.

The loop stands braced with its first torque, its journals on the shells: no film, no friction of rotation. The teeth
carry by that torque alone, so that the mesh is as stiff as the pairs it presses together, mean over the places where
the teeth may have come to rest. Shafts that bend stand on what their bearings are at rest: a journal in the contact
with its shell and the oil squeezed out of it, as `dynamics.rotor.journal` has it, rolling elements under
their load.

A natural frequency is asked for by the number of its torsional mode, ``3`` or ``torsional 3``, or by the name of any
mode, ``lateral test_pinion 1`` (`dynamics.rotor.damped_modes`).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import pi

import numpy as np

from dynamics.rotor.damped_modes import NamedMode, elastic_named_modes, torsional_modes
from dynamics.rotor.graph import assemble
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.static_loop import LoopLoad, port_model, solve_static
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_force import evaluate_mesh
from dynamics.tooth.mesh_laws import alike_teeth
from rigdesign.base.errors import UsageError
from rigdesign.base.part_name import MeshName
from rigdesign.coupling.iteration import SOLVED, IterationParts, initial_state
from rigdesign.coupling.preloaded_loop import LoadedCircuit, brace_initial, shifted_laws, signed_torque
from rigdesign.coupling.state import OperatingPoint
from rigdesign.prediction.model import Channel
from rigdesign.rig.model import Rig

HIGHEST_FREQUENCY = 20e3
"""Natural frequencies are counted up to here [Hz]."""
NAMED = 6
"""Modes that a message names at most."""


def standing_value(rig: Rig, channel: Channel, modes: Sequence[NamedMode] | None = None) -> float:
    """Natural frequency [Hz] or circumferential backlash on the working pitch circle [m] of the rig at rest.

    modes : `standing_modes`, where they are known

    Raises
    ------
    UsageError
        A natural frequency that the rig does not have, a mesh that the case does not have, another quantity.
    NotConverged
        The standstill torque leaves the flanks open.
    """
    if channel.quantity == "backlash":
        return assembly_backlash(rig, channel.place)
    if channel.quantity != "natural_frequency":
        raise UsageError(f"channel {channel.name!r}: {channel.quantity} is not measured on the rig at rest")
    modes = standing_modes(rig) if modes is None else modes
    return mode_frequency(channel, modes)


def mode_frequency(channel: Channel, modes: Sequence[NamedMode]) -> float:
    """Frequency [Hz] of the mode that a channel names; UsageError where there is none of that name."""
    wanted = f"torsional {int(channel.place)}" if channel.place.isdecimal() else channel.place
    for mode in modes:
        if mode.name == wanted:
            return mode.frequency
    count = sum(mode.name.startswith("torsional ") for mode in modes)
    others = [mode.name for mode in modes if not mode.name.startswith("torsional ")][:NAMED]
    named = f"; other modes are {', '.join(others)}, ..." if others else ""
    raise UsageError(
        f"channel {channel.name!r}: place = {channel.place!r}: torsional natural frequencies at rest are counted from "
        f"1 to {count}{named}"
    )


def assembly_backlash(rig: Rig, mesh: str) -> float:
    """Circumferential backlash of a mesh at the temperature of the drawings [m]; UsageError for an unknown mesh."""
    name = MeshName.read(mesh)
    if name not in rig.pairs:
        raise UsageError(f"backlash of {mesh!r}: no such mesh; the case has {', '.join(rig.pairs)}")
    return rig.pairs[name].transverse_backlash


def standing_modes(rig: Rig, point: OperatingPoint | None = None) -> tuple[NamedMode, ...]:
    """Oscillating modes of the braced loop at rest, by rising frequency; point : as `rig_at_rest`.

    Raises UsageError for a case without drivetrain.
    """
    return modes_at_rest(rig, rig_at_rest(rig, point=point))


@dataclass(frozen=True, kw_only=True)
class RigAtRest:
    """The rig at rest under its first torque: its meshes, all teeth alike, and the matrices of its power circuit."""

    point: OperatingPoint
    laws: tuple[MeshLaw, ...]
    system: LinearSystem


def rig_at_rest(rig: Rig, parts: IterationParts = SOLVED, point: OperatingPoint | None = None) -> RigAtRest:
    """What the modes at rest depend on.

    parts : solve meshes, bearings and matrices; point : torque that braces the loop, and speed at which shafts that
        bend run in their films, in the initial state of the case; the standstill torque at rest when left out

    Raises UsageError for a case without drivetrain.
    """
    if rig.case.drivetrain is None:
        raise UsageError("natural frequencies need the drivetrain, which this case leaves out")
    if point is None:
        point = OperatingPoint(stage="standstill", speed=0.0, torque=standstill_torque(rig))
    initial = initial_state(rig, point, parts.bearings)
    models = parts.models(rig, point, initial)
    system = rig.system
    if rig.shaft_model == "elastic":
        system = parts.system(rig, point, initial, parts.bearings(rig, point, initial))
    bracing = brace_initial(rig, point, initial, models, system)
    laws = tuple(alike_teeth(law) for law in shifted_laws(rig, models, bracing))
    return RigAtRest(point=point, laws=laws, system=system)


def modes_at_rest(rig: Rig, rest: RigAtRest) -> tuple[NamedMode, ...]:
    """Oscillating modes by rising frequency, meshes as stiff in the mean as the standstill torque makes them."""
    laws, twisting = standing_laws(rig, rest), _undragged(rig)
    if rig.shaft_model == "torsional":
        return torsional_modes(twisting, laws, HIGHEST_FREQUENCY)
    seen = rig.elastic.seen
    system = replace(rest.system, damping=rest.system.damping - seen.drag)
    return elastic_named_modes(seen, system, laws, twisting, HIGHEST_FREQUENCY)


def twisting_modes(rig: Rig, rest: RigAtRest) -> tuple[NamedMode, ...]:
    """As `modes_at_rest` of the same rig with shafts that only twist, whatever its shafts do."""
    return torsional_modes(_undragged(rig), standing_laws(rig, rest), HIGHEST_FREQUENCY)


def _undragged(rig: Rig) -> LinearSystem:
    """The circuit with shafts that only twist, no drag in its bearings."""
    bearings = tuple(replace(bearing, linear_drag=0.0) for bearing in rig.drivetrain.bearings)
    return assemble(replace(rig.drivetrain, bearings=bearings))


def loaded_modes(rig: Rig, loop: LoadedCircuit) -> tuple[NamedMode, ...]:
    """Oscillating modes of the loop at an operating point, its bearings as they run there, by rising frequency."""
    laws = [alike_teeth(law) for law in shifted_laws(rig, loop.models, loop.bracing)]
    if rig.shaft_model == "torsional":
        return torsional_modes(loop.system, laws, HIGHEST_FREQUENCY)
    return elastic_named_modes(rig.elastic.seen, loop.system, laws, rig.system, HIGHEST_FREQUENCY)


def standing_laws(rig: Rig, rest: RigAtRest) -> list[MeshLaw]:
    """Mesh laws of the rig at rest with the mean stiffness that the standstill torque makes."""
    loop = port_model(rest.system, rest.laws)
    state = solve_static(loop, LoopLoad(torque=signed_torque(rig, rest.point)))
    found = []
    for m, (law, packed) in enumerate(zip(rest.laws, loop.packed)):
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


# Speeds at which an order meets a mode of the loop, as run-ups and run-downs show them.
#
# An order k of the reference gear has the frequency k n / 2 pi, so that it meets a mode of the frequency f at n = 2 pi
# f / k. Teeth are as stiff as the torque of the sweep presses them together. Modes of shafts that only twist do not
# depend on the speed. Those of shafts that bend do, by films and gyroscopic moments: they are those of the speed at
# which the loop that only twists meets the order, bearings in the initial state of the case. Oil films bring modes of
# their own, which cross the others as the speed rises; lateral modes in films have no name that stays and are refused.

ModesAt = Callable[[Rig, OperatingPoint | None], Sequence[NamedMode]]
"""Finds the modes of a rig at an operating point, at rest for None."""


def resonance_speed(rig: Rig, channel: Channel, modes_of: ModesAt = standing_modes) -> float:
    """Speed of the reference gear [rad/s] at which the order of a channel meets its mode.

    Raises
    ------
    UsageError
        A mode that the rig does not have, a lateral one in oil films, no order or several, a case without drivetrain.
    """
    if len(channel.orders) != 1 or not channel.orders[0] > 0.0:
        raise UsageError(
            f"channel {channel.name!r}: orders = {channel.orders}: a resonance speed is where one order above 0 meets "
            "a mode; name that order"
        )
    torque = standstill_torque(rig) if channel.torque is None else channel.torque
    at_rest = OperatingPoint(stage="sweep", speed=0.0, torque=torque)
    if rig.shaft_model == "torsional":
        return _crossing(channel, modes_of(rig, at_rest))
    twists = channel.place.isdecimal() or channel.place.startswith("torsional ")
    if not twists and _in_films(rig):
        raise UsageError(
            f"channel {channel.name!r}: place = {channel.place!r}: lateral modes in oil films change their numbers "
            "with the speed, so that no resonance speed belongs to one; name a torsional mode, or measure its natural "
            "frequency at rest"
        )
    modes = twisting_modes(rig, rig_at_rest(rig, point=at_rest)) if twists else modes_of(rig, at_rest)
    near = OperatingPoint(stage="sweep", speed=_crossing(channel, modes), torque=torque)
    return _crossing(channel, modes_of(rig, near))


def _crossing(channel: Channel, modes: Sequence[NamedMode]) -> float:
    """Speed [rad/s] at which the order of a channel meets its mode among some."""
    return 2.0 * pi * mode_frequency(channel, modes) / channel.orders[0]


def _in_films(rig: Rig) -> bool:
    """Whether journals run in films whose stiffness is computed."""
    power = rig.case.power_circuit
    return power.bearing_coefficients == "computed" and any(entry.has_film for _, _, entry in rig.bearings())
