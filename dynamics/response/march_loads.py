"""Columns of load through which a march acts on the drivetrain: motor, bracing, periodic loads and drag torques."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from dynamics import kernels
from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.errors import DynamicsInputError
from dynamics.mesh.law import MeshLaw
from dynamics.response.modal_model import DEFAULT_CUTOFF, ModalModel, modal_model

Array = NDArray[np.float64]


def march_model(
    system: LinearSystem,
    laws: Sequence[MeshLaw],
    drags: Sequence[str] = (),
    cutoff: float = DEFAULT_CUTOFF,
    drag_damping: Mapping[str, float] | None = None,
) -> ModalModel:
    """Modal model of a drivetrain with the loads of a march: motor, twist, alternating torques and the drags named.

    cutoff : modes above this frequency keep their static effect only [Hz]
    drag_damping : steepest rise of the drags over the speed by name [N m s/rad]; modes that are
        damped far more by themselves give way to drags statically alone; all move with them when left out

    Raises DynamicsInputError and DefectiveModes as ``modal_model``, DynamicsInputError for unknown names of drags.
    """
    loads = drag_loads(system, drags)
    steepest = None
    if drag_damping is not None:
        steepest = np.zeros(loads.shape[1])
        steepest[drag_places(system, drags)] = [drag_damping[name] for name in drags]
    return modal_model(system, laws, slow_loads(system), loads, cutoff=cutoff, drag_damping=steepest)


def slow_loads(system: LinearSystem) -> Array:
    """Return the loads (n, 2 + n_periodic_loads) of motor, twist and what alternates with a shaft."""
    drive = np.zeros(len(system.inertia))
    drive[system.drive_dof] = 1.0
    return np.column_stack((drive, system.twist_load, *(load.load for load in system.periodic_loads)))


def drag_places(system: LinearSystem, drags: Sequence[str]) -> NDArray[np.int64]:
    """Return (n_drags,) the columns of named drags in ``drag_loads``: every line begins a new four of them.

    Raises DynamicsInputError for unknown names.
    """
    unknown = [name for name in drags if name not in system.drag_loads]
    if unknown:
        raise DynamicsInputError(
            f"no drag load named {', '.join(unknown)}; known: {', '.join(system.drag_loads) or 'none'}"
        )
    lines = [int(np.argmax(np.abs(system.drag_loads[name] @ system.rigid))) for name in drags]
    places = np.empty(len(drags), np.int64)
    first = 0
    for line in np.unique(lines):
        own = np.flatnonzero(np.array(lines) == line)
        places[own] = first + np.arange(len(own))
        first += -(-len(own) // kernels.FOUR) * kernels.FOUR
    return places


def drag_loads(system: LinearSystem, drags: Sequence[str]) -> Array:
    """Return the loads (n, n_places) of named drag torques in fours, see ``drag_places``; zeros where there is no drag.

    Raises DynamicsInputError for unknown names.
    """
    places = drag_places(system, drags)
    loads = np.zeros(
        (len(system.inertia), -(-int(max(places, default=-1) + 1) // kernels.FOUR) * kernels.FOUR)
    )
    for place, name in zip(places, drags):
        loads[:, place] = system.drag_loads[name]
    return loads
