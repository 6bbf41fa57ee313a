"""What the channels of a rig read of an iteration, the last one of a converged operating point above all."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.vibration.response_curve import CurvePoint
from rigdesign.base.errors import UsageError
from rigdesign.base.part_name import MeshName, PartName
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.mesh_models import MeshModel
from rigdesign.coupling.state import LEAST_TORQUE
from rigdesign.postprocessing.loaded_contact import HeldContact, held_flanks, kept_contact, stress_at
from rigdesign.prediction.model import LATERAL_QUANTITIES, ORDER_QUANTITIES, STANDING_QUANTITIES, Channel
from rigdesign.prediction.order_motion import is_ideal, shaft_orders
from rigdesign.prediction.places import lateral_motion, place_weights
from rigdesign.rig.joints import bearing_of_bore, shell_temperature
from rigdesign.rig.model import Rig
from rigdesign.rig.strain_gauges import RootGauge
from rigdesign.strain_gauge.turn_average import curve_windows
from thermal.conduction.capacity import StoredHeat
from thermal.expansion.alignment import SealExpansion

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
        PartName(box, seal.name): seal
        for box, model in rig.models.items()
        if not model.no_expansion
        for seal in model.seals
    }
    found = [name for name in stations if channel.place in (name, name.part)]
    if len(found) != 1:
        raise UsageError(
            f"channel {channel.name!r}: {channel.place!r} is not one seal of this case; it has "
            f"{', '.join(stations) or 'none'}"
        )
    box, own = found[0].both
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


# What a root gauge reads at an operating point: the loaded contact under the mesh torque as it passes its tooth.
#
# The stress of the quasi-static contact under the mean torque, on influence numbers and with the axes of the warm rig,
# is multiplied at every angle by the torque of the mesh over its mean at the time at which the tooth of the gauge is
# there, mean over the turns that the periodic response holds. Left out: that a dynamic load evens out face and pairs,
# deviations of single teeth within the contact (a response over a turn has them in the torque, one over a mesh does
# not), friction forces on the flank, centrifugal strain, and a second mesh of the same gear.

Array = NDArray[np.float64]
Index = Literal[0, 1]
TURN = 2.0 * np.pi
POSITIONS = 192
"""Positions of the contact over a base pitch: three times those of a check, as differences of curves with steep edges
are read."""
SAMPLES = 2048
"""Samples of a turn on which a low-pass acts."""


@dataclass(frozen=True, kw_only=True)
class StrainCurve:
    """Indicated strain of a gauge over the way of its tooth through the mesh.

    angle : (n,) of its gear in the order of time, zero at the pitch point, increasing [rad]; strain : (n,) [-]
    """

    angle: Array
    strain: Array


def root_strain(rig: Rig, channel: Channel) -> Callable[[Rig, IterationResult], tuple[float, ...]]:
    """How a channel of a root gauge is read.

    Raises UsageError for a gauge that the rig does not have, and for a rig without drivetrain.
    """
    known = rig.strain_gauges
    if channel.place not in known:
        raise UsageError(
            f"channel {channel.name!r}: {channel.place!r} is no strain gauge of this case; it has "
            f"{', '.join(known) or 'none'}"
        )
    if rig.case.drivetrain is None:
        raise UsageError(
            f"channel {channel.name!r}: root_strain needs the drivetrain, which this case leaves out"
        )

    def read(here: Rig, done: IterationResult) -> tuple[float, ...]:
        gauge = here.strain_gauges[channel.place]
        curve = strain_curve(here, done, channel.place)
        pitch = TURN / here.case.gearboxes[gauge.gear.gearbox].gears[gauge.gear.part].teeth
        found = curve_windows(curve.angle, curve.strain, pitch)
        return tuple(found[window] for window in channel.windows)

    return read


def strain_curve(rig: Rig, done: IterationResult, place: str) -> StrainCurve:
    """Indicated strain of a gauge, ``gearbox.gear.gauge``, at an operating point.

    Raises UsageError for an operating point at which its mesh carries no torque.
    """
    gauge = rig.strain_gauges[place]
    number, index = _mesh_of(rig, gauge)
    response = done.response
    assert response is not None
    torque = abs(float(response.mean[number]))
    if torque < LEAST_TORQUE:
        raise UsageError(
            f"root strain at {place}: its mesh carries {torque:.3g} N m at {done.point.stage!r}, at least "
            f"{LEAST_TORQUE:g} N m are needed; leave the point or the gauge out"
        )
    contact = _contact(rig, done, number, torque)
    flank = contact.flanks.flank
    cold = contact.cold
    still = stress_at(gauge, contact.cycle, contact.gears[index], cold, index, flank)
    sense = -1.0 if index else 1.0
    path = sense * cold.base_radii[index] * still.angle
    stress = still.stress * torque_share(done.models[number], response, number, (gauge.tooth, index), path)
    # contact runs to the tip of the gear that drives, to the root of the driven one
    turned = sense * (1.0 if flank == "front" else -1.0)
    order = np.argsort(turned * still.angle)
    point = gauge.point
    strain = point.strain_factor * np.asarray(point.surface.strain(stress))[order]
    curve = StrainCurve(angle=(turned * still.angle)[order], strain=strain)
    return _lagged(curve, _response_time(rig, gauge) * _gear_speed(rig, done, gauge))


def torque_share(
    model: MeshModel, response: CurvePoint, mesh: int, tooth: tuple[int, Index], path: Array
) -> Array:
    """(n,) torque of a mesh over its mean while the pair of one tooth is at path positions (n,) [m].

    tooth : its number, on the pinion (0) or the wheel (1); mean over the times it passes in the period of the response
    """
    law = model.law
    number, index = tooth
    front = bool(response.flank[mesh] > 0)
    pair = number if index == 0 else number - law.tooth_offset_2 - (0 if front else 1)
    teeth = (law.teeth_1, law.teeth_2)[index]
    wave = response.wave
    angle, torque = wave.angle[mesh], np.abs(wave.torque[mesh])
    pitch = TURN / law.teeth_1
    step = float(angle[-1] - angle[0]) / (len(angle) - 1)
    period = pitch * round((float(angle[-1] - angle[0]) + step) / pitch)
    passes = max(1, round(period / (pitch * teeth)))
    pairs = pair + teeth * np.arange(passes)[:, None]
    along = (
        path + law.base_pitch * pairs - law.phase if front else law.back_phase - path + law.base_pitch * pairs
    )
    share = np.interp(along / law.base_radius_1, angle, torque, period=period)
    return np.asarray(share.mean(axis=0) / abs(float(response.mean[mesh])))


def _mesh_of(rig: Rig, gauge: RootGauge) -> tuple[int, Index]:
    """Number of the first mesh of the gear of a gauge, and whether it is its pinion (0) or wheel (1)."""
    own, side = rig.case.gearboxes[gauge.gear.gearbox].first_meshes()[gauge.gear.part]
    return rig.mesh_names.index(MeshName(gauge.gear.gearbox, own)), 1 if side else 0


def _contact(rig: Rig, done: IterationResult, number: int, torque: float) -> HeldContact:
    """Loaded contact of a mesh under its mean torque, shared by all gauges that ask for it."""
    point = PointResult(point=done.point, last=done, setting=done.bracing, residuals=())
    flanks = held_flanks(rig, point, number)
    return kept_contact(
        HeldContact(
            cold=rig.pairs[rig.mesh_names[number]],
            flanks=flanks,
            force=torque / done.models[number].halves / flanks.pair.base_radii[0],
            influence=rig.tooth_influence,
            positions=POSITIONS,
        )
    )


def _response_time(rig: Rig, gauge: RootGauge) -> float:
    """Time constant of the measuring chain of a gauge [s]."""
    gear = rig.case.gearboxes[gauge.gear.gearbox].gears[gauge.gear.part]
    return gear.strain_gauges[gauge.name].response_time


def _gear_speed(rig: Rig, done: IterationResult, gauge: RootGauge) -> float:
    """Speed of its gear [rad/s]."""
    gear = rig.case.gearboxes[gauge.gear.gearbox].gears[gauge.gear.part]
    return rig.shaft_speed(gear.shaft, done.point.speed)


def _lagged(curve: StrainCurve, lag: float) -> StrainCurve:
    """The curve through a first-order low-pass whose time constant is an angle of the gear [rad]."""
    if not lag:
        return curve
    first = 0.5 * float(curve.angle[0] + curve.angle[-1]) - 0.5 * TURN
    angle = first + TURN / SAMPLES * np.arange(SAMPLES, dtype=np.float64)
    strain = np.interp(angle, curve.angle, curve.strain, left=0.0, right=0.0)
    gain = 1.0 / (1.0 + 1j * lag * np.arange(SAMPLES // 2 + 1))
    passed = np.fft.irfft(np.fft.rfft(strain) * gain, SAMPLES)
    return StrainCurve(angle=np.asarray(angle, dtype=np.float64), strain=passed)
