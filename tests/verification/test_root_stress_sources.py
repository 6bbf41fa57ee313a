"""ISO 6336-3 factors of known gears, and the local lever against the point that the standard rates.

FZG type C (DIN ISO 14635) and the test gear of the UHCF rig: values of an independent calculation.
"""

from math import cos, radians

import numpy as np
import pytest

from dynamics.gear.pair import GearPair
from dynamics.rating import iso_rating
from dynamics.rating.root_stress import root_influence
from tests.builders.p2_gears import spur_pair

FZG_C = GearPair.from_centre_distance(
    normal_module=4.5e-3,
    teeth=(16, 24),
    centre_distance=91.5e-3,
    face_widths=(14e-3, 14e-3),
    profile_shift_1=0.1817,
)


def uhcf(profile_shift_1):
    return spur_pair(profile_shift_1=profile_shift_1)


@pytest.mark.parametrize(
    ("pair", "Y_F", "Y_S", "places"),
    [(FZG_C, 1.685, 1.848, 5e-4), (uhcf(0.0), 1.821, 1.901, 5e-4), (uhcf(-0.714), 2.110, 1.639, 1e-3)],
    ids=["FZG-C", "UHCF x1 = 0", "UHCF x1 = -0.714"],
)
def test_factors_of_known_pinions(pair, Y_F, Y_S, places):
    stress = iso_rating.root_stress(pair, 100.0, 0)
    assert pytest.approx(Y_F, abs=places) == stress.Y_F
    assert pytest.approx(Y_S, abs=places) == stress.Y_S


def test_nominal_stress_of_the_uhcf_pinion_is_1_80_gpa():
    stress = iso_rating.root_stress(uhcf(0.0), 180.0, 0)
    assert stress.sigma_F0 == pytest.approx(1800.0, abs=5.0)
    assert pytest.approx(3.46, abs=5e-3) == stress.Y_F * stress.Y_S
    assert stress.warnings == ()


def test_thirty_degree_tangent_touches_the_trochoid():
    """The section of the closed formula lies on the generated fillet, with a tangent of 30 degrees."""
    for gear in (*FZG_C.gears, *uhcf(0.0).gears):
        pair = FZG_C if gear in FZG_C.gears else uhcf(0.0)
        root = iso_rating.tooth_root(pair, pair.gears.index(gear))
        section = iso_rating.iso6336_3_2006.root_section(root)
        angles = np.linspace(gear.pressure_angle, np.pi / 2, 20001)
        x, y = np.array([gear.trochoid_point(angle) for angle in angles]).T
        slope = np.gradient(x) / np.gradient(y)
        at = int(np.argmin(np.abs(slope + np.tan(np.pi / 6))))
        assert 2 * x[at] == pytest.approx(section.s_Fn * gear.normal_module, rel=2e-4)
        assert y[at] == pytest.approx(section.y_F * gear.normal_module, rel=2e-5)
        radius = (1 + slope**2) ** 1.5 / np.abs(np.gradient(slope) / np.gradient(y))
        assert radius[at] == pytest.approx(section.rho_F * gear.normal_module, rel=5e-3)


@pytest.mark.parametrize("index", [0, 1])
def test_local_lever_at_the_outer_single_contact_is_method_b(index):
    torque = 302.0
    influence = root_influence(FZG_C, index, n_path=2001)
    path = FZG_C.path
    place = path.outer_single_contact if index == 0 else path.inner_single_contact
    stress = torque / FZG_C.base_radii[0] / influence.width * influence.at(place)
    expected = iso_rating.root_stress(FZG_C, torque, index).sigma_F0 * 1e6
    assert stress == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("index", [0, 1])
def test_local_lever_of_a_helical_gear_at_the_virtual_load_point(index):
    pair = GearPair.from_centre_distance(
        normal_module=3e-3,
        teeth=(30, 41),
        centre_distance=112.5e-3,
        helix_angle=radians(18.0),
        face_widths=(30e-3, 30e-3),
        profile_shift_1="equal",
    )
    influence = root_influence(pair, index, n_path=2001)
    # d_en sits p_bn (eps_an - 1) from the tip of the virtual gear, cos(beta_b) times that on the real path
    from_tip = pair.base_pitch * (pair.transverse_contact_ratio - cos(pair.base_helix_angle) ** 2)
    place = pair.path.tip_end - from_tip if index == 0 else pair.path.tip_start + from_tip
    stress = influence.at(place) * 500.0 / pair.base_radii[0] / influence.width
    assert stress == pytest.approx(iso_rating.root_stress(pair, 500.0, index).sigma_F0 * 1e6, rel=1e-6)


def test_truncated_flank_moves_the_load_point_of_the_uhcf_pinion():
    """The wheel's form circle ends the path before the pinion's tip; D follows, d_en does not."""
    pair = uhcf(0.0)
    influence = root_influence(pair, 0)
    real = influence.at(pair.path.outer_single_contact) * 180.0 / pair.base_radii[0] / influence.width
    missing = pair.path.tip_end - pair.path.end
    rated = (
        influence.at(pair.path.outer_single_contact + missing) * 180 / pair.base_radii[0] / influence.width
    )
    assert missing == pytest.approx(43e-6, abs=1e-6)
    assert rated == pytest.approx(iso_rating.root_stress(pair, 180.0, 0).sigma_F0 * 1e6, rel=1e-4)
    assert 0.985 < real / rated < 1.0
