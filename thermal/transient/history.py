"""Temperatures over a schedule: stages of given duration, each with its own conditions.

The step follows the local error, the conditions may jump between stages and change smoothly inside of one.
What the conditions give is stored to 1e-8 of the heat turned over, or the run is refused.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from thermal.conditions.boundary import ConditionError
from thermal.conduction.balance import HeatBalance, held_by
from thermal.conduction.capacity import HeatCapacity
from thermal.conduction.setup import Condition, check_conditions
from thermal.conduction.steady import CLOSURE, ConductionSetup
from thermal.conduction.terms import OFF_REST, ConductionProblem
from thermal.errors import ThermalNotConverged
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import FloatArray, IndexArray
from thermal.transient.time_steps import STAGE_WEIGHTS, ProblemAt, Stepper, TimeStep, landing, next_length

# Named places whose temperature is kept over time.

Reader = Callable[[FloatArray, Mapping[str, float]], float]
"""Temperature [K] from the field (n_nodes,) and the volumes."""


@dataclass(frozen=True, kw_only=True)
class Probe:
    """A surface, body or volume by name, or the node nearest to a point."""

    name: str
    place: str | tuple[float, float, float]
    """Surface, body or volume; or x, y, z [m]."""
    quantity: Literal["mean", "max", "min"] = "mean"
    """Of a surface (area mean) or body (volume mean)."""


def reader(elements: FiniteElements, probe: Probe) -> Reader:
    """How a probe is read. A name that is no surface or body is taken for a volume when it is read."""
    mesh, place = elements.mesh, probe.place
    if not isinstance(place, str):
        node = int(np.linalg.norm(mesh.points - np.array(place), axis=1).argmin())
        return lambda temperature, volumes: float(temperature[node])
    if place in mesh.surfaces:
        surface = elements.surfaces[place]
        if probe.quantity == "mean":
            return lambda temperature, volumes: surface.mean(temperature)
        return _extreme(surface.nodes, probe.quantity)
    if place in mesh.bodies:
        if probe.quantity == "mean":
            share = elements.body_load(place)
            share = share / share.sum()
            return lambda temperature, volumes: float(share @ temperature)
        return _extreme(np.unique(mesh.cells[mesh.bodies[place]]), probe.quantity)
    return _of_volume(probe.name, place)


def _extreme(nodes: IndexArray, quantity: str) -> Reader:
    take = np.max if quantity == "max" else np.min
    return lambda temperature, volumes: float(take(temperature[nodes]))


def _of_volume(name: str, place: str) -> Reader:
    def read(temperature: FloatArray, volumes: Mapping[str, float]) -> float:
        if place not in volumes:
            raise ConditionError(
                f"probe {name!r}: {place!r} is no surface, body or volume; volumes here: "
                f"{', '.join(sorted(volumes)) or 'none'}"
            )
        return volumes[place]

    return read


# Energy over a time run: what every condition gave, what every body and volume stored.

ROUNDING = 1e-12
"""Share of the heat content above 0 K up to which energies are rounding."""

Place = int | str
"""A connected piece of the mesh by number, a volume by name."""


@dataclass(frozen=True)
class EnergyBalance:
    """Energies [J] since the start, positive into the solid or volume."""

    rows: Mapping[tuple[str, str], float]
    """(surface, body or volume; kind) -> energy."""
    stored: Mapping[str, float]
    """Body or volume -> energy taken up."""
    gaps: Mapping[Place, float]
    """What came in less what was stored, for each connected piece and each volume."""
    rounding: float
    """Turnover up to which no heat flows but by rounding."""

    @property
    def turnover(self) -> float:
        """Half the sum of the sizes of all rows and stored energies [J]."""
        parts = [*self.rows.values(), *self.stored.values()]
        return 0.5 * float(np.abs(parts).sum()) if parts else 0.0

    @property
    def closure(self) -> float:
        """Greatest gap relative to the turnover [-]; 0 where no heat flows but by rounding."""
        worst = max((abs(gap) for gap in self.gaps.values()), default=0.0)
        return worst / self.turnover if self.turnover > self.rounding else 0.0


class EnergyAccount:
    """Adds up energies step by step.

    capacity : body -> density times specific heat [J/(m3 K)]; level : of the temperatures [K]
    """

    def __init__(self, elements: FiniteElements, capacity: Mapping[str, float], level: float) -> None:
        self._elements = elements
        self._capacity = capacity
        self._rows: dict[tuple[str, str], float] = {}
        self._stored: dict[str, float] = {}
        self._gaps: dict[Place, float] = {}
        content = sum(capacity[body] * elements.volume(body) * level for body in elements.mesh.bodies)
        self._rounding = ROUNDING * content
        self._piece = {body: elements.components[cells] for body, cells in elements.mesh.bodies.items()}

    def book(self, balance: HeatBalance, duration: float) -> None:
        """Add the heats of ``balance`` [W] over ``duration`` [s]."""
        n_pieces = int(self._elements.components.max()) + 1
        for row in balance.rows:
            place = row.piece if row.piece < n_pieces else row.surface
            self.give(row.surface, row.kind, place, duration * row.power)

    def give(self, surface: str, kind: str, place: Place, energy: float) -> None:
        """Add one energy [J] that enters a piece or volume."""
        key = (surface, kind)
        self._rows[key] = self._rows.get(key, 0.0) + energy
        self._add(place, energy)

    def store(self, rise: FloatArray, volumes: Mapping[str, float]) -> None:
        """Add what the bodies take up when the nodes warm by ``rise`` (n_nodes,) [K], and volumes [J]."""
        for body, cells in self._elements.mesh.bodies.items():
            rises, weights = self._elements.at_points(rise, cells)
            order = np.sort(cells)
            per_cell = self._capacity[body] * (rises * weights).reshape(len(order), -1).sum(axis=1)
            self._stored[body] = self._stored.get(body, 0.0) + float(per_cell.sum())
            by_piece = np.bincount(self._elements.components[order], per_cell)
            for piece in np.unique(self._piece[body]).tolist():
                self._add(piece, -float(by_piece[piece]))
        for name, energy in volumes.items():
            self._stored[name] = self._stored.get(name, 0.0) + energy
            self._add(name, -energy)

    def _add(self, place: Place, energy: float) -> None:
        self._gaps[place] = self._gaps.get(place, 0.0) + energy

    @property
    def balance(self) -> EnergyBalance:
        """What was added up so far."""
        return EnergyBalance(dict(self._rows), dict(self._stored), dict(self._gaps), self._rounding)


FIRST_STEP = 1e-2
"""First step of a stage as a share of its duration."""

LARGEST_STEP = 0.1
"""Greatest step as a share of the stage, where none is given."""

SMALLEST_STEP = 1e-10
"""Time step as a share of the stage at which the run gives up."""

ConditionsAt = Callable[[float], Sequence[Condition]]
"""Conditions at a time since the start of the stage [s], smooth in it."""

Observer = Callable[[float, FloatArray, Mapping[str, float]], None]
"""Called with time [s], field (n_nodes,) [K] and volume -> temperature [K]."""


@dataclass(frozen=True, kw_only=True)
class ThermalStage:
    """A part of the schedule."""

    name: str
    duration: float
    """[s]"""
    conditions: Sequence[Condition] | ConditionsAt


@dataclass(frozen=True, kw_only=True)
class TransientSolution:
    """Temperatures at the probes over time, with the energy of the whole run."""

    times: FloatArray
    """(n,) start, then the end of every step [s]."""
    stages: IndexArray
    """(n,) number of the stage each time ends; 0 for the start."""
    probes: Mapping[str, FloatArray]
    """Probe -> (n,) temperature [K]."""
    errors: FloatArray
    """(n,) local error of each step [K], 0 for the start."""
    temperature: FloatArray
    """(n_nodes,) at the end [K]."""
    volumes: Mapping[str, float]
    """Volume -> temperature at the end [K]."""
    energy: EnergyBalance
    rejected: int
    """Steps that were repeated with a shorter length."""
    linear_iterations: int
    warnings: tuple[str, ...]
    """What is to be said of joints, and what the film laws said about their range; each sentence once."""


@dataclass(frozen=True, kw_only=True)
class InitialState:
    """Temperatures at the start."""

    temperature: FloatArray | float
    """(n_nodes,) field or one value [K]."""
    volumes: Mapping[str, float] | None = None
    """Volume -> temperature [K]; others start 1 K below the mean of the field they meet."""


@dataclass(frozen=True, kw_only=True)
class Observed:
    """What is kept or handed out of a run."""

    probes: Sequence[Probe] = ()
    """Where temperatures are kept for every step."""
    at: Sequence[float] | None = ()
    """Times [s] that are met exactly, and at which the observer is called; None calls it after every step."""
    observer: Observer | None = None


@dataclass(frozen=True, kw_only=True)
class StepControl:
    """How long time steps are, and how far their equations are solved."""

    tolerance: float = 0.05
    """Local error of a step [K], root mean square over any body."""
    first: float | None = None
    """First step of every stage [s]; a hundredth of it if None."""
    largest: float | None = None
    """[s]; a tenth of each stage if None."""
    newton: float = 1e-9
    """Tolerance of Newton's method, see `thermal.conduction.steady.solve_steady`."""


def solve_transient(
    setup: ConductionSetup,
    capacity: Mapping[str, float],
    stages: Sequence[ThermalStage],
    initial: InitialState | FloatArray | float,
    *,
    observed: Observed = Observed(),
    steps: StepControl = StepControl(),
) -> TransientSolution:
    """Run through ``stages`` from an initial state.

    setup : mesh and conductivities
    capacity : body -> density times specific heat [J/(m3 K)]
    initial : (n_nodes,) field or one value [K], with volumes if these are given

    Raises ConditionError for input that cannot be computed, ThermalNotConverged if a step fails however short it is or
    the energy does not close.
    """
    _check(stages, observed.at or (), steps)
    if not isinstance(initial, InitialState):
        initial = InitialState(temperature=initial)
    run = _Run(setup, setup.heat_capacity(capacity), initial, steps)
    run.watch(observed)
    for number, stage in enumerate(stages):
        run.stage(number, stage)
    return run.solution()


def settling_time(times: FloatArray, values: FloatArray, final: float, band: float) -> float | None:
    """Time [s] from which ``values`` stay within ``band`` of ``final``; None if they are outside at the end.

    times, values : (n,); between the last point outside and the next the history is taken straight
    """
    outside = np.flatnonzero(np.abs(values - final) > band)
    if not len(outside):
        return float(times[0])
    last = int(outside[-1])
    if last == len(times) - 1:
        return None
    edge = final + math.copysign(band, values[last] - final)
    share = (edge - values[last]) / (values[last + 1] - values[last])
    return float(times[last] + min(share, 1.0) * (times[last + 1] - times[last]))


def _check(stages: Sequence[ThermalStage], observe_at: Sequence[float], steps: StepControl) -> None:
    if not stages:
        raise ConditionError("schedule without a stage; give at least one")
    for stage in stages:
        if not (math.isfinite(stage.duration) and stage.duration > 0.0):
            raise ConditionError(f"stage {stage.name!r}: duration = {stage.duration} s must be above 0 s")
    positive = {"tolerance": steps.tolerance, "first step": steps.first, "largest step": steps.largest}
    for name, value in positive.items():
        if value is not None and not value > 0.0:
            raise ConditionError(f"{name} = {value} must be above 0")
    end = math.fsum(stage.duration for stage in stages)
    if any(not 0.0 <= time <= end for time in observe_at):
        raise ConditionError(f"observe_at holds a time outside of 0 to {end:g} s, the end of the schedule")


class _Run:
    """State of a run: time, field, account, histories."""

    def __init__(
        self, setup: ConductionSetup, capacity: HeatCapacity, initial: InitialState, steps: StepControl
    ) -> None:
        self._setup, self._steps = setup, steps
        self._stepper = Stepper(capacity, steps.newton)
        shape = (len(setup.mesh.points),)
        self._temperature = np.broadcast_to(np.asarray(initial.temperature, dtype=np.float64), shape).copy()
        if not (np.isfinite(self._temperature).all() and self._temperature.min() > 0.0):
            raise ConditionError(
                "initial temperature must be finite and above 0 K at every node; give kelvin"
            )
        level = float(self._temperature.mean())
        self._account = EnergyAccount(setup.elements, capacity.capacity, level)
        self._volumes = dict(initial.volumes or {})
        self._time = self._begin = 0.0
        self._readers: dict[str, Reader] = {}
        self._due: list[float] = []
        self._observer: Observer | None = None
        self._always = False
        self._times: list[float] = []
        self._numbers: list[int] = []
        self._read: dict[str, list[float]] = {}
        self._errors: list[float] = []
        self._rejected = self._iterations = 0
        self._warnings: dict[str, None] = {}

    def watch(self, observed: Observed) -> None:
        """Set what is kept and called."""
        probes = observed.probes
        self._readers = {probe.name: reader(self._setup.elements, probe) for probe in probes}
        if len(self._readers) < len(probes):
            raise ConditionError("two probes have the same name; give each its own")
        self._read = {name: [] for name in self._readers}
        self._due = sorted(set(observed.at or ())) if observed.observer is not None else []
        self._always = observed.at is None
        self._observer = observed.observer

    def stage(self, number: int, stage: ThermalStage) -> None:
        """Run through one stage."""
        tolerance, first, largest = self._steps.tolerance, self._steps.first, self._steps.largest
        problems = _Problems(self._setup, stage, self._begin)
        problem = problems(self._begin)
        self._enter(problem)
        self._warnings |= dict.fromkeys(problems.notes)
        if not self._times:
            self._record(0, 0.0)
        self._stepper.forget()
        end = self._begin + stage.duration
        longest = LARGEST_STEP * stage.duration if largest is None else largest
        dt = min(FIRST_STEP * stage.duration if first is None else first, longest)
        slope: FloatArray | None = None
        while self._time < end:
            goal = min([end, *(due for due in self._due if due > self._time)])
            length = landing(dt, goal - self._time)
            field = np.append(self._temperature, list(self._volumes.values()))
            made = self._try(problems, length, field, slope, SMALLEST_STEP * stage.duration)
            if made is None or made.error > tolerance:
                self._rejected += 1
                dt = (
                    0.25 * length
                    if made is None
                    else min(next_length(length, made.error, tolerance), 0.7 * length)
                )
                if dt < SMALLEST_STEP * stage.duration:
                    raise ThermalNotConverged(
                        f"stage {stage.name!r} at {self._time:.6g} s: a step of {length:.3g} s is still off by more "
                        f"than {tolerance:g} K; check the conditions for jumps inside of the stage",
                        (),
                    )
                continue
            self._accept(number, problem, length, goal, made, field)
            slope = made.slope
            proposed = min(next_length(length, made.error, tolerance), longest)
            dt = max(proposed, dt) if length < dt and made.error <= tolerance else proposed
        self._begin = end

    def _try(
        self, problems: "ProblemAt", dt: float, field: FloatArray, slope: FloatArray | None, smallest: float
    ) -> TimeStep | None:
        try:
            return self._stepper.step(problems, self._time, dt, field, slope)
        except ThermalNotConverged:
            if dt <= 8.0 * smallest:
                raise
            self._stepper.forget()
            return None

    def _enter(self, problem: ConductionProblem) -> None:
        """Take over the volumes of a stage, new ones start fresh; put prescribed nodes to their temperature."""
        mean = float(self._temperature.mean())
        self._volumes = {name: self._volumes.get(name, mean - OFF_REST) for name in problem.volumes.index}
        self._jump(problem)
        problem.check_paths(np.append(self._temperature, list(self._volumes.values())), storing=True)

    def _jump(self, problem: ConductionProblem) -> None:
        """What a prescribed temperature that jumps gives at once, the free nodes unchanged."""
        rise = np.where(problem.fixed, problem.held - self._temperature, 0.0)
        if not rise.any():
            return
        given = self._stepper.capacity.matrix.sum(axis=0) * rise
        elements = self._setup.elements
        holders = held_by(elements, problem.conditions)
        for condition in problem.prescribed:
            surface = elements.surfaces[condition.surface]
            energy = float((given[surface.nodes] / holders[surface.nodes]).sum())
            self._account.give(condition.surface, condition.kind, surface.piece, energy)
        self._account.store(rise, {})
        self._temperature = self._temperature + rise

    def _accept(
        self,
        number: int,
        problem: ConductionProblem,
        dt: float,
        goal: float,
        made: TimeStep,
        before: FloatArray,
    ) -> None:
        n = problem.n_nodes
        for share, balance in zip(STAGE_WEIGHTS, made.balances, strict=True):
            self._account.book(balance, share * dt)
            self._warnings |= dict.fromkeys(balance.warnings)
        rise = made.field - before
        energies = problem.volumes.capacity * rise[n:]
        self._account.store(rise[:n], dict(zip(problem.volumes.index, energies.tolist(), strict=True)))
        self._temperature = made.field[:n]
        self._volumes = dict(zip(problem.volumes.index, made.field[n:].tolist(), strict=True))
        self._time = goal if dt == goal - self._time else self._time + dt
        self._iterations += made.linear_iterations
        self._record(number, made.error)

    def _record(self, number: int, error: float) -> None:
        self._times.append(self._time)
        self._numbers.append(number)
        self._errors.append(error)
        for name, read in self._readers.items():
            self._read[name].append(read(self._temperature, self._volumes))
        due = bool(self._due) and self._due[0] <= self._time
        if due:
            self._due.pop(0)
        if self._observer is not None and (due or self._always):
            self._observer(self._time, self._temperature.copy(), dict(self._volumes))

    def solution(self) -> TransientSolution:
        """What was kept; ThermalNotConverged if the energy does not close."""
        energy = self._account.balance
        if energy.closure > CLOSURE:
            raise ThermalNotConverged(
                f"energy open by {energy.closure:.3g} of the heat turned over, above {CLOSURE:g}; lower the "
                "tolerance of Newton's method",
                (),
            )
        return TransientSolution(
            times=np.array(self._times),
            stages=np.array(self._numbers, dtype=np.int32),
            probes={name: np.array(values) for name, values in self._read.items()},
            errors=np.array(self._errors),
            temperature=self._temperature,
            volumes=dict(self._volumes),
            energy=energy,
            rejected=self._rejected,
            linear_iterations=self._iterations,
            warnings=tuple(self._warnings),
        )


class _Problems:
    """The conduction problem of a stage at any time; made once if the conditions do not change."""

    def __init__(self, setup: ConductionSetup, stage: ThermalStage, begin: float) -> None:
        self._setup, self._stage, self._begin = setup, stage, begin
        self._fixed = None if callable(stage.conditions) else self._made(stage.conditions)

    def __call__(self, time: float) -> ConductionProblem:
        if self._fixed is not None:
            return self._fixed
        assert callable(self._stage.conditions)
        return self._made(self._stage.conditions(time - self._begin))

    def _made(self, conditions: Sequence[Condition]) -> ConductionProblem:
        try:
            check_conditions(self._setup.elements, conditions)
        except ConditionError as error:
            raise ConditionError(f"stage {self._stage.name!r}: {error}") from error
        return ConductionProblem(self._setup, conditions)

    @property
    def notes(self) -> tuple[str, ...]:
        """What is to be said of the joints at the start of the stage."""
        conditions = self._stage.conditions
        return self._setup.notes(conditions(0.0) if callable(conditions) else conditions)
