"""Tip corners ahead of and behind the path: gap, force direction, levers, rounding."""

from math import atan2, cos, hypot

import numpy as np
import pytest

from dynamics.gear.tooth_form import TipEdge, ToothForm
from dynamics.tooth.corner import TipEnd, contact_places, tip_ends
from dynamics.tooth.pair_gap import tip_separation
from tests.builders.loaded_mesh import equal_gears, fzg_c
from tests.builders.p2_gears import helical_pair, spur_pair

PAIRS = pytest.mark.parametrize(
    "pair", [spur_pair(), helical_pair(), fzg_c()], ids=["test", "reference", "FZG-C"]
)


def around(pair, margin=0.25, n=301):
    return np.linspace(
        pair.path.start - margin * pair.base_pitch, pair.path.end + margin * pair.base_pitch, n
    )


@PAIRS
def test_gap_of_tip_ends_is_that_of_the_mesh_law(pair):
    path = around(pair)
    assert contact_places(pair, path).gap == pytest.approx(tip_separation(pair, path), abs=2e-12)


@PAIRS
def test_on_the_path_the_force_acts_along_the_line_of_action(pair):
    path = np.linspace(pair.path.tip_start, pair.path.tip_end, 21)[1:-1]
    place = contact_places(pair, path)
    assert not place.gap.any() and not place.corner.any() and not place.beyond.any()
    for index in (0, 1):
        assert place.lever[index] == pytest.approx(pair.base_radii[index])
        assert place.reach[index] == pytest.approx(place.roll[index])
    assert place.roll[0] + place.roll[1] == pytest.approx(sum(pair.rolling_radii))


@PAIRS
@pytest.mark.parametrize("side", [-1, 1])
def test_work_of_the_corner_force_follows_the_slope_of_the_gap(pair, side):
    """At a constant gap the wheel turns by (1 - gap') of the pinion: so do the levers, per base radius."""
    end = pair.path.tip_end if side > 0 else pair.path.tip_start
    path = end + side * np.array([0.05, 0.1, 0.2]) * pair.base_pitch
    step = 1e-5 * pair.base_pitch
    slope = (contact_places(pair, path + step).gap - contact_places(pair, path - step).gap) / (2.0 * step)
    place = contact_places(pair, path)
    ratio = (place.lever[0] / pair.base_radii[0]) / (place.lever[1] / pair.base_radii[1])
    assert ratio == pytest.approx(1.0 - slope, rel=2e-5)
    assert np.all(np.abs(slope) > 1e-3)
    assert np.all(place.corner == (1 if side > 0 else 2))


@PAIRS
def test_corner_lies_on_the_normal_of_the_mating_flank(pair):
    """Kinematics: the tip point, the base tangent point of the mating gear and the force are on one line."""
    path = pair.path.tip_end + np.array([0.02, 0.1]) * pair.base_pitch
    place = contact_places(pair, path)
    a, r_2 = pair.centre_distance, pair.base_radii[1]
    for k in range(2):
        tau, roll = place.pressure_angle[k], place.roll[1][k]
        x = r_2 * cos(tau) + roll * np.sin(tau)
        y = r_2 * np.sin(tau) - roll * cos(tau)
        assert hypot(a - x, y) == pytest.approx(pair.tip_radii[0], rel=1e-9)
        assert place.lever[0][k] == pytest.approx(a * cos(tau) - r_2)
        assert place.reach[0][k] == pytest.approx(a * np.sin(tau) - roll)
        assert atan2(y, a - x) > 0.0


@PAIRS
def test_path_and_corner_join_without_a_step(pair):
    step = 1e-7 * pair.base_pitch
    for end in (pair.path.tip_start, pair.path.tip_end):
        place = contact_places(pair, np.array([end - step, end + step]))
        for one in (place.pressure_angle, place.gap, *place.roll, *place.lever, *place.reach):
            assert one[0] == pytest.approx(one[1], rel=1e-5, abs=1e-6 * pair.base_pitch)


def rounded(pair, radius):
    forms = [ToothForm(gear=gear, tip_edge=TipEdge(rounding=radius)) for gear in pair.gears]
    return tuple(TipEnd(roll=form.flank_tip_roll, rounding=radius) for form in forms)


def test_rounding_moves_the_ends_of_the_path_and_opens_more_slowly_than_a_sharp_end_there():
    pair = fzg_c()
    tips = rounded(pair, 0.3e-3)
    sharp = tuple(TipEnd(roll=tip.roll) for tip in tips)
    end = tips[0].roll - pair.rolling_radii[0]
    assert end < pair.path.tip_end
    path = end + np.array([1e-6, 0.2e-3, 1e-3])
    soft, hard = contact_places(pair, path, tips), contact_places(pair, path, sharp)
    assert soft.gap[0] < 1e-9
    assert np.all((soft.gap[1:] > 0.0) & (soft.gap[1:] < hard.gap[1:]))
    full = contact_places(pair, path, tip_ends(pair))
    assert np.all(soft.gap[1:] >= full.gap[1:])


def test_gap_of_a_rounded_corner_equals_the_distance_found_point_by_point():
    """Points on the rounding, each as a sharp corner: the closest one gives the gap."""
    pair, radius = fzg_c(), 0.4e-3
    tips = rounded(pair, radius)
    form = ToothForm(gear=pair.gears[0], tip_edge=TipEdge(rounding=radius))
    s = tips[0].roll - pair.rolling_radii[0] + 1.2e-3
    a, (r_1, r_2) = pair.centre_distance, pair.base_radii
    reach = pair.rolling_radii[0]
    start = form.gear.base_half_angle
    normal = form.flank_normal(tips[0].roll)
    centre = form.flank_point(tips[0].roll) - radius * normal
    first = atan2(normal[1], normal[0])
    angles = first + np.linspace(0.0, 1.2, 20001)
    edge = centre + radius * np.column_stack([np.cos(angles), np.sin(angles)])
    inv_w = reach / r_1 - np.arctan(reach / r_1)
    # clockwise angle of the edge points from the tooth axis; the base point of the flank is at `start`
    turned = inv_w + s / r_1 - (start - np.arctan2(edge[:, 0], edge[:, 1]))
    size = np.hypot(*edge.T)
    x, y = a - size * np.cos(turned), size * np.sin(turned)
    rho = np.sqrt(x**2 + y**2 - r_2**2) / r_2
    gaps = s - r_2 * inv_w + r_2 * (rho - np.arctan(rho) - np.arctan2(y, x))
    assert contact_places(pair, np.array([s]), tips).gap[0] == pytest.approx(gaps.min(), rel=1e-6)


def test_equal_gears_are_mirrored():
    """The corner of the wheel meets the pinion as that of the pinion meets the wheel, at its own position."""
    pair = equal_gears()
    own = pair.path.tip_end + np.array([0.05, 0.1, 0.25]) * pair.base_pitch
    late = contact_places(pair, own)
    early = contact_places(pair, late.gap - own)
    assert early.gap == pytest.approx(late.gap, rel=1e-8)
    assert early.pressure_angle == pytest.approx(late.pressure_angle, rel=1e-8)
    for first, second in ((0, 1), (1, 0)):
        for name in ("roll", "lever", "reach"):
            assert getattr(early, name)[first] == pytest.approx(getattr(late, name)[second], rel=1e-8)
