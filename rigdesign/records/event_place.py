"""The solved rig where an event happens: its loop, drags and channels, and what is kept of a march."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dynamics.bearing.lateral import LateralCoefficients
from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.twist_rows import TorqueSection
from dynamics.mesh.law import MeshLaw
from dynamics.response.event_channels import Channel, Watched, bearing_channels, torque_channels
from dynamics.response.event_march import (
    EventHistory,
    EventMarch,
)
from dynamics.response.initial_state import pinion_ratios
from dynamics.response.periodic_response import TimeSettings
from dynamics.response.steady_start import SteadyStart, steady_start
from rigdesign.case.events import Event
from rigdesign.coupling.bearing_films import solve_bearings
from rigdesign.coupling.bearing_loads import bearing_loads
from rigdesign.coupling.braced_loop import BracingState, shifted_laws, signed_torque
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.loop_system import bearing_coefficients, loop_system, running_state
from rigdesign.coupling.mesh_models import mesh_models
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.coupling.time_run import DRAG_SHARES, drags_at
from rigdesign.coupling.tooth_deviations import periodic_laws
from rigdesign.coupling.twist_rows import twist_rows_of
from rigdesign.records.event_journals import LINEAR_FILMS, journal_channels, largest_travels, travel_warnings
from rigdesign.records.run_torques import shear_stress
from rigdesign.results.events import EventCurve, EventPeak, EventRecord, Quantity, Reversal
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]

CONTROLLED = BracingState(mode="torque_controlled")
SLOTS = 400
"""Slots of time of a curve."""
QUANTITIES: dict[str, Quantity] = {
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
        found: dict[tuple[str, Quantity], EventPeak] = {}
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


def _peak(place: str, quantity: Quantity, before: float, amount: Array, time: Array) -> EventPeak:
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
    place: str, quantity: Quantity, least: Array, greatest: Array, slots: Sequence[NDArray[np.int64]]
) -> EventCurve:
    return EventCurve(
        place=place,
        quantity=quantity,
        least=[float(least[slot].min()) for slot in slots],
        greatest=[float(greatest[slot].max()) for slot in slots],
    )
