"""Modes of the closed elastic loop, named by the parts that hold their strain energy.

A shaft holds what its elements store in torsion, axial motion and bending, a joint, a bearing and a mesh what their
springs store. Of a film, whose stiffness is not symmetric, the symmetric part counts.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array, diags_array

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.modal_form import times
from dynamics.drivetrain.modes import (
    Describe,
    LoopMode,
    ModeShape,
    energy_shares,
    modes_of_loop,
    shape_name,
)
from dynamics.elastic_rig.running_state import BearingCoefficients, RunningState
from dynamics.elastic_rig.seen_system import SeenRig
from dynamics.mesh.law import MeshLaw

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

FAMILY = {"turn": "torsion", "u_x": "axial"}
"""What a freedom belongs to, by its name; all others bend."""


def elastic_loop_modes(
    seen: SeenRig, state: RunningState, laws: Sequence[MeshLaw], highest_frequency: float
) -> tuple[LoopMode, ...]:
    """Rigid mode (0 Hz) and all oscillating modes of the closed loop at a running state up to a frequency [Hz].

    laws : of the meshes, in the order of the drivetrain; both flanks in contact, mean stiffness

    Raises DrivetrainError as `RunningState.check`.
    """
    system = seen.system(state)
    return modes_of_loop(system, laws, highest_frequency, description(seen, system, state))


def description(seen: SeenRig, system: LinearSystem, state: RunningState) -> Describe:
    """What names the shapes of a system made of a rig at a running state."""
    return _Description(seen, system, state.bearings).of


@dataclass(frozen=True)
class _Description:
    """Strain energies of a shape in the freedoms of a system."""

    seen: SeenRig
    system: LinearSystem
    bearings: Mapping[str, BearingCoefficients]

    def of(self, shape: Complex, mesh_energy: Array) -> ModeShape:
        """Describe a shape (n,) with the energies of the meshes."""
        reduced = self.seen.reduced
        model = reduced.model
        own = times(self._to_coordinates, shape)
        whole = times(reduced.basis, own)
        energy: dict[str, float] = {}
        for name, stiffness in self._shafts.items():
            energy[name] = _energy(stiffness, whole)
        for joint in model.joints:
            part = joint.name if joint.kind in ("spline", "coupling") else f"{joint.kind} {joint.name}"
            energy[part] = energy.get(part, 0.0) + _energy(joint.stiffness, times(joint.rows, whole))
        for name, coefficients in self.bearings.items():
            spring = coefficients.padded()[0]
            energy[f"bearing {name}"] = _energy(0.5 * (spring + spring.T), times(reduced.ports[name], own))
        for name, value in zip(self.seen.ports, mesh_energy):
            energy[f"mesh {name}"] = float(value)
        shares = energy_shares({name: max(value, 0.0) for name, value in energy.items()})
        return ModeShape(
            largest=model.names[int(np.argmax(self._sizes * np.abs(whole)))],
            name=shape_name(shares),
            energy=shares,
        )

    @cached_property
    def _to_coordinates(self) -> Array:
        """(n, n) coordinates of the reduced rig per freedom."""
        return np.asarray(np.linalg.inv(self.system.coordinates.freedoms), np.float64)

    @cached_property
    def _sizes(self) -> Array:
        """(n_full,) square root of the diagonal of the mass: makes displacements and rotations comparable."""
        return np.array(np.sqrt(self.seen.reduced.model.mass.diagonal()), np.float64)

    @cached_property
    def _shafts(self) -> dict[str, csr_array]:
        """Stiffness of the elements of every shaft by ``shaft torsion``, ``shaft axial``, ``shaft bending``."""
        model = self.seen.reduced.model
        joints = csr_array((model.size, model.size))
        for joint in model.joints:
            rows = csr_array(joint.rows)
            joints = joints + rows.T @ csr_array(joint.stiffness) @ rows
        elements = csr_array(model.stiffness - joints)
        owner = np.array(model.freedoms.shaft_of)
        kind = np.array([FAMILY.get(name.rsplit(" ", 1)[1], "bending") for name in model.names])
        found = {}
        for number, shaft in enumerate(model.rig.drivetrain.shafts):
            for family in ("torsion", "axial", "bending"):
                mask = diags_array(((owner == number) & (kind == family)).astype(float))
                found[f"{shaft.name} {family}"] = csr_array(mask @ elements @ mask)
        return found


def _energy(stiffness: csr_array | Array, motion: Complex) -> float:
    return float(np.real(np.conj(motion) @ (stiffness @ motion)))
