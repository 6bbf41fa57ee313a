"""Residual and Jacobian of steady conduction under one set of boundary conditions.

The residual of node a is the heat that leaves it [W],

    R_a = int k grad N_a . grad T + films: int h(Tm) (T - Tf) N_a + radiation: int eps sigma (T^4 - Ts^4) N_a
          + exchange: int Q / A N_a  -  sources,

with Tm the area mean of the film's own surface. The Jacobian is a sparse symmetric matrix plus one rank for
every law that depends on a mean temperature and one for every exchange. Both parts enter the preconditioner:
means live in the linear space, where the small-rank part is inverted exactly.
"""

import math
from collections.abc import Mapping, Sequence

import numpy as np
from scipy import sparse

from thermal.boundary import (
    STEFAN_BOLTZMANN,
    BodySource,
    BoundaryCondition,
    Exchange,
    Film,
    PrescribedTemperature,
    Radiation,
    SurfaceSource,
)
from thermal.condition_checks import ConditionError, check_heat_paths
from thermal.fe.elements import FiniteElements, SurfaceElements
from thermal.fe.mesh import FloatArray, IndexArray
from thermal.fe.solver import LowRank, TwoLevelMultigrid, constrain

DIFFERENCE = 0.01
"""Half step of the central difference that gives the slope of a film law [K]."""

EXCHANGE_SHIFT = 1e-4
"""Share of its exchange coefficient that a body without any film gets in the coarse factor."""


class ConductionProblem:
    """Residual and Jacobian of one set of checked conditions.

    fine, coarse : conduction values of the second-order and the linear matrix [W/K]
    """

    def __init__(
        self,
        elements: FiniteElements,
        fine: FloatArray,
        coarse: FloatArray,
        conditions: Sequence[BoundaryCondition],
    ) -> None:
        self.elements = elements
        self.surfaces = elements.surfaces
        self.fine, self.coarse = fine, coarse
        self.films = [c for c in conditions if isinstance(c, Film)]
        self.radiations = [c for c in conditions if isinstance(c, Radiation)]
        self.exchanges = [c for c in conditions if isinstance(c, Exchange)]
        self.prescribed = [c for c in conditions if isinstance(c, PrescribedTemperature)]
        self.matrix = elements.fine.matrix(fine)
        self.fixed = np.zeros(len(elements.mesh.points), dtype=np.bool_)
        self.held = np.zeros(len(elements.mesh.points))
        for condition in self.prescribed:
            nodes = self.surfaces[condition.surface].nodes
            self.fixed[nodes], self.held[nodes] = True, condition.temperature
        self.source = np.zeros(len(elements.mesh.points))
        self.source_turnover = 0.0
        for source in conditions:
            if isinstance(source, SurfaceSource):
                surface = self.surfaces[source.surface]
                self.source += source.power / surface.area * surface.shares
                self.source_turnover += abs(source.power)
            elif isinstance(source, BodySource):
                share = self.elements.body_load(source.body)
                self.source += source.power / share.sum() * share
                self.source_turnover += abs(source.power)

    def start(self, initial: FloatArray | float | None) -> FloatArray:
        """First field of the iteration, prescribed nodes at their temperature."""
        if initial is None:
            given = [c.fluid_temperature for c in self.films]
            given += [c.surroundings_temperature for c in self.radiations]
            given += [c.temperature for c in self.prescribed]
            initial = math.fsum(given) / len(given) if given else 293.15
        field = np.broadcast_to(np.asarray(initial, dtype=np.float64), self.held.shape).copy()
        if not (np.isfinite(field).all() and field.min() > 0.0):
            raise ConditionError(
                "initial temperature must be finite and above 0 K at every node; give kelvin"
            )
        return np.where(self.fixed, self.held, field)

    def film_value(self, film: Film, mean: float) -> float:
        """Coefficient of a film [W/(m2 K)], checked."""
        return _checked(film.law(mean, film.fluid_temperature).value, film.surface, film.kind)

    def exchange_value(self, exchange: Exchange, mean_a: float, mean_b: float) -> float:
        """Coefficient of an exchange [W/(m2 K)], checked."""
        return _checked(exchange.law(mean_a, mean_b).value, exchange.surface_a, exchange.kind)

    def heat_out(self, temperature: FloatArray) -> tuple[FloatArray, float]:
        """Heat (n_nodes,) that leaves every node by conduction and conditions; heat turned over [W]."""
        out = self.matrix @ temperature - self.source
        turned = self.source_turnover
        for film in self.films:
            surface = self.surfaces[film.surface]
            mean = surface.mean(temperature)
            value = self.film_value(film, mean)
            out += value * surface.load(surface.at_points(temperature) - film.fluid_temperature)
            turned += value * surface.area * abs(mean - film.fluid_temperature)
        for radiation in self.radiations:
            surface = self.surfaces[radiation.surface]
            excess = surface.at_points(temperature) ** 4 - radiation.surroundings_temperature**4
            part = radiation.emissivity * STEFAN_BOLTZMANN * surface.load(excess)
            out += part
            turned += abs(float(part.sum()))
        for exchange in self.exchanges:
            a, b, mean_a, mean_b = self._sides(exchange, temperature)
            into_a = self.exchange_value(exchange, mean_a, mean_b) * a.area * (mean_b - mean_a)
            out += into_a * (b.shares / b.area - a.shares / a.area)
            turned += 2.0 * abs(into_a)
        for condition in self.prescribed:
            turned += abs(float(out[self.surfaces[condition.surface].nodes].sum()))
        return out, 0.5 * turned

    def reactions(self, temperature: FloatArray) -> FloatArray:
        """(n_nodes,) heat that holds the prescribed nodes [W], zero elsewhere."""
        return np.where(self.fixed, self.heat_out(temperature)[0], 0.0)

    def roundoff(self, temperature: FloatArray) -> float:
        """Size [W] below which the residual is rounding error."""
        return 4.0 * float(np.finfo(np.float64).eps * (abs(self.matrix) @ np.abs(temperature)).sum())

    def point_coefficients(self, temperature: FloatArray) -> dict[str, FloatArray]:
        """Surface -> (n_f, n_q) slope of the local heat flux [W/(m2 K)]: films and 4 eps sigma T^3."""
        slopes: dict[str, FloatArray] = {}
        for film in self.films:
            surface = self.surfaces[film.surface]
            value = np.full_like(surface.weights, self.film_value(film, surface.mean(temperature)))
            slopes[film.surface] = slopes.get(film.surface, 0.0) + value
        for radiation in self.radiations:
            wall = self.surfaces[radiation.surface].at_points(temperature)
            value = 4.0 * radiation.emissivity * STEFAN_BOLTZMANN * wall**3
            slopes[radiation.surface] = slopes.get(radiation.surface, 0.0) + value
        return slopes

    def jacobian(self, slopes: Mapping[str, FloatArray]) -> sparse.csr_array:
        """Symmetric part of the Jacobian with local slopes, prescribed nodes taken out."""
        values = self.fine.copy()
        for name, slope in slopes.items():
            self.surfaces[name].add_mass(values, slope)
        return constrain(self.elements.fine.matrix(values), self.fixed)

    def low_rank(self, temperature: FloatArray) -> LowRank | None:
        """Part of the Jacobian that comes from mean temperatures."""
        left: list[Column] = []
        right: list[Column] = []
        for film in self.films:
            surface = self.surfaces[film.surface]
            mean = surface.mean(temperature)
            slope = self.film_value(film, mean + DIFFERENCE) - self.film_value(film, mean - DIFFERENCE)
            if slope != 0.0:
                excess = surface.load(surface.at_points(temperature) - film.fluid_temperature)
                left.append((surface.nodes, slope / (2.0 * DIFFERENCE) * excess[surface.nodes]))
                right.append(_mean_of(surface))
        for exchange in self.exchanges:
            a, b, mean_a, mean_b = self._sides(exchange, temperature)
            by_a, by_b = self._exchange_slopes(exchange, mean_a, mean_b)
            left.append(_join(_mean_of(b), _mean_of(a), 1.0, -1.0))
            right.append(_join(_mean_of(b), _mean_of(a), a.area * by_b, a.area * by_a))
        if not left:
            return None
        free = [(nodes, np.where(self.fixed[nodes], 0.0, values)) for nodes, values in left]
        return LowRank(_columns(free, len(self.fixed)), _columns(right, len(self.fixed)))

    def _sides(
        self, exchange: Exchange, temperature: FloatArray
    ) -> tuple[SurfaceElements, SurfaceElements, float, float]:
        """Both surfaces of an exchange and their mean temperatures [K]."""
        a, b = self.surfaces[exchange.surface_a], self.surfaces[exchange.surface_b]
        return a, b, a.mean(temperature), b.mean(temperature)

    def _exchange_slopes(self, exchange: Exchange, mean_a: float, mean_b: float) -> tuple[float, float]:
        """Slopes of the heat flux h (Tb - Ta) by both mean temperatures [W/(m2 K)]."""
        value = self.exchange_value(exchange, mean_a, mean_b)
        slopes = []
        for da, db in ((DIFFERENCE, 0.0), (0.0, DIFFERENCE)):
            above = self.exchange_value(exchange, mean_a + da, mean_b + db)
            below = self.exchange_value(exchange, mean_a - da, mean_b - db)
            slopes.append((above - below) / (2.0 * DIFFERENCE) * (mean_b - mean_a))
        return slopes[0] - value, slopes[1] + value

    def multigrid(
        self, jacobian: sparse.csr_array, slopes: Mapping[str, FloatArray], temperature: FloatArray
    ) -> TwoLevelMultigrid:
        """Preconditioner around one linearisation; the heat paths are checked on the way."""
        links: dict[tuple[str, str], float] = {}
        for exchange in self.exchanges:
            means = self._sides(exchange, temperature)[2:]
            links[exchange.surface_a, exchange.surface_b] = self.exchange_value(exchange, *means)
        grounded = [name for name, slope in slopes.items() if slope.max() > 0.0]
        grounded += [c.surface for c in self.prescribed]
        loose = check_heat_paths(
            self.elements, grounded, [pair for pair, value in links.items() if value > 0.0]
        )
        values = self.coarse.copy()
        for name, slope in slopes.items():
            self.surfaces[name].add_coarse_mass(values, slope)
        for pair, value in links.items():
            for name in pair if loose else ():
                surface = self.surfaces[name]
                surface.add_coarse_mass(values, np.full_like(surface.weights, EXCHANGE_SHIFT * value))
        fixed = self.fixed[self.elements.corners]
        coarse = constrain(self.elements.coarse.matrix(values), fixed)
        return TwoLevelMultigrid(jacobian, coarse, self.elements.prolongation, self.fixed, fixed)


Column = tuple[IndexArray, FloatArray]
"""Nodes and values of a sparse column."""


def _mean_of(surface: SurfaceElements) -> Column:
    """The area mean as a functional of the nodal temperatures [-]."""
    return surface.nodes, surface.shares[surface.nodes] / surface.area


def _join(first: Column, second: Column, factor_1: float, factor_2: float) -> Column:
    """The sum of two columns times a factor each; nodes may occur twice."""
    return np.append(first[0], second[0]), np.append(factor_1 * first[1], factor_2 * second[1])


def _columns(columns: list[Column], n_rows: int) -> sparse.csc_array:
    """(n_rows, len(columns)) matrix; values of equal nodes are added."""
    rows = np.concatenate([nodes for nodes, _ in columns])
    values = np.concatenate([values for _, values in columns])
    which = np.repeat(np.arange(len(columns)), [len(nodes) for nodes, _ in columns])
    return sparse.csc_array(sparse.coo_array((values, (rows, which)), shape=(n_rows, len(columns))))


def _checked(value: float, surface: str, kind: str) -> float:
    if not (math.isfinite(value) and value >= 0.0):
        raise ConditionError(
            f"{surface}: coefficient of {kind!r} is {value} W/(m2 K); a film law must give a number >= 0"
        )
    return value
