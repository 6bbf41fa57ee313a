"""Slices of a mesh law as springs at any place on the path, by the cubics of ``dynamics.mesh.tables``."""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from dynamics.kernels.contact_nodes import SliceSprings
from dynamics.mesh.law import MeshLaw

Array = NDArray[np.float64]


def slice_springs(law: MeshLaw, path: Array, sign: float, pitches: int = 1, *, beyond: bool) -> SliceSprings:
    """Slices of a pair, and of those that follow it within so many base pitches, at its path positions (n,) [m].

    sign : +1 in front, -1 on the back
    beyond : whether slices go on beyond the ends of the path, opening as there, or carry nothing
    """
    n_slices, n_path = law.stiffness.shape
    lag = sign * law.slice_shift
    grid = law.path_start + law.path_step * np.arange(n_path)
    place = path[:, None] - np.tile(lag, pitches) + law.base_pitch * np.repeat(np.arange(pitches), n_slices)
    inside = np.clip(place, grid[0], grid[-1])
    out = place - inside
    stiffness, gap, slope = np.empty(place.shape), np.empty(place.shape), np.empty(place.shape)
    for row in range(n_slices):
        opening = PchipInterpolator(grid, law.gap[row])
        at = inside[:, row::n_slices]
        stiffness[:, row::n_slices] = PchipInterpolator(grid, law.stiffness[row])(at)
        slope[:, row::n_slices] = opening(at, 1)
        gap[:, row::n_slices] = opening(at) + np.abs(out[:, row::n_slices] * slope[:, row::n_slices])
    if not beyond:
        stiffness[np.abs(out) > 1e-9 * law.path_step] = 0.0
    face = np.zeros(n_slices) if law.slice_face is None else np.asarray(law.slice_face, float)
    return SliceSprings(stiffness=stiffness, gap=gap, slope=slope, path=place, face=np.tile(face, pitches))
