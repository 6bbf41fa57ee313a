"""Modes of the closed elastic loop with names that stay: the torsional ones by number, the others by shaft and motion.

Bending puts its own modes between the torsional ones and shifts them, so that a number by rising frequency over all
modes says nothing. The loop that only twists (same stations, bending locked) gives as many torsional modes as there
are; each is matched with the elastic mode that is most like it, by the modal assurance criterion with the mass as
weight (R. J. Allemang, D. L. Brown, IMAC 1982), one to one and largest in sum. The matched ones are numbered by rising
frequency: where two modes share a shape, a small change of the rig exchanges their shares, not their numbers.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.modal_form import ModalForm, modal_form
from dynamics.drivetrain.modes import LEAST_DAMPING, closed_matrices
from dynamics.elastic_rig.damped_modes import mode_character
from dynamics.elastic_rig.freedoms import FAMILIES
from dynamics.elastic_rig.reduction import ReducedElasticRig
from dynamics.elastic_rig.seen_system import SeenRig
from dynamics.mesh.law import MeshLaw

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
