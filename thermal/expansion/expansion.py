"""Thermal expansion of a gearbox: displacement field, rigid placement of the shafts, clearances.

Pieces that share no nodes are solved together but supported each for itself: the housing on its foot, every
shaft at its locating bearing. The housing is then placed so that its foot does not shift or turn on average
(in a foot joint the field is, and the foot follows its seat on average and slides on it without friction),
and every shaft as a rigid body so that its axis passes through the displaced centres of its bearing bores and
its locating journal sits axially in its bore. Bearing clearance and film position are not part of this: the
axis runs through the middle of the bores.
"""

from dataclasses import dataclass

import numpy as np

from thermal.expansion.alignment import ShaftAxis
from thermal.expansion.clearances import (
    BearingExpansion,
    CentreDistance,
    GearExpansion,
    SealExpansion,
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
