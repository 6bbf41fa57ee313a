"""Residual and Jacobian of conduction under one set of conditions.

The unknowns are the temperatures of the nodes followed by those of the volumes of thermal.conditions.streams. The
residual of node a is the heat that leaves it [W],

    R_a = int k grad N_a . grad T + what films, radiation, exchanges, contacts, enclosures and volumes take
          + heat stored per time  -  sources.

The Jacobian is a sparse symmetric matrix plus one rank for every law that depends on a mean temperature, for
every exchange, every surface of an enclosure and every film of a volume; the volumes themselves are
eliminated. Both parts enter the preconditioner: means live in the linear space, where the small-rank part is
inverted exactly.
"""

import copy
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from scipy import sparse

from thermal.conditions.boundary import (
    BodySource,
    ConditionError,
    Exchange,
    Film,
    PrescribedTemperature,
    Radiation,
    SurfaceSource,
)
from thermal.conditions.contact import Contact, SurfaceJoint
from thermal.conditions.enclosure import Enclosure, EnclosureTerms
from thermal.conditions.streams import StreamNetwork, volume_links
from thermal.conduction.capacity import Storage, StoredHeat
from thermal.conduction.setup import Condition, ConductionSetup, check_heat_paths
from thermal.conduction.stream_terms import Elimination, VolumeTerms, checked_value, eliminate
from thermal.fe.direct_factor import MOST_NODES, DirectFactor
from thermal.fe.elements import FiniteElements, SurfaceElements
from thermal.fe.mesh import FloatArray
from thermal.fe.solver import (
    DIFFERENCE,
    BoolArray,
    Column,
    HeldMatrix,
    LowRank,
    Operator,
    Product,
    TwoLevelMultigrid,
    combined,
    constrain,
    mean_of,
    stack,
)
from thermal.films.law import STEFAN_BOLTZMANN

EXCHANGE_SHIFT = 1e-4
"""Share of its exchange coefficient that a body without any film gets in the coarse factor."""

OFF_REST = 1.0
"""Step [K] by which pieces and volumes start apart: laws of free convection give nothing at rest."""


@dataclass(frozen=True)
class Linearisation:
    """The Jacobian around one field, volumes eliminated: what a Newton step solves with."""

    matrix: sparse.csr_array
    low_rank: LowRank | None
    """What mean temperatures and volumes add."""
    elimination: Elimination | None
    conductivity_slope: Operator | None
    fixed: BoolArray
    """(n_nodes,)"""

    def load(self, residual: FloatArray) -> FloatArray:
        """(n_nodes,) right-hand side of a step from the whole residual."""
        n = len(self.fixed)
        load = -residual[:n]
        if self.elimination is not None:
            nodes, values = self.elimination.node_load(residual[n:])
            load = load - np.bincount(nodes, values, minlength=n)
        return np.where(self.fixed, 0.0, load)

    def whole(self, residual: FloatArray, step: FloatArray) -> FloatArray:
        """The step of nodes and volumes from that of the nodes."""
        if self.elimination is None:
            return step
        return np.append(step, self.elimination.volume_step(residual[len(step) :], step))

    @property
    def symmetric(self) -> bool:
        """Whether the matrix is all there is; it is positive definite."""
        return self.low_rank is None and self.conductivity_slope is None

    @cached_property
    def _product(self) -> Product:
        return Product(self.matrix)

    def __call__(self, x: FloatArray) -> FloatArray:
        """Apply the reduced Jacobian to (n_nodes,)."""
        y = self._product @ x
        if self.low_rank is not None:
            y = y + self.low_rank @ x
        if self.conductivity_slope is not None:
            y = y + np.where(self.fixed, 0.0, self.conductivity_slope(x))
        return np.asarray(y)


class Preconditioner(Protocol):
    """An approximate inverse that knows the small-rank part of the Jacobian."""

    def __call__(self, residual: FloatArray) -> FloatArray:
        """Apply it to (n_nodes,)."""
        ...

    def set_low_rank(self, low_rank: LowRank | None) -> None:
        """Replace the small-rank part."""
        ...


class ConductionProblem:
    """Residual and Jacobian of one set of checked conditions."""

    def __init__(self, setup: ConductionSetup, conditions: Sequence[Condition]) -> None:
        self.setup = setup
        self.elements = elements = setup.elements
        self.surfaces = elements.surfaces
        self.conditions = tuple(conditions)
        self._conduction = Product(elements.fine.matrix(setup.fine))
        self.walls = SurfaceTerms(
            elements,
            [c for c in conditions if isinstance(c, Film)],
            [c for c in conditions if isinstance(c, Radiation)],
            [c for c in conditions if isinstance(c, Exchange)],
        )
        contacts = [c for c in conditions if isinstance(c, Contact)]
        self.contacts = ContactTerms(contacts, [setup.joint(c) for c in contacts])
        self.enclosures = [EnclosureTerms(elements, c) for c in conditions if isinstance(c, Enclosure)]
        self.networks = [c for c in conditions if isinstance(c, StreamNetwork)]
        self.volumes = VolumeTerms(elements, self.networks)
        self.storage: Storage | None = None
        """Of a time step."""
        self.n_nodes = n = len(elements.mesh.points)
        self.stores = tuple(self._stored(c) for c in conditions if isinstance(c, StoredHeat))
        """All that is stored, that of a time step last."""
        self.fixed = np.zeros(n, dtype=np.bool_)
        self.held = np.zeros(n)
        self.prescribed = [c for c in conditions if isinstance(c, PrescribedTemperature)]
        for condition in self.prescribed:
            nodes = self.surfaces[condition.surface].nodes
            self.fixed[nodes], self.held[nodes] = True, condition.temperature
        self._add_sources(conditions)

    def _add_sources(self, conditions: Sequence[Condition]) -> None:
        self.source = np.zeros(self.n_nodes)
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

    def _stored(self, condition: StoredHeat) -> Storage:
        m = len(self.volumes)
        return Storage(
            self.setup.heat_capacity(condition.capacity),
            np.zeros(m),
            1.0 / condition.time,
            np.append(np.broadcast_to(condition.start, (self.n_nodes,)), np.zeros(m)),
        )

    def storing(self, storage: Storage) -> "ConductionProblem":
        """The same problem with heat stored over a time step."""
        problem = copy.copy(self)
        problem.storage = storage
        problem.stores = (*self.stores, storage)
        return problem

    def start(self, initial: FloatArray | float | None) -> FloatArray:
        """First unknowns of the iteration, prescribed nodes at their temperature.

        initial : (n_nodes,) or (n_nodes + m,) field or one value [K]; near the mean of all given ones if None
        """
        m = len(self.volumes)
        if initial is None:
            given = [c.fluid_temperature for c in self.walls.films]
            given += [c.surroundings_temperature for c in self.walls.radiations]
            given += [c.temperature for c in self.prescribed] + self.volumes.given
            rooms = (terms.enclosure.opening_temperature for terms in self.enclosures)
            given += [room for room in rooms if room is not None]
            mean = math.fsum(given) / len(given) if given else 293.15
            initial = np.asarray(mean + OFF_REST * (1.0 + self.elements.piece_of_node))
        field = np.asarray(initial, dtype=np.float64)
        if field.shape == (self.n_nodes + m,):
            field, volumes = field[: self.n_nodes], field[self.n_nodes :]
        else:
            volumes = np.full(m, float(field.mean()) - OFF_REST)
        field = np.broadcast_to(field, self.held.shape)
        whole = np.append(np.where(self.fixed, self.held, field), volumes)
        if not (np.isfinite(whole).all() and min(field.min(), whole.min()) > 0.0):
            raise ConditionError(
                "initial temperature must be finite and above 0 K at every node; give kelvin"
            )
        return whole

    def heat_out(self, field: FloatArray) -> tuple[FloatArray, float]:
        """Heat (n_nodes + m,) that leaves every node and volume; heat turned over [W]."""
        n = self.n_nodes
        temperature, volumes = field[:n], field[n:]
        nodes = np.asarray(self._conduction @ temperature - self.source)
        turned = self.source_turnover
        if self.setup.variable is not None:
            nodes += self.setup.variable.heat_out(temperature)
        for heat_out in (self.walls.heat_out, self.contacts.heat_out, *(e.heat_out for e in self.enclosures)):
            part, size = heat_out(temperature)
            nodes += part
            turned += size
        films, fluid, size = self.volumes.heat_out(temperature, volumes)
        out = np.append(nodes + films, fluid)
        turned += size
        for storage in self.stores:
            stored = storage.heat_out(field)
            out += stored
            turned += self._stored_turnover(stored)
        for condition in self.prescribed:
            turned += abs(float(out[self.surfaces[condition.surface].nodes].sum()))
        return out, 0.5 * turned

    def _stored_turnover(self, stored: FloatArray) -> float:
        """Sum of the sizes of the heats stored in each piece and volume [W]."""
        pieces = np.bincount(self.elements.piece_of_node, stored[: self.n_nodes])
        return float(np.abs(pieces).sum() + np.abs(stored[self.n_nodes :]).sum())

    def residual(self, out: FloatArray) -> FloatArray:
        """`heat_out` with the prescribed nodes taken out."""
        return np.where(np.append(self.fixed, np.zeros(len(self.volumes), dtype=np.bool_)), 0.0, out)

    def reactions(self, field: FloatArray) -> FloatArray:
        """(n_nodes,) heat that holds the prescribed nodes [W], zero elsewhere."""
        return np.where(self.fixed, self.heat_out(field)[0][: self.n_nodes], 0.0)

    def roundoff(self, field: FloatArray) -> float:
        """Size [W] below which the residual is rounding error."""
        temperature = np.abs(field[: self.n_nodes])
        size = float(self.setup.size @ temperature)
        joints = self.contacts.matrix(field[: self.n_nodes])
        if joints is not None:
            size += float((abs(joints) @ temperature).sum())
        for storage in self.stores:
            size += storage.rate * float((storage.capacity.matrix @ temperature).sum())
            size += storage.rate * float(storage.volumes @ np.abs(field[self.n_nodes :]))
        size += float(self.volumes.rate @ np.abs(field[self.n_nodes :]))
        return 4.0 * float(np.finfo(np.float64).eps) * size

    def point_coefficients(self, temperature: FloatArray) -> dict[str, FloatArray]:
        """Surface -> (n_f, n_q) slope of the local heat flux [W/(m2 K)] that leaves through it."""
        slopes = self.walls.slopes(temperature)
        for terms in self.enclosures:
            for name, slope in terms.slopes(temperature).items():
                slopes[name] = slopes.get(name, 0.0) + slope
        return slopes

    def linearise(self, field: FloatArray) -> Linearisation:
        """The Jacobian at a field, prescribed nodes taken out."""
        temperature = field[: self.n_nodes]
        values = self.setup.fine.copy()
        slope: Operator | None = None
        if self.setup.variable is not None:
            values += self.setup.variable.fine_values(temperature)
            slope = self.setup.variable.slope(temperature)
        for name, local in self._local_slopes(field).items():
            self.surfaces[name].add_mass(values, local)
        for storage in self.stores:
            values += storage.rate * storage.capacity.fine
        matrix = self.elements.fine.matrix(values)
        joints = self.contacts.matrix(temperature)
        if joints is not None:
            matrix = sparse.csr_array(matrix + joints)
        columns = self.walls.columns(temperature) + self.contacts.columns(temperature)
        for terms in self.enclosures:
            columns += terms.columns(temperature)
        elimination = None
        if len(self.volumes):
            volumes = field[self.n_nodes :]
            stored = (
                np.zeros(len(volumes)) if self.storage is None else self.storage.rate * self.storage.volumes
            )
            elimination = eliminate(self.volumes, temperature, volumes, stored)
            columns += elimination.columns
        return Linearisation(
            matrix=constrain(matrix, self.fixed, overwrite=True),
            low_rank=self._low_rank(columns),
            elimination=elimination,
            conductivity_slope=slope,
            fixed=self.fixed,
        )

    def _low_rank(self, columns: list[tuple[Column, Column]]) -> LowRank | None:
        columns = [(left, right) for left, right in columns if len(left[0]) and len(right[0])]
        if not columns:
            return None
        free = [(nodes, np.where(self.fixed[nodes], 0.0, values)) for (nodes, values), _ in columns]
        return LowRank(stack(free, self.n_nodes), stack([right for _, right in columns], self.n_nodes))

    def _local_slopes(self, field: FloatArray) -> dict[str, FloatArray]:
        """Local slopes of all conditions, films of volumes included."""
        n = self.n_nodes
        slopes = self.point_coefficients(field[:n])
        terms = self.volumes
        state = terms.state(terms.means(field[:n]), field[n:])
        for film, value in zip(terms.films, state.coefficient, strict=True):
            surface = self.surfaces[film.surface]
            slopes[film.surface] = slopes.get(film.surface, 0.0) + np.full_like(surface.weights, value)
        return slopes

    def check_paths(self, field: FloatArray, *, storing: bool = False) -> None:
        """Check that the temperature of every piece and volume is determined (ConditionError).

        storing : True where heat capacities count as well, in a transient
        """
        temperature = field[: self.n_nodes]
        slopes = self.walls.slopes(temperature)
        grounded = [name for name, slope in slopes.items() if slope.max() > 0.0]
        grounded += [c.surface for c in self.prescribed]
        links = [*self.walls.links(temperature), *self.contacts.links(temperature)]
        for terms in self.enclosures:
            grounded += terms.grounded
            links += terms.links
        if storing:
            grounded += [*self.surfaces, *(v.name for v in self.volumes.volumes if v.heat_capacity > 0.0)]
        for volume, other in volume_links(self.networks):
            if other is None:
                grounded.append(volume)
            else:
                links.append((volume, other))
        state = self.volumes.state(self.volumes.means(temperature), field[self.n_nodes :])
        for film, value in zip(self.volumes.films, state.coefficient, strict=True):
            if value > 0.0:
                links.append((film.surface, film.volume))
        check_heat_paths(self.elements, grounded, links, list(self.volumes.index))

    def preconditioner(self, linear: Linearisation, field: FloatArray) -> "Preconditioner":
        """For the system of a Newton step and those near it; factors for time steps on a small mesh."""
        made: Preconditioner
        if self.storage is not None and self.n_nodes <= MOST_NODES:
            made = DirectFactor(linear.matrix, self.elements.mesh.points)
        else:
            made = self.multigrid(linear, field)
        made.set_low_rank(linear.low_rank)
        return made

    def multigrid(self, linear: Linearisation, field: FloatArray) -> TwoLevelMultigrid:
        """Preconditioner around one linearisation."""
        fixed = self.fixed[self.elements.corners]
        return TwoLevelMultigrid(
            HeldMatrix(linear.matrix, self.fixed),
            HeldMatrix(self.linear_matrix(field), fixed),
            self.elements.prolongation,
        )

    def linear_matrix(self, field: FloatArray) -> sparse.csr_array:
        """Sparse part of the Jacobian on the linear space (n_corners, n_corners), prescribed corners taken out."""
        temperature = field[: self.n_nodes]
        values = self.setup.coarse.copy()
        if self.setup.variable is not None:
            values += self.setup.variable.coarse_values(temperature)
        slopes = self._local_slopes(field)
        for name, slope in slopes.items():
            self.surfaces[name].add_coarse_mass(values, slope)
        for storage in self.stores:
            values += storage.rate * storage.capacity.coarse
        if not self.stores:
            self._shift_exchanges(values, slopes, temperature)
        coarse = self.elements.coarse.matrix(values)
        joints = self.contacts.matrix(temperature)
        if joints is not None:
            up = self.elements.prolongation
            coarse = sparse.csr_array(coarse + up.T @ joints @ up)
        return constrain(coarse, self.fixed[self.elements.corners], overwrite=True)

    def _shift_exchanges(
        self, values: FloatArray, slopes: Mapping[str, FloatArray], temperature: FloatArray
    ) -> None:
        """Keep the coarse factor regular where a piece is held by exchanges only (they are of small rank)."""
        firm = {self.surfaces[name].piece for name, slope in slopes.items() if slope.max() > 0.0}
        firm |= {self.surfaces[c.surface].piece for c in self.prescribed}
        if len(firm) == int(self.elements.components.max()) + 1:
            return
        for pair, value in self.walls.links(temperature).items():
            for name in pair:
                surface = self.surfaces[name]
                surface.add_coarse_mass(values, np.full_like(surface.weights, EXCHANGE_SHIFT * value))


# Residual and Jacobian of the contacts of a model.


class ContactTerms:
    """All contacts with their joints."""

    def __init__(self, contacts: Sequence[Contact], joints: Sequence[SurfaceJoint]) -> None:
        self.contacts, self.joints = contacts, joints
        self._jumps = [joint.jump for joint in joints]
        self._units = [
            sparse.csr_array(jump.T @ (sparse.diags_array(joint.weights) @ jump))
            for jump, joint in zip(self._jumps, joints, strict=True)
        ]
        """(n_nodes, n_nodes) matrix of each contact at 1 W/(m2 K) [m2]."""
        self._means = [(joint.mean(joint.side_a), joint.mean(joint.side_b)) for joint in joints]

    def values(self, temperature: FloatArray) -> list[float]:
        """Conductance of every contact [W/(m2 K)]."""
        return [
            _value(contact, float(a @ temperature), float(b @ temperature))
            for contact, (a, b) in zip(self.contacts, self._means, strict=True)
        ]

    def heat_out(self, temperature: FloatArray) -> tuple[FloatArray, float]:
        """Heat (n_nodes,) that leaves every node; sum of the flows' sizes [W]."""
        out = np.zeros(len(temperature))
        turned = 0.0
        values = self.values(temperature)
        for value, jump, joint in zip(values, self._jumps, self.joints, strict=True):
            flow = value * joint.weights * (jump @ temperature)
            out += jump.T @ flow
            turned += 2.0 * abs(float(flow.sum()))
        return out, turned

    def matrix(self, temperature: FloatArray) -> sparse.csr_array | None:
        """Symmetric part of the Jacobian [W/K]; None without contacts."""
        total: sparse.csr_array | None = None
        for value, unit in zip(self.values(temperature), self._units, strict=True):
            total = value * unit if total is None else total + value * unit
        return total

    def columns(self, temperature: FloatArray) -> list[tuple[Column, Column]]:
        """What conductances that follow the mean temperatures add to the Jacobian."""
        columns = []
        for contact, (a, b), unit in zip(self.contacts, self._means, self._units, strict=True):
            t_a, t_b = float(a @ temperature), float(b @ temperature)
            by_a = _value(contact, t_a + DIFFERENCE, t_b) - _value(contact, t_a - DIFFERENCE, t_b)
            by_b = _value(contact, t_a, t_b + DIFFERENCE) - _value(contact, t_a, t_b - DIFFERENCE)
            if by_a != 0.0 or by_b != 0.0:
                slope = (by_a * a + by_b * b) / (2.0 * DIFFERENCE)
                columns.append((_column(unit @ temperature), _column(slope)))
        return columns

    def links(self, temperature: FloatArray) -> list[tuple[str, str]]:
        """Pairs of surfaces that pass heat."""
        values = zip(self.contacts, self.values(temperature), strict=True)
        return [(c.surface_a, c.surface_b) for c, value in values if value > 0.0]


def _value(contact: Contact, mean_a: float, mean_b: float) -> float:
    return checked_value(contact.law(mean_a, mean_b).value, contact.surface_a, contact.kind)


def _column(values: FloatArray) -> Column:
    nodes = np.flatnonzero(values).astype(np.int32)
    return nodes, values[nodes]


# Residual and Jacobian of films, radiation to surroundings and exchange between area means.
#
# A film's coefficient follows the area mean of its own surface, an exchange the means of both: each adds one
# rank to the Jacobian in addition to the local slope of the heat flux.


class SurfaceTerms:
    """All conditions of these three kinds."""

    def __init__(
        self,
        elements: FiniteElements,
        films: Sequence[Film],
        radiations: Sequence[Radiation],
        exchanges: Sequence[Exchange],
    ) -> None:
        self._surfaces = elements.surfaces
        self.films, self.radiations, self.exchanges = films, radiations, exchanges

    def heat_out(self, temperature: FloatArray) -> tuple[FloatArray, float]:
        """Heat (n_nodes,) that leaves every node; sum of the flows' sizes [W]."""
        out = np.zeros(len(temperature))
        turned = 0.0
        for film in self.films:
            surface = self._surfaces[film.surface]
            mean = surface.mean(temperature)
            value = _film_value(film, mean)
            out += value * surface.load(surface.at_points(temperature) - film.fluid_temperature)
            turned += value * surface.area * abs(mean - film.fluid_temperature)
        for radiation in self.radiations:
            surface = self._surfaces[radiation.surface]
            excess = surface.at_points(temperature) ** 4 - radiation.surroundings_temperature**4
            part = radiation.emissivity * STEFAN_BOLTZMANN * surface.load(excess)
            out += part
            turned += abs(float(part.sum()))
        for exchange in self.exchanges:
            a, b, mean_a, mean_b = self._sides(exchange, temperature)
            into_a = _exchange_value(exchange, mean_a, mean_b) * a.area * (mean_b - mean_a)
            out += into_a * (b.shares / b.area - a.shares / a.area)
            turned += 2.0 * abs(into_a)
        return out, turned

    def slopes(self, temperature: FloatArray) -> dict[str, FloatArray]:
        """Surface -> (n_f, n_q) slope of the local heat flux [W/(m2 K)]: films and 4 eps sigma T^3."""
        slopes: dict[str, FloatArray] = {}
        for film in self.films:
            surface = self._surfaces[film.surface]
            value = np.full_like(surface.weights, _film_value(film, surface.mean(temperature)))
            slopes[film.surface] = slopes.get(film.surface, 0.0) + value
        for radiation in self.radiations:
            wall = self._surfaces[radiation.surface].at_points(temperature)
            value = 4.0 * radiation.emissivity * STEFAN_BOLTZMANN * wall**3
            slopes[radiation.surface] = slopes.get(radiation.surface, 0.0) + value
        return slopes

    def columns(self, temperature: FloatArray) -> list[tuple[Column, Column]]:
        """Left and right columns of what comes from mean temperatures."""
        columns: list[tuple[Column, Column]] = []
        for film in self.films:
            surface = self._surfaces[film.surface]
            mean = surface.mean(temperature)
            slope = _film_value(film, mean + DIFFERENCE) - _film_value(film, mean - DIFFERENCE)
            if slope != 0.0:
                excess = surface.load(surface.at_points(temperature) - film.fluid_temperature)
                left = (surface.nodes, slope / (2.0 * DIFFERENCE) * excess[surface.nodes])
                columns.append((left, mean_of(surface)))
        for exchange in self.exchanges:
            a, b, mean_a, mean_b = self._sides(exchange, temperature)
            by_a, by_b = _exchange_slopes(exchange, mean_a, mean_b)
            left = combined([(1.0, mean_of(b)), (-1.0, mean_of(a))])
            columns.append((left, combined([(a.area * by_b, mean_of(b)), (a.area * by_a, mean_of(a))])))
        return columns

    def links(self, temperature: FloatArray) -> dict[tuple[str, str], float]:
        """Pairs of surfaces that exchange heat -> coefficient [W/(m2 K)], zeros left out."""
        values = {
            (e.surface_a, e.surface_b): _exchange_value(e, *self._sides(e, temperature)[2:])
            for e in self.exchanges
        }
        return {pair: value for pair, value in values.items() if value > 0.0}

    def _sides(
        self, exchange: Exchange, temperature: FloatArray
    ) -> tuple[SurfaceElements, SurfaceElements, float, float]:
        """Both surfaces of an exchange and their mean temperatures [K]."""
        a, b = self._surfaces[exchange.surface_a], self._surfaces[exchange.surface_b]
        return a, b, a.mean(temperature), b.mean(temperature)


def _film_value(film: Film, mean: float) -> float:
    return checked_value(film.law(mean, film.fluid_temperature).value, film.surface, film.kind)


def _exchange_value(exchange: Exchange, mean_a: float, mean_b: float) -> float:
    return checked_value(exchange.law(mean_a, mean_b).value, exchange.surface_a, exchange.kind)


def _exchange_slopes(exchange: Exchange, mean_a: float, mean_b: float) -> tuple[float, float]:
    """Slopes of the heat flux h (Tb - Ta) by both mean temperatures [W/(m2 K)]."""
    value = _exchange_value(exchange, mean_a, mean_b)
    slopes = []
    for da, db in ((DIFFERENCE, 0.0), (0.0, DIFFERENCE)):
        above = _exchange_value(exchange, mean_a + da, mean_b + db)
        below = _exchange_value(exchange, mean_a - da, mean_b - db)
        slopes.append((above - below) / (2.0 * DIFFERENCE) * (mean_b - mean_a))
    return slopes[0] - value, slopes[1] + value
