"""Mean of a stress field over the grid, as a callable and from nodes; gauges that do not lie in the root."""

import math

import numpy as np
import pytest

from rigdesign.base.errors import CaseError
from rigdesign.strain_gauge.measuring_point import GaugePlacement, StressField, grid_average, grid_weights
from tests.builders.strain_gauge import gauge, measuring_point

PLACED = GaugePlacement(face_position=3e-3, fillet_position=0.2e-3, misalignment=math.radians(15.0))


def fine_mean(field: StressField, count: int = 400) -> float:
    """Mean over the turned grid by a fine midpoint rule of its own."""
    middle = (np.arange(count) + 0.5) / count - 0.5
    along, across = np.meshgrid(0.6e-3 * middle, 1e-3 * middle)
    cos, sin = math.cos(PLACED.misalignment), math.sin(PLACED.misalignment)
    s = PLACED.fillet_position + cos * along - sin * across
    z = PLACED.face_position + sin * along + cos * across
    return float(np.mean(field(s, z)))


def test_linear_field_has_its_value_at_the_centre() -> None:
    mean = grid_average(lambda s, z: 5.0 + 2e3 * s - 4e3 * z, gauge(), PLACED)
    assert float(mean) == pytest.approx(5.0 + 0.4 - 12.0, rel=1e-12)


def test_notch_gradient_lowers_the_reading_as_the_second_moment_of_the_grid_says() -> None:
    """sigma = 1 - (s / s0)^2: mean of s^2 over a turned rectangle is (L^2 cos^2 + W^2 sin^2) / 12."""
    placed = GaugePlacement(face_position=0.0, misalignment=math.radians(15.0))
    second = (
        0.6e-3**2 * math.cos(placed.misalignment) ** 2 + 1e-3**2 * math.sin(placed.misalignment) ** 2
    ) / 12
    mean = grid_average(lambda s, z: 1.0 - (s / 1e-3) ** 2, gauge(), placed)
    assert float(mean) == pytest.approx(1.0 - second / 1e-6, rel=1e-12)


def test_weights_at_nodes_serve_every_angle() -> None:
    s, z = np.linspace(-2e-3, 2e-3, 9), np.linspace(-12.5e-3, 12.5e-3, 26)
    weights = grid_weights(s, z, gauge(), PLACED)
    assert weights.sum() == pytest.approx(1.0, rel=1e-12)
    angles = np.linspace(0.0, 1.0, 5)[:, np.newaxis, np.newaxis]
    stress = 1.0 + angles * (3e2 * s[:, np.newaxis] + 2e2 * z)  # linear: nodes hold it exactly
    means = np.einsum("sz,...sz->...", weights, stress)
    by_field = grid_average(lambda s, z: 1.0 + angles[:, :, 0] * (3e2 * s + 2e2 * z), gauge(), PLACED)
    assert means == pytest.approx(by_field, rel=1e-12)


def test_nodes_converge_to_a_fine_integral_at_fourth_order() -> None:
    def field(s: np.ndarray, z: np.ndarray) -> np.ndarray:
        return np.exp(-((s / 1e-3) ** 2)) * np.cos(z / 4e-3)

    exact, errors = fine_mean(field), []
    assert float(grid_average(field, gauge(), PLACED)) == pytest.approx(exact, rel=1e-6)
    for count in (11, 21, 41):
        s, z = np.linspace(-2e-3, 2e-3, count), np.linspace(-12.5e-3, 12.5e-3, 3 * count)
        weights = grid_weights(s, z, gauge(), PLACED)
        errors.append(abs(float(np.sum(weights * field(*np.meshgrid(s, z, indexing="ij")))) - exact))
    assert errors[2] < 1e-4 * exact
    assert errors[0] / errors[2] > 100.0  # 256 at fourth order


@pytest.mark.parametrize(
    ("placement", "said"),
    [
        (
            {"face_position": 12.2e-3},
            "II.face_position = 12.2 mm: the grid reaches 12.7 mm from mid-face, the face ends at 12.5 mm; "
            "state the position from mid-face, within +-12 mm",
        ),
        ({"face_position": 0.0, "fillet_position": 1.9e-3}, "II.fillet_position = 1.9 mm: the grid reaches"),
        ({"face_position": math.nan}, "II.face_position = nan mm"),
    ],
)
def test_gauge_outside_the_root(placement: dict[str, float], said: str) -> None:
    with pytest.raises(CaseError) as error:
        measuring_point(placement=GaugePlacement(**placement))
    assert said in str(error.value)


def test_gauge_turned_across_and_nodes_that_do_not_cover_it() -> None:
    with pytest.raises(CaseError, match="must lie within -45 to 45 deg"):
        GaugePlacement(face_position=0.0, misalignment=math.radians(80.0))
    with pytest.raises(CaseError, match="do not cover the grid"):
        grid_weights(np.array([0.4e-3, 1e-3]), np.array([-0.01, 0.01]), gauge(), PLACED)
    with pytest.raises(CaseError, match="at least 2 and increase"):
        grid_weights(np.array([1e-3, 0.0]), np.array([-0.01, 0.01]), gauge(), PLACED)
