"""Displaced and eccentric teeth on their two flanks, beside the geometry of involutes and a mirror.

Source: two involutes on base circles whose centres stand a' apart on a line turned by gamma touch in front at
r_b1 theta_1 - r_b2 theta_2 = (r_b1 + r_b2) (inv alpha' - inv alpha_wt + gamma), cos alpha' = (r_b1 + r_b2) / a',
and on the back at the negative of the same with -gamma, less the backlash (Litvin, Gear Geometry, 2nd ed., ch. 10:
centre distance and backlash of involute gears).
"""

from dataclasses import replace
from math import acos, pi, radians, sin, tan

import numpy as np
import pytest

from dynamics.gear.microgeometry import Microgeometry, pitch_waves
from dynamics.gear.pair import GearPair
from dynamics.gear.pair_geometry import TipShortening
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_force import evaluate_mesh, pack_meshes, tooth_forces
from dynamics.tooth.mesh_laws import (
    ContactDiscretisation,
    MeshDissipation,
    MeshPosition,
    alike_teeth,
    mesh_law,
    pair_stiffness,
)

PAIR = GearPair.from_centre_distance(
    normal_module=4.5e-3,
    teeth=(16, 25),
    centre_distance=93.0e-3,
    face_widths=(14e-3, 14e-3),
    profile_shift_1=0.2,
    thickness_allowances=(60e-6, 80e-6),
    tips=TipShortening(contact_ratio=1.4),
)
HELICAL = GearPair.from_centre_distance(
    normal_module=3e-3,
    teeth=(19, 24),
    centre_distance=68.0e-3,
    helix_angle=radians(15.0),
    face_widths=(30e-3, 30e-3),
    profile_shift_1=0.1,
    thickness_allowances=(60e-6, 80e-6),
)


def law_of(
    pair: GearPair,
    *micro: Microgeometry,
    position: MeshPosition = MeshPosition(),  # noqa: B008 - immutable
    dissipation: MeshDissipation = MeshDissipation(),  # noqa: B008 - immutable
) -> MeshLaw:
    return mesh_law(
        pair, pair_stiffness(pair, 2e5), (micro[0], micro[1]), position=position, dissipation=dissipation,
        discretisation=ContactDiscretisation(n_path=801),
    )  # fmt: skip


def first_touch(law: MeshLaw, theta_1: np.ndarray, back: bool) -> np.ndarray:
    """Approach [m] at which the first tooth pair touches, by bisection on the force of the law."""
    packed = pack_meshes([law])
    low, high = (np.full(theta_1.size, end) for end in (-1.5e-4, 1.5e-4))
    for _ in range(40):
        middle = 0.5 * (low + high)
        approach = -law.backlash - middle if back else middle
        found = evaluate_mesh(packed, theta_1, approach, 0.0, 0.0)
        touching = (found.force_back if back else found.force_front) > 0.0
        low, high = np.where(touching, low, middle), np.where(touching, middle, high)
    return -law.backlash - high if back else high


def involute_touch(pair: GearPair, shift: np.ndarray, back: bool) -> np.ndarray:
    """Approach at which flanks touch when the wheel's base circle stands ``shift`` (2, n) [m] off its place."""
    radii = sum(pair.base_radii)
    x, y = pair.centre_distance + shift[0], shift[1]
    angle, nominal = np.arccos(radii / np.hypot(x, y)), acos(radii / pair.centre_distance)
    opened = radii * ((np.tan(angle) - angle) - (tan(nominal) - nominal))
    turned = radii * np.arctan2(y, x)
    return -pair.backlash_along_path - opened + turned if back else opened + turned


@pytest.mark.parametrize("sizes", [(20e-6, 0.0), (0.0, 20e-6), (15e-6, 25e-6)])
def test_eccentric_gears_touch_on_both_flanks_where_their_involutes_do(sizes: tuple[float, float]) -> None:
    phases = 0.7, -1.9
    micro = [Microgeometry(run_out=e, run_out_phase=p) for e, p in zip(sizes, phases)]
    law = law_of(PAIR, *micro, position=MeshPosition(tooth_offset_2=3, phase=0.4e-3))
    theta_1 = np.linspace(0.0, 25.0 * 2.0 * pi, 900, endpoint=False)
    theta_2 = theta_1 * 16.0 / 25.0
    # at rotation = phase the centre of the teeth is off along the front line of action, then it turns with the gear:
    # the pinion pushes along pi/2 - alpha, the wheel the other way, and they turn in opposite senses
    steep = 0.5 * pi - PAIR.working_pressure_angle
    pinion = steep + theta_1 - phases[0]
    wheel = steep + pi - theta_2 + phases[1]
    shift = sizes[1] * np.array([np.cos(wheel), np.sin(wheel)]) - sizes[0] * np.array(
        [np.cos(pinion), np.sin(pinion)]
    )
    played = []
    for back in (False, True):
        found, expected = first_touch(law, theta_1, back), involute_touch(PAIR, shift, back)
        played.append(found)
        assert np.ptp(expected) > 1.9 * max(sizes)
        # second order is e^2 / a = 10 nm; the pinion turns on by the play between both flanks
        assert found == pytest.approx(expected, abs=2.5e-3 * sum(sizes) + 1e-8)
    backlash = played[0] - played[1]
    largest = PAIR.backlash_along_path + 2.0 * sum(sizes) * sin(PAIR.working_pressure_angle)
    assert backlash.max() <= largest + 1e-8
    if 0.0 in sizes:
        assert backlash.max() == pytest.approx(largest, abs=1e-7)


def test_tooth_that_stands_ahead_gives_way_on_its_back_flank() -> None:
    places = tuple(1e-6 * np.random.default_rng(2).normal(size=16))
    law = law_of(PAIR, Microgeometry(pitch_deviations=places), Microgeometry())
    assert law.back_deviation_1 is not None and law.back_deviation_2 is None
    assert not np.any(law.deviation_1 + law.back_deviation_1)
    sloped = law_of(PAIR, Microgeometry(), Microgeometry(profile_slopes=tuple(range(25))))
    assert sloped.back_deviation_2 is None


def test_all_teeth_ahead_are_a_gear_turned_ahead() -> None:
    ahead, behind = 5e-6, 2e-6
    micro = (
        Microgeometry(pitch_deviations=(ahead,) * 16),
        Microgeometry(pitch_deviations=(-behind,) * 25),
    )
    law, ideal = law_of(PAIR, *micro), law_of(PAIR, Microgeometry(), Microgeometry())
    single = ideal._replace(deviation_1=np.full_like(ideal.gap[:1], 1e-30))  # contacts looked up one by one
    alike = alike_teeth(law)
    assert alike.offset == pytest.approx(ahead - behind, abs=1e-15)
    theta_1 = np.linspace(0.0, 3.0, 60)
    for approach in (2e-5, -law.backlash - 2e-5):
        for turned, plain in ((law, single), (alike, ideal)):
            found = evaluate_mesh(turned, theta_1, approach + turned.offset, 10.0, 8.0)
            expected = evaluate_mesh(plain, theta_1, approach + alike.offset, 10.0, 8.0)
            scale = np.abs(expected.torque_1).max()
            assert found.torque_1 == pytest.approx(expected.torque_1, abs=1e-9 * scale)


def test_run_out_and_closed_pitch_leave_the_mean_tooth_in_its_place() -> None:
    waves = Microgeometry(
        run_out=17e-6, run_out_phase=0.3, pitch_deviations=pitch_waves(16, [(3, 4e-6, 1.0)])
    )
    law = law_of(PAIR, waves, Microgeometry(run_out=9e-6, run_out_phase=2.3))
    alike, ideal = alike_teeth(law), law_of(PAIR, Microgeometry(), Microgeometry())
    assert alike.offset == ideal.offset == 0.0
    assert alike.back_deviation_1 is None and alike.back_deviation_2 is None
    assert alike.gap == pytest.approx(ideal.gap, abs=1e-18)


def test_back_flank_of_a_tooth_meets_the_next_tooth_of_the_wheel() -> None:
    """The pinion tooth stands in the space of the wheel: teeth p + offset before it, p + 1 + offset behind it."""
    shares = np.ones(25)
    shares[7] = 0.5
    law = law_of(
        PAIR,
        Microgeometry(),
        Microgeometry(tooth_stiffness=tuple(shares)),
        position=MeshPosition(tooth_offset_2=3),
    )
    for approach, side, sound in ((2e-5, "front", 4), (-law.backlash - 2e-5, "back", 3)):
        whole = tooth_forces(law._replace(scale_2=np.ones(25)), np.linspace(0.0, 6.0, 200), approach)
        found = tooth_forces(law, np.linspace(0.0, 6.0, 200), approach)
        share = getattr(found, side).sum(axis=2) / np.maximum(getattr(whole, side).sum(axis=2), 1e-9)
        loaded = getattr(whole, side).sum(axis=2) > 1.0
        assert set(found.pair[loaded & (share < 0.6)]) == {sound}


def mirrored(pair: GearPair, micro: tuple[Microgeometry, Microgeometry], law: MeshLaw) -> MeshLaw:
    """The law of the pair seen in a mirror through both axes: front flanks are back flanks, gears turn backwards."""
    twice = 2.0 * pair.working_pressure_angle
    seen = [
        replace(
            own,
            run_out_phase=pi - own.run_out_phase - sign * twice,
            pitch_deviations=tuple(-own.pitch_deviations[-j] for j in range(teeth)),
            profile_slopes=tuple(own.profile_slopes[-j] for j in range(teeth)),
            tooth_stiffness=tuple(own.tooth_stiffness[-j] for j in range(teeth)),
        )
        for own, teeth, sign in zip(micro, pair.teeth, (1.0, -1.0))
    ]
    turned = law_of(
        pair,
        *seen,
        position=MeshPosition(phase=law.back_phase, tooth_offset_2=-1 - law.tooth_offset_2),
        dissipation=MeshDissipation(damping=400.0, friction=0.05),
    )
    assert turned.back_phase == pytest.approx(law.phase, abs=1e-15)
    return turned._replace(slice_shift=-turned.slice_shift)


@pytest.mark.parametrize("pair", [PAIR, HELICAL], ids=["spur", "helical"])
def test_a_pair_driven_the_other_way_round_is_its_mirror_image(pair: GearPair) -> None:
    rng = np.random.default_rng(5)
    first, second = (
        Microgeometry(
            run_out=12e-6,
            run_out_phase=phase,
            pitch_deviations=tuple(3e-6 * rng.normal(size=teeth)),
            profile_slopes=tuple(3e-6 * rng.normal(size=teeth)),
            tooth_stiffness=tuple(1.0 + 0.1 * rng.normal(size=teeth)),
            profile_crowning=5e-6,
        )
        for phase, teeth in zip((0.4, 2.2), pair.teeth)
    )
    law = law_of(
        pair, first, second, position=MeshPosition(phase=0.3e-3, tooth_offset_2=5),
        dissipation=MeshDissipation(damping=400.0, friction=0.05),
    )  # fmt: skip
    image = mirrored(pair, (first, second), law)
    theta_1 = np.linspace(0.0, 40.0, 500)
    for approach in (2.5e-5, -law.backlash - 2.5e-5):
        omega = 90.0, 91.0 * pair.teeth[0] / pair.teeth[1]
        here = evaluate_mesh(law, theta_1, approach, *omega)
        there = evaluate_mesh(image, -theta_1, -approach - law.backlash, -omega[0], -omega[1])
        scale = np.abs(here.torque_1).max()
        assert scale > 10.0
        assert there.torque_1 == pytest.approx(-here.torque_1, abs=1e-9 * scale)
        assert there.torque_2 == pytest.approx(-here.torque_2, abs=1e-9 * scale)
        assert there.force_back == pytest.approx(here.force_front, abs=1e-7 * scale)
        assert there.friction_power == pytest.approx(here.friction_power, rel=1e-9, abs=1e-9 * scale)
        assert there.energy == pytest.approx(here.energy, rel=1e-9)
