"""Bulk temperature of FZG gears against Michaelis, and what an assumed split makes of it."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from rigdesign.case import load_case
from rigdesign.coupling.loop import PointResult, solve_point
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.model import Rig, build_rig
from rigdesign.run.heat_audits import thin_rim_films
from tests.builders.fzg_case import HELD, RIM_FILM, fzg_case

MICHAELIS = 126.0
"""Dip lubricated C-type gears, 372.6 N m, 2250 rpm, FVA 3 at 90 degC, by hand after Michaelis [degC]."""


def settled(path: Path) -> tuple[Rig, PointResult]:
    rig = build_rig(load_case(path), "quick")
    return rig, solve_point(rig, held_points(rig)[-1])


def bulk(result: PointResult) -> list[float]:
    """Pinion and wheel of the test gearbox [degC]."""
    found = result.last.coupling_state.gear_temperature
    return [found[f"test.{gear}"] - 273.15 for gear in ("pinion", "wheel")]


def test_a_case_that_says_nothing_gets_the_film_on_the_flanks(tmp_path: Path) -> None:
    """No word on the split: all friction heat enters the flanks, the oil flung off them takes its part."""
    rig, result = settled(fzg_case(tmp_path))
    assert rig.case.gearboxes["test"].heat_split.mesh is None
    assert rig.case.gearboxes["test"].heat_split.rule == "flank_film"
    assert bulk(result) == pytest.approx([MICHAELIS] * 2, abs=6.0)


def test_gears_that_dip_reach_the_same_temperature(tmp_path: Path) -> None:
    """Level at the shafts, teeth flooded once a turn: 122.5 and 119.5 degC, where Michaelis has one value for both.

    The mean is 5 K below his: faces and shafts, which his formula does not know, take a part of the heat.
    """
    _, result = settled(fzg_case(tmp_path, sumps={"test": HELD, "slave": HELD}))
    pinion, wheel = bulk(result)
    assert wheel < pinion < MICHAELIS
    assert 0.5 * (pinion + wheel) == pytest.approx(MICHAELIS, abs=6.0)


def test_half_of_the_heat_under_a_film_of_walls_is_far_too_hot_and_said(tmp_path: Path) -> None:
    """300 W/(m2 K) is a film on a wall: the flanks of these gears have nine times as much."""
    rig, result = settled(fzg_case(tmp_path, split="mesh_into_gears = 0.5\n", rims=RIM_FILM))
    assert rig.case.gearboxes["test"].heat_split.rule == "assumed"
    assert min(bulk(result)) > MICHAELIS + 40.0
    solved: Any = SimpleNamespace(rig=rig, points=(result,))
    texts = list(thin_rim_films(solved, result.last.fields["test"]))
    assert len(texts) == 2
    assert "film on its rim = 300 W/(m2 K) with mesh_into_gears = 0.5" in texts[0]
    assert 'law = "flank_film"' in texts[0]
