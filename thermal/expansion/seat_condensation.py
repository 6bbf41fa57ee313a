"""Stiffness and mass of a housing at its bearing seats, condensed from its finite-element mesh.

A seat moves by the area mean of its bore's displacement, across the axis and along it; a force on it is spread evenly
over the bore, which is the same condition read as a load, so that the compliance is symmetric. So does the thrust of a
bearing that locates its shaft press on the whole bore, not on the ring of its shoulder. The housing stands bolted:
every node of its foot is held. The mass is that of the static shapes (R. J. Guyan, AIAA J. 3 (1965) 380).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from thermal.expansion.elastic import ElasticError, ElasticSetup, three_two_one
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import FloatArray
from thermal.housing.stations import GearboxModel

SEAT_MOTIONS = (1, 2, 0)
"""Directions of a seat: y, z across the axis, x along it."""


@dataclass(frozen=True, kw_only=True, eq=False)
class CondensedSeats:
    """Seats of k bearings on one housing.

    names : of the bearing stations; stiffness, mass : (3 k, 3 k) in the order y, z, x of each [N/m], [kg]
    """

    names: tuple[str, ...]
    stiffness: FloatArray
    mass: FloatArray


def condense_seats(
    model: GearboxModel,
    elastic: Mapping[str, tuple[float, float, float]],
    densities: Mapping[str, float],
    elements: FiniteElements | None = None,
    *,
    tolerance: float = 1e-8,
) -> CondensedSeats:
    """Condense a housing to its bearing seats.

    elastic : body -> (Young's modulus [Pa], Poisson's ratio, expansion coefficient [1/K])
    densities : body -> [kg/m3]; elements : spaces on the mesh of the model; tolerance : of the linear solves

    Raises ElasticError for a model without bearings or bad materials, ThermalNotConverged if a solve stalls.
    """
    if not model.bearings:
        raise ElasticError(
            f"no bearing seat to condense to: {model.no_expansion or 'give a model with bearings'}"
        )
    spaces = FiniteElements(model.mesh) if elements is None else elements
    setup = ElasticSetup(spaces, elastic, _bolted(model, spaces))
    loads = _seat_loads(model, spaces)
    shapes = np.array([setup.deflection(load, tolerance) for load in loads])
    compliance = np.einsum("ina,jna->ij", loads, shapes)
    stiffness = np.linalg.inv(0.5 * (compliance + compliance.T))
    modes = np.einsum("ij,jna->nai", stiffness, shapes)
    density = spaces.per_cell(dict(densities))
    values, volumes = spaces.at_points(modes)
    points = len(volumes) // len(density)
    weighted = values * (volumes * np.repeat(density, points))[:, None, None]
    mass = np.einsum("qai,qaj->ij", weighted, values)
    return CondensedSeats(
        names=tuple(bearing.name for bearing in model.bearings),
        stiffness=0.5 * (stiffness + stiffness.T),
        mass=0.5 * (mass + mass.T),
    )


def _bolted(model: GearboxModel, spaces: FiniteElements) -> np.ndarray[tuple[int, int], np.dtype[np.bool_]]:
    """(n_nodes, 3) supports: the foot of the housing held all over, other pieces held determinate."""
    fixed = np.zeros((len(model.mesh.points), 3), dtype=np.bool_)
    foot = model.foot_surface if model.joint is None else model.joint.foot_surface
    fixed[spaces.surfaces[foot].nodes] = True
    loose = [b.journal_surface for b in model.bearings if b.locating]
    loose += [] if model.joint is None else [model.foot_surface]
    for name in loose:
        nodes = np.intersect1d(spaces.surfaces[name].nodes, spaces.corners)
        for node, directions in three_two_one(model.mesh.points, nodes.astype(np.int32)):
            fixed[node, list(directions)] = True
    return fixed


def _seat_loads(model: GearboxModel, spaces: FiniteElements) -> FloatArray:
    """(3 k, n_nodes, 3) nodal forces of 1 N on every seat in y, z and x [N]."""
    size = len(SEAT_MOTIONS)
    loads = np.zeros((size * len(model.bearings), len(model.mesh.points), 3))
    for i, bearing in enumerate(model.bearings):
        bore = spaces.surfaces[bearing.bore_surface]
        for j, direction in enumerate(SEAT_MOTIONS):
            loads[size * i + j, :, direction] = bore.shares / bore.area
    return loads
