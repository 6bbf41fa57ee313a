"""Heat stored in the solids: the capacity matrix of both spaces, and the heat content of a body."""

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np

from thermal.conditions.boundary import ConditionError
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import FloatArray
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
    (`thermal.transient.backward_differences`). Raises ConditionError for a time that is not positive and a start that
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
