"""The reduced rig as a linear system: the same motion, seen at meshes, drive and couplings."""

from functools import cache

import numpy as np
import pytest

from dynamics.rotor.assembly import assemble_rig
from dynamics.rotor.bearing_state import BearingCoefficients, RunningState
from dynamics.rotor.bracing import LoopBracing, brace
from dynamics.rotor.craig_bampton import Face, SeenRig, approach_row, mesh_ports
from dynamics.rotor.damped_modes import elastic_loop_modes
from dynamics.rotor.graph import assemble
from dynamics.rotor.reduction import reduce_rig
from dynamics.rotor.static_loop import LoopLoad, line_ratios
from dynamics.vibration.initial_state import wound_state
from dynamics.vibration.march_inputs import MarchSettings, march_model
from dynamics.vibration.speed_sweep import SweepSettings, periodic_response
from dynamics.vibration.time_integration import TimeMarch
from tests.builders.elastic_rig import bearings, prototype_rig
from tests.builders.rig import prototype_laws

SPEED = 1200.0
FILM = BearingCoefficients(
    stiffness=np.array([[1.0e8, 0.8e8], [-1.5e8, 1.2e8]]), damping=np.array([[2e5, -3e4], [-3e4, 3e5]])
)


@cache
def seen(cutoff: float | None = 20e3) -> SeenRig:
    """The prototype, its ports on the flanks that carry under positive torque of the loop."""
    rig = prototype_rig(0.03)
    model = assemble_rig(rig)
    faces: dict[str, Face] = {"test": "front", "reference": "back"}
    return SeenRig(
        reduced=reduce_rig(model, bearings(rig), cutoff),
        ports={mesh.name: mesh_ports(model, mesh.name, faces[mesh.name]) for mesh in rig.drivetrain.meshes},
    )


def films(speed: float = SPEED, scale: float = 1.0) -> RunningState:
    places = seen().reduced.model.rig.drivetrain.bearings
    film = BearingCoefficients(stiffness=scale * FILM.stiffness, damping=FILM.damping)
    return RunningState(speed=speed, bearings={place.name: film for place in places})


def test_receptance_of_the_ports_is_that_of_the_whole_rig() -> None:
    """Gyroscopic moments and films in; against the direct solution of the full matrices in reduced coordinates."""
    system = seen().system(films())
    at = seen().reduced.matrices(films())
    rows = seen().reduced.rows(np.vstack(list(seen().ports.values())))
    ports = system.mesh_ports.ravel()
    for omega in (300.0, 5e3, 6e4):
        direct = rows @ np.linalg.solve(
            -(omega**2) * at.mass + 1j * omega * at.damping + at.stiffness, rows.T
        )
        found = system.form.receptance(np.array([omega]), ports)[0]
        assert np.abs(found - direct).max() < 1e-7 * np.abs(direct).max()


def test_freedoms_stay_the_same_from_state_to_state_and_turn_with_the_drive() -> None:
    slow, fast = seen().system(films(100.0)), seen().system(films(2000.0))
    assert slow.dofs == fast.dofs and np.array_equal(slow.mesh_ports, fast.mesh_ports)
    assert np.abs(slow.damping - fast.damping).max() > 0.0
    laws = prototype_laws()
    ratios = line_ratios(fast, laws)
    torsional = assemble(prototype_rig().drivetrain)
    expected = line_ratios(torsional, laws)[torsional.mesh_ports]
    assert ratios[fast.mesh_ports] == pytest.approx(expected, rel=1e-10)
    assert ratios[fast.drive_dof] == pytest.approx(1.0)
    # uniform rotation needs no force, and every drag of a line brakes it with all of its torque
    assert np.abs(fast.stiffness @ ratios).max() < 1e-9 * np.abs(fast.stiffness).max()
    for name, load in fast.drag_loads.items():
        turning = abs(float(load @ ratios))
        assert (
            min(
                abs(turning - 1.0),
                abs(turning - expected.ravel().max()),
                abs(turning - expected.ravel().min()),
            )
            < 1e-9
        ), name


def test_approach_of_the_ports_is_that_of_the_flanks() -> None:
    rig = seen()
    system, model = rig.system(films()), rig.reduced.model
    motion = np.random.default_rng(1).normal(size=rig.reduced.size)
    freedoms = system.coordinates.freedoms @ motion
    for mesh, (pinion, wheel) in zip(rig.reduced.model.rig.drivetrain.meshes, system.mesh_ports):
        first, second = mesh.base_radii
        approach = first * freedoms[pinion] - second * freedoms[wheel]
        face, side = ("front", 1.0) if mesh.name == "test" else ("back", -1.0)
        row = side * approach_row(model, mesh.name, face)  # type: ignore[arg-type]
        assert approach == pytest.approx(float(rig.reduced.rows(row) @ motion))


def test_the_loop_is_softer_by_bending_and_bearings() -> None:
    """An independent code found 24.8 and 16.3 kN m/rad for 1e8 N/m at every bearing."""
    laws = prototype_laws()
    state = RunningState(bearings=bearings(prototype_rig(0.03)))
    elastic, torsional = (
        brace(system, laws, 180.0, LoopBracing(mode="torque_controlled"))
        for system in (seen().system(state), assemble(prototype_rig(0.03).drivetrain))
    )
    assert torsional.loop_stiffness == pytest.approx(24.8e3, rel=0.06)
    assert elastic.loop_stiffness == pytest.approx(16.3e3, rel=0.06)


def test_the_drive_pays_for_what_the_teeth_lose_on_films() -> None:
    """Films are no symmetric springs; nothing but the friction of the teeth takes power from the turning loop."""
    laws = prototype_laws()
    system = seen().system(films())
    curve = periodic_response(
        system, laws, [SPEED], LoopLoad(torque=180.0), settings=SweepSettings(methods=("harmonic_balance",))
    )
    (point,) = curve.points
    lost = float(point.friction_power.sum() + point.damping_power.sum())
    ratios = line_ratios(system, laws)
    drive = SPEED / float(ratios[system.mesh_ports[0, 0]])
    assert point.drive_torque * drive == pytest.approx(lost, rel=0.02)


def test_a_film_under_next_to_no_load_has_modes() -> None:
    """The stiffness of an unloaded film is skew: it holds nothing by itself, its damping does."""
    skew = BearingCoefficients(
        stiffness=np.array([[-1e5, 5e7], [-5e7, -1e5]]), damping=np.array([[8e4, 0.0], [0.0, 8e4]])
    )
    places = seen().reduced.model.rig.drivetrain.bearings
    state = RunningState(speed=SPEED, bearings={place.name: skew for place in places})
    system, at = seen().system(state), seen().reduced.matrices(state)
    rows = seen().reduced.rows(np.vstack(list(seen().ports.values())))
    direct = rows @ np.linalg.solve(-(2e3**2) * at.mass + 2e3j * at.damping + at.stiffness, rows.T)
    found = system.form.receptance(np.array([2e3]), system.mesh_ports.ravel())[0]
    assert np.abs(found - direct).max() < 1e-7 * np.abs(direct).max()
    assert np.isfinite(march_model(system, prototype_laws()).through).all()


def test_a_march_goes_on_as_it_was_with_the_same_matrices() -> None:
    system, laws = seen().system(films()), prototype_laws()
    wound = wound_state(system, laws, SPEED, LoopLoad(torque=180.0))
    given = np.zeros((40, 4))
    given[:, 0], given[:, 1] = 5.0, wound.state.twist
    offsets = np.full((40, 2), 3e-6)
    forces = []
    for change in (False, True):
        march = TimeMarch(system, laws, wound.state, MarchSettings(step=1 / 320e3, substeps=8))
        march.advance(given, offsets=offsets)
        if change:
            march = march.continued(system, march.model)
        forces.append(march.advance(given, offsets=offsets).force)
    assert np.abs(forces[1] - forces[0]).max() < 1e-4 * np.abs(forces[0]).max()


def test_a_march_keeps_both_lines_in_their_groups() -> None:
    model = march_model(seen().system(films()), prototype_laws(), ("test_pinion front", "test_wheel front"))
    assert np.all(np.diff(model.branches) >= 0)
    assert set(model.port_branches) <= set(model.branches)
    assert np.isfinite(model.through).all()


def test_modes_are_named_by_the_parts_that_store_their_energy() -> None:
    modes = elastic_loop_modes(seen(), films(), prototype_laws(), 3000.0)
    assert [mode.frequency for mode in modes].count(0.0) == 1
    moving = [mode for mode in modes if mode.frequency > 0.0]
    assert all(sum(mode.energy.values()) == pytest.approx(1.0) for mode in moving)
    assert any(name.startswith("bearing ") for mode in moving for name in mode.energy)
    bending = [mode for mode in moving if next(iter(mode.energy)).endswith("bending")]
    assert bending and all(mode.name.startswith(next(iter(mode.energy))) for mode in bending)
