"""Heat stored in the solids: the capacity matrix of both spaces, and the heat content of a body."""

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass

import numpy as np

from thermal.conditions.boundary import ConditionError
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import FloatArray
from thermal.fe.solver import DIFFERENCE, Operator
from thermal.forms import heat_capacity


class HeatCapacity:
    """Capacity matrices of a mesh, assembled once for all time steps.

    capacity : body -> density times specific heat [J/(m3 K)]
    Raises ConditionError for missing, unknown or not positive values.
    """

    def __init__(self, elements: FiniteElements, capacity: Mapping[str, float]) -> None:
        check_capacity(elements.mesh.bodies, capacity)
        self.elements = elements
        self.capacity = dict(capacity)
        per_cell = elements.per_cell(self.capacity)
        self.fine = elements.assemble(heat_capacity, elements.fine, capacity=per_cell)
        """(nnz,) values of the second-order matrix [J/K]."""
        self.coarse = elements.assemble(heat_capacity, elements.coarse, capacity=per_cell)
        """Values of the linear matrix [J/K]."""
        self.matrix = elements.fine.matrix(self.fine)

    def stored(self, rise: FloatArray, body: str) -> float:
        """Heat [J] that a body takes up when its nodes warm by ``rise`` (n_nodes,) [K]."""
        values, volumes = self.elements.at_points(rise, self.elements.mesh.bodies[body])
        return self.capacity[body] * float(values @ volumes)


@dataclass(frozen=True)
class Storage:
    """Heat taken up per time at the end of an implicit stage: rate C (T - T_base), rate = 1/(step share)."""

    capacity: HeatCapacity
    volumes: FloatArray
    """(m,) heat capacity of the volumes [J/K]."""
    rate: float
    """[1/s]"""
    base: FloatArray
    """(n_nodes + m,) [K]"""

    def heat_out(self, field: FloatArray) -> FloatArray:
        """(n_nodes + m,) heat per time that goes into storage [W]."""
        rise = field - self.base
        n = len(rise) - len(self.volumes)
        return self.rate * np.append(self.capacity.matrix @ rise[:n], self.volumes * rise[n:])


@dataclass(frozen=True, kw_only=True)
class StoredHeat:
    """Bodies that still warm up: a condition on all of them in addition to those of the surfaces.

    Every body takes up rho c (T - start)/time per volume, which is one implicit step. From room temperature alone it
    leaves tau/(tau + time) of a rise missing for a time constant tau where exp(-time/tau) is right: march with several
    (`thermal.transient.time_steps`). Raises ConditionError for a time that is not positive and a start that
    is not above 0 K.
    """

    capacity: Mapping[str, float]
    """Body -> density times specific heat [J/(m3 K)]."""
    start: float | FloatArray
    """Temperature that the step counts from [K]: one value, or (n_nodes,)."""
    time: float
    """Length of the step [s]: the rate of change at its end is (T - start)/time."""
    kind: str = "stored"
    """Row name in the heat balance."""

    def rate(self, field: FloatArray) -> FloatArray:
        """(n_nodes,) rate of change [K/s] at the end of the step; field : (n_nodes,) temperatures there [K]."""
        return np.asarray((field - self.start) / self.time)

    def __post_init__(self) -> None:
        if not (math.isfinite(self.time) and self.time > 0.0):
            raise ConditionError(
                f"stored heat: time = {self.time} s must be above 0; leave it out when steady"
            )
        if not (np.all(np.isfinite(self.start)) and np.min(self.start) > 0.0):
            coldest = float(np.min(self.start))
            raise ConditionError(f"stored heat: start = {coldest} K must be above 0 K; give kelvin")


def check_capacity(bodies: Collection[str], capacity: Mapping[str, float]) -> None:
    """Check that every body has a positive heat capacity [J/(m3 K)] and no other is named (ConditionError)."""
    missing, unknown = sorted(set(bodies) - set(capacity)), sorted(set(capacity) - set(bodies))
    if missing or unknown:
        raise ConditionError(
            f"heat capacity: none for body {', '.join(missing) or '-'}, unknown body {', '.join(unknown) or '-'}; "
            "give one for every body of the mesh"
        )
    for name, value in capacity.items():
        if not (math.isfinite(value) and value > 0.0):
            raise ConditionError(f"heat capacity of body {name!r} is {value} J/(m3 K); it must be positive")


# Conductivity that depends on temperature: residual, matrix and slope of the bodies that have a law.
#
#     R_a = int k(T) grad T . grad N_a,    dR_a/dT_b = int k grad N_b . grad N_a + int k' N_b grad T . grad N_a.
#
# The second part of the slope is not symmetric; it is applied point by point, as part of the operator only and
# not of the preconditioner.

ConductivityLaw = Callable[[FloatArray], FloatArray]
"""Conductivity [W/(m K)] at temperatures (n, n_q) [K], smooth and positive."""

Conductivity = float | ConductivityLaw
"""A number [W/(m K)] or a law."""


class VariableConduction:
    """Heat conduction in the bodies whose conductivity is a law.

    laws : body -> law, at least one
    """

    def __init__(self, elements: FiniteElements, laws: Mapping[str, ConductivityLaw]) -> None:
        self._elements = elements
        self._laws = list(laws.items())
        body = np.full(len(elements.mesh.cells), -1)
        for number, (name, _) in enumerate(self._laws):
            body[elements.mesh.bodies[name]] = number
        self._cells = np.flatnonzero(body >= 0).astype(np.int32)
        self._body = body[self._cells]

    def value(self, temperature: FloatArray) -> FloatArray:
        """(n, n_q) conductivity at the points of these bodies [W/(m K)]; ConditionError if not positive.

        temperature : (n, n_q) at the same points [K]
        """
        result = np.empty_like(temperature)
        for number, (name, law) in enumerate(self._laws):
            of_law = self._body == number
            local = temperature[of_law]
            conductivity = np.broadcast_to(law(local), local.shape)
            bad = ~(np.isfinite(conductivity) & (conductivity > 0.0))
            if bad.any():
                raise ConditionError(
                    f"conductivity of body {name!r} is {conductivity[bad][0]} W/(m K) at {local[bad][0]:.6g} K; it "
                    "must be positive at every temperature that occurs: limit the law to its range"
                )
            result[of_law] = conductivity
        return result

    def heat_out(self, temperature: FloatArray) -> FloatArray:
        """(n_nodes,) heat that leaves every node by conduction in these bodies [W]."""
        fine = self._elements.fine
        value = self.value(fine.at_points(temperature, self._cells))
        return fine.flux_load(_scaled(value, fine.gradient(temperature, self._cells)), self._cells)

    def fine_values(self, temperature: FloatArray) -> FloatArray:
        """Second-order matrix values (nnz,) [W/K] of k(T) grad u . grad v in these bodies."""
        return self._values(temperature, coarse=False)

    def coarse_values(self, temperature: FloatArray) -> FloatArray:
        """Linear matrix values (nnz,) [W/K] of k(T) grad u . grad v in these bodies."""
        return self._values(temperature[self._elements.corners], coarse=True)

    def _values(self, temperature: FloatArray, *, coarse: bool) -> FloatArray:
        level = self._elements.coarse if coarse else self._elements.fine
        conductivity = np.zeros(level.volumes.shape)
        conductivity[self._cells] = self.value(level.at_points(temperature, self._cells))
        return level.conduction(conductivity)

    def slope(self, temperature: FloatArray) -> Operator:
        """The operator x -> int k' x grad T . grad N_a."""
        fine = self._elements.fine
        local = fine.at_points(temperature, self._cells)
        rise = (self.value(local + DIFFERENCE) - self.value(local - DIFFERENCE)) / (2.0 * DIFFERENCE)
        flux = _scaled(rise, fine.gradient(temperature, self._cells))

        def apply(x: FloatArray) -> FloatArray:
            return fine.flux_load(_scaled(fine.at_points(x, self._cells), flux), self._cells)

        return apply


def _scaled(factor: FloatArray, vectors: FloatArray) -> FloatArray:
    """(n, n_q, 3) vectors times (n, n_q) factors."""
    return np.asarray(factor[:, :, np.newaxis] * vectors)
