"""Where modified flanks touch, against a scan of the exact curves of both flanks."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from dynamics.gear.microgeometry import Microgeometry
from dynamics.tooth.corner import Profiles, contact_places, settled, tip_ends
from dynamics.tooth.pair_gap import PairGap
from dynamics.tooth.points import FaceGrid, contact_points, flank_gap, no_gap
from tests.builders.loaded_mesh import fzg_c
from tests.builders.p2_gears import ALLOWANCES, spur_pair

PLAIN, CROWNED = Microgeometry(), Microgeometry(profile_crowning=7e-6)


def curve(base, roll, contact_roll, removed):
    """Flank (n, 2) about its gear, turned so that its normal at ``contact_roll`` is along x."""
    turn = (roll - contact_roll) / base
    normal = np.column_stack([np.cos(turn), np.sin(turn)])
    return base * np.column_stack([-normal[:, 1], normal[:, 0]]) + (roll - removed)[:, None] * normal


def scanned_gap(pair, gap, path, n=20001):
    """Turn of the wheel, along the line of action, until its flank meets that of the pinion [m]."""
    reach, base = pair.rolling_radii, pair.base_radii
    rolls = [np.linspace(g.roll_length(g.form_radius), g.roll_length(g.tip_radius), n) for g in pair.gears]
    removed = [flank.modification(roll, np.zeros(n)) for flank, roll in zip(gap.flanks, rolls)]
    centre = np.array([sum(reach), sum(base)])
    pinion = curve(base[0], rolls[0], reach[0] + path, removed[0]) - centre
    wheel = -curve(base[1], rolls[1], reach[1] - path, removed[1])
    radius, angle = np.hypot(*wheel.T), np.arctan2(wheel[:, 1], wheel[:, 0])
    at = np.hypot(*pinion.T)
    met = (at >= radius[0]) & (at <= radius[-1])
    return base[1] * np.min(CubicSpline(radius, angle)(at[met]) - np.arctan2(pinion[met, 1], pinion[met, 0]))


def points_of(pair, micro, reach=40e-6):
    gap = PairGap.of_pair(pair, (micro, micro))
    points = contact_points(
        pair, FaceGrid.over(pair.face_width, 1), gap=flank_gap(gap), reach=reach, n_positions=16
    )
    return gap, points


@pytest.fixture(scope="module")
def gears():
    return spur_pair(thickness_allowances=ALLOWANCES["thickness_allowances"])


@pytest.mark.parametrize("micro", [PLAIN, CROWNED], ids=["plain", "crowned"])
def test_gap_against_a_scan_of_the_flanks(gears, micro):
    gap, points = points_of(gears, micro)
    seen = np.isfinite(points.gap)
    assert seen.sum() > 30
    for path, found in zip(points.path[seen], points.gap[seen]):
        # far from contact the relative curvature of the involutes is no longer even
        assert found == pytest.approx(scanned_gap(gears, gap, path), abs=0.15e-6 if found < 25e-6 else 0.4e-6)


def test_crowned_flanks_touch_nearer_than_on_the_line_of_action(gears):
    """At the ends of the path 13 um of metal removed leave a gap of 9 um, away from the corner."""
    gap = PairGap.of_pair(gears, (CROWNED, CROWNED))
    path = np.array([gears.path.start, gears.path.end])
    place = contact_places(gears, path)

    def removed(rolls):
        return flank_gap(gap)(np.zeros(2, dtype=np.int64), np.zeros(2), path, rolls)

    on_line = removed(place.roll)
    moved, there = settled(Profiles(pair=gears, place=place, tips=tip_ends(gears)), removed)
    assert on_line == pytest.approx([13.4e-6, 14.0e-6], abs=0.8e-6)
    assert moved.gap + there == pytest.approx([8.9e-6, 9.0e-6], abs=0.5e-6)
    for k, s in enumerate(path):
        assert moved.gap[k] + there[k] == pytest.approx(scanned_gap(gears, gap, s), abs=0.15e-6)
    # towards the middle of the flanks
    assert moved.roll[0][0] > place.roll[0][0] and moved.roll[0][1] < place.roll[0][1]
    assert moved.roll[1][0] < place.roll[1][0] and moved.roll[1][1] > place.roll[1][1]
    assert np.all(moved.bend > 0.0)


@pytest.mark.parametrize("pair", [spur_pair(), fzg_c()], ids=["test", "FZG-C"])
def test_unmodified_flanks_stay_where_they_are(pair):
    _, points = points_of(pair, PLAIN)
    involutes = contact_points(pair, points.grid, gap=no_gap, reach=40e-6, n_positions=16)
    seen = np.isfinite(points.gap)
    assert np.array_equal(seen, np.isfinite(involutes.gap))
    assert points.gap[seen] == pytest.approx(involutes.gap[seen], abs=1e-15)
    for found, before in zip(points.place.roll, involutes.place.roll):
        assert found[seen] == pytest.approx(before[seen], rel=1e-12)
    assert np.array_equal(points.place.corner[seen], involutes.place.corner[seen])
    assert np.any(points.place.corner[seen] == 1) and np.any(points.place.corner[seen] == 2)


def test_even_metal_removed_moves_nothing(gears):
    path = np.linspace(gears.path.start - 1e-3, gears.path.end + 1e-3, 41)
    place = contact_places(gears, path)
    profiles = Profiles(pair=gears, place=place, tips=tip_ends(gears))
    moved, there = settled(profiles, lambda rolls: np.full(41, 5e-6))
    assert np.array_equal(moved.corner, place.corner)
    assert moved.gap == pytest.approx(place.gap, abs=1e-15)
    assert np.all(there == 5e-6)
    corner = place.corner > 0
    assert moved.lever[0][corner] == pytest.approx(place.lever[0][corner])
    assert moved.beyond == pytest.approx(place.beyond)


def test_a_corner_stays_a_corner_far_beyond_the_path(gears):
    """There the flank falls away faster than the crowning gives; near the path the flanks touch first."""
    _, points = points_of(gears, CROWNED)
    path, corner, gap = (table.ravel() for table in (points.path, points.place.corner, points.gap))
    seen = np.isfinite(gap)
    start, end = gears.path.start, gears.path.end
    far = seen & ((path < start - 1.3e-3) | (path > end + 1e-3))
    near = seen & (path > start - 0.5e-3) & (path < end + 0.4e-3)
    assert np.any(far) and np.all(corner[far] > 0)
    assert np.any(near & (path < start)) and np.all(corner[near] == 0)
    lever = points.place.lever[0].ravel()
    assert lever[near] == pytest.approx(gears.base_radii[0])


def test_tip_relief_is_found_within_two_per_cent(gears):
    """20 um over 0.8 mm, more than any gear of this size has: the kink between involute and relief is looked for."""
    gap, points = points_of(gears, Microgeometry(tip_relief=20e-6, tip_relief_length=0.8e-3))
    seen = np.isfinite(points.gap)
    for path, found in zip(points.path[seen], points.gap[seen]):
        assert found == pytest.approx(scanned_gap(gears, gap, path), rel=0.025, abs=0.02e-6)


def test_the_larger_gear_may_be_called_pinion(gears):
    """Exchanged gears: the same gaps along the mirrored path."""
    exchanged = replace(
        gears,
        teeth=gears.teeth[::-1],
        face_widths=gears.face_widths[::-1],
        profile_shifts=gears.profile_shifts[::-1],
        tip_diameters=gears.tip_diameters[::-1],
        thickness_allowances=gears.thickness_allowances[::-1],
    )
    path = np.linspace(gears.path.start, gears.path.end, 25)
    found = []
    for pair, places in ((gears, path), (exchanged, -path)):
        whole = flank_gap(PairGap.of_pair(pair, (CROWNED, CROWNED)))

        def removed(rolls, whole=whole, places=places):
            return whole(np.zeros(25, dtype=np.int64), np.zeros(25), places, rolls)

        place = contact_places(pair, places)
        moved, there = settled(Profiles(pair=pair, place=place, tips=tip_ends(pair)), removed)
        found.append(moved.gap + there)
    assert found[0] == pytest.approx(found[1], abs=2e-8)
