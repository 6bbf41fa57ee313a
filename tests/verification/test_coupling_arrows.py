"""Every arrow of the coupling loop: cut it, and a named result moves as a hand calculation says.

Each arrow is held at its cold value by `solve_point(..., hold={...})`; the test derives sign and amount from the
two solved points by hand and asks for at least twenty times the tolerance of the loop.
"""

import math
from functools import cache

import pytest

from rigdesign.case import load_case
from rigdesign.coupling import PointResult, solve_point
from rigdesign.ramp_run import held_points
from rigdesign.rig.model import Rig, build_rig

CASE = "cases/uhcf_prototype"
TEMPERATURE, LENGTH, TORQUE = 0.05, 0.5e-6, 1e-3
"""Tolerances of the loop: K, m, relative."""


@cache
def rig() -> Rig:
    return build_rig(load_case(CASE), "quick")


@cache
def solved(*hold: str) -> PointResult:
    return solve_point(rig(), held_points(rig())[-1], hold=frozenset(hold))


def test_growth_to_centre_distance_opens_the_backlash() -> None:
    """The hot housing moves the axes apart: backlash grows by 2 tan(alpha_wt) times the change."""
    warm, cut = solved().last.models[0].pair, solved("centre_distance").last.models[0].pair
    change = warm.centre_distance - cut.centre_distance
    by_hand = 2.0 * math.tan(cut.working_pressure_angle) * change
    moved = warm.transverse_backlash - cut.transverse_backlash
    assert change > 0.0
    assert moved == pytest.approx(by_hand, rel=0.02)
    assert moved > 20 * LENGTH
