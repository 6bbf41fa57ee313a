"""Influence numbers of small models: reciprocity, symmetry, hand, even load over the face."""

import numpy as np
import pytest

from dynamics.errors import DynamicsInputError
from dynamics.tooth.compliance import InterpolatedCompliance
from dynamics.tooth.influence_model import influence_numbers
from dynamics.tooth.influence_numbers import GearBody
from tests.builders.influence import hat_means, small_model


@pytest.fixture(scope="module")
def spur():
    return influence_numbers(small_model())


@pytest.fixture(scope="module")
def helical():
    return influence_numbers(small_model(15.0))


def grid(block, numbers):
    n_f = len(numbers.face)
    return block.reshape(-1, n_f, len(numbers.profile), n_f)


def test_offsets_are_each_other_s_transpose(spur, helical):
    for numbers in (spur, helical):
        assert sorted(numbers.deflection) == list(range(-3, 4))
        for k in range(4):
            assert np.array_equal(numbers.deflection[k], numbers.deflection[-k].T)
        # read on the tooth axis the numbers are reciprocal within some per cent; they are averaged
        assert 0.0 < numbers.asymmetry < 0.06
        assert np.linalg.eigvalsh(numbers.deflection[0]).min() > -1e-3 * np.abs(numbers.deflection[0]).max()


def test_spur_gear_is_alike_from_both_ends(spur):
    turned = spur.reversed_face()
    for k, block in spur.deflection.items():
        assert turned.deflection[k] == pytest.approx(block, rel=1e-8, abs=1e-10 * np.abs(block).max())
    for place, block in spur.stress.items():
        assert turned.stress[place] == pytest.approx(block, abs=1e-8 * np.abs(block).max())


def test_helical_gear_is_not(helical):
    block = helical.deflection[0]
    assert np.abs(helical.reversed_face().deflection[0] - block).max() > 0.01 * np.abs(block).max()


def test_reversed_twice_is_the_gear_again(helical):
    again = helical.reversed_face().reversed_face()
    assert np.array_equal(again.face, helical.face)
    assert np.array_equal(again.body, helical.body)
    for k, block in helical.deflection.items():
        assert np.array_equal(again.deflection[k], block)
    for place, block in helical.stress.items():
        assert np.array_equal(again.stress[place], block)


def test_a_load_is_felt_less_with_distance(spur):
    own = grid(spur.deflection[0], spur)
    tip = len(spur.profile) - 1
    over_face = own[tip, :, tip, 0]
    assert np.all(np.diff(over_face) < 0.0) and over_face[-1] > 0.0
    # free end softer than mid-face, tip softer than root, neighbours less than the tooth
    assert own[tip, 0, tip, 0] > 1.2 * own[tip, 1, tip, 1]
    assert own[tip, 1, tip, 1] > 3.0 * own[0, 1, 0, 1]
    for k in (-1, 1):
        assert 0.0 < np.abs(spur.deflection[k]).max() < 0.5 * own.max()


def test_body_is_a_part_of_the_deflection(spur):
    part = np.diag(spur.body) / np.diag(spur.deflection[0])
    assert np.all((part > 0.1) & (part < 1.0))
    per_profile = part.reshape(spur.shape)
    assert np.all(np.diff(per_profile, axis=0) < 0.0)  # towards the tip the tooth bends more


def test_root_stress_pulls_under_the_load_and_pushes_behind(spur):
    tangent = spur.fillet.tangent
    at = int(np.argmin(np.abs(tangent - np.pi / 6)))
    n_r, n_f = len(tangent), len(spur.face)
    for side, sign in ((1, 1.0), (-1, -1.0)):
        stress = spur.stress[0, side].reshape(n_r, n_f, len(spur.profile), n_f)
        assert sign * stress[at, 1, -1, 1] > 0.0
    assert np.all(np.diff(spur.fillet.arc) > 0.0)
    arc = spur.fillet.arc_at_tangent(np.pi / 6)
    assert spur.fillet.arc[0] < arc < spur.fillet.arc[-1]


def test_even_load_is_the_mean_of_the_hats(spur):
    even = spur.even()
    steps = np.diff(spur.face)
    share = np.convolve(steps, [0.5, 0.5]) / steps.sum()  # areas of the hats
    block = grid(spur.deflection[1], spur)
    assert even.shape == (len(spur.profile), 1)
    for i, j in ((0, 2), (3, 1)):
        assert even.deflection[1][i, j] == pytest.approx(share @ block[i, :, j, :] @ share, rel=1e-12)
    stress = grid(spur.stress[0, 1], spur)
    assert even.stress[0, 1][2, 3] == pytest.approx(share @ stress[2, :, 3, :] @ share, rel=1e-12)


def test_plane_strain_is_stiffer_than_free_ends():
    plane = influence_numbers(small_model(plane_strain=True)).even()
    free = influence_numbers(small_model(n_face=3)).even()
    ratio = np.diag(plane.deflection[0]) / np.diag(free.deflection[0])
    assert np.all((ratio > 1.0 - 0.3**2 - 0.02) & (ratio < 1.0))


def test_thin_rim_and_web_are_softer(spur):
    rim = influence_numbers(
        small_model(body=GearBody(bore_radius=15e-3, rim_thickness=8e-3, web_thickness=7e-3))
    )
    assert np.all(np.diag(rim.body) > 1.2 * np.diag(spur.body))


def test_compliance_takes_the_numbers(helical):
    compliance = InterpolatedCompliance.of(helical, slant=0.2)
    roll = np.repeat(helical.profile, len(helical.face))
    face = np.tile(helical.face, len(helical.profile))
    same = hat_means(compliance, offset=0)
    assert same == pytest.approx(helical.deflection[0], rel=1e-9, abs=1e-9 * same.max())
    far = hat_means(compliance, offset=3)  # tooth 3 under forces on tooth 0
    assert far == pytest.approx(helical.deflection[3], rel=1e-6, abs=1e-9 * same.max())
    assert compliance.depth(helical.profile) == pytest.approx(helical.axis_depth / np.cos(0.2), rel=1e-12)
    assert compliance.excess(helical.profile) == pytest.approx(helical.local_excess)
    tooth = np.arange(len(roll)) % 7
    far = compliance.matrix(roll, face, tooth)
    assert far == pytest.approx(far.T, abs=1e-12 * far.max())
    assert far[6, 0] == 0.0  # further than three teeth


def test_body_without_steel_is_named():
    with pytest.raises(DynamicsInputError, match="correct bore or rim"):
        influence_numbers(small_model(body=GearBody(bore_radius=60e-3)))
