"""What the channels of a rig read of an iteration, the last one of a converged operating point above all."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence

import numpy as np

from rigdesign.base.errors import UsageError
from rigdesign.coupling.iteration import IterationResult
from rigdesign.prediction.lateral_places import lateral_motion
from rigdesign.prediction.model import LATERAL_QUANTITIES, ORDER_QUANTITIES, STANDING_QUANTITIES, Channel
from rigdesign.prediction.order_motion import is_ideal
from rigdesign.prediction.orders import shaft_orders
from rigdesign.prediction.places import place_weights
from rigdesign.prediction.root_strain import root_strain
from rigdesign.rig.joints import bearing_of_bore, shell_temperature
from rigdesign.rig.model import Rig
from thermal.conduction.capacity import StoredHeat
from thermal.expansion.clearances import SealExpansion

Numbers = tuple[float, ...]
"""Numbers of one channel at one point, in the order of its features."""
Reading = Callable[[Rig, IterationResult], Numbers]
Readings = Sequence[tuple[Channel, Reading]]


def readings(rig: Rig, channels: Iterable[Channel]) -> list[tuple[Channel, Reading]]:
    """How every channel that stands at operating points is read, places found once.

    Raises
    ------
    UsageError
        A place the rig does not have, a quantity its case cannot give.
    """
    moving = [channel for channel in channels if channel.quantity not in STANDING_QUANTITIES]
    orders = _Orders([channel for channel in moving if channel.quantity in ORDER_QUANTITIES])
    return [(channel, _reading(rig, channel, orders)) for channel in moving]


def rate_rows(channels: Iterable[Channel]) -> dict[int, int]:
    """Number of the reading of every warming rate -> that of the temperature which changes.

    Raises
    ------
    UsageError
        A rate without that temperature among the channels.
    """
    moving = [channel for channel in channels if channel.quantity not in STANDING_QUANTITIES]
    starts = np.cumsum([0, *(count_of(channel) for channel in moving)]).tolist()
    row = dict(zip(moving, starts))
    temperatures = {(one.place, one.at): row[one] for one in moving if one.quantity == "temperature"}
    found = {}
    for channel in moving:
        if channel.quantity == "warming_rate":
            if (channel.place, channel.at) not in temperatures:
                raise UsageError(
                    f"channel {channel.name!r}: the temperature whose rate it is, at {channel.place!r}, is no channel"
                )
            found[row[channel]] = temperatures[channel.place, channel.at]
    return found


def count_of(channel: Channel) -> int:
    """How many numbers a channel gives at a point."""
    if channel.quantity == "root_strain":
        return len(channel.windows)
    return sum(2 if order else 1 for order in channel.orders) if channel.orders else 1


def _reading(rig: Rig, channel: Channel, orders: "_Orders") -> Reading:
    if channel.quantity in ORDER_QUANTITIES:
        return _in_orders(rig, channel, orders)
    match channel.quantity:
        case "temperature":
            return _temperature(rig, channel)
        case "warming_rate":
            return _warming_rate(rig, channel)
        case "oil_outlet_temperature":
            return _outlet(rig, channel)
        case "seal_gap":
            return _seal_gap(rig, channel)
        case "motor_power" | "drive_torque":
            return _drive(rig, channel)
        case "root_strain":
            return root_strain(rig, channel)
    raise UsageError(f"channel {channel.name!r}: quantity {channel.quantity!r} is not predicted")


def _temperature(rig: Rig, channel: Channel) -> Reading:
    name, (nodes, weights) = place_weights(rig, channel.place, channel.at)
    surface = channel.place.partition(".")[2]

    def body(_: Rig, done: IterationResult) -> Numbers:
        return (float(weights @ done.fields[name].temperature[nodes]),)

    def shell(rig: Rig, done: IterationResult) -> Numbers:
        (bore,) = body(rig, done)
        return (shell_temperature(surface, bore, done.fields[name].conditions),)

    return body if bearing_of_bore(rig.case.gearboxes[name], surface) is None else shell


def _warming_rate(rig: Rig, channel: Channel) -> Reading:
    """Change of a temperature with time [K/s] where bodies still take up heat; zero at a steady point."""
    name, (nodes, weights) = place_weights(rig, channel.place, channel.at)

    def read(_: Rig, done: IterationResult) -> Numbers:
        field = done.fields[name]
        steps = [one for one in field.conditions if isinstance(one, StoredHeat)]
        return (math.fsum(float(weights @ step.rate(field.temperature)[nodes]) for step in steps),)

    return read


def _outlet(rig: Rig, channel: Channel) -> Reading:
    known = [f"{box}.{kind}" for box in rig.case.gearboxes for kind in ("gear_oil", "bearing_oil")]
    if channel.place not in known:
        raise UsageError(
            f"channel {channel.name!r}: {channel.place!r} is no oil stream of this case; it has {', '.join(known)}"
        )
    return lambda _, done: (next(s.outlet for s in done.streams if s.name == channel.place),)


def _drive(rig: Rig, channel: Channel) -> Reading:
    if rig.case.drivetrain is None:
        raise UsageError(
            f"channel {channel.name!r}: {channel.quantity} needs the drivetrain, which this case leaves out"
        )

    def read(here: Rig, done: IterationResult) -> Numbers:
        assert done.response is not None
        torque = done.response.drive_torque
        if channel.quantity == "drive_torque":
            return (torque,)
        return (torque * here.drive_speed(done.point.speed),)

    return read


def _seal_gap(rig: Rig, channel: Channel) -> Reading:
    """Hot radial gap, mean over the length: at the angle of ``at``, of the whole circumference without."""
    stations = {
        f"{box}.{seal.name}": seal
        for box, model in rig.models.items()
        if not model.no_expansion
        for seal in model.seals
    }
    found = [name for name in stations if channel.place in (name, name.split(".", 1)[1])]
    if len(found) != 1:
        raise UsageError(
            f"channel {channel.name!r}: {channel.place!r} is not one seal of this case; it has "
            f"{', '.join(stations) or 'none'}"
        )
    box, own = found[0].split(".", 1)
    if channel.at is None:
        return lambda _, done: (_seals(done, box)[own].mean,)
    centre = stations[found[0]].centre
    angle = math.atan2(channel.at[2] - centre[2], channel.at[1] - centre[1])

    def read(_: Rig, done: IterationResult) -> Numbers:
        seal = _seals(done, box)[own]
        return (float(np.interp(angle, seal.angles, seal.gap, period=2.0 * math.pi)),)

    return read


def _seals(done: IterationResult, gearbox: str) -> Mapping[str, SealExpansion]:
    """Hot seals of a housing."""
    return done.expansion[gearbox].deformed.seals


class _Orders:
    """Complex orders of all channels that want them, found together for one iteration after the other."""

    def __init__(self, channels: Sequence[Channel]) -> None:
        self._channels = channels
        self._known: tuple[IterationResult, Mapping[tuple[str, float], complex]] | None = None

    def at(self, rig: Rig, done: IterationResult) -> Mapping[tuple[str, float], complex]:
        """(channel, order) -> amplitude."""
        if self._known is None or self._known[0] is not done:
            base = done.response if is_ideal(rig, done.loop) else None
            self._known = done, shaft_orders(rig, done.loop, self._channels, base=base)
        return self._known[1]


def _in_orders(rig: Rig, channel: Channel, orders: _Orders) -> Reading:
    if rig.case.drivetrain is None:
        raise UsageError(
            f"channel {channel.name!r}: {channel.quantity} needs the drivetrain, which this case leaves out"
        )
    if not channel.orders:
        raise UsageError(f"channel {channel.name!r}: {channel.quantity} is read by orders, and none is given")
    if channel.quantity in LATERAL_QUANTITIES:
        lateral_motion(rig, channel)

    def read(here: Rig, done: IterationResult) -> Numbers:
        found = orders.at(here, done)
        numbers: list[float] = []
        for order in channel.orders:
            value = complex(found[channel.name, order])
            numbers += [value.real, value.imag] if order else [value.real]
        return tuple(numbers)

    return read
