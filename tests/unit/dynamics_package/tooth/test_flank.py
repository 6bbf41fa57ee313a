from dataclasses import replace
from math import cos, pi, tan

import numpy as np
import pytest

from dynamics.gear.flank import AxisMisalignment, FlankField
from dynamics.gear.microgeometry import Microgeometry, cumulative_pitch
from dynamics.rating.iso_rating import mesh_stiffness
from dynamics.tooth.law import check_mesh_law
from dynamics.tooth.mesh_laws import (
    ContactDiscretisation,
    MeshDissipation,
    MeshPosition,
    PairStiffness,
    mesh_law,
    pair_stiffness,
)
from tests.builders.p2_gears import ALLOWANCES, helical_pair, spur_pair

TEST_GEAR = spur_pair(**ALLOWANCES)
REFERENCE_GEAR = helical_pair(**ALLOWANCES)
PUBLISHED = (
    Microgeometry(profile_crowning=7e-6, lead_crowning=5e-6),
    Microgeometry(profile_crowning=7e-6),
)


def scaled(pair, torque=180.0):
    load = torque / pair.base_radii[0] / pair.face_width
    return pair_stiffness(pair, load).scaled_to(mesh_stiffness(pair, torque))


def flank_modification(pair, gear, index, path, face):
    """Metal removed from gear ``index``, (len(face), len(path)), by places on the path."""
    flank = FlankField(pair=pair, index=index, micro=gear)
    return flank.modification(flank.roll(path), face[:, None])


def path_of(law):
    return law.path_start + law.path_step * np.arange(law.gap.shape[1])


def rigid_mesh_stiffness(law, pair, travel):
    """Sum of the table stiffness of all pairs and slices on the active path at one pinion travel."""
    total, path = 0.0, path_of(law)
    for shift, row in zip(law.slice_shift, law.stiffness, strict=True):
        places = travel - shift + law.base_pitch * np.arange(-40, 41)
        inside = places[(places >= pair.path.start) & (places <= pair.path.end)]
        total += np.interp(inside, path, row).sum()
    return total


@pytest.mark.parametrize("pair", [TEST_GEAR, REFERENCE_GEAR], ids=["spur", "helical"])
def test_mean_mesh_stiffness_is_c_gamma_alpha_times_width(pair):
    law = mesh_law(pair, stiffness=scaled(pair), discretisation=ContactDiscretisation(n_path=2001))
    travels = (np.arange(400) + 0.5) / 400 * law.base_pitch
    mean = np.mean([rigid_mesh_stiffness(law, pair, travel) for travel in travels])
    expected = mesh_stiffness(pair, 180.0) * pair.face_width
    assert mean == pytest.approx(expected, rel=3e-3)
    assert law.mean_stiffness == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("pair", [TEST_GEAR, REFERENCE_GEAR], ids=["spur", "helical"])
def test_law_passes_the_contract_check(pair):
    check_mesh_law(
        mesh_law(pair, scaled(pair), micro=PUBLISHED, dissipation=MeshDissipation(damping=1e3, friction=0.04))
    )


def test_default_slices():
    stiffness = scaled(TEST_GEAR)
    assert mesh_law(TEST_GEAR, stiffness=stiffness).stiffness.shape[0] == 1
    assert mesh_law(TEST_GEAR, stiffness, micro=PUBLISHED).stiffness.shape[0] == 8
    assert (
        mesh_law(
            TEST_GEAR, stiffness=stiffness, position=MeshPosition(axes=AxisMisalignment(skew=1e-4))
        ).stiffness.shape[0]
        == 8
    )
    # a face that lags by 4.14 base pitches from end to end
    assert mesh_law(REFERENCE_GEAR, stiffness=scaled(REFERENCE_GEAR)).stiffness.shape[0] == 34


def test_narrow_face_governs_and_slices_share_it():
    law = mesh_law(TEST_GEAR, stiffness=scaled(TEST_GEAR), discretisation=ContactDiscretisation(n_slices=7))
    one = mesh_law(TEST_GEAR, stiffness=scaled(TEST_GEAR), discretisation=ContactDiscretisation(n_slices=1))
    assert law.stiffness.sum(axis=0) == pytest.approx(one.stiffness[0])
    middle = np.searchsorted(path_of(one), 2e-3)
    assert one.stiffness[0, middle] == pytest.approx(scaled(TEST_GEAR).at(path_of(one))[middle] * 7e-3)


def test_base_radii_keep_the_ratio_of_the_teeth_when_the_gears_grow_differently():
    warm = TEST_GEAR.warm(440.0, 400.0, 99.6e-3)
    law = mesh_law(warm, stiffness=scaled(warm))
    assert law.base_radius_1 / law.base_radius_2 == pytest.approx(99 / 102, rel=1e-15)
    assert law.base_radius_1 * 2 * pi / 99 == pytest.approx(law.base_pitch, rel=1e-15)
    inside = (path_of(law) > warm.path.start) & (path_of(law) < warm.path.end)
    slope = np.polyfit(path_of(law)[inside], law.gap[0, inside], 1)[0]
    assert slope == pytest.approx(11.5e-6 * (400.0 - 440.0), rel=2e-3)


def test_crowning_is_zero_in_the_middle_and_full_at_the_ends():
    path = np.array(
        [TEST_GEAR.path.start, 0.5 * (TEST_GEAR.path.start + TEST_GEAR.path.end), TEST_GEAR.path.end]
    )
    face = np.array([-3.5e-3, 0.0, 3.5e-3])
    removed = flank_modification(TEST_GEAR, PUBLISHED[0], 0, path, face)
    assert removed[1] == pytest.approx([7e-6, 0.0, 7e-6])
    assert removed[:, 1] == pytest.approx([5e-6, 0.0, 5e-6])
    wheel = flank_modification(TEST_GEAR, Microgeometry(lead_crowning=5e-6), 1, path, face)
    assert wheel[2, 0] == pytest.approx(5e-6 * (7 / 15) ** 2)


@pytest.mark.parametrize("index", [0, 1])
def test_tip_relief_starts_at_its_length_from_the_own_tip(index):
    limits = TEST_GEAR.path
    tip, inwards = (limits.end, -1.0) if index == 0 else (limits.start, 1.0)
    path = tip + inwards * np.array([0.0, 0.5e-3, 1e-3, 1.5e-3])
    for exponent, half in ((1.0, 10e-6), (2.0, 5e-6)):
        gear = Microgeometry(tip_relief=20e-6, tip_relief_length=1e-3, tip_relief_exponent=exponent)
        assert flank_modification(TEST_GEAR, gear, index, path, np.zeros(1))[0] == pytest.approx(
            [20e-6, half, 0.0, 0.0], abs=1e-18
        )


def test_twist_and_helix_slope_are_bilinear():
    limits = REFERENCE_GEAR.path
    corners = np.array([limits.start, limits.end])
    face = np.array([-20e-3, 20e-3])
    twist = Microgeometry(profile_twist=4e-6)
    assert flank_modification(REFERENCE_GEAR, twist, 0, corners, face) == pytest.approx(
        np.array([[4e-6, -4e-6], [-4e-6, 4e-6]])
    )
    assert flank_modification(REFERENCE_GEAR, twist, 1, corners, face) == pytest.approx(
        np.array([[-4e-6, 4e-6], [4e-6, -4e-6]])
    )
    slope = Microgeometry(helix_slope=6e-6)
    assert np.ptp(flank_modification(REFERENCE_GEAR, slope, 0, corners, face)[:, 0]) == pytest.approx(6e-6)


def test_misalignment_opens_the_gap_along_the_face():
    law = mesh_law(
        TEST_GEAR,
        stiffness=scaled(TEST_GEAR),
        position=MeshPosition(axes=AxisMisalignment.of_gap(TEST_GEAR, 1e-3, 1e-3)),
        discretisation=ContactDiscretisation(n_slices=7),
    )
    middle = np.searchsorted(path_of(law), 2e-3)
    assert np.diff(law.gap[:, middle]) == pytest.approx(1e-3 * 1e-3)
    assert law.gap[3, middle] == pytest.approx(0.0, abs=1e-18)


def test_slices_of_a_helical_gear_lag_by_the_base_helix():
    law = mesh_law(REFERENCE_GEAR, stiffness=scaled(REFERENCE_GEAR))
    step = 40e-3 / 34
    assert np.diff(law.slice_shift) == pytest.approx(step * tan(REFERENCE_GEAR.base_helix_angle))
    assert law.slice_shift.sum() == pytest.approx(0.0, abs=1e-15)
    total = 34 / 33 * np.ptp(law.slice_shift) / law.base_pitch
    assert total == pytest.approx(REFERENCE_GEAR.overlap_ratio)


def test_backlash_and_back_flank_follow_the_tooth_thickness():
    law = mesh_law(TEST_GEAR, stiffness=scaled(TEST_GEAR), position=MeshPosition(phase=0.4e-3))
    assert law.backlash == pytest.approx(100e-6 * cos(TEST_GEAR.working_pressure_angle), rel=2e-2)
    # the pinion turns by its own tooth before the back flank stands where the front flank stood (pitch point)
    to_pitch_point = -law.phase / law.base_radius_1
    tooth = TEST_GEAR.working_thicknesses[0] / TEST_GEAR.working_radii[0]
    back = law.back_phase - law.base_radius_1 * (to_pitch_point + tooth)
    assert back == pytest.approx(0.0, abs=1e-15)


def test_a_jammed_pair_has_no_play():
    jammed = TEST_GEAR.warm(470.0, 470.0, 99.5e-3)
    assert jammed.transverse_backlash < 0.0
    assert mesh_law(jammed, stiffness=scaled(jammed)).backlash == 0.0


def test_pitch_deviations_move_whole_teeth():
    single = np.zeros(99)
    single[10] = 5e-6
    places = cumulative_pitch(single)
    assert np.mean(places) == pytest.approx(0.0, abs=1e-20)
    assert places[10] - places[9] == pytest.approx(5e-6 * (1 - 1 / 99))
    law = mesh_law(
        TEST_GEAR, scaled(TEST_GEAR), micro=(Microgeometry(pitch_deviations=places), Microgeometry())
    )
    assert law.deviation_1.shape == (99, law.gap.shape[1])
    assert law.deviation_1[:, 5] == pytest.approx(-np.array(places))
    assert not law.deviation_2.any()


@pytest.mark.parametrize(("index", "offset"), [(0, 0), (1, 0), (1, 7)])
def test_run_out_is_one_wave_per_turn_continuous_from_tooth_to_tooth(index, offset):
    bent = Microgeometry(run_out=10e-6, run_out_phase=0.3)
    micro = (bent, Microgeometry()) if index == 0 else (Microgeometry(), bent)
    law = mesh_law(
        TEST_GEAR,
        scaled(TEST_GEAR),
        micro=micro,
        position=MeshPosition(phase=0.2e-3, tooth_offset_2=offset),
        discretisation=ContactDiscretisation(n_path=801),
    )
    rows = law.deviation_1 if index == 0 else law.deviation_2
    teeth = TEST_GEAR.teeth[index]
    for pair in (0, 3, 50):
        for place in (1e-3, 3e-3):
            rotation = (place - law.phase + pair * law.base_pitch) / law.base_pitch * 2 * pi / teeth
            row = rows[(pair + (offset if index else 0)) % teeth]
            assert np.interp(place, path_of(law), row) == pytest.approx(
                -10e-6 * np.cos(rotation - 0.3), abs=1e-11
            )


def test_tooth_stiffness_scales_are_handed_on():
    scales = (0.7, *(1.0,) * 98)
    law = mesh_law(
        TEST_GEAR, scaled(TEST_GEAR), micro=(Microgeometry(tooth_stiffness=scales), Microgeometry())
    )
    assert law.scale_1 == pytest.approx(scales)
    assert law.mean_stiffness == pytest.approx(scaled(TEST_GEAR).mesh_mean * 7e-3 * (98.7 / 99), rel=1e-12)


@pytest.mark.parametrize(
    ("micro", "words"),
    [
        (Microgeometry(pitch_deviations=(1e-6,) * 5), "99 teeth"),
        (Microgeometry(tooth_stiffness=(1.0,) * 98), "99 teeth"),
        (Microgeometry(tooth_stiffness=(-0.1, *(1.0,) * 98)), "negative"),
        (Microgeometry(tip_relief=1e-6), "tip_relief_length"),
    ],
)
def test_impossible_microgeometry_is_refused(micro, words):
    with pytest.raises(ValueError, match=words):
        mesh_law(TEST_GEAR, scaled(TEST_GEAR), micro=(micro, Microgeometry()))


def loaded_mesh(law, force, travel):
    """Approach [m] of the static mesh and the number of pairs that carry ``force`` [N] at a pinion travel."""
    places = travel + law.base_pitch * np.arange(-4, 5)
    places = places[(places > path_of(law)[0]) & (places < path_of(law)[-1])]
    stiffness = np.array([np.interp(places, path_of(law), row) for row in law.stiffness])
    gap = np.array([np.interp(places, path_of(law), row) for row in law.gap])
    low, high = 0.0, 3e-4
    for _ in range(60):
        approach = 0.5 * (low + high)
        carried = float((stiffness * np.maximum(approach - gap, 0.0)).sum())
        low, high = (approach, high) if carried < force else (low, approach)
    return approach, int(np.any(approach > gap, axis=0).sum())


def test_deflected_teeth_meet_before_the_path_and_share_the_load():
    """At 180 Nm the fine-pitch gear deflects some 30 um; the tip gap reaches that a base pitch outside."""
    force = 180.0 / TEST_GEAR.base_radii[0]
    travels = 1e-3 + np.linspace(0.0, 1.0, 40, endpoint=False) * TEST_GEAR.base_pitch
    laws = {
        kind: mesh_law(
            TEST_GEAR,
            scaled(TEST_GEAR),
            micro=PUBLISHED,
            discretisation=ContactDiscretisation(engagement=kind),
        )
        for kind in ("corner", "path")
    }
    mesh = {kind: [loaded_mesh(law, force, travel) for travel in travels] for kind, law in laws.items()}
    approach = {kind: np.array([a for a, _ in mesh[kind]]) for kind in mesh}
    pairs = {kind: np.mean([n for _, n in mesh[kind]]) for kind in mesh}
    assert 1.26 <= pairs["path"] < 1.26 + 0.1
    assert 1.9 < pairs["corner"] < 2.4
    assert np.ptp(approach["corner"]) < 3e-6 < 10e-6 < np.ptp(approach["path"])
    # light load: the crowned flanks carry one pair after the other, the corners stay apart
    light = [loaded_mesh(laws["corner"], 10.0, travel)[1] for travel in travels]
    assert np.mean(light) < 1.3


def test_law_without_corner_contact_keeps_the_mean_stiffness():
    law = mesh_law(
        TEST_GEAR, stiffness=scaled(TEST_GEAR), discretisation=ContactDiscretisation(engagement="path")
    )
    check_mesh_law(law)
    assert law.gap[0, [0, -1]] == pytest.approx(0.15e-3)
    assert law.mean_stiffness == pytest.approx(mesh_stiffness(TEST_GEAR, 180.0) * 7e-3)


def test_impossible_resolution_is_refused():
    with pytest.raises(ValueError, match="n_slices = 0"):
        mesh_law(TEST_GEAR, stiffness=scaled(TEST_GEAR), discretisation=ContactDiscretisation(n_slices=0))
    with pytest.raises(ValueError, match="gap = 0"):
        mesh_law(TEST_GEAR, stiffness=scaled(TEST_GEAR), discretisation=ContactDiscretisation(reach=0.0))


def test_pair_stiffness_scaling():
    course = pair_stiffness(TEST_GEAR, 553e3)
    assert course.scaled(0.8).mesh_mean == pytest.approx(0.8 * course.mesh_mean)
    assert course.scaled_to(16e9).mesh_mean == pytest.approx(16e9)
    assert course.at(np.array([-1.0, 1.0])) == pytest.approx(course.value[[0, -1]])
    with pytest.raises(ValueError, match="factor = 0"):
        course.scaled(0.0)
    with pytest.raises(ValueError, match="line load"):
        pair_stiffness(TEST_GEAR, 0.0)
    with pytest.raises(ValueError, match="bore"):
        pair_stiffness(TEST_GEAR, 1e5, body="ring")
    flat = PairStiffness(path=np.array([0.0, 2.0]), value=np.array([3.0, 3.0]), base_pitch=1.5)
    assert flat.mesh_mean == pytest.approx(4.0)


def test_input_is_not_changed():
    before = replace(TEST_GEAR)
    mesh_law(TEST_GEAR, scaled(TEST_GEAR), micro=PUBLISHED)
    assert before == TEST_GEAR
