"""Linear forces of one running state: speed, bearing coefficients, linear mesh springs.

Bearings and meshes stand outside the matrices of `dynamics.elastic_rig.assembly`, because they change from stage to
stage; `ReducedElasticRig.matrices` adds them.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.shaft import DrivetrainError
from dynamics.elastic_rig.assembly import ElasticModel
from dynamics.elastic_rig.layout import SEAT_DIRECTIONS

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class BearingCoefficients:
    """Force -K w - C w' on the journal for its motion w against the seat: (d, d) in the first d of `SEAT_DIRECTIONS`.

    d is 2 for a film, 5 for a rolling bearing. [N/m], [N s/m] and likewise for tilts; K of a film is not symmetric.

    Raises DrivetrainError for another shape or a value that is not finite.
    """

    stiffness: Array
    damping: Array

    def __post_init__(self) -> None:
        for name, matrix in (("stiffness", self.stiffness), ("damping", self.damping)):
            if matrix.shape not in ((2, 2), (5, 5)) or not np.isfinite(matrix).all():
                raise DrivetrainError(
                    f"bearing: {name} of shape {matrix.shape}: must be (2, 2) or (5, 5) and finite; correct it"
                )

    def padded(self) -> tuple[Array, Array]:
        """Both with zeros up to (5, 5)."""
        whole = np.zeros((2, len(SEAT_DIRECTIONS), len(SEAT_DIRECTIONS)))
        for i, matrix in enumerate((self.stiffness, self.damping)):
            whole[i, : matrix.shape[0], : matrix.shape[0]] = matrix
        return whole[0], whole[1]


def isotropic_bearing(stiffness: float, damping: float = 0.0) -> BearingCoefficients:
    """Bearing alike in all lateral directions without cross-coupling (P2, Table 1): [N/m], [N s/m]."""
    return BearingCoefficients(stiffness=stiffness * np.eye(2), damping=damping * np.eye(2))


@dataclass(frozen=True, kw_only=True)
class RowSpring:
    """Spring and damper on one relative motion row . q, row (n,): a mesh in its mean position [N/m], [N s/m]."""

    row: Array
    stiffness: float
    damping: float = 0.0


@dataclass(frozen=True, kw_only=True)
class RunningState:
    """Speed of the reference shaft [rad/s], coefficients of the bearings by name, springs on rows of all freedoms.

    torques : by coupling, mean torque that its first shaft passes to the second along their rotation [N m], for the
        cross joints; 0 where none is given
    """

    speed: float = 0.0
    bearings: Mapping[str, BearingCoefficients] = field(default_factory=dict)
    springs: tuple[RowSpring, ...] = ()
    torques: Mapping[str, float] = field(default_factory=dict)

    def check(self, model: ElasticModel) -> None:
        """Raise DrivetrainError for a bearing that is missing, unknown or does not locate a shaft it should."""
        for name in self.bearings.keys() - model.ports.keys():
            raise DrivetrainError(
                f"bearing {name!r} has coefficients but no place on a shaft; correct the name"
            )
        for name in model.ports.keys() - self.bearings.keys():
            raise DrivetrainError(f"bearing {name!r} has no coefficients: give its stiffness and damping")
        axial = SEAT_DIRECTIONS.index("u_x")
        for name, coefficients in self.bearings.items():
            stiffness = coefficients.padded()[0]
            if name in model.rig.axially_locating:
                if not stiffness[axial, axial] > 0.0:
                    raise DrivetrainError(
                        f"bearing {name!r} is to locate its shaft, but its axial stiffness is "
                        f"{stiffness[axial, axial]:.6g} N/m: must be above 0; give five directions or another location"
                    )
            elif np.abs(stiffness[axial]).max() > 0.0:
                raise DrivetrainError(
                    f"bearing {name!r} has an axial stiffness of {stiffness[axial, axial]:.6g} N/m but does not count "
                    "as locating: must be 0; make it the locating bearing of its shaft"
                )
