"""The housings of a rig in the reduced thermal model: parts of an iteration that take the place of the full ones."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, TypeVar

import numpy as np
from scipy import sparse

from rigdesign.base.parallel import BackgroundTasks
from rigdesign.coupling.expansion import HousingExpansion, named_expansion
from rigdesign.coupling.iteration import IterationParts
from rigdesign.coupling.located_loss import PointLosses
from rigdesign.coupling.temperatures import HousingField, boundary_conditions
from rigdesign.prediction.places import Weights
from rigdesign.rig.model import Rig
from thermal.conditions.boundary import (
    BodySource,
    Exchange,
    Film,
    PrescribedTemperature,
    Radiation,
    SurfaceSource,
)
from thermal.conditions.contact import Contact
from thermal.conditions.enclosure import Enclosure, EnclosureTerms
from thermal.conduction.reduced import Factor, ReducedConduction, shapes_of
from thermal.conduction.setup import Condition, ConductionSetup
from thermal.conduction.steady import TemperatureSolution, newton
from thermal.conduction.terms import ConductionProblem, Preconditioner
from thermal.expansion.expansion import read_expansion
from thermal.fe.direct_factor import MOST_NODES, DirectFactor
from thermal.fe.kernels import THREADED
from thermal.fe.mesh import FloatArray
from thermal.fe.solver import LowRank
from thermal.films import convection

# Thermal expansion of a housing as a linear map of its reduced basis: clearances without an elastic solve.
#
# Expansion is linear in the temperature and the clearances are read from displacements a thousand times smaller than
# the rig, so that a clearance follows each basis vector in proportion to nanometres. Each is expanded once.

AMPLITUDE = 10.0
"""Temperature [K] with which a basis vector is expanded."""
EXACT = 1e-8
"""Relative residual of the expansion of the field the map starts from."""
ENOUGH = 1e-3
"""Relative residual of the expansion of a basis vector that reaches 1 K: ten nanometres of a clearance."""
LEAST = 0.1
"""Temperature [K] a basis vector has to reach to be expanded: 0.1 K moves a clearance by a tenth of a micrometre."""


class ExpansionMap:
    """Clearances of one housing by the coefficients of its reduced basis.

    basis : (n_nodes, m); sizes : (m,) temperature [K] that each reaches, strongest first; base : (m,)
        coefficients of a warm field near which the map is made
    """

    def __init__(self, rig: Rig, name: str, basis: FloatArray, sizes: FloatArray, base: FloatArray) -> None:
        setup, reference = rig.expansion[name], rig.case.ambient.reference_temperature
        self._base = base
        field = basis @ base
        start = setup.elastic.solve(field, reference, EXACT).values

        def read(temperature: FloatArray, supported: FloatArray) -> HousingExpansion:
            return named_expansion(rig, name, read_expansion(setup, temperature, reference, supported))

        self.expansion = read(field, start)
        """At the base."""
        first = numbers_of(self.expansion)

        def derivative(vector: FloatArray, size: float) -> FloatArray:
            if size < LEAST:
                return np.zeros_like(first)
            bent = setup.elastic.solve(AMPLITUDE * vector, 0.0, min(1e-2, ENOUGH / size)).values
            moved = read(field + AMPLITUDE * vector, start + bent)
            return np.asarray((numbers_of(moved) - first) / AMPLITUDE)

        works = [partial(derivative, vector, size) for vector, size in zip(basis.T, sizes.tolist())]
        self.first, self.derivative = first, np.array(fields_in_parallel(len(field), works)).T
        """Numbers of the thermal expansion at the base, and (k, m) how they follow the coefficients [m/K]."""

    def at(self, coefficients: FloatArray) -> HousingExpansion:
        """Thermal expansion of the field with these coefficients (m,)."""
        return with_numbers(self.expansion, self.first + self.derivative @ (coefficients - self._base))


def numbers_of(expansion: HousingExpansion) -> FloatArray:
    """Bores and journals, seal gaps, centre distances, axial travels, in this order [m]."""
    shape = expansion.deformed
    parts = [np.array([(b.bore_expansion, b.journal_expansion) for b in shape.bearings.values()]).ravel()]
    parts += [seal.gaps.ravel() for seal in shape.seals.values()]
    parts.append(np.array([*expansion.centre_distance.values(), *expansion.axial_expansion.values()]))
    return np.concatenate(parts)


def with_numbers(expansion: HousingExpansion, numbers: FloatArray) -> HousingExpansion:
    """The thermal expansion with other numbers; displacements and what else depends on them stay those of the base."""
    remaining = numbers

    def take(count: int) -> FloatArray:
        nonlocal remaining
        taken, remaining = remaining[:count], remaining[count:]
        return taken

    bearings = {}
    for name, bearing in expansion.deformed.bearings.items():
        bore, journal = map(float, take(2))
        bearings[name] = replace(bearing, bore_expansion=bore, journal_expansion=journal)
    seals = {
        name: replace(seal, gaps=take(seal.gaps.size).reshape(seal.gaps.shape))
        for name, seal in expansion.deformed.seals.items()
    }
    distance = dict(zip(expansion.centre_distance, map(float, take(len(expansion.centre_distance)))))
    travel = dict(zip(expansion.axial_expansion, map(float, take(len(expansion.axial_expansion)))))
    return replace(
        expansion,
        deformed=replace(expansion.deformed, bearings=bearings, seals=seals),
        centre_distance=distance,
        axial_expansion=travel,
    )


# Works on fields of one mesh on all cores, while its products are too small for threads of their own.

T = TypeVar("T")


def fields_in_parallel(nodes: int, works: Sequence[Callable[[], T]]) -> list[T]:
    """Results of works on fields of so many nodes, in their order; the same bits on any number of cores."""
    if nodes >= THREADED:
        return [work() for work in works]
    with BackgroundTasks(works) as tasks:
        return tasks.results()


HousingNumbers = tuple[FloatArray, FloatArray, float, ExpansionMap | None, FloatArray]
"""Basis vectors, their sizes, error, thermal expansion and start of a housing, for another process."""


@dataclass(frozen=True)
class ReducedField(HousingField):
    """A projected field with its coefficients."""

    coefficients: FloatArray
    factor: Factor
    """Of the Jacobian it was found with."""


class ReducedHousings:
    """Reduced basis and thermal expansion of every housing of a rig; valid for every case with these housings.

    states : by gearbox, conditions of some operating points among which those wanted lie
    readers : by gearbox, sensors at points
    """

    def __init__(
        self,
        rig: Rig,
        states: Mapping[str, Sequence[Sequence[Condition]]],
        readers: Mapping[str, Sequence[Weights]],
    ) -> None:
        self.bases: dict[str, Basis] = {}
        self.expansions: dict[str, ExpansionMap] = {}
        self._start: dict[str, FloatArray] = {}
        for name, conditions in states.items():
            basis = build_basis(rig.conduction[name], conditions, readers.get(name, ()))
            start = np.zeros(basis.reduced.size)
            start[0] = rig.case.ambient.temperature + 30.0
            start = basis.reduced.solve(conditions[0], start).coefficients
            self.bases[name], self._start[name] = basis, start
            if not rig.models[name].no_expansion:
                self.expansions[name] = ExpansionMap(rig, name, basis.reduced.shapes, basis.sizes, start)

    def numbers(self) -> dict[str, HousingNumbers]:
        """Basis vectors, their sizes, error, thermal expansion and start by gearbox: what another process needs."""
        return {
            name: (
                basis.reduced.shapes,
                basis.sizes,
                basis.error,
                self.expansions.get(name),
                self._start[name],
            )
            for name, basis in self.bases.items()
        }

    @classmethod
    def of_numbers(
        cls,
        rig: Rig,
        numbers: Mapping[str, HousingNumbers],
    ) -> "ReducedHousings":
        """The housings of the same rig from their numbers."""
        made = cls(rig, {}, {})
        for name, (vectors, sizes, error, expansion, start) in numbers.items():
            made.bases[name] = Basis(ReducedConduction(rig.conduction[name], vectors), sizes, error)
            made._start[name] = start
            if expansion is not None:
                made.expansions[name] = expansion
        return made

    @property
    def error(self) -> float:
        """Stated error of a temperature against the full model [K]."""
        return max((basis.error for basis in self.bases.values()), default=0.0)

    def field(
        self,
        rig: Rig,
        name: str,
        losses: PointLosses,
        start: HousingField | None = None,
        **_: Any,
    ) -> ReducedField:
        """Field of a housing as `rigdesign.coupling.temperatures.solve_housing` gives it, projected."""
        housing = rig.case.housings[name]
        conditions = tuple(
            boundary_conditions(rig, name, losses, radiation_included=housing.radiation_included)
        )
        return self.solved(name, conditions, start if isinstance(start, ReducedField) else None)

    def solved(
        self, name: str, conditions: tuple[Condition, ...], near: ReducedField | None = None
    ) -> ReducedField:
        """Field of a housing under conditions."""
        reduced = self.bases[name].reduced
        if near is None:
            found = reduced.solve(conditions, self._start[name])
        else:
            found = reduced.solve(conditions, near.coefficients, near.factor)
        solution = TemperatureSolution(
            temperature=reduced.field(found.coefficients),
            balance=found.balance,
            residuals=(),
            linear_iterations=(),
            warnings=(),
            volumes={},
            preconditioner=None,
        )
        return ReducedField(name, conditions, solution, found.coefficients, found.factor)

    def expansion(
        self, _: Rig, field: HousingField, start: HousingExpansion | None = None
    ) -> HousingExpansion:
        """Thermal expansion of a projected field; ``start`` is not needed."""
        assert isinstance(field, ReducedField)
        return self.expansions[field.gearbox].at(field.coefficients)

    def bulk(self, _: Rig, field: HousingField, body: str) -> float:
        """Volume mean of a body [K]."""
        assert isinstance(field, ReducedField)
        return float(self.bases[field.gearbox].reduced.body(body) @ field.coefficients)

    def parts(self, others: IterationParts) -> IterationParts:
        """Parts of an iteration with the fields and thermal expansion of these housings."""
        return replace(others, field=self.field, expansion=self.expansion, bulk=self.bulk)


# Reduced basis of the temperatures of a housing, and the error of the model with it.
#
# Basis vectors are fields of the full model: fields under the conditions of some operating points, what each
# film, joint and source does to them (solutions with the Jacobian), and fields under changed conditions. Changed
# conditions are drawn at random (see `drawn`); those the model misses most join the basis, until it stays within
# `WANTED` on draws it has not seen. The largest miss on those last draws is the stated error.

WANTED = 0.08
"""Error [K] of what is read under which no further basis vectors are sought."""
LEAST_DIRECTION = 4e-3
"""Root mean square [K] below which a direction of the sampled fields is left out."""
DRAWS = 10
"""Changed conditions per round that may join the basis."""
UNSEEN = 8
"""Changed conditions per round that only tell the error."""
ROUNDS = 4
"""Rounds at most."""
FACTOR = 3.0
"""Largest factor on a kind of film, joint or source in a draw, and on `SINGLE` others."""
SINGLE = 3
"""Single conditions that change by much in a draw."""
LITTLE = 1.2
"""Largest factor on all others in a draw: what speeds and temperatures do to their laws."""
SHIFT = 15.0
"""Largest change of a fluid temperature in a draw [K]."""
FLUX_RISE = 20.0
"""Temperature difference [K] that gives the size of the response to a uniform heat flux."""
TOLERANCE = 1e-6
"""Heat left over in a full field that joins the basis, relative to the heat turned over."""


@dataclass(frozen=True)
class Basis:
    """A reduced housing with its error."""

    reduced: ReducedConduction
    sizes: FloatArray
    """(m,) temperature that each basis vector reaches [K], strongest first."""
    error: float
    """Largest error of a surface or body mean or a sensor in draws that did not join the basis [K]."""


class _Kept:
    """A preconditioner that keeps the small-rank part it was given first: means of a few surfaces hardly matter."""

    def __init__(self, made: Preconditioner) -> None:
        self._made = made

    def __call__(self, residual: FloatArray) -> FloatArray:
        return self._made(residual)

    def set_low_rank(self, low_rank: LowRank | None) -> None:
        """Leave the part as it is."""


class FullField:
    """Full fields of one housing under many conditions, with the factors of one Jacobian."""

    def __init__(
        self, setup: ConductionSetup, conditions: Sequence[Condition], near: FloatArray | None = None
    ) -> None:
        self.setup = setup
        problem = ConductionProblem(setup, conditions)
        self._start = problem.start(near)
        linear = problem.linearise(self._start)
        points, small = setup.elements.mesh.points, problem.n_nodes <= MOST_NODES
        made = DirectFactor(linear.matrix, points) if small else problem.multigrid(linear, self._start)
        made.set_low_rank(linear.low_rank)
        self._factor = _Kept(made)

    def solve(self, conditions: Sequence[Condition], start: FloatArray | None = None) -> FloatArray:
        """(n_nodes,) field in equilibrium."""
        problem = ConductionProblem(self.setup, conditions)
        found = newton(
            problem,
            problem.start(self._start if start is None else start),
            TOLERANCE,
            preconditioner=self._factor,
        )
        return found.field[: problem.n_nodes]

    def responses(self, conditions: Sequence[Condition], field: FloatArray) -> FloatArray:
        """(n_nodes, k) changes of a field by each film, joint and source, about as large as they may be.

        They only have to point the right way, so that the preconditioner does.
        """
        fixed = ConductionProblem(self.setup, conditions).fixed
        loads = (np.where(fixed, 0.0, load) for load in self._loads(conditions, field))
        return np.array([self._factor(load) for load in loads]).T

    def _loads(self, conditions: Sequence[Condition], field: FloatArray) -> Iterator[FloatArray]:
        surfaces, elements = self.setup.elements.surfaces, self.setup.elements
        for condition in conditions:
            match condition:
                case Film():
                    surface = surfaces[condition.surface]
                    value = condition.law(surface.mean(field), condition.fluid_temperature).value
                    yield value * FLUX_RISE * surface.shares
                    yield value * surface.load(condition.fluid_temperature - surface.at_points(field))
                case Radiation():
                    surface = surfaces[condition.surface]
                    yield 6.0 * FLUX_RISE * surface.shares
                    wall = surface.at_points(field)
                    yield 5.7e-8 * surface.load(condition.surroundings_temperature**4 - wall**4)
                case Exchange():
                    a, b = surfaces[condition.surface_a], surfaces[condition.surface_b]
                    value = condition.law(a.mean(field), b.mean(field)).value
                    yield value * a.area * FLUX_RISE * (a.shares / a.area - b.shares / b.area)
                case Contact():
                    joint = self.setup.joint(condition)
                    jump = joint.jump
                    means = (float(joint.mean(side) @ field) for side in (joint.side_a, joint.side_b))
                    value = condition.law(*means).value
                    yield -value * (jump.T @ (joint.weights * (jump @ field)))
                case SurfaceSource():
                    surface = surfaces[condition.surface]
                    yield condition.power * surface.shares / surface.area
                case BodySource():
                    share = elements.body_load(condition.body)
                    yield condition.power * share / share.sum()
        for condition in conditions:
            if isinstance(condition, Enclosure):
                yield -EnclosureTerms(elements, condition).heat_out(field)[0]
        for body in elements.mesh.bodies:
            share = elements.body_load(body)
            yield 50.0 * share / share.sum()


def build_basis(
    setup: ConductionSetup,
    states: Sequence[Sequence[Condition]],
    readers: Sequence[Weights] = (),
    seed: int = 5,
) -> Basis:
    """The basis of one housing from its conditions at some operating points.

    readers : sensors at points; the error is that of theirs and of the means of all surfaces and bodies
    seed : of the draws, which are the same for the same seed
    """
    fields: list[FloatArray] = []
    responses: list[FloatArray] = []
    full = FullField(setup, states[0])
    for conditions in states:
        fields.append(full.solve(conditions, fields[-1] if fields else None))
        full = FullField(setup, conditions, fields[-1])
        responses.append(full.responses(conditions, fields[-1]))
    snapshots = np.hstack([np.array(fields).T, *responses])
    read = _readers(setup, readers)
    random = np.random.default_rng(seed)
    for last in [False] * (ROUNDS - 1) + [True]:
        vectors, sizes = shapes_of(snapshots, LEAST_DIRECTION)
        reduced = ReducedConduction(setup, vectors)
        missed = _missed(full, reduced, read, states, random, UNSEEN)
        error = max(gap for gap, _ in missed)
        if error <= WANTED or last:
            break
        missed += _missed(full, reduced, read, states, random, DRAWS)
        snapshots = np.hstack([snapshots, np.array([field for _, field in missed]).T])
    return Basis(reduced, sizes, error)


def _readers(setup: ConductionSetup, readers: Sequence[Weights]) -> sparse.csr_array:
    """(k, n_nodes) means of all surfaces and bodies, and what sensors read."""
    elements = setup.elements
    rows = [surface.shares / surface.area for surface in elements.surfaces.values()]
    for body in elements.mesh.bodies:
        load = elements.body_load(body)
        rows.append(load / load.sum())
    for nodes, weights in readers:
        row = np.zeros(len(elements.mesh.points))
        np.add.at(row, nodes, weights)
        rows.append(row)
    return sparse.csr_array(np.array(rows))


def _missed(
    full: FullField,
    reduced: ReducedConduction,
    read: sparse.csr_array,
    states: Sequence[Sequence[Condition]],
    random: np.random.Generator,
    count: int,
) -> list[tuple[float, FloatArray]]:
    """Largest error that is read under randomly changed conditions [K], and the full field; some of them."""
    start = np.zeros(reduced.size)
    start[0] = 330.0

    def under(conditions: Sequence[Condition]) -> tuple[float, FloatArray]:
        found = reduced.field(reduced.solve(conditions, start).coefficients)
        exact = full.solve(conditions, found)
        return float(np.abs(read @ (exact - found)).max()), exact

    drawn_ones = [drawn(states[int(random.integers(len(states)))], random) for _ in range(count)]
    return fields_in_parallel(read.shape[1], [partial(under, conditions) for conditions in drawn_ones])


def drawn(conditions: Sequence[Condition], random: np.random.Generator) -> list[Condition]:
    """Conditions changed at random: one kind and three single ones by much, all of them by a little.

    Fluids of one kind move together, as one stream does.
    """
    kind_of = [getattr(condition, "kind", "") for condition in conditions]
    kinds = sorted(set(kind_of))
    kind = kinds[int(random.integers(len(kinds)))]
    single = set(random.integers(len(conditions), size=SINGLE).tolist())
    shifts = {name: float(random.uniform(-SHIFT, SHIFT)) for name in kinds}
    common = float(FACTOR ** random.uniform(-1.0, 1.0))
    changed = []
    for index, (condition, own) in enumerate(zip(conditions, kind_of)):
        factor = float(LITTLE ** random.uniform(-1.0, 1.0))
        if index in single:
            factor = float(FACTOR ** random.uniform(-1.0, 1.0))
        elif own == kind:
            factor *= common
        changed.append(_changed(condition, factor, shifts[own]))
    return changed


def _changed(condition: Condition, factor: float, shift: float) -> Condition:
    match condition:
        case Film():
            law = convection.scaled(condition.law, factor)
            return replace(condition, law=law, fluid_temperature=condition.fluid_temperature + shift)
        case Exchange() | Contact():
            return replace(condition, law=convection.scaled(condition.law, factor))
        case Radiation():
            return replace(
                condition,
                emissivity=min(1.0, condition.emissivity * math.sqrt(factor)),
                surroundings_temperature=condition.surroundings_temperature + shift,
            )
        case Enclosure():
            greyer = min(1.0, math.sqrt(factor))
            return replace(condition, emissivities=tuple(greyer * e for e in condition.emissivities))
        case SurfaceSource() | BodySource():
            return replace(condition, power=condition.power * factor)
        case PrescribedTemperature():
            return replace(condition, temperature=condition.temperature + shift)
        case _:
            return condition
