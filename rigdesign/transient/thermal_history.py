"""Temperatures and clearances of every housing over the schedule and over what may end it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.coupling.alignment import Alignment, alignment
from rigdesign.coupling.boundary import BEARING_OIL, GEAR_OIL
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.temperatures import seat_means
from rigdesign.rig.model import Rig
from rigdesign.transient.branch import Branch
from rigdesign.transient.clearances import Clearances, clearances
from rigdesign.transient.heating import Heating
from rigdesign.transient.oil_power import OilHistory, OilPower, oil_power
from rigdesign.transient.phases import SCHEDULE, Phase, event_phases, schedule_phases
from rigdesign.transient.places import probes_of
from rigdesign.transient.soak import first_broken, soak_of
from rigdesign.transient.warm_up import Soak
from thermal.expansion.alignment import ShaftAxis
from thermal.expansion.many_fields import ExpansionBasis
from thermal.transient.history import InitialState, Observed, StepControl, TransientSolution, solve_transient

FloatArray = NDArray[np.float64]
FIRST_STEP = 0.5
"""First time step of a phase [s]."""
UNBOUND = 1e12
"""No limit of the time step [s] but its error."""


@dataclass(frozen=True, kw_only=True)
class TransientRun:
    """All branches of all housings."""

    branches: tuple[Branch, ...]
    soak: tuple[Soak, ...]
    power: tuple[OilPower, ...]
    """Heaters and cooler over every branch, of all gearboxes together."""
    missed: Mapping[str, float]
    """Gearbox -> temperature that the patterns of its expansion miss at most [K]."""

    def of(self, gearbox: str, name: str) -> Branch | None:
        """A branch by gearbox and event; None if it was not asked for."""
        return next((b for b in self.branches if (b.gearbox, b.name) == (gearbox, name)), None)


@dataclass(frozen=True)
class ThermalHistory:
    """Temperatures of a branch before its clearances are read."""

    name: str
    phases: tuple[Phase, ...]
    start: float
    solution: TransientSolution
    fields: list[NDArray[np.float32]]
    """(n_nodes,) at every time [K]."""
    ends: dict[int, tuple[FloatArray, dict[str, float]]]
    """Number of a phase -> field and volumes at its end [K]."""


def run_transient(
    rig: Rig, points: Sequence[PointResult], say: Callable[[str], None] = lambda message: None
) -> TransientRun:
    """March every housing through the schedule and its events; the rig begins at the temperature of the room.

    Losses and films are those of the coupled run with its warm clearances, interpolated between the operating
    points of the schedule; the oil leaves with what it has taken up.

    Raises
    ------
    ConditionError
        Conditions that cannot be computed.
    NotConverged
        A time step or an expansion does not converge.
    """
    heating = Heating(rig, points)
    branches: list[Branch] = []
    soaks: list[Soak] = []
    missed: dict[str, float] = {}
    for name in rig.models:
        histories = _histories(rig, heating, name, say)
        say(f"expanding {name} over {sum(len(h.fields) for h in histories)} times")
        own, missed[name] = _read(rig, heating, name, histories)
        by_name = {branch.name: branch for branch in own}

        def trial(step: int, name: str = name, histories: list[ThermalHistory] = histories) -> bool:
            say(f"{name}: warm-up of {histories[0].solution.times[step] / 3600.0:.2f} h")
            (tried,), _ = _read(rig, heating, name, [_after_warm_up(rig, heating, name, histories[0], step)])
            return first_broken(rig.case, tried) is None

        soaks.append(soak_of(rig.case, by_name[SCHEDULE], by_name.get("cold_start"), trial))
        branches += own
    names = dict.fromkeys(branch.name for branch in branches)
    power = [oil_power(rig, heating, [_oil_history(b) for b in branches if b.name == name]) for name in names]
    return TransientRun(branches=tuple(branches), soak=tuple(soaks), power=tuple(power), missed=missed)


def _oil_history(branch: Branch) -> OilHistory:
    return OilHistory(
        gearbox=branch.gearbox,
        name=branch.name,
        phases=branch.phases,
        start=branch.start,
        times=branch.times,
        phase=branch.phase,
        outlets={kind: branch.temperatures[f"{kind}_outlet"] for kind in (GEAR_OIL, BEARING_OIL)},
        from_rest=branch.start == 0.0,
    )


def _read(
    rig: Rig, heating: Heating, name: str, histories: Sequence[ThermalHistory]
) -> tuple[list[Branch], float]:
    """Clearances of the histories of one housing, and what the patterns of their expansion miss [K]."""
    fields = [np.asarray(field, dtype=np.float64) for history in histories for field in history.fields]
    basis = ExpansionBasis.of(rig.expansion[name], rig.case.ambient.reference_temperature, fields)
    return [read_branch(rig, heating, name, history, basis) for history in histories], basis.missed


def _after_warm_up(
    rig: Rig, heating: Heating, name: str, planned: ThermalHistory, step: int
) -> ThermalHistory:
    """The running phases up to the last dwell, begun at a time step of the warm-up."""
    phases = planned.phases[1:]
    last = max(i for i, phase in enumerate(phases) if phase.held)
    field = np.asarray(planned.fields[step], dtype=np.float64)
    return march(rig, heating, name, "shorter_warm_up", phases[: last + 1], WarmStart(field))


def _histories(rig: Rig, heating: Heating, name: str, say: Callable[[str], None]) -> list[ThermalHistory]:
    phases = schedule_phases(rig.case)
    say(f"{name} over the schedule: {', '.join(phase.name for phase in phases)}")
    planned = march(rig, heating, name, SCHEDULE, phases)
    number = max(i for i, phase in enumerate(phases) if phase.held)
    field, volumes = planned.ends[number]
    stopped = sum(phase.duration for phase in phases[: number + 1])
    histories = [planned]
    for event in rig.case.transient.events:
        say(f"{name}: {event.replace('_', ' ')}")
        own = event_phases(rig.case, event, phases[number])
        if event == "cold_start":
            histories.append(march(rig, heating, name, event, own))
        else:
            histories.append(march(rig, heating, name, event, own, WarmStart(field, volumes, stopped)))
    return histories


@dataclass(frozen=True)
class WarmStart:
    """State of one housing from which a history goes on."""

    field: FloatArray
    """(n_nodes,) [K]"""
    volumes: Mapping[str, float] | None = None
    """Oil volume -> temperature [K]; None where they follow from the field."""
    time: float = 0.0
    """In the schedule [s]."""


def march(
    rig: Rig,
    heating: Heating,
    name: str,
    event: str,
    phases: tuple[Phase, ...],
    start: WarmStart | None = None,
) -> ThermalHistory:
    """Temperatures of the housing of gearbox ``name`` over ``phases``.

    event : name of the history; start : the rig at the temperature of the room when left out

    Raises
    ------
    ConditionError
        Conditions that cannot be computed.
    NotConverged
        A time step does not converge.
    """
    setup = rig.conduction[name]
    materials = rig.body_materials(name)
    fields: list[NDArray[np.float32]] = []
    ends: dict[int, tuple[FloatArray, dict[str, float]]] = {}
    limits = np.cumsum([phase.duration for phase in phases])

    def keep(time: float, field: FloatArray, fluids: Mapping[str, float]) -> None:
        fields.append(field.astype(np.float32))
        for number in np.flatnonzero(np.isclose(limits, time, rtol=1e-12, atol=1e-9)).tolist():
            ends[number] = field, dict(fluids)

    solution = solve_transient(
        setup,
        {body: material.density * material.heat_capacity for body, material in materials.items()},
        [heating.stage(name, phase) for phase in phases],
        InitialState(
            temperature=rig.case.ambient.temperature if start is None else start.field,
            volumes=None if start is None else start.volumes,
        ),
        observed=Observed(probes=probes_of(rig, name), at=None, observer=keep),
        steps=StepControl(tolerance=rig.case.transient.tolerance, first=FIRST_STEP, largest=UNBOUND),
    )
    return ThermalHistory(event, phases, 0.0 if start is None else start.time, solution, fields, ends)


def read_branch(
    rig: Rig, heating: Heating, name: str, history: ThermalHistory, basis: ExpansionBasis
) -> Branch:
    """Clearances and alignment of a history at every time."""
    solution = history.solution
    begins = np.concatenate([[0.0], np.cumsum([phase.duration for phase in history.phases])])
    read: list[Clearances] = []
    aligned: list[Alignment] = []
    axes: list[Mapping[str, ShaftAxis]] = []
    for time, number, field in zip(solution.times, solution.stages, history.fields, strict=True):
        phase = history.phases[number]
        since = min(float(time - begins[number]), phase.duration)
        speed = phase.speed(since)
        temperature = np.asarray(field, dtype=np.float64)
        shape = basis.shape(temperature)
        seated = heating.seated_bearings(name, phase, since, seat_means(rig, name, temperature))
        read.append(clearances(rig, name, temperature, shape, speed, seated))
        aligned.append(alignment(rig, name, shape, read[-1]["bearing_clearance"]))
        axes.append(shape.axes)
    return Branch(
        gearbox=name,
        name=history.name,
        phases=history.phases,
        start=history.start,
        times=solution.times + history.start,
        phase=solution.stages,
        temperatures=solution.probes,
        clearances=tuple(read),
        alignment=tuple(aligned),
        axes=tuple(axes),
        energy_closure=solution.energy.closure,
        warnings=solution.warnings,
    )
