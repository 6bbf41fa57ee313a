"""Temperatures and clearances of every housing over the schedule and over what may end it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.errors import NotConvergedError
from rigdesign.coupling.alignment import Alignment, alignment
from rigdesign.coupling.housing_context import BEARING_FILM, BEARING_OIL, GEAR_OIL
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.temperatures import seat_means
from rigdesign.oil_circuit.state import CircuitState
from rigdesign.rig.model import Rig
from rigdesign.transient.heating import Heating
from rigdesign.transient.oil import seated_bearings
from rigdesign.transient.oil_power import OilHistory, OilPower, oil_power, stream_heats
from rigdesign.transient.oil_supply import (
    MOST_SWEEPS,
    SWEEP_TOLERANCE,
    Secants,
    SupplyHistory,
    circuits_over,
    first_guess,
    start_states,
)
from rigdesign.transient.phases import SCHEDULE, Phase, event_phases, schedule_phases
from rigdesign.transient.soak import Branch, Clearances, Soak, clearances, first_broken, soak_of
from thermal.expansion.alignment import ShaftAxis
from thermal.expansion.expansion import ExpansionBasis
from thermal.transient.history import (
    InitialState,
    Observed,
    Probe,
    StepControl,
    TransientSolution,
    solve_transient,
)

# Temperatures of one housing over one branch of the thermal history, marched with given supply temperatures.

FloatArray = NDArray[np.float64]
FIRST_STEP = 0.5
"""First time step of a phase [s]."""
UNBOUND = 1e12
"""No limit of the time step [s] but its error."""


@dataclass(frozen=True)
class WarmStart:
    """State of one housing from which a history goes on."""

    field: FloatArray
    """(n_nodes,) [K]"""
    volumes: Mapping[str, float] | None = None
    """Oil volume -> temperature [K]; None where they follow from the field."""


@dataclass(frozen=True, kw_only=True)
class BranchPlan:
    """What the rig goes through in one branch of the thermal history."""

    name: str
    """``schedule`` or the event."""
    phases: tuple[Phase, ...]
    start: float = 0.0
    """Since the start of the schedule [s]."""
    housings: Mapping[str, WarmStart] = field(default_factory=dict)
    """Gearbox -> its state at the start; at the temperature of the room when left out."""


@dataclass(frozen=True, kw_only=True)
class Marching:
    """How exact the time steps are, and how the oil is fed.

    tolerance : local error of a time step [K]
    supply : what the oil circuits do; None without circuits
    """

    tolerance: float
    supply: SupplyHistory | None = None


@dataclass(frozen=True, kw_only=True)
class ThermalHistory:
    """Temperatures of a branch before its clearances are read."""

    gearbox: str
    plan: BranchPlan
    solution: TransientSolution
    fields: list[NDArray[np.float32]]
    """(n_nodes,) at every time [K]."""
    ends: dict[int, WarmStart]
    """Number of a phase -> its state at its end."""

    @property
    def oil(self) -> OilHistory:
        """The outlets of its oil."""
        solution, plan = self.solution, self.plan
        return OilHistory(
            gearbox=self.gearbox,
            name=plan.name,
            phases=plan.phases,
            start=plan.start,
            times=solution.times + plan.start,
            phase=solution.stages,
            outlets={kind: solution.probes[f"{kind}_outlet"] for kind in (GEAR_OIL, BEARING_OIL)},
            from_rest=plan.start == 0.0,
        )


def march(rig: Rig, heating: Heating, name: str, plan: BranchPlan, how: Marching) -> ThermalHistory:
    """Temperatures of the housing of gearbox ``name`` over a branch.

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
    ends: dict[int, WarmStart] = {}
    limits = np.cumsum([phase.duration for phase in plan.phases])
    start = plan.housings.get(name)

    def keep(time: float, field: FloatArray, fluids: Mapping[str, float]) -> None:
        fields.append(field.astype(np.float32))
        for number in np.flatnonzero(np.isclose(limits, time, rtol=1e-12, atol=1e-9)).tolist():
            ends[number] = WarmStart(field, dict(fluids))

    solution = solve_transient(
        setup,
        {body: material.density * material.heat_capacity for body, material in materials.items()},
        [
            heating.stage(name, phase, float(end) - phase.duration, how.supply)
            for phase, end in zip(plan.phases, plan.start + limits)
        ],
        InitialState(
            temperature=rig.case.ambient.temperature if start is None else start.field,
            volumes=None if start is None else start.volumes,
        ),
        observed=Observed(probes=probes_of(rig, name), at=None, observer=keep),
        steps=StepControl(tolerance=how.tolerance, first=FIRST_STEP, largest=UNBOUND),
    )
    return ThermalHistory(gearbox=name, plan=plan, solution=solution, fields=fields, ends=ends)


# Places of a housing whose temperatures are kept over time.


def probes_of(rig: Rig, name: str) -> list[Probe]:
    """Every body by its mean, the hottest place of the housing, oil outlets, bearing films, and those of the case."""
    box = rig.case.gearboxes[name]
    fed = box.fed_bearings is not None
    films = list(box.bearings) if fed else seated_bearings(rig, name)
    probes = [
        *(Probe(name=body, place=body) for body in rig.models[name].mesh.bodies),
        Probe(name="housing_max", place="housing", quantity="max"),
        Probe(name="gear_oil_outlet", place=GEAR_OIL),
        Probe(name="bearing_oil_outlet", place=BEARING_OIL if fed else GEAR_OIL),
        *(Probe(name=f"film_outlet_{part}", place=f"{BEARING_FILM}:{part}") for part in films),
    ]
    taken = {probe.name for probe in probes}
    return probes + [
        Probe(name=f"probe_{key}" if key in taken else key, place=entry.place, quantity=entry.quantity)
        for key, entry in rig.case.transient.probes.items()
        if entry.gearbox == name
    ]


# One branch of the thermal history: housings and oil circuits in turn, until their supply temperatures agree.

FIRST_CHANGE = 20.0
"""Size by which supply temperatures may move in the first sweep [K]."""
STEP_SHARE = 0.2
"""Error of a time step as a share of what the supply temperatures moved by in the sweep before."""


@dataclass(frozen=True, kw_only=True)
class BranchHistories:
    """One branch of all housings and oil circuits."""

    plan: BranchPlan
    housings: Mapping[str, ThermalHistory]
    """By gearbox."""
    supply: SupplyHistory | None
    """Of the oil circuits; None without any."""
    power: OilPower


def branch_histories(
    rig: Rig,
    heating: Heating,
    plan: BranchPlan,
    circuits: Mapping[str, CircuitState],
    say: Callable[[str], None] = lambda message: None,
) -> BranchHistories:
    """March every housing, and with them the oil circuits, over one branch.

    circuits : at its start

    Raises
    ------
    ConditionError
        Conditions that cannot be computed.
    NotConvergedError
        A time step does not converge, or housings and circuits do not come to agree.
    """
    case = rig.case
    if not circuits:
        housings = _housings(rig, heating, plan, Marching(tolerance=case.transient.tolerance), say)
        heats = stream_heats(rig, heating, [each.oil for each in housings.values()])
        power = oil_power(case, plan.name, heats)
        return BranchHistories(plan=plan, housings=housings, supply=None, power=power)
    fed, secants, change = first_guess(rig, circuits), Secants(), FIRST_CHANGE
    for sweep in range(1, MOST_SWEEPS + 1):
        # while the supplies still move a lot, steps need not be more exact than that
        tolerance = max(case.transient.tolerance, STEP_SHARE * change)
        housings = _housings(rig, heating, plan, Marching(tolerance=tolerance, supply=fed), say)
        heats = stream_heats(rig, heating, [each.oil for each in housings.values()], fed)
        supply = circuits_over(circuits, heats, heating.answers)
        change = supply.change(fed)
        say(f"oil circuits, sweep {sweep}: supply temperatures move by {change:.2g} K")
        if change <= SWEEP_TOLERANCE and tolerance == case.transient.tolerance:
            power = oil_power(case, plan.name, heats, supply)
            return BranchHistories(plan=plan, housings=housings, supply=supply, power=power)
        fed = secants.following(fed, supply)
    raise NotConvergedError(
        f"oil circuits over {plan.name}: supply temperatures still move by {change:.3g} K after {MOST_SWEEPS} sweeps, "
        f"limit {SWEEP_TOLERANCE:g} K; give the tanks more oil or the consumers less flow"
    )


def _housings(
    rig: Rig, heating: Heating, plan: BranchPlan, how: Marching, say: Callable[[str], None]
) -> dict[str, ThermalHistory]:
    histories = {}
    for name in rig.models:
        say(f"{name} over {plan.name.replace('_', ' ')}: {', '.join(phase.name for phase in plan.phases)}")
        histories[name] = march(rig, heating, name, plan, how)
    return histories


SHORTER = "shorter_warm_up"
"""Name of a branch with less warm-up than the case plans."""


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
    by_branch = _branches(rig, heating, say)
    branches: list[Branch] = []
    soaks: list[Soak] = []
    missed: dict[str, float] = {}
    for name in rig.models:
        histories = [each.housings[name] for each in by_branch.values()]
        say(f"expanding {name} over {sum(len(h.fields) for h in histories)} times")
        housing_branches, missed[name] = _read(rig, heating, name, histories)
        by_name = {branch.name: branch for branch in housing_branches}

        def trial(step: int, planned: ThermalHistory = histories[0]) -> bool:
            say(f"{planned.gearbox}: warm-up of {planned.solution.times[step] / 3600.0:.2f} h")
            shorter = _after_warm_up(rig, heating, planned, step, by_branch[SCHEDULE].supply)
            (tried,), _ = _read(rig, heating, planned.gearbox, [shorter])
            return first_broken(rig.case, tried) is None

        soaks.append(soak_of(rig.case, by_name[SCHEDULE], by_name.get("cold_start"), trial))
        branches += housing_branches
    power = tuple(each.power for each in by_branch.values())
    return TransientRun(branches=tuple(branches), soak=tuple(soaks), power=power, missed=missed)


def _branches(rig: Rig, heating: Heating, say: Callable[[str], None]) -> dict[str, BranchHistories]:
    """The schedule, and what follows every event, by name."""
    cold: Mapping[str, CircuitState] = start_states(rig)
    phases = schedule_phases(rig.case)
    planned = branch_histories(rig, heating, BranchPlan(name=SCHEDULE, phases=phases), cold, say)
    by_branch = {SCHEDULE: planned}
    number = max(i for i, phase in enumerate(phases) if phase.held)
    stopped = sum(phase.duration for phase in phases[: number + 1])
    for event in rig.case.transient.events:
        following = event_phases(rig.case, event, phases[number])
        if event == "cold_start":
            plan, circuits = BranchPlan(name=event, phases=following), cold
        else:
            warm = {name: history.ends[number] for name, history in planned.housings.items()}
            plan = BranchPlan(name=event, phases=following, start=stopped, housings=warm)
            circuits = {} if planned.supply is None else planned.supply.states_at(stopped)
        by_branch[event] = branch_histories(rig, heating, plan, circuits, say)
    return by_branch


def _read(
    rig: Rig, heating: Heating, name: str, histories: Sequence[ThermalHistory]
) -> tuple[list[Branch], float]:
    """Clearances of the histories of one housing, and what the patterns of their expansion miss [K]."""
    fields = [np.asarray(field, dtype=np.float64) for history in histories for field in history.fields]
    basis = ExpansionBasis.of(rig.expansion[name], rig.case.ambient.reference_temperature, fields)
    return [read_branch(rig, heating, name, history, basis) for history in histories], basis.missed


def _after_warm_up(
    rig: Rig, heating: Heating, planned: ThermalHistory, step: int, supply: SupplyHistory | None
) -> ThermalHistory:
    """The running phases up to the last dwell, begun at a time step of the warm-up.

    supply : of the planned schedule; the tank goes on to warm up as it does there
    """
    phases = planned.plan.phases[1:]
    last = max(i for i, phase in enumerate(phases) if phase.held)
    field = np.asarray(planned.fields[step], dtype=np.float64)
    plan = BranchPlan(
        name=SHORTER,
        phases=phases[: last + 1],
        start=float(planned.solution.times[step]),
        housings={planned.gearbox: WarmStart(field)},
    )
    how = Marching(tolerance=rig.case.transient.tolerance, supply=supply)
    return march(rig, heating, planned.gearbox, plan, how)


def read_branch(
    rig: Rig, heating: Heating, name: str, history: ThermalHistory, basis: ExpansionBasis
) -> Branch:
    """Clearances and alignment of a history at every time."""
    solution, plan = history.solution, history.plan
    begins = np.concatenate([[0.0], np.cumsum([phase.duration for phase in plan.phases])])
    read: list[Clearances] = []
    aligned: list[Alignment] = []
    axes: list[Mapping[str, ShaftAxis]] = []
    for time, number, nodal in zip(solution.times, solution.stages, history.fields, strict=True):
        phase = plan.phases[number]
        since = min(float(time - begins[number]), phase.duration)
        speed = phase.speed(since)
        temperature = np.asarray(nodal, dtype=np.float64)
        shape = basis.shape(temperature)
        seated = heating.seated_bearings(name, phase, since, seat_means(rig, name, temperature))
        read.append(clearances(rig, name, temperature, shape, speed, seated))
        aligned.append(alignment(rig, name, shape, read[-1]["bearing_clearance"]))
        axes.append(shape.axes)
    return Branch(
        gearbox=name,
        name=plan.name,
        phases=plan.phases,
        start=plan.start,
        times=solution.times + plan.start,
        phase=solution.stages,
        temperatures=solution.probes,
        clearances=tuple(read),
        alignment=tuple(aligned),
        axes=tuple(axes),
        energy_closure=solution.energy.closure,
        warnings=solution.warnings,
    )
