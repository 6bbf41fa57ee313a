"""Rows of the dynamics solvers: energy of the mesh law, static closure of the loop; and of the oscillator."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsNotConverged
from dynamics.rotor.linear_system import LinearSystem, line_shapes, modal_form
from dynamics.rotor.static_loop import LoopLoad, port_model, solve_static
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_force import PackedMeshes, evaluate_mesh, pack_meshes
from dynamics.vibration.harmonic_balance import BalanceProblem, HarmonicGrid, HarmonicSolution, solve_periodic
from dynamics.vibration.response_curve import waveform
from dynamics.vibration.steady_motion import TimeSettings, periodic_by_time
from rigdesign.rig.model import Rig
from tests.published.prototype import RPM, TEST_TORQUE, Prototype
from tests.published.rows import Gate, PublishedQuantity, ValidationRow, Window, compare, not_modelled
from tests.published.speed_sweeps import simulation_laws, smooth

Array = NDArray[np.float64]

ENERGY = "Oh, Grosh and Barber 2005; validation case V11"
DWELL = 12000.0
"""Speed of the dwell whose momentum is balanced [rpm]."""


def mechanics_rows(prototype: Prototype) -> Iterator[ValidationRow]:
    """V4, V5, V11 and V12 of the validation sheet."""
    yield from oscillator_rows()
    yield not_modelled(
        PublishedQuantity(
            id="V5-rotor",
            text="geared rotor, mesh mode",
            source="Kahraman et al. 1992",
            printed="2524",
            unit="Hz",
        ),
        "verification",
        reason="needs bending of the shafts; the drivetrain is torsional",
    )
    yield from _energy_rows(prototype)
    yield _closure_row(prototype)
    yield _momentum_row(prototype)


# ---- V11: force and torques from one potential neither create nor destroy energy


def _energy_rows(prototype: Prototype) -> Iterator[ValidationRow]:
    rig = prototype.simulated
    shipped = simulation_laws(prototype)[0]._replace(damping=0.0, friction=0.0)
    wave = _waved(shipped, 0.3)
    free = "without damping and friction, two free gears, Runge-Kutta with 16 steps per 40 kHz sample"
    cases = (
        ("", "shipped mesh law, 100 meshes at 12,000 rpm", shipped, _torques, 12000.0, 100, 3e-2),
        ("-1500", "shipped mesh law, 100 meshes at 1500 rpm", shipped, _torques, 1500.0, 100, 1e-3),
        ("-wave", "k(angle) waving by 30 %, 100 meshes at 12,000 rpm", wave, _torques, 12000.0, 100, 1e-3),
    )
    for identity, text, law, torques, speed, meshes, limit in cases:
        yield compare(
            PublishedQuantity(
                id=f"V11-energy{identity}",
                text=f"energy drift per strain energy, {text}",
                source=ENERGY,
                printed="conserved",
                unit="1",
            ),
            _drift(rig, law, torques, speed, meshes),
            "verification",
            Window(0.0, limit),
            assumptions=free,
        )
    yield compare(
        PublishedQuantity(
            id="V11-energy-control",
            text="the same with force times base radius only, k(angle) waving by 30 %",
            source=ENERGY,
            printed="above 0.3",
            unit="1",
        ),
        _drift(rig, wave, _bare_torques, 12000.0, 100),
        "verification",
        Window(0.3, np.inf),
        assumptions="negative control: without the torque from the change of stiffness over the angle "
        "energy is made and lost; the shipped law shows "
        f"{_drift(rig, shipped, _bare_torques, 12000.0, 100):.2g}",
    )


def _waved(law: MeshLaw, depth: float) -> MeshLaw:
    """A law of one pair whose stiffness waves once per base pitch by ``depth`` of its mean."""
    turns = np.linspace(0.0, 1.0, 241)
    wave = law.mean_stiffness * (1.0 + depth * np.cos(2.0 * np.pi * turns))
    none = np.zeros((1, turns.size))
    return smooth(law)._replace(
        path_step=law.base_pitch / (turns.size - 1), stiffness=wave[None, :], gap=none, deviation_1=none,
        deviation_2=none,
    )  # fmt: skip


MeshTorques = Callable[[MeshLaw, PackedMeshes, float, float], tuple[float, float]]


def _torques(law: MeshLaw, packed: PackedMeshes, angle: float, approach: float) -> tuple[float, float]:
    """Torques on pinion and wheel from the potential [N m]."""
    reaction = evaluate_mesh(packed, angle, approach, 0.0, 0.0)
    return float(reaction.torque_1[0]), float(reaction.torque_2[0])


def _bare_torques(law: MeshLaw, packed: PackedMeshes, angle: float, approach: float) -> tuple[float, float]:
    """Force times base radius, as a mesh with a stiffness k(t) has it."""
    reaction = evaluate_mesh(packed, angle, approach, 0.0, 0.0)
    force = float(reaction.force_front[0] - reaction.force_back[0])
    return -force * law.base_radius_1, force * law.base_radius_2


def _drift(rig: Rig, law: MeshLaw, torques: MeshTorques, speed_rpm: float, meshes: int) -> float:
    """Largest change of the total energy of two free gears per strain energy at 180 N m."""
    assert rig.drivetrain is not None
    packed = pack_meshes([law])
    mesh = rig.drivetrain.meshes[0]
    inertia = np.array([rig.drivetrain.gear(name).inertia for name in (mesh.pinion, mesh.wheel)])
    radius = np.array([law.base_radius_1, law.base_radius_2])
    load = TEST_TORQUE * np.array([1.0, -radius[1] / radius[0]])
    force = TEST_TORQUE / radius[0]
    strain = 0.5 * force**2 / law.mean_stiffness
    speed = speed_rpm * RPM
    step = 1.0 / (40e3 * 16)
    count = round(meshes * 2.0 * np.pi / law.teeth_1 / speed / step)

    def rate(state: Array) -> Array:
        approach = float(radius[0] * state[0] - radius[1] * state[1] + law.offset)
        torque = np.array(torques(law, packed, float(state[0]), approach))
        return np.concatenate([state[2:], (torque + load) / inertia])

    def energy(state: Array) -> float:
        approach = float(radius[0] * state[0] - radius[1] * state[1] + law.offset)
        stored = float(evaluate_mesh(packed, float(state[0]), approach, 0.0, 0.0).energy[0])
        return stored + float(0.5 * inertia @ state[2:] ** 2 - load @ state[:2])

    windup = (law.offset - force / law.mean_stiffness) / radius[1]
    state = np.array([0.0, windup, speed, speed * radius[0] / radius[1]])
    first = energy(state)
    largest = 0.0
    for i in range(1, count + 1):
        state = _runge_kutta(rate, state, step)
        if i % 16 == 0:
            largest = max(largest, abs(energy(state) - first))
    return float(largest / strain)


def _runge_kutta(rate: Callable[[Array], Array], state: Array, step: float) -> Array:
    """One classical step of fourth order."""
    k_1 = rate(state)
    k_2 = rate(state + 0.5 * step * k_1)
    k_3 = rate(state + 0.5 * step * k_2)
    k_4 = rate(state + step * k_3)
    return np.asarray(state + step / 6.0 * (k_1 + 2.0 * k_2 + 2.0 * k_3 + k_4))


# ---- V12: static closure of the loop


def _closure_row(prototype: Prototype) -> ValidationRow:
    """Torque per twist of the loop with constant mesh springs, against the series sum by hand."""
    rig = prototype.simulated
    assert rig.system is not None
    laws = [smooth(law)._replace(backlash=0.0, damping=0.0, offset=0.0) for law in simulation_laws(prototype)]
    state = solve_static(port_model(rig.system, laws), LoopLoad(torque=TEST_TORQUE))
    return compare(
        PublishedQuantity(
            id="V12-closure",
            text="stiffness of the closed loop, torque per bracing twist",
            source="series sum of sections, splines, couplings and meshes",
            value=_series_stiffness(rig, laws),
            unit="N m/rad",
        ),
        TEST_TORQUE / state.twist,
        "verification",
        Gate(1e-6),
        assumptions="meshes as constant springs of their mean stiffness, no play; the sum is taken by hand, "
        "section by section from gear to coupling",
    )


def _momentum_row(prototype: Prototype) -> ValidationRow:
    """Motor power from the momentum of the time integration at a dwell, against the losses one by one."""
    rig = prototype.simulated
    assert rig.system is not None
    run = periodic_by_time(
        rig.system,
        simulation_laws(prototype),
        speed=DWELL * RPM,
        load=LoopLoad(torque=TEST_TORQUE),
        settings=TimeSettings(tolerance=1e-4, internal_rate=640e3),
    )
    return compare(
        PublishedQuantity(
            id="V12-momentum",
            text=f"drive power of the time integration against its losses, {DWELL:.0f} rpm",
            source="momentum balance",
            value=run.total_loss,
            unit="W",
        ),
        run.drive_power + run.bracing_power,
        "verification",
        Gate(1e-3),
        assumptions="motor torque from the momentum gained and lost from block to block; losses integrated from the "
        "contacts, the rates of the joints and the bearing drag"
        + ("" if run.steady else f"; not steady: {'; '.join(run.warnings)}"),
    )


def _series_stiffness(rig: Rig, laws: list[MeshLaw]) -> float:
    """Stiffness at the pinion line [N m/rad]; the wheel line carries the ratio of the base radii more."""
    train = rig.drivetrain
    assert train is not None
    shafts = {shaft.name: shaft for shaft in train.shafts}
    ratio = laws[0].base_radius_2 / laws[0].base_radius_1
    pinions = {train.gear(mesh.pinion).shaft for mesh in train.meshes}
    compliance = 0.0
    for gear in train.gears:
        shaft = shafts[gear.shaft]
        weight = 1.0 if gear.shaft in pinions else ratio**2
        coupling = next(c for c in train.couplings if gear.shaft in c.shafts)
        length = sum(section.length for section in shaft.sections)
        end = 0.0 if coupling.ends[coupling.shafts.index(gear.shaft)] == "left" else length
        low, high = sorted((gear.position, end))
        start = 0.0
        for section in shaft.sections:
            inside = max(0.0, min(start + section.length, high) - max(start, low))
            area = np.pi * (section.outer_diameter**4 - section.inner_diameter**4) / 32.0
            compliance += weight * inside / (shaft.shear_modulus * area)
            start += section.length
        compliance += weight / gear.stiffness
    for coupling in train.couplings:
        compliance += (1.0 if coupling.shafts[0] in pinions else ratio**2) / coupling.stiffness
    meshes = sum(1.0 / (law.mean_stiffness * law.base_radius_1**2) for law in laws)
    return 1.0 / (float(compliance) + meshes)


# V4: the piecewise-linear oscillator with play by harmonic balance, both branches of its jump.
#
# x'' + 2 zeta x' + g(x) = F_m + F_a W^2 cos(W t), g = x -+ 1 outside |x| > 1 and 0 inside; zeta 0.05, F_m 0.1, F_a 0.05
# (Kahraman and Singh, J. Sound Vib. 142, 1990). The oscillator is one mesh of stiffness 1 between a body of inertia 1
# with a grounded damper and a wheel too heavy to move; a soft spring leads to the drive, a drag torque loads the wheel.

ZETA, MEAN_FORCE, FORCE = 0.05, 0.1, 0.05
BOTH = {
    0.50: 0.0166,
    0.70: 0.0476,
    0.85: 0.2555,
    0.90: 0.2292,
    0.95: 0.2065,
    1.00: 0.1870,
    1.10: 0.1559,
    1.30: 0.1150,
}
UP = {**BOTH, 0.75: 0.0634, 0.80: 0.0868}
"""Half peak-to-peak amplitude at each frequency swept upwards: DOP853 at 1e-9 over 400 cycles."""
DOWN = {**BOTH, 0.75: 0.3183, 0.80: 0.2857}
"""The same swept downwards: the upper branch holds to 0.75."""
SHOWN = {"up": (0.75, 0.80, 0.85, 0.90, 1.00, 1.30), "down": (1.00, 0.85, 0.80, 0.75)}
TEETH, HEAVY, SOFT = 1000, 1e8, 1e-5


def oscillator_rows() -> Iterator[ValidationRow]:
    """Rows round the jump, swept up and down."""
    for direction, published in (("up", UP), ("down", DOWN)):
        steps = np.round(np.arange(0.60, 1.3001, 0.025), 4).tolist()
        found = sweep(steps if direction == "up" else steps[::-1])
        for frequency in SHOWN[direction]:
            yield compare(
                PublishedQuantity(
                    id=f"V4-{direction}-{frequency:.2f}",
                    text=f"piecewise-linear oscillator, half peak-to-peak at {frequency:.2f}, sweep "
                    f"{direction}",
                    source="Kahraman and Singh 1990, DOP853",
                    value=published[frequency],
                    unit="1",
                ),
                found[frequency],
                "verification",
                Gate(5e-3),
                assumptions="harmonic balance with 24 harmonics; damper grounded",
            )


def sweep(frequencies: Sequence[float]) -> dict[float, float]:
    """Half peak-to-peak amplitude by frequency over a continued sweep; where a branch ends, from beyond the gap."""
    system, law = _oscillator()
    model = port_model(system, [law])
    form = modal_form(system.inertia, system.damping, system.stiffness, system.rigid)
    problem = BalanceProblem(model=model, form=form, load=LoopLoad(twist=0.0))
    grid = HarmonicGrid(cells=1, harmonics=24, samples=512, cell_angle=2.0 * np.pi / TEETH)
    rest = np.zeros((2, grid.top + 1), complex)
    rest[:, 0] = -MEAN_FORCE / SOFT, -MEAN_FORCE / SOFT - 1.1
    state = HarmonicSolution(
        grid=grid, speed=0.0, ports=rest, twist=0.0, drive=MEAN_FORCE, residual=np.inf, iterations=0
    )
    states: dict[float, HarmonicSolution] = {}
    for order in (frequencies, frequencies[::-1]):
        for frequency in order:
            if frequency not in states:
                force = np.zeros((2, grid.top + 1), complex)
                force[0, 1] = 0.5 * FORCE * frequency**2
                with suppress(DynamicsNotConverged):
                    states[frequency] = solve_periodic(
                        problem, frequency / TEETH, state, drag_torques={"load": MEAN_FORCE},
                        excitation=force,
                    )  # fmt: skip
            state = states.get(frequency, state)
    return {f: 0.5 * float(np.ptp(waveform(model, state).approach)) for f, state in states.items()}


def _oscillator() -> tuple[LinearSystem, MeshLaw]:
    """The oscillator as a mesh of unit stiffness between a unit inertia and a wheel too heavy to move."""
    pitch = 2.0 * np.pi / TEETH
    law = MeshLaw(
        base_radius_1=1.0, base_radius_2=1.0, base_pitch=pitch, teeth_1=TEETH, teeth_2=TEETH,
        tooth_offset_2=0,
        path_start=0.0, path_step=pitch / 4, stiffness=np.ones((1, 5)), gap=np.ones((1, 5)),
        slice_shift=np.zeros(1), deviation_1=np.zeros((1, 5)), deviation_2=np.zeros((1, 5)),
        scale_1=np.ones(1),
        scale_2=np.ones(1), backlash=0.0, offset=0.0, phase=0.0, back_phase=0.0, damping=0.0,
        mean_stiffness=1.0,
        friction=0.0, rolling_radius_1=1.0, rolling_radius_2=1.0, friction_reversal_speed=1.0,
    )  # fmt: skip
    spring = np.zeros((3, 3))
    spring[0, 0] = spring[2, 2] = SOFT
    spring[0, 2] = spring[2, 0] = -SOFT
    system = LinearSystem(
        inertia=np.diag([1.0, HEAVY, HEAVY]),
        damping=np.diag([2.0 * ZETA, 0.0, 0.0]),
        stiffness=spring,
        dofs=("pinion", "wheel", "drive"),
        mesh_ports=np.array([[0, 1]], dtype=np.int64),
        rigid=line_shapes(np.array([0, 1, 0])),
        drive_dof=2,
        twist_load=np.zeros(3),
        drag_loads={"load": np.array([0.0, -1.0, 0.0])},
    )
    return system, law
