"""One flank field over profile, face and tooth: values by hand, integrals, symmetry, what is refused."""

from dataclasses import replace
from math import cos, hypot, pi, tan

import numpy as np
import pytest

from dynamics.errors import DynamicsInputError
from dynamics.gear.flank import AT_PITCH_POINT, FlankField, TeethInMesh, back_phase
from dynamics.gear.microgeometry import Microgeometry, Topography
from tests.builders.p2_gears import helical_pair, spur_pair

SPUR, HELICAL = spur_pair(), helical_pair()
COMMON = SPUR.face_widths[0]


def field(index=0, pair=SPUR, count=AT_PITCH_POINT, **micro):
    return FlankField(pair=pair, index=index, micro=Microgeometry(**micro), count=count)


def places(flank, n=2001):
    """Places over profile (n, 1) and face (1, n), from end to end."""
    half = 0.5 * flank.pair.face_widths[flank.index]
    return np.linspace(*flank.profile, n)[:, None], np.linspace(-half, half, n)[None, :]


@pytest.mark.parametrize("index", [0, 1])
def test_profile_runs_from_the_root_to_the_tip_of_its_own_gear(index):
    """On the line of action the tip of one is where the path ends or starts; the pinion's is beyond the involute of
    the wheel here."""
    root, tip = field(index).profile
    at_tip = SPUR.gears[index].roll_length(SPUR.tip_radii[index])
    unused = SPUR.path.tip_end - SPUR.path.end if index == 0 else 0.0
    assert tip == pytest.approx(at_tip - unused, rel=1e-12)
    assert tip - root == pytest.approx(SPUR.path.length, rel=1e-12)
    slope = field(index, profile_slope=8e-6).modification([root, tip], 0.0)
    assert slope == pytest.approx([4e-6, -4e-6])


@pytest.mark.parametrize("exponent", [1.0, 2.0, 1.5])
def test_root_relief_fades_away_from_the_root(exponent):
    flank = field(root_relief=12e-6, root_relief_length=0.4e-3, root_relief_exponent=exponent)
    root, _ = flank.profile
    at = root + np.array([-0.1e-3, 0.0, 0.2e-3, 0.4e-3, 0.5e-3])
    assert flank.modification(at, 0.0) == pytest.approx(
        [12e-6, 12e-6, 12e-6 * 0.5**exponent, 0, 0], abs=1e-18
    )


def test_end_relief_of_both_ends_of_its_own():
    flank = field(end_relief=(6e-6, 10e-6), end_relief_length=2e-3, end_relief_exponent=2.0)
    half, middle = 0.5 * COMMON, np.mean(flank.profile)
    at = np.array([-half, -half + 1e-3, -half + 2e-3, 0.0, half - 2e-3, half - 1e-3, half])
    expected = np.array([6e-6, 1.5e-6, 0.0, 0.0, 0.0, 2.5e-6, 10e-6])
    assert flank.modification(middle, at) == pytest.approx(expected, abs=1e-17)


def test_reliefs_have_the_volume_of_their_power():
    """Mean over the whole profile or face: amount length / (exponent + 1) for each edge."""
    for exponent in (1.0, 2.0):
        flank = field(
            tip_relief=20e-6, tip_relief_length=0.5e-3, tip_relief_exponent=exponent,
            root_relief=10e-6, root_relief_length=0.3e-3, root_relief_exponent=exponent,
        )  # fmt: skip
        roll, _ = places(flank, 20001)
        area = np.trapezoid(flank.modification(roll, 0.0)[:, 0], roll[:, 0])
        assert area == pytest.approx((20e-6 * 0.5e-3 + 10e-6 * 0.3e-3) / (exponent + 1.0), rel=1e-5)


def test_means_over_the_flank():
    """Parabolas have a third of their amount, slopes and twist none."""
    crowned = field(1, profile_crowning=9e-6, lead_crowning=6e-6)
    assert crowned.modification(*places(crowned)).mean() == pytest.approx(5e-6, rel=2e-3)
    tilted = field(1, profile_slope=9e-6, helix_slope=6e-6, profile_twist=5e-6)
    assert tilted.modification(*places(tilted)).mean() == pytest.approx(0.0, abs=1e-18)


def test_twist_changes_sign_with_either_coordinate_and_so_do_the_corners():
    flank = field(0, HELICAL, profile_twist=4e-6)
    root, tip = flank.profile
    corners = flank.modification(np.array([[root], [tip]]), np.array([[-20e-3, 20e-3]]))
    assert corners == pytest.approx(np.array([[4e-6, -4e-6], [-4e-6, 4e-6]]))
    roll, face = places(flank, 41)
    whole = flank.modification(roll, face)
    assert whole == pytest.approx(-whole[::-1], abs=1e-18)
    assert whole == pytest.approx(-whole[:, ::-1], abs=1e-18)


def test_circular_crowning_meets_the_parabola_in_three_points():
    """An arc over 7 mm with a rise of 1 mm lies outside of the parabola by the hand value at a quarter of the face."""
    rise, half = 1e-3, 0.5 * COMMON
    arc = field(lead_crowning=rise, lead_crowning_form="circular")
    radius = (half**2 + rise**2) / (2.0 * rise)
    at = np.array([-half, 0.0, 0.5 * half, half])
    found = arc.modification(np.mean(arc.profile), at)
    assert found == pytest.approx(
        [rise, 0.0, radius - np.sqrt(radius**2 - (0.5 * half) ** 2), rise], rel=1e-12
    )
    assert found[2] < 0.25 * rise
    real = [
        field(lead_crowning=32e-6, lead_crowning_form=form).modification(10e-3, at)
        for form in ("parabolic", "circular")
    ]
    assert real[0] == pytest.approx(real[1], abs=32e-6 * (32e-6 / COMMON) ** 2)
    hollow = field(lead_crowning=-rise, lead_crowning_form="circular")
    assert hollow.modification(np.mean(arc.profile), at) == pytest.approx(-found)


@pytest.mark.parametrize(
    ("index", "flank", "sign"), [(0, "front", 1), (0, "back", -1), (1, "front", -1), (1, "back", 1)]
)
def test_manufacturing_twist_of_a_crowned_helical_flank(index, flank, sign):
    """S_alpha = 8 C_beta L tan(beta_b) / b by the change of the profile slope, opposite on both flanks of a tooth."""
    crowned = field(index, HELICAL, lead_crowning=10e-6, manufacturing_twist=1.0)
    root, tip = crowned.profile
    ends = crowned.modification(np.array([[root], [tip]]), np.array([[-20e-3, 20e-3]]), flank)
    front_slope, rear_slope = ends[0] - ends[1]
    expected = 8.0 * 10e-6 * (tip - root) * tan(HELICAL.base_helix_angle) / 40e-3
    assert rear_slope - front_slope == pytest.approx(sign * expected, rel=1e-12)
    assert crowned.natural_twist == pytest.approx(expected if index == 0 else -expected, rel=1e-12)
    middle = 0.5 * (root + tip)
    assert crowned.modification(middle, [-20e-3, 0.0, 20e-3], flank) == pytest.approx(
        [10e-6, 0, 10e-6], abs=1e-18
    )
    half = replace(crowned, micro=replace(crowned.micro, manufacturing_twist=0.5))
    slopes = half.modification(root, [-20e-3, 20e-3], flank) - half.modification(tip, [-20e-3, 20e-3], flank)
    assert slopes[1] - slopes[0] == pytest.approx(0.5 * sign * expected, rel=1e-12)


def test_a_crowned_spur_flank_has_no_manufacturing_twist():
    plain, ground = (field(lead_crowning=10e-6, manufacturing_twist=share) for share in (0.0, 1.0))
    assert np.array_equal(plain.modification(*places(plain, 21)), ground.modification(*places(plain, 21)))
    assert ground.natural_twist == 0.0


def test_pitch_of_a_tooth_gives_on_the_back_what_it_takes_in_front():
    pitch = tuple(1e-6 * k for k in range(99))
    flank, middle = field(pitch_deviations=pitch), np.mean(field().profile)
    for tooth in (0, 7, 98, 99 + 7, -1):
        front, back = (flank.removed(middle, 0.0, tooth, side) for side in ("front", "back"))
        assert front == pytest.approx(-pitch[tooth % 99], abs=1e-20)
        assert back == -front


@pytest.mark.parametrize("index", [0, 1])
def test_run_out_is_the_eccentricity_of_the_base_circle(index):
    """Sum of front and back at the same tooth: 2 e sin(alpha_wt) by hand where the eccentricity points to the mate."""
    count = TeethInMesh(phase=0.3e-3, tooth_offset_2=5)
    flank = field(index, count=count, run_out=10e-6, run_out_phase=0.7)
    teeth, reach = SPUR.teeth[index], SPUR.rolling_radii[index]
    radius = SPUR.base_pitch * teeth / (2.0 * pi)
    for tooth in (0, 11):
        path = 1.2e-3
        roll = reach + path if index == 0 else reach - path
        rotation = (path - 0.3e-3) / radius + 2.0 * pi * (tooth - (5 if index else 0)) / teeth
        assert flank.removed(roll, 0.0, tooth) == pytest.approx(-10e-6 * np.cos(rotation - 0.7), abs=1e-15)
        own = tooth - (5 if index else 0) - index
        behind = (back_phase(SPUR, count) - path) / radius + 2.0 * pi * own / teeth
        later = 0.7 + (2.0 - 4.0 * index) * SPUR.working_pressure_angle
        assert flank.removed(roll, 0.0, tooth, "back") == pytest.approx(
            10e-6 * np.cos(behind - later), abs=1e-15
        )


def test_scatter_of_the_profile_is_the_same_on_both_flanks():
    slopes = (6e-6, *(0.0,) * 98)
    flank = field(profile_slopes=slopes)
    for side in ("front", "back"):
        assert flank.removed(np.array(flank.profile), 0.0, 0, side) == pytest.approx([3e-6, -3e-6])
        assert not flank.removed(np.array(flank.profile), 0.0, 1, side).any()


def test_removed_takes_any_shape_and_is_the_sum_of_its_parts():
    flank = field(lead_crowning=5e-6, profile_slopes=(6e-6, *(0.0,) * 98), run_out=3e-6)
    roll, face, tooth = (
        np.linspace(*flank.profile, 5)[:, None, None],
        np.array([0.0, 1e-3])[:, None],
        np.arange(3),
    )
    whole = flank.removed(roll, face, tooth)
    assert whole.shape == (5, 2, 3)
    one = flank.removed(roll[2, 0, 0], 1e-3, 2)
    assert (
        whole[2, 1, 2]
        == one
        == flank.modification(roll[2, 0, 0], 1e-3) + flank.deviation(roll[2, 0, 0], 1e-3, 2)
    )


def grid(flank, values, n=(5, 4), **how):
    """Topography of a function of place on the profile (-1 .. 1) and on the face (-1 .. 1)."""
    gear = flank.pair.gears[flank.index]
    ends = [gear.roll_length(radius) / gear.base_radius for radius in (gear.form_radius, gear.tip_radius)]
    half = 0.5 * flank.pair.face_widths[flank.index]
    angles, across = np.linspace(*ends, n[0]), np.linspace(-half, half, n[1])
    removed = values(angles[:, None], across[None, :])
    return Topography(roll_angle=angles, face=across, removed=np.atleast_3d(removed.T).T, **how)


def test_topography_is_exact_for_its_degree_and_adds_to_the_rest():
    base = SPUR.gears[0].base_radius

    def bilinear(angle, face):
        return 1e-6 * (2.0 + 3.0 * angle - 500.0 * face + 900.0 * angle * face)

    def bicubic(angle, face):
        return bilinear(angle, face) + 1e-6 * (angle**3 + (1e3 * face) ** 3 * 0.01)

    roll, face = places(field(), 31)
    for how, values in (("bilinear", bilinear), ("bicubic", bicubic)):
        flank = field(topography=grid(field(), values, interpolation=how), profile_slope=2e-6)
        plain = field(profile_slope=2e-6).modification(roll, face)
        assert flank.modification(roll, face) - plain == pytest.approx(values(roll / base, face), abs=1e-15)
        assert flank.modification(roll, face, "back") == pytest.approx(plain, abs=1e-20)


def test_topography_of_every_tooth():
    one = grid(field(), lambda angle, face: 1e-6 * np.ones_like(angle * face))
    shares = np.arange(99.0)
    every = Topography(roll_angle=one.roll_angle, face=one.face, removed=one.removed * shares[:, None, None])
    flank, middle = field(topography=every), np.mean(field().profile)
    assert flank.modification(middle, 0.0) == pytest.approx(1e-6 * shares.mean())
    assert flank.removed(middle, 0.0, np.array([0, 3, 98, 102])) == pytest.approx(
        1e-6 * np.array([0, 3, 98, 3]), abs=1e-18
    )


def test_topography_stays_on_its_points_when_the_gear_is_warm():
    bump = grid(field(), lambda angle, face: 1e-4 * angle + 0.0 * face)
    warm = SPUR.warm(420.0, 420.0, 99.7e-3)
    gear = warm.gears[0]
    roll = gear.roll_length(gear.tip_radius - 0.2e-3)
    flank = field(pair=warm, topography=bump)
    assert flank.modification(roll, 0.0) == pytest.approx(1e-4 * roll / gear.base_radius, rel=1e-12)


GOOD = {
    "roll_angle": np.array([0.1, 0.2, 0.3]),
    "face": np.array([-1.0, 1.0]),
    "removed": np.zeros((1, 3, 2)),
}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"roll_angle": np.array([0.1, 0.3, 0.2])}, "roll_angle must increase"),
        ({"face": np.array([1.0, 1.0])}, "face must increase"),
        ({"removed": np.zeros((1, 2, 3))}, r"shape \(1, 2, 3\)"),
        ({"removed": np.array([[[0, 1], [np.nan, 1], [2, 3]]])}, "1 of 6 values are missing"),
        ({"interpolation": "bicubic"}, "needs 4 places"),
        ({"interpolation": "nearest"}, "bilinear or bicubic"),
    ],
)
def test_impossible_topographies_are_refused(change, words):
    with pytest.raises(DynamicsInputError, match=words):
        Topography(**{**GOOD, **change})


@pytest.mark.parametrize(
    ("profile", "width", "words"),
    [
        ((0.09, 0.3), 2.0, "roll angle 5.730 .. 17.189 deg does not cover"),
        ((0.1, 0.31), 2.0, "roll angle"),
        ((0.1, 0.3), 2.1, "face position"),
    ],
)
def test_a_grid_must_cover_the_flank(profile, width, words):
    Topography(**GOOD).require_cover((0.1, 0.3), 2.0)
    with pytest.raises(DynamicsInputError, match=words):
        Topography(**GOOD).require_cover(profile, width)


@pytest.mark.parametrize(
    ("micro", "words"),
    [
        ({"root_relief": 1e-6}, "root_relief_length"),
        ({"end_relief": (0.0, 1e-6)}, "end_relief_length"),
        (
            {"tip_relief": 1e-6, "tip_relief_length": 1e-3, "tip_relief_exponent": 0.0},
            "tip_relief_exponent = 0",
        ),
        ({"manufacturing_twist": 1.2}, "manufacturing_twist = 1.2"),
        ({"topography": Topography(**{**GOOD, "removed": np.zeros((5, 3, 2))})}, "5 teeth for 99 teeth"),
    ],
)
def test_micro_geometry_that_does_not_fit_is_refused(micro, words):
    with pytest.raises(DynamicsInputError, match=words):
        field(**micro)


def test_an_unknown_flank_is_refused():
    with pytest.raises(DynamicsInputError, match="front or back"):
        field().removed(10e-3, 0.0, 0, "left")


def helicoid(pair, roll, place, rotation):
    """Point of the front flank of the pinion turned by ``rotation``, from the axis [m]; z along the axis."""
    base = pair.base_radii[0]
    angle = (
        rotation - (roll - base * np.arctan(roll / base)) / base - place * tan(pair.base_helix_angle) / base
    )
    radius = hypot(base, roll)
    return np.array([radius * np.cos(angle), radius * np.sin(angle), place])


def test_trace_of_a_worm_on_a_helical_flank_is_slanted_by_the_base_helix():
    """The twist against two screw surfaces met in space, with normals by differences.

    A screw surface with axis w through A turns and advances along itself, so that each of its normals n obeys
    (n x w).(A - P) = lead n.w, and on an involute one n.w is the same everywhere. A point of the gear flank where both
    hold for a worm is one that the worm finishes while it stands at one axial place.
    """
    from scipy.optimize import fsolve

    pair, axis = HELICAL, np.array([0.0, np.sin(1.25), np.cos(1.25)])

    def normal(roll, place, rotation):
        step = 1e-7
        along = helicoid(pair, roll + step, place, rotation) - helicoid(pair, roll - step, place, rotation)
        across = helicoid(pair, roll, place + step, rotation) - helicoid(pair, roll, place - step, rotation)
        n = np.cross(along, across)
        return n / np.linalg.norm(n)

    def screw(roll, place, rotation):
        n, p = normal(roll, place, rotation), helicoid(pair, roll, place, rotation)
        return np.array([n @ axis, np.cross(axis, n) @ p * 1e2])

    pitch_roll = pair.base_radii[0] * tan(pair.working_pressure_angle)
    start = screw(pitch_roll, 0.0, 0.0)
    found = []
    for travel in (-1.0e-3, -0.5e-3, 0.5e-3, 1.0e-3):
        rotation = travel / pair.base_radii[0]

        def miss(x, rotation=rotation):
            return 1e4 * (screw(pitch_roll + 1e-3 * x[0], 1e-3 * x[1], rotation) - start)

        solution, _, status, _ = fsolve(
            miss, [1e3 * travel * cos(pair.base_helix_angle) ** 2, 0.0], full_output=True
        )
        assert status == 1
        found.append(solution)
    roll, place = np.array(found).T
    assert np.ptp(roll) > 1.5
    assert place / roll == pytest.approx(tan(pair.base_helix_angle), rel=1e-4)
    # the field is level along that trace: the tool removed one amount there
    flank = field(0, HELICAL, lead_crowning=10e-6, manufacturing_twist=1.0)
    middle, at = np.mean(flank.profile), 8e-3
    removed = flank.modification(middle + 1e-3 * roll, at + 1e-3 * place)
    assert removed == pytest.approx(float(flank.modification(middle, at)), rel=1e-4)
