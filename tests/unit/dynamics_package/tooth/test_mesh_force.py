"""Mesh forces: one potential, tangents, friction, damping, tooth identity."""

from typing import get_args

import numpy as np
import pytest

from dynamics.tooth.law import DampedRate, MeshLaw, check_mesh_law
from dynamics.tooth.mesh_force import evaluate_mesh, pack_meshes, tooth_forces
from tests.builders.mesh import BASE_PITCH, BASE_RADIUS_1, BASE_RADIUS_2, spur_law

HELIX = {"n_slices": 7, "contact_ratio": 1.448, "span": 11.6e-3}
STATES = np.random.default_rng(7)
THETA = STATES.uniform(0.0, 3.0, 400)
APPROACH = np.concatenate((STATES.uniform(5e-6, 5e-5, 300), STATES.uniform(-1.6e-4, -1.1e-4, 100)))


def individual(law: MeshLaw) -> MeshLaw:
    """The same law with teeth that are individual but equal."""
    return law._replace(scale_1=np.full(law.teeth_1, 1.0 + 1e-15))


@pytest.mark.parametrize("law", [spur_law(), spur_law(**HELIX), individual(spur_law(**HELIX))])
def test_torques_are_the_gradient_of_the_contact_energy(law: MeshLaw) -> None:
    here = evaluate_mesh(law, THETA, APPROACH, 0.0, 0.0)
    h = 1e-9

    def energy(d_1: float, d_2: float) -> np.ndarray:
        x = APPROACH + BASE_RADIUS_1 * d_1 - BASE_RADIUS_2 * d_2
        return evaluate_mesh(law, THETA + d_1, x, 0.0, 0.0).energy

    slope_1 = (energy(h, 0.0) - energy(-h, 0.0)) / (2.0 * h)
    slope_2 = (energy(0.0, h) - energy(0.0, -h)) / (2.0 * h)
    largest = np.abs(here.torque_1).max()
    np.testing.assert_allclose(-slope_1, here.torque_1, atol=1e-6 * largest)
    np.testing.assert_allclose(-slope_2, here.torque_2, atol=1e-6 * largest)
    assert np.abs(here.torque_1 + BASE_RADIUS_1 * (here.force_front - here.force_back)).max() > 1e-3 * largest


CLOSING = {"damping_acts_on": "contact_closing_rate"}
RATES = pytest.mark.parametrize("acts_on", get_args(DampedRate))


@RATES
@pytest.mark.parametrize("law", [spur_law(damping=1e3, friction=0.05), individual(spur_law(damping=1e3))])
def test_tangents_are_the_derivatives_of_the_torques(law: MeshLaw, acts_on: DampedRate) -> None:
    law = law._replace(damping_acts_on=acts_on)
    w_1, w_2 = 100.0, 100.0 * BASE_RADIUS_1 / BASE_RADIUS_2 - 0.05
    here = evaluate_mesh(law, THETA, APPROACH, w_1, w_2)
    largest = np.abs(here.torque_1_per_approach).max()
    h = 1e-10
    for sign, field in ((1, "torque_1"), (2, "torque_2")):
        high = getattr(evaluate_mesh(law, THETA, APPROACH + h, w_1, w_2), field)
        low = getattr(evaluate_mesh(law, THETA, APPROACH - h, w_1, w_2), field)
        difference = np.abs((high - low) / (2 * h) - getattr(here, f"torque_{sign}_per_approach"))
        assert np.mean(difference > 1e-4 * largest) < 0.01  # contacts that open within the difference
    # the direction of friction is held in the tangents, so it is left out here
    rate, law = 1e-6, law._replace(friction=0.0)
    here = evaluate_mesh(law, THETA, APPROACH, w_1, w_2)
    faster = evaluate_mesh(law, THETA, APPROACH, w_1, w_2 - rate / BASE_RADIUS_2).torque_2
    slope = (faster - here.torque_2) / rate
    np.testing.assert_allclose(slope, here.torque_2_per_rate, atol=2e-3 * np.abs(slope).max())
    # where the wheel alone moves the path stands still, so that both torques answer to the rate alone
    slope = (
        evaluate_mesh(law, THETA, APPROACH, w_1, w_2 - rate / BASE_RADIUS_2).torque_1 - here.torque_1
    ) / rate
    np.testing.assert_allclose(slope, here.torque_1_per_rate, atol=2e-3 * np.abs(slope).max())


def uneven(law: MeshLaw) -> MeshLaw:
    """The same law with teeth of the wheel that differ in shape and stiffness, in front and behind."""
    rng = np.random.default_rng(3)
    place = np.linspace(-1.0, 1.0, law.gap.shape[1])
    wave, steep = rng.normal(size=(2, law.teeth_2, 1))
    shape = 1e-6 * (wave * np.cos(3.0 * place) + steep * place**2)
    scale = 1.0 + 0.1 * rng.uniform(size=law.teeth_2)
    return law._replace(deviation_2=shape, back_deviation_2=0.5 * shape, scale_2=scale)


@RATES
@pytest.mark.parametrize("alike", [True, False])
@pytest.mark.parametrize("friction", [0.0, 0.05])
@pytest.mark.parametrize(("damping", "off"), [(0.0, 0.0), (1e3, -0.3)])
def test_angle_tangent_holds_approach_rate_and_speeds(
    friction: float, damping: float, off: float, alike: bool, acts_on: DampedRate
) -> None:
    """Also of what both torques leave for the common rotation, where the curvature of gap and stiffness is most."""
    law = spur_law(**HELIX, damping=damping, friction=friction, damping_acts_on=acts_on)
    law = law if alike else uneven(law)
    w_1, w_2 = 100.0, 100.0 * BASE_RADIUS_1 / BASE_RADIUS_2 + off
    h = 1e-8
    here, high, low = (evaluate_mesh(law, THETA + d, APPROACH, w_1, w_2) for d in (0.0, h, -h))
    for share in ((1.0, 0.0), (0.0, 1.0), (1.0 / BASE_RADIUS_1, 1.0 / BASE_RADIUS_2)):
        after, before = (share[0] * one.torque_1 + share[1] * one.torque_2 for one in (high, low))
        slope = (after - before) / (2.0 * h)
        tangent = share[0] * here.torque_1_per_angle + share[1] * here.torque_2_per_angle
        assert np.median(np.abs(slope - tangent)) < 1e-6 * np.abs(slope).max()
        assert np.mean(np.abs(slope - tangent) > 1e-3 * np.abs(slope).max()) < 0.02


@RATES
def test_mesh_power_is_friction_damping_and_stored_energy(acts_on: DampedRate) -> None:
    law = spur_law(damping=1e3, friction=0.05, damping_acts_on=acts_on)
    w_1 = np.full_like(THETA, 120.0)
    w_2 = w_1 * BASE_RADIUS_1 / BASE_RADIUS_2 + STATES.normal(size=len(THETA))
    rate = BASE_RADIUS_1 * w_1 - BASE_RADIUS_2 * w_2
    here = evaluate_mesh(law, THETA, APPROACH, w_1, w_2)
    t = 1e-10
    ahead = evaluate_mesh(law, THETA + w_1 * t, APPROACH + rate * t, 0.0, 0.0).energy
    behind = evaluate_mesh(law, THETA - w_1 * t, APPROACH - rate * t, 0.0, 0.0).energy
    given = -(here.torque_1 * w_1 + here.torque_2 * w_2)
    taken = (ahead - behind) / (2 * t) + here.friction_power + here.damping_power
    np.testing.assert_allclose(given, taken, atol=1e-5 * np.abs(given).max())
    assert here.friction_power.min() >= 0.0
    assert here.damping_power.min() >= 0.0
    assert here.friction_power.max() > 1.0
    assert here.damping_power.max() > 1.0


def test_flanks_that_roll_off_steadily_lose_nothing_in_a_damper_on_the_relative_rotation() -> None:
    # both gears at constant speed: the approach stays, the tip corners come in and go out with the gap
    law = spur_law(n_slices=1, damping=1e3)
    theta = np.linspace(0.0, 2.0 * np.pi / law.teeth_1, 200, endpoint=False)
    w_1, w_2 = 1256.6, 1256.6 * BASE_RADIUS_1 / BASE_RADIUS_2
    rotation = evaluate_mesh(law, theta, 4e-5, w_1, w_2)
    elastic = evaluate_mesh(law._replace(damping=0.0), theta, 4e-5, w_1, w_2)
    assert np.abs(rotation.damping_power).max() < 1e-20
    np.testing.assert_allclose(rotation.torque_1, elastic.torque_1, rtol=1e-12)
    closing = evaluate_mesh(law._replace(**CLOSING), theta, 4e-5, w_1, w_2)
    slope = np.gradient(law.gap[0], law.path_step)
    place = (law.phase + BASE_RADIUS_1 * theta)[:, None] + BASE_PITCH * np.arange(-2, 3)
    gap, e, k = (
        np.interp(place, law.path_start + law.path_step * np.arange(slope.size), table, right=0.0, left=0.0)
        for table in (law.gap[0], slope, law.stiffness[0])
    )
    rate, depth = -e * BASE_RADIUS_1 * w_1, np.maximum(4e-5 - gap, 0.0)
    share = law.damping / law.mean_stiffness * np.minimum(depth / law.damping_depth, 1.0)
    by_hand = (k * np.maximum(share * rate, -depth) * rate).sum(axis=1)  # flanks do not pull
    assert closing.damping_power.mean() == pytest.approx(by_hand.mean(), rel=0.01)
    assert closing.damping_power.mean() > 20.0


@RATES
def test_damper_torques_do_the_work_that_is_booked(acts_on: DampedRate) -> None:
    law = spur_law(n_slices=1, damping=1e3, damping_acts_on=acts_on)
    w_1 = 1256.6
    w_2 = w_1 * BASE_RADIUS_1 / BASE_RADIUS_2 + STATES.normal(size=len(THETA)) * 0.5
    damped = evaluate_mesh(law, THETA, APPROACH, w_1, w_2)
    elastic = evaluate_mesh(law._replace(damping=0.0), THETA, APPROACH, w_1, w_2)
    taken = (elastic.torque_1 - damped.torque_1) * w_1 + (elastic.torque_2 - damped.torque_2) * w_2
    np.testing.assert_allclose(taken, damped.damping_power, atol=1e-9 * damped.damping_power.max())
    assert damped.damping_power.min() >= 0.0


def test_friction_reverses_with_the_direction_of_rotation() -> None:
    law, smooth = spur_law(friction=0.05), spur_law()
    ratio = BASE_RADIUS_1 / BASE_RADIUS_2
    theta, x = np.linspace(0.0, 0.2, 50), np.full(50, 3e-5)
    bare = evaluate_mesh(smooth, theta, x, 0.0, 0.0).torque_1
    forward = evaluate_mesh(law, theta, x, 100.0, 100.0 * ratio).torque_1 - bare
    backward = evaluate_mesh(law, theta, x, -100.0, -100.0 * ratio).torque_1 - bare
    np.testing.assert_allclose(forward, -backward, atol=1e-9)
    assert np.abs(forward).max() > 0.5


def test_friction_changes_sign_at_the_pitch_point() -> None:
    # recess brakes the pinion, approach helps it: s > 0 and s < 0 with equal radii of curvature at C
    law = spur_law(n_slices=1, friction=0.05)
    law = law._replace(rolling_radius_2=law.rolling_radius_1 * law.teeth_2 / law.teeth_1)
    ratio = BASE_RADIUS_1 / BASE_RADIUS_2
    for place, brakes in ((0.1 * BASE_PITCH, True), (-0.1 * BASE_PITCH, False)):
        theta = place / BASE_RADIUS_1
        with_friction = evaluate_mesh(law, theta, 1e-5, 200.0, 200.0 * ratio)
        without = evaluate_mesh(law._replace(friction=0.0), theta, 1e-5, 200.0, 200.0 * ratio)
        assert (with_friction.torque_1[0] < without.torque_1[0]) == brakes


def test_contacts_never_pull() -> None:
    law = spur_law(damping=1e5)
    separating = evaluate_mesh(law, 0.0, 1e-5, 0.0, 10.0)
    assert separating.force_front[0] == 0.0
    assert evaluate_mesh(law, 0.0, 1e-5, 0.0, 0.0).force_front[0] > 0.0


def test_touching_with_speed_starts_at_zero_force() -> None:
    law = spur_law(n_slices=1, damping=1e3)
    touch = float(law.gap.min())
    forces = evaluate_mesh(law, 0.0, touch + np.array([1e-12, 1e-9, 1e-6]), 0.0, -1.0).force_front
    assert forces[0] < 1e-2
    assert forces[2] > 1.0
    assert np.all(np.diff(forces) > 0.0)


def test_open_mesh_between_the_flanks() -> None:
    middle = evaluate_mesh(spur_law(damping=1e3, friction=0.1), THETA, -50e-6, 10.0, 9.0)
    assert not np.any(middle.force_front) and not np.any(middle.force_back)
    assert not np.any(middle.torque_1) and not np.any(middle.torque_2)


def test_back_flank_turns_the_torques_round() -> None:
    back = evaluate_mesh(spur_law(), 0.1, -1.3e-4, 0.0, 0.0)
    assert back.force_back[0] > 0.0 and back.force_front[0] == 0.0
    assert back.torque_1[0] > 0.0 and back.torque_2[0] < 0.0


def test_tooth_forces_add_up_to_the_mesh_and_keep_their_names() -> None:
    law = spur_law(**HELIX, damping=500.0)
    theta = np.linspace(0.0, 0.5, 300)
    w_1, w_2 = 100.0, 100.0 * BASE_RADIUS_1 / BASE_RADIUS_2 - 0.02
    total = evaluate_mesh(individual(law), theta, 3e-5, w_1, w_2)
    teeth = tooth_forces(law, theta, 3e-5, w_1, w_2)
    np.testing.assert_allclose(teeth.front.sum(axis=(1, 2)), total.force_front, rtol=1e-12)
    assert teeth.front.shape[2] == 7
    path, force = teeth.of_pair(3)
    assert np.all(np.diff(path) > 0.0)
    assert force.max() > 0.2 * total.force_front.max()
    expected = law.phase + BASE_RADIUS_1 * theta[0] - teeth.pair[0] * BASE_PITCH
    np.testing.assert_allclose(teeth.path[0], expected, atol=1e-15)


def test_back_flank_tooth_forces_add_up() -> None:
    law = spur_law(**HELIX)
    teeth = tooth_forces(law, THETA, -1.35e-4)
    total = evaluate_mesh(individual(law), THETA, -1.35e-4, 0.0, 0.0)
    np.testing.assert_allclose(teeth.back.sum(axis=(1, 2)), total.force_back, rtol=1e-12)


def test_equal_teeth_give_the_same_by_phase_and_on_the_path() -> None:
    law = spur_law(**HELIX, damping=500.0, friction=0.04)
    w_1, w_2 = 100.0, 100.0 * BASE_RADIUS_1 / BASE_RADIUS_2
    by_phase = evaluate_mesh(law, THETA, APPROACH, w_1, w_2)
    on_path = evaluate_mesh(individual(law), THETA, APPROACH, w_1, w_2)
    for field in ("torque_1", "torque_2", "force_front", "force_back", "friction_power", "energy"):
        a, b = getattr(by_phase, field), getattr(on_path, field)
        assert np.abs(a - b).max() < 1e-3 * np.abs(b).max(), field


def test_one_stiff_tooth_meets_once_per_turn_and_with_its_mate() -> None:
    stiff = np.ones(99)
    stiff[5] = 1.5
    law = spur_law(n_slices=1, scale_1=stiff)
    at_tooth = (np.arange(0, 200) * BASE_PITCH) / BASE_RADIUS_1
    force = evaluate_mesh(law, at_tooth, 1e-5, 0.0, 0.0).force_front
    np.testing.assert_array_equal(np.flatnonzero(force > 1.2 * np.median(force)), [5, 104])
    deviation = np.zeros((102, law.stiffness.shape[1]))
    deviation[7] = 4e-6
    law = spur_law(n_slices=1, deviation_2=deviation, tooth_offset_2=3)
    force = evaluate_mesh(law, at_tooth, 1e-5, 0.0, 0.0).force_front
    np.testing.assert_array_equal(np.flatnonzero(force < 0.9 * np.median(force)), [4, 106])


def test_packing_twice_gives_the_same_bytes() -> None:
    a, b = pack_meshes([spur_law(**HELIX)]), pack_meshes([spur_law(**HELIX)])
    assert all(np.array_equal(x, y) for x, y in zip(a, b))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"base_radius_1": 0.0}, "base_radius_1"),
        ({"friction": -0.1}, "friction"),
        ({"slice_shift": np.zeros(3)}, "slice_shift"),
        ({"scale_1": np.ones(7)}, "scale_1"),
        ({"deviation_1": np.full((1, 401), np.nan)}, "finite"),
        ({"back_deviation_1": np.full((1, 401), np.nan)}, "finite"),
        ({"back_deviation_2": np.zeros((102, 401))}, "back_deviation_2"),
    ],
)
def test_impossible_laws_are_refused_by_name(change: dict[str, object], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        check_mesh_law(spur_law(**change))
