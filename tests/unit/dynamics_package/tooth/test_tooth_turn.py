"""Stress of a tooth over a turn: put together from its meshes, symmetric where they are opposite."""

import numpy as np
import pytest

from dynamics.tooth.root_field import ToothPass, pitches_apart, tooth_turn

RADIUS, PITCH = 0.1, 2.0 * np.pi / 45


def course(n: int = 301) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rotation, stress under the loaded flank at two points and three face positions, stress behind it."""
    angle = np.linspace(-1.5 * PITCH, 1.5 * PITCH, n)
    shape = np.array([[0.8, 0.9, 0.7], [0.9, 1.0, 0.85]])
    under = (600e6 * np.exp(-(((angle - 0.2 * PITCH) / (0.4 * PITCH)) ** 2)) - 30e6 * (angle < -PITCH))[
        :, None, None
    ]
    behind = -500e6 * np.exp(-(((angle - 0.25 * PITCH) / (0.4 * PITCH)) ** 2))[:, None, None]
    return angle, under * shape, behind * shape


def idler(apart: float = np.pi) -> tuple[ToothPass, ToothPass]:
    """Driven on the trailing flank by one gear, driving another with the leading one, both with the same forces.

    The contact runs from tip to root in one and from root to tip in the other.
    """
    angle, under, behind = course()
    return (
        ToothPass(angle=angle, loaded="leading", leading=under, trailing=behind),
        ToothPass(angle=apart - angle[::-1], loaded="trailing", leading=behind[::-1], trailing=under[::-1]),
    )


def test_an_idler_between_two_opposite_gears_is_stressed_alike_in_both_fillets() -> None:
    """Mirrored in the turn: trailing flank at half a turn less the angle as the leading flank at the angle."""
    turn = tooth_turn(idler())
    assert turn.leading.max() == pytest.approx(turn.trailing.max())
    assert turn.leading.min() == pytest.approx(turn.trailing.min())
    mirrored = np.interp(np.mod(np.pi - turn.angle, 2.0 * np.pi), turn.angle, turn.trailing)
    np.testing.assert_allclose(mirrored, turn.leading, atol=2e-3 * turn.leading.max())
    assert turn.leading.min() / turn.leading.max() == pytest.approx(-500.0 / 600.0, rel=2e-3)


def test_the_tooth_is_free_between_its_meshes() -> None:
    turn = tooth_turn(idler())
    between = (turn.angle > 2.0 * PITCH) & (turn.angle < np.pi - 2.0 * PITCH)
    assert not turn.leading[between].any() and not turn.trailing[between].any()
    at_highest = turn.angle[turn.leading.argmax()]
    assert at_highest == pytest.approx(0.2 * PITCH, abs=0.02 * PITCH)
    assert turn.angle[turn.trailing.argmax()] == pytest.approx(np.pi - 0.2 * PITCH, abs=0.02 * PITCH)


def test_one_mesh_leaves_the_other_fillet_under_compression_alone() -> None:
    angle, under, behind = course()
    turn = tooth_turn([ToothPass(angle=angle, loaded="leading", leading=under, trailing=behind)])
    assert turn.trailing.max() == 0.0
    # at the point of the fillet that is under tension
    assert turn.trailing.min() == pytest.approx(behind[:, 1, 1].min(), rel=1e-3)
    assert (turn.leading.min(), turn.leading.max()) == pytest.approx((-30e6, 600e6), rel=0.03)


def test_a_tooth_loaded_twice_on_one_flank_keeps_both_passes() -> None:
    angle, under, behind = course()
    turn = tooth_turn(
        [
            ToothPass(angle=angle, loaded="leading", leading=under, trailing=behind),
            ToothPass(angle=np.pi + angle, loaded="leading", leading=0.5 * under, trailing=0.5 * behind),
        ]
    )
    late = turn.angle > 0.5 * np.pi
    late &= turn.angle < 1.5 * np.pi
    assert turn.leading[late].max() == pytest.approx(300e6, rel=1e-3)
    assert turn.leading.min() > -40e6


def test_a_turn_needs_a_mesh() -> None:
    with pytest.raises(ValueError, match="at least one"):
        tooth_turn([])


@pytest.mark.parametrize("whole", [-7, 0, 22, 45])
def test_teeth_decide_the_fraction_of_a_pitch_and_the_axes_the_whole_pitches(whole: int) -> None:
    fine = np.pi + 0.31 * PITCH + whole * PITCH
    assert pitches_apart(np.pi, fine, PITCH) == pytest.approx(np.pi + 0.31 * PITCH)
