"""Gap of a pair: both flanks, axes, expansion, corners beyond the path; P1's test gear by hand."""

from math import cos, radians, sin, tan

import numpy as np
import pytest

from dynamics.errors import DynamicsInputError
from dynamics.gear.cylindrical_gear import Rack
from dynamics.gear.flank import AxisMisalignment, FlankField, TeethInMesh
from dynamics.gear.involute import GearGeometryError
from dynamics.gear.microgeometry import Microgeometry
from dynamics.gear.pair import GearPair
from dynamics.tooth.mesh_laws import MeshPosition, mesh_law, pair_stiffness
from dynamics.tooth.pair_gap import PairGap, tip_separation
from tests.builders.p1_gears import PINION, TWIST, WHEEL, p1_pair
from tests.builders.p2_gears import ALLOWANCES, helical_pair, spur_pair

SPUR, HELICAL, P1 = spur_pair(**ALLOWANCES), helical_pair(**ALLOWANCES), p1_pair()


def corners(pair, gap, flank="front"):
    """Gap at the ends of the path (rows: start, end) and of the face (columns: front, rear)."""
    path, half = np.array([[pair.path.start], [pair.path.end]]), 0.5 * pair.face_width
    return gap.modifications(path, np.array([[-half, half]]), flank)


def test_corners_of_p1s_test_gear_by_hand():
    """Crownings 25 + 32 + 3 um, twist +-40 um, helix slope -+5 um: two opposite corners are free."""
    gap = PairGap.of_pair(P1, (PINION, WHEEL))
    expected = 1e-6 * np.array([[60 - 40 + 5, 60 + 40 - 5], [60 + 40 + 5, 60 - 40 - 5]])
    assert corners(P1, gap) == pytest.approx(expected, abs=1e-12)
    path = 0.5 * (P1.path.start + P1.path.end)
    assert float(gap.at(path, 0.0, 0)) == pytest.approx(0.0, abs=1e-12)
    assert gap.normal(path, 12.5e-3, 0) == pytest.approx(cos(P1.base_helix_angle) * 30e-6, rel=1e-9)


def test_p1s_twist_as_the_amount_at_the_corner_would_stand_out_of_the_flank():
    wheel = Microgeometry(profile_crowning=25e-6, lead_crowning=32e-6, profile_twist=TWIST)
    assert corners(P1, PairGap.of_pair(P1, (Microgeometry(), wheel))).min() == pytest.approx(-103e-6)
    assert corners(P1, PairGap.of_pair(P1, (Microgeometry(), WHEEL))).min() == pytest.approx(17e-6)


@pytest.mark.parametrize("helix", [8.0, 10.0, 14.0])
def test_p1s_twist_is_more_than_the_natural_one_of_its_crowning(helix):
    """C_beta 32 um alone brings 8 C_beta L tan(beta_b) / b: a third of the 160 um printed at most."""
    pair = p1_pair(helix)
    wheel = FlankField(pair=pair, index=1, micro=Microgeometry(lead_crowning=32e-6, manufacturing_twist=1.0))
    expected = 8 * 32e-6 * pair.path.length * tan(pair.base_helix_angle) / 25e-3
    assert abs(wheel.natural_twist) == pytest.approx(expected, rel=1e-12)
    assert abs(wheel.natural_twist) < 0.4 * TWIST


def test_natural_twists_of_two_crowned_gears_add():
    """Both worms trace the common normal of the flanks, so that the gap sees twice the twist; mirrored on the back."""
    both = Microgeometry(lead_crowning=10e-6, manufacturing_twist=1.0)
    one = corners(HELICAL, PairGap.of_pair(HELICAL, (both, Microgeometry())))
    two = corners(HELICAL, PairGap.of_pair(HELICAL, (Microgeometry(), both)))
    assert two == pytest.approx(one, rel=1e-9)
    assert one[1, 1] < one[0, 1] and one[1, 0] > one[0, 0]
    behind = corners(HELICAL, PairGap.of_pair(HELICAL, (both, both)), "back")
    assert behind == pytest.approx(2.0 * one[:, ::-1], rel=1e-9)


@pytest.mark.parametrize("flank", ["front", "back"])
def test_axes_open_the_gap_by_the_projections_on_the_line_of_action(flank):
    """1 mrad over 10 mm: 10 um sin(alpha_wt) in the plane of the axes, 10 um cos(alpha_wt) out of it."""
    angle, side = SPUR.working_pressure_angle, 1.0 if flank == "front" else -1.0
    for axes, expected in (
        (AxisMisalignment(inclination=1e-3), 10e-6 * sin(angle)),
        (AxisMisalignment(skew=1e-3), side * 10e-6 * cos(angle)),
    ):
        gap = PairGap.of_pair(SPUR, axes=axes)
        assert np.diff(gap.modifications(2e-3, np.array([-5e-3, 5e-3]), flank)) == pytest.approx(
            expected, rel=1e-12
        )
    assert AxisMisalignment.of_gap(SPUR, 3e-4, 1e-4).gap_slope(SPUR) == pytest.approx((3e-4, 1e-4))


def test_unequal_expansion_opens_the_path():
    """40 K between the gears: 11.5e-6 x 40 of the way along the path."""
    warm = SPUR.warm(440.0, 400.0, 99.6e-3)
    gap = PairGap.of_pair(warm)
    assert np.diff(gap.modifications(np.array([1e-3, 3e-3]), 0.0)) == pytest.approx(
        -11.5e-6 * 40 * 2e-3, rel=1e-2
    )


def test_beyond_the_path_the_corner_opens_on_top_of_the_modification_of_the_end():
    gap = PairGap.of_pair(P1, (PINION, WHEEL))
    path = np.array([P1.path.start - 1e-3, P1.path.end + 1e-3])
    ends = gap.modifications(np.array([P1.path.start, P1.path.end]), 5e-3)
    assert gap.at(path, 5e-3, 0) == pytest.approx(tip_separation(P1, path) + ends, rel=1e-9)
    assert np.all(gap.at(path, 5e-3, 0) > ends)


@pytest.mark.parametrize("flank", ["front", "back"])
def test_gap_is_that_of_the_mesh_law_on_both_flanks(flank):
    """Every pair, place and slice against the tables of the law, which the response uses."""
    rng = np.random.default_rng(3)
    micro = tuple(
        Microgeometry(
            pitch_deviations=tuple(3e-6 * rng.standard_normal(teeth)), run_out=8e-6, run_out_phase=0.4,
            profile_slopes=tuple(2e-6 * rng.standard_normal(teeth)), lead_crowning=5e-6, profile_twist=3e-6,
            root_relief=6e-6, root_relief_length=0.3e-3, end_relief=(4e-6, 2e-6), end_relief_length=5e-3,
        )
        for teeth in HELICAL.teeth
    )  # fmt: skip
    count = TeethInMesh(phase=0.4e-3, tooth_offset_2=7)
    law = mesh_law(
        HELICAL, pair_stiffness(HELICAL, 2e5), micro, position=MeshPosition(phase=0.4e-3, tooth_offset_2=7)
    )
    gap = PairGap.of_pair(HELICAL, micro, count=count)
    path = law.path_start + law.path_step * np.arange(law.gap.shape[1])
    slices = len(law.slice_shift)
    face = ((np.arange(slices) + 0.5) / slices - 0.5) * HELICAL.face_width
    one, two = (
        (law.deviation_1, law.deviation_2)
        if flank == "front"
        else (law.back_deviation_1, law.back_deviation_2)
    )
    for pair in (-3, 0, 50, 120):
        tables = law.gap + one[pair % 99] + two[(pair + 7 + (flank == "back")) % 102]
        assert gap.at(path, face[:, None], pair, flank) == pytest.approx(tables, abs=1e-15)


def test_pointed_and_undercut_teeth_are_refused():
    undercut = GearPair.from_centre_distance(
        normal_module=4e-3, teeth=(12, 40), centre_distance=104e-3, face_widths=(20e-3, 20e-3), profile_shift_1=0.0,
        racks=(Rack(addendum=1.0), Rack(addendum=1.0)),
    )  # fmt: skip
    assert undercut.gears[0].undercut
    with pytest.raises(
        GearGeometryError, match=r"pinion: undercut takes .*limit 0 mm.*raise its profile shift"
    ):
        PairGap.of_pair(undercut)
    shape = {
        "normal_module": 4e-3, "teeth": (12, 60), "centre_distance": 150e-3, "face_widths": (20e-3, 20e-3),
        "pressure_angle": radians(20.0), "profile_shifts": (1.2, 0.4), "tip_diameters": (66e-3, 251.0e-3),
    }  # fmt: skip
    pointed = GearPair(**shape, expansion=(1e-9, 1e-9))  # a warm pair is not asked whether it can be made
    assert pointed.gears[0].tip_thickness <= 0.0
    with pytest.raises(GearGeometryError, match=r"pointed tooth\); reduce profile shift"):
        PairGap.of_pair(pointed)


def test_micro_geometry_of_another_gear_is_refused():
    with pytest.raises(DynamicsInputError, match="99 values for 102 teeth"):
        PairGap.of_pair(SPUR, (Microgeometry(), Microgeometry(profile_slopes=(0.0,) * 99)))
