"""Sparse matrices of all freedoms of the elastic rig at a running state, against which the reduced rig is checked."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array, diags_array
from scipy.sparse.linalg import splu

from dynamics.rotor.assembly import ElasticModel
from dynamics.rotor.bearing_state import RunningState
from dynamics.rotor.reduction import spline_dampers

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class FullMatrices:
    """Sparse M, C with gyroscopics and K with cross-coupling of all freedoms at one running state, each (n, n)."""

    mass: csr_array
    damping: csr_array
    stiffness: csr_array

    def response(self, loads: Array | Complex, frequency: float) -> Complex:
        """Displacement (n, k) under harmonic loads (n, k) of an angular frequency [rad/s]."""
        dynamic = self.stiffness - frequency**2 * self.mass + 1j * frequency * self.damping
        return np.asarray(splu(csc_array(dynamic)).solve(np.asarray(loads, complex)))


def full_matrices(model: ElasticModel, state: RunningState) -> FullMatrices:
    """Matrices of all freedoms at a running state; raises DrivetrainError as `RunningState.check`."""
    state.check(model)
    stiffness = model.stiffness + state.speed * model.circulation
    damping = model.damping + state.speed * model.gyroscopic + diags_array(model.drag)
    for name, coefficients in state.bearings.items():
        rows = csr_array(model.ports[name])
        bearing_stiffness, bearing_damping = coefficients.padded()
        stiffness = stiffness + rows.T @ csr_array(bearing_stiffness) @ rows
        damping = damping + rows.T @ csr_array(bearing_damping) @ rows
    for damper in spline_dampers(model):
        row = csr_array(damper.row[None, :])
        damping = damping + damper.loss.damping(state.speed) * (row.T @ row)
    for spring in state.springs:
        row = csr_array(spring.row[None, :])
        stiffness = stiffness + spring.stiffness * (row.T @ row)
        damping = damping + spring.damping * (row.T @ row)
    return FullMatrices(model.mass, csr_array(damping), csr_array(stiffness))
