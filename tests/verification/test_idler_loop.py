"""A gear in two meshes: statics of the loop by hand, harmonic balance against the time integration."""

import math

import numpy as np
import pytest

from dynamics.rotor.graph import assemble
from dynamics.rotor.shaft import STEEL_SHEAR_MODULUS
from dynamics.rotor.static_loop import LoopLoad, port_model, solve_static
from dynamics.rotor.torsional_modes import loop_modes
from dynamics.tooth.law import MeshLaw
from dynamics.vibration.speed_continuation import mesh_cells
from dynamics.vibration.speed_sweep import SweepSettings, periodic_response
from dynamics.vibration.steady_motion import periodic_by_time
from tests.builders.idler import COUPLING_STIFFNESS, RADIUS, SPLINE_STIFFNESS, idler_laws, idler_rig

RPM = math.pi / 30.0
TORQUE = 400.0


def constant(law: MeshLaw) -> MeshLaw:
    """The same mesh with one pair of constant stiffness, no gap, no backlash and no friction."""
    return law._replace(
        path_start=0.0,
        path_step=law.base_pitch / 4,
        stiffness=np.full((1, 5), law.mean_stiffness),
        gap=np.zeros((1, 5)),
        slice_shift=np.zeros(1),
        deviation_1=np.zeros((1, 5)),
        deviation_2=np.zeros((1, 5)),
        backlash=0.0,
        friction=0.0,
        damping=0.0,
    )


def test_an_idler_is_one_port_of_two_meshes() -> None:
    model = port_model(assemble(idler_rig()), idler_laws())
    assert model.n_bodies == 6
    assert model.pinions.tolist() == [0, 0, 3, 3]
    assert model.wheels.tolist() == [1, 2, 4, 5]


def test_torque_goes_round_the_loop_and_stiffness_adds_in_series() -> None:
    """One flank of the idler is driven, the other drives; its line carries nothing beside.

    The twist is made on a wheel line: it turns a wheel ahead, where the pinion's own torque asks for the contrary.
    """
    laws = tuple(constant(law) for law in idler_laws())
    state = solve_static(port_model(assemble(idler_rig()), laws), LoopLoad(torque=TORQUE))
    assert state.mean_torque == pytest.approx([TORQUE, -TORQUE, -TORQUE, TORQUE], rel=1e-9)
    half_shaft = 0.1 / (STEEL_SHEAR_MODULUS * math.pi * 0.05**4 / 32.0)
    wheel_line = 2.0 * (half_shaft + 1.0 / SPLINE_STIFFNESS) + 1.0 / COUPLING_STIFFNESS
    meshes = 2.0 * (1.0 / 1.5e8 + 1.0 / 4e8) / RADIUS**2
    assert -state.twist == pytest.approx(TORQUE * (2.0 * wheel_line + meshes), rel=1e-8)


def test_backlash_of_every_mesh_that_turns_to_its_back_flank_counts_once() -> None:
    laws = [constant(law) for law in idler_laws()]
    system = assemble(idler_rig())
    closed = solve_static(port_model(system, laws), LoopLoad(torque=TORQUE))
    played = [law._replace(backlash=50e-6) for law in laws]
    open_ = solve_static(port_model(system, played), LoopLoad(torque=TORQUE))
    assert closed.twist - open_.twist == pytest.approx(2 * 50e-6 / RADIUS, rel=1e-8)


def test_both_solvers_agree_and_the_motor_gives_what_is_lost() -> None:
    system, laws = assemble(idler_rig()), idler_laws()
    speeds = np.array([2000.0, 4000.0, 7500.0])
    curve = periodic_response(
        system,
        laws,
        speeds * RPM,
        LoopLoad(torque=TORQUE),
        settings=SweepSettings(methods=("harmonic_balance",)),
    )
    assert curve.failed == ()
    for point in curve.points:
        run = periodic_by_time(system, laws, speed=point.speed, load=LoopLoad(torque=TORQUE))
        assert point.flank.tolist() == [1.0, -1.0, -1.0, 1.0]
        peak = np.maximum(run.greatest_torque, -run.least_torque)
        assert point.maximum == pytest.approx(peak, rel=0.01)
        assert point.friction_power == pytest.approx(run.friction_loss, rel=0.01)
        # everything turns at one speed here
        joints = point.drive_torque * point.speed - point.friction_power.sum() - point.damping_power.sum()
        assert joints == pytest.approx(run.joint_loss, abs=0.01 * point.drive_torque * point.speed)
        assert (point.maximum / point.mean > 1.02).any()


def test_cell_and_modes_of_the_loop() -> None:
    rig, laws = idler_rig(), idler_laws()
    cells, angle = mesh_cells(port_model(assemble(rig), laws), "mesh", 0)
    assert (cells, angle) == (1, pytest.approx(2.0 * math.pi / 40))
    modes = loop_modes(rig, laws)
    assert [mode.frequency for mode in modes].count(0.0) == 1
    assert all(mode.mesh_gain.shape == (4,) for mode in modes)
