"""Moments of a cross joint on its shafts against its exact kinematics, and what they do to the elastic rig."""

import math
from dataclasses import replace

import numpy as np
import pytest

from dynamics.rotor.assembly import (
    CrossJointLoad,
    ElasticModel,
    assemble_rig,
    bending_moment,
    cross_joint_loads,
    standing_load,
)
from dynamics.rotor.craig_bampton import SeenRig, mesh_ports
from dynamics.rotor.reduction import reduce_rig
from dynamics.rotor.rotor_model import CrossJoint
from tests.builders.elastic_rig import bearings, prototype_rig, running

TORQUE = 180.0
TURNS = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)


def exact(slope: tuple[float, float], sense: float, turn: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Moments [N m] that yokes of a massless cross get under the torque 1 along the first axis, and the second torque.

    The arms are made by rotation, the moment by its definition: square to both arms, along e_1 the torque.
    """
    one, two = (sense * np.array([1.0, *values]) for values in (slope, (0.0, 0.0)))
    one, two = one / np.linalg.norm(one), two / np.linalg.norm(two)
    square = np.cross(one, two) / np.linalg.norm(np.cross(one, two))
    first = math.cos(turn) * -square + math.sin(turn) * np.cross(one, -square)
    second = np.cross(two, first)
    moment = np.cross(first, second / np.linalg.norm(second))
    moment /= moment @ one
    assert abs(moment @ first) < 1e-12 and abs(moment @ second) < 1e-12
    return -(moment - (moment @ one) * one), moment - (moment @ two) * two, float(moment @ two)


@pytest.fixture(scope="module", params=[((2e-3, 0.0), "pinion"), ((-1e-3, 3e-3), "wheel")])
def joint(request: pytest.FixtureRequest) -> tuple[CrossJoint, ElasticModel]:
    """On the pinion line, which turns about +x, and on the wheel line, which turns about -x."""
    slope, line = request.param
    rig = prototype_rig(0.0165)
    name = next(one.name for one in rig.drivetrain.couplings if line in one.shafts[0])
    made = CrossJoint(coupling=name, slope=slope)
    return made, assemble_rig(replace(rig, cross_joints=(made,)))


def load_of(model: ElasticModel) -> CrossJointLoad:
    (load,) = cross_joint_loads(model)
    return load


def tilts(model: ElasticModel, joint: CrossJoint) -> list[np.ndarray]:
    """(2, n) rows of the tilt about y and z of both ends at the joint."""
    coupling = next(one for one in model.rig.drivetrain.couplings if one.name == joint.coupling)
    rows = []
    for shaft, end in zip(coupling.shafts, coupling.ends, strict=True):
        nodes = model.freedoms.nodes[shaft]
        first = nodes.first + 6 * (0 if end == "left" else nodes.positions.size - 1)
        rows.append(np.eye(model.size)[[first + 4, first + 5]])
    return rows


def test_loads_are_the_moments_of_the_exact_joint(joint: tuple[CrossJoint, ElasticModel]) -> None:
    """Virtual work: a tilt of one shaft end alone takes the moment on it, at every angle; the rest is of order b^2."""
    made, model = joint
    load, angle = load_of(model), math.hypot(*made.slope)
    sense = float(np.sign(model.spins[load.shaft]))
    for turn in TURNS:
        acting = load.standing + (load.turning * np.exp(2j * turn)).real
        for rows, moment in zip(tilts(model, made), exact(made.slope, sense, turn)[:2], strict=True):
            assert rows @ acting == pytest.approx(moment[1:], abs=2.0 * angle**2)
            assert abs(rows @ acting).max() <= angle


def test_the_exact_joint_does_no_work_and_its_couple_is_t_tan_b_cos() -> None:
    """T_1 w_1 = T_2 w_2 with w_2/w_1 = cos b/(1 - sin^2 b sin^2 theta); |couple| on the first yoke T tan b |cos|."""
    slope = (0.3, -0.4)
    angle = math.atan(0.5)
    for turn in TURNS:
        first, second, torque = exact(slope, 1.0, turn)
        speed = math.cos(angle) / (1.0 - (math.sin(angle) * math.sin(turn)) ** 2)
        assert torque * speed == pytest.approx(1.0)
        assert np.linalg.norm(first) == pytest.approx(math.tan(angle) * abs(math.cos(turn)), abs=1e-12)
        assert np.linalg.norm(second) == pytest.approx(
            math.sin(angle) * abs(math.sin(turn)), rel=0.12, abs=1e-9
        )


def test_orders_are_zero_and_two_in_the_fixed_frame_and_one_in_that_of_the_yoke() -> None:
    """Waves of the exact couple at 1 mrad over a turn: halves at 0 and 2, none at 1; across the yoke all of it at 1."""
    angle, sense = 1e-3, 1.0
    couples = np.array([exact((angle, 0.0), sense, turn)[0] for turn in TURNS])
    waves = np.abs(np.fft.fft(couples[:, 1] + 1j * couples[:, 2])) / TURNS.size
    assert waves[0] == pytest.approx(0.5 * angle, rel=1e-5) and waves[2] == pytest.approx(
        0.5 * angle, rel=1e-5
    )
    assert waves[[1, 3, 4]].max() < 1e-5 * angle
    turning = (couples[:, 1] + 1j * couples[:, 2]) * np.exp(-1j * sense * TURNS)
    seen = np.abs(np.fft.fft(turning)) / TURNS.size
    assert seen[1] == pytest.approx(0.5 * angle, rel=1e-5) and seen[-1] == pytest.approx(
        0.5 * angle, rel=1e-5
    )


def test_the_standing_part_is_that_of_the_turn(joint: tuple[CrossJoint, ElasticModel]) -> None:
    made, model = joint
    sense = float(np.sign(model.spins[load_of(model).shaft]))
    whole = standing_load(model, {made.coupling: TORQUE})
    mean = np.mean([exact(made.slope, sense, turn)[0][1:] for turn in TURNS], axis=0)
    for rows in tilts(model, made):
        assert rows @ whole == pytest.approx(TORQUE * mean, rel=1e-4)
    assert bending_moment(made, sense, TORQUE) == pytest.approx(TORQUE * mean, rel=1e-4)


def test_the_linear_system_has_it_twice_a_turn_under_its_torque(
    joint: tuple[CrossJoint, ElasticModel],
) -> None:
    """Two rows, cosine and sine, that do on any motion of the reduced rig what the full load does; none without torque
    and none on the turn of the shafts."""
    made, model = joint
    reduced = reduce_rig(model, bearings(model.rig), 20e3)
    faces = {mesh.name: mesh_ports(model, mesh.name, "front") for mesh in model.rig.drivetrain.meshes}
    seen = SeenRig(reduced=reduced, ports=faces)
    state = running(model.rig, 1000.0)
    assert not [one for one in seen.system(state).periodic_loads if one.name.startswith("cross joint")]
    system = seen.system(replace(state, torques={made.coupling: TORQUE}))
    loads = [one for one in system.periodic_loads if one.name == f"cross joint {made.coupling}"]
    assert len(loads) == 2 and all(part.order == 2.0 for one in loads for part in one.parts)
    turning = load_of(model).turning
    for turn in (0.3, 1.7):
        acting = sum(float(one.at(np.array([turn]))[0]) * one.load for one in loads)
        full = TORQUE * (turning * np.exp(2j * turn)).real
        forth = system.coordinates.freedoms
        assert forth.T @ acting == pytest.approx(
            reduced.rows(full), abs=1e-9 * np.abs(reduced.rows(full)).max()
        )
        rigid = np.abs(system.rigid.T @ acting).max()
        assert rigid < 1e-9 * np.abs(acting).max()
