"""Conductivity that depends on temperature: residual, matrix and slope of the bodies that have a law.

    R_a = int k(T) grad T . grad N_a,    dR_a/dT_b = int k grad N_b . grad N_a + int k' N_b grad T . grad N_a.

The second part of the slope is not symmetric; it is applied point by point, as part of the operator only and
not of the preconditioner.
"""

from collections.abc import Callable, Mapping

import numpy as np

from thermal.conditions.boundary import ConditionError
from thermal.fe.elements import FiniteElements
from thermal.fe.low_rank import DIFFERENCE
from thermal.fe.mesh import FloatArray
from thermal.fe.solver import Operator

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
            mine = self._body == number
            at = temperature[mine]
            found = np.broadcast_to(law(at), at.shape)
            bad = ~(np.isfinite(found) & (found > 0.0))
            if bad.any():
                raise ConditionError(
                    f"conductivity of body {name!r} is {found[bad][0]} W/(m K) at {at[bad][0]:.6g} K; it must be "
                    "positive at every temperature that occurs: limit the law to its range"
                )
            result[mine] = found
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
        at = fine.at_points(temperature, self._cells)
        rise = (self.value(at + DIFFERENCE) - self.value(at - DIFFERENCE)) / (2.0 * DIFFERENCE)
        flux = _scaled(rise, fine.gradient(temperature, self._cells))

        def apply(x: FloatArray) -> FloatArray:
            return fine.flux_load(_scaled(fine.at_points(x, self._cells), flux), self._cells)

        return apply


def _scaled(factor: FloatArray, vectors: FloatArray) -> FloatArray:
    """(n, n_q, 3) vectors times (n, n_q) factors."""
    return np.asarray(factor[:, :, np.newaxis] * vectors)
