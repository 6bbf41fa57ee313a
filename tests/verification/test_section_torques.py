"""Torque in shafts and joints from the mesh forces: against the dynamic stiffness of all freedoms and Newton's law."""

from dataclasses import replace

import numpy as np
import pytest

from dynamics.rotor.assembly import assemble_rig
from dynamics.rotor.craig_bampton import SeenRig, elastic_twist_rows, mesh_ports
from dynamics.rotor.graph import assemble, torsional_twist_rows
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.parts import LoadOrder, PeriodicLoad
from dynamics.rotor.reduction import reduce_rig
from dynamics.rotor.static_loop import LoopLoad
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_force import evaluate_mesh
from dynamics.vibration.response_curve import CurvePoint, section_torques
from dynamics.vibration.speed_sweep import periodic_response
from dynamics.vibration.steady_motion import Motion
from tests.builders.elastic_rig import bearings, prototype_rig, running
from tests.builders.full_matrices import full_matrices
from tests.builders.rig import BASE_RADIUS_REFERENCE, BASE_RADIUS_TEST, prototype, synthetic_law

SPEED, TORQUE = 240.0, 180.0


def laws() -> tuple[MeshLaw, MeshLaw]:
    test = synthetic_law(BASE_RADIUS_TEST, stiffness=1.1e8, contact_ratio=1.3)
    reference = synthetic_law(BASE_RADIUS_REFERENCE, stiffness=6e8, contact_ratio=2.4)
    return test, reference


def respond(system: LinearSystem) -> CurvePoint:
    curve = periodic_response(system, laws(), [SPEED], LoopLoad(torque=TORQUE))
    assert not curve.failed
    return curve.points[0]


def mesh_loads(point: CurvePoint) -> np.ndarray:
    """Torque on the bodies of both meshes, pinion first (4, count)."""
    wave = point.wave
    found = []
    for m, law in enumerate(laws()):
        reaction = evaluate_mesh(law, wave.angle[m], wave.approach[m], wave.omega_1[m], wave.omega_2[m])
        found += [reaction.torque_1, reaction.torque_2]
    return np.array(found)


def harmonic(values: np.ndarray, number: int) -> np.ndarray:
    return np.asarray(np.fft.rfft(values, axis=-1)[..., number] / values.shape[-1])


def base_frequency(point: CurvePoint) -> float:
    time = point.wave.time
    return float(2.0 * np.pi / (time.size * (time[1] - time[0])))


@pytest.fixture(scope="module")
def torsional() -> tuple[LinearSystem, CurvePoint, np.ndarray]:
    system = assemble(prototype())
    point = respond(system)
    loop = section_torques(system, laws(), torsional_twist_rows(prototype()))
    return system, point, loop.over_period(point)


@pytest.mark.parametrize("number", [1, 2, 5])
def test_torques_are_those_of_the_dynamic_stiffness(
    torsional: tuple[LinearSystem, CurvePoint, np.ndarray], number: int
) -> None:
    system, point, torque = torsional
    omega = number * base_frequency(point)
    load = np.zeros(len(system.inertia), complex)
    np.add.at(load, system.mesh_ports.ravel(), harmonic(mesh_loads(point), number))
    dynamic = system.stiffness + 1j * omega * system.damping - omega**2 * system.inertia
    motion = np.linalg.solve(dynamic, load)
    rows = torsional_twist_rows(prototype())
    expected = (rows.stiffness + 1j * omega * rows.damping) * (rows.rows @ motion)
    # both are exact; the modal form loses digits with dampers far above their corner frequency
    assert harmonic(torque, number) == pytest.approx(expected, abs=1e-7 * np.abs(expected).max())


def test_a_gear_body_is_accelerated_by_mesh_less_seat(
    torsional: tuple[LinearSystem, CurvePoint, np.ndarray],
) -> None:
    """Newton's law at the test pinion, its acceleration from its speed in the wave."""
    _, point, torque = torsional
    rows = torsional_twist_rows(prototype())
    seat = next(i for i, s in enumerate(rows.sections) if s.kind == "spline" and s.part == "test_pinion_gear")
    inertia = prototype().gear("test_pinion_gear").inertia
    acting = mesh_loads(point)[0] - torque[seat]
    for number in (1, 2, 3):
        acceleration = 1j * number * base_frequency(point) * harmonic(point.wave.omega_1[0], number)
        # the harmonic balance leaves 1e-5 of the mean approach
        assert harmonic(acting, number) == pytest.approx(inertia * acceleration, abs=1e-4 * TORQUE)


def test_means_are_those_of_the_meshes_and_the_motor(
    torsional: tuple[LinearSystem, CurvePoint, np.ndarray],
) -> None:
    _, point, torque = torsional
    rows = torsional_twist_rows(prototype())
    mean = {(s.kind, s.part): t.mean() for s, t in zip(rows.sections, torque)}
    for gear, load in zip(
        ("test_pinion_gear", "test_wheel_gear", "reference_pinion_gear", "reference_wheel_gear"),
        mesh_loads(point).mean(axis=1),
    ):
        assert mean["spline", gear] == pytest.approx(load, abs=1e-3)
    last = [i for i, s in enumerate(rows.sections) if s.part == "reference_wheel"][-1]
    assert torque[last].mean() == pytest.approx(-point.drive_torque, abs=1e-3)
    assert abs(mean["coupling", "pinion side"]) == pytest.approx(
        abs(mean["spline", "test_pinion_gear"]), abs=1e-3
    )


@pytest.mark.parametrize(
    "motion", [Motion(kind="subharmonic", periods=3), Motion(kind="quasi-periodic", periods=0)]
)
def test_loads_that_the_response_left_out_stay_out_of_a_longer_motion(
    torsional: tuple[LinearSystem, CurvePoint, np.ndarray], motion: Motion
) -> None:
    """Three mesh periods hold one wave of an order 33 of 99 teeth, of which a response over one mesh knows nothing; one
    of order 198 it knows. The same motion shown three times has three times the same torques."""
    system, point, _ = torsional
    gear = int(system.mesh_ports[0, 0])
    load = np.eye(len(system.inertia))[gear]
    orders = LoadOrder(order=33.0, amplitude=500.0), LoadOrder(order=198.0, amplitude=5.0)
    wave = point.wave
    count, step = wave.time.size, float(wave.time[1] - wave.time[0])
    time = step * np.arange(3 * count, dtype=np.float64)
    spread = {name: np.tile(getattr(wave, name), 3) for name in ("approach", "omega_1", "omega_2", "torque")}
    turned = np.array([law.teeth_1 for law in laws()])[:, None]
    angle = np.hstack([wave.angle + 2.0 * np.pi * period / turned for period in range(3)])
    shown = replace(point, wave=replace(wave, time=time, angle=angle, **spread), motion=motion)
    rows = torsional_twist_rows(prototype())

    def torques(at: CurvePoint, *parts: LoadOrder) -> np.ndarray:
        loads = (PeriodicLoad(name="ripple", load=load, dof=gear, parts=parts),) if parts else ()
        return section_torques(replace(system, periodic_loads=loads), laws(), rows).over_period(at)

    once = torques(point, *orders)
    assert np.abs(once - torques(point)).max() > 0.1
    assert torques(shown, *orders) == pytest.approx(np.tile(once, 3), abs=1e-6 * TORQUE)


def test_elastic_rig_has_the_torques_of_its_full_matrices() -> None:
    rig = prototype_rig(element_length=0.03)
    model = assemble_rig(rig)
    state = running(rig, 250.0)
    ports = {mesh: mesh_ports(model, mesh) for mesh in ("test", "reference")}
    seen = SeenRig(
        reduced=reduce_rig(model, bearings(rig)), ports=ports
    )  # all modes: a change of coordinates
    system = seen.system(state)
    point = respond(system)
    rows = elastic_twist_rows(seen)
    torque = section_torques(system, laws(), rows).over_period(point)
    full = full_matrices(model, state)
    for number in (1, 2):
        omega = number * base_frequency(point)
        load = np.vstack(list(ports.values())).T @ harmonic(mesh_loads(point), number)
        motion = full.response(load[:, None], omega)[:, 0]
        for i, section in enumerate(rows.sections):
            if section.kind == "coupling":
                joint = model.joint(section.part, "coupling")
                expected = (rows.stiffness[i] + 1j * omega * rows.damping[i]) * (joint.row("turn") @ motion)
                # the dense eigenvectors of 400 states lose some digits
                assert harmonic(torque[i], number) == pytest.approx(expected, abs=1e-5 * TORQUE)
