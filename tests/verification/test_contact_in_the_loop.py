"""March with the tooth contact in the loop: the contact is that of the quasi-static solver, its forces have a
potential, the linear part is exact, and no energy comes or goes."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import scipy.linalg
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.rotor.assembly import assemble_rig
from dynamics.rotor.craig_bampton import SeenRig, mesh_ports, wrench_rows
from dynamics.rotor.reduction import reduce_rig
from dynamics.rotor.static_loop import LoopLoad
from dynamics.tooth.law import in_parallel
from dynamics.tooth.loaded_mesh import LoadedMesh
from dynamics.tooth.points import FaceGrid
from dynamics.vibration.initial_state import wound_state
from tests.builders.elastic_rig import bearings, prototype_rig, running
from tests.builders.loaded_mesh import fzg_c, influence_of
from tests.builders.p2_gears import helical_pair, spur_pair
from tests.builders.rig import prototype_laws
from tests.contact_in_loop.integration import FlankMotion, PhaseTable, Pressed, contact_work, press_phase
from tests.contact_in_loop.loop import ContactLoop, MeshInLoop
from tests.contact_in_loop.modes import ModesOverStep
from tests.contact_in_loop.phase_tables import phase_table
from tests.contact_in_loop.response import LoopedProblem, LoopedResponse, looped_response

Array = NDArray[np.float64]
RPM = np.pi / 30.0
FORCE = 5000.0


@cache
def mesh() -> LoadedMesh:
    pair = fzg_c()
    gears = influence_of(pair, 0), influence_of(pair, 1)
    return LoadedMesh(pair=pair, gears=gears, grid=FaceGrid.over(pair.face_width, 11), n_positions=16)


@cache
def table() -> PhaseTable:
    return phase_table(mesh(), FORCE, 60e-6)


def pressed(path: float, approach: float, tilt: float = 0.0) -> Pressed:
    held = table()
    none = np.zeros(held.gap.shape[2])
    return press_phase(held, FlankMotion(path, approach, tilt, 1.0, 1.0), none, 1e-3, contact_work(held))


def test_forces_are_those_of_the_quasi_static_contact() -> None:
    """Every position of the cycle is a place of the table: no interpolation; tangent stiffness with it."""
    cycle = mesh().cycle(FORCE)
    for path, approach, tangent in zip(
        cycle.points.position, cycle.approach, cycle.tangent_stiffness, strict=True
    ):
        found = pressed(path, approach)
        assert found.ended
        assert found.force == pytest.approx(FORCE, rel=1e-6)
        assert found.stiffness == pytest.approx(tangent, rel=1e-5)


def test_places_between_those_of_the_table_are_those_of_a_finer_one() -> None:
    fine = phase_table(mesh(), FORCE, 60e-6, 192)
    none, work = np.zeros(fine.gap.shape[2]), contact_work(fine)
    for share in np.linspace(0.0, 3.0, 60):
        path = table().start + share * table().pitch
        found = press_phase(fine, FlankMotion(path, 20e-6, 1e-4, 1.0, 1.0), none, 1e-3, work)
        assert pressed(path, 20e-6, 1e-4).force == pytest.approx(found.force, rel=2e-3)


@pytest.mark.parametrize(
    ("share", "approach", "tilt"), [(0.33, 25e-6, 2e-4), (0.8, 12e-6, -4e-4), (0.05, 40e-6, 1e-3)]
)
def test_force_moment_and_path_force_come_from_one_potential(
    share: float, approach: float, tilt: float
) -> None:
    path = table().start + share * table().pitch
    found, at = pressed(path, approach, tilt), (path, approach, tilt)
    for place, step, value in ((1, 1e-9, found.force), (2, 1e-7, found.moment), (0, 1e-8, found.per_path)):
        there, back = list(at), list(at)
        there[place] += step
        back[place] -= step
        slope = (pressed(*there).energy - pressed(*back).energy) / (2.0 * step)
        assert value == pytest.approx(slope, rel=1e-5, abs=1e-5 * abs(found.force))


@cache
def seen() -> SeenRig:
    rig = prototype_rig(0.03)
    model = assemble_rig(rig)
    return SeenRig(
        reduced=reduce_rig(model, bearings(rig), 20e3),
        ports={one.name: mesh_ports(model, one.name) for one in rig.drivetrain.meshes},
    )


SPEED = 3000.0 * RPM


@cache
def loaded_meshes(*, lossless: bool) -> tuple[MeshInLoop, ...]:
    laws = [law._replace(damping=0.0, friction=0.0) if lossless else law for law in prototype_laws()]
    meshes: list[MeshInLoop] = []
    for law, pair in zip(laws, (spur_pair(), helical_pair()), strict=True):
        contact = LoadedMesh(
            pair=pair,
            gears=(influence_of(pair, 0), influence_of(pair, 1)),
            grid=FaceGrid.over(pair.face_width, 11),
        )
        meshes.append(
            MeshInLoop(
                contact=contact, law=law, force=180.0 / law.base_radius_1 * (1.0 if not meshes else -1.0)
            )
        )
    return tuple(meshes)


def loop_rows() -> Array:
    model = seen().reduced.model
    return seen().on_freedoms(np.vstack([wrench_rows(model, name) for name in seen().ports]))


def looped(step: float, *, lossless: bool, halves: int = 1) -> ContactLoop:
    """The prototype on Table 1's bearings; both meshes with the contact in the loop.

    halves : that each carry 180 N m
    """
    system = seen().system(running(seen().reduced.model.rig, SPEED))
    meshes = [
        replace(mesh, law=in_parallel(mesh.law, halves), force=halves * mesh.force, halves=halves)
        for mesh in loaded_meshes(lossless=lossless)
    ]
    wound = wound_state(system, [mesh.law for mesh in meshes], SPEED, LoopLoad(torque=halves * 180.0))
    return ContactLoop(system, loop_rows(), meshes, wound, step=step, cutoff=20e3)


def problem(speed: float = SPEED) -> LoopedProblem:
    """The same in steady rotation; the motor torque starts without the friction of the teeth."""
    system, meshes = seen().system(running(seen().reduced.model.rig, SPEED)), loaded_meshes(lossless=False)
    wound = wound_state(system, [mesh.law for mesh in meshes], SPEED, LoopLoad(torque=180.0))
    return LoopedProblem(
        system=system, rows=loop_rows(), meshes=meshes, speed=speed, twist=wound.state.twist,
        drive_torque=wound.drive_torque, drag_torques={}, cutoff=20e3,
    )  # fmt: skip


def test_one_step_of_the_linear_part_is_exact() -> None:
    """Against the exponential of the state matrix with forces linear in the step."""
    system = seen().system(running(seen().reduced.model.rig, 300.0))
    model = seen().reduced.model
    rows = seen().on_freedoms(wrench_rows(model, "test"))
    n, step = len(system.inertia), 2e-5
    inverse = np.linalg.inv(system.inertia)
    matrix = np.block(
        [[np.zeros((n, n)), np.eye(n)], [-inverse @ system.stiffness, -inverse @ system.damping]]
    )
    rng = np.random.default_rng(3)
    old, new, load = rng.normal(size=7), rng.normal(size=7), rng.normal(size=n) * 1e-3
    whole = np.zeros((2 * n + 2, 2 * n + 2))
    whole[: 2 * n, : 2 * n] = matrix
    whole[n : 2 * n, 2 * n] = inverse @ (rows.T @ old + load)
    whole[n : 2 * n, 2 * n + 1] = inverse @ (rows.T @ (new - old)) / step
    whole[2 * n + 1, 2 * n] = 1.0
    at_end = scipy.linalg.expm(whole * step)[: 2 * n, 2 * n]
    held = ModesOverStep(system.form, rows, step, np.inf).held(load)
    given = held.given @ np.concatenate([old, new]) + held.given_constant
    expected = np.concatenate([rows @ at_end[:n], rows @ at_end[n:]])
    assert given == pytest.approx(expected, rel=1e-6, abs=1e-8 * np.abs(expected).max())


def test_no_energy_comes_or_goes() -> None:
    """Without friction and dampers: what the meshes do leaves their teeth, once the blow of the start has gone."""
    lost = []
    for step in (4e-6, 2e-6):
        loop = looped(step, lossless=True)
        first = loop.advance(round(4e-3 / step)).energy.sum(axis=0)[-1]
        before = loop.work[0]
        stored = loop.advance(round(4e-3 / step)).energy.sum(axis=0)
        assert loop.unconverged == 0
        lost.append(abs(loop.work[0] - before + stored[-1] - first) / stored.max())
    assert lost[1] < 1e-3
    assert lost[0] > 3.0 * lost[1]


def test_friction_and_dampers_take_what_the_meshes_give() -> None:
    """Power of all forces on their rows = - change of the stored energy - friction - dampers."""
    loop = looped(2e-6, lossless=False)
    record = loop.advance(4000)
    stored = record.energy.sum(axis=0)
    done, rubbed, damped = loop.work
    assert rubbed > 0.0
    assert damped > 0.0
    assert done + stored[-1] - stored[0] == pytest.approx(-rubbed - damped, rel=5e-3)


def test_both_meshes_of_the_loop_carry_its_torque() -> None:
    """At held twist the torque is that of the stiffness of the teeth; the loop closes over both meshes."""
    record = looped(4e-6, lossless=True).advance(6000)
    late = record.net_force[:, 3000:]
    torques = [row.mean() * law.base_radius_1 for row, law in zip(late, prototype_laws(), strict=True)]
    assert late.min() > 0.0
    assert torques[0] == pytest.approx(180.0, rel=0.1)
    assert torques[1] == pytest.approx(torques[0], rel=0.01)


def test_halves_of_a_double_helical_mesh_share_its_torque() -> None:
    """Under twice the torque each of two halves approaches as one does; the twist is that of laws that are not quite so
    stiff, of which the shafts take another share."""
    one, two = (looped(4e-6, lossless=True, halves=halves).advance(3000) for halves in (1, 2))
    late = slice(1500, None)
    assert two.net_force[:, late].mean(axis=1) == pytest.approx(
        2.0 * one.net_force[:, late].mean(axis=1), rel=3e-2
    )
    assert two.approach[:, late].mean(axis=1) == pytest.approx(one.approach[:, late].mean(axis=1), rel=3e-2)


@cache
def steady() -> LoopedResponse:
    return looped_response(problem())


def test_a_steady_response_keeps_its_speed_and_torque() -> None:
    found = steady()
    assert found.settled
    assert found.unconverged == 0
    assert found.speed == pytest.approx(SPEED, rel=1e-4)
    assert np.all(found.dynamic_factor > 1.0)
    assert np.all(found.least_share < 1.0)
    torques = [
        force * mesh.law.base_radius_1
        for force, mesh in zip(found.mean_force, loaded_meshes(lossless=False), strict=True)
    ]
    assert torques == pytest.approx([180.0, 180.0], rel=0.1)


@pytest.mark.slow
def test_a_steady_response_is_that_of_shorter_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tests.contact_in_loop.response.LONGEST_STEP", 2e-6)
    assert looped_response(problem(), longest=0.2).dynamic_factor == pytest.approx(
        steady().dynamic_factor, abs=3e-3
    )


def test_a_march_that_ends_before_it_settles_says_so() -> None:
    found = looped_response(problem(), tolerance=1e-9, longest=0.1)
    assert not found.settled
    assert found.time <= 0.1
    assert np.any(found.change > 1e-9)


def test_a_speed_that_is_not_positive_is_refused() -> None:
    with pytest.raises(DynamicsInputError, match=r"speed = 0\.0 rad/s must be above 0"):
        problem(0.0)
