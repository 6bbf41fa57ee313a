"""Shapes from a few patterns against solves of every field."""

import numpy as np
import pytest

from tests.builders.housing import PROTOTYPE
from thermal.expansion.elastic import ElasticError
from thermal.expansion.expansion import ExpansionBasis, expand
from thermal.expansion.setup import ExpansionSetup
from thermal.housing.gearbox import build_gearbox

STEEL = (210e9, 0.3, 12e-6)
COLD = 293.15


@pytest.fixture(scope="module")
def setup() -> ExpansionSetup:
    model = build_gearbox(PROTOTYPE, "quick")
    return ExpansionSetup(model, dict.fromkeys(model.mesh.bodies, STEEL))


def fields(setup: ExpansionSetup) -> list[np.ndarray]:
    """Twelve fields of three patterns: gears ahead, box behind, a gradient over the height."""
    mesh = setup.model.mesh
    gears = np.unique(mesh.cells[np.concatenate([mesh.bodies["gear_pinion"], mesh.bodies["gear_wheel"]])])
    first, second = np.zeros((2, len(mesh.points)))
    first[gears] = 1.0
    second[:] = 1.0
    third = mesh.points[:, 2]
    times = np.linspace(0.0, 3.0, 12)
    return [
        COLD + 130.0 * (1 - np.exp(-3 * t)) * first + 60.0 * (1 - np.exp(-t)) * second + 20.0 * t * third
        for t in times
    ]


def test_three_patterns_hold_twelve_fields(setup: ExpansionSetup) -> None:
    found = fields(setup)
    course = ExpansionBasis.of(setup, COLD, found, missed=1e-3, tolerance=1e-9)
    assert len(course.patterns) == 3
    assert course.missed <= 1e-3
    for field in (found[4], found[-1]):
        direct = expand(setup, field, COLD, tolerance=1e-10)
        quick = course.shape(field)
        assert np.abs(quick.displacement - direct.displacement).max() < 2e-9
        for name, seal in direct.seals.items():
            assert quick.seals[name].minimum == pytest.approx(seal.minimum, abs=2e-9)
        assert quick.centre_distances[0].hot == pytest.approx(direct.centre_distances[0].hot, abs=2e-9)


def test_patterns_stop_at_the_limit(setup: ExpansionSetup) -> None:
    found = fields(setup)
    coarse = ExpansionBasis.of(setup, COLD, found, missed=5.0)
    assert len(coarse.patterns) < 3 and 1e-3 < coarse.missed <= 5.0
    cold = ExpansionBasis.of(setup, COLD, [np.full_like(found[0], COLD)])
    assert len(cold.patterns) == 0
    assert np.abs(cold.shape(np.full_like(found[0], COLD)).displacement).max() == 0.0


def test_no_field_is_refused(setup: ExpansionSetup) -> None:
    with pytest.raises(ElasticError, match="no temperature field"):
        ExpansionBasis.of(setup, COLD, [])
