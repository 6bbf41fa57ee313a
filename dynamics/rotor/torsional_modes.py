"""Natural frequencies with named shapes, damping of every joint and mesh, order crossings, sampling.

Audits of a rig's input: which joint is so strongly damped that its stiffness plays no part, at which speeds a
mesh order meets a natural frequency, how many samples a recording has per mesh.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from dynamics.rotor.graph import Drivetrain, TorsionalJoint, assemble, joints
from dynamics.rotor.linear_system import LinearSystem, modal_form
from dynamics.rotor.parts import speed_ratios
from dynamics.tooth.law import MeshLaw

Array = NDArray[np.float64]


DAMPING_RATIO_LIMIT = 0.3
"""Above this damping ratio a joint or mesh gets a warning: the resonance of its spring is gone [-]."""

SEEN_GAIN = 1.0
"""Mesh gain from which a mode above the sampled band is worth a warning: its mesh answers it like a static load [-]."""

LEAST_DAMPING = 1e-9
"""Damping ratio taken for a mode that no damper reaches, so that its gain stays a number [-]."""


@dataclass(frozen=True, kw_only=True)
class LoopMode:
    """Mode of the closed loop with mean mesh stiffness.

    frequency : undamped natural frequency |pole| / 2 pi [Hz]; damping_ratio [-]
    name : parts that hold the strain energy, largest first
    energy : part -> share of strain energy [-], shafts, splines, couplings and meshes
    mesh_gain : (n_meshes,) peak of mean mesh stiffness times approach per mesh force of this mode alone [-];
        far below 1 the mesh hardly excites it
    largest : freedom that oscillates most, ``shaft/station``
    """

    frequency: float
    damping_ratio: float
    name: str
    energy: dict[str, float]
    mesh_gain: Array
    largest: str = ""


@dataclass(frozen=True, kw_only=True)
class ModeShape:
    """What a mode shape shows: where it is largest, its name, and share of strain energy by part [-]."""

    largest: str
    name: str
    energy: dict[str, float]


Describe = Callable[[NDArray[np.complex128], Array], ModeShape]
"""Describes the shape (n,) of a mode, with the strain energy of every mesh in it (n_meshes,)."""


def loop_modes(
    drivetrain: Drivetrain, laws: Sequence[MeshLaw], highest_frequency: float = 20e3
) -> tuple[LoopMode, ...]:
    """Rigid mode (0 Hz) and all oscillating modes of a torsional loop up to a frequency [Hz], see `modes_of_loop`."""
    system = assemble(drivetrain)
    parts = joints(drivetrain)
    for ports, mesh in zip(system.mesh_ports, drivetrain.meshes):
        parts = (*parts, TorsionalJoint(f"mesh {mesh.name}", "mesh", int(ports[0]), int(ports[1]), 0.0, 0.0))

    def describe(shape: NDArray[np.complex128], mesh_energy: Array) -> ModeShape:
        energy = _strain_energy(parts, shape, mesh_energy)
        return ModeShape(
            largest=system.dofs[int(np.argmax(np.abs(shape)))], name=shape_name(energy), energy=energy
        )

    return modes_of_loop(system, laws, highest_frequency, describe)


def modes_of_loop(
    system: LinearSystem, laws: Sequence[MeshLaw], highest_frequency: float, describe: Describe
) -> tuple[LoopMode, ...]:
    """Rigid mode (0 Hz) and all oscillating modes up to a frequency [Hz], meshes at their mean stiffness.

    Overdamped pairs have no frequency and are left out.
    """
    inertia, damping, stiffness = closed_matrices(system, laws)
    form = modal_form(inertia, damping, stiffness, system.rigid)
    approach = np.zeros((len(laws), len(inertia)))
    for m, (law, ports) in enumerate(zip(laws, system.mesh_ports)):
        approach[m, ports] = law.base_radius_1, -law.base_radius_2
    mean = np.array([law.mean_stiffness for law in laws])
    modes = [
        LoopMode(
            frequency=0.0, damping_ratio=0.0, name="rigid rotation", energy={}, mesh_gain=np.zeros(len(laws))
        )
        for _ in range(form.rigid.shape[1])
    ]
    order = np.argsort(np.abs(form.poles), kind="stable")
    for i in order[form.poles.imag[order] > 1e-6 * np.abs(form.poles[order])]:
        pole, shape = form.poles[i], form.velocity_shapes[:, i]
        frequency = abs(pole) / (2.0 * math.pi)
        if frequency > highest_frequency:
            break
        reach = approach @ shape
        damping = max(abs(pole.real), LEAST_DAMPING * abs(pole))
        gain = np.abs(reach * (form.loads[i] @ approach.T)) * mean / (damping * abs(pole))
        seen = describe(shape, mean * np.abs(reach) ** 2)
        modes.append(
            LoopMode(
                frequency=float(frequency),
                damping_ratio=float(-pole.real / abs(pole)),
                name=seen.name,
                energy=seen.energy,
                mesh_gain=gain,
                largest=seen.largest,
            )
        )
    return tuple(modes)


def closed_matrices(system: LinearSystem, laws: Sequence[MeshLaw]) -> tuple[Array, Array, Array]:
    """Loop with every mesh as its mean spring and damper, both flanks in contact.

    laws : of the meshes, in the order of ``system.mesh_ports``

    Returns inertia (n, n) [kg m2], damping (n, n) [N m s/rad] and stiffness (n, n) [N m/rad] of the freedoms.
    """
    stiffness, damping = system.stiffness.copy(), system.damping.copy()
    for law, ports in zip(laws, system.mesh_ports):
        approach = np.zeros(len(system.inertia))
        approach[ports] = law.base_radius_1, -law.base_radius_2
        stiffness += law.mean_stiffness * np.outer(approach, approach)
        damping += law.damping * np.outer(approach, approach)
    return system.inertia, damping, stiffness


def _strain_energy(
    parts: Sequence[TorsionalJoint], shape: NDArray[np.complex128], mesh_energy: Array
) -> dict[str, float]:
    share: dict[str, float] = {}
    meshes = iter(mesh_energy)
    for joint in parts:
        if joint.kind == "mesh":
            value = float(next(meshes))
        else:
            value = joint.stiffness * float(np.abs(shape[joint.dof_a] - shape[joint.dof_b]) ** 2)
        share[joint.name] = share.get(joint.name, 0.0) + value
    return energy_shares(share)


def energy_shares(energy: Mapping[str, float]) -> dict[str, float]:
    """Energies of parts as shares of their sum [-], the largest first."""
    total = math.fsum(energy.values()) or 1.0
    return {name: value / total for name, value in sorted(energy.items(), key=lambda item: -item[1])}


def shape_name(energy: Mapping[str, float]) -> str:
    """Up to three parts that hold most of the strain energy: ``test_pinion 62 %, mesh test 21 %``."""
    named, total = [], 0.0
    for part, share in energy.items():
        named.append(f"{part} {share:.0%}".replace("%", " %"))
        total += share
        if total > 0.75 or len(named) == 3:
            break
    return ", ".join(named)


@dataclass(frozen=True, kw_only=True)
class DampingRecord:
    """Damping of one joint or mesh.

    damping_ratio : c / (2 sqrt(k J)) with J the smaller body against the larger held (reduced inertia) [-]
    corner_frequency : k / (2 pi c) [Hz]; far above it the damper bridges the spring
    own_frequency : sqrt(k / J) / 2 pi [Hz], what the joint would resonate at without damper
    warning : empty, or name, value, limit, remedy
    """

    name: str
    kind: str
    damping_ratio: float
    corner_frequency: float
    own_frequency: float
    warning: str


def damping_record(name: str, kind: str, stiffness: float, damping: float, inertia: float) -> DampingRecord:
    """Audit one spring-damper against the inertia (or mass) it holds.

    name, kind : for the message
    stiffness : above 0; damping : not negative; inertia : above 0; consistent SI units, torsional or translational

    Damping ratio c / (2 sqrt(k J)), corner frequency k / (2 pi c) above which the damper makes the joint rigid; the
    record warns above DAMPING_RATIO_LIMIT.
    """
    ratio = damping / (2.0 * math.sqrt(stiffness * inertia))
    corner = stiffness / (2.0 * math.pi * damping) if damping > 0.0 else math.inf
    warning = ""
    if ratio > DAMPING_RATIO_LIMIT:
        warning = (
            f"{kind} {name!r}: damping ratio = {ratio:.3g}, limit {DAMPING_RATIO_LIMIT}: above its corner "
            f"frequency of {corner:.3g} Hz the damper makes the joint rigid and deletes a resonance; measure "
            "the damping or run a variant with less"
        )
    return DampingRecord(
        name=name,
        kind=kind,
        damping_ratio=ratio,
        corner_frequency=corner,
        own_frequency=math.sqrt(stiffness / inertia) / (2.0 * math.pi),
        warning=warning,
    )


def damping_audit(drivetrain: Drivetrain, laws: Sequence[MeshLaw]) -> tuple[DampingRecord, ...]:
    """Damping ratio and corner frequency of every spline, coupling, motor joint and mesh.

    Inertia taken: gear body on its spline with the shaft held; for a coupling the reduced inertia of the two
    shafts with their gear bodies; for a mesh the reduced mass of the two gear bodies on the line of action.
    """
    records = []
    of_shaft = {shaft.name: shaft.inertia for shaft in drivetrain.shafts}
    for gear in drivetrain.gears:
        of_shaft[gear.shaft] += gear.inertia
        records.append(damping_record(gear.name, "spline", gear.stiffness, gear.damping, gear.inertia))
    for coupling in drivetrain.couplings:
        a, b = (of_shaft[name] for name in coupling.shafts)
        records.append(
            damping_record(coupling.name, "coupling", coupling.stiffness, coupling.damping, a * b / (a + b))
        )
    motor = drivetrain.motor
    if motor.stiffness is not None:
        records.append(damping_record("motor", "motor joint", motor.stiffness, motor.damping, motor.inertia))
    for mesh, law in zip(drivetrain.meshes, laws):
        pinion, wheel = drivetrain.gear(mesh.pinion), drivetrain.gear(mesh.wheel)
        mobility = law.base_radius_1**2 / pinion.inertia + law.base_radius_2**2 / wheel.inertia
        records.append(damping_record(mesh.name, "mesh", law.mean_stiffness, law.damping, 1.0 / mobility))
    return tuple(records)


@dataclass(frozen=True, kw_only=True)
class SamplingAudit:
    """Samples of a recording per mesh period at top speed.

    harmonics : whole mesh harmonics below half the sample rate; warning : empty, or name, value, limit,
    remedy
    """

    mesh: str
    mesh_frequency: float
    samples_per_mesh: float
    harmonics: int
    warning: str


def sampling_audit(
    drivetrain: Drivetrain, speed: float, sample_rate: float, samples_wanted: float = 10.0
) -> tuple[SamplingAudit, ...]:
    """Audit every mesh of a recording at a speed of the motor's shaft.

    speed : [rad/s], above 0; sample_rate : [Hz]; samples_wanted : per mesh period, below which a record warns [-]
    """
    ratios = speed_ratios(drivetrain)
    audits = []
    for mesh in drivetrain.meshes:
        pinion_speed = speed * ratios[drivetrain.gear(mesh.pinion).shaft]
        frequency = pinion_speed * mesh.teeth[0] / (2.0 * math.pi)
        samples = sample_rate / frequency
        warning = ""
        if samples < samples_wanted:
            warning = (
                f"mesh {mesh.name!r}: samples per mesh = {samples:.2f}, limit {samples_wanted:g}: the "
                f"waveform and harmonics above {int(samples / 2)} are lost; sample at "
                f"{samples_wanted * frequency:.3g} Hz or use the envelopes taken at the internal rate"
            )
        audits.append(
            SamplingAudit(
                mesh=mesh.name, mesh_frequency=frequency, samples_per_mesh=samples,
                harmonics=int(samples / 2.0), warning=warning,
            )
        )  # fmt: skip
    return tuple(audits)


def modes_above_samples(modes: Sequence[LoopMode], sample_rate: float) -> tuple[str, ...]:
    """Warnings of modes that the meshes excite above half of a sample rate [Hz], with name, frequency and remedy."""
    band = 0.5 * sample_rate
    return tuple(
        f"mode of {mode.frequency / 1e3:.2f} kHz ({mode.name}): above half the sample rate of "
        f"{sample_rate / 1e3:g} kHz: sampled speeds and torques show it at "
        f"{abs(mode.frequency - sample_rate * round(mode.frequency / sample_rate)) / 1e3:.2f} kHz; sample at "
        f"{2.5 * mode.frequency / 1e3:.0f} kHz, or use means and envelopes, which come from the internal steps"
        for mode in modes
        if mode.frequency > band and float(mode.mesh_gain.max(initial=0.0)) >= SEEN_GAIN
    )


# Modes of the closed loop followed over speed by their shapes.
#
# A mode at one speed is the one at the speed before whose shape is most alike: modal assurance criterion (Allemang and
# Brown, Proc. 1st IMAC, 1982, 110) with the inertia as weight, one partner each (linear assignment).

Complex = NDArray[np.complex128]

ALIKE = 0.3
"""Assurance from which two shapes are one mode [-]; neighbours of one frequency mix, and still share this much."""


@dataclass(frozen=True, kw_only=True)
class ShapedModes:
    """Oscillating modes at one speed with their shapes.

    speed : stated speed [rad/s]; modes : by frequency; shapes : (n, m) in the freedoms of the system
    """

    speed: float
    modes: tuple[LoopMode, ...]
    shapes: Complex


@dataclass(frozen=True)
class TrackedMode:
    """One mode over speed; None where it is damped out or beyond the range."""

    modes: tuple[LoopMode | None, ...]

    @property
    def strongest(self) -> LoopMode:
        """Where a mesh excites it most."""
        return max((mode for mode in self.modes if mode), key=lambda mode: float(mode.mesh_gain.max()))


def shaped_modes(
    system: LinearSystem,
    laws: Sequence[MeshLaw],
    describe: Describe,
    speed: float,
    highest_frequency: float,
) -> ShapedModes:
    """Oscillating modes of the closed loop up to a frequency [Hz], meshes at their mean stiffness.

    system, laws : as of `modes_of_loop`; speed : at which the matrices hold [rad/s]
    """
    shapes: list[Complex] = []

    def keep(shape: Complex, mesh_energy: Array) -> ModeShape:
        shapes.append(shape)
        return describe(shape, mesh_energy)

    loop_modes = modes_of_loop(system, laws, highest_frequency, keep)
    modes = tuple(mode for mode in loop_modes if mode.frequency > 0.0)
    size = len(system.inertia)
    columns = np.array(shapes).T if shapes else np.zeros((size, 0), complex)
    return ShapedModes(speed=speed, modes=modes, shapes=columns)


def tracked(by_speed: Sequence[ShapedModes], inertia: Array) -> tuple[TrackedMode, ...]:
    """Every mode over the speeds of ``by_speed``, in the order of their first frequency.

    inertia : (n, n) of the system, the same at all speeds
    """
    root = np.linalg.cholesky(inertia).T
    rows: list[list[LoopMode | None]] = []
    members: list[int] = []
    before: Complex | None = None
    for number, shaped in enumerate(by_speed):
        shapes = root @ shaped.shapes
        shapes = shapes / np.linalg.norm(shapes, axis=0)
        partners = {} if before is None else _partners(before, shapes, by_speed[number - 1], shaped)
        current = []
        for k, mode in enumerate(shaped.modes):
            if k in partners:
                row = members[partners[k]]
            else:
                row = len(rows)
                rows.append([None] * len(by_speed))
            rows[row][number] = mode
            current.append(row)
        before, members = shapes, current
    return tuple(TrackedMode(tuple(row)) for row in sorted(rows, key=_first))


def _first(row: Sequence[LoopMode | None]) -> float:
    return next(mode.frequency for mode in row if mode)


def _partners(old: Complex, new: Complex, before: ShapedModes, after: ShapedModes) -> dict[int, int]:
    """Mode before for each mode after."""
    if not (old.size and new.size):
        return {}
    assurance = np.abs(np.conj(old).T @ new) ** 2
    frequencies = [np.array([mode.frequency for mode in shaped.modes]) for shaped in (before, after)]
    apart = np.abs(np.log(frequencies[0][:, None] / frequencies[1]))
    rows, columns = linear_sum_assignment(apart - assurance)
    return {int(k): int(j) for j, k in zip(rows, columns) if assurance[j, k] >= ALIKE}


# Speeds at which a mesh or shaft order meets a mode of the closed loop.
#
# Crossings of isolated shafts (`modes.order_crossings`, P2's way) tell which shaft would oscillate alone; what is
# measured on the rig are the modes of the assembled loop: couplings, meshes and the bracing close it.


@dataclass(frozen=True, kw_only=True)
class LoopCrossing:
    """An order that meets a mode of the closed loop.

    source : mesh or shaft whose order it is; kind : which of the two
    mode : number of the mode, 1 for the lowest that oscillates
    harmonic : of the mesh frequency, or order of the shaft speed
    speed : at which they meet, of the motor's shaft; own_speed : of the pinion of the mesh, or of the shaft [rad/s]
    gain : `LoopMode.mesh_gain` of the mesh [-]; 0 for a shaft, which excites by its errors only
    """

    source: str
    kind: Literal["mesh", "shaft"]
    mode: int
    harmonic: int
    frequency: float
    damping_ratio: float
    speed: float
    own_speed: float
    gain: float


@dataclass(frozen=True)
class _Order:
    """First order of a mesh or shaft: turns of its frequency per turn of the motor, own speed per motor speed."""

    source: str
    kind: Literal["mesh", "shaft"]
    cycles: float
    ratio: float
    mesh: int


def loop_crossings(
    drivetrain: Drivetrain,
    modes: Sequence[LoopMode],
    highest_speed: float,
    mesh_harmonics: int = 4,
    shaft_harmonics: int = 3,
) -> tuple[LoopCrossing, ...]:
    """All crossings up to a speed of the motor's shaft [rad/s], meshes first, each by speed: w = 2 pi f / (h c).

    c is the number of cycles of the order per turn of the motor's shaft. Modes without a frequency are left out.
    """
    oscillating = [mode for mode in modes if mode.frequency > 0.0]
    crossings = []
    for order in _orders(drivetrain):
        of_order = []
        harmonics = mesh_harmonics if order.kind == "mesh" else shaft_harmonics
        for number, mode in enumerate(oscillating, start=1):
            for harmonic in range(1, harmonics + 1):
                speed = 2.0 * math.pi * mode.frequency / (harmonic * order.cycles)
                if speed <= highest_speed:
                    of_order.append(
                        LoopCrossing(
                            source=order.source,
                            kind=order.kind,
                            mode=number,
                            harmonic=harmonic,
                            frequency=mode.frequency,
                            damping_ratio=mode.damping_ratio,
                            speed=speed,
                            own_speed=speed * order.ratio,
                            gain=float(mode.mesh_gain[order.mesh]) if order.kind == "mesh" else 0.0,
                        )
                    )
        crossings += sorted(of_order, key=lambda crossing: (crossing.speed, crossing.mode))
    return tuple(crossings)


def _orders(drivetrain: Drivetrain) -> Iterator[_Order]:
    ratios = speed_ratios(drivetrain)
    for index, mesh in enumerate(drivetrain.meshes):
        ratio = ratios[drivetrain.gear(mesh.pinion).shaft]
        yield _Order(mesh.name, "mesh", mesh.teeth[0] * ratio, ratio, index)
    for shaft in drivetrain.shafts:
        yield _Order(shaft.name, "shaft", ratios[shaft.name], ratios[shaft.name], -1)
