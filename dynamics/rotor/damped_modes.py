"""Damped modes of the elastic rig at one running state: poles, decrements, whirl, and where a mode moves.

The eigenproblem is solved in the reduced coordinates, displacements scaled by the undamped frequencies so that all
states have the unit of a velocity. A coordinate that no stiffness touches (the rigid motions) has no displacement
state, so no defective double zero arises: its velocity is the state, with a pole of exactly zero without drag.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import qr
from scipy.optimize import linear_sum_assignment
from scipy.sparse import csr_array, diags_array

from dynamics.rotor.assembly import ElasticModel
from dynamics.rotor.bearing_state import BearingCoefficients, RunningState, line_loads
from dynamics.rotor.craig_bampton import SeenRig
from dynamics.rotor.freedoms import FAMILIES
from dynamics.rotor.linear_system import LinearSystem, ModalForm, modal_form, times
from dynamics.rotor.location import unresisted
from dynamics.rotor.reduction import ReducedElasticRig
from dynamics.rotor.rotor_model import SpeedPower
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


OSCILLATING = 1e-8
"""Imaginary part over magnitude above which a pole oscillates."""


@dataclass(frozen=True, kw_only=True)
class DampedModes:
    """Oscillating modes in order of frequency, and the real poles of the rest.

    poles : (m,) with positive imaginary part [1/s]; shapes : (n, m) displacement in the coordinates of the rig
    real_poles : (k,) overdamped motions and rigid velocities [1/s], ascending magnitude
    """

    poles: Complex
    shapes: Complex
    real_poles: Array

    @property
    def frequency(self) -> Array:
        """(m,) damped natural frequency [Hz]."""
        return np.asarray(self.poles.imag / (2.0 * np.pi))

    @property
    def damping_ratio(self) -> Array:
        """(m,) share of critical damping -Re / |pole| [-]."""
        return np.asarray(-self.poles.real / np.abs(self.poles))

    @property
    def logarithmic_decrement(self) -> Array:
        """(m,) decay of one period to the next, -2 pi Re / Im [-]; negative is unstable."""
        return np.asarray(-2.0 * np.pi * self.poles.real / self.poles.imag)

    @property
    def amplification(self) -> Array:
        """(m,) 1 / (2 damping ratio) at resonance [-], infinite without damping."""
        ratio = np.abs(self.damping_ratio)
        return np.divide(0.5, ratio, where=ratio > 0.0, out=np.full_like(ratio, np.inf))


@dataclass(frozen=True, kw_only=True)
class ModeCharacter:
    """Where modes move.

    share : (m, n_shafts + 1, 4) of the kinetic energy in each shaft (last: housing) and family of `FAMILIES`
    whirl : (m, n_shafts) from -1 (backward circle) over 0 (line) to 1 (forward), in each shaft's own sense
    names : (m,) shaft and family that move most, with the direction of whirl if they whirl
    """

    share: Array
    whirl: Array
    names: tuple[str, ...]

    def lateral_whirl(self, least_share: float) -> tuple[float | None, ...]:
        """Whirl of the shaft that moves most sideways; None where lateral motion of shafts has less than a share."""
        lateral = self.share[:, :-1, FAMILIES.index("lateral")]
        leading = np.argmax(lateral, axis=1)
        return tuple(
            float(self.whirl[k, shaft]) if lateral[k].sum() >= least_share else None
            for k, shaft in enumerate(leading)
        )


def damped_modes(rig: ReducedElasticRig, state: RunningState, highest: float | None = None) -> DampedModes:
    """Modes of a rig at a state, up to a frequency [Hz] if given; raises DrivetrainError as `RunningState.check`."""
    matrices = rig.matrices(state)
    turned, stiffness, free = _free_first(matrices.stiffness, rig.n_rigid)
    n, elastic = rig.size, slice(free, rig.size)
    scale = np.sqrt(np.maximum(np.diag(stiffness)[elastic], 1.0))
    size = n - free
    system = np.zeros((size + n, size + n))
    system[np.arange(size), size + free + np.arange(size)] = scale
    system[size:, :size] = -stiffness[:, elastic] / scale
    system[size:, size:] = -(turned.T @ matrices.damping @ turned)
    poles, vectors = np.linalg.eig(system)
    oscillating = poles.imag > OSCILLATING * np.abs(poles)
    real = poles[np.abs(poles.imag) <= OSCILLATING * np.abs(poles)].real
    if highest is not None:
        oscillating &= poles.imag <= 2.0 * np.pi * highest
    index = np.flatnonzero(oscillating)
    index = index[np.argsort(poles[index].imag, kind="stable")]
    shapes = turned @ (vectors[size:, index] / poles[index])
    return DampedModes(
        poles=poles[index],
        shapes=np.asarray(shapes / np.linalg.norm(shapes, axis=0)),
        real_poles=real[np.argsort(np.abs(real), kind="stable")],
    )


def _free_first(stiffness: Array, n_rigid: int) -> tuple[Array, Array, int]:
    """Orthogonal change of coordinates that puts the motions without stiffness first: it, the stiffness, their number.

    Mesh springs leave one combination of the turns of the lines they join free; its row and column become exact zeros.
    """
    free = unresisted(stiffness[:, :n_rigid])
    count = free.shape[1]
    turned = np.eye(stiffness.shape[0])
    if 0 < count < n_rigid:
        turned[:n_rigid, :n_rigid] = qr(free)[0]
        stiffness = turned.T @ stiffness @ turned
    stiffness[:count] = 0.0
    stiffness[:, :count] = 0.0
    return turned, stiffness, count


def mode_character(rig: ReducedElasticRig, modes: Complex) -> ModeCharacter:
    """Energy shares, whirl and names of mode shapes (n, m) in the coordinates of the rig."""
    model = rig.model
    shapes = rig.basis @ modes
    energy = np.maximum(np.real(np.conj(shapes) * (model.mass @ shapes)), 0.0)
    shafts = [shaft.name for shaft in model.rig.drivetrain.shafts]
    owner = np.array(model.freedoms.shaft_of)
    family = np.array(model.freedoms.family)
    share = np.zeros((shapes.shape[1], len(shafts) + 1, len(FAMILIES)))
    for i in range(-1, len(shafts)):
        for j in range(len(FAMILIES)):
            share[:, i, j] = energy[(owner == i) & (family == j)].sum(axis=0)
    share /= share.sum(axis=(1, 2), keepdims=True)
    whirl = np.column_stack([_whirl(model, shaft, shapes) for shaft in shafts])
    return ModeCharacter(
        share=share,
        whirl=whirl,
        names=tuple(_name([*shafts, "housing"], share[k], whirl[k]) for k in range(shapes.shape[1])),
    )


def _whirl(model: ElasticModel, shaft: str, shapes: Complex) -> Array:
    """(m,) signed ratio of the areas of the orbits of a shaft to those of circles of their size."""
    nodes = model.freedoms.nodes[shaft]
    base = nodes.first + 6 * np.arange(nodes.x.size)
    across, up = shapes[base + 1], shapes[base + 2]
    area = -2.0 * np.imag(np.conj(across) * up).sum(axis=0)
    size = (np.abs(across) ** 2 + np.abs(up) ** 2).sum(axis=0)
    sense = np.sign(model.spins[shaft])
    return np.asarray(sense * np.divide(area, size, where=size > 0.0, out=np.zeros_like(area)))


def _name(bodies: list[str], share: Array, whirl: Array) -> str:
    body, family = np.unravel_index(int(np.argmax(share)), share.shape)
    name = bodies[body] if FAMILIES[family] == "housing" else f"{bodies[body]} {FAMILIES[family]}"
    if FAMILIES[family] != "lateral" or abs(whirl[body]) < 0.1:
        return name
    return f"{name} {'forward' if whirl[body] > 0.0 else 'backward'}"


# Lateral vibration at one running state: modes with decrement and amplification, whirl and forces under loads once a
# turn.

AT_REST = 0.01
"""Share of the speed of the reference shaft below which a pole is no oscillation: a shaft that moves freely in the play
of unloaded bearings, whose linear stiffness is zero."""
LineLoads = Mapping[tuple[str, SpeedPower], Complex]
"""Loads once a turn (n,) on the reduced coordinates, by line and power of its speed."""


@dataclass(frozen=True, kw_only=True)
class Orbit:
    """Ellipse of a lateral motion: half axes [m], the minor negative for backward whirl; angle of the major [rad]."""

    major: float
    minor: float
    angle: float


def orbit(across: complex, up: complex, sense: float = 1.0) -> Orbit:
    """Ellipse of u_y = Re(across e^{iwt}), u_z = Re(up e^{iwt}) on a shaft that turns about ``sense`` x."""
    forward = 0.5 * (across + 1j * sense * up)
    backward = 0.5 * np.conj(across - 1j * sense * up)
    angle = sense * 0.5 * (np.angle(forward) + np.angle(backward))
    return Orbit(
        major=float(abs(forward) + abs(backward)),
        minor=float(abs(forward) - abs(backward)),
        angle=float(angle),
    )


@dataclass(frozen=True, kw_only=True)
class RigMode:
    """One oscillating mode of the running rig.

    frequency : damped [Hz]; logarithmic_decrement : [-], negative is unstable; family : of `FAMILIES`, with most of its
    kinetic energy; shaft : that moves most, empty for the housing; whirl : of that shaft, -1 backward to 1 forward
    elastic_share : strain energy in shafts and couplings over the kinetic energy, 0 where shafts move as rigid bodies
    """

    name: str
    family: str
    shaft: str
    frequency: float
    logarithmic_decrement: float
    whirl: float
    elastic_share: float = 1.0

    @property
    def damping_ratio(self) -> float:
        """Share of critical damping [-]."""
        return self.logarithmic_decrement / math.hypot(2.0 * math.pi, self.logarithmic_decrement)

    @property
    def amplification(self) -> float:
        """AF = 1 / (2 damping ratio) [-]; infinite without damping or unstable."""
        return 0.5 / self.damping_ratio if self.damping_ratio > 0.0 else math.inf


def rig_modes(rig: ReducedElasticRig, state: RunningState, highest: float) -> tuple[RigMode, ...]:
    """Oscillating modes at a running state up to a frequency [Hz], by frequency.

    Springs of the state stand for the meshes. Raises DrivetrainError as `RunningState.check`.
    """
    modes = damped_modes(rig, state, highest)
    character = mode_character(rig, modes.shapes)
    elastic = _elastic_shares(rig, modes)
    shafts = [shaft.name for shaft in rig.model.rig.drivetrain.shafts]
    slowest = AT_REST * abs(state.speed) / (2.0 * math.pi)
    oscillating = []
    for i in range(modes.poles.size):
        if modes.frequency[i] <= slowest:
            continue
        body, family = np.unravel_index(int(np.argmax(character.share[i])), character.share[i].shape)
        on_shaft = body < len(shafts)
        oscillating.append(
            RigMode(
                name=character.names[i],
                family=FAMILIES[int(family)],
                shaft=shafts[int(body)] if on_shaft else "",
                frequency=float(modes.frequency[i]),
                logarithmic_decrement=float(modes.logarithmic_decrement[i]),
                whirl=float(character.whirl[i, body]) if on_shaft else 0.0,
                elastic_share=float(elastic[i]),
            )
        )
    return tuple(oscillating)


def _elastic_shares(rig: ReducedElasticRig, modes: DampedModes) -> Array:
    """(m,) as `RigMode.elastic_share`; bearings, meshes and housings are no part of the strain."""
    model = rig.model
    shapes = rig.basis @ modes.shapes
    on_shafts = np.flatnonzero(np.array(model.freedoms.shaft_of) >= 0)
    moved = shapes[on_shafts]
    strain = np.real(np.sum(np.conj(moved) * (model.stiffness[on_shafts][:, on_shafts] @ moved), axis=0))
    kinetic = np.real(np.sum(np.conj(shapes) * (model.mass @ shapes), axis=0)) * np.abs(modes.poles) ** 2
    return np.asarray(np.maximum(strain, 0.0) / kinetic)


@dataclass(frozen=True, kw_only=True)
class LineWhirl:
    """Motion once a turn of one shaft line: frequency [rad/s], complex coordinates (n,) of the reduced rig."""

    line: str
    frequency: float
    motion: Complex


def reduced_line_loads(rig: ReducedElasticRig) -> LineLoads:
    """What turns with every line, for all speeds."""
    return {
        key: rig.rows(load.real) + 1j * rig.rows(load.imag) for key, load in line_loads(rig.model).items()
    }


def line_whirls(rig: ReducedElasticRig, state: RunningState, loads: LineLoads) -> tuple[LineWhirl, ...]:
    """Response to the loads once a turn of every line that has some; what shakes one line moves the others as well.

    Raises DrivetrainError as `RunningState.check`.
    """
    matrices = rig.matrices(state)
    speeds = {name: abs(rig.model.spins[name]) * state.speed for name, _ in loads}
    whirls = []
    for name, speed in speeds.items():
        if not speed > 0.0:
            continue
        load = sum(
            (speed**power * amplitude for (line, power), amplitude in loads.items() if line == name),
            np.zeros(rig.size, complex),
        )
        motion = matrices.response(np.asarray(load)[:, None], speed)[:, 0]
        whirls.append(LineWhirl(line=name, frequency=speed, motion=motion))
    return tuple(whirls)


def whirl_at(whirls: tuple[LineWhirl, ...], rows: Array, sense: float) -> dict[str, Orbit]:
    """Orbit of a place by line, from the rows (2, n) of its motion along y and z on the reduced coordinates."""
    orbits = {}
    for whirl in whirls:
        across, up = rows @ whirl.motion
        orbits[whirl.line] = orbit(complex(across), complex(up), sense)
    return orbits


def bearing_forces(
    rig: ReducedElasticRig, state: RunningState, whirls: tuple[LineWhirl, ...], bearing: str
) -> dict[str, Orbit]:
    """Force [N] that turns once with a line in a bearing, K w + C w', by line: half axes of its ellipse."""
    stiffness, damping = (matrix[:2] for matrix in state.bearings[bearing].padded())
    orbits = {}
    for whirl in whirls:
        motion = rig.ports[bearing] @ whirl.motion
        force = stiffness @ motion + 1j * whirl.frequency * damping @ motion
        orbits[whirl.line] = orbit(complex(force[0]), complex(force[1]))
    return orbits


# Modes of the closed elastic loop with names that stay: the torsional ones by number, the others by shaft and motion.
#
# Bending puts its own modes between the torsional ones and shifts them, so that a number by rising frequency over all
# modes says nothing. The loop that only twists (same stations, bending locked) gives as many torsional modes as there
# are; each is matched with the elastic mode that is most like it, by the modal assurance criterion with the mass as
# weight (R. J. Allemang, D. L. Brown, IMAC 1982), one to one and largest in sum. The matched ones are numbered by
# rising frequency: where two modes share a shape, a small change of the rig exchanges their shares, not their numbers.

Integers = NDArray[np.int64]

LEAST_OSCILLATION = 1e-6
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
    index = _oscillating(form, highest)
    frequencies, gains = _frequencies(form, index), _mesh_gains(form, index, system, laws)
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
    index = _oscillating(form, SOUGHT * highest)
    frequencies, gains = _frequencies(form, index), _mesh_gains(form, index, system, laws)
    modes = seen.on_coordinates(form.velocity_shapes[:, index])
    likeness = _likeness(seen.reduced, modes, laws, twisting, highest)
    rows, matched = linear_sum_assignment(-likeness)
    alike = dict(zip(matched.tolist(), likeness[rows, matched].tolist()))
    names = _names(seen.reduced, modes, set(alike))
    return tuple(
        NamedMode(frequency=float(f), name=name, likeness=alike.get(i, 0.0), mesh_gain=float(gain))
        for i, (f, name, gain) in enumerate(zip(frequencies, names, gains))
        if i in alike or f <= highest
    )


def _oscillating(form: ModalForm, highest: float) -> Integers:
    """Poles that oscillate up to a frequency [Hz], by rising magnitude."""
    size = np.abs(form.poles)
    wanted = (form.poles.imag > LEAST_OSCILLATION * size) & (size <= 2.0 * np.pi * highest)
    index = np.flatnonzero(wanted)
    return np.asarray(index[np.argsort(size[index], kind="stable")], np.int64)


def _frequencies(form: ModalForm, index: Integers) -> Array:
    return np.array([abs(pole) / (2.0 * np.pi) for pole in form.poles[index]])


def _mesh_gains(form: ModalForm, index: Integers, system: LinearSystem, laws: Sequence[MeshLaw]) -> Array:
    """(m,) as `NamedMode.mesh_gain`."""
    poles = form.poles[index]
    gains = []
    for law, (pinion, wheel) in zip(laws, system.mesh_ports):
        reach = (
            law.base_radius_1 * form.velocity_shapes[pinion] - law.base_radius_2 * form.velocity_shapes[wheel]
        )
        load = law.base_radius_1 * form.loads[:, pinion] - law.base_radius_2 * form.loads[:, wheel]
        damping = np.maximum(np.abs(poles.real), LEAST_DAMPING * np.abs(poles))
        gains.append(law.mean_stiffness * np.abs(reach[index] * load[index]) / (damping * np.abs(poles)))
    return np.asarray(np.max(gains, axis=0), float)


def _likeness(
    reduced: ReducedElasticRig,
    modes: Complex,
    laws: Sequence[MeshLaw],
    twisting: LinearSystem,
    highest: float,
) -> Array:
    """(m_torsional, m) modal assurance of elastic shapes on the coordinates (n, m) with the torsional modes."""
    mass, damping, stiffness = closed_matrices(twisting, laws)
    form = modal_form(mass, damping, stiffness, twisting.rigid)
    torsional = form.velocity_shapes[:, _oscillating(form, highest)]
    turns = np.flatnonzero(np.array(reduced.model.freedoms.family) == FAMILIES.index("torsion"))
    shared = np.abs(torsional.conj().T @ mass @ (reduced.basis[turns] @ modes)) ** 2
    size = np.real(np.einsum("it,ij,jt->t", torsional.conj(), mass, torsional))
    return np.asarray(shared / size[:, None] / np.sum(np.abs(modes) ** 2, axis=0))


def _names(reduced: ReducedElasticRig, modes: Complex, torsional: set[int]) -> Iterator[str]:
    """Names of modes by rising frequency; the coordinates are mass-orthonormal."""
    shafts = [shaft.name for shaft in reduced.model.rig.drivetrain.shafts]
    counts: dict[str, int] = {}
    for i, share in enumerate(mode_character(reduced, modes).share):
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
        motion = times(self._to_coordinates, shape)
        whole = times(reduced.basis, motion)
        energy: dict[str, float] = {}
        for name, stiffness in self._shafts.items():
            energy[name] = _energy(stiffness, whole)
        for joint in model.joints:
            part = joint.name if joint.kind in ("spline", "coupling") else f"{joint.kind} {joint.name}"
            energy[part] = energy.get(part, 0.0) + _energy(joint.stiffness, times(joint.rows, whole))
        for name, coefficients in self.bearings.items():
            spring = coefficients.padded()[0]
            energy[f"bearing {name}"] = _energy(0.5 * (spring + spring.T), times(reduced.ports[name], motion))
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
        stiffness = {}
        for number, shaft in enumerate(model.rig.drivetrain.shafts):
            for family in ("torsion", "axial", "bending"):
                mask = diags_array(((owner == number) & (kind == family)).astype(float))
                stiffness[f"{shaft.name} {family}"] = csr_array(mask @ elements @ mask)
        return stiffness


def _energy(stiffness: csr_array | Array, motion: Complex) -> float:
    return float(np.real(np.conj(motion) @ (stiffness @ motion)))
