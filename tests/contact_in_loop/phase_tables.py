"""Potential contact points of a mesh over its phase, tabulated for a contact that is solved in every step of a march.

Gap, direction, levers, local approach and influence numbers of all points of a loaded mesh (`loaded_mesh`) change with
the place of the tooth pairs on the path. They are tabulated over one base pitch as cubic splines, so that force and the
torque from their change over the path are continuous and come from one potential.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from dynamics.errors import DynamicsInputError
from dynamics.tooth.compliance import LocalModel
from dynamics.tooth.loaded_mesh import LoadedMesh
from dynamics.tooth.pair_gap import path_reach
from dynamics.tooth.points import ContactPoints
from tests.contact_in_loop.integration import PhaseTable

Array = NDArray[np.float64]

PHASES = 96
"""Places in a base pitch."""
STEEPNESS = 0.05
"""Growth of the gap per path beyond the reach [-]: nothing touches there."""
BEYOND = 4
"""Places beyond the pitch on either side that go into the splines: their ends do not show in the pitch."""


@dataclass(frozen=True, kw_only=True)
class _Places:
    """Quantities (n_places, n_points), influence numbers (n_places, n_points, n_points).

    local, local_log : a and c of the local approach; the latter does not change over the path (n_points,) [m/N]
    """

    gap: Array
    weight: Array
    local: Array
    local_log: Array
    reach: tuple[Array, Array]
    compliance: Array


def phase_table(mesh: LoadedMesh, force: float, reach: float, phases: int = PHASES) -> PhaseTable:
    """Tabulate a mesh.

    Parameters
    ----------
    force : transverse mesh force at which the width of the contacts is taken [N]
    reach : approach up to which every point that can touch is in the table [m]
    phases : places in a base pitch

    Raises DynamicsInputError for a force or reach that is not positive or less than 8 places.
    """
    if not (force > 0.0 and reach > 0.0) or phases < 8:
        raise DynamicsInputError(
            f"phase table: force = {force} N and reach = {reach} m must be positive, phases = {phases} at least 8"
        )
    points = mesh.points(reach, phases, beyond=BEYOND)
    places = _places(mesh, points, force)
    numbers, n_face = np.repeat(points.pairs, len(mesh.grid.position)), len(mesh.grid.position)
    kept = np.flatnonzero(np.isfinite(points.gap).any(axis=0).ravel())
    index = np.full(numbers.size + 2 * n_face, -1, np.int64)
    index[n_face + kept] = np.arange(kept.size)
    return PhaseTable(
        start=float(points.position[BEYOND]),
        pitch=mesh.pair.base_pitch,
        pair=numbers[kept].astype(np.int64),
        later=index[kept + 2 * n_face],
        sooner=index[kept],
        face=np.tile(mesh.grid.position, len(points.pairs))[kept],
        gap=_cubics(places.gap[:, kept]),
        weight=_cubics(places.weight[:, kept]),
        local=_cubics(places.local[:, kept]),
        reach_1=_cubics(places.reach[0][:, kept]),
        reach_2=_cubics(places.reach[1][:, kept]),
        compliance=np.ascontiguousarray(np.moveaxis(_cubics(places.compliance[:, kept][:, :, kept]), 1, -1)),
        local_log=places.local_log[kept],
    )


def _places(mesh: LoadedMesh, points: ContactPoints, force: float) -> _Places:
    """At every place of the points."""
    count, shape = len(points.position), points.path.shape[1:]
    local = _local(mesh, points, force)
    first, last = path_reach(mesh.pair, points.reach)
    beyond = np.maximum(first - points.path, 0.0) + np.maximum(points.path - last, 0.0)
    gap = np.where(np.isfinite(points.gap), points.gap, points.reach + STEEPNESS * beyond)
    face, number = np.tile(points.grid.position, shape[0]), np.repeat(points.pairs, shape[1])
    compliance = np.stack(
        [
            mesh.gears[0].matrix(points.place.roll[0][k].ravel(), face, -number)
            + mesh.gears[1].matrix(points.place.roll[1][k].ravel(), face, number)
            for k in range(count)
        ]
    )
    return _Places(
        gap=gap.reshape(count, -1),
        weight=points.weight.reshape(count, -1),
        local=local[..., 0].reshape(count, -1),
        local_log=np.ascontiguousarray(local[0, ..., 1].ravel()),
        reach=(points.place.reach[0].reshape(count, -1), points.place.reach[1].reshape(count, -1)),
        compliance=compliance,
    )


def _local(mesh: LoadedMesh, points: ContactPoints, force: float) -> Array:
    """Factors a and c of the local approach (n_places, n_pairs, n_face, 2) [m/N]."""
    model = LocalModel(
        pair=mesh.pair, gears=mesh.gears, tips=points.tips, edges=mesh.edges,
        line_load=force / mesh.grid.face_width,
    )  # fmt: skip
    return model.at(points.place, np.broadcast_to(mesh.grid.width, points.path.shape)).law


def _cubics(values: Array) -> Array:
    """Coefficients (phases, 4, ...) of the cubics between the places of a pitch, lowest power first."""
    count = len(values) - 2 * BEYOND
    spline = CubicSpline(np.arange(len(values), dtype=float), values, axis=0)
    within = spline.c[::-1, BEYOND : BEYOND + count]
    return np.ascontiguousarray(np.moveaxis(within, 0, 1))
