"""Stiffness, structural damping and static position of a rolling bearing under a load vector.

The five-by-five tangent stiffness of the rolling elements as they stand with one of them under the load; their passing
under it, centrifugal force and gyroscopic moment are not in it. The axis of the bearing is x of the rig, its first
radial direction y. Metal contacts damp little: the share is the caller's, c = structural_damping times k.
"""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dynamics.bearing.lateral import LateralCoefficients
from dynamics.bearing.protocol import BearingError, LateralOperation
from dynamics.bearing.rolling_row import RowOfElements
from dynamics.bearing.rolling_stiffness import bearing_stiffness, stiffness_at

ORDER = [2, 0, 1, 3, 4]
"""Places of u_x, u_y, u_z, theta_y, theta_z among x, y, z, rx, ry of the bearing, whose z is the axis."""


def rolling_lateral(row: RowOfElements, operation: LateralOperation) -> LateralCoefficients:
    """Coefficients of a row of rolling elements; axially and against tilting as well.

    A bearing with a contact angle takes axial force up in the direction of the operation's (along +x without one).
    Rollers without one leave it to their flanges, which have no stiffness here.

    Raises
    ------
    BearingError : no rolling element carries load: nothing holds the rings
    BearingNotConvergedError : no displacement carries the load
    """
    radial = math.hypot(*operation.force)
    straight_rollers = row.elements.roller and row.elements.contact_angle == 0.0
    axial = 0.0 if straight_rollers else abs(operation.axial_force)
    found = bearing_stiffness(replace(row, direction=1), radial, axial)
    if found.loaded_elements == 0:
        raise BearingError(
            f"rolling bearing: load = 0 N with a clearance of {1e6 * row.clearance:.3g} um: no element carries, "
            "nothing holds the rings; give the load with the weight of the shaft, or a preload"
        )
    direction = -1 if operation.axial_force < 0.0 else 1
    azimuth = math.atan2(operation.force[1], operation.force[0])
    whole = stiffness_at(replace(row, direction=direction), found, azimuth)[np.ix_(ORDER, ORDER)]
    damping = operation.structural_damping * whole
    towards: NDArray[np.float64] = np.array([math.cos(azimuth), math.sin(azimuth)])
    return LateralCoefficients(
        stiffness=whole[1:3, 1:3],
        damping=damping[1:3, 1:3],
        position=found.radial_displacement * towards,
        regime="elastic",
        all_stiffness=whole,
        all_damping=damping,
    )
