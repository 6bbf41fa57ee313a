"""Unbalance, bow, run-out and misalignment against closed forms, and their way into the mesh as sidebands."""

import math
from dataclasses import replace

import numpy as np
import pytest

from dynamics.rotor.assembly import ElasticModel, assemble_rig
from dynamics.rotor.bearing_state import RunningState, isotropic_bearing, line_loads, misalignment_load
from dynamics.rotor.craig_bampton import SeenRig, mesh_ports
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.parts import Coupling, JointStiffness, LoadOrder, harmonic_loads, rotating_load
from dynamics.rotor.reduction import reduce_rig
from dynamics.rotor.rotor_model import (
    AxisMisalignment,
    ElasticRig,
    FlangeRunOut,
    RotatingPart,
    ShaftBow,
    ShaftPlacement,
    ShaftUnbalance,
)
from dynamics.rotor.shaft import STEEL_SHEAR_MODULUS, Disc, Section
from dynamics.rotor.static_loop import LoopLoad, line_ratios
from dynamics.vibration.speed_sweep import SweepSettings, periodic_response
from tests.builders.elastic_rig import bearings, prototype_rig, single_shaft
from tests.builders.full_matrices import full_matrices
from tests.builders.mesh import BASE_RADIUS_1, TEETH, chain, wavy_law
from tests.builders.rig import prototype_laws
from tests.builders.static_deflection import static_deflection

LENGTH, DIAMETER, MASS = 0.4, 0.02, 8.0
MODULUS = 2.0 * STEEL_SHEAR_MODULUS * 1.3
BENDING = 48.0 * MODULUS * math.pi / 64.0 * DIAMETER**4 / LENGTH**3
DAMPING = 120.0
STATE = {
    "b0": isotropic_bearing(1e11),
    "b1": isotropic_bearing(0.0, DAMPING),
    "b2": isotropic_bearing(1e11),
}


def load_at_speed(model: ElasticModel, line: str, speed: float) -> np.ndarray:
    """Load (n,) of a shaft line at the speed [rad/s] of the reference shaft."""
    own = abs(model.spins[line]) * speed
    return sum(own**power * load for (name, power), load in line_loads(model).items() if name == line)


def jeffcott(*parts: RotatingPart, sense: int = 1, elements: int = 4) -> ElasticModel:
    """Disc of 8 kg in the middle of a light shaft on stiff bearings, a damper at the disc."""
    rig = single_shaft(
        (Section(length=LENGTH, outer_diameter=DIAMETER),),
        (0.0, 0.5 * LENGTH, LENGTH),
        LENGTH / elements,
        discs=(Disc(name="disc", position=0.5 * LENGTH, inertia=0.02, mass=MASS),),
        density=1e-3,
    )
    placements = (replace(rig.placements[0], sense=sense),)
    return assemble_rig(replace(rig, shear="rigid", placements=placements, rotating=parts))


def at_disc(model: ElasticModel, speed: float) -> np.ndarray:
    """Complex (u_y, u_z) of the disc at a speed."""
    load = load_at_speed(model, "rotor", speed)
    whole = full_matrices(model, RunningState(speed=speed, bearings=STATE)).response(load[:, None], speed)
    return np.asarray(model.rows("rotor/disc")[1:3] @ whole[:, 0])


def amplitude(speed: float, force: complex) -> complex:
    return force / (BENDING - MASS * speed**2 + 1j * speed * DAMPING)


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("share", [0.3, 0.9, 1.0, 1.1, 2.5])
def test_jeffcott_through_resonance(sense: int, share: float) -> None:
    """u = U Omega^2 / (k - m Omega^2 + i c Omega); bearings 1e3 times as stiff as the shaft at resonance, amplification
    60: 2e-4."""
    moment, angle = 3e-4, 0.4
    speed = share * math.sqrt(BENDING / MASS)
    unbalance = ShaftUnbalance(shaft="rotor", position=0.5 * LENGTH, moment=moment, angle=angle)
    exact = amplitude(speed, moment * speed**2 * np.exp(1j * angle))
    found = at_disc(jeffcott(unbalance, sense=sense), speed)
    assert found == pytest.approx([exact, -1j * sense * exact], rel=3e-4)


def test_residual_bow_and_unbalance_cancel_at_the_critical_speed() -> None:
    """Nicholas, Gunter and Allaire 1976: u = k (b + e r^2) / (k - m Omega^2 + i c Omega), r = Omega over critical. An
    unbalance opposite to the bow with e = b leaves the shaft without whirl at r = 1. Half sine against the nodal
    deflection of 32 elements: 1e-3."""
    bow = ShaftBow(shaft="rotor", supports=(0.0, LENGTH), amplitude=50e-6, angle=0.3)
    for share in (0.2, 0.8, 1.5):
        speed = share * math.sqrt(BENDING / MASS)
        found = at_disc(jeffcott(bow, elements=32), speed)[0]
        assert found == pytest.approx(amplitude(speed, BENDING * 50e-6 * np.exp(0.3j)), rel=1e-3)
    opposite = ShaftUnbalance(shaft="rotor", position=0.5 * LENGTH, moment=MASS * 50e-6, angle=0.3 + math.pi)
    speed = math.sqrt(BENDING / MASS)
    alone = abs(at_disc(jeffcott(bow, elements=32), speed)[0])
    assert abs(at_disc(jeffcott(bow, opposite, elements=32), speed)[0]) < 2e-3 * alone


def test_bow_at_a_place_has_that_amplitude_there() -> None:
    bow = ShaftBow(shaft="rotor", supports=(0.1, 0.3), amplitude=20e-6, position=0.15)
    assert bow.amplitude / bow.height * bow.shape(0.15)[0] == pytest.approx(20e-6)
    beyond = bow.shape(0.35)[0] - bow.shape(0.3)[0]
    assert beyond == pytest.approx(0.05 * bow.shape(0.3)[1])


def test_thermal_bow_is_a_parabola_between_the_bearings() -> None:
    """alpha dT / d over the span: sag alpha dT L^2 / 8 d at low speed, exact in every beam element."""
    gradient = 11.5e-6 * 20.0
    bow = ShaftBow(shaft="rotor", supports=(0.0, LENGTH), gradient=gradient, gradient_angle=1.1)
    found = at_disc(jeffcott(bow), 1.0)[0]
    assert found == pytest.approx(-gradient / DIAMETER * LENGTH**2 / 8.0 * np.exp(1.1j), rel=1e-3)


def coupled(**more: object) -> ElasticRig:
    """Two stiff shafts of 0.2 m on two bearings each, a coupling that resists offset and angle."""
    tube = (Section(length=0.2, outer_diameter=0.2),)
    one = single_shaft(tube, (0.05, 0.15), 0.05)
    first = one.drivetrain.shafts[0]
    second = replace(first, name="second")
    places = [replace(b, name=f"second {b.name}", shaft="second") for b in one.drivetrain.bearings]
    drivetrain = replace(
        one.drivetrain,
        shafts=(first, second),
        bearings=(*one.drivetrain.bearings, *places),
        couplings=(
            Coupling(
                name="disc", shafts=("rotor", "second"), stiffness=1e5,
                flexibility=JointStiffness(axial=1e6, lateral=1e4, angular=1e3),
            ),
        ),
    )  # fmt: skip
    placements = (*one.placements, ShaftPlacement(shaft="second", y=0.0, z=0.0, sense=1, start=0.25))
    return replace(one, drivetrain=drivetrain, placements=placements, **more)  # type: ignore[arg-type]


def test_axes_out_of_line_press_on_both_shafts() -> None:
    """Force K o, moment K_a slope at the coupling, opposite on both; the shafts as good as rigid, their bearings 1e5
    times as stiff as the coupling: reactions to 1 %. The lever from the middle of the coupling, 25 mm beyond each end.
    """
    rig = coupled()
    model = assemble_rig(rig)
    state = RunningState(bearings=bearings(rig, 1e9))
    offset, slope = 0.2e-3, 1e-3
    load = misalignment_load(
        model, (AxisMisalignment(coupling="disc", offset=(0.0, offset), slope=(0.0, slope)),)
    )
    bent = static_deflection(model, state, load).deflection
    reactions = {name: 1e9 * float(port[1] @ bent) for name, port in model.ports.items()}
    force, moment = -1e4 * offset, -1e3 * slope
    # first shaft: force at 0.225 m, moment slope = du_z/dx there; bearings at 0.05 and 0.15 m
    rear = (force * (0.225 - 0.05) + moment) / 0.1
    assert reactions["b1"] == pytest.approx(rear, rel=0.01)
    assert reactions["b0"] == pytest.approx(force - rear, rel=0.01)
    # second shaft, starts at 0.25 m: the opposite at -0.025 m of its own
    rear = (-force * (-0.025 - 0.05) - moment) / 0.1
    assert reactions["second b1"] == pytest.approx(rear, rel=0.01)
    assert reactions["second b0"] == pytest.approx(-force - rear, rel=0.01)


def test_run_out_of_flanges_turns_what_misalignment_presses() -> None:
    """At 0 and at a right angle of the shaft the load is that of an offset across and upwards."""
    rig = coupled(
        rotating=(FlangeRunOut(coupling="disc", offset=30e-6, offset_angle=0.0, tilt=2e-4, tilt_angle=0.0),)
    )
    model = assemble_rig(rig)
    load = load_at_speed(model, "rotor", 100.0)
    across = misalignment_load(
        model, (AxisMisalignment(coupling="disc", offset=(30e-6, 0.0), slope=(2e-4, 0.0)),)
    )
    upwards = misalignment_load(
        model, (AxisMisalignment(coupling="disc", offset=(0.0, 30e-6), slope=(0.0, 2e-4)),)
    )
    assert load.real == pytest.approx(across, abs=1e-9 * np.abs(across).max())
    assert (load * 1j).real == pytest.approx(upwards, abs=1e-9 * np.abs(across).max())


def mesh_orders(
    system: LinearSystem, speed: float, depth: float, load: np.ndarray, damping: float
) -> dict[int, complex]:
    """Mesh force of a linear system with a mesh of stiffness k (1 + depth cos(z theta)) under a load once a turn, by
    shaft order, to the first power of ``depth``; mean torque 180 N m.

    Once a turn F_1 = K_1 g / (1 + K_1 h_1), K_1 = k + i c Omega, h the receptance of the approach and g the approach
    under the load without the mesh. The wave of the stiffness turns the approach X into k depth X / 2 at z - 1 and z +
    1, and the swing Theta of the pinion, which passes it sooner and later, into i z k depth x_0 Theta / 2; what the
    mesh carries of both is 1 / (1 + K h) at these orders.
    """
    z, k = TEETH[0], 1.1e8
    across = np.zeros(len(system.inertia))
    across[system.mesh_ports[0]] = BASE_RADIUS_1, -BASE_RADIUS_1 * TEETH[1] / TEETH[0]

    def answer(order: int, acting: np.ndarray) -> np.ndarray:
        omega = order * speed
        dynamic = system.stiffness - omega**2 * system.inertia + 1j * omega * system.damping
        return np.asarray(np.linalg.solve(dynamic, acting))

    def carried(order: int) -> complex:
        stiff = k + 1j * damping * order * speed
        return 1.0 / (1.0 + stiff * (across @ answer(order, across)))

    stiff = k + 1j * damping * speed
    felt = stiff * (across @ answer(1, load)) * carried(1)
    motion = answer(1, load - felt * across)
    approach, swing = across @ motion, motion[system.mesh_ports[0, 0]]
    mean = 180.0 / BASE_RADIUS_1 / k
    above = 0.5 * k * depth * (approach + 1j * z * mean * swing)
    below = 0.5 * k * depth * (np.conj(approach) + 1j * z * mean * np.conj(swing))
    return {1: felt, z + 1: above * carried(z + 1), z - 1: below * carried(z - 1)}


@pytest.mark.parametrize("method", ["harmonic_balance", "time_integration"])
def test_sidebands_of_a_load_once_a_turn_in_closed_form(method: str) -> None:
    """A load that grows with the square of the speed in two rows, through a mesh whose stiffness waves by 2 %: once a
    turn and the sidebands. Terms of second order in the wave are a hundredth; both methods are within 1 %."""
    speed, depth, damping = 300.0, 0.02, 2e3
    amplitude, phase = 400.0, 0.6
    system = chain(3, joint=(1e6, 20.0), bearing=0.05)
    turning = np.array([-1.0, 1.0, 0.0, 0.0, 0.0, 0.0]) - 0.5j * np.array([0.0, 0.0, 0.0, 0.0, -1.0, 1.0])
    part = LoadOrder(order=1.0, amplitude=amplitude / speed**2, phase=phase, speed_power=2)
    loaded = replace(system, periodic_loads=rotating_load("rotor", turning, 2, part))
    settings = SweepSettings(period="revolution", methods=(method,))  # type: ignore[arg-type]
    curve = periodic_response(
        loaded, [wavy_law(depth, damping=damping)], [speed], LoopLoad(torque=180.0), settings=settings
    )
    (point,) = curve.points
    torque = point.wave.torque[0]
    spectrum = 2.0 * np.fft.rfft(torque) / torque.size
    exact = mesh_orders(system, speed, depth, amplitude * np.exp(-1j * phase) * turning, damping)
    for order, force in exact.items():
        assert abs(spectrum[order]) == pytest.approx(BASE_RADIUS_1 * abs(force), rel=0.01), order
    assert abs(spectrum[TEETH[0] + 2]) < 0.05 * abs(spectrum[TEETH[0] + 1])


def test_loads_of_the_seen_rig_are_those_of_all_freedoms() -> None:
    """Unbalance, bow and run-out of the prototype move its mesh ports once a turn as the full matrices say; modes up to
    20 kHz, a hundred times the frequency: 1e-4 of the largest."""
    parts: tuple[RotatingPart, ...] = (
        ShaftUnbalance(shaft="test_pinion", position=0.05, moment=5e-5, angle=0.7),
        ShaftBow(shaft="test_pinion", supports=(0.06758, 0.30778), amplitude=10e-6, angle=-0.4),
        FlangeRunOut(coupling="pinion side", offset=10e-6),
    )
    rig = replace(prototype_rig(0.03), rotating=parts)
    model = assemble_rig(rig)
    seen = SeenRig(
        reduced=reduce_rig(model, bearings(rig), 20e3),
        ports={mesh.name: mesh_ports(model, mesh.name) for mesh in rig.drivetrain.meshes},
    )
    speed = 1200.0
    state = RunningState(speed=speed, bearings=bearings(rig))
    system = seen.system(state)
    own = abs(model.spins["test_pinion"]) * speed
    ratios = line_ratios(system, prototype_laws()) / 1.0
    ratios = ratios / ratios[system.drive_dof]
    assert {load.name.split(" of ")[1] for load in system.periodic_loads} == {"test_pinion"}
    turns = speed / own
    (load,) = harmonic_loads(system.periodic_loads, ratios, turns, speed).values()
    found = np.linalg.solve(system.stiffness - own**2 * system.inertia + 1j * own * system.damping, load)[
        system.mesh_ports.ravel()
    ]
    whole = full_matrices(model, state).response(load_at_speed(model, "test_pinion", speed)[:, None], own)
    exact = np.vstack(list(seen.ports.values())) @ whole[:, 0]
    assert found == pytest.approx(exact, abs=1e-4 * float(np.abs(exact).max()))
