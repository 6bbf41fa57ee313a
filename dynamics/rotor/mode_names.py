"""Modes of the closed elastic loop with names that stay: the torsional ones by number, the others by shaft and motion.

Bending puts its own modes between the torsional ones and shifts them, so that a number by rising frequency over all
modes says nothing. The loop that only twists (same stations, bending locked) gives as many torsional modes as there
are; each is matched with the elastic mode that is most like it, by the modal assurance criterion with the mass as
weight (R. J. Allemang, D. L. Brown, IMAC 1982), one to one and largest in sum. The matched ones are numbered by rising
frequency: where two modes share a shape, a small change of the rig exchanges their shares, not their numbers.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment
from scipy.sparse import csr_array, diags_array

from dynamics.rotor.bearing_state import BearingCoefficients, RunningState
from dynamics.rotor.craig_bampton import SeenRig
from dynamics.rotor.damped_modes import mode_character
from dynamics.rotor.freedoms import FAMILIES
from dynamics.rotor.linear_system import LinearSystem, ModalForm, modal_form, times
from dynamics.rotor.reduction import ReducedElasticRig
from dynamics.rotor.torsional_modes import (
    LEAST_DAMPING,
    Describe,
    LoopMode,
    ModeShape,
    closed_matrices,
    energy_shares,
    modes_of_loop,
    shape_name,
)
from dynamics.tooth.law import MeshLaw

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


Integers = NDArray[np.int64]

OSCILLATING = 1e-6
"""Imaginary part over magnitude above which a pole oscillates."""
SOUGHT = 1.3
"""Modes are looked at up to this times the highest torsional frequency asked for: bending shifts some that far."""


@dataclass(frozen=True, kw_only=True)
class NamedMode:
    """Oscillating mode of a closed loop with mean mesh stiffness.

    frequency : |pole| / 2 pi [Hz]; name : ``torsional 3``, ``lateral test_pinion 1``, ``axial …``, ``housing 2``
    likeness : modal assurance with its torsional mode [-]; 0 of the others
    mesh_gain : peak of mean mesh stiffness times approach per mesh force of this mode alone, largest of the meshes [-]
    """

    frequency: float
    name: str
    likeness: float
    mesh_gain: float


def torsional_modes(system: LinearSystem, laws: Sequence[MeshLaw], highest: float) -> tuple[NamedMode, ...]:
    """Modes up to a frequency [Hz] of a loop whose shafts only twist, by rising frequency."""
    form = modal_form(*closed_matrices(system, laws), system.rigid)
    found = _oscillating(form, highest)
    frequencies, gains = _frequencies(form, found), _mesh_gains(form, found, system, laws)
    return tuple(
        NamedMode(frequency=float(f), name=f"torsional {i}", likeness=1.0, mesh_gain=float(gain))
        for i, (f, gain) in enumerate(zip(frequencies, gains), start=1)
    )


def elastic_named_modes(
    seen: SeenRig, system: LinearSystem, laws: Sequence[MeshLaw], twisting: LinearSystem, highest: float
) -> tuple[NamedMode, ...]:
    """Modes of a closed elastic loop by rising frequency.

    system : of ``seen`` at a running state; laws : of the meshes, both flanks in contact, mean stiffness
    twisting : the same circuit with shafts that only twist
    highest : frequency [Hz] up to which modes are found; torsional ones belong to torsional modes up to there
    """
    form = modal_form(*closed_matrices(system, laws), system.rigid)
    found = _oscillating(form, SOUGHT * highest)
    frequencies, gains = _frequencies(form, found), _mesh_gains(form, found, system, laws)
    own = seen.on_coordinates(form.velocity_shapes[:, found])
    likeness = _likeness(seen.reduced, own, laws, twisting, highest)
    rows, matched = linear_sum_assignment(-likeness)
    alike = dict(zip(matched.tolist(), likeness[rows, matched].tolist()))
    names = _names(seen.reduced, own, set(alike))
    return tuple(
        NamedMode(frequency=float(f), name=name, likeness=alike.get(i, 0.0), mesh_gain=float(gain))
        for i, (f, name, gain) in enumerate(zip(frequencies, names, gains))
        if i in alike or f <= highest
    )


def _oscillating(form: ModalForm, highest: float) -> Integers:
    """Poles that oscillate up to a frequency [Hz], by rising magnitude."""
    size = np.abs(form.poles)
    wanted = (form.poles.imag > OSCILLATING * size) & (size <= 2.0 * np.pi * highest)
    index = np.flatnonzero(wanted)
    return np.asarray(index[np.argsort(size[index], kind="stable")], np.int64)


def _frequencies(form: ModalForm, found: Integers) -> Array:
    return np.array([abs(pole) / (2.0 * np.pi) for pole in form.poles[found]])


def _mesh_gains(form: ModalForm, found: Integers, system: LinearSystem, laws: Sequence[MeshLaw]) -> Array:
    """(m,) as `NamedMode.mesh_gain`."""
    poles = form.poles[found]
    gains = []
    for law, (pinion, wheel) in zip(laws, system.mesh_ports):
        reach = (
            law.base_radius_1 * form.velocity_shapes[pinion] - law.base_radius_2 * form.velocity_shapes[wheel]
        )
        load = law.base_radius_1 * form.loads[:, pinion] - law.base_radius_2 * form.loads[:, wheel]
        damping = np.maximum(np.abs(poles.real), LEAST_DAMPING * np.abs(poles))
        gains.append(law.mean_stiffness * np.abs(reach[found] * load[found]) / (damping * np.abs(poles)))
    return np.asarray(np.max(gains, axis=0), float)


def _likeness(
    reduced: ReducedElasticRig, own: Complex, laws: Sequence[MeshLaw], twisting: LinearSystem, highest: float
) -> Array:
    """(m_torsional, m) modal assurance of elastic shapes on the coordinates (n, m) with the torsional modes."""
    mass, damping, stiffness = closed_matrices(twisting, laws)
    form = modal_form(mass, damping, stiffness, twisting.rigid)
    torsional = form.velocity_shapes[:, _oscillating(form, highest)]
    turns = np.flatnonzero(np.array(reduced.model.freedoms.family) == FAMILIES.index("torsion"))
    shared = np.abs(torsional.conj().T @ mass @ (reduced.basis[turns] @ own)) ** 2
    size = np.real(np.einsum("it,ij,jt->t", torsional.conj(), mass, torsional))
    return np.asarray(shared / size[:, None] / np.sum(np.abs(own) ** 2, axis=0))


def _names(reduced: ReducedElasticRig, own: Complex, torsional: set[int]) -> Iterator[str]:
    """Names of modes by rising frequency; the coordinates are mass-orthonormal."""
    shafts = [shaft.name for shaft in reduced.model.rig.drivetrain.shafts]
    counts: dict[str, int] = {}
    for i, share in enumerate(mode_character(reduced, own).share):
        body, family = np.unravel_index(int(np.argmax(share)), share.shape)
        kind = FAMILIES[family] if body == len(shafts) else f"{FAMILIES[family]} {shafts[body]}"
        kind = "torsional" if i in torsional else kind
        counts[kind] = counts.get(kind, 0) + 1
        yield f"{kind} {counts[kind]}"


# Modes of the closed elastic loop, named by the parts that hold their strain energy.
#
# A shaft holds what its elements store in torsion, axial motion and bending, a joint, a bearing and a mesh what their
# springs store. Of a film, whose stiffness is not symmetric, the symmetric part counts.

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
