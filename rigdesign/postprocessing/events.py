"""Events of a case on its solved rig: marches from the steady state at the speed and torque of each."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.bearing import LateralCoefficients
from dynamics.rotor.craig_bampton import SeenRig
from dynamics.rotor.graph import TorqueSection
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.static_loop import LoopLoad
from dynamics.tooth.law import MeshLaw
from dynamics.vibration.event_march import (
    Brake,
    Channel,
    EventHistory,
    EventMarch,
    SteadyStart,
    Trip,
    Watched,
    bearing_channels,
    steady_start,
    time_to_standstill,
    torque_channels,
    without_teeth,
)
from dynamics.vibration.initial_state import pinion_ratios
from dynamics.vibration.speed_sweep import SweepSettings, periodic_response
from dynamics.vibration.steady_motion import TimeSettings
from rigdesign.case.events import EmergencyStop, Event, Overspeed, ToothLoss
from rigdesign.coupling.bearing_loads import bearing_loads, solve_bearings
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.loop_system import bearing_coefficients, loop_system, running_state, twist_rows_of
from rigdesign.coupling.mesh_models import mesh_models
from rigdesign.coupling.preloaded_loop import (
    BracingState,
    lines_left_out,
    loads_left_out,
    periodic_laws,
    shifted_laws,
    signed_torque,
)
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.coupling.time_run import DRAG_SHARES, drags_at
from rigdesign.postprocessing.curves import LEAST_GAIN, held_modes
from rigdesign.postprocessing.dynamics import DynamicRun
from rigdesign.postprocessing.passing_peaks import passing_peaks
from rigdesign.postprocessing.run_torques import shear_stress
from rigdesign.results.loads import EventCurve, EventPeak, EventRecord, Load, Reversal
from rigdesign.rig.model import Rig

# The solved rig where an event happens: its loop, drags and channels, and what is kept of a march.

# Journals in an event: do their films still hold where the linear coefficients send them?
#
# A march has every film as stiffness and damping about the place of the journal under the load before the event. Where
# the load vanishes or turns round, a film is softer than that towards the bore centre and far stiffer near
# its wall; the forces of such an event are those of the linear film. How far the journal goes is compared with its
# clearance.

Array = NDArray[np.float64]

LINEAR_FILMS = (
    "films of plain bearings are linearised about the journal position before the event; where the load vanishes or "
    "reverses they are too stiff near the bore centre and too soft near the bore wall"
)
"""What of films an event leaves out, for its notes."""


def journal_channels(seen: SeenRig, films: Sequence[str]) -> tuple[Channel, ...]:
    """Travel along y and z [m] of journals in films, ``gearbox.bearing``, against their seats: two channels each."""
    found = []
    for name in films:
        rows = seen.on_freedoms(seen.reduced.model.ports[name])[:2]
        found += [
            Channel(place=name, kind="journal travel", angle=row[None], speed=np.zeros_like(row[None]))
            for row in rows
        ]
    return tuple(found)


def largest_travels(
    channels: Sequence[Channel], history: EventHistory, coefficients: Mapping[str, LateralCoefficients]
) -> dict[str, float]:
    """Largest distance of every journal from the middle of its bore [m], by ``gearbox.bearing``.

    Its place under the load before the event, and what the march moves it from there.

    channels : those of ``history``; coefficients : of every bearing before the event
    """
    moved: dict[str, list[Array]] = {}
    for channel, values, before in zip(channels, history.values, history.before, strict=True):
        if channel.kind == "journal travel":
            moved.setdefault(channel.place, []).append(values - before)
    return {
        name: float(np.hypot(*(place[:, None] + np.array(way))).max())
        for name, way in moved.items()
        for place in [np.asarray(coefficients[name].position)]
    }


def travel_warnings(rig: Rig, travels: Mapping[str, float], clearances: Mapping[str, float]) -> Iterator[str]:
    """Of every journal that would pass its clearance: the film is stiffer than the linear one.

    clearances : on the diameter as they run, by ``gearbox.bearing`` [m]
    """
    for name, travel in travels.items():
        limit = 0.5 * clearances[name]
        if rig.bearing(name).has_film and travel > limit and math.isfinite(travel):
            yield (
                f"bearing {name}: journal displacement {1e6 * travel:.0f} um exceeds the radial clearance "
                f"{1e6 * limit:.0f} um: the linear film is too soft there; treat the force as a lower bound, or lower "
                "the torque of the event"
            )


CONTROLLED = BracingState(mode="torque_controlled")
SLOTS = 400
"""Slots of time of a curve."""
QUANTITIES: dict[str, Load] = {
    "coupling": "coupling torque", "shaft": "shaft torque", "spline": "seat torque", "bearing": "bearing force"
}  # fmt: skip


@dataclass(frozen=True)
class EventPlace:
    """Rig at the operating point of an event."""

    name: str
    kind: str
    rig: Rig
    warm: IterationResult
    point: OperatingPoint
    coupling_state: CouplingState
    system: LinearSystem
    laws: Sequence[MeshLaw]
    channels: tuple[Channel, ...]
    drags: dict[str, float]
    films: Mapping[str, LateralCoefficients]
    """Of the bearings with a film, where their journals are watched."""

    @classmethod
    def of(cls, rig: Rig, test: PointResult, name: str, event: Event) -> "EventPlace":
        """The rig at the speed and torque of an event, else at those of the test."""
        schedule = rig.case.schedule
        speed = schedule.test_speed if event.speed is None else event.speed
        torque = schedule.test_torque if event.torque is None else event.torque
        point = OperatingPoint(stage=name, speed=speed, torque=torque)
        state = test.last.coupling_state.with_torque_share(torque / test.point.torque)
        bearings = solve_bearings(rig, point, state)
        system = loop_system(rig, point, state, bearings)
        channels = torque_channels(twist_rows_of(rig, speed))
        films: dict[str, LateralCoefficients] = {}
        if rig.shaft_model != "torsional":
            running = running_state(rig, point, state, bearings)
            found = bearing_coefficients(rig, state, bearings)
            films = {name: found[name] for name, _, entry in rig.bearings() if entry.has_film}
            channels += bearing_channels(rig.elastic.seen, system, running)
            channels += journal_channels(rig.elastic.seen, list(films))
        laws = periodic_laws(rig, shifted_laws(rig, mesh_models(rig, point, state), CONTROLLED))
        drags = drags_at(rig, test.last, state, speed)
        return cls(name, event.kind, rig, test.last, point, state, system, laws, channels, drags, films)

    @property
    def pinion_speed(self) -> float:
        """[rad/s]"""
        return self.rig.pinion_speed(self.point.speed)

    @property
    def drive_speed(self) -> float:
        """[rad/s]"""
        return self.rig.drive_speed(self.point.speed)

    def march(self) -> EventMarch:
        """From the steady state on."""
        return EventMarch(self.system, self.laws, self.start, Watched(self.channels), self.rig.highest_mode)

    @cached_property
    def start(self) -> SteadyStart:
        """Steady state before the event."""
        settings = TimeSettings(period=self.rig.case.numerics.response_period, cutoff=self.rig.highest_mode)
        torque = signed_torque(self.rig, self.point)
        return steady_start(self.system, self.laws, self.pinion_speed, torque, self.drags, settings)

    @property
    def notes(self) -> tuple[str, ...]:
        """Loads that the period of the steady state does not hold, and doubts about it."""
        start = self.start
        settled: tuple[str, ...] = ()
        if start.settled:
            settled = (
                f"{', '.join(start.settled)}: the period of the steady state holds no whole waves of it; brought up "
                f"during {start.settling:.3g} s before the event",
            )
        return (*settled, *start.doubts)

    def drag(self, drive_speed: float) -> float:
        """Torque on the motor of all drags at a speed of it [N m]; of linear bearing drag as well."""
        shares, torques = self._drags_over_speed
        ratios = self._ratios
        linear = float(ratios @ self.system.damping @ ratios) * drive_speed
        return linear + float(np.interp(drive_speed / self.drive_speed, shares, torques))

    @cached_property
    def _ratios(self) -> Array:
        """(n,) speed of each freedom per speed of the drive."""
        ratios = pinion_ratios(self.system, self.laws)
        return np.asarray(ratios / ratios[self.system.drive_dof])

    @cached_property
    def _drags_over_speed(self) -> tuple[Array, Array]:
        """Shares of the speed and torque of the drags on the motor there [N m]."""
        torques = []
        for share in DRAG_SHARES:
            found = drags_at(self.rig, self.warm, self.coupling_state, share * self.point.speed)
            torques.append(
                -sum(float(self.system.drag_loads[k] @ self._ratios) * max(v, 0.0) for k, v in found.items())
            )
        return np.array(DRAG_SHARES), np.array(torques)

    def record(self, what: str, history: EventHistory) -> EventRecord:
        """Peaks and curves of a march."""
        couplings = [i for i, channel in enumerate(self.channels) if channel.kind == "coupling"]
        slots = np.array_split(np.arange(history.time.size), min(SLOTS, history.time.size))
        return EventRecord(
            name=self.name,
            kind=self.kind,
            speed=self.point.speed,
            torque=self.point.torque,
            what=what,
            peaks=tuple(self._peaks(history)),
            reversals=tuple(self._reversals(history)),
            tripped=history.tripped,
            notes=(*self.notes, *self._journals(history)),
            time=[float(history.time[slot[-1]]) for slot in slots],
            curves=(
                *(
                    _curve(
                        self.channels[i].place, "coupling torque", history.values[i], history.values[i], slots
                    )
                    for i in couplings
                ),
                *(
                    _curve(name, "mesh torque", history.least[m], history.greatest[m], slots)
                    for m, name in enumerate(self.rig.mesh_names)
                ),
            ),
        )

    def _journals(self, history: EventHistory) -> Iterator[str]:
        if self.films:
            travels = largest_travels(self.channels, history, self.films)
            yield LINEAR_FILMS
            yield from travel_warnings(self.rig, travels, self.coupling_state.bearing_clearance)

    def _peaks(self, history: EventHistory) -> Iterator[EventPeak]:
        meshes = tuple(self._peaks_of_meshes(history))
        yield from meshes
        found: dict[tuple[str, Load], EventPeak] = {}
        for i, channel in enumerate(self.channels):
            if channel.kind not in QUANTITIES:
                continue
            place, quantity = channel.place, QUANTITIES[channel.kind]
            peak = _peak(place, quantity, float(history.before[i]), np.abs(history.values[i]), history.time)
            if (place, quantity) not in found or peak.peak > found[place, quantity].peak:
                found[place, quantity] = _at_section(peak, channel.section)
        yield from sorted(found.values(), key=lambda peak: list(QUANTITIES.values()).index(peak.quantity))
        if self.rig.shaft_model == "torsional":
            yield from self._static_bearings(meshes)

    def _static_bearings(self, meshes: Sequence[EventPeak]) -> Iterator[EventPeak]:
        """Forces of shafts that only twist: their static ones times peak over mean of the meshes on the shaft.

        meshes : peaks of all of them
        """
        loads = bearing_loads(self.rig, self.coupling_state)
        for name, _, entry in self.rig.bearings():
            own = [
                peak
                for m, peak in enumerate(meshes)
                if entry.shaft in (self.rig.mesh_gear(m, 0).shaft, self.rig.mesh_gear(m, 1).shaft)
            ]
            if own:
                worst = max(own, key=lambda peak: peak.peak / max(abs(peak.before), 1e-9))
                force = loads[name].radial
                yield EventPeak(
                    place=name, part=name, quantity="bearing force", before=force,
                    peak=force * worst.peak / max(abs(worst.before), 1e-9), time=worst.time,
                )  # fmt: skip

    def _peaks_of_meshes(self, history: EventHistory) -> Iterator[EventPeak]:
        for m, name in enumerate(self.rig.mesh_names):
            amount = np.maximum(np.abs(history.least[m]), np.abs(history.greatest[m]))
            yield _peak(name, "mesh torque", float(history.before_torque[m]), amount, history.time)

    def _reversals(self, history: EventHistory) -> Iterator[Reversal]:
        for m, name in enumerate(self.rig.mesh_names):
            other = -history.least[m] if history.before_torque[m] > 0.0 else history.greatest[m]
            yield Reversal(
                mesh=name,
                open_share=float(history.open_share[m]),
                other_flank=max(float(other.max()), 0.0),
            )


def _peak(place: str, quantity: Load, before: float, amount: Array, time: Array) -> EventPeak:
    at = int(amount.argmax())
    return EventPeak(
        place=place,
        part=place,
        quantity=quantity,
        before=before,
        peak=float(amount[at]),
        time=float(time[at]),
    )


def _at_section(peak: EventPeak, section: TorqueSection | None) -> EventPeak:
    """The same with what a record says of a section."""
    if section is None:
        return peak
    return replace(peak, part=section.part, shear_stress=shear_stress(section, peak.peak))


def _curve(
    place: str, quantity: Load, least: Array, greatest: Array, slots: Sequence[NDArray[np.int64]]
) -> EventCurve:
    return EventCurve(
        place=place,
        quantity=quantity,
        least=[float(least[slot].min()) for slot in slots],
        greatest=[float(greatest[slot].max()) for slot in slots],
    )


OVERSPEED_TIME, OVERSPEED_TURNS = 0.02, 2.0
"""Time of the steady rotation at overspeed in which peaks are sought [s], and turns of the slowest shaft; the longer
of both."""
ORDERS = 3
"""Orders of a mesh frequency whose crossings with a mode count as resonances."""
RPM = math.pi / 30.0


def solve_events(rig: Rig, run: DynamicRun) -> tuple[EventRecord, ...]:
    """Every event of the case, with the gears and films of the test as warm as they are there.

    run : with the responses over speed that a stop passes during run-down
    Raises DynamicsNotConverged if a march leaves the finite numbers.
    """
    return tuple(_solved(rig, run, name, event) for name, event in rig.case.events.items())


def _solved(rig: Rig, run: DynamicRun, name: str, event: Event) -> EventRecord:
    place = EventPlace.of(rig, run.test, name, event)
    if isinstance(event, Overspeed):
        return _overspeed(place, run.test)
    if isinstance(event, EmergencyStop):
        return _emergency_stop(place, run, event)
    return _tooth_loss(place, event)


def _tooth_loss(place: EventPlace, event: ToothLoss) -> EventRecord:
    march, mesh = place.march(), place.rig.mesh_names.index(event.mesh)
    teeth = march.carrying_teeth(mesh, event.gear, event.teeth)
    laws = [without_teeth(own, event.gear, teeth) if m == mesh else own for m, own in enumerate(place.laws)]
    trip, notes = _trip(place, event)
    brake = Brake(torque=event.brake_torque)
    history = march.run(event.duration, laws=laws, trip=trip, brake=brake)
    record = place.record(
        f"{event.teeth} {'tooth' if event.teeth == 1 else 'adjacent teeth'} of the {event.gear} of {event.mesh} lost",
        history,
    )
    if trip is not None and history.tripped is None:
        notes = (
            *notes,
            f"the monitor does not trip within the {event.duration:g} s for which the event is followed",
        )
        record = replace(record, untripped=event.duration)
    standstill = None
    if history.tripped is not None:
        standstill = event.trip_delay + time_to_standstill(
            place.system, place.laws, place.drive_speed, brake, place.drag
        )
    return replace(record, standstill=standstill, notes=(*record.notes, *notes))


def _trip(place: EventPlace, event: ToothLoss) -> tuple[Trip | None, tuple[str, ...]]:
    """The monitor; none where shafts that only twist show no velocity of a journal."""
    if event.monitor is None:
        return None, ()
    watched = Watched(place.channels)
    if event.trip_torque is not None:
        channel = watched.index(event.monitor.rpartition(".")[2], "coupling")
        return Trip(channel=channel, limit=event.trip_torque, delay=event.trip_delay), ()
    assert event.trip_velocity is not None
    _, box, _, bearing = event.monitor.split(".")
    if place.rig.shaft_model == "torsional":
        return None, ("shafts that only twist show no velocity of a journal: the monitor is left out",)
    channel = watched.index(f"{box}.{bearing}", "journal velocity")
    return Trip(channel=channel, limit=event.trip_velocity, delay=event.trip_delay), ()


def _emergency_stop(place: EventPlace, run: DynamicRun, event: EmergencyStop) -> EventRecord:
    torque = event.brake_torque
    if torque is None:
        assert event.stop_time is not None
        torque = _brake_torque(place, event.stop_time, event.brake_onset)
    brake = Brake(torque=torque, onset=event.brake_onset)
    history = place.march().run(event.duration, trip=Trip(channel=None), brake=brake)
    record = place.record(f"brake torque {torque:.3g} N m on the motor", history)
    standstill = time_to_standstill(place.system, place.laws, place.drive_speed, brake, place.drag)
    passed, notes = passing_peaks(place.rig, run, place.point)
    return replace(record, tripped=None, standstill=standstill, passing=passed, notes=(*record.notes, *notes))


def _brake_torque(place: EventPlace, stop_time: float, onset: float) -> float:
    """Brake torque with which the rig stands after a time [N m]; 0 where the drags alone are quicker."""

    def time(torque: float) -> float:
        brake = Brake(torque=torque, onset=onset)
        return time_to_standstill(place.system, place.laws, place.drive_speed, brake, place.drag)

    low, high = 0.0, 1.0
    while time(high) > stop_time:
        low, high = high, 2.0 * high
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if time(middle) > stop_time else (low, middle)
    return 0.5 * (low + high)


def _overspeed(place: EventPlace, test: PointResult) -> EventRecord:
    rig = place.rig
    speeds = [share * place.pinion_speed for share in (0.97, 1.0)]
    curve = periodic_response(
        place.system, place.laws, speeds, LoopLoad(torque=signed_torque(rig, place.point)), place.drags,
        SweepSettings(period=rig.case.numerics.response_period, cutoff=rig.highest_mode),
    )  # fmt: skip
    notes: tuple[str, ...] = tuple(reason for _, reason in curve.failed)
    missing = [*loads_left_out(rig, place.laws, place.system), *lines_left_out(rig, place.laws, place.system)]
    if missing:
        notes = (*notes, f"loads that the period of the response does not hold: {', '.join(missing)}")
    at = [point for point in curve.points if point.speed == speeds[-1]]
    factors: dict[str, float] = {
        name: float(p.dynamic_factor[m]) for p in at for m, name in enumerate(rig.mesh_names)
    }
    resonance, distance = _nearest_resonance(place, test)
    what = f"{place.point.speed / RPM:.0f} rpm, {place.point.speed / rig.case.schedule.test_speed:.3f} of the test"
    record = place.record(what, place.march().run(overspeed_time(rig, place.point.speed)))
    return replace(
        record,
        dynamic_factor=factors,
        resonance=resonance,
        resonance_distance=distance,
        notes=(*record.notes, *notes, "bursting of discs and rotors is not modelled"),
    )


def overspeed_time(rig: Rig, speed: float) -> float:
    """How long the steady rotation at a stated speed [rad/s] is marched [s]: what shakes once a turn of any shaft has
    shown its peak."""
    slowest = min(abs(rig.shaft_speed(shaft.name, speed)) for shaft in rig.drivetrain.shafts)
    return max(OVERSPEED_TIME, OVERSPEED_TURNS * 2.0 * math.pi / slowest)


def _nearest_resonance(place: EventPlace, test: PointResult) -> tuple[str, float | None]:
    """Mode of the closed loop that an order of a mesh meets nearest to the speed."""
    rig, found = place.rig, []
    for m, name in enumerate(rig.mesh_names):
        box, mesh = rig.mesh(name)
        pinion = box.gears[box.meshes[mesh].pinion]
        frequency = rig.shaft_speed(pinion.shaft, place.point.speed) * pinion.teeth / (2.0 * math.pi)
        for mode in held_modes(rig, test):
            if mode.frequency > 0.0 and mode.mesh_gain[m] >= LEAST_GAIN:
                for order in range(1, ORDERS + 1):
                    share = mode.frequency / (order * frequency)
                    text = (
                        f"{mode.name}, {mode.frequency:.0f} Hz, order {order} of mesh {name} at "
                        f"{share * place.point.speed / RPM:.0f} rpm"
                    )
                    found.append((abs(share - 1.0), text))
    if not found:
        return "", None
    distance, text = min(found)
    return text, distance
