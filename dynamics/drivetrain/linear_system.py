"""The linear part of a drivetrain: everything but the gear meshes, as matrices with named freedoms."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from dynamics.drivetrain.mesh_wrench import MeshWrench
from dynamics.drivetrain.modal_form import ModalForm, known_modal_form
from dynamics.drivetrain.periodic_load import PeriodicLoad

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True, kw_only=True)
class Coordinates:
    """Coordinates in which the matrices of a system fall into blocks: eta, with freedoms q = freedoms @ eta.

    freedoms : (n, n); inertia, damping, stiffness : (n, n) in these coordinates; rigid : (n, n_rigid)
    """

    freedoms: Array
    inertia: Array
    damping: Array
    stiffness: Array
    rigid: Array

    @cached_property
    def branches(self) -> Integers:
        """Number of the branch of each coordinate (n,): those between which nothing but a mesh acts are apart."""
        tied = (self.inertia != 0.0) | (self.damping != 0.0) | (self.stiffness != 0.0)
        tied |= self.rigid @ self.rigid.T != 0.0
        return np.asarray(connected_components(csr_matrix(tied), directed=False)[1], np.int64)


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
    periodic_loads : loads that alternate with the rotation of a shaft
    own_coordinates : in which the matrices fall into more blocks than in the freedoms, where there are such
    mesh_wrench : directions of tooth forces beside those of the ports; None where gears only rotate
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
    periodic_loads: tuple[PeriodicLoad, ...] = ()
    own_coordinates: Coordinates | None = None
    mesh_wrench: MeshWrench | None = None

    def at(self, speed: float) -> "LinearSystem":
        """Itself: these matrices hold at every speed [rad/s]."""
        return self

    @cached_property
    def coordinates(self) -> Coordinates:
        """Coordinates of the eigenproblems: its own, else the freedoms themselves."""
        return self.own_coordinates or Coordinates(
            freedoms=np.eye(len(self.inertia)),
            inertia=self.inertia,
            damping=self.damping,
            stiffness=self.stiffness,
            rigid=self.rigid,
        )

    @cached_property
    def form(self) -> ModalForm:
        """Complex modes without the meshes, solved once for all speeds and iterations, branch by branch."""
        inner = self.coordinates
        forms = []
        for branch in np.unique(inner.branches):
            own = np.flatnonzero(inner.branches == branch)
            block = np.ix_(own, own)
            form = known_modal_form(
                inner.inertia[block], inner.damping[block], inner.stiffness[block], inner.rigid[own]
            )
            forms.append(form.seen(inner.freedoms[:, own]))
        return ModalForm(
            poles=np.concatenate([form.poles for form in forms]),
            velocity_shapes=np.hstack([form.velocity_shapes for form in forms]),
            loads=np.vstack([form.loads for form in forms]),
            rigid=np.hstack([form.rigid for form in forms]),
        )

    @cached_property
    def branches(self) -> Integers:
        """Number of the branch of each freedom (n,): that of its largest coordinate."""
        inner = self.coordinates
        return np.asarray(inner.branches[np.argmax(np.abs(inner.freedoms), axis=1)], np.int64)


def line_shapes(lines: Integers) -> Array:
    """Rigid shapes (n, n_lines) of freedoms that turn together, from the number of the shaft line of each (n,)."""
    return np.asarray(lines[:, None] == np.unique(lines), float)
