"""The linear part of a drivetrain: everything but the gear meshes, as matrices with named freedoms."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from dynamics.drivetrain.modal_form import ModalForm, modal_form
from dynamics.drivetrain.shaft_torque import ShaftTorques

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True, kw_only=True)
class LinearSystem:
    """M q'' + C q' + K q = external loads + mesh reactions.

    The freedoms are the rotations of a torsional drivetrain [rad], each positive in the running direction of its own
    shaft, or generalised freedoms of a reduced elastic one. Whatever is seen from outside, the gears in their meshes,
    the drive, the ends of couplings, is a freedom of its own. The meshes are outside: without them each shaft line is
    free to turn, a rigid shape that K does not resist.

    inertia : (n, n) M, symmetric and positive definite [kg m2]
    damping : (n, n) [N m s/rad], joints and (if modelled linear) bearing drag; its skew part is gyroscopic
    stiffness : (n, n) [N m/rad]; its skew part is that of lubricant films
    dofs : name of each freedom, ``shaft/station``
    mesh_ports : (n_meshes, 2) freedoms of pinion and wheel of each mesh: how far their flanks move along the line of
        action, over the base radius [rad]
    rigid : (n, n_rigid) exact rigid shapes, each of freedoms that nothing ties to those of another
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
    mesh_ports: Integers
    rigid: Array
    drive_dof: int
    twist_load: Array
    drag_loads: dict[str, Array]
    shaft_torques: tuple[ShaftTorques, ...] = ()

    @cached_property
    def form(self) -> ModalForm:
        """Complex modes without the meshes, solved once for all speeds and iterations."""
        return modal_form(self.inertia, self.damping, self.stiffness, self.rigid)

    @cached_property
    def branches(self) -> Integers:
        """Number of the branch of each freedom (n,): freedoms between which nothing but a mesh acts are apart."""
        tied = (self.inertia != 0.0) | (self.damping != 0.0) | (self.stiffness != 0.0)
        tied |= self.rigid @ self.rigid.T != 0.0
        return np.asarray(connected_components(csr_matrix(tied), directed=False)[1], np.int64)


def line_shapes(lines: Integers) -> Array:
    """Rigid shapes (n, n_lines) of freedoms that turn together, from the number of the shaft line of each (n,)."""
    return np.asarray(lines[:, None] == np.unique(lines), float)
