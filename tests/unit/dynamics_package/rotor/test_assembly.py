from dataclasses import replace

import numpy as np
import pytest

from dynamics.rotor.assembly import assemble_rig
from dynamics.rotor.bearing_state import BearingCoefficients, RunningState, isotropic_bearing
from dynamics.rotor.damped_modes import damped_modes
from dynamics.rotor.parts import JointStiffness
from dynamics.rotor.reduction import reduce_rig
from dynamics.rotor.rotor_model import HousingSupport, ProbeStation, isotropic_support
from dynamics.rotor.shaft import Disc, DrivetrainError, Section
from tests.builders.elastic_rig import (
    bearings,
    motion_of_all,
    placements,
    prototype_rig,
    ring_mass,
    running,
    single_shaft,
)
from tests.builders.full_matrices import full_matrices
from tests.builders.static_deflection import static_deflection

BAR = (Section(length=0.15, outer_diameter=0.05), Section(length=0.25, outer_diameter=0.03))


def test_matrices_are_symmetric_and_gyroscopics_skew() -> None:
    model = assemble_rig(prototype_rig())
    for matrix in (model.mass, model.stiffness, model.damping):
        assert np.abs((matrix - matrix.T).toarray()).max() <= 1e-12 * abs(matrix).max()
    assert np.abs((model.gyroscopic + model.gyroscopic.T).toarray()).max() == 0.0
    assert len(set(model.names)) == model.size


def test_mass_of_all_parts_and_their_weight() -> None:
    rig = prototype_rig()
    model = assemble_rig(rig)
    parts = sum(ring_mass(g.shaft) for g in rig.drivetrain.gears)
    for shaft in rig.drivetrain.shafts:
        parts += sum(7850.0 * 0.25 * np.pi * s.outer_diameter**2 * s.length for s in shaft.sections)
        parts += sum(disc.mass for disc in shaft.discs)
    rise = motion_of_all(model, np.array([0.0, 0.0, 1.0]), np.zeros(3))
    assert rise @ model.mass @ rise == pytest.approx(parts, rel=1e-12)
    assert rise @ model.weight() == pytest.approx(-9.80665 * parts, rel=1e-12)


def test_joints_let_the_rig_move_as_a_whole() -> None:
    """Couplings of finite length and gears off their station stretch nothing when everything moves as one body."""
    rig = prototype_rig(0.05)
    gears = tuple(
        replace(g, offset=0.006, seat=JointStiffness(axial=1e8, lateral=5e8, angular=2e5))
        for g in rig.drivetrain.gears
    )
    model = assemble_rig(
        replace(rig, drivetrain=replace(rig.drivetrain, gears=gears), axial_locations=rig.axial_locations)
    )
    motion = motion_of_all(model, np.array([0.2, -0.4, 0.7]), np.array([0.0, 0.3, -0.5]))
    for gear in gears:
        place, at = model.freedoms.place(gear.name), rig.placement(gear.shaft)
        here = np.array([0.2, -0.4, 0.7]) + np.cross([0.0, 0.3, -0.5], [place.x, at.y, at.z])
        motion[place.freedoms] = [*here, 0.0, 0.3, -0.5]
    for joint in model.joints:
        if joint.kind != "axial location":
            assert np.abs(joint.rows @ motion).max() < 1e-12
    assert {joint.kind for joint in model.joints} == {"spline", "coupling", "axial location"}


def test_gear_off_its_station_hangs_on_a_rigid_arm() -> None:
    rig = prototype_rig(0.05)
    gears = tuple(replace(g, offset=0.01) for g in rig.drivetrain.gears)
    model = assemble_rig(replace(rig, drivetrain=replace(rig.drivetrain, gears=gears)))
    station = model.freedoms.on_shaft("test_pinion", 0.17992).rows(model.size)
    centre = model.rows("test_pinion_gear")
    assert centre[1] == pytest.approx(station[1] + 0.01 * station[5])
    assert centre[2] == pytest.approx(station[2] - 0.01 * station[4])
    assert centre[3] @ station[3] == 0.0


def test_a_shaft_drawn_backwards_is_the_same_rotor_turned_round() -> None:
    discs = (Disc(name="flange", position=0.4, inertia=0.01, mass=3.0),)
    rig = single_shaft(BAR, (0.05, 0.3), 0.05, discs=discs)
    back = replace(rig, placements=(replace(rig.placements[0], start=0.4, direction=-1, sense=-1),))
    found = []
    for one in (rig, back):
        reduced = reduce_rig(assemble_rig(one), bearings(one))
        modes = damped_modes(reduced, RunningState(speed=900.0, bearings=bearings(one)), 5e3)
        found.append(modes.poles)
    assert found[0] == pytest.approx(found[1], rel=1e-9)


def test_speeds_and_senses_of_all_shafts() -> None:
    model = assemble_rig(prototype_rig(0.05))
    ratio = 102.0 / 99.0
    assert model.spins == pytest.approx(
        {"test_pinion": ratio, "test_wheel": -1.0, "reference_pinion": ratio, "reference_wheel": -1.0}
    )
    other = assemble_rig(replace(prototype_rig(0.05), reference_shaft="test_pinion"))
    assert other.spins["test_wheel"] == pytest.approx(-1.0 / ratio)
    assert placements()[0].sense == 1


def test_seat_of_the_housing_is_in_series_with_its_bearing() -> None:
    """Two bearings of k_b on seats of k_s carry a force on the middle of a shaft: + F / 2 (1 / k_b + 1 / k_s)."""
    bar = (Section(length=0.4, outer_diameter=0.05),)
    rig = replace(
        single_shaft(bar, (0.0, 0.4), 0.1), stations=(ProbeStation(name="here", shaft="rotor", position=0.2),)
    )
    soft = replace(rig, supports=tuple(isotropic_support(b, 3e8, 2.0, 1e3) for b in ("b0", "b1")))
    found = []
    for one in (rig, soft):
        model = assemble_rig(one)
        row = model.row("here", "u_y")
        found.append(float(row @ static_deflection(model, running(one), row).deflection))
    assert found[1] - found[0] == pytest.approx(0.5 / 3e8, rel=1e-9)


def test_condensed_housing_moves_one_bearing_under_the_load_of_another() -> None:
    bar = (Section(length=0.4, outer_diameter=0.05),)
    rig = single_shaft(bar, (0.0, 0.4), 0.1)
    flexibility = np.diag([2e-9, 3e-9, 4e-9, 2e-9])
    flexibility[0, 2] = flexibility[2, 0] = 1e-9
    housing = HousingSupport(
        name="housing", bearings=("b0", "b1"), stiffness=np.linalg.inv(flexibility), mass=2.0 * np.eye(4)
    )
    model = assemble_rig(replace(rig, supports=(housing,)))
    state = RunningState(bearings=bearings(rig))
    journal = model.rows("b0")[1]
    deflection = static_deflection(model, state, 1e3 * journal).deflection
    force = 1e8 * model.ports["b0"][0] @ deflection
    assert force == pytest.approx(1e3, rel=1e-9)
    seats = [deflection[model.freedoms.seats[b]][0] for b in ("b0", "b1")]
    assert seats == pytest.approx([2e-6, 1e-6], rel=1e-9)
    assert model.joint("housing", "housing").directions[2] == "b1 u_y"
    assert model.names[-1] == "b1 seat u_z"


def test_thrust_of_a_locating_bearing_presses_on_its_seat() -> None:
    """An axial force passes the spring of the bearing and the seat: F (1 / k_b + h_xx); the other seat follows it."""
    rig = single_shaft((Section(length=0.4, outer_diameter=0.05),), (0.0, 0.4), 0.1)
    flexibility = np.diag([2e-9, 3e-9, 5e-9, 2e-9, 3e-9, 5e-9])
    flexibility[2, 5] = flexibility[5, 2] = 1e-9
    housing = HousingSupport(
        name="housing", bearings=("b0", "b1"), stiffness=np.linalg.inv(flexibility), mass=2.0 * np.eye(6)
    )
    model = assemble_rig(replace(rig, supports=(housing,)))
    pull = model.rows("b0")[0]
    deflection = static_deflection(model, running(rig), 1e3 * pull).deflection
    assert pull @ deflection == pytest.approx(1e3 * (1e-9 + 5e-9), rel=1e-9)
    seats = [deflection[model.freedoms.seats[b]][2] for b in ("b0", "b1")]
    assert seats == pytest.approx([5e-6, 1e-6], rel=1e-9)


def test_rolling_bearing_locates_and_resists_tilting() -> None:
    bar = (Section(length=0.4, outer_diameter=0.05),)
    rig = replace(
        single_shaft(bar, (0.0,), 0.1), axial_locations=(), axially_locating=("b0",), moment_carrying=("b0",)
    )
    model = assemble_rig(rig)
    assert [motion.kind for motion in model.rigid] == ["turn"]
    five = BearingCoefficients(stiffness=np.diag([2e8, 2e8, 5e7, 3e5, 3e5]), damping=np.zeros((5, 5)))
    state = RunningState(bearings={"b0": five})
    pull = model.rows("b0")[0]
    assert pull @ static_deflection(model, state, pull).deflection == pytest.approx(2e-8, rel=1e-9)
    with pytest.raises(DrivetrainError, match="'b0' is to locate its shaft, but its axial stiffness is 0"):
        full_matrices(model, RunningState(bearings={"b0": isotropic_bearing(1e8)}))
    with pytest.raises(DrivetrainError, match="does not count as locating"):
        full_matrices(
            assemble_rig(single_shaft(bar, (0.0, 0.4), 0.1)), RunningState(bearings={"b0": five, "b1": five})
        )


def test_bearings_without_coefficients_and_unknown_names() -> None:
    model = assemble_rig(prototype_rig(0.05))
    with pytest.raises(DrivetrainError, match="has no coefficients"):
        full_matrices(model, RunningState())
    with pytest.raises(DrivetrainError, match="'elsewhere' has coefficients but no place"):
        full_matrices(
            model, RunningState(bearings={**bearings(model.rig), "elsewhere": isotropic_bearing(1e8)})
        )
    with pytest.raises(DrivetrainError, match=r"shape \(3, 3\): must be \(2, 2\)"):
        BearingCoefficients(stiffness=np.eye(3), damping=np.eye(3))
    with pytest.raises(DrivetrainError, match="place 'nowhere' does not exist"):
        model.rows("nowhere")
    with pytest.raises(DrivetrainError, match="resists turn, not u_y"):
        model.joint("test_pinion_gear", "spline").row("u_y")


def test_motor_rotor_on_a_joint_of_its_own_turns_alone() -> None:
    rig = prototype_rig(0.05)
    motor = replace(rig.drivetrain.motor, stiffness=5e4, inertia=0.02)
    model = assemble_rig(replace(rig, drivetrain=replace(rig.drivetrain, motor=motor)))
    turn = model.freedoms.place("motor").turn
    assert model.names[turn] == "reference_wheel/motor turn"
    assert model.mass[turn, turn] == 0.02
    assert model.joint("motor", "motor").directions == ("turn",)


def test_linear_drag_is_kept_apart_from_structural_damping() -> None:
    rig = prototype_rig(0.05)
    places = tuple(replace(b, linear_drag=7e-4) for b in rig.drivetrain.bearings)
    model = assemble_rig(replace(rig, drivetrain=replace(rig.drivetrain, bearings=places)))
    assert model.drag.sum() == pytest.approx(8 * 7e-4)
    reduced = reduce_rig(model, bearings(rig))
    modes = damped_modes(reduced, running(rig))
    # two lines coast down by themselves: drag over inertia of each
    inertia = [float(m.shape @ model.mass @ m.shape) for m in model.rigid]
    assert sorted(modes.real_poles[:2]) == pytest.approx(sorted(-4 * 7e-4 / j for j in inertia), rel=1e-4)
