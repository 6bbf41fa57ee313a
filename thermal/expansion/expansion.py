"""Thermal expansion of a gearbox: displacement field, rigid placement of the shafts, clearances.

Pieces that share no nodes are solved together but supported each for itself: the housing on its foot, every
shaft at its locating bearing. The housing is then placed so that its foot does not shift or turn on average
(in a foot joint the field is, and the foot follows its seat on average and slides on it without friction),
and every shaft as a rigid body so that its axis passes through the displaced centres of its bearing bores and
its locating journal sits axially in its bore. Bearing clearance and film position are not part of this: the
axis runs through the middle of the bores.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermal.expansion.alignment import (
    BearingExpansion,
    CentreDistance,
    GearExpansion,
    SealExpansion,
    ShaftAxis,
    ShaftExpansion,
)
from thermal.expansion.deformed_geometry import DeformedGeometry
from thermal.expansion.elastic import ElasticError, Known
from thermal.expansion.setup import ExpansionSetup
from thermal.fe.mesh import FloatArray

__all__ = ["Expansion", "ExpansionSetup", "expand"]


@dataclass(frozen=True, kw_only=True)
class Expansion:
    """Deformed geometry of a gearbox."""

    displacement: FloatArray
    """(n_nodes, 3) [m], relative to the foot, shafts placed in their bearings."""
    known: tuple[Known, ...]
    """Solutions from which that of a neighbouring temperature field starts."""
    bearings: dict[str, BearingExpansion]
    seals: dict[str, SealExpansion]
    shafts: dict[str, ShaftExpansion]
    gears: dict[str, GearExpansion]
    axes: dict[str, ShaftAxis]
    """Hot axis of every shaft, through its bearing bores."""
    centre_distances: tuple[CentreDistance, ...]
    """Every two gears of different shafts whose widths overlap."""
    largest_reaction: float
    """Of the statically determinate supports [N]; zero but for the tolerance of the solver."""
    iterations: int


def expand(
    setup: ExpansionSetup,
    temperature: FloatArray,
    reference_temperature: float,
    *,
    tolerance: float = 1e-8,
    start: Expansion | None = None,
) -> Expansion:
    """Expand a gearbox from ``reference_temperature`` [K], at which the model's dimensions hold.

    setup : gearbox and materials; temperature : (n_nodes,) [K]
    tolerance : of the linear solve's residual
    start : expansion under a neighbouring temperature field, which saves iterations

    Raises ElasticError (a ValueError) for input that cannot be computed, NotConverged (a RuntimeError with
    its residuals) if the linear solve stalls.
    """
    n_nodes = len(setup.model.mesh.points)
    if temperature.shape != (n_nodes,) or not np.isfinite(temperature).all():
        raise ElasticError(
            f"temperature of shape {temperature.shape}: need one finite value per node, ({n_nodes},)"
        )
    solution = setup.elastic.solve(
        temperature, reference_temperature, tolerance, () if start is None else start.known
    )
    return read_expansion(
        setup,
        temperature,
        reference_temperature,
        solution.values,
        largest_reaction=float(np.abs(solution.reactions).max()),
        known=solution.known,
        iterations=solution.iterations,
    )


def read_expansion(
    setup: ExpansionSetup,
    temperature: FloatArray,
    reference_temperature: float,
    supported: FloatArray,
    *,
    largest_reaction: float = 0.0,
    known: tuple[Known, ...] = (),
    iterations: int = 0,
) -> Expansion:
    """Place the shafts and read every clearance from a displacement on the supports of the solve.

    temperature : (n_nodes,) [K]; supported : (n_nodes, 3) [m], of this temperature
    """
    model = setup.model
    shape = DeformedGeometry(setup, temperature, reference_temperature, supported)
    return Expansion(
        displacement=shape.displacement,
        known=known,
        bearings={b.name: shape.bearing(b) for b in model.bearings},
        seals={s.name: shape.seal(s) for s in model.seals},
        shafts={s.name: shape.shaft(s) for s in model.shafts},
        gears={g.name: shape.gear(g) for g in model.gears},
        axes=shape.axes,
        centre_distances=shape.centre_distances(),
        largest_reaction=largest_reaction,
        iterations=iterations,
    )


# Deformed geometries of many temperature fields for the price of a few solves.
#
# Displacement is linear in temperature. The fields of a time run differ by few patterns: the leading ones are
# found from the fields themselves, each is expanded once, and the expansion under any field is their sum. What the
# patterns miss of a temperature is measured and kept below a limit.
# Source of the patterns (snapshots): Sirovich, Quart. Appl. Math. 45 (1987) 561.

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
