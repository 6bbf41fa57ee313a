"""Speeds at which an order meets a mode of the loop, as run-ups and run-downs show them.

An order k of the reference gear has the frequency k n / 2 pi, so that it meets a mode of the frequency f at n = 2 pi f
/ k. Teeth are as stiff as the torque of the sweep presses them together. Modes of shafts that only twist do not depend
on the speed. Those of shafts that bend do, by films and gyroscopic moments: they are those of the speed at which the
loop that only twists meets the order, bearings in the initial state of the case. Oil films bring modes of their own,
which cross the others as the speed rises; lateral modes in films have no name that stays and are refused.
"""

from collections.abc import Callable, Sequence
from math import pi

from dynamics.elastic_rig.mode_names import NamedMode
from rigdesign.base.errors import UsageError
from rigdesign.coupling.state import OperatingPoint
from rigdesign.prediction.model import Channel
from rigdesign.prediction.static_tests import (
    mode_frequency,
    rig_at_rest,
    standing_modes,
    standstill_torque,
    twisting_modes,
)
from rigdesign.rig.model import Rig

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
    power = rig.case.drivetrain
    assert power is not None
    return power.bearing_coefficients == "computed" and any(entry.has_film for _, _, entry in rig.bearings())
