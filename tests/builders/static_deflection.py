"""Static deflection of all freedoms under given loads, with bearings whose stiffness need not be symmetric."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array, hstack, vstack
from scipy.sparse.linalg import splu

from dynamics.rotor.assembly import ElasticModel
from dynamics.rotor.bearing_state import RunningState
from dynamics.rotor.location import unresisted
from dynamics.rotor.shaft import DrivetrainError
from tests.builders.full_matrices import full_matrices

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class StaticDeflection:
    """deflection : (n,) without rigid motion, mass-orthogonal to it [m], [rad]

    unbalanced : (k,) work of the load on each rigid motion that no spring resists: torque on a shaft line, axial force
    on a shaft that floats [N m], [N]. Inertia takes it up; zero for loads in balance.
    """

    deflection: Array
    unbalanced: Array


def static_deflection(model: ElasticModel, state: RunningState, load: Array) -> StaticDeflection:
    """Deflection under a load (n,) [N], [N m] at a running state.

    Raises DrivetrainError as `RunningState.check`, or for bearings that do not hold the shafts.
    """
    stiffness = full_matrices(model, state).stiffness
    motions = [motion.shape for motion in model.rigid]
    rigid = np.array(motions).reshape(-1, model.size).T
    rigid = rigid @ unresisted(stiffness @ rigid, float(abs(stiffness).max()))
    held = csr_array(model.mass @ rigid)
    corner = csr_array((rigid.shape[1], rigid.shape[1]))
    bordered = vstack([hstack([stiffness, held]), hstack([held.T, corner])])
    try:
        solution = splu(csc_array(bordered)).solve(np.concatenate([load, np.zeros(rigid.shape[1])]))
    except RuntimeError as error:
        raise DrivetrainError(
            "static deflection: the stiffness is singular: the bearings must hold every shaft; give their stiffness"
        ) from error
    return StaticDeflection(deflection=solution[: model.size], unbalanced=rigid.T @ load)
