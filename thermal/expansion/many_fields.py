"""Deformed geometries of many temperature fields for the price of a few solves.

Displacement is linear in temperature. The fields of a time run differ by few patterns: the leading ones are
found from the fields themselves, each is expanded once, and the expansion under any field is their sum. What the
patterns miss of a temperature is measured and kept below a limit.
Source of the patterns (snapshots): Sirovich, Quart. Appl. Math. 45 (1987) 561.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermal.expansion.elastic import ElasticError
from thermal.expansion.expansion import Expansion, read_expansion
from thermal.expansion.setup import ExpansionSetup
from thermal.fe.mesh import FloatArray

MISSED = 0.5
"""Greatest temperature [K] that the patterns may miss at any node: 0.6 um on 100 mm of steel, were it everywhere."""

LEAST_SHARE = 1e-14
"""Patterns below this share of the strongest are rounding."""


@dataclass(frozen=True, eq=False)
class ExpansionBasis:
    """Patterns of temperature rise with their displacements.

    patterns : (k, n_nodes) [K], orthonormal; displacements : (k, n_nodes, 3) [m]
    """

    setup: ExpansionSetup
    reference: float
    patterns: FloatArray
    displacements: FloatArray
    missed: float
    """Greatest rise of the fields that the patterns do not hold [K]."""

    @classmethod
    def of(
        cls,
        setup: ExpansionSetup,
        reference: float,
        fields: Sequence[FloatArray],
        *,
        missed: float = MISSED,
        tolerance: float = 1e-5,
    ) -> "ExpansionBasis":
        """Find the patterns of ``fields`` (n_nodes,) [K] and expand them from ``reference`` [K].

        missed : limit of what they may miss [K]; tolerance : of the linear solves
        Raises ElasticError without a field, NotConverged if a solve stalls.
        """
        if not fields:
            raise ElasticError("no temperature field to expand; give at least one")
        rises = np.array([field - reference for field in fields])
        patterns, left = _patterns(rises, missed)
        shapes = [setup.elastic.solve(reference + p, reference, tolerance).values for p in patterns]
        return cls(setup, reference, patterns, np.array(shapes).reshape(*patterns.shape, 3), left)

    def shape(self, temperature: FloatArray) -> Expansion:
        """Expansion under a field (n_nodes,) [K] among or between those the basis was made of."""
        shares = self.patterns @ (temperature - self.reference)
        supported = np.tensordot(shares, self.displacements, axes=1)
        return read_expansion(self.setup, temperature, self.reference, supported)


def _patterns(rises: FloatArray, limit: float) -> tuple[FloatArray, float]:
    """Orthonormal patterns (k, n) of ``rises`` (m, n) and the greatest rise they miss."""
    sizes, turns = np.linalg.eigh(rises @ rises.T)
    order = np.argsort(sizes)[::-1]
    usable = [i for i in order if sizes[i] > LEAST_SHARE * max(float(sizes[order[0]]), 1e-300)]
    patterns = np.empty((0, rises.shape[1]))
    left = rises.copy()
    for i in usable:
        if np.abs(left).max(initial=0.0) <= limit:
            break
        pattern = turns[:, i] @ rises
        for _ in range(2):
            pattern = pattern - (patterns @ pattern) @ patterns
        pattern /= np.linalg.norm(pattern)
        patterns = np.vstack([patterns, pattern])
        left -= np.outer(left @ pattern, pattern)
    return patterns, float(np.abs(left).max(initial=0.0))
