"""The coupling loop: iterations at one operating point until nothing moves any more."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.errors import NotConvergedError
from rigdesign.base.json_text import require_finite
from rigdesign.base.part_name import BearingName, OilStreamName
from rigdesign.case.schedule import Numerics
from rigdesign.coupling.bearing_seats import bearing_temperatures
from rigdesign.coupling.expansion import hot_clearances, uniform_expansion
from rigdesign.coupling.iteration import SOLVED, IterationParts, IterationResult, PointProblem, run_iteration
from rigdesign.coupling.loop_system import axis_tilt, flank_approach, mesh_placements
from rigdesign.coupling.misalignment import warm_misalignment
from rigdesign.coupling.oil_circuits import circuit_balances, supplies
from rigdesign.coupling.state import (
    CouplingState,
    OperatingPoint,
    length_change,
    temperature_change,
    torque_change,
)
from rigdesign.coupling.temperatures import seat_temperatures
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import bearing_feed, gear_feed, wall_flow

# The coupling state as a vector in comparable sizes, for accelerations and sensitivities of the loop.

FloatArray = NDArray[np.float64]

SCALES = {
    "gear_temperature": 1.0,
    "oil_outlet": 1.0,
    "oil_supply": 1.0,
    "centre_distance": 1e-6,
    "bearing_clearance": 1e-6,
    "axial_expansion": 1e-6,
    "bearing_heat": 10.0,
    "wall_heat": 10.0,
    "mesh_torque": 1.0,
    "seat_temperature": 1.0,
    "flank_approach": 1e-6,
    "axis_tilt": 1e-6,
    "coupling_offset": 1e-6,
    "coupling_angle": 1e-6,
}
"""Unit of each field of the coupling state in the vector [K, m, W, N m, rad]."""

SHARES = {"bearing_heat": 1e-3, "wall_heat": 1e-3, "mesh_torque": 1e-3}
"""Of fields that grow with the rig: share of a value that counts as one where it is above its unit."""


def scaled(state: CouplingState) -> FloatArray:
    """(n,) the coupling state in units of `SCALES`, fields and names in their order."""
    parts = [
        np.fromiter(getattr(state, entry.name).values(), dtype=np.float64) / SCALES[entry.name]
        for entry in fields(state)
    ]
    return np.concatenate(parts)


def unscaled(vector: FloatArray, like: CouplingState) -> CouplingState:
    """The coupling state of a vector (n,), with the names of another."""
    found: dict[str, dict[str, float]] = {}
    start = 0
    for entry in fields(like):
        names = getattr(like, entry.name)
        part = vector[start : start + len(names)] * SCALES[entry.name]
        found[entry.name] = dict(zip(names, part.tolist()))
        start += len(names)
    return CouplingState(**found)


def ordered(state: CouplingState, like: CouplingState) -> CouplingState:
    """The coupling state with its names in the order of another."""
    return CouplingState(
        **{
            entry.name: {name: getattr(state, entry.name)[name] for name in getattr(like, entry.name)}
            for entry in fields(like)
        }
    )


def scaled_change(old: CouplingState, new: CouplingState) -> float:
    """Largest change between two iterations in units of `SCALES`, of large heats and torques by `SHARES` [-]."""
    changes = (
        abs(getattr(new, name)[part] - value) / max(scale, SHARES.get(name, 0.0) * abs(value))
        for name, scale in SCALES.items()
        for part, value in getattr(old, name).items()
    )
    return max(changes, default=0.0)


def numbering(state: CouplingState) -> dict[tuple[str, str], int]:
    """(field, name) -> place in the vector."""
    names = [(entry.name, name) for entry in fields(state) for name in getattr(state, entry.name)]
    return {name: number for number, name in enumerate(names)}


# How the next coupling state follows from the iterations so far: plain relaxation, Anderson acceleration, Newton.
#
# An acceleration proposes a coupling state after every iteration; the distance between the proposal and the state the
# iteration started from is the residual of the loop. From the proposals so far it finds the state of the next
# iteration.

DEPTH = 12
"""Differences that Anderson acceleration keeps."""
RANK_TOLERANCE = 1e-9
"""Relative size of a singular value of the differences below which a direction is left out."""


class Acceleration(Protocol):
    """The way from one iteration to the next."""

    def proposal(self, problem: PointProblem, done: IterationResult) -> CouplingState:
        """The coupling state that an iteration asks for."""

    def following(self, proposal: CouplingState) -> CouplingState:
        """The coupling state of the next iteration, after this proposal."""


class PlainRelaxation:
    """Fixed-point iteration: every proposal is the next state, heats relaxed by what the oil can take up."""

    def proposal(self, problem: PointProblem, done: IterationResult) -> CouplingState:
        """The next state as the iteration gives it."""
        return _relaxed_state(problem, done)

    def following(self, proposal: CouplingState) -> CouplingState:
        """The proposal."""
        return proposal


@dataclass(frozen=True)
class Differences:
    """Secants of earlier iterations, in units of `state_vector.SCALES`; one column a pair of iterations, (n, k)."""

    states: FloatArray
    """Of the coupling states they started from."""
    proposals: FloatArray
    """Of what they proposed."""

    @classmethod
    def of(cls, states: Sequence[FloatArray], proposals: Sequence[FloatArray], size: int) -> "Differences":
        """From vectors (n,), n = ``size``."""
        columns = [np.array(part).T if part else np.empty((size, 0)) for part in (states, proposals)]
        return cls(*columns)


class Anderson:
    """Anderson acceleration, a multi-secant quasi-Newton method; with a known inverse on top of Newton's method.

    Differences of a neighbouring case serve as well as its own, so that a changed case needs two or three iterations
    from the point it is near to.

    start : coupling state of the first iteration
    known : differences of a neighbouring point
    inverse : (n, n) inverse of 1 - G, G the sensitivity of an iteration to its coupling state: then the proposals are
        steps of Newton's method with it
    depth : differences that are kept

    Source: Walker, Ni, SIAM J. Numer. Anal. 49 (2011) 1715.
    """

    def __init__(
        self,
        start: CouplingState,
        *,
        known: Differences | None = None,
        inverse: NDArray[np.floating] | None = None,
        depth: int = DEPTH,
    ) -> None:
        self._names, self._x = start, scaled(start)
        self._inverse, self._depth = inverse, depth
        self._states = [] if known is None else list(known.states.T)
        self._proposals = [] if known is None else list(known.proposals.T)
        self._proposal = self._x
        self._before: tuple[FloatArray, FloatArray] | None = None
        self.residual = np.zeros_like(self._x)
        """(n,) what the last iteration would still move, heats not relaxed, in units of `state_vector.SCALES`."""

    @property
    def differences(self) -> Differences:
        """Those kept, for a neighbouring point."""
        return Differences.of(self._states, self._proposals, len(self._x))

    def proposal(self, problem: PointProblem, done: IterationResult) -> CouplingState:
        """The relaxed next state, or a step of Newton's method."""
        after = _relaxed_state(problem, done)
        self.residual = scaled(ordered(unrelaxed(after, done), self._names)) - self._x
        if self._inverse is None:
            step = scaled(ordered(after, self._names)) - self._x
        else:
            step = np.asarray(self._inverse @ self.residual)
        self._proposal = self._x + step
        if self._before is not None:
            self._states = [*self._states, self._x - self._before[0]][-self._depth :]
            self._proposals = [*self._proposals, self._proposal - self._before[1]][-self._depth :]
        return unscaled(self._proposal, self._names)

    def following(self, proposal: CouplingState) -> CouplingState:
        """Where the differences say that nothing would move."""
        self._before = self._x, self._proposal
        self._x = _secant_step(self._x, self._proposal, self.differences)
        return unscaled(self._x, self._names)


def _relaxed_state(problem: PointProblem, done: IterationResult) -> CouplingState:
    """What an iteration hands on, frozen arrows at their initial values."""
    return next_state(problem.rig, done, problem.parts).freeze(problem.freeze, problem.initial)


def _secant_step(x: FloatArray, proposal: FloatArray, differences: Differences) -> FloatArray:
    """(n,) least-squares zero of the residual in the span of the differences."""
    if not differences.states.size:
        return proposal
    residuals = differences.proposals - differences.states
    size = np.linalg.norm(residuals, axis=0)
    kept = size > 0.0
    share = np.linalg.lstsq(residuals[:, kept] / size[kept], proposal - x, rcond=RANK_TOLERANCE)[0]
    return np.asarray(proposal - (differences.proposals[:, kept] / size[kept]) @ share)


# When the iterations at an operating point have converged, and what is said where they do not.

COARSE_ABOVE = 8.0
"""Change of temperature in an iteration [K] below which the next one may be the last: it is solved in full."""
SHOWN = 4
"""Residuals that a message shows."""


@dataclass(frozen=True, kw_only=True)
class Residual:
    """Largest changes of one iteration: temperature [K], length [m], mean torque relative [-]."""

    temperature: float
    length: float
    torque: float

    @classmethod
    def between(cls, old: CouplingState, new: CouplingState, heat: float = 0.0) -> "Residual":
        """Changes from the coupling state of an iteration to what it proposes.

        heat : temperature error [K] of the heats of the iteration, see `relaxation.heat_residual`
        """
        return cls(
            temperature=max(temperature_change(old, new), heat),
            length=length_change(old, new),
            torque=torque_change(old, new),
        )


class Convergence(Protocol):
    """Criterion that ends the iterations at an operating point."""

    @property
    def iterations(self) -> int:
        """Iterations at most."""

    @property
    def remedy(self) -> str:
        """What to do where they do not suffice."""

    @property
    def limits(self) -> str:
        """The tolerances, formatted."""

    def final(self, residuals: Sequence[Residual]) -> bool:
        """Whether the next iteration may be the last, after those with these residuals."""

    def reached(self, state: CouplingState, proposal: CouplingState, residual: Residual) -> bool:
        """Whether an iteration from ``state`` that proposes ``proposal`` ends the loop."""


class CaseTolerances:
    """Temperatures, lengths and torques within the tolerances of the case; coarse iterations while it is far off."""

    def __init__(self, numerics: Numerics) -> None:
        self._numerics = numerics
        self.iterations = numerics.coupling_passes
        self.remedy = "raise numerics.coupling_passes, or feed more oil if a film or stream oscillates"

    @property
    def limits(self) -> str:
        """The tolerances, formatted."""
        own = self._numerics
        return f"{own.temperature_tolerance:g} K, {1e6 * own.growth_tolerance:g} um, {own.torque_tolerance:g}"

    def final(self, residuals: Sequence[Residual]) -> bool:
        """The first iteration, and those after a small change of temperature."""
        return not residuals or residuals[-1].temperature < COARSE_ABOVE

    def reached(self, state: CouplingState, proposal: CouplingState, residual: Residual) -> bool:
        """Whether all three residuals are within their tolerances."""
        return (
            residual.temperature <= self._numerics.temperature_tolerance
            and residual.length <= self._numerics.growth_tolerance
            and residual.torque <= self._numerics.torque_tolerance
        )


@dataclass(frozen=True)
class ScaledTolerance:
    """No part of the coupling state moves by more than ``limit`` in units of `state_vector.SCALES`."""

    limit: float
    iterations: int = 40
    remedy: str = "feed more oil if a film or stream oscillates"

    @property
    def limits(self) -> str:
        """The tolerance, formatted."""
        return f"{self.limit:g} K, {self.limit:g} um, {10.0 * self.limit:g} W, {self.limit:g} N m"

    def final(self, residuals: Sequence[Residual]) -> bool:
        """Every iteration may be the last."""
        return True

    def reached(self, state: CouplingState, proposal: CouplingState, residual: Residual) -> bool:
        """Whether the largest change is within the limit."""
        return scaled_change(state, proposal) <= self.limit


def not_converged(
    point: OperatingPoint, residuals: Sequence[Residual], convergence: Convergence
) -> NotConvergedError:
    """The error of a point whose iterations are used up, with the history of its residuals."""
    last = "; ".join(
        f"iteration {len(residuals) - back}: {r.temperature:.3g} K, {1e6 * r.length:.3g} um, "
        f"{r.torque:.2g} of the torque"
        for back, r in enumerate(reversed(residuals[-SHOWN:]))
    )
    message = (
        f"coupling at stage {point.stage!r} did not converge in {len(residuals)} iterations (limits "
        f"{convergence.limits}): {last}; {convergence.remedy}"
    )
    rows = [
        {"temperature_K": r.temperature, "growth_um": 1e6 * r.length, "torque_relative": r.torque}
        for r in residuals
    ]
    return NotConvergedError(message, {"stage": point.stage, "residuals": rows})


@dataclass(frozen=True)
class Step:
    """One iteration of the loop."""

    state: CouplingState
    """What it started from."""
    done: IterationResult
    proposal: CouplingState
    residuals: tuple[Residual, ...]
    """Of all iterations so far."""
    final: bool
    """Whether it was solved in full."""


def iterations(
    problem: PointProblem,
    acceleration: Acceleration,
    convergence: Convergence,
    start: CouplingState,
    before: IterationResult | None = None,
) -> Iterator[Step]:
    """The iterations from a coupling state on, without end.

    before : iteration of a neighbouring point on the same meshes: first guess of fields and thermal expansion

    Raises
    ------
    NonFiniteResultError
        A loss, temperature, length or torque of an iteration is NaN or infinite.
    """
    state, done = start, before
    residuals: tuple[Residual, ...] = ()
    while True:
        final = convergence.final(residuals)
        done = run_iteration(problem, state, done, final=final)
        proposal = acceleration.proposal(problem, done)
        require_finite(proposal, f"stage {problem.point.stage}")
        residuals = (*residuals, Residual.between(state, proposal, heat_residual(problem, done)))
        yield Step(state, done, proposal, residuals, final)
        state = acceleration.following(proposal)


def solve_fixed_point(
    problem: PointProblem,
    acceleration: Acceleration,
    convergence: Convergence,
    start: CouplingState,
    before: IterationResult | None = None,
) -> tuple[IterationResult, Sequence[Residual]]:
    """Iterate until the criterion is reached: the last iteration and the residuals of all.

    Parameters
    ----------
    start : coupling state of the first iteration
    before : as in `iterations`

    Raises
    ------
    NotConvergedError
        The iterations of the criterion are used up; the message shows the residuals of the last ones.
    NonFiniteResultError
        As `iterations`.
    """
    residuals: Sequence[Residual] = ()
    for _, step in zip(
        range(convergence.iterations), iterations(problem, acceleration, convergence, start, before)
    ):
        residuals = step.residuals
        if step.final and convergence.reached(step.state, step.proposal, residuals[-1]):
            return step.done, residuals
    raise not_converged(problem.point, residuals, convergence)


# What an iteration hands to the next, with its heats relaxed by what the oil can take up.


def next_state(rig: Rig, done: IterationResult, parts: IterationParts = SOLVED) -> CouplingState:
    """What an iteration hands to the next; heats are relaxed by what the oil can take up (`relaxed`)."""
    old = done.coupling_state
    gear_temperature: dict[str, float] = {}
    centre_distance: dict[str, float] = {}
    clearance: dict[str, float] = {}
    axial_expansion: dict[str, float] = dict.fromkeys(rig.pairs, 0.0)
    for name, box in rig.case.gearboxes.items():
        streams = {stream.name: stream for stream in done.streams}
        bulk = streams[OilStreamName(name, "gear_oil")].chamber
        gear_temperature |= {f"{name}.{gear}": bulk for gear in box.gears}
        if name in done.fields:
            gear_temperature |= {
                f"{name}.{gear}": parts.bulk(rig, done.fields[name], f"gear_{entry.shaft}")
                for gear, entry in box.gears.items()
                if f"gear_{entry.shaft}" in rig.models[name].mesh.bodies
            }
        if name in done.expansion:
            centre_distance |= done.expansion[name].centre_distance
            axial_expansion |= done.expansion[name].axial_expansion
        else:
            centre_distance |= uniform_expansion(
                rig, name, streams[OilStreamName(name, "bearing_oil")].chamber
            )
    seats = seat_temperatures(rig, done.fields)
    clearance |= hot_clearances(
        rig, done.point.speed, done.expansion, bearing_temperatures(done.bearings, seats)
    )
    placements = mesh_placements(rig, done.point, old, done.bearings)
    warm = warm_misalignment(rig, {name: shape.deformed for name, shape in done.expansion.items()})
    torque = old.mesh_torque
    if done.response is not None:
        signed = done.response.flank * done.response.mean
        torque = dict(zip(rig.mesh_names, map(float, signed)))
    return CouplingState(
        gear_temperature=gear_temperature,
        centre_distance={
            name: distance + (placements[name].apart if name in placements else 0.0)
            for name, distance in centre_distance.items()
        },
        bearing_clearance=clearance,
        bearing_heat={
            name: relaxed(old.bearing_heat[name], heat, 0.5 * _film_gain(rig, done, BearingName.read(name)))
            if rig.bearing(name).has_film
            else heat
            for name, heat in done.bearing_heat.items()
        },
        wall_heat={
            name: relaxed(old.wall_heat[name], heat, _stream_gain(rig, done, OilStreamName.read(name)))
            for name, heat in done.wall_heat.items()
        },
        oil_outlet={stream.name: stream.chamber for stream in done.streams},
        oil_supply=supplies(circuit_balances(rig, done)),
        mesh_torque=torque,
        axial_expansion=axial_expansion,
        seat_temperature=seats,
        flank_approach=flank_approach(placements),
        axis_tilt=axis_tilt(placements),
        coupling_offset=warm.offset,
        coupling_angle=warm.angle,
    )


def unrelaxed(after: CouplingState, done: IterationResult) -> CouplingState:
    """The next state of an iteration with its heats as the solids gave them."""
    return replace(after, bearing_heat=done.bearing_heat, wall_heat=done.wall_heat)


def relaxed(old: float, new: float, gain: float) -> float:
    """Heat after a step that stays stable however little oil flows.

    gain : film conductance over heat capacity flow, h A / (rho c Q): change of the heat per heat of the iteration
        before, by the oil temperature this caused; the step is 1 / (1 + gain)
    """
    return old + (new - old) / (1.0 + gain)


def heat_residual(problem: PointProblem, done: IterationResult) -> float:
    """Largest temperature error [K] that the heats of an iteration would still make in an oil stream or film.

    Zero where the heats are frozen.
    """
    rig, old = problem.rig, done.coupling_state
    if {"bearing_heat", "wall_heat"} & problem.freeze:
        return 0.0
    films = (
        0.5 * abs(heat - old.bearing_heat[name]) / _bearing_capacity(rig, BearingName.read(name), old)
        for name, heat in done.bearing_heat.items()
    )
    walls = (
        abs(heat - old.wall_heat[name]) / _stream_capacity(rig, OilStreamName.read(name), old)
        for name, heat in done.wall_heat.items()
    )
    return max((*films, *walls), default=0.0)


def _bearing_capacity(rig: Rig, name: BearingName, state: CouplingState) -> float:
    """Heat capacity flow rho c Q of the oil of one bearing [W/K]; boundless where none is fed (`_without_flow`)."""
    chamber = state.oil_outlet[f"{name.gearbox}.gear_oil"]
    return _without_flow(bearing_feed(rig, name.gearbox, chamber, state.oil_supply).capacity_rate)


def _stream_capacity(rig: Rig, name: OilStreamName, state: CouplingState) -> float:
    """Heat capacity flow of an oil stream of a gearbox along its walls [W/K]; boundless where none is fed."""
    box_name, kind = name.both
    box = rig.case.gearboxes[box_name]
    chamber = state.oil_outlet[f"{box_name}.gear_oil"]
    if kind == "gear_oil":
        return _without_flow(
            replace(gear_feed(rig, box_name, chamber, state.oil_supply), flow=wall_flow(box)).capacity_rate
        )
    feed = bearing_feed(rig, box_name, chamber, state.oil_supply)
    return _without_flow(replace(feed, flow=feed.flow * len(box.bearings)).capacity_rate)


def _without_flow(capacity_rate: float) -> float:
    """A capacity rate, boundless for zero: the field knows the temperature of such oil, no heat has to be relaxed."""
    return capacity_rate or math.inf


def _film_gain(rig: Rig, done: IterationResult, name: BearingName) -> float:
    films = _conductance(done, name.gearbox, f"bearing_film:{name.part}")
    return films / _bearing_capacity(rig, name, done.coupling_state)


def _stream_gain(rig: Rig, done: IterationResult, name: OilStreamName) -> float:
    return _conductance(done, name.gearbox, name.part) / _stream_capacity(rig, name, done.coupling_state)


def _conductance(done: IterationResult, box: str, kind: str) -> float:
    """Sum of h A over the films of one kind [W/K]."""
    if box not in done.fields:
        return 0.0
    rows = done.fields[box].solution.balance.rows
    return sum(row.coefficient.value * row.area for row in rows if row.kind == kind and row.coefficient)
