"""Loaded contact of a pair: balance, symmetry, reciprocity, where modifications shift the pattern, limits."""

from dataclasses import replace
from math import cos, hypot

import numpy as np
import pytest

from dynamics.errors import DynamicsInputError, DynamicsNotConverged
from dynamics.gear.microgeometry import Microgeometry
from dynamics.tooth.compliance import EdgeModel
from dynamics.tooth.loaded_mesh import LoadedMesh
from dynamics.tooth.mesh_cycle import unloaded_contact_ratio
from dynamics.tooth.points import FaceGrid
from tests.builders.loaded_mesh import equal_gears, exchanged_fzg_c, fzg_c, gap_of, influence_of, sliced_mesh
from tests.builders.p2_gears import helical_pair, spur_pair

FORCE = 4.8e3
EQUAL = equal_gears()
HELICAL = helical_pair()
CROWNED = Microgeometry(profile_crowning=6e-6, lead_crowning=6e-6)
PLAIN = Microgeometry()


def interpolated_mesh(pair, n_face=11, **fields):
    grid = FaceGrid.over(pair.face_width, n_face)
    return LoadedMesh(pair=pair, gears=(influence_of(pair, 0), influence_of(pair, 1)), grid=grid, **fields)


def modified(pair, first=PLAIN, second=PLAIN, misalignment=0.0, **fields):
    gap = gap_of(pair, (first, second), misalignment)
    return sliced_mesh(pair, 11 if pair is not HELICAL else 41, coupling=1.5, gap=gap, **fields)


@pytest.mark.parametrize(
    "pair", [EQUAL, HELICAL, fzg_c(), spur_pair()], ids=["equal", "helical", "FZG-C", "test"]
)
def test_forces_equal_the_torque_of_the_wheel(pair):
    cycle = interpolated_mesh(pair).cycle(FORCE)
    assert cycle.torques[1] == pytest.approx(np.full(64, FORCE * pair.base_radii[1]), rel=1e-10)
    assert cycle.load_share.sum(axis=1) == pytest.approx(np.ones(64), rel=1e-10)
    assert np.all(cycle.force >= 0.0)


def test_torque_of_the_pinion_differs_where_corners_touch_only():
    pair = fzg_c()
    cycle = sliced_mesh(pair, 1).cycle(FORCE)
    corner = (cycle.early | cycle.late).any(axis=(1, 2))
    error = np.abs(cycle.torques[0] / (FORCE * pair.base_radii[0]) - 1.0)
    assert corner.any() and np.all(error[~corner] < 1e-10)
    assert 1e-5 < error[corner].max() < 0.05


def test_no_point_overlaps_and_none_pulls():
    mesh = interpolated_mesh(HELICAL)
    cycle = mesh.cycle(FORCE)
    points = cycle.points
    for k in (0, 17, 40):
        within = np.isfinite(points.gap[k])
        problem = mesh._problem(points, cycle.local, k, within)
        left = problem.weight * cycle.approach[k] - problem.gap - problem.compliance @ cycle.force[k][within]
        on = cycle.force[k][within] > 0.0
        assert np.all(left[~on] <= 1e-12) and np.all(left[on] > 0.0)
        assert left == pytest.approx(cycle.closing[k][within], abs=1e-15)


def test_equal_gears_share_symmetrically():
    relieved = Microgeometry(tip_relief=60e-6, tip_relief_length=2.5e-3)
    pattern = modified(EQUAL, relieved, relieved, n_positions=512).cycle(0.5 * FORCE).pattern(0)
    load = pattern.line_load
    for column in (0, 5):
        mirrored = np.interp(-pattern.path, pattern.path, load[:, column])
        assert mirrored == pytest.approx(load[:, column], abs=0.01 * load.max())


def test_pattern_of_a_symmetric_pair_is_centred_over_the_face():
    cycle = modified(EQUAL, CROWNED, CROWNED).cycle(FORCE)
    assert cycle.line_load == pytest.approx(cycle.line_load[:, :, ::-1], rel=1e-7, abs=1e-3)
    assert cycle.pattern(0).centre[1] == pytest.approx(0.0, abs=1e-9)
    assert cycle.face_load_factor > 1.05


def test_exchanged_gears_are_the_same_contact():
    """Reciprocity: 16/24 and 24/16 carry alike at mirrored places, tips relieved so that no corner touches."""
    relieved = Microgeometry(tip_relief=60e-6, tip_relief_length=5e-3)
    loads, approaches = [], []
    for pair in (fzg_c(), exchanged_fzg_c()):
        mesh = sliced_mesh(pair, 3, gap=gap_of(pair, (relieved, relieved)), n_positions=4096)
        cycle = mesh.cycle(0.3 * FORCE)
        assert not (cycle.early.any() or cycle.late.any())
        loads.append((cycle.pattern(0).path, cycle.pattern(0).line_load[:, 1]))
        approaches.append(cycle.approach.mean())
    path, load = loads[0]
    mirrored = np.interp(path, -loads[1][0][::-1], loads[1][1][::-1])
    assert mirrored == pytest.approx(load, abs=0.003 * load.max())
    assert approaches[0] == pytest.approx(approaches[1], rel=1e-4)


@pytest.mark.parametrize("where", ["slope", "misalignment"])
def test_slope_and_misalignment_load_the_end_with_less_gap(where):
    slope = Microgeometry(helix_slope=20e-6)
    tilt = 20e-6 / EQUAL.face_width
    mesh = modified(EQUAL, slope) if where == "slope" else modified(EQUAL, misalignment=tilt)
    cycle = mesh.cycle(FORCE)
    assert cycle.pattern(0).centre[1] < -1e-3 and cycle.pattern(1).centre[1] < -1e-3
    opposite = (
        modified(EQUAL, Microgeometry(helix_slope=-20e-6))
        if where == "slope"
        else modified(EQUAL, misalignment=-tilt)
    )
    assert opposite.cycle(FORCE).pattern(0).centre[1] == pytest.approx(-cycle.pattern(0).centre[1], rel=1e-6)
    assert cycle.face_load_factor > 1.2
    assert cycle.face_load_factor == pytest.approx(opposite.cycle(FORCE).face_load_factor, rel=1e-6)


def test_slope_without_elastic_coupling_follows_the_hand_value():
    """Slices of equal compliance c under a linear gap of total f: K = 1 + f / (2 c w_m); c by the tangent."""
    even, tilted = (
        sliced_mesh(EQUAL, 21, gap=gap_of(EQUAL, (Microgeometry(helix_slope=f), PLAIN)), n_positions=8)
        for f in (0.0, 2e-6)
    )
    cycle = even.cycle(FORCE)
    c = 1.0 / (cycle.tangent_stiffness / EQUAL.face_width)
    mean = FORCE / EQUAL.face_width
    expected = 1.0 + 2e-6 / (2.0 * c * mean)
    load = (tilted.cycle(FORCE).force.sum(axis=1) / tilted.grid.width).max(axis=1) / mean
    assert load == pytest.approx(expected, rel=0.01)


def test_crowning_draws_the_pattern_to_the_middle():
    flat, crowned = (modified(EQUAL, one).cycle(FORCE) for one in (PLAIN, Microgeometry(lead_crowning=30e-6)))
    edge, middle = crowned.pattern(0).line_load[:, 0].max(), crowned.pattern(0).line_load[:, 5].max()
    assert edge < 0.5 * middle
    assert flat.pattern(0).line_load[:, 0].max() == pytest.approx(
        flat.pattern(0).line_load[:, 5].max(), rel=1e-9
    )


def test_twist_loads_the_corners_it_leaves_proud():
    """Gap at the tip at +b/2 and at the root at -b/2: load at the tip of -b/2 and at the root of +b/2."""
    pattern = modified(EQUAL, Microgeometry(profile_twist=15e-6)).cycle(FORCE).pattern(0)
    inside = (pattern.path > EQUAL.path.start) & (pattern.path < EQUAL.path.end)
    tip = inside & (pattern.path > 0.5 * EQUAL.path.end)
    root = inside & (pattern.path < 0.5 * EQUAL.path.start)
    load = pattern.line_load
    assert load[tip, 0].sum() > 1.5 * load[tip, -1].sum()
    assert load[root, -1].sum() > 1.5 * load[root, 0].sum()
    wheel = modified(EQUAL, PLAIN, Microgeometry(profile_twist=15e-6)).cycle(FORCE).pattern(1)
    high = wheel.roll > np.median(wheel.roll)
    assert (wheel.line_load * high)[:, 0].sum() > 1.2 * (wheel.line_load * high)[:, -1].sum()


@pytest.mark.parametrize("pair", [EQUAL, HELICAL, fzg_c()], ids=["equal", "helical", "FZG-C"])
def test_contact_ratio_without_load_is_the_geometric_one(pair):
    mesh = sliced_mesh(pair, 41 if pair is HELICAL else 3)
    assert unloaded_contact_ratio(mesh.points(1e-4, 2048)) == pytest.approx(
        pair.total_contact_ratio, abs=3e-4
    )


def test_contact_ratio_under_vanishing_load_goes_to_the_geometric_one():
    ratios = [
        sliced_mesh(EQUAL, 1, n_positions=256).cycle(force).contact_ratio
        for force in (FORCE, 0.01 * FORCE, 1e-4 * FORCE)
    ]
    assert ratios[0] > 1.1 * ratios[1] > 1.1 * ratios[2]
    assert ratios[2] == pytest.approx(EQUAL.total_contact_ratio, abs=0.005)


def test_crowned_profiles_hand_over_from_pair_to_pair_without_load():
    points = modified(EQUAL, CROWNED, CROWNED).points(1e-4, 1024)
    assert unloaded_contact_ratio(points) == pytest.approx(1.0, abs=1e-4)
    assert unloaded_contact_ratio(points, separation=1e-6) > 1.02
    assert modified(EQUAL, CROWNED, CROWNED).cycle(1.0).contact_ratio < 1.2


def test_early_contact_is_that_of_the_tip_of_the_wheel():
    cycle = sliced_mesh(spur_pair(), 1).cycle(3900.0)
    assert cycle.early.any() and cycle.late.any()
    assert np.all(cycle.points.place.corner[cycle.early] == 2) and np.all(
        cycle.points.place.corner[cycle.late] == 1
    )
    assert np.all(cycle.points.path[cycle.early] < spur_pair().path.tip_start)
    assert np.all(cycle.edge_contact[cycle.early | cycle.late])
    assert cycle.edge_contact.sum() > (cycle.early | cycle.late).sum()
    assert 0.0 < cycle.flank_pressure < 0.5 * cycle.pressure.max()
    assert cycle.pattern(0).edge.sum() == cycle.edge_contact.sum()


def test_softer_edges_carry_less():
    pair = fzg_c()
    soft, hard = (sliced_mesh(pair, 1, edges=EdgeModel(softer=one)).cycle(FORCE) for one in (True, False))
    near = hard.early | hard.late
    assert soft.force[near].sum() < hard.force[near].sum()
    assert np.all(soft.approach >= hard.approach - 1e-12)


def test_pitch_deviation_takes_load_from_one_pair_and_raises_k_h_alpha():
    def gap(pairs, face, path, rolls):
        return 8e-6 * (pairs % 2)

    relief = Microgeometry(tip_relief=40e-6, tip_relief_length=1.0e-3)
    shape = gap_of(EQUAL, (relief, relief))
    clean = sliced_mesh(EQUAL, 1, gap=shape)
    deviating = replace(clean, gap=lambda *at: shape(*at) + gap(*at))
    loaded, reference = deviating.cycle(FORCE), clean.cycle(FORCE)
    odd = loaded.points.pairs % 2 == 1
    assert loaded.load_share[:, odd].sum() < reference.load_share[:, odd].sum() - 5.0
    assert reference.transverse_load_factor(reference) == 1.0
    assert loaded.transverse_load_factor(reference) >= 1.0


def test_tangent_stiffness_is_the_derivative_of_the_force():
    mesh = interpolated_mesh(EQUAL, gap=gap_of(EQUAL, (CROWNED, CROWNED)), n_positions=8)
    low, middle, high = (mesh.cycle(FORCE * f) for f in (0.9999, 1.0, 1.0001))
    # the width at which edges act follows the load: held by the mean of both sides up to 1e-3
    assert 2e-4 * FORCE / (high.approach - low.approach) == pytest.approx(middle.tangent_stiffness, rel=2e-3)
    assert np.all(middle.secant_stiffness < middle.tangent_stiffness)


def test_backlash_is_not_used_up():
    """Front flanks approach by less than the backlash for the pair to stay free behind."""
    cycle = sliced_mesh(spur_pair(thickness_allowances=(40e-6, 60e-6)), 1).cycle(3900.0)
    play = spur_pair(thickness_allowances=(40e-6, 60e-6)).backlash_along_path
    assert np.all(-cycle.approach - play < 0.0)


def test_helical_positions_lag_by_the_base_helix():
    points = sliced_mesh(HELICAL, 5).points(1e-4)
    step = np.diff(points.path, axis=2)
    assert step == pytest.approx(-np.tan(HELICAL.base_helix_angle) * 10e-3)
    assert points.weight[points.place.corner == 0] == pytest.approx(cos(HELICAL.base_helix_angle))


def test_pattern_covers_the_active_flank_and_grows_with_the_path():
    cycle = sliced_mesh(HELICAL, 21).cycle(FORCE)
    for gear, turn in ((0, 1.0), (1, -1.0)):
        pattern = cycle.pattern(gear)
        assert np.all(np.diff(pattern.path) > 0.0)
        roll = pattern.roll[pattern.touched]
        flank = HELICAL.gears[gear]
        assert hypot(flank.base_radius, roll.max()) == pytest.approx(flank.tip_radius, rel=1e-6)
        inner = (pattern.path > HELICAL.path.start + 3e-3) & (pattern.path < HELICAL.path.end - 3e-3)
        assert np.all(turn * np.diff(pattern.roll[inner, 10]) > 0.0)


def test_force_that_cannot_be_and_teeth_that_approach_too_far_are_refused():
    mesh = sliced_mesh(EQUAL, 1, n_positions=4)
    for force in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(DynamicsInputError, match="mesh force"):
            mesh.cycle(force)
    with pytest.raises(DynamicsNotConverged, match="approach"):
        mesh.cycle(1e6 * FORCE)
    with pytest.raises(DynamicsInputError, match="finite"):
        replace(mesh, gap=lambda n, z, s, _: np.full_like(s, np.nan)).cycle(FORCE)
    with pytest.raises(DynamicsInputError, match="least_radius"):
        EdgeModel(least_radius=0.0)


def test_neighbours_stand_behind_the_pinion_flank_and_before_the_wheel_flank():
    """Pair p + 1 follows: its pinion tooth is the one the loaded flank turns its back to, its wheel tooth the other."""
    pair = EQUAL
    gears = tuple(influence_of(pair, index, neighbour=share) for index, share in ((0, 0.05), (1, 0.09)))
    mesh = LoadedMesh(pair=pair, gears=gears, grid=FaceGrid.over(pair.face_width, 11))
    points = mesh.points(5e-5)
    cycle = mesh.cycle(FORCE)
    k = int(np.argmax((cycle.closing.max(axis=2) > 0.0).sum(axis=1)))
    within = np.isfinite(points.gap[k])
    rows, columns = np.nonzero(within)
    compliance = mesh._problem(points, cycle.local, k, within).compliance
    first, second = sorted(set(points.pairs[rows]))[:2]
    i = int(np.flatnonzero((points.pairs[rows] == first) & (columns == 5))[0])
    j = int(np.flatnonzero((points.pairs[rows] == second) & (columns == 5))[0])
    expected = 0.0
    for gear, offset in ((0, 1), (1, -1)):
        roll, face = points.place.roll[gear][k][within][[i, j]], np.zeros(2)
        shapes = gears[gear].shapes(roll, face)
        expected += shapes[0] @ gears[gear].deflection[offset] @ shapes[1]
    assert compliance[i, j] == pytest.approx(expected, rel=1e-9)


def test_sliding_changes_sign_at_the_pitch_point_and_follows_the_mating_flank_at_corners():
    points = sliced_mesh(fzg_c(), 1).points(1e-4)
    pair, path = fzg_c(), points.path
    on_path = points.place.corner == 0
    expected = path * (1.0 + 1.0 / pair.gear_ratio)
    assert points.sliding[on_path] == pytest.approx(expected[on_path], abs=1e-12)
    outside = np.isfinite(points.gap) & ~on_path
    assert outside.any() and np.all(np.sign(points.sliding[outside]) == np.sign(path[outside]))


def test_reach_grows_with_the_gap_and_an_even_gap_only_adds_to_the_approach():
    plain, apart = (
        sliced_mesh(EQUAL, 1, gap=lambda n, z, s, _, g=g: np.full_like(s, g)).cycle(FORCE)
        for g in (0.0, 3e-4)
    )
    assert apart.points.reach > 3e-4 > plain.points.reach
    assert apart.approach - 3e-4 == pytest.approx(plain.approach, rel=1e-9)
