"""What a march through time starts from and how it goes: state, loads, steps, controllers."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from dynamics.response.modal_model import DEFAULT_CUTOFF

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class DriveState:
    """Angles [rad] and speeds [rad/s] of all freedoms, shape (n,), and the bracing twist [rad]."""

    angles: Array
    speeds: Array
    twist: float = 0.0


@dataclass(frozen=True, kw_only=True)
class SpeedControl:
    """Speed controller of the motor: torque = proportional * error + integral * integrated error, limited.

    proportional : [N m s/rad]; integral : [N m/rad]; torque_limit : largest motor torque [N m]
    time_constant : of the average over the measured speed, which keeps the torsional vibration out [s]
    """

    proportional: float
    integral: float
    torque_limit: float
    time_constant: float = 0.01


@dataclass(frozen=True, kw_only=True)
class TorqueControl:
    """Torque-controlled bracing: the twist follows the averaged torque of the first mesh.

    stiffness : torque of the first mesh per twist of the bracing [N m/rad]
    time_constant : of the control loop and of the average it acts on [s]
    """

    stiffness: float
    time_constant: float = 0.02


@dataclass(frozen=True, kw_only=True)
class DriveLoads:
    """Torques that act at the start of a march.

    drive_torque : of the motor [N m]
    drag_torques : by name of ``system.drag_loads``, positive against positive rotation [N m]; a drag that may act
        later is named here, if only with 0
    periodic : (n_periodic_loads,) value of each entry of ``system.periodic_loads``; zeros when left out
    """

    drive_torque: float = 0.0
    drag_torques: Mapping[str, float] = field(default_factory=dict)
    periodic: Array | None = None


@dataclass(frozen=True, kw_only=True)
class DragTables:
    """Drag torques over speed, on uniform grids from 0.

    torque : (n_drags, n_table) [N m], in the order of the drags of the march
    last_speed : (n_drags,) at the end of each table [rad/s]; None for torques that do not depend on it
    """

    torque: Array
    last_speed: Array | None = None


@dataclass(frozen=True, kw_only=True)
class MarchSettings:
    """Steps of a march and what it keeps.

    step : internal step [s]; substeps : of them in a sample, over which the slow inputs are linear
    cutoff : modes above this frequency keep their static effect only [Hz]
    accounts : integrate work and losses at every internal step
    record_all : keep approach, rates and torques of every internal step, else the mesh forces alone
    derivative_torques : torques from the change of stiffness and gap along the path, without which the pinion
        sees the elastic force alone
    """

    step: float
    substeps: int = 1
    cutoff: float = DEFAULT_CUTOFF
    accounts: bool = True
    record_all: bool = True
    derivative_torques: bool = True
