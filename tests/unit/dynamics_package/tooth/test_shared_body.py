"""Tooth pairs on a body that all of them share: one potential, exact tangents, the same march."""

import numpy as np
import pytest

from dynamics.errors import DynamicsInputError
from dynamics.tooth.law import MeshLaw, check_mesh_law
from dynamics.tooth.mesh_force import evaluate_mesh, pack_meshes, tooth_forces
from dynamics.vibration.hill_system import Motion, pair_sensitivity
from tests.builders.mesh import BASE_PITCH, BASE_RADIUS_1, BASE_RADIUS_2, spur_law

BODY = 5e-9
HELIX = {"n_slices": 7, "contact_ratio": 1.448, "span": 11.6e-3}
STATES = np.random.default_rng(11)
THETA = STATES.uniform(0.0, 3.0, 400)
APPROACH = np.concatenate((STATES.uniform(5e-6, 7e-5, 300), STATES.uniform(-1.8e-4, -1.1e-4, 100)))


def shared(law: MeshLaw) -> MeshLaw:
    """The law on bodies that take a third of the approach."""
    return law._replace(body_compliance=BODY, mean_stiffness=1.0 / (1.0 / law.mean_stiffness + BODY))


def individual(law: MeshLaw) -> MeshLaw:
    """The same law with teeth that are individual but equal."""
    return law._replace(scale_1=np.full(law.teeth_1, law.scale_1[0] * (1.0 + 1e-15)))


def jammed(law: MeshLaw) -> MeshLaw:
    """Both flanks pressed at once near the middle of the play."""
    return law._replace(backlash=0.0, gap=law.gap - 30e-6)


LAWS = [
    shared(spur_law()),
    shared(spur_law(**HELIX)),
    shared(individual(spur_law(**HELIX))),
    shared(jammed(spur_law(**HELIX))),
    shared(individual(jammed(spur_law()))),
]
EVERY_LAW = pytest.mark.parametrize("law", LAWS)


def approaches(law: MeshLaw) -> np.ndarray:
    """States on both flanks, or about the middle of jammed teeth."""
    return APPROACH if law.backlash else np.linspace(-9e-5, 9e-5, THETA.size)


@EVERY_LAW
def test_tooth_approach_is_what_the_body_leaves(law: MeshLaw) -> None:
    reaction = evaluate_mesh(law, THETA, approaches(law), 0.0, 0.0)
    given = BODY * (reaction.force_front - reaction.force_back)
    np.testing.assert_allclose(reaction.tooth_approach, approaches(law) - given, atol=1e-18, rtol=1e-13)
    assert np.abs(given).max() > 0.1 * np.abs(approaches(law)).max()


@EVERY_LAW
def test_force_is_that_of_the_pairs_in_series_with_the_body(law: MeshLaw) -> None:
    """P = sum k (x - g) / (1 + c_b sum k) over the pairs that touch, read from the same pairs without the body."""
    reaction = evaluate_mesh(law, THETA, approaches(law), 0.0, 0.0)
    alone = evaluate_mesh(law._replace(body_compliance=0.0), THETA, reaction.tooth_approach, 0.0, 0.0)
    stiffness = alone.torque_2_per_approach / BASE_RADIUS_2
    force = alone.force_front - alone.force_back
    at_x = force + stiffness * (approaches(law) - reaction.tooth_approach)
    np.testing.assert_allclose(
        reaction.force_front - reaction.force_back,
        at_x / (1.0 + BODY * stiffness),
        atol=1e-12 * np.abs(force).max(),
    )
    np.testing.assert_allclose(
        reaction.torque_2_per_approach, alone.torque_2_per_approach / (1.0 + BODY * stiffness), rtol=1e-12
    )


@EVERY_LAW
def test_torques_are_the_gradient_of_teeth_and_body_together(law: MeshLaw) -> None:
    here = evaluate_mesh(law, THETA, approaches(law), 0.0, 0.0)
    h = 1e-9

    def energy(d_1: float, d_2: float) -> np.ndarray:
        x = approaches(law) + BASE_RADIUS_1 * d_1 - BASE_RADIUS_2 * d_2
        return evaluate_mesh(law, THETA + d_1, x, 0.0, 0.0).energy

    slope_1 = (energy(h, 0.0) - energy(-h, 0.0)) / (2.0 * h)
    slope_2 = (energy(0.0, h) - energy(0.0, -h)) / (2.0 * h)
    largest = np.abs(here.torque_1).max()
    np.testing.assert_allclose(-slope_1, here.torque_1, atol=1e-6 * largest)
    np.testing.assert_allclose(-slope_2, here.torque_2, atol=1e-6 * largest)


@EVERY_LAW
def test_tangents_are_the_derivatives_of_the_torques(law: MeshLaw) -> None:
    law = law._replace(damping=1e3)
    speeds = 100.0, 100.0 * BASE_RADIUS_1 / BASE_RADIUS_2 - 0.05
    states = THETA, approaches(law)
    here = evaluate_mesh(law, *states, *speeds)
    x, turn, rate = 1e-10, 1e-8, 1e-6
    for gear, step, moved, name in (
        ("torque_1", x, (0.0, x, 0.0), "approach"),
        ("torque_2", x, (0.0, x, 0.0), "approach"),
        ("torque_1", turn, (turn, 0.0, 0.0), "angle"),
        ("torque_2", turn, (turn, 0.0, 0.0), "angle"),
        ("torque_1", rate, (0.0, 0.0, -rate / BASE_RADIUS_2), "rate"),
        ("torque_2", rate, (0.0, 0.0, -rate / BASE_RADIUS_2), "rate"),
    ):
        high, low = (
            getattr(
                evaluate_mesh(
                    law, THETA + s * moved[0], states[1] + s * moved[1], speeds[0], speeds[1] + s * moved[2]
                ),
                gear,
            )
            for s in (1.0, -1.0)
        )
        slope = (high - low) / (2.0 * step)
        off = np.abs(slope - getattr(here, f"{gear}_per_{name}"))
        assert np.mean(off > 1e-3 * np.abs(slope).max()) < 0.02  # contacts that open in between


@EVERY_LAW
def test_single_teeth_add_up(law: MeshLaw) -> None:
    forces = tooth_forces(law, THETA, approaches(law))
    reaction = evaluate_mesh(individual(law), THETA, approaches(law), 0.0, 0.0)
    largest = reaction.force_front.max()
    np.testing.assert_allclose(forces.front.sum(axis=(1, 2)), reaction.force_front, atol=1e-9 * largest)
    np.testing.assert_allclose(forces.back.sum(axis=(1, 2)), reaction.force_back, atol=1e-9 * largest)


def test_a_loaded_tooth_keeps_the_next_one_away() -> None:
    """The same approach of the teeth needs a larger one of the gears, and no pair that was open without load closes."""
    law = spur_law()
    theta = np.linspace(0.0, BASE_PITCH / BASE_RADIUS_1, 50)
    alone, together = (tooth_forces(one, theta, 3e-5) for one in (law, shared(law)))
    assert (together.front > 0.0).sum() < (alone.front > 0.0).sum()
    assert np.all(together.front <= alone.front)


@pytest.mark.parametrize("back", [False, True])
def test_what_single_teeth_do_to_the_torques_includes_the_body(back: bool) -> None:
    law = shared(spur_law(n_slices=3, damping=1e3, friction=0.05))
    angle = np.linspace(0.0, 2.0 * BASE_PITCH / BASE_RADIUS_1, 60)
    motion = Motion(angle, np.full(60, -1.6e-4 if back else 4e-5), np.full(60, 800.0), np.full(60, 776.0))
    found = pair_sensitivity(law, pack_meshes([law]), motion, back=back)
    assert found is not None
    # all pairs deviate alike: a narrower approach of the gears by so much, or stiffer teeth
    n_path, h = law.stiffness.shape[1], 1e-10
    for change, expected in (
        (law._replace(gap=law.gap + h), [np.asarray(table.sum(axis=1)).ravel() for table in found.gap]),
        (
            law._replace(scale_1=np.full(1, 1.0 + 1e-7)),
            [table.ravel() for table in found.scale],
        ),
    ):
        step = h if change.scale_1[0] == 1.0 else 1e-7
        here, there = (evaluate_mesh(individual(one), *motion) for one in (law, change))
        for output, field in ((0, "torque_1"), (1, "torque_2")):
            slope = (getattr(there, field) - getattr(here, field)) / step
            total = expected[output].reshape(found.pairs, 60).sum(axis=0)
            off = np.abs(slope - total)
            assert np.mean(off > 1e-2 * np.abs(slope).max()) < 0.05
    assert found.gap[0].shape[1] == n_path


@pytest.mark.parametrize("compliance", [-1e-9, np.nan, 1.0 / 1.1e8])
def test_a_body_softer_than_the_mesh_is_refused(compliance: float) -> None:
    with pytest.raises(DynamicsInputError, match="body_compliance"):
        check_mesh_law(spur_law(body_compliance=compliance))
