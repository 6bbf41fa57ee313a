"""Places on a housing mesh as weights of nodal temperatures: surfaces, bodies, coordinates.

Coordinates are found in the nearest cell by Newton's method on its isoparametric map and read with its shape
functions. A sensor sits on a surface that the mesh follows to a fraction of a millimetre, so a point that far
outside the body is read at the nearest point of the cell.
"""

from collections.abc import Mapping

import numpy as np
from scipy.spatial import cKDTree

from rigdesign.base.errors import UsageError
from rigdesign.rig.model import Rig
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import FloatArray

OFF_BODY = 2e-3
"""Distance from the body [m] up to which a sensor is taken to sit on its surface."""
CANDIDATES = 24
"""Cells whose middle is nearest that are searched for a point."""
STEPS = 12
"""Newton steps on the map of a cell; the cells are nearly straight."""

Weights = tuple[np.ndarray[tuple[int], np.dtype[np.intp]], FloatArray]
"""Nodes and the weights of their temperatures, which sum to one."""


def place_weights(rig: Rig, place: str, at: tuple[float, float, float] | None) -> tuple[str, Weights]:
    """Gearbox and weights of a temperature channel.

    place : ``gearbox.surface`` (area mean) or ``gearbox.body`` (volume mean); the gearbox alone with ``at`` [m]

    Raises
    ------
    UsageError
        A gearbox without a housing, a name that is neither surface nor body, a point off the body.
    """
    name, _, part = place.partition(".")
    if name not in rig.models:
        known = ", ".join(rig.models) or "none"
        raise UsageError(
            f"temperature at {place!r}: {name!r} is no gearbox with a housing; with one: {known}"
        )
    elements = rig.conduction[name].elements
    if at is not None:
        return name, _at_point(elements, place, np.array(at, dtype=np.float64))
    if part in elements.mesh.surfaces:
        return name, _normed(elements.surfaces[part].shares)
    if part in elements.mesh.bodies:
        return name, _normed(elements.body_load(part))
    known = ", ".join([*elements.mesh.bodies, *elements.mesh.surfaces])
    raise UsageError(
        f"temperature at {place!r}: {part!r} is no body or surface of the housing; it has {known}"
    )


def _normed(shares: FloatArray) -> Weights:
    nodes = np.flatnonzero(shares)
    return nodes, shares[nodes] / shares.sum()


def _at_point(elements: FiniteElements, place: str, point: FloatArray) -> Weights:
    mesh, shape = elements.mesh, elements.shape
    middles = mesh.points[mesh.cells[:, : shape.n_corners]].mean(axis=1)
    _, near = cKDTree(middles).query(point, k=min(CANDIDATES, len(middles)))
    best: tuple[float, Weights] | None = None
    for cell in np.atleast_1d(near):
        nodes = mesh.cells[cell].astype(np.intp)
        local = _inside(elements, _local(elements, mesh.points[nodes], point))
        weights = shape.values(local[None])[0]
        gap = float(np.linalg.norm(weights @ mesh.points[nodes] - point))
        if best is None or gap < best[0]:
            best = gap, (nodes, weights)
        if gap < 1e-9:
            break
    assert best is not None
    if best[0] > OFF_BODY:
        x, y, z = point
        raise UsageError(
            f"temperature at {place!r}: the point {x:g}, {y:g}, {z:g} m is {1e3 * best[0]:.3g} mm off the body, "
            f"above {1e3 * OFF_BODY:g} mm; nearest surface: {_nearest_surface(mesh.surfaces, mesh.points, point)}"
        )
    return best[1]


def _local(elements: FiniteElements, corners: FloatArray, point: FloatArray) -> FloatArray:
    """Reference coordinates of a point in the cell with these nodes (n_nodes, 3)."""
    shape = elements.shape
    local = shape.corners.mean(axis=0)
    for _ in range(STEPS):
        gap = shape.values(local[None])[0] @ corners - point
        slope = np.einsum("na,nd->ad", corners, shape.gradients(local[None])[0])
        step = np.linalg.lstsq(slope, -gap, rcond=None)[0]
        local = np.clip(local + step, -3.0, 3.0)
        if np.abs(step).max() < 1e-12:
            break
    return np.asarray(local)


def _inside(elements: FiniteElements, local: FloatArray) -> FloatArray:
    """The point of the reference cell nearest to ``local``, in its own coordinates."""
    if elements.shape.n_corners == 8:
        return np.clip(local, 0.0, 1.0)
    shares = np.append(1.0 - local.sum(), local)
    for _ in range(4):
        shares = np.maximum(shares, 0.0)
        shares /= shares.sum()
    return shares[1:]


def _nearest_surface(surfaces: Mapping[str, np.ndarray], points: FloatArray, point: FloatArray) -> str:
    gaps = {
        name: float(np.linalg.norm(points[np.unique(facets)] - point, axis=1).min())
        for name, facets in surfaces.items()
    }
    return min(gaps, key=gaps.__getitem__)
