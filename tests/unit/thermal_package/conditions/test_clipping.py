"""Convex polygons cut and intersected, against areas known by hand."""

import numpy as np
import pytest

from thermal.conditions.contact import clip, cross, fan, intersect

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def area(polygons: np.ndarray) -> np.ndarray:
    triangles = fan(polygons)
    halves = 0.5 * cross(triangles[:, :, 1] - triangles[:, :, 0], triangles[:, :, 2] - triangles[:, :, 0])
    return np.asarray(halves.sum(axis=1))


LINES = [
    ((1.0, 0.0, -0.3), 0.7),
    ((1.0, 1.0, -1.0), 0.5),
    ((1.0, 1.0, -1.5), 0.125),
    ((-1.0, 0.0, 2.0), 1.0),
]


@pytest.mark.parametrize(("line", "left"), LINES)
def test_a_square_cut_by_a_line(line: tuple[float, float, float], left: float) -> None:
    heights = SQUARE @ np.array(line[:2]) + line[2]
    assert area(clip(SQUARE[None], heights[None]))[0] == pytest.approx(left)


def test_nothing_is_left_below() -> None:
    assert area(clip(SQUARE[None], np.full((1, 4), -1.0)))[0] == 0.0


def test_pairs_of_polygons() -> None:
    shifts = np.array([[0.0, 0.0], [0.25, 0.5], [1.5, 0.0], [-0.5, -0.5]])
    common = intersect(np.tile(SQUARE, (4, 1, 1)), SQUARE + shifts[:, None])
    assert common.shape == (4, 8, 2)
    assert area(common) == pytest.approx([1.0, 0.375, 0.0, 0.25])


def test_common_part_of_random_triangles_by_sampling() -> None:
    rng = np.random.default_rng(5)
    angles = np.sort(rng.random((2, 20, 3)), axis=2) * 2.0 * np.pi
    pairs = 0.5 + 0.5 * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    places = np.stack(np.meshgrid(*[(np.arange(300) + 0.5) / 300] * 2), axis=-1).reshape(-1, 2)

    def inside(triangle: np.ndarray) -> np.ndarray:
        edges = np.roll(triangle, -1, axis=0) - triangle
        return np.asarray((cross(edges, places[:, None] - triangle) >= 0.0).all(axis=1))

    found = area(intersect(pairs[0], pairs[1]))
    counted = [np.mean(inside(a) & inside(b)) for a, b in zip(*pairs, strict=True)]
    assert found == pytest.approx(counted, abs=3e-3)
    assert np.count_nonzero(found > 0.01) > 5
