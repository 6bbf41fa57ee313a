"""Friction of splines: energy of a cycle and decay at the mesh frequency are those of the loss factor at all speeds."""

import math
from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg

from dynamics.rotor.assembly import assemble_rig
from dynamics.rotor.bearing_state import RunningState
from dynamics.rotor.graph import (
    Drivetrain,
    assemble,
    at_speed,
    torsional_twist_rows,
    with_spline_dampers,
)
from dynamics.rotor.parts import GearBody, MeshConnection, Motor
from dynamics.rotor.reduction import reduce_rig
from dynamics.rotor.rotor_model import ElasticRig
from dynamics.rotor.shaft import DrivetrainError, Section, Shaft
from tests.builders.elastic_rig import bearings, prototype_rig
from tests.builders.full_matrices import full_matrices

STIFFNESS, TEETH = 2e5, (20, 30)
SPEEDS = (150.0, 900.0)
"""Of the motor [rad/s]."""


def two_inertias(loss_factor: float, motor_inertia: float = 2e-3) -> Drivetrain:
    """A gear of 1 g m2 on a spline against a shaft as good as rigid with its motor, and its partner on another one."""

    def shaft(name: str) -> Shaft:
        return Shaft(
            name=name,
            sections=(Section(length=0.1, outer_diameter=0.04),),
            shear_modulus=8e18,
            element_length=0.1,
        )

    def gear(name: str) -> GearBody:
        return GearBody(
            name=name,
            shaft=f"shaft {name}",
            position=0.05,
            inertia=1e-3,
            stiffness=STIFFNESS,
            loss_factor=loss_factor,
        )

    return Drivetrain(
        shafts=(shaft("shaft a"), shaft("shaft b")),
        gears=(gear("a"), gear("b")),
        meshes=(
            MeshConnection(
                name="mesh",
                pinion="a",
                wheel="b",
                base_radii=(0.04, 0.06),
                teeth=TEETH,
                centre_distance=0.106,
            ),
        ),
        motor=Motor(shaft="shaft a", position=0.0, inertia=motor_inertia),
    )


@pytest.mark.parametrize("speed", SPEEDS)
@pytest.mark.parametrize("eta", [0.02, 0.3])
def test_a_cycle_at_the_mesh_frequency_loses_pi_eta_k_phi2(speed: float, eta: float) -> None:
    """Work of a torque on the gear over a cycle, -pi Im(x) T, against pi eta k |phi|^2: nothing else dissipates."""
    system = assemble(at_speed(two_inertias(eta), speed))
    gear, _ = system.mesh_ports[0]
    seat = system.dofs.index("shaft a/50.00 mm")
    omega = TEETH[0] * speed
    dynamic = system.stiffness - omega**2 * system.inertia + 1j * omega * system.damping
    response = np.linalg.solve(dynamic, np.eye(len(dynamic))[gear])
    twist = response[gear] - response[seat]
    assert -math.pi * response[gear].imag == pytest.approx(
        math.pi * eta * STIFFNESS * abs(twist) ** 2, rel=1e-9
    )


@pytest.mark.parametrize("eta", [0.01, 0.2])
def test_a_mode_at_the_mesh_frequency_decays_by_pi_eta(eta: float) -> None:
    """All strain energy in the spline, undamped frequency at the mesh: damping ratio eta/2, logarithmic decrement
    pi eta / sqrt(1 - (eta/2)^2). The nodes of the shaft move together."""
    system = assemble(two_inertias(0.0))
    gear, _ = system.mesh_ports[0]
    shapes = np.zeros((len(system.inertia), 2))
    shapes[gear, 0] = 1.0
    shapes[[i for i, name in enumerate(system.dofs) if name.startswith("shaft a") and i != gear], 1] = 1.0
    inertia, stiffness = (shapes.T @ matrix @ shapes for matrix in (system.inertia, system.stiffness))
    undamped = math.sqrt(scipy.linalg.eigh(stiffness, inertia, eigvals_only=True)[1])
    assert undamped == pytest.approx(math.sqrt(STIFFNESS * np.sum(1.0 / np.diag(inertia))))
    damping = shapes.T @ assemble(at_speed(two_inertias(eta), undamped / TEETH[0])).damping @ shapes
    inverse = np.linalg.inv(inertia)
    state = np.block([[np.zeros((2, 2)), np.eye(2)], [-inverse @ stiffness, -inverse @ damping]])
    poles = np.linalg.eigvals(state)
    pole = max(poles, key=lambda one: one.imag)
    decrement = -2.0 * math.pi * pole.real / pole.imag
    assert decrement == pytest.approx(math.pi * eta / math.sqrt(1.0 - 0.25 * eta**2), rel=1e-9)
    assert decrement == pytest.approx(math.pi * eta, rel=0.2 * eta**2)


def test_the_damper_carries_torque_beside_the_spring() -> None:
    """At the mesh frequency |k + i omega c| = k sqrt(1 + eta^2) per twist, on the rows of the splines alone."""
    drivetrain, speed, eta = two_inertias(0.3), 150.0, 0.3
    plain = torsional_twist_rows(drivetrain)
    rows = with_spline_dampers(plain, drivetrain, speed)
    for section, stiffness, damping, before in zip(
        rows.sections, rows.stiffness, rows.damping, plain.damping, strict=True
    ):
        if section.kind == "spline":
            per_twist = abs(stiffness + 1j * TEETH[0] * speed * damping)
            assert per_twist == pytest.approx(STIFFNESS * math.sqrt(1.0 + eta**2))
        else:
            assert damping == before
    still = two_inertias(0.0)
    same = torsional_twist_rows(still)
    assert with_spline_dampers(same, still, speed) is same


def test_every_gear_counts_its_own_teeth_and_speed() -> None:
    """The wheel of 30 teeth turns 2/3 as fast: one mesh frequency, one damper; at twice the speed half of it."""
    slow, fast = (at_speed(two_inertias(0.05), speed) for speed in (100.0, 200.0))
    for gear in slow.gears:
        assert (
            gear.damping == pytest.approx(0.05 * STIFFNESS / (20 * 100.0), rel=1e-12) and not gear.loss_factor
        )
    assert [gear.damping for gear in fast.gears] == pytest.approx([0.5 * gear.damping for gear in slow.gears])
    assert all(gear.damping == 0.0 for gear in at_speed(two_inertias(0.05), 0.0).gears)


def frictional(eta: float) -> ElasticRig:
    """The prototype with friction in its splines, all other dampers taken out."""
    rig = prototype_rig(0.0165)
    train = rig.drivetrain
    return replace(
        rig,
        drivetrain=replace(
            train,
            gears=tuple(replace(gear, damping=0.0, loss_factor=eta) for gear in train.gears),
            couplings=tuple(replace(coupling, damping=0.0) for coupling in train.couplings),
        ),
    )


@pytest.mark.parametrize("speed", [250.0, 1250.0])
def test_the_elastic_rig_loses_the_same_full_and_reduced(speed: float) -> None:
    """Work of a torque on one gear, all splines dissipate; shafts that turn and whirl take nothing."""
    eta, model = 0.05, assemble_rig(frictional(0.05))
    held = bearings(model.rig, damping=0.0)
    state = RunningState(speed=speed, bearings=held)
    omega = 99 * abs(model.spins["test_pinion"]) * speed
    load = model.row("test_pinion_gear", "turn")
    rows = np.array([model.joint(gear.name, "spline").row("turn") for gear in model.rig.drivetrain.gears])
    lost = math.pi * eta * np.array([gear.stiffness for gear in model.rig.drivetrain.gears])
    reduced = reduce_rig(model, held, 20e3)
    for response, sight in (
        (full_matrices(model, state).response(load[:, None], omega)[:, 0], (load, rows)),
        (
            reduced.matrices(state).response(reduced.rows(load)[:, None], omega)[:, 0],
            (reduced.rows(load), reduced.rows(rows)),
        ),
    ):
        work = -math.pi * float((sight[0] @ response).imag)
        assert work == pytest.approx(float(lost @ np.abs(sight[1] @ response) ** 2), rel=1e-7)


def test_the_rigid_motions_of_the_elastic_rig_feel_no_friction() -> None:
    model = assemble_rig(frictional(0.5))
    reduced = reduce_rig(model, bearings(model.rig), 20e3)
    damping = reduced.matrices(RunningState(speed=1.0, bearings=bearings(model.rig))).damping
    assert not damping[: reduced.n_rigid].any() and not damping[:, : reduced.n_rigid].any()


def test_a_damper_and_a_loss_factor_exclude_each_other() -> None:
    train = two_inertias(0.05)
    with pytest.raises(DrivetrainError, match=r"damping = 3\.0 N m s/rad and loss_factor = 0\.05 exclude"):
        replace(train, gears=tuple(replace(gear, damping=3.0) for gear in train.gears))
