"""Stiffness and damping of a bearing across its axis, as a rotor on it feels them.

Axes of the rig: x along the shaft, (y, z) across it, turns about x, y, z right-handed. Force on the journal about its
static position = -stiffness u - damping u', u = (u_y, u_z).
"""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError

Array = NDArray[np.float64]

Regime = Literal["hydrodynamic", "mixed", "standstill", "elastic", "constant"]


@dataclass(frozen=True, kw_only=True, eq=False)
class LateralCoefficients:
    """Linear coefficients of one bearing at its static position.

    stiffness : (2, 2) [N/m]; that of a film is not symmetric
    damping : (2, 2) [N s/m], symmetric
    position : (2,) static displacement of the journal against the bearing [m]
    regime : what carries the journal
    eccentricity : static, over the radial clearance [-]; None for a kind without a film
    all_stiffness, all_damping : (5, 5) in the order u_x, u_y, u_z, theta_y, theta_z, of kinds that hold more than the
        two lateral directions; None for others. [N/m, N/rad = N m/m, N m/rad] and the same times s
    """

    stiffness: Array
    damping: Array
    position: Array
    regime: Regime
    eccentricity: float | None = None
    all_stiffness: Array | None = None
    all_damping: Array | None = None

    @property
    def node_stiffness(self) -> Array:
        """(5, 5) in the order u_x, u_y, u_z, theta_y, theta_z; 0 where the bearing holds nothing."""
        return _at_node(self.stiffness) if self.all_stiffness is None else self.all_stiffness

    @property
    def node_damping(self) -> Array:
        """(5, 5) as `node_stiffness`."""
        return _at_node(self.damping) if self.all_damping is None else self.all_damping

    @property
    def axial_stiffness(self) -> float:
        """Along x [N/m]; 0 for a plain bearing or rollers without contact angle."""
        return float(self.node_stiffness[0, 0])

    @property
    def tilting_stiffness(self) -> Array:
        """(2, 2) moments about y and z over tilts about them [N m/rad]."""
        return self.node_stiffness[3:, 3:]


def constant_coefficients(
    stiffness: float, damping: float, force: tuple[float, float] = (0.0, 0.0)
) -> LateralCoefficients:
    """Coefficients that a case states, equal in all directions (P2, Table 1: 1e8 N/m and 4e4 N s/m).

    stiffness, damping : radial [N/m], [N s/m]
    force : static load on the journal in y and z [N]

    Raises DynamicsInputError for a stiffness not above 0 or a negative damping.
    """
    if not (stiffness > 0.0 and math.isfinite(stiffness)):
        raise DynamicsInputError(
            f"bearing: stiffness = {stiffness:.6g} N/m: must be finite and above 0; correct the radial stiffness"
        )
    if not (damping >= 0.0 and math.isfinite(damping)):
        raise DynamicsInputError(
            f"bearing: damping = {damping:.6g} N s/m: must be finite and not negative; correct the radial damping"
        )
    return LateralCoefficients(
        stiffness=stiffness * np.eye(2),
        damping=damping * np.eye(2),
        position=np.array(force) / stiffness,
        regime="constant",
    )


def load_axes(force: tuple[float, float], sense: int) -> Array:
    """(2, 2) unit vectors in (y, z) as columns: along the load, and across it where the running journal is carried to.

    The second is the first turned a right angle in the direction of rotation. y without a load.

    sense : +1 for a shaft that turns about +x, from y to z; -1 the other way
    """
    magnitude = math.hypot(*force)
    along = np.array(force) / magnitude if magnitude > 0.0 else np.array([1.0, 0.0])
    return np.column_stack([along, sense * np.array([-along[1], along[0]])])


def _at_node(lateral: Array) -> Array:
    whole = np.zeros((5, 5))
    whole[1:3, 1:3] = lateral
    return whole
