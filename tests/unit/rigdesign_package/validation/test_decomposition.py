"""Rows that decompose P2's Figures 7 and 8: what each part changes in the mesh laws, and which value a row takes."""

from functools import cache

import numpy as np
import pytest

from dynamics.tooth.law import MeshLaw
from rigdesign.coupling.mesh_models import MeshModel
from tests.builders.paths import CASES
from tests.published import decomposition
from tests.published.decomposition import PARTS, QUANTITIES, decomposition_rows
from tests.published.prototype import Prototype
from tests.published.speed_sweeps import (
    SpeedSweep,
    corner_gaps,
    damped,
    simulation_models,
    smooth,
    speed_sweep,
)

SPEEDS = np.array([1700.0, 12000.0])


@cache
def prototype() -> Prototype:
    return Prototype(CASES / "uhcf_prototype")


@cache
def models() -> tuple[MeshModel, ...]:
    return simulation_models(prototype())


def laws() -> list[MeshLaw]:
    return [model.law for model in models()]


@cache
def sweep(part: str) -> SpeedSweep:
    own = {
        "torsion": laws,
        "corner-1": lambda: corner_gaps(models(), 1.0),
        "damping-as-it-is": lambda: [damped([law], law.damping)[0] for law in laws()],
        "damping-300": lambda: damped(laws(), 300.0),
        "smooth": lambda: [smooth(law) for law in laws()],
    }[part]()
    return speed_sweep(prototype(), own, SPEEDS)


def test_parts_that_change_nothing_are_the_same_column() -> None:
    """One times the corner gap, and the damping that the laws have."""
    for part in ("corner-1", "damping-as-it-is"):
        assert sweep(part).factor == pytest.approx(sweep("torsion").factor, rel=1e-9)


def test_less_damping_raises_k_v_and_a_mesh_without_excitation_has_none() -> None:
    assert sweep("damping-300").factor[0, 0] > sweep("torsion").factor[0, 0] > 1.1
    assert sweep("smooth").factor == pytest.approx(np.ones((2, 2)), abs=1e-6)
    assert sweep("torsion").mean[:, 0] == pytest.approx(180.0, rel=1e-3)


def test_the_corner_gap_grows_where_teeth_meet_too_early_and_nowhere_else() -> None:
    for model, twice, thrice in zip(
        models(), corner_gaps(models(), 2.0), corner_gaps(models(), 3.0), strict=True
    ):
        added = twice.gap - model.law.gap
        assert added.min() >= 0.0 and added.max() > 0.0
        assert thrice.gap - model.law.gap == pytest.approx(2.0 * added)
        middle = model.law.gap.shape[1] // 2
        assert not added[:, middle].any()


def test_amplitudes_are_k_v_and_mean_in_newton_metres() -> None:
    found = sweep("torsion")
    above, whole = found.amplitude(0, (1000.0, 2000.0))
    assert above == pytest.approx((found.factor[0, 0] - 1.0) * found.mean[0, 0])
    # the highest torque above the mean is less than the whole swing
    assert above < whole < 4.0 * above


def test_every_part_has_a_row_for_every_quantity_with_the_value_of_its_own_sweep(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Each part and speed has a number of its own; a row takes the highest within the speeds of its quantity."""
    speed = np.array([800.0, 2000.0, 3000.0, 12000.0])
    sweeps = {}
    for number, part in enumerate(PARTS):
        factor = 1.0 + 0.01 * number + np.outer([0.5, 0.4, 0.3, 0.2], [1.0, 0.1])
        sweeps[part.name] = SpeedSweep(
            speed=speed, factor=factor, half=factor, mean=np.full((4, 2), 180.0), drive=np.zeros(4), missing=(2000.0,)
        )  # fmt: skip
    monkeypatch.setattr(decomposition, "part_sweeps", lambda _: sweeps)
    monkeypatch.setattr(decomposition, "_bending_modes", lambda *_: iter(()))
    rows = {row.id: row for row in decomposition_rows(prototype())}
    assert len(rows) == len(PARTS) * len(QUANTITIES)
    for number, part in enumerate(PARTS):
        sub, main, top = (rows[f"P2-part-TG-{name}-{part.name}"] for name in ("sub", "main", "super"))
        assert [row.computed for row in (sub, main, top)] == pytest.approx(
            [1.5 + 0.01 * number, 1.3 + 0.01 * number, 1.2 + 0.01 * number]
        )
        assert rows[f"P2-part-RG-super-{part.name}"].computed == pytest.approx(1.02 + 0.01 * number)
        assert rows[f"P2-part-TG-dM-{part.name}"].computed == pytest.approx(180.0 * (0.5 + 0.01 * number))
        assert "1 speeds without a periodic response: 2000 rpm" in sub.assumptions
        assert "without" not in top.assumptions
