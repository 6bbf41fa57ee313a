"""Tip edge, protuberance and body of the gears of a pair: path of contact, tip corners, mass, limits."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from dynamics.gear.flank import require_whole_flanks
from dynamics.gear.involute import GearGeometryError
from dynamics.gear.pair import GearPair
from dynamics.gear.pair_geometry import TipShortening
from dynamics.gear.tooth_form import GearDetails, TipEdge, ToothForm
from dynamics.rating.iso_rating import mesh_data, root_stress
from dynamics.tooth.corner import contact_places, tip_ends
from dynamics.tooth.loaded_mesh import LoadedMesh
from dynamics.tooth.pair_gap import tip_separation
from tests.builders.loaded_mesh import fzg_c, sliced_mesh

PAIR = fzg_c()


def with_details(first: GearDetails, second: GearDetails | None = None, pair: GearPair = PAIR) -> GearPair:
    return replace(pair, details=(first, second or GearDetails()))


def test_plain_details_change_nothing() -> None:
    same = replace(PAIR, details=(GearDetails(), GearDetails()))
    assert same == PAIR and same.path == PAIR.path
    assert same.flanks[0].tip_radius == PAIR.gears[0].tip_radius


def test_a_chamfer_ends_the_path_where_it_begins() -> None:
    pair = with_details(GearDetails(tip_edge=TipEdge(chamfer=0.2e-3)))
    gear = PAIR.gears[0]
    end = gear.roll_length(gear.tip_radius - 0.2e-3) - PAIR.rolling_radii[0]
    assert pair.path.end == pytest.approx(end, abs=1e-15)
    assert pair.path.start == PAIR.path.start
    assert pair.transverse_contact_ratio < PAIR.transverse_contact_ratio - 0.02


def test_a_rounding_ends_the_path_at_its_flank_and_grows_with_the_gear() -> None:
    details = GearDetails(tip_edge=TipEdge(rounding=0.3e-3))
    pair = with_details(GearDetails(), details)
    form = ToothForm(gear=PAIR.gears[1], tip_edge=details.tip_edge)
    assert pair.path.start == pytest.approx(PAIR.rolling_radii[1] - form.flank_tip_roll, abs=1e-15)
    warm = pair.warm(393.15, 393.15, pair.centre_distance)
    grown = 1.0 + warm.expansion[1]
    assert warm.flanks[1].tip_radius == pytest.approx(grown * form.flank_tip_radius, rel=1e-12)
    assert tip_ends(warm)[1].rounding == pytest.approx(grown * 0.3e-3)


def test_tip_corners_of_a_chamfered_pair_are_alike_in_mesh_law_and_contact() -> None:
    details = GearDetails(tip_edge=TipEdge(chamfer=0.2e-3))
    pair = with_details(details, details)
    path = np.concatenate(
        [pair.path.start - np.array([2.0, 0.5]) * 1e-3, pair.path.end + np.array([0.5, 2.0]) * 1e-3]
    )
    assert contact_places(pair, path).gap == pytest.approx(tip_separation(pair, path), rel=1e-9)


def test_no_point_of_a_rounded_edge_is_out_of_reach() -> None:
    """Points that a larger reach finds within the smaller one are among those of the smaller one."""
    details = GearDetails(tip_edge=TipEdge(rounding=0.5e-3))
    mesh: LoadedMesh = sliced_mesh(with_details(details, details), n_face=1)
    near, far = mesh.points(40e-6), mesh.points(80e-6)
    assert np.sum(near.gap <= 40e-6) == np.sum(far.gap <= 40e-6)


def test_a_tip_cut_to_a_contact_ratio_counts_the_tip_edge() -> None:
    details = GearDetails(tip_edge=TipEdge(chamfer=0.2e-3))
    pair = GearPair.from_centre_distance(
        normal_module=4.5e-3,
        teeth=(16, 24),
        centre_distance=91.5e-3,
        face_widths=(14e-3, 14e-3),
        profile_shift_1=0.1817,
        tips=TipShortening(contact_ratio=1.3),
        details=(details, details),
    )
    assert pair.transverse_contact_ratio == pytest.approx(1.3, abs=1e-9)


def test_a_protuberance_takes_flank_and_root() -> None:
    pair = with_details(GearDetails(protuberance=0.05e-3))
    assert pair.flanks[0].form_radius > PAIR.flanks[0].form_radius
    assert pair.fillet_overlaps[0] == 0.0
    loaded = [root_stress(entry, 100.0, 0).sigma_F for entry in (PAIR, pair)]
    assert loaded[1] > loaded[0] * 1.005
    with pytest.raises(
        GearGeometryError, match=r"pinion: protuberance = 0\.180 mm takes .* mm of the path .*reduce"
    ):
        require_whole_flanks(with_details(GearDetails(protuberance=0.18e-3)))


def test_rim_and_web_weigh_what_they_are() -> None:
    pair = with_details(
        GearDetails(rim_thickness=8e-3, web_thickness=5e-3), pair=replace(PAIR, bore_diameters=(20e-3, 0.0))
    )
    outer, inner, bore = pair.gears[0].mean_radius, pair.root_radii[0] - 8e-3, 10e-3
    rim, web = (
        pair.densities[0] * pi * width * (one**2 - two**2)
        for width, one, two in ((14e-3, outer, inner), (5e-3, inner, bore))
    )
    assert pair.masses[0] == pytest.approx(rim + web)
    assert pair.inertias[0] == pytest.approx(
        0.5 * rim * (outer**2 + inner**2) + 0.5 * web * (inner**2 + bore**2)
    )
    assert mesh_data(pair).b_s_over_b == (pytest.approx(5.0 / 14.0), None)
    solid = replace(pair, details=(GearDetails(rim_thickness=8e-3), GearDetails()))
    plain = replace(pair, details=(GearDetails(), GearDetails()))
    assert solid.inertias == pytest.approx(plain.inertias)


@pytest.mark.parametrize(
    ("details", "message"),
    [
        (
            GearDetails(rim_thickness=40e-3),
            r"pinion: rim_thickness = 40\.000 mm reaches into the bore, limit 3",
        ),
        (
            GearDetails(rim_thickness=4e-3),
            r"rim_thickness = 4\.000 mm is a rim of 0\.\d+ tooth heights.*exceed 0\.5; make",
        ),
        (GearDetails(web_thickness=4e-3), r"web_thickness = 4\.000 mm needs a rim_thickness"),
        (GearDetails(rim_thickness=8e-3, web_thickness=15e-3), r"at most at the face width 14\.000 mm"),
        (
            GearDetails(tip_edge=TipEdge(rounding=3e-3)),
            r"tip_edge\.rounding = 3\.000 mm.*(reduce the tip edge|overlap)",
        ),
    ],
)
def test_bodies_and_edges_that_cannot_be_made_are_named(details: GearDetails, message: str) -> None:
    with pytest.raises(GearGeometryError, match=message):
        with_details(details)
