"""Loads that alternate with a shaft in the march of an event: against the harmonic balance and the linear solution."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from dynamics.rotor.assembly import assemble_rig
from dynamics.rotor.bearing_state import RunningState
from dynamics.rotor.craig_bampton import SeenRig, mesh_ports
from dynamics.rotor.graph import assemble, torsional_twist_rows
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.parts import LoadOrder, PeriodicLoad, harmonic_loads, rotating_load
from dynamics.rotor.reduction import reduce_rig
from dynamics.rotor.rotor_model import ShaftUnbalance
from dynamics.rotor.static_loop import LoopLoad
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_force import evaluate_mesh
from dynamics.vibration.event_march import (
    Brake,
    Channel,
    EventMarch,
    Trip,
    Watched,
    bearing_channels,
    steady_start,
    torque_channels,
)
from dynamics.vibration.initial_state import pinion_ratios
from dynamics.vibration.march_inputs import TurningLoads
from dynamics.vibration.response_curve import CurvePoint
from dynamics.vibration.speed_sweep import SweepSettings, periodic_response
from dynamics.vibration.steady_motion import TimeSettings
from tests.builders.elastic_rig import bearings, prototype_rig
from tests.builders.mesh import BASE_RADIUS_1, BASE_RADIUS_2, TEETH, chain, wavy_law
from tests.builders.rig import prototype, prototype_laws

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
SPEED, TORQUE, CUTOFF = 200.0 * math.pi, 180.0, 20e3


def smooth_laws() -> list[MeshLaw]:
    """Without friction, which acts beside the ports."""
    return [law._replace(friction=0.0) for law in prototype_laws()]


def once_a_turn(time: Array, values: Array, speed: float) -> Complex:
    """Amplitudes of the wave at a speed beside a mean, by least squares over about whole turns."""
    waves = np.column_stack([np.ones(time.size), np.cos(speed * time), np.sin(speed * time)])
    fit = np.linalg.lstsq(waves, values.T, rcond=None)[0]
    return np.asarray(fit[1] - 1j * fit[2])


def balanced(system: LinearSystem) -> CurvePoint:
    settings = SweepSettings(period="revolution", cutoff=CUTOFF, methods=("harmonic_balance",))
    curve = periodic_response(system, smooth_laws(), [SPEED], LoopLoad(torque=TORQUE), settings=settings)
    assert not curve.failed
    return curve.points[0]


def motion_once_a_turn(system: LinearSystem, point: CurvePoint) -> Complex:
    """Of all freedoms by the dynamic stiffness, under the mesh forces of a periodic state and the loads of a system."""
    wave, laws = point.wave, smooth_laws()
    load = np.zeros(len(system.inertia), complex)
    for m, (law, ports) in enumerate(zip(laws, system.mesh_ports)):
        reaction = evaluate_mesh(law, wave.angle[m], wave.approach[m], wave.omega_1[m], wave.omega_2[m])
        for port, torque in zip(ports, (reaction.torque_1, reaction.torque_2)):
            load[port] += 2.0 * np.fft.rfft(torque)[1] / torque.size
    lead = float(np.mean(wave.angle[0] - SPEED * (wave.time - wave.time[0])))
    turning = harmonic_loads(system.periodic_loads, pinion_ratios(system, laws), 1.0, SPEED)
    load += turning[1] * np.exp(1j * lead)
    dynamic = system.stiffness - SPEED**2 * system.inertia + 1j * SPEED * system.damping
    return np.asarray(np.linalg.solve(dynamic, load))


def test_unbalance_shakes_the_bearings_before_an_event_as_in_the_harmonic_balance() -> None:
    """Amplitude of the force once a turn, across and upwards, in every bearing: 1e-3 of the largest, the tolerance of
    the steady state that the march starts from."""
    parts = (ShaftUnbalance(shaft="test_pinion", position=0.05, moment=5e-5, angle=0.7),)
    rig = replace(prototype_rig(0.03), rotating=parts)
    model = assemble_rig(rig)
    seen = SeenRig(
        reduced=reduce_rig(model, bearings(rig), CUTOFF),
        ports={"test": mesh_ports(model, "test"), "reference": mesh_ports(model, "reference", "back")},
    )
    state = RunningState(speed=SPEED, bearings=bearings(rig))
    system = seen.system(state)
    start = steady_start(system, smooth_laws(), SPEED, TORQUE, {}, TimeSettings(cutoff=CUTOFF))
    assert start.period == "revolution" and not start.settled and not start.doubts
    sides = [
        replace(channel, angle=channel.angle[k : k + 1], speed=channel.speed[k : k + 1])
        for channel in bearing_channels(seen, system, state)
        if channel.kind == "bearing"
        for k in range(2)
    ]
    march = EventMarch(system, smooth_laws(), start, Watched(tuple(sides)), CUTOFF)
    history = march.run(2.0 * math.pi / SPEED)
    found = np.abs(once_a_turn(history.time, history.values, SPEED))
    motion = motion_once_a_turn(system, balanced(system))
    exact = np.abs([(side.angle + 1j * SPEED * side.speed)[0] @ motion for side in sides])
    # m e w^2 = 5e-5 kg m (628 rad/s)^2 = 19.7 N next to the front bearing
    assert exact.max() == pytest.approx(21.2, rel=0.02)
    assert found == pytest.approx(exact, abs=1e-3 * float(exact.max()))


def test_load_that_turns_with_the_wheel_settles_to_the_linear_response() -> None:
    """A turn of the pinion holds no whole turn of the wheel, 99 to 102 teeth. Through a mesh of constant stiffness the
    system is linear: motion by its dynamic stiffness, 1e-3."""
    system = chain(3, joint=(1e6, 20.0), bearing=0.05)
    row = np.array([0.0, 0.0, 0.0, -1.0, 1.0, 0.3])
    part = LoadOrder(order=1.0, amplitude=20.0 / SPEED**2, phase=0.6, speed_power=2)
    loaded = replace(system, periodic_loads=rotating_load("unbalance", row + 0.5j * row[::-1], 5, part))
    law = wavy_law(0.0, damping=2e3)
    start = steady_start(loaded, [law], SPEED, TORQUE, {})
    assert start.settled == ("unbalance order 1",) and start.settling >= 0.3
    ports = tuple(
        Channel(place=f"{i}", kind="shaft", angle=np.zeros((1, 6)), speed=np.eye(6)[i : i + 1])
        for i in range(6)
    )
    wheel = SPEED * TEETH[0] / TEETH[1]
    history = EventMarch(loaded, [law], start, Watched(ports)).run(20.0 * 2.0 * math.pi / wheel)
    across = np.zeros(6)
    across[system.mesh_ports[0]] = BASE_RADIUS_1, -BASE_RADIUS_2
    stiffness = system.stiffness + 1.1e8 * np.outer(across, across)
    damping = system.damping + 2e3 * np.outer(across, across)
    dynamic = stiffness - wheel**2 * system.inertia + 1j * wheel * damping
    amplitude = 20.0 * (TEETH[0] / TEETH[1]) ** 2 * np.exp(-0.6j)
    speeds = 1j * wheel * np.linalg.solve(dynamic, amplitude * (row + 0.5j * row[::-1]))
    found = once_a_turn(history.time, history.values, wheel)
    assert np.abs(found) == pytest.approx(np.abs(speeds), rel=1e-3)
    assert history.speed.mean() == pytest.approx(SPEED, rel=1e-4)


def test_loads_of_amplitude_zero_change_nothing() -> None:
    """Torques of shafts, couplings and meshes through an emergency stop, to round-off."""
    system, laws = assemble(prototype()), prototype_laws()
    part = LoadOrder(order=1.0, amplitude=0.0)
    load = PeriodicLoad(name="ripple", load=np.eye(len(system.inertia))[0], dof=0, parts=(part,))
    watched = Watched(torque_channels(torsional_twist_rows(prototype())))
    runs = []
    for own in (system, replace(system, periodic_loads=(load,))):
        start = steady_start(own, laws, SPEED, TORQUE, {})
        stop = EventMarch(own, laws, start, watched)
        runs.append(stop.run(2e-3, trip=Trip(channel=None), brake=Brake(torque=20.0)))
    bare, silent = runs
    scale = float(np.abs(bare.values).max())
    assert silent.values == pytest.approx(bare.values, abs=1e-9 * scale)
    assert silent.greatest == pytest.approx(bare.greatest, abs=1e-9 * scale)
    assert silent.before == pytest.approx(bare.before, abs=1e-9 * scale)


def test_turning_loads_are_the_loads_at_the_angles_of_their_lines() -> None:
    """A vibration that moves no momentum of a line is not seen."""
    system = chain(3)
    parts = (
        LoadOrder(order=1.0, amplitude=2e-4, speed_power=2),
        LoadOrder(order=6.0, amplitude=3.0, phase=1.0),
    )
    loads = tuple(
        PeriodicLoad(name=f"{dof}", load=np.eye(6)[dof], dof=dof, parts=parts[:count])
        for dof, count in ((0, 2), (4, 1), (5, 0))
    )
    turning = TurningLoads(replace(system, periodic_loads=loads))
    angles, speeds = np.array([[0.3, 2.0, 1.0], [1.3, 0.2, 0.0]]), np.array([100.0, 90.0, 90.0])
    expected = [load.at(angles[:, i], speeds[i]) for i, load in enumerate(loads)]
    assert turning.values(angles, np.tile(speeds, (2, 1))) == pytest.approx(np.array(expected).T)
    vibration = np.array([1.0, -2.0, 1.0, 0.0, 3.0, -3.0])
    assert turning.speeds(np.repeat([100.0, 90.0], 3) + vibration) == pytest.approx(speeds)
