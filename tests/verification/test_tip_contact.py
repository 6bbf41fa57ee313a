"""Separation beyond the path of contact against kinematics and a brute-force search.

Second derivative at the end of the path, from the relative acceleration of the corner normal to the flank
(unit path speed; rho base tangent distances, v sliding speed of the corner over the flank):
gap'' = rho_1/r_b1^2 + rho_2/r_b2^2 + 2 v/r_b2 + v^2/rho_2 for a corner of gear 1 on a flank of gear 2.
"""

from math import atan2, hypot, tan

import numpy as np
import pytest
from scipy.optimize import brentq

from dynamics.gear.pair import GearPair
from dynamics.tooth.pair_gap import path_reach, tip_separation
from tests.builders.p2_gears import helical_pair, spur_pair

UHCF = spur_pair()
FZG_C = GearPair.from_centre_distance(
    normal_module=4.5e-3,
    teeth=(16, 24),
    centre_distance=91.5e-3,
    face_widths=(14e-3, 14e-3),
    profile_shift_1=0.1817,
)
UNDERCUT = GearPair.from_centre_distance(
    normal_module=2e-3, teeth=(11, 40), centre_distance=51e-3, face_widths=(14e-3, 14e-3), profile_shift_1=0.0
)
PAIRS = pytest.mark.parametrize("pair", [UHCF, FZG_C], ids=["UHCF", "FZG-C"])


@PAIRS
@pytest.mark.parametrize("side", ["start", "end"])
def test_gap_grows_with_the_square_of_the_distance(pair, side):
    (r_1, r_2), (c_1, c_2), path = pair.base_radii, pair.rolling_radii, pair.path
    place = path.tip_end if side == "end" else -path.tip_start
    if side == "start":
        (r_1, r_2), (c_1, c_2) = (r_2, r_1), (c_2, c_1)
    rho_1, rho_2 = c_1 + place, c_2 - place
    sliding = place * (1.0 / r_1 + 1.0 / r_2)
    expected = rho_1 / r_1**2 + rho_2 / r_2**2 + 2.0 * sliding / r_2 + sliding**2 / rho_2
    steps = pair.base_pitch * np.array([0.002, 0.004])
    at = path.tip_end + steps if side == "end" else path.tip_start - steps
    curvature = 2.0 * tip_separation(pair, at) / steps**2
    assert 2.0 * curvature[0] - curvature[1] == pytest.approx(expected, rel=1e-3)


def involute_flank(radius, base):
    roll = np.sqrt(radius**2 - base**2) / base
    return roll - np.arctan(roll)


@PAIRS
@pytest.mark.parametrize("distance", [0.05, 0.2, 0.3])
@pytest.mark.parametrize("side", ["start", "end"])
def test_gap_is_the_approach_at_which_the_corner_meets_the_flank(pair, distance, side):
    """Turn the wheel back by x / r_b2 at a fixed pinion until tip corner and flank meet."""
    path, a = pair.path, pair.centre_distance
    (r_1, r_2), w = pair.base_radii, pair.working_pressure_angle
    start = tan(w) - w
    s = (
        path.tip_end + distance * pair.base_pitch
        if side == "end"
        else path.tip_start - distance * pair.base_pitch
    )

    def distance_to_flank(x):
        pinion_base = start + s / r_1
        wheel_base = -start + (s - x) / r_2
        if side == "end":
            angle = pinion_base - involute_flank(pair.tip_radii[0], r_1)
            px, py = pair.tip_radii[0] * np.cos(angle), pair.tip_radii[0] * np.sin(angle)
            radius = hypot(a - px, py)
            return wheel_base + involute_flank(radius, r_2) - atan2(py, a - px)
        angle = wheel_base + involute_flank(pair.tip_radii[1], r_2)
        px, py = a - pair.tip_radii[1] * np.cos(angle), pair.tip_radii[1] * np.sin(angle)
        radius = hypot(px, py)
        return atan2(py, px) - (pinion_base - involute_flank(radius, r_1))

    touching = brentq(distance_to_flank, 0.0, 0.4 * pair.normal_module, xtol=1e-16)
    assert tip_separation(pair, np.array([s]))[0] == pytest.approx(touching, rel=1e-8, abs=1e-13)
    assert touching > 0.0


def test_active_path_has_no_gap():
    for pair in (UHCF, FZG_C, UNDERCUT):
        path = np.linspace(pair.path.start, pair.path.end, 50)[1:-1]
        assert not tip_separation(pair, path).any()


def test_undercut_flank_ends_in_a_corner():
    assert UNDERCUT.gears[0].undercut
    assert UNDERCUT.path.start > UNDERCUT.path.tip_start + 1e-4
    before = UNDERCUT.path.start - 1e-4 * np.arange(1, 9)
    gap = tip_separation(UNDERCUT, before)
    assert np.all(np.diff(gap) > 0.0)
    assert gap[1] / gap[0] == pytest.approx(4.0, rel=0.2)


def test_reach_stops_where_the_gap_is_wide_enough():
    first, last = path_reach(FZG_C, 50e-6)
    gaps = tip_separation(FZG_C, np.array([first, last]))
    assert np.all(gaps >= 50e-6)
    assert np.all(gaps < 54e-6)


def test_helical_gears_take_the_transverse_section():
    pair = helical_pair()
    path = np.linspace(*path_reach(pair, 50e-6), 200)
    gap = tip_separation(pair, path)
    assert np.all(gap >= 0.0)
    outside = path > pair.path.tip_end
    assert np.all(np.diff(gap[outside]) > 0.0)
