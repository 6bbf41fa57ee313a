"""The linear part of a drivetrain: everything but the gear meshes, as matrices with named freedoms."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.modal_form import ModalForm, modal_form
from dynamics.drivetrain.shaft_torque import ShaftTorques

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class LinearSystem:
    """M q'' + C q' + K q = external loads + mesh reactions, torsional freedoms q [rad].

    Every angle is positive in the running direction of its own shaft. The meshes are outside: without them
    each shaft line is free to rotate, so K has one exact rigid pair per line.

    inertia : (n,) diagonal of M [kg m2]
    damping : (n, n) [N m s/rad], joints and (if modelled linear) bearing drag
    stiffness : (n, n) [N m/rad]
    dofs : name of each freedom, ``shaft/station``
    mesh_ports : (n_meshes, 2) freedoms of pinion and wheel body of each mesh
    lines : (n,) index of the rigidly connected shaft line of each freedom
    drive_dof : freedom on which the motor torque acts
    twist_load : (n,) torque on each freedom per radian of bracing twist (zero sum) [N m/rad]
    drag_loads : name -> (n,) share of a drag torque that acts on each freedom, summing to -1 (drag opposes
        rotation); one entry per loss place that brakes (bearing, windage, seal)
    shaft_torques : torques that alternate with the rotation of a shaft
    """

    inertia: Array
    damping: Array
    stiffness: Array
    dofs: tuple[str, ...]
    mesh_ports: NDArray[np.int64]
    lines: NDArray[np.int64]
    drive_dof: int
    twist_load: Array
    drag_loads: dict[str, Array]
    shaft_torques: tuple[ShaftTorques, ...] = ()

    @cached_property
    def form(self) -> ModalForm:
        """Complex modes without the meshes, solved once for all speeds and iterations."""
        return modal_form(self.inertia, self.damping, self.stiffness, self.lines)
