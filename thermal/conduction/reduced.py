"""Conduction projected on a few temperature shapes of one mesh: the same conditions, solved in milliseconds.

The field is T = V a with shapes V (n_nodes, m) and the coefficients solve V' R(V a) = 0 for the residual R of
`thermal.conduction.terms` (Galerkin). Every condition is integrated with the shapes on its surface once; films,
radiation, exchanges and contacts then cost m x m products, their laws are evaluated as in the full model at the
mean temperatures of the projected field, radiation at its quadrature points.

A prescribed surface is held in its mean; shapes taken from fields that hold it are constant there, so that this
is the same. The heat balance has the rows of `thermal.conduction.balance`.
Source: Quarteroni, Manzoni, Negri, Reduced Basis Methods for Partial Differential Equations, ch. 3 and 6.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lu_factor, lu_solve

from thermal.conditions.boundary import (
    Adiabatic,
    BodySource,
    ConditionError,
    Exchange,
    Film,
    PrescribedTemperature,
    Radiation,
    SurfaceSource,
)
from thermal.conditions.contact import Contact
from thermal.conditions.enclosure import Enclosure, EnclosureTerms
from thermal.conduction.balance import HeatBalance, HeatFlow
from thermal.conduction.capacity import StoredHeat
from thermal.conduction.setup import Condition, ConductionSetup
from thermal.errors import ThermalNotConverged
from thermal.fe.mesh import FloatArray
from thermal.fe.solver import DIFFERENCE
from thermal.films.law import STEFAN_BOLTZMANN, FilmCoefficient

# Radiation between the surfaces of a chamber, projected on temperature shapes.


class ShapesOnSurface(Protocol):
    """m shapes on a surface: values at its points (n, m), weights (n,) [m2], integrals (m,), area [m2]."""

    points: FloatArray
    weights: FloatArray
    load: FloatArray
    area: float


class ReducedEnclosure:
    """Heat of one enclosure by the coefficients of the shapes on its surfaces."""

    def __init__(self, terms: EnclosureTerms, surfaces: Sequence[ShapesOnSurface]) -> None:
        self.terms, self.surfaces = terms, tuple(surfaces)

    def heat_out(self, a: FloatArray) -> FloatArray:
        """(m,) heat that leaves with each shape [W]."""
        heat = np.zeros(len(a))
        for surface, e, arriving in zip(
            self.surfaces, self.terms.emissivity, self._irradiation(a), strict=True
        ):
            emitted = STEFAN_BOLTZMANN * (surface.points @ a) ** 4
            heat += e * ((surface.weights * emitted) @ surface.points - arriving * surface.load)
        return heat

    def slope(self, a: FloatArray) -> FloatArray:
        """(m, m) slope of `heat_out`."""
        jacobian = np.zeros((len(a), len(a)))
        emitted = []
        for surface, e in zip(self.surfaces, self.terms.emissivity, strict=True):
            local = 4.0 * STEFAN_BOLTZMANN * surface.weights * (surface.points @ a) ** 3
            jacobian += e * surface.points.T @ (local[:, None] * surface.points)
            emitted.append(local @ surface.points / surface.area)
        arriving = self.terms.transfer @ np.array(emitted)
        for surface, e, row in zip(self.surfaces, self.terms.emissivity, arriving, strict=True):
            jacobian -= e * np.outer(surface.load, row)
        return jacobian

    def powers(self, a: FloatArray) -> FloatArray:
        """(n,) heat into each surface [W]."""
        emitted = [
            STEFAN_BOLTZMANN * float(surface.weights @ (surface.points @ a) ** 4) for surface in self.surfaces
        ]
        area = np.array([surface.area for surface in self.surfaces])
        return np.asarray(self.terms.emissivity * (self._irradiation(a) * area - np.array(emitted)))

    def _irradiation(self, a: FloatArray) -> FloatArray:
        """(n,) [W/m2]"""
        emission = [
            STEFAN_BOLTZMANN * float(surface.weights @ (surface.points @ a) ** 4) / surface.area
            for surface in self.surfaces
        ]
        terms = self.terms
        return np.asarray(terms.transfer @ np.array(emission) + terms.from_opening * terms.opening_emission)


STEPS = 30
"""Newton steps at most."""
ENOUGH = 1e-5
"""Root mean square of a Newton step [K] after which the coefficients stand."""
CONTRACTION = 0.2
"""Fall of the steps above which the Jacobian is made afresh."""

Factor = tuple[FloatArray, NDArray[np.int32]]
"""LU factors of a Jacobian with the rows of prescribed surfaces, as scipy gives them."""


def shapes_of(fields: FloatArray, least: float) -> tuple[FloatArray, FloatArray]:
    """Orthogonal shapes (n_nodes, m) that span fields (n_nodes, k), and their sizes (m,), strongest first.

    Each shape has a root mean square of one, so that a coefficient is a temperature; its size is the root mean
    square over the nodes of what all fields together have of it [K]. The first is the constant.

    least : size [K] of a direction below which it is left out
    """
    n = len(fields)
    constant = np.ones((n, 1))
    mean = fields.mean(axis=0)
    left, size, _ = np.linalg.svd(fields - mean, full_matrices=False)
    size = size / np.sqrt(n)
    kept = size > least
    shapes = np.ascontiguousarray(np.hstack([constant, np.sqrt(n) * left[:, kept]]))
    return shapes, np.append(np.linalg.norm(mean), size[kept])


class _Surface:
    """The shapes on one surface."""

    def __init__(self, setup: ConductionSetup, name: str, shapes: FloatArray) -> None:
        self.surface = surface = setup.elements.surfaces[name]
        self.area, self.piece = surface.area, surface.piece
        points = surface.at_points(shapes)
        self.points = points.reshape(-1, shapes.shape[1])
        """(n_points, m) at the quadrature points."""
        self.weights = surface.weights.ravel()
        self.load = self.weights @ self.points
        self.mean = self.load / self.area
        """(m,) area mean of each shape."""

    @cached_property
    def mass(self) -> FloatArray:
        """(m, m) integral of products of shapes [m2]."""
        return np.asarray(self.points.T @ (self.weights[:, None] * self.points))


class _Joint:
    """The shapes across a joint."""

    def __init__(self, setup: ConductionSetup, contact: Contact, shapes: FloatArray) -> None:
        joint = setup.joint(contact)
        jump = np.asarray(joint.jump @ shapes)
        self.mass = np.asarray(jump.T @ (joint.weights[:, None] * jump))
        self.area = float(joint.weights.sum())
        self.means = tuple(
            np.asarray(joint.weights @ (side @ shapes)) / self.area for side in (joint.side_a, joint.side_b)
        )
        self.load = np.asarray(joint.weights @ jump)


@dataclass(frozen=True)
class Link:
    """One local conductance at a field: how the residual follows its logarithm."""

    condition: Condition
    column: FloatArray
    """(m,) heat that leaves each shape through it [W]."""
    heat: float
    """Heat that leaves the solids through a film [W]; zero for others."""
    heat_slope: FloatArray
    """(m,) how that heat follows the field [W/K]."""


@dataclass(frozen=True)
class ReducedSolution:
    """Coefficients with the heat balance and the Jacobian there."""

    coefficients: FloatArray
    """(m,) [K]"""
    balance: HeatBalance
    conditions: tuple[Condition, ...]
    factor: Factor
    """Of the Jacobian the last step took."""
    steps: int


class ReducedConduction:
    """One mesh and its conductivities, projected on shapes.

    shapes : (n_nodes, m), see `shapes_of`
    Raises ConditionError for a conductivity that follows the temperature: that is solved in full only.
    """

    def __init__(self, setup: ConductionSetup, shapes: FloatArray) -> None:
        if setup.variable is not None:
            raise ConditionError(
                "the reduced model takes constant conductivities; give numbers or solve the full model"
            )
        self.setup, self.shapes = setup, shapes
        self.matrix = np.asarray(shapes.T @ (setup.elements.fine.matrix(setup.fine) @ shapes))
        """(m, m) [W/K]"""
        self._surfaces: dict[str, _Surface] = {}
        self._joints: dict[tuple[str, str], _Joint] = {}
        self._bodies: dict[str, FloatArray] = {}
        self._capacities: dict[tuple[tuple[str, float], ...], FloatArray] = {}

    @property
    def size(self) -> int:
        """Number of shapes."""
        return int(self.shapes.shape[1])

    def field(self, coefficients: FloatArray) -> FloatArray:
        """(n_nodes,) temperatures [K]."""
        return np.asarray(self.shapes @ coefficients)

    def surface(self, name: str) -> _Surface:
        """The shapes on a surface."""
        if name not in self._surfaces:
            self._surfaces[name] = _Surface(self.setup, name, self.shapes)
        return self._surfaces[name]

    def body(self, name: str) -> FloatArray:
        """(m,) volume mean of each shape over a body."""
        if name not in self._bodies:
            load = self.setup.elements.body_load(name)
            self._bodies[name] = np.asarray(load @ self.shapes) / load.sum()
        return self._bodies[name]

    def joint(self, contact: Contact) -> _Joint:
        """The shapes across a contact."""
        key = contact.surface_a, contact.surface_b
        if key not in self._joints:
            self._joints[key] = _Joint(self.setup, contact, self.shapes)
        return self._joints[key]

    def enclosure(self, condition: Enclosure) -> ReducedEnclosure:
        """The shapes on the surfaces of an enclosure."""
        surfaces = [self.surface(name) for name in condition.surfaces]
        return ReducedEnclosure(EnclosureTerms(self.setup.elements, condition), surfaces)

    def capacity_of(self, capacity: Mapping[str, float]) -> FloatArray:
        """(m, m) heat capacity matrix of the bodies [J/K]; capacity : body -> density times specific heat."""
        key = tuple(sorted(capacity.items()))
        if key not in self._capacities:
            matrix = self.setup.heat_capacity(capacity).matrix
            self._capacities[key] = np.asarray(self.shapes.T @ (matrix @ self.shapes))
        return self._capacities[key]

    def stored_load(self, condition: StoredHeat) -> FloatArray:
        """(m,) heat content that the step counts from, on each shape [J]."""
        matrix = self.setup.heat_capacity(condition.capacity).matrix
        start = np.broadcast_to(condition.start, (len(self.shapes),))
        return np.asarray(self.shapes.T @ (matrix @ start))

    def solve(
        self, conditions: Sequence[Condition], start: FloatArray, near: Factor | None = None
    ) -> ReducedSolution:
        """Coefficients in equilibrium under ``conditions``, from ``start`` (m,).

        near : Jacobian of a solution nearby; kept as long as the steps shrink

        Raises
        ------
        ConditionError
            A condition that is solved in full only.
        ThermalNotConverged
            Newton's method stalls.
        """
        system = Projection(self, conditions)
        a, factor, history = start.copy(), near, [np.inf]
        while True:
            if factor is None or (len(history) > 2 and history[-1] > CONTRACTION * history[-2]):
                residual, jacobian = system.at(a)
                factor = system.factor(jacobian)
            else:
                residual = system.residual(a)
            step = system.step(residual, factor, a)
            share = 1.0
            while system.coldest(a + share * step) <= 0.0 and share > 1e-3:
                share *= 0.5
            a = a + share * step
            history.append(float(np.sqrt(step @ step)))
            if history[-1] < ENOUGH:
                return ReducedSolution(
                    coefficients=a,
                    balance=system.balance(a),
                    conditions=tuple(conditions),
                    factor=factor,
                    steps=len(history) - 1,
                )
            if len(history) > STEPS:
                raise ThermalNotConverged(
                    f"reduced conduction: Newton step of {history[-1]:.3g} K after {STEPS} steps; check the film "
                    "laws for jumps or start from a nearer field",
                    tuple(history[1:]),
                )


class Projection:
    """Residual, Jacobian and balance of one set of conditions on the shapes."""

    def __init__(self, reduced: ReducedConduction, conditions: Sequence[Condition]) -> None:
        self.reduced, self.conditions = reduced, tuple(conditions)
        self.source = np.zeros(reduced.size)
        self.matrix = reduced.matrix
        self.held: list[tuple[FloatArray, float]] = []
        self.enclosures: dict[Enclosure, ReducedEnclosure] = {}
        for condition in conditions:
            match condition:
                case SurfaceSource():
                    self.source += condition.power * reduced.surface(condition.surface).mean
                case BodySource():
                    self.source += condition.power * reduced.body(condition.body)
                case StoredHeat():
                    self.matrix = self.matrix + reduced.capacity_of(condition.capacity) / condition.time
                    self.source += reduced.stored_load(condition) / condition.time
                case PrescribedTemperature():
                    self.held.append((reduced.surface(condition.surface).mean, condition.temperature))
                case Enclosure():
                    self.enclosures[condition] = reduced.enclosure(condition)
                case Film() | Radiation() | Exchange() | Contact() | Adiabatic():
                    pass
                case _:
                    raise ConditionError(
                        f"the reduced model does not take {type(condition).__name__}; solve the full model"
                    )
        self.multipliers = np.zeros(len(self.held))
        """Heat that holds each prescribed surface [W], of the last step."""

    def coldest(self, a: FloatArray) -> float:
        """Lowest area mean of the film surfaces [K]."""
        means = [self.reduced.surface(c.surface).mean @ a for c in self.conditions if isinstance(c, Film)]
        return float(min(means, default=1.0))

    def coefficients(self, a: FloatArray) -> list[FilmCoefficient | None]:
        """Coefficient of every condition at the means of a field; None where it has none."""
        return [
            self._coefficient(condition, a) if isinstance(condition, Film | Exchange | Contact) else None
            for condition in self.conditions
        ]

    def _means(self, condition: Exchange | Contact) -> tuple[FloatArray, FloatArray]:
        if isinstance(condition, Contact):
            first, second = self.reduced.joint(condition).means
            return first, second
        surfaces = condition.surface_a, condition.surface_b
        first, second = (self.reduced.surface(name).mean for name in surfaces)
        return first, second

    def _coefficient(self, condition: Film | Exchange | Contact, a: FloatArray) -> FilmCoefficient:
        if isinstance(condition, Film):
            mean = float(self.reduced.surface(condition.surface).mean @ a)
            return condition.law(mean, condition.fluid_temperature)
        first, second = self._means(condition)
        return condition.law(float(first @ a), float(second @ a))

    def _law_slope(self, condition: Film | Exchange | Contact, a: FloatArray) -> FloatArray:
        """(m,) slope of a coefficient by the field; zeros for one that does not follow it."""
        if isinstance(condition, Film):
            mean_of = self.reduced.surface(condition.surface).mean
            mean, fluid = float(mean_of @ a), condition.fluid_temperature
            rise = (
                condition.law(mean + DIFFERENCE, fluid).value - condition.law(mean - DIFFERENCE, fluid).value
            )
            return rise / (2.0 * DIFFERENCE) * mean_of
        first, second = self._means(condition)
        t_a, t_b, law = float(first @ a), float(second @ a), condition.law
        by_a = law(t_a + DIFFERENCE, t_b).value - law(t_a - DIFFERENCE, t_b).value
        by_b = law(t_a, t_b + DIFFERENCE).value - law(t_a, t_b - DIFFERENCE).value
        return (by_a * first + by_b * second) / (2.0 * DIFFERENCE)

    def residual(self, a: FloatArray) -> FloatArray:
        """(m,) heat that leaves with each shape [W]."""
        residual = self.matrix @ a - self.source
        for condition in self.conditions:
            if isinstance(condition, Film | Exchange | Contact):
                residual += self._coefficient(condition, a).value * self.unit(condition, a)
            elif isinstance(condition, Radiation):
                surface = self.reduced.surface(condition.surface)
                flux = (surface.points @ a) ** 4 - condition.surroundings_temperature**4
                residual += (
                    condition.emissivity * STEFAN_BOLTZMANN * (surface.weights * flux) @ surface.points
                )
            elif isinstance(condition, Enclosure):
                residual += self.enclosures[condition].heat_out(a)
        return np.asarray(residual)

    def at(self, a: FloatArray, *, exact: bool = False) -> tuple[FloatArray, FloatArray]:
        """Residual (m,) and Jacobian (m, m) at coefficients ``a``.

        exact : with the slope of radiation point by point; else at the mean of a surface, which only costs a step
        """
        jacobian = self.matrix.copy()
        for condition in self.conditions:
            if isinstance(condition, Film | Exchange | Contact):
                jacobian += self._coefficient(condition, a).value * self._mass(condition)
                slope = self._law_slope(condition, a)
                if slope.any():
                    jacobian += np.outer(self.unit(condition, a), slope)
            elif isinstance(condition, Radiation):
                surface = self.reduced.surface(condition.surface)
                factor = 4.0 * condition.emissivity * STEFAN_BOLTZMANN
                if exact:
                    slope = factor * surface.weights * (surface.points @ a) ** 3
                    jacobian += surface.points.T @ (slope[:, None] * surface.points)
                else:
                    jacobian += factor * float(surface.mean @ a) ** 3 * surface.mass
            elif isinstance(condition, Enclosure):
                jacobian += self.enclosures[condition].slope(a)
        return self.residual(a), jacobian

    def unit(self, condition: Film | Exchange | Contact, a: FloatArray) -> FloatArray:
        """(m,) residual of a condition at a coefficient of 1 W/(m2 K)."""
        if isinstance(condition, Film):
            surface = self.reduced.surface(condition.surface)
            return np.asarray(surface.mass @ a - condition.fluid_temperature * surface.load)
        if isinstance(condition, Contact):
            return np.asarray(self.reduced.joint(condition).mass @ a)
        first, second = self._means(condition)
        jump = second - first
        return self.reduced.surface(condition.surface_a).area * float(jump @ a) * jump

    def _mass(self, condition: Film | Exchange | Contact) -> FloatArray:
        """(m, m) slope of `unit`."""
        if isinstance(condition, Film):
            return self.reduced.surface(condition.surface).mass
        if isinstance(condition, Contact):
            return self.reduced.joint(condition).mass
        first, second = self._means(condition)
        jump = second - first
        return self.reduced.surface(condition.surface_a).area * np.outer(jump, jump)

    def factor(self, jacobian: FloatArray) -> Factor:
        """Factors of a Jacobian (m, m), prescribed surfaces held by their heat."""
        if self.held:
            rows = np.array([row for row, _ in self.held])
            zero = np.zeros((len(rows), len(rows)))
            jacobian = np.block([[jacobian, -rows.T], [rows, zero]])
        lu, pivots = lu_factor(jacobian, check_finite=False)
        return np.asarray(lu), np.asarray(pivots)

    def step(self, residual: FloatArray, factor: Factor, a: FloatArray) -> FloatArray:
        """(m,) Newton step."""
        gap = [float(row @ a) - temperature for row, temperature in self.held]
        solution = lu_solve(factor, -np.append(residual, gap), check_finite=False)
        self.multipliers = solution[len(residual) :]
        return np.asarray(solution[: len(residual)])

    def links(self, a: FloatArray) -> list[Link]:
        """Every local conductance at coefficients ``a``: films, radiation, exchanges, contacts."""
        links: list[Link] = []
        nothing = np.zeros(self.reduced.size)
        for condition in self.conditions:
            if isinstance(condition, Film):
                surface = self.reduced.surface(condition.surface)
                law = self._coefficient(condition, a)
                excess = surface.area * (float(surface.mean @ a) - condition.fluid_temperature)
                slope = law.value * surface.load + excess * self._law_slope(condition, a)
                links.append(Link(condition, law.value * self.unit(condition, a), law.value * excess, slope))
            elif isinstance(condition, Exchange | Contact):
                law = self._coefficient(condition, a)
                links.append(Link(condition, law.value * self.unit(condition, a), 0.0, nothing))
            elif isinstance(condition, Radiation):
                surface = self.reduced.surface(condition.surface)
                flux = (surface.points @ a) ** 4 - condition.surroundings_temperature**4
                column = condition.emissivity * STEFAN_BOLTZMANN * (surface.weights * flux) @ surface.points
                links.append(Link(condition, np.asarray(column), 0.0, nothing))
            elif isinstance(condition, Enclosure):
                links.append(Link(condition, self.enclosures[condition].heat_out(a), 0.0, nothing))
        return links

    def answers(self, a: FloatArray, loads: FloatArray) -> FloatArray:
        """(m, k) changes of the field by loads (m, k) [W] on the shapes, with the exact Jacobian."""
        _, jacobian = self.at(a, exact=True)
        factor = self.factor(jacobian)
        whole = np.vstack([loads, np.zeros((len(self.held), loads.shape[1]))])
        return np.asarray(lu_solve(factor, whole, check_finite=False))[: len(a)]

    def balance(self, a: FloatArray) -> HeatBalance:
        """Rows of the heat balance at coefficients ``a``, two for an exchange or contact."""
        rows: list[HeatFlow] = []
        multipliers = iter(self.multipliers)
        for condition in self.conditions:
            match condition:
                case Film():
                    surface, law = self.reduced.surface(condition.surface), self._coefficient(condition, a)
                    excess = condition.fluid_temperature - float(surface.mean @ a)
                    rows.append(
                        self._row(
                            condition.surface, condition.kind, law.value * surface.area * excess, a, law
                        )
                    )
                case Radiation():
                    surface = self.reduced.surface(condition.surface)
                    flux = condition.surroundings_temperature**4 - (surface.points @ a) ** 4
                    power = condition.emissivity * STEFAN_BOLTZMANN * float(surface.weights @ flux)
                    rows.append(self._row(condition.surface, condition.kind, power, a))
                case Enclosure():
                    powers = self.enclosures[condition].powers(a)
                    for name, power in zip(condition.surfaces, powers.tolist(), strict=True):
                        rows.append(self._row(name, condition.kind, power, a))
                case Exchange() | Contact():
                    law = self._coefficient(condition, a)
                    first, second = self._means(condition)
                    area = (
                        self.reduced.joint(condition).area
                        if isinstance(condition, Contact)
                        else self.reduced.surface(condition.surface_a).area
                    )
                    power = law.value * area * float((second - first) @ a)
                    rows.append(self._row(condition.surface_a, condition.kind, power, a, law))
                    rows.append(self._row(condition.surface_b, condition.kind, -power, a, law))
                case PrescribedTemperature():
                    rows.append(self._row(condition.surface, condition.kind, float(next(multipliers)), a))
                case SurfaceSource():
                    rows.append(self._row(condition.surface, condition.kind, condition.power, a))
                case BodySource():
                    rows.append(self._body_row(condition.body, condition.kind, condition.power, a))
                case StoredHeat():
                    capacity = self.reduced.setup.heat_capacity(condition.capacity)
                    rise = self.reduced.field(a) - condition.start
                    for body in condition.capacity:
                        power = -capacity.stored(rise, body) / condition.time
                        rows.append(self._body_row(body, condition.kind, power, a))
        return HeatBalance(tuple(rows))

    def _row(
        self, surface: str, kind: str, power: float, a: FloatArray, coefficient: FilmCoefficient | None = None
    ) -> HeatFlow:
        face = self.reduced.surface(surface)
        return HeatFlow(
            surface=surface,
            kind=kind,
            power=power,
            area=face.area,
            mean_temperature=float(face.mean @ a),
            piece=face.piece,
            coefficient=coefficient,
        )

    def _body_row(self, body: str, kind: str, power: float, a: FloatArray) -> HeatFlow:
        elements = self.reduced.setup.elements
        return HeatFlow(
            surface=body,
            kind=kind,
            power=power,
            area=0.0,
            mean_temperature=float(self.reduced.body(body) @ a),
            piece=int(elements.components[elements.mesh.bodies[body][0]]),
        )
