"""Weber/Banaschek single-pair stiffness against an independent calculation.

E 206 GPa, nu 0.3, rack 1.25 / 0.38 (28/28 pair: tool tip radius 0.30); N/(mm um); points A, B, C, D, E of the
tip circles. Found by trial against the listed values: bending counts from the root circle, the lever of the
half plane from the 30 degree section with its chord, the ring's half root angle from the same chord.
"""

from math import cos, radians

import numpy as np
import pytest

from dynamics.gear.cylindrical_gear import Rack
from dynamics.gear.pair import GearPair
from dynamics.gear.pair_geometry import TipShortening
from dynamics.rating.iso_rating import RatingOptions, mesh_stiffness
from dynamics.tooth.mesh_laws import pair_stiffness, single_pair_stiffness

UHCF = {
    "normal_module": 1e-3,
    "teeth": (99, 102),
    "centre_distance": 99.5e-3,
    "face_widths": (7e-3, 15e-3),
    "profile_shift_1": 0.0,
    "tips": TipShortening(shortening=(0.0, 0.70545e-3)),
}


def equal_pair(module, teeth, width, tip_radius=0.38, bore=0.0):
    return GearPair.from_centre_distance(
        normal_module=module,
        teeth=(teeth, teeth),
        centre_distance=module * teeth,
        face_widths=(width, width),
        profile_shift_1=0.0,
        racks=(Rack(tip_radius=tip_radius),) * 2,
        bore_diameters=(bore, bore),
    )


def line_load(pair, torque):
    return torque / pair.base_radii[0] / pair.face_width


def course(pair, load, places):
    return single_pair_stiffness(pair, np.array(places), load) / 1e9


def tip_mean(pair, load, body="half_plane"):
    path = np.linspace(pair.path.tip_start, pair.path.tip_end, 401)
    return np.trapezoid(single_pair_stiffness(pair, path, load, body=body), path) / pair.base_pitch / 1e9


def test_uhcf_test_gear():
    pair = GearPair.from_centre_distance(**UHCF)
    path = pair.path
    places = [path.tip_start, path.tip_end - path.base_pitch, path.tip_start + path.base_pitch, path.tip_end]
    reach = pair.rolling_radii[0]
    assert [round(1e3 * (s + reach), 3) for s in places] == [15.943, 16.711, 18.895, 19.663]
    values = course(pair, 553e3, places)
    assert values == pytest.approx([18.7, 19.8, 15.7, 12.6], abs=0.051)
    assert tip_mean(pair, 553e3) == pytest.approx(22.5, abs=0.05)
    assert values[0] + values[2] == pytest.approx(34.4, abs=0.05)


@pytest.mark.parametrize(
    ("torque", "centre", "tip", "mean"),
    [(85.0, 16.42, 10.98, 25.4), (170.0, 16.96, 11.22, 26.1), (340.0, 17.54, 11.47, 26.9)],
)
def test_spur_pair_50_50(torque, centre, tip, mean):
    pair = equal_pair(3e-3, 50, 20e-3)
    load = line_load(pair, torque)
    assert course(pair, load, [pair.path.start, 0.0, pair.path.end]) == pytest.approx(
        [tip, centre, tip], abs=0.0052
    )
    assert pair_stiffness(pair, load).mesh_mean / 1e9 == pytest.approx(mean, abs=0.05)


def test_nasa_pair_28_28_has_a_sharper_tool():
    sharp, standard = (equal_pair(3.175e-3, 28, 6.35e-3, radius) for radius in (0.30, 0.38))
    load = line_load(sharp, 71.8)
    assert course(sharp, load, [0.0]) == pytest.approx([15.7], abs=0.05)
    assert pair_stiffness(sharp, load).mesh_mean / 1e9 == pytest.approx(22.6, abs=0.05)
    assert course(standard, load, [0.0])[0] > 15.8


def test_fzg_c():
    pair = GearPair.from_centre_distance(
        normal_module=4.5e-3,
        teeth=(16, 24),
        centre_distance=91.5e-3,
        face_widths=(14e-3, 14e-3),
        profile_shift_1=0.1817,
    )
    load = line_load(pair, 302.0)
    assert course(pair, load, [0.0]) == pytest.approx([16.1], abs=0.05)
    assert pair_stiffness(pair, load).mesh_mean / 1e9 == pytest.approx(20.8, abs=0.05)


def test_ring_body_of_sainsot():
    uhcf = GearPair.from_centre_distance(bore_diameters=(60e-3, 60e-3), **UHCF)
    assert tip_mean(uhcf, 553e3, body="ring") == pytest.approx(14.95, rel=2e-3)
    pair = equal_pair(3e-3, 50, 20e-3, bore=50e-3)
    ring = pair_stiffness(pair, line_load(pair, 340.0), body="ring")
    assert ring.mesh_mean / 1e9 == pytest.approx(17.6, abs=0.05)
    assert ring.warnings == ()
    thick = equal_pair(3e-3, 50, 20e-3, bore=15e-3)
    (warning, _) = pair_stiffness(thick, line_load(thick, 340.0), body="ring").warnings
    assert "root radius / bore radius = 9.5" in warning


def test_contact_at_the_pitch_point_is_near_the_standard():
    """c at C lies -6 .. +2 % from c'_th of ISO 6336-1 (50/50 pair, no correction C_M and C_B)."""
    pair = equal_pair(3e-3, 50, 20e-3)
    plain = RatingOptions(measured_correction=1.0, low_load_factor=False)
    c_prime = mesh_stiffness(pair, 340.0, plain) / 1e9 / (0.75 * pair.transverse_contact_ratio + 0.25) / 0.975
    assert c_prime == pytest.approx(18.02, abs=0.01)
    assert -0.06 < course(pair, line_load(pair, 340.0), [0.0])[0] / c_prime - 1.0 < 0.02


def test_load_dependence_is_the_logarithm_of_the_flattening():
    pair = equal_pair(3e-3, 50, 20e-3)
    one, four = (1.0 / course(pair, load, [0.0])[0] for load in (1e5, 4e5))
    expected = 2.0 * (1.0 - 0.09) / (np.pi * 206.0) * np.log(4.0)
    assert one - four == pytest.approx(expected, rel=1e-9)


def test_helical_pair_of_zero_helix_limit():
    spur = equal_pair(3e-3, 50, 20e-3)
    angle = radians(0.5)
    helical = GearPair.from_centre_distance(
        normal_module=3e-3 * cos(angle),
        helix_angle=angle,
        teeth=(50, 50),
        centre_distance=0.15,
        face_widths=(20e-3, 20e-3),
        profile_shift_1="equal",
    )
    assert course(helical, 2e5, [0.0]) == pytest.approx(course(spur, 2e5, [0.0]), rel=1e-3)
