"""Modes that cross keep their identity."""

from collections.abc import Sequence

import numpy as np

from dynamics.rotor.torsional_modes import LoopMode, ShapedModes, tracked


def mode(frequency: float, gain: float = 1.0) -> LoopMode:
    return LoopMode(frequency=frequency, damping_ratio=0.01, name="", energy={}, mesh_gain=np.array([gain]))


def at(speed: float, modes: Sequence[tuple[float, Sequence[float]]]) -> ShapedModes:
    """Modes with their shapes, sorted by frequency as solvers give them."""
    ordered = sorted(modes)
    return ShapedModes(
        speed=speed,
        modes=tuple(mode(frequency) for frequency, _ in ordered),
        shapes=np.array([shape for _, shape in ordered], complex).T,
    )


def test_modes_that_cross_are_followed_by_their_shapes() -> None:
    """One rises from 100 to 200 Hz, the other stays at 150 Hz."""
    found = [
        at(speed, [(rising, (1.0, 0.1)), (150.0, (-0.1, 1.0))])
        for speed, rising in ((1.0, 100.0), (2.0, 140.0), (3.0, 160.0), (4.0, 200.0))
    ]
    first, second = tracked(found, np.eye(2))
    assert [m.frequency for m in first.modes if m] == [100.0, 140.0, 160.0, 200.0]
    assert [m.frequency for m in second.modes if m] == [150.0] * 4


def test_the_inertia_weighs_the_shapes() -> None:
    """Shapes that are alike in their light freedom only are two modes."""
    found = [at(1.0, [(100.0, (1.0, 5.0))]), at(2.0, [(101.0, (-1.0, 5.0))])]
    assert len(tracked(found, np.diag([1.0, 1.0]))) == 1
    assert len(tracked(found, np.diag([25.0, 1.0]))) == 2


def test_a_mode_that_leaves_the_range_has_none_there() -> None:
    found = [at(1.0, [(100.0, (1.0, 0.0)), (200.0, (0.0, 1.0))]), at(2.0, [(200.0, (0.0, 1.0))])]
    first, second = tracked(found, np.eye(2))
    assert first.modes[1] is None
    assert second.modes[1] is not None
    assert first.strongest.frequency == 100.0
