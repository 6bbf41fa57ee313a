from dataclasses import replace
from math import acos, cos, degrees, log, pi, radians, sin, sqrt, tan

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dynamics.gear.cylindrical_gear import CylindricalGear, Rack
from dynamics.gear.involute import GearGeometryError, involute
from dynamics.gear.pair import GearPair
from dynamics.gear.pair_geometry import TipShortening
from dynamics.rating import iso_rating

UHCF = {
    "normal_module": 1e-3,
    "teeth": (99, 102),
    "centre_distance": 99.5e-3,
    "face_widths": (7e-3, 15e-3),
    "profile_shift_1": 0.0,
    "tips": TipShortening(contact_ratio=1.26, cut_gear="wheel"),
}
SPUR_50 = {
    "normal_module": 3e-3,
    "teeth": (50, 50),
    "centre_distance": 0.15,
    "face_widths": (20e-3, 20e-3),
    "profile_shift_1": 0.0,
}
FZG_A = {
    "normal_module": 4.5e-3,
    "teeth": (16, 24),
    "centre_distance": 91.5e-3,
    "face_widths": (20e-3, 20e-3),
    "profile_shift_1": 0.8532,
}


def make(base, **changes):
    return GearPair.from_centre_distance(**{**base, **changes})


def test_uhcf_test_gear_has_its_pitch_point_outside_the_path():
    pair = make(UHCF)
    assert degrees(pair.working_pressure_angle) == pytest.approx(18.353, abs=5e-4)
    assert sum(pair.profile_shifts) == pytest.approx(-0.9610, abs=5e-5)
    assert pair.transverse_contact_ratio == pytest.approx(1.26, abs=1e-12)
    assert 0.0 < pair.path.start < pair.path.end
    assert pair.path.end < pair.path.tip_end
    assert pair.face_width == 7e-3
    assert pair.total_contact_ratio == pair.transverse_contact_ratio


def tip_contact_ratio(pair):
    """eps_alpha that the tips alone would give [-]."""
    return (pair.path.tip_end - pair.path.tip_start) / pair.base_pitch


@pytest.mark.parametrize(("shift", "cut"), [(0.0, 0.705), (None, 0.784), (-0.714, 0.802)])
def test_tip_cut_that_gives_the_contact_ratio_of_the_tips(shift, cut):
    """Published cut depths count the tip circles only; a fine tool radius leaves both limits equal."""
    first = "equal" if shift is None else shift
    pair = make(UHCF, profile_shift_1=first, tips=TipShortening(shortening=(0.0, cut * 1e-3)))
    assert tip_contact_ratio(pair) == pytest.approx(1.26, abs=1e-3)
    assert pair.transverse_contact_ratio <= tip_contact_ratio(pair)


def test_a_thin_rim_warns_and_adds_to_the_root_stress():
    """Y_B = 1.6 ln(2.242 h_t / s_R) below 1.2 tooth heights (ISO 6336-3, clause 9), 1 above."""
    solid, thick, thin = (make(SPUR_50, bore_diameters=(bore, 0.0)) for bore in (0.0, 0.12, 0.13))
    height = 2.25 * 3e-3
    rim = 75e-3 - 1.25 * 3e-3 - 65e-3
    assert thick.warnings == ()
    assert f"{rim / height:.2f} tooth heights" in thin.warnings[0]
    stress = [iso_rating.root_stress(pair, 100.0, 0).sigma_F0 for pair in (solid, thick, thin)]
    assert stress[1] == stress[0]
    assert stress[2] / stress[0] == pytest.approx(1.6 * log(2.242 * height / rim), rel=1e-9)
    assert iso_rating.root_stress(thin, 100.0, 1).sigma_F0 == iso_rating.root_stress(solid, 100.0, 1).sigma_F0
    with pytest.raises(GearGeometryError, match=r"rim of 0\.\d+ tooth heights under the root.*reduce"):
        make(SPUR_50, bore_diameters=(0.137, 0.0))


def test_reference_gear_contact_ratios():
    full = make(
        UHCF,
        normal_module=0.95e-3,
        helix_angle=radians(18.0),
        face_widths=(40e-3, 40e-3),
        tips=TipShortening(),
    )
    assert full.overlap_ratio == pytest.approx(4.142, abs=5e-4)
    assert sum(full.profile_shifts) == pytest.approx(-0.9060, abs=5e-5)
    assert degrees(full.transverse_pressure_angle) == pytest.approx(20.942, abs=5e-4)
    assert degrees(full.working_pressure_angle) == pytest.approx(19.562, abs=5e-4)
    assert tip_contact_ratio(full) + full.overlap_ratio == pytest.approx(5.957, abs=5e-4)
    assert full.total_contact_ratio < tip_contact_ratio(full) + full.overlap_ratio - 0.05
    assert full.fillet_distances == pytest.approx((-0.1568e-3, -0.0061e-3), abs=1e-7)
    assert 0.0 < full.fillet_overlaps[1] < full.fillet_overlaps[0] == pytest.approx(2.28e-6, abs=1e-8)


def test_spur_pair_by_hand():
    pair = make(SPUR_50)
    roll = sqrt(78.0**2 - (75.0 * cos(radians(20))) ** 2)
    length = 2.0 * (roll - 75.0 * sin(radians(20)))
    assert 1e3 * pair.path.length == pytest.approx(length)
    assert pair.transverse_contact_ratio == pytest.approx(length / (3.0 * pi * cos(radians(20))))
    assert pair.path.start == pytest.approx(-pair.path.end)
    assert pair.tip_clearances == pytest.approx((0.75e-3, 0.75e-3))
    assert pair.transverse_backlash == pytest.approx(0.0, abs=1e-15)
    assert pair.rolling_radii[0] == pytest.approx(75e-3 * sin(radians(20)))
    assert pair.path.inner_single_contact == pytest.approx(pair.path.end - pair.base_pitch)
    assert pair.warnings == ()


def test_fzg_a_wheel_is_undercut_below_its_active_flank():
    pair = make(FZG_A)
    assert pair.profile_shifts[1] == pytest.approx(-0.50002, abs=5e-6)
    assert pair.gears[1].undercut
    assert pair.transverse_contact_ratio == pytest.approx(tip_contact_ratio(pair))


def test_masses_and_inertias_of_bored_bodies():
    pair = make(SPUR_50, bore_diameters=(40e-3, 0.0))
    outer = 0.5 * (78.0 + 71.25) * 1e-3
    mass = 7830.0 * pi * (outer**2 - 0.02**2) * 0.02
    assert pair.masses[0] == pytest.approx(mass)
    assert pair.inertias[0] == pytest.approx(0.5 * mass * (outer**2 + 0.02**2))
    assert pair.inertias[1] == pytest.approx(0.5 * 7830.0 * pi * outer**4 * 0.02)


def test_thinned_teeth_have_the_backlash_of_their_allowances():
    pair = make(SPUR_50, thickness_allowances=(30e-6, 50e-6))
    assert pair.transverse_backlash == pytest.approx(80e-6, rel=1e-12)
    assert pair.backlash_along_path == pytest.approx(80e-6 * cos(radians(20)), rel=1e-12)
    helical = make(
        SPUR_50,
        normal_module=3e-3 * cos(radians(15)),
        helix_angle=radians(15),
        thickness_allowances=(30e-6, 50e-6),
    )
    assert helical.transverse_backlash == pytest.approx(80e-6 / cos(radians(15)), rel=1e-12)


def test_hot_gears_in_a_cooler_box_close_the_backlash():
    """Gears 170 degC, housing 100 degC, a = 99.5 mm: -0.084 mm and about -56 um (12e-6 1/K)."""
    cold = make(UHCF, thickness_allowances=(50e-6, 50e-6))
    growth = 12e-6
    box = 99.5e-3 * (1.0 + growth * 80.0)
    hot = cold.warm(443.15, 443.15, box, expansion_coefficients=(growth, growth))
    net = box - 99.5e-3 * (1.0 + growth * 150.0)
    assert 1e3 * net == pytest.approx(-0.084, abs=5e-4)
    change = hot.transverse_backlash - cold.transverse_backlash
    assert change == pytest.approx(2.0 * tan(cold.working_pressure_angle) * net, rel=0.01)
    assert 1e6 * change == pytest.approx(-55.3, abs=1.0)
    assert hot.tip_clearances[0] - cold.tip_clearances[0] == pytest.approx(net, rel=0.01)
    assert hot.working_pressure_angle < cold.working_pressure_angle


def test_uniform_warming_with_the_box_only_scales():
    cold = make(UHCF, thickness_allowances=(50e-6, 50e-6))
    scale = 1.0 + 11.5e-6 * 100.0
    hot = cold.warm(393.15, 393.15, cold.centre_distance * scale)
    assert hot.transverse_backlash == pytest.approx(cold.transverse_backlash * scale, rel=1e-9)
    assert hot.working_pressure_angle == pytest.approx(cold.working_pressure_angle, rel=1e-12)
    assert hot.transverse_contact_ratio == pytest.approx(cold.transverse_contact_ratio, rel=1e-9)
    assert hot.path.length == pytest.approx(cold.path.length * scale, rel=1e-9)
    assert hot.base_pitch_difference == pytest.approx(0.0, abs=1e-15)


def test_warming_twice_starts_from_the_cold_gears():
    cold = make(UHCF)
    once = cold.warm(400.0, 390.0, 99.6e-3, speed=900.0)
    assert cold.warm(440.0, 440.0, 99.7e-3).warm(400.0, 390.0, 99.6e-3, speed=900.0) == once
    assert once.base_pitch_difference == pytest.approx(
        cold.base_pitch * (once.expansion[1] - once.expansion[0]), rel=1e-9
    )


def test_centrifugal_growth_of_a_solid_and_a_bored_disc():
    pair = make(UHCF, bore_diameters=(30e-3, 0.0))
    speed, radius, bore = 12000 * pi / 30, 49.5e-3, 15e-3
    expected = 7830 * speed**2 * (0.7 * radius**2 + 3.3 * bore**2) / (4 * 206e9)
    assert pair.centrifugal_strain(0, speed) == pytest.approx(expected)
    still, spinning = (pair.warm(293.15, 293.15, 99.5e-3, speed=w) for w in (0.0, speed))
    assert spinning.expansion[0] == pytest.approx(expected)
    assert spinning.expansion[1] == pytest.approx(pair.centrifugal_strain(1, speed * 99 / 102))
    assert spinning.transverse_backlash < still.transverse_backlash - 1e-6


def test_a_jammed_warm_pair_is_a_warning_not_an_error():
    hot = make(UHCF).warm(443.15, 443.15, 99.5e-3)
    assert hot.transverse_backlash < -50e-6
    assert any("jam" in warning for warning in hot.warnings)


@pytest.mark.parametrize(
    ("base", "changes", "name", "remedy"),
    [
        (UHCF, {"centre_distance": 90e-3}, "working pressure angle", "increase"),
        (
            UHCF,
            {"tips": TipShortening(contact_ratio=2.5, cut_gear="wheel")},
            "contact_ratio = 2.5",
            "change addendum",
        ),
        (
            UHCF,
            {"tips": TipShortening(shortening=(0.0, 1.0e-3))},
            "total contact",
            "lengthen the tips",
        ),
        (
            UHCF,
            {"tips": TipShortening(contact_ratio=0.2, cut_gear="wheel")},
            "contact_ratio = 0.2",
            "change addendum",
        ),
        (UHCF, {"face_widths": (-7e-3, 15e-3)}, "face_widths[0]", "must be positive"),
        (UHCF, {"bore_diameters": (0.12, 0.0)}, "bore_diameters[0]", "reduce the bore"),
        (UHCF, {"helix_angle": radians(-18.0)}, "helix_angle", "without sign"),
        (SPUR_50, {"racks": (Rack(dedendum=0.95), Rack())}, "wheel: tip clearance", "shorten the tip"),
        (
            SPUR_50,
            {"racks": (Rack(addendum=0.95, dedendum=1.0, tip_radius=0.6),) * 2},
            "interference",
            "shorten",
        ),
        (SPUR_50, {"racks": (Rack(dedendum=1.25, tip_radius=1.5),) * 2}, "tool tip", "reduce"),
        (FZG_A, {"profile_shift_1": 1.6}, "pointed", "reduce"),
        (SPUR_50, {"normal_module": 0.0}, "normal_module", "correct"),
    ],
)
def test_gears_that_cannot_mesh_are_refused(base, changes, name, remedy):
    with pytest.raises(GearGeometryError) as failure:
        make(base, **changes)
    assert name in str(failure.value)
    assert remedy in str(failure.value)
    assert any(character.isdigit() for character in str(failure.value))


def test_negative_rack_is_refused():
    with pytest.raises(GearGeometryError, match=r"rack\.dedendum"):
        Rack(dedendum=-1.25)


def spur(teeth, shift, **rack):
    return CylindricalGear(
        normal_module=1e-3,
        pressure_angle=radians(20),
        helix_angle=0.0,
        teeth=teeth,
        profile_shift=shift,
        tip_diameter=(teeth + 2 + 2 * shift) * 1e-3,
        rack=Rack(**rack),
    )


@pytest.mark.parametrize(("teeth", "shift"), [(99, 0.0), (102, -0.961), (50, 0.0), (28, 0.3)])
def test_trochoid_joins_the_involute_at_the_form_circle(teeth, shift):
    gear = spur(teeth, shift)
    x, y = gear.trochoid_point(gear.pressure_angle)
    assert np.hypot(x, y) == pytest.approx(gear.form_radius, rel=1e-13)
    assert np.arctan2(x, y) == pytest.approx(gear.half_angle(gear.form_radius), rel=1e-10)
    bottom = gear.trochoid_point(pi / 2)
    assert np.hypot(*bottom) == pytest.approx(gear.root_radius, rel=1e-13)


def test_undercut_tooth_ends_where_trochoid_and_involute_cross():
    gear = spur(10, 0.0)
    assert gear.undercut
    assert gear.base_radius < gear.form_radius < gear.tip_radius
    angles = np.linspace(gear.pressure_angle, pi / 2, 20001)
    x, y = np.array([gear.trochoid_point(angle) for angle in angles]).T
    radii = np.hypot(x, y)
    outside = radii > gear.base_radius * (1 + 1e-9)
    half = gear.base_half_angle - np.array([involute(acos(gear.base_radius / r)) for r in radii[outside]])
    cut = np.arctan2(x[outside], y[outside]) < half
    assert radii[outside][cut].max() == pytest.approx(gear.form_radius, rel=1e-4)


def test_undercut_starts_at_the_known_limit():
    """z_min = 2 (h_fP - rho (1 - sin alpha)) / sin^2 alpha; with a sharp rack of h_fP = 1: 17.1 teeth."""
    assert spur(17, 0.0, dedendum=1.0, tip_radius=0.0).undercut
    assert not spur(18, 0.0, dedendum=1.0, tip_radius=0.0).undercut


@settings(max_examples=60, deadline=None)
@given(
    z=st.tuples(st.integers(20, 120), st.integers(20, 150)),
    sum_shift=st.floats(-0.3, 1.0),
    helix=st.floats(0.0, 0.5),
    split=st.floats(0.3, 0.7),
)
def test_centre_distance_and_shift_sum_are_inverse(z, sum_shift, helix, split):
    """The pair built from its centre distance has no backlash and the shift sum that it was made from."""
    alpha_t = np.arctan(tan(radians(20)) / cos(helix))
    target = involute(alpha_t) + 2 * tan(radians(20)) * sum_shift / sum(z)
    low, high = 0.02, 0.9
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if involute(middle) < target else (low, middle)
    distance = 1e-3 * sum(z) / cos(helix) / 2 * cos(alpha_t) / cos(low)
    pair = GearPair.from_centre_distance(
        normal_module=1e-3,
        teeth=z,
        centre_distance=distance,
        face_widths=(0.02, 0.02),
        helix_angle=helix,
        profile_shift_1=split * sum_shift,
        tips=TipShortening(shortening=(0.15e-3, 0.15e-3)),
    )
    assert sum(pair.profile_shifts) == pytest.approx(sum_shift, abs=1e-9)
    assert pair.transverse_backlash == pytest.approx(0.0, abs=1e-12)
    assert sum(pair.rolling_radii) == pytest.approx(distance * sin(pair.working_pressure_angle))
    assert pair.path.start > pair.path.tangent_1
    assert replace(pair, expansion=(1e-3, 1e-3), centre_distance=distance * 1.001).transverse_backlash == (
        pytest.approx(0.0, abs=1e-12)
    )
