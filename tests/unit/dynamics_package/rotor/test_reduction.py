from dataclasses import replace

import numpy as np
import pytest

from dynamics.rotor.assembly import ElasticModel, assemble_rig
from dynamics.rotor.bearing_state import (
    BearingCoefficients,
    RowSpring,
    RunningState,
    isotropic_bearing,
)
from dynamics.rotor.craig_bampton import approach_row, mesh_ports
from dynamics.rotor.reduction import ReducedElasticRig, port_rows_of, reduce_rig
from dynamics.rotor.rotor_model import AxialLocation, HousingSupport, isotropic_support
from dynamics.rotor.shaft import DrivetrainError
from tests.builders.elastic_rig import bearings, prototype_rig
from tests.builders.reduction_error import reduction_error
from tests.builders.static_deflection import static_deflection

FILM = BearingCoefficients(
    stiffness=np.array([[6e7, 8e7], [-1.1e8, 1.6e8]]), damping=np.array([[5e4, -1e4], [-1e4, 9e4]])
)
SPEED = 1256.6
"""12,000 rpm [rad/s]."""


@pytest.fixture(scope="module")
def model() -> ElasticModel:
    return assemble_rig(prototype_rig(0.0165))


@pytest.fixture(scope="module")
def reduced(model: ElasticModel) -> ReducedElasticRig:
    return reduce_rig(model, bearings(model.rig), 20e3)


def test_basis_is_mass_orthonormal_and_diagonal_in_stiffness(
    model: ElasticModel, reduced: ReducedElasticRig
) -> None:
    basis = reduced.basis
    assert np.abs(basis.T @ (model.mass @ basis) - np.eye(reduced.size)).max() < 1e-9
    stiffness = basis.T @ (model.stiffness @ basis)
    for name, port in reduced.ports.items():
        stiffness += port.T @ reduced.reference[name] @ port
    lowest = reduced.squared[reduced.n_rigid]
    scale = np.sqrt(np.maximum(np.outer(reduced.squared, reduced.squared), lowest**2))
    # stiffnesses of 1e10 N/m over the lowest mode of 4e4 N/m: rounding of 1e-16 becomes 1e-10 and its sums
    assert np.abs((stiffness - np.diag(reduced.squared)) / scale).max() < 1e-8


def test_rigid_motions_are_exact_zeros(model: ElasticModel, reduced: ReducedElasticRig) -> None:
    """Frequency 0, no force of dampers or gyroscopics, and equal turns of a whole line: by construction."""
    assert reduced.n_rigid == 2
    assert not reduced.squared[:2].any()
    state = RunningState(speed=SPEED, bearings=dict.fromkeys(model.ports, FILM))
    matrices = reduced.matrices(state)
    for matrix in (matrices.stiffness, matrices.damping):
        assert not matrix[:2].any()
        assert not matrix[:, :2].any()
    for k, motion in enumerate(model.rigid):
        values = set(reduced.basis[:, k])
        assert len(values) == 2
        inertia = motion.shape @ model.mass @ motion.shape
        assert max(values) == pytest.approx(inertia**-0.5)
    assert reduced.rigid.shape == (reduced.size, 2)


def test_damping_is_symmetric_but_for_the_gyroscopics(
    model: ElasticModel, reduced: ReducedElasticRig
) -> None:
    assert np.abs(reduced.damping - reduced.damping.T).max() < 1e-9 * np.abs(reduced.damping).max()
    assert np.abs(reduced.gyroscopic + reduced.gyroscopic.T).max() < 1e-12 * np.abs(reduced.gyroscopic).max()
    assert not reduced.circulation.any()
    damped = replace(model.rig.drivetrain.shafts[0], damping_time=1e-6)
    drivetrain = replace(model.rig.drivetrain, shafts=(damped, *model.rig.drivetrain.shafts[1:]))
    other = reduce_rig(
        assemble_rig(replace(model.rig, drivetrain=drivetrain)), bearings(model.rig), 20e3
    ).circulation
    assert other.any()
    assert np.abs(other + other.T).max() < 1e-9 * np.abs(other).max()


def test_all_modes_are_an_exact_change_of_coordinates(model: ElasticModel) -> None:
    whole = reduce_rig(model, bearings(model.rig))
    assert whole.size == model.size
    assert not whole.attached.any()
    state = RunningState(speed=SPEED, bearings=dict.fromkeys(model.ports, FILM))
    error = reduction_error(
        whole, state, mesh_ports(model, "test"), 2.0 * np.pi * np.array([300.0, 7e3, 4e4])
    )
    assert error.maximum < 1e-8


def test_static_answer_at_ports_is_exact_for_any_bearing_and_mesh(
    model: ElasticModel, reduced: ReducedElasticRig
) -> None:
    """With bearings far from the reference, cross-coupled, and mesh springs on rows made of the kept gear motions."""
    springs = tuple(
        RowSpring(row=approach_row(model, mesh), stiffness=k)
        for mesh, k in (("test", 1.14e8), ("reference", 7e8))
    )
    state = RunningState(bearings=dict.fromkeys(model.ports, FILM), springs=springs)
    load = model.joint("pinion side", "coupling").load("turn")
    exact = static_deflection(model, state, load).deflection
    stiffness = reduced.matrices(state).stiffness
    free = np.array([1.0 / 99.0, 1.0 / 102.0]) / reduced.basis[:, :2].max(axis=0)
    held = np.concatenate([free, np.zeros(reduced.size - 2)])
    bordered = np.block([[stiffness, held[:, None]], [held, 0.0]])
    found = reduced.basis @ np.linalg.solve(bordered, [*reduced.rows(load), 0.0])[:-1]
    rows = np.vstack([approach_row(model, "test"), *[port[:2] for port in model.ports.values()]])
    # rounding of the solutions, with stiffnesses from 1e2 to 1e10 N/m in one matrix
    assert rows @ found == pytest.approx(rows @ exact, rel=1e-6, abs=1e-9 * np.abs(rows @ exact).max())


@pytest.mark.parametrize(
    ("cutoff", "low", "high"), [(10e3, 1e-4, 1e-2), (20e3, 5e-5, 2e-3), (50e3, 1e-5, 2e-4)]
)
def test_measured_error_falls_with_the_cutoff(
    model: ElasticModel, cutoff: float, low: float, high: float
) -> None:
    """At meshes and bearings, 12,000 rpm, films far from the reference bearings: up to 2 kHz, up to 5 kHz."""
    rig = reduce_rig(model, bearings(model.rig), cutoff)
    rows = np.vstack([mesh_ports(model, "test"), mesh_ports(model, "reference")])
    rows = np.vstack([rows, *[port[:2] for port in model.ports.values()]])
    frequencies = 2.0 * np.pi * np.linspace(50.0, 5e3, 34)
    state = RunningState(speed=SPEED, bearings=dict.fromkeys(model.ports, FILM))
    error = reduction_error(rig, state, rows, frequencies)
    assert error.largest[frequencies < 2.0 * np.pi * 2e3].max() < low
    assert error.maximum < high


def test_static_shapes_are_what_makes_a_small_basis_exact(model: ElasticModel) -> None:
    """The same modes without them miss the yield of the bearings by more than a hundred times as much."""
    rows = mesh_ports(model, "test")
    frequencies = 2.0 * np.pi * np.array([200.0, 1e3])
    state = RunningState(speed=SPEED, bearings=dict.fromkeys(model.ports, FILM))
    errors = []
    for wanted in (None, np.zeros((1, model.size))):
        rig = reduce_rig(model, bearings(model.rig), 10e3, wanted)
        errors.append(reduction_error(rig, state, rows, frequencies).maximum)
    assert errors[1] > 100.0 * errors[0]


def test_lines_that_nothing_ties_stay_apart(model: ElasticModel, reduced: ReducedElasticRig) -> None:
    """Torsion, axial motion and bending of two lines are six groups; no coordinate reaches into another's freedoms."""
    assert set(reduced.components) == set(range(6))
    films = (port[[0, 1, 3, 4]] for port in reduced.ports.values())
    for matrix in (reduced.damping, reduced.gyroscopic, *(film.T @ film for film in films)):
        i, j = np.nonzero(np.abs(matrix) > 1e-12 * np.abs(matrix).max())
        assert (reduced.components[i] == reduced.components[j]).all()
    shafts = np.array(model.freedoms.shaft_of)
    for component in range(6):
        touched = np.abs(reduced.basis[:, reduced.components == component]).max(axis=1) > 0.0
        assert len({int(s) % 2 for s in shafts[touched]}) == 1


def test_a_common_housing_ties_them(model: ElasticModel) -> None:
    stiffness = 5e8 * np.eye(4)
    stiffness[0, 2] = stiffness[2, 0] = 1e8
    support = HousingSupport(
        name="box",
        bearings=("test_pinion front", "test_wheel front"),
        stiffness=stiffness,
        mass=3.0 * np.eye(4),
    )
    rig = replace(model.rig, supports=(support, isotropic_support("test_wheel rear", 5e8, 2.0)))
    reduced = reduce_rig(assemble_rig(rig), bearings(rig), 10e3)
    assert set(reduced.components) == set(range(5))


def test_axial_float_is_a_rigid_motion_of_the_reduced_rig(model: ElasticModel) -> None:
    """Of a line that two meshes of opposite hands hold, outside the matrices."""
    rig = model.rig
    train = rig.drivetrain
    pinion, wheel = (replace(g, name=f"{g.name}_2") for g in train.gears if g.name.startswith("reference"))
    left = replace(train.meshes[1], base_helix_angle=-0.3)
    right = replace(left, name="second", base_helix_angle=0.3, pinion=pinion.name, wheel=wheel.name)
    train = replace(train, gears=(*train.gears, pinion, wheel), meshes=(train.meshes[0], left, right))
    located = (AxialLocation(bearing="reference_wheel rear", stiffness=1e8),)
    rig = replace(rig, drivetrain=train, axial_locations=located)
    floating = assemble_rig(rig)
    reduced = reduce_rig(floating, bearings(rig), 10e3)
    assert reduced.n_rigid == 3
    assert not reduced.squared[:3].any()
    row = reduced.rows(floating.row("test_pinion_gear", "u_x"))
    mass = floating.rigid[2].shape @ floating.mass @ floating.rigid[2].shape
    assert row[2] == pytest.approx(mass**-0.5)
    assert not row[:2].any()


def test_default_ports_name_everything_that_acts(model: ElasticModel) -> None:
    """8 bearings x 5, 4 gears x 6, the motor, 4 splines and 2 couplings with torsional dampers."""
    assert port_rows_of(model).shape == (8 * 5 + 4 * 6 + 1 + 6, model.size)


def test_reference_bearings_must_hold_the_shafts(model: ElasticModel) -> None:
    held = {**bearings(model.rig), "test_wheel front": isotropic_bearing(0.0)}
    with pytest.raises(DrivetrainError, match=r"'test_wheel front': symmetric part .* must be above 0"):
        reduce_rig(model, held)
