import math

import numpy as np
import pytest
from scipy.linalg import eigvals

from dynamics.rotor.assembly import assemble_rig
from dynamics.rotor.bearing_state import RowSpring, RunningState
from dynamics.rotor.craig_bampton import SeenRig, approach_row
from dynamics.rotor.damped_modes import damped_modes, mode_character, orbit
from dynamics.rotor.location import unresisted
from dynamics.rotor.reduction import reduce_rig
from dynamics.rotor.shaft import DrivetrainError, Section
from dynamics.rotor.torsional_modes import ModeShape, shaped_modes, tracked
from tests.builders.elastic_rig import bearings, prototype_rig, running, single_shaft
from tests.builders.full_matrices import full_matrices
from tests.builders.harmonic_response import Unbalance, receptance, unbalance_load

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
    character = mode_character(reduced, modes.shapes)
    assert character.share.sum(axis=(1, 2)) == pytest.approx(np.ones(modes.poles.size))
    assert np.abs(character.whirl).max() <= 1.0 + 1e-9
    assert "reference_wheel torsion" in character.names
    assert "test_pinion lateral forward" in character.names
    assert any(name.endswith("axial") for name in character.names)


def test_modes_followed_over_speed_are_those_of_a_rigid_rotor() -> None:
    """Drum on soft bearings: conical modes part from each other through the crossing with the parallel pair.

    (I_t w^2 -+ I_p Omega w - k L^2 / 2) = 0 (closed form of a rigid rotor), followed by shape from end to end.
    """
    stiffness, length = 1e4, 0.3
    rig = single_shaft(DRUM, (0.0, length), 0.05)
    held = bearings(rig, stiffness, 5.0)
    seen = SeenRig(reduced=reduce_rig(assemble_rig(rig), held), ports={})
    mass = 7850.0 * 0.25 * math.pi * 0.2**2 * length
    polar = mass * 0.2**2 / 8.0
    across = 0.5 * polar + mass * length**2 / 12.0
    speeds = np.linspace(0.0, 120.0, 61)
    systems = [seen.system(RunningState(speed=speed, bearings=held)) for speed in speeds]
    found = [
        shaped_modes(system, (), lambda shape, energy: ModeShape(largest="", name="", energy={}), speed, 20.0)
        for system, speed in zip(systems, speeds)
    ]
    modes = tracked(found, systems[0].inertia)
    assert len(modes) == 4
    whirls = {}
    for system, at in zip(systems, found):
        own = np.linalg.solve(system.coordinates.freedoms, at.shapes)
        whirl = mode_character(seen.reduced, own).lateral_whirl(0.5)
        whirls.update(zip((id(mode) for mode in at.modes), whirl))
    ends = np.array([mode.modes[-1].frequency for mode in modes])  # type: ignore[union-attr]
    root = np.sqrt((polar * speeds) ** 2 + 2.0 * across * stiffness * length**2)
    for place, sign in zip(np.argsort(ends)[[0, -1]], (-1.0, 1.0)):
        exact = (sign * polar * speeds + root) / (2.0 * across) / (2.0 * math.pi)
        assert [mode.frequency for mode in modes[place].modes] == pytest.approx(exact, rel=1e-4)  # type: ignore[union-attr]
        sense = [whirls[id(mode)] for mode in modes[place].modes[5:]]
        assert sense == pytest.approx(sign * np.ones(56), abs=1e-2)


def test_a_mode_without_lateral_motion_has_no_whirl() -> None:
    model, state = meshed(1256.0)
    reduced = reduce_rig(model, state.bearings, 10e3)  # type: ignore[arg-type]
    character = mode_character(reduced, damped_modes(reduced, state, 4e3).shapes)
    for name, whirl in zip(character.names, character.lateral_whirl(0.5)):
        if name.endswith(("torsion", "axial")) or name == "housing":
            assert whirl is None
        if name.endswith("forward"):
            assert whirl is not None and whirl > 0.0


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
