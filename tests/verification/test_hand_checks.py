"""Numbers by hand stand near the computed ones, and on the same side."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from rigdesign import load_case
from rigdesign.assemble.hand import mean_gap, partition_gap
from rigdesign.cold import cold_feedback
from rigdesign.coupling import solve_point
from rigdesign.loads import brace_cold, mesh_models, respond
from rigdesign.ramp_run import held_points
from rigdesign.rig.model import build_rig

PROTOTYPE = Path(__file__).parents[2] / "cases" / "uhcf_prototype"


def test_crowning_belongs_to_the_mean_deflection() -> None:
    """Reference gear: 5 + 5 um over the profile and the face add about as much as the load."""
    rig = build_rig(load_case(PROTOTYPE), "quick")
    point = held_points(rig)[0]
    cold = cold_feedback(rig, point)
    models = mesh_models(rig, point, cold)
    response = respond(rig, point, models, {}, brace_cold(rig, point, cold))
    for index, model in enumerate(models):
        approach = abs(float(response.wave.approach[index].mean()))
        if response.flank[index] < 0:
            approach -= model.law.backlash
        elastic = abs(response.mean[index]) / model.pair.base_radii[0] / model.law.mean_stiffness
        by_hand = elastic + mean_gap(model)
        assert approach == pytest.approx(by_hand, rel=0.35)
        assert abs(approach - by_hand) < abs(approach - elastic) or index == 0


def test_a_plate_warmer_at_its_bore_narrows_the_gap_by_hand_too() -> None:
    rig = build_rig(load_case(PROTOTYPE / "given_losses.toml"), "quick")
    result = solve_point(rig, held_points(rig)[0])
    subject: Any = SimpleNamespace(case=rig.case, rig=rig, points=(result,))
    growth: Any = SimpleNamespace(gearbox="test", stage=result.point.stage)
    for name, seal in result.last.growth["test"].expansion.seals.items():
        by_hand = partition_gap(subject, growth, name)
        if by_hand is not None:
            assert abs(seal.mean - by_hand) < abs(seal.mean - seal.gap_by_hand)
