"""Change of a march to the matrices of another speed band.

Within a band the bearings are springs from where nothing loads them, so that new springs would press on the old mean
position by ``(K_2 - K_1) u``, a blow that no rig gives. The mean of the motion therefore goes over to the place where
the new matrices hold the same loads; the vibration about it goes on as it is. What the place of the gears changes of
the approach of their flanks comes over a time, as it does while the rig passes through the band.
"""

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from dynamics.drivetrain.linear_system import LinearSystem

Array = NDArray[np.float64]

FADE = 0.1
"""Time over which the approach of the flanks follows the mean position of a new band [s]."""


def static_position(system: LinearSystem, load: Array) -> Array:
    """Displacements (n,) under steady loads (n,), without rigid motion; what accelerates the lines is in balance with
    their inertia."""
    inertia, rigid = system.inertia, system.rigid
    still = inertia @ rigid
    modal = rigid.T @ still
    balanced = load - still @ np.linalg.solve(modal, rigid.T @ load)
    scale = np.abs(system.stiffness).max() / max(np.abs(still @ still.T).max(), 1e-300)
    return np.asarray(scipy.linalg.solve(system.stiffness + scale * still @ still.T, balanced))


def mean_shift(before: LinearSystem, after: LinearSystem, load: Array) -> Array:
    """Change (n,) of the mean position under steady loads (n,) from one band to the next, with equal freedoms."""
    return static_position(after, load) - static_position(before, load)


def fade(n_samples: int, first: int, sample_time: float) -> Array:
    """Part (n_samples,) of a shift that is still to come at the ends of samples from number ``first`` on, counted from
    the change; it begins and ends without a jump of its rate."""
    place = np.minimum((first + 1 + np.arange(n_samples)) * sample_time / FADE, 1.0)
    return np.asarray(1.0 - place * place * (3.0 - 2.0 * place))
