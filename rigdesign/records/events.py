"""Events of a case on its solved rig: marches from the steady state at the speed and torque of each."""

import math
from dataclasses import replace

from dynamics.drivetrain.loop_load import LoopLoad
from dynamics.response.event_channels import Watched
from dynamics.response.event_march import (
    Brake,
    Trip,
    time_to_standstill,
)
from dynamics.response.speed_sweep import SweepSettings, periodic_response
from dynamics.response.tooth_loss import without_teeth
from rigdesign.case.events import EmergencyStop, Event, Overspeed, ToothLoss
from rigdesign.coupling.braced_loop import signed_torque
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.periodic_loads import lines_left_out, loads_left_out
from rigdesign.records.curves import LEAST_GAIN
from rigdesign.records.dynamics import DynamicRun
from rigdesign.records.event_place import EventPlace
from rigdesign.records.loop_modes import held_modes
from rigdesign.records.passing_peaks import passing_peaks
from rigdesign.results.events import EventRecord
from rigdesign.rig.model import Rig

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
    factors = {name: float(p.dynamic_factor[m]) for p in at for m, name in enumerate(rig.mesh_names)}
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
    assert rig.drivetrain is not None
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
