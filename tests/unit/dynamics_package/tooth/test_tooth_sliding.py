"""Tooth-loss factor, sliding speed and the loss of a force history."""

import math

import numpy as np
import pytest

from dynamics.losses.loss import LossError
from dynamics.losses.mesh_loss import mesh_loss, squeeze_loss
from dynamics.tooth.friction import (
    GivenFriction,
    Schlenk,
    ToothPath,
    ToothPathError,
    friction_coefficient,
    ohlendorf_factor,
    tooth_loss_factor,
)
from tests.builders.p2_gears import helical_pair


def spur_path(start: float = -4e-3, end: float = 5e-3, **changes: float) -> ToothPath:
    numbers = {
        "base_radius_1": 0.05,
        "base_radius_2": 0.08,
        "start": start,
        "end": end,
        "base_pitch": 6e-3,
        "working_pressure_angle": 0.35,
        "face_width": 0.02,
    }
    return ToothPath(**(numbers | changes))


def brute_force_factor(path: ToothPath, phases: int = 4000, slices: int = 801) -> float:
    """Midpoint sums over phase and face width, knowing nothing of breakpoints or antiderivatives."""
    lag = (np.arange(slices) + 0.5) / slices * path.width_shift
    pairs = np.arange(-1, 12)
    total = 0.0
    for phase in (np.arange(phases) + 0.5) / phases * path.base_pitch:
        s = path.start + phase + pairs[:, None] * path.base_pitch - lag[None, :]
        touching = (s >= path.start) & (s <= path.end)
        total += np.abs(s[touching]).sum() / touching.sum()
    per_radius = 1.0 / path.base_radius_1 + 1.0 / path.base_radius_2
    return total / phases * per_radius / math.cos(path.base_helix_angle)


@pytest.mark.parametrize(("start", "end"), [(-4e-3, 5e-3), (0.5e-3, 8e-3), (-7e-3, -0.2e-3), (-1e-3, 7.5e-3)])
def test_spur_factor_equals_brute_force(start: float, end: float) -> None:
    path = spur_path(start, end)
    assert tooth_loss_factor(path) == pytest.approx(brute_force_factor(path, slices=1), rel=2e-3)


@pytest.mark.parametrize("helix", [0.1, 0.3, -0.3])
def test_helical_factor_equals_brute_force(helix: float) -> None:
    path = spur_path(base_helix_angle=helix, face_width=0.03)
    assert tooth_loss_factor(path) == pytest.approx(brute_force_factor(path, phases=600), rel=2e-3)


def test_equal_stiffness_shares_like_rigid_teeth() -> None:
    path = spur_path()
    assert tooth_loss_factor(path, lambda s: np.full_like(s, 14e9)) == pytest.approx(tooth_loss_factor(path))


def test_pairs_softer_at_the_ends_lose_less() -> None:
    path = spur_path()
    soft_ends = tooth_loss_factor(path, lambda s: 1.0 - (s / 9e-3) ** 2)
    assert soft_ends < 0.99 * tooth_loss_factor(path)


def test_ohlendorf_is_the_integral_with_the_pitch_point_in_single_contact() -> None:
    path = spur_path()
    assert ohlendorf_factor(path, round(2 * math.pi * 0.05 / 6e-3)) == pytest.approx(
        tooth_loss_factor(path), rel=0.01
    )


def test_ohlendorf_refuses_a_pitch_point_outside() -> None:
    with pytest.raises(ValueError, match="integrated tooth-loss factor"):
        ohlendorf_factor(spur_path(0.5e-3, 8e-3), 52)


def test_steady_force_history_gives_the_steady_loss() -> None:
    """The loop's integral over forces F(t), s(t) equals mu H_V P for the same load sharing."""
    path = spur_path(base_helix_angle=0.0)
    omega_1, torque = 300.0, 40.0
    omega_2 = omega_1 * path.base_radius_1 / path.base_radius_2
    phase = (np.arange(6000) + 0.5) / 6000 * path.base_pitch
    s = path.start + phase[:, None] + np.arange(3)[None, :] * path.base_pitch
    touching = s <= path.end
    force = touching * (torque / path.base_radius_1 / touching.sum(axis=1))[:, None]
    speed = np.abs(omega_1 + omega_2) * np.abs(s)
    power = (path.transverse_friction(0.05) * force * speed).sum(axis=1).mean()
    friction = friction_coefficient(
        path.contact(torque, omega_1, reference_diameter_1=0.1, roughness=4e-7, viscosity=0.01),
        GivenFriction(value=0.05),
    )
    assert power == pytest.approx(mesh_loss("mesh", path, torque, omega_1, friction).power, rel=1e-3)


def test_helical_teeth_press_harder_than_their_transverse_force() -> None:
    path = spur_path(base_helix_angle=0.3)
    assert path.transverse_friction(0.05) == pytest.approx(0.05 / math.cos(0.3))


def test_loss_does_not_care_for_the_running_direction() -> None:
    path = spur_path()
    contact = path.contact(-40.0, -300.0, reference_diameter_1=0.1, roughness=4e-7, viscosity=0.01)
    friction = friction_coefficient(contact, Schlenk())
    forward = mesh_loss("mesh", path, 40.0, 300.0, friction)
    assert mesh_loss("mesh", path, -40.0, 300.0, friction).power == forward.power > 0.0


def test_path_of_a_gear_pair() -> None:
    pair = helical_pair()
    path = ToothPath.of_pair(pair)
    assert path.contact_ratio == pytest.approx(1.448)
    assert path.width_shift == pytest.approx(pair.overlap_ratio * pair.base_pitch)
    assert 0.05 < tooth_loss_factor(path) < 0.07


def test_contact_ratio_below_one_is_refused() -> None:
    with pytest.raises(ToothPathError, match="contact ratio"):
        spur_path(-2e-3, 3e-3)


def test_squeeze_is_a_share_up_to_a_tenth() -> None:
    path = spur_path()
    contact = path.contact(40.0, 300.0, reference_diameter_1=0.1, roughness=4e-7, viscosity=0.01)
    loss = mesh_loss("mesh", path, 40.0, 300.0, friction_coefficient(contact, GivenFriction(value=0.04)))
    assert squeeze_loss("mesh", loss, 0.1).power == pytest.approx(0.1 * loss.power)
    with pytest.raises(LossError, match="squeeze share"):
        squeeze_loss("mesh", loss, 0.11)
