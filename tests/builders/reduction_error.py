"""How exact is a reduced rig: its receptance at the ports against that of all freedoms, measured."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.bearing_state import RunningState
from dynamics.rotor.reduction import ReducedElasticRig
from tests.builders.full_matrices import full_matrices
from tests.builders.harmonic_response import receptance

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class ReductionError:
    """Error of the receptances |H - H_full|_ij over sqrt(|H_ii| |H_jj|) of the full rig.

    frequencies : (f,) angular [rad/s]; largest : (f,) over all pairs of ports [-]; worst : ports (i, j) of the maximum
    """

    frequencies: Array
    largest: Array
    worst: tuple[int, int]

    @property
    def maximum(self) -> float:
        """Over all frequencies [-]."""
        return float(self.largest.max())


def reduction_error(
    rig: ReducedElasticRig, state: RunningState, rows: Array, frequencies: Array
) -> ReductionError:
    """Measured error of a reduced rig at a running state, with its bearings, dampers and gyroscopics.

    rows : (m, n_full) motions at which loads act and answers count; frequencies : (f,) angular, above zero [rad/s]
    """
    exact = receptance(full_matrices(rig.model, state), rows, frequencies)
    reduced = receptance(rig.matrices(state), rig.rows(rows), frequencies)
    own = np.sqrt(np.abs(np.einsum("fii->fi", exact)))
    error = np.abs(reduced - exact) / (own[:, :, None] * own[:, None, :])
    place = np.unravel_index(int(np.argmax(error)), error.shape)
    return ReductionError(
        frequencies=frequencies, largest=error.max(axis=(1, 2)), worst=(int(place[1]), int(place[2]))
    )
