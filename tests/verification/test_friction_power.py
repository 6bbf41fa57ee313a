"""One source for friction: the power the mesh kernel takes from the shafts is the loss that heats the box."""

import math

import numpy as np
import pytest

from dynamics.gear.pair import GearPair
from dynamics.losses.mesh_loss import mesh_loss
from dynamics.tooth.friction import GivenFriction, ToothPath, friction_coefficient
from dynamics.tooth.mesh_force import evaluate_mesh, tooth_forces
from dynamics.tooth.mesh_laws import ContactDiscretisation, MeshDissipation, mesh_law, pair_stiffness
from tests.builders.p2_gears import helical_pair, spur_pair

OMEGA = 12000 * math.pi / 30
FRICTION = 0.04
TORQUE = 180.0
PAIRS = {
    "spur, pitch point outside": spur_pair(),
    "helical": helical_pair(),
}


@pytest.fixture(params=list(PAIRS), ids=list(PAIRS))
def pair(request: pytest.FixtureRequest) -> GearPair:
    return PAIRS[request.param]


def sliding_speed(path: ToothPath, position: np.ndarray, omega_1: float, omega_2: float) -> np.ndarray:
    """v_g = omega_1 rho_1 - omega_2 rho_2 [m/s], rho_1 = T1C + s, rho_2 = T2C - s."""
    ratio = math.tan(path.working_pressure_angle)
    return omega_1 * (path.base_radius_1 * ratio + position) - omega_2 * (
        path.base_radius_2 * ratio - position
    )


def law_and_states(pair: GearPair, torque: float = TORQUE):
    """Mesh law with friction, and one base pitch of pinion angles at constant load (elastic, no friction)."""
    path = ToothPath.of_pair(pair)
    stiffness = pair_stiffness(pair, torque / pair.base_radii[0] / pair.face_width)
    law = mesh_law(
        pair,
        stiffness=stiffness,
        dissipation=MeshDissipation(friction=path.transverse_friction(FRICTION)),
        discretisation=ContactDiscretisation(n_slices=24),
    )
    theta = (np.arange(200) + 0.5) / 200 * law.base_pitch / law.base_radius_1
    low, high = np.zeros(200), np.full(200, 1e-4)
    for _ in range(50):
        approach = 0.5 * (low + high)
        heavy = evaluate_mesh(law, theta, approach, 0.0, 0.0).force_front > torque / law.base_radius_1
        low, high = np.where(heavy, low, approach), np.where(heavy, approach, high)
    return path, stiffness, law, theta, approach


def test_kernel_and_loss_integral_count_the_same_power(pair: GearPair) -> None:
    path, _, law, theta, approach = law_and_states(pair)
    omega_2 = 0.999 * OMEGA * law.base_radius_1 / law.base_radius_2
    reaction = evaluate_mesh(law, theta, approach, OMEGA, omega_2)
    teeth = tooth_forces(law, theta, approach, OMEGA, omega_2)
    position = teeth.path[:, :, None] - law.slice_shift
    speed = sliding_speed(path, position, OMEGA, omega_2)
    ratio = np.clip(speed / law.friction_reversal_speed, -1.0, 1.0)
    direction = ratio * (1.5 - 0.5 * ratio**2)
    power = (path.transverse_friction(FRICTION) * teeth.front * direction * speed).sum(axis=(1, 2))
    assert power.min() > 0.0
    # teeth that are all alike are tabulated over the phase, a second interpolation of the same cubics
    assert reaction.friction_power.mean() == pytest.approx(power.mean(), rel=1e-4)
    single = law._replace(deviation_1=np.full((law.teeth_1, law.gap.shape[1]), 1e-30))
    exact = evaluate_mesh(single, theta, approach, OMEGA, omega_2)
    assert power == pytest.approx(exact.friction_power, rel=1e-9)


@pytest.mark.parametrize("torque", [180.0, 0.18])
def test_loaded_contact_against_the_loss_factor(pair: GearPair, torque: float) -> None:
    """At a thousandth of the load the teeth are rigid and mu H_V P is met. Under load contact reaches beyond
    A and E: more loss where both ends are far from the pitch point (helical), less where contact begins
    nearer to it than A (the spur pair rolls in recess only).
    """
    path, stiffness, law, theta, approach = law_and_states(pair, torque)
    omega_2 = OMEGA * law.base_radius_1 / law.base_radius_2
    reaction = evaluate_mesh(law, theta, approach, OMEGA, omega_2)
    assert reaction.force_front == pytest.approx(torque / law.base_radius_1, rel=1e-6)
    contact = path.contact(torque, OMEGA, reference_diameter_1=0.099, roughness=5e-7, viscosity=5e-3)
    friction = friction_coefficient(contact, GivenFriction(value=FRICTION))
    steady = mesh_loss("mesh", path, torque, OMEGA, friction, stiffness.at).power
    ratio = reaction.friction_power.mean() / steady
    if torque < 1.0:
        assert ratio == pytest.approx(1.0, abs=0.01)
    elif path.start > 0.0:
        assert 0.90 < ratio < 0.97
    else:
        assert 1.05 < ratio < 1.15
