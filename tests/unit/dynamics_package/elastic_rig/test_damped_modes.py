import math

import numpy as np
import pytest
from scipy.linalg import eigvals

from dynamics.drivetrain.shaft import DrivetrainError, Section
from dynamics.elastic_rig.assembly import assemble_rig
from dynamics.elastic_rig.campbell import campbell_diagram
from dynamics.elastic_rig.damped_modes import damped_modes, mode_character
from dynamics.elastic_rig.forced import Unbalance, orbit, receptance, unbalance_load
from dynamics.elastic_rig.location import unresisted
from dynamics.elastic_rig.mesh_rows import approach_row
from dynamics.elastic_rig.reduction import reduce_rig
from dynamics.elastic_rig.running_state import RowSpring, RunningState, full_matrices
from tests.builders.elastic_rig import bearings, prototype_rig, running, single_shaft

DRUM = (Section(length=0.3, outer_diameter=0.2),)
"""Short and thick: I_p below I_t, strong gyroscopics."""


def meshed(rig_speed: float, damping: float = 0.0) -> tuple[object, RunningState]:
    rig = prototype_rig(0.04)
    model = assemble_rig(rig)
    springs = tuple(
        RowSpring(row=approach_row(model, name), stiffness=k, damping=damping)
        for name, k in (("test", 1.14e8), ("reference", 7.09e8))
    )
    return model, RunningState(speed=rig_speed, bearings=bearings(rig), springs=springs)


@pytest.mark.parametrize("speed", [0.0, 1256.0])
def test_poles_are_those_of_the_whole_state_matrix(speed: float) -> None:
    """All freedoms in a companion matrix by a general solver; its double zero of the closed loop is left out."""
    model, state = meshed(speed, 500.0)
    full = full_matrices(model, state)  # type: ignore[arg-type]
    n = model.size  # type: ignore[attr-defined]
    inverse = np.linalg.inv(full.mass.toarray())
    companion = np.block(
        [
            [np.zeros((n, n)), 1e4 * np.eye(n)],
            [-inverse @ full.stiffness.toarray() / 1e4, -inverse @ full.damping.toarray()],
        ]
    )
    theirs = eigvals(companion)
    ours = damped_modes(reduce_rig(model, state.bearings), state, 15e3).poles  # type: ignore[arg-type]
    for pole in ours[ours.imag > 1.0]:
        assert np.abs(theirs - pole).min() < 1e-6 * abs(pole)


def test_closed_loop_keeps_one_rigid_turn_with_a_pole_of_exactly_zero() -> None:
    model, state = meshed(0.0)
    modes = damped_modes(reduce_rig(model, state.bearings), state)  # type: ignore[arg-type]
    assert modes.real_poles[0] == 0.0
    assert np.count_nonzero(modes.real_poles == 0.0) == 1


def test_decrement_ratio_and_amplification_agree() -> None:
    model, state = meshed(300.0)
    modes = damped_modes(reduce_rig(model, state.bearings), state, 5e3)  # type: ignore[arg-type]
    ratio = modes.damping_ratio
    assert modes.logarithmic_decrement == pytest.approx(2.0 * math.pi * ratio / np.sqrt(1.0 - ratio**2))
    assert modes.amplification[ratio > 1e-9] == pytest.approx(0.5 / ratio[ratio > 1e-9])


def test_names_and_shares_tell_where_a_mode_moves() -> None:
    model, state = meshed(1256.0)
    reduced = reduce_rig(model, state.bearings, 10e3)  # type: ignore[arg-type]
    modes = damped_modes(reduced, state, 4e3)
    character = mode_character(reduced, modes)
    assert character.share.sum(axis=(1, 2)) == pytest.approx(np.ones(modes.poles.size))
    assert np.abs(character.whirl).max() <= 1.0 + 1e-9
    assert "reference_wheel torsion" in character.names
    assert "test_pinion lateral forward" in character.names
    assert any(name.endswith("axial") for name in character.names)


def test_campbell_follows_modes_through_crossings_and_finds_the_critical_speed() -> None:
    """Drum on soft bearings: conical modes part from each other; order 1 meets the forward one at
    s^2 = k L^2 / (2 (I_t - I_p)) (closed form of a rigid rotor)."""
    stiffness, length = 1e4, 0.3
    rig = single_shaft(DRUM, (0.0, length), 0.05)
    held = bearings(rig, stiffness, 5.0)
    reduced = reduce_rig(assemble_rig(rig), held)
    mass = 7850.0 * 0.25 * math.pi * 0.2**2 * length
    polar = mass * 0.2**2 / 8.0
    across = 0.5 * polar + mass * length**2 / 12.0
    critical = math.sqrt(0.5 * stiffness * length**2 / (across - polar))
    found = campbell_diagram(
        reduced, lambda speed: RunningState(speed=speed, bearings=held), np.linspace(0.0, 120.0, 61), 20.0
    )
    assert found.frequency.shape == (61, 4)
    conical = np.argsort(found.frequency[-1])[[0, -1]]
    assert [found.names[k] for k in conical] == ["rotor lateral backward", "rotor lateral forward"]
    for column, sign in zip(conical, (-1.0, 1.0)):
        root = np.sqrt((polar * found.speeds) ** 2 + 2.0 * across * stiffness * length**2)
        exact = (sign * polar * found.speeds + root) / (2.0 * across) / (2.0 * math.pi)
        # followed from end to end, through the crossing with the parallel pair
        assert found.frequency[:, column] == pytest.approx(exact, rel=1e-4)
        assert found.whirl[5:, column] == pytest.approx(sign * np.ones(56), abs=1e-2)
    crossing = [speed for _, speed, _ in found.crossings(1.0)]
    assert min(abs(speed / critical - 1.0) for speed in crossing) < 1e-3
    assert all(decrement > 0.0 for _, _, decrement in found.crossings(1.0))


def test_campbell_wants_ascending_speeds() -> None:
    rig = single_shaft(DRUM, (0.0, 0.3), 0.1)
    reduced = reduce_rig(assemble_rig(rig), bearings(rig))
    with pytest.raises(DrivetrainError, match="speeds must ascend"):
        campbell_diagram(reduced, lambda speed: running(rig, speed), np.array([10.0, 5.0]), 100.0)


def test_combinations_that_no_force_resists() -> None:
    """A spring between two turns leaves one combination of them."""
    ratio = np.array([0.05, -0.06])
    forces = np.outer([1.0, 2.0, 0.5], ratio) * 1e8
    free = unresisted(forces)
    assert free.shape == (2, 1)
    assert ratio @ free[:, 0] == pytest.approx(0.0, abs=1e-15)
    assert unresisted(np.zeros((3, 2))).shape == (2, 2)
    assert unresisted(np.zeros((3, 0))).shape == (0, 0)


@pytest.mark.parametrize(
    ("across", "up", "expected"),
    [
        (2.0, -2.0j, (2.0, 2.0, None)),
        (2.0, 2.0j, (2.0, -2.0, None)),
        (3.0, 0.0, (3.0, 0.0, 0.0)),
        (1.0, 1.0, (math.sqrt(2.0), 0.0, 0.25 * math.pi)),
        (3.0, -1.0j, (3.0, 1.0, 0.0)),
    ],
)
def test_orbits(across: complex, up: complex, expected: tuple[float, float, float | None]) -> None:
    found = orbit(across, up)
    assert (found.major, found.minor) == pytest.approx(expected[:2])
    if expected[2] is not None:
        assert found.angle == pytest.approx(expected[2])
    mirrored = orbit(across, up, -1.0)
    assert mirrored.minor == pytest.approx(-found.minor)


def test_unbalance_of_two_speeds_is_no_one_response() -> None:
    model = assemble_rig(prototype_rig(0.05))
    both = tuple(Unbalance(place=f"test_{gear}_gear", moment=1e-5) for gear in ("pinion", "wheel"))
    with pytest.raises(DrivetrainError, match=r"speeds .* must be equal"):
        unbalance_load(model, both, 100.0)
    load, frequency = unbalance_load(model, both[:1], 100.0)
    assert frequency == pytest.approx(100.0 * 102.0 / 99.0)
    force = model.rows("test_pinion_gear") @ load
    assert np.abs(force[1:3]) == pytest.approx([1e-5 * frequency**2] * 2)
    assert force[1] / force[2] == pytest.approx(1.0j)


def test_receptance_wants_a_frequency() -> None:
    model = assemble_rig(prototype_rig(0.05))
    full = full_matrices(model, running(model.rig))
    with pytest.raises(DrivetrainError, match=r"lowest frequency = 0\.0 rad/s"):
        receptance(full, model.rows("motor"), np.array([0.0, 1.0]))
