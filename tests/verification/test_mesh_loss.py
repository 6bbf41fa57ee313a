"""Published and hand-computed mesh losses: FZG-C and FZG-A, and the gears of the UHCF prototype (P2)."""

import math

import pytest

from dynamics.losses.mesh_loss import mesh_loss
from dynamics.tooth.friction import (
    Schlenk,
    ToothPath,
    friction_coefficient,
    ohlendorf_factor,
    tooth_loss_factor,
)

TEST_SPEED = 12000 * math.pi / 30


def tip_circle_path(module, teeth, centre_distance, tip_radii, face_width, contact_ratio=None):
    """Path of contact from the tip circles alone, 20 degrees; A set by the contact ratio if one is given."""
    alpha = math.radians(20.0)
    base_1, base_2 = (0.5 * module * z * math.cos(alpha) for z in teeth)
    working = math.acos((base_1 + base_2) / centre_distance)
    pitch = math.pi * module * math.cos(alpha)
    end = math.sqrt(tip_radii[0] ** 2 - base_1**2) - base_1 * math.tan(working)
    if contact_ratio is None:
        start = base_2 * math.tan(working) - math.sqrt(tip_radii[1] ** 2 - base_2**2)
    else:
        start = end - contact_ratio * pitch
    return ToothPath(
        base_radius_1=base_1,
        base_radius_2=base_2,
        start=start,
        end=end,
        base_pitch=pitch,
        working_pressure_angle=working,
        face_width=face_width,
    )


def fzg(shifts, face_width):
    tips = [0.5 * 4.5e-3 * (z + 2.0 + 2.0 * x) for z, x in zip((16, 24), shifts, strict=True)]
    return tip_circle_path(4.5e-3, (16, 24), 91.5e-3, tips, face_width)


def prototype(pinion_shift):
    """Test gear of P2, Figure 7: z 99/102, m 1, a 99.5, eps_alpha 1.26 by shortening the wheel tips."""
    return tip_circle_path(1e-3, (99, 102), 99.5e-3, (50.5e-3 + pinion_shift * 1e-3, 0.0), 7e-3, 1.26)


def test_fzg_c_factor():
    path = fzg((0.1817, 0.1715), 14e-3)
    assert tooth_loss_factor(path) == pytest.approx(0.1986, abs=5e-5)
    assert ohlendorf_factor(path, 16) == pytest.approx(tooth_loss_factor(path), rel=1e-9)


def test_fzg_a_factor():
    """The pitch point of FZG-A lies in double contact (eps_2 0.250 < eps_alpha - 1 = 0.356): the often quoted
    0.3043 is Ohlendorf's formula, which counts one sign wrong; its load sharing integrates to 0.3006.
    """
    path = fzg((0.8532, -0.5), 20e-3)
    assert ohlendorf_factor(path, 16) == pytest.approx(0.3043, abs=5e-5)
    assert -path.start / path.base_pitch == pytest.approx(0.2497, abs=5e-5)
    assert tooth_loss_factor(path) == pytest.approx(0.3006, abs=5e-5)


@pytest.mark.parametrize(("shift", "factor"), [(-0.714, 0.0364), (-0.4805, 0.0508), (0.0, 0.1005)])
def test_prototype_factor_hangs_on_the_profile_shift_split(shift, factor):
    assert tooth_loss_factor(prototype(shift)) == pytest.approx(factor, abs=5e-5)


def test_ohlendorf_is_wrong_for_the_prototype():
    """x1 = 0: the pitch point lies before A; the bare formula gives 0.1141 instead of 0.1005."""
    path = prototype(0.0)
    eps_1, eps_2 = path.end / path.base_pitch, -path.start / path.base_pitch
    bare = math.pi * (1.0 + 99 / 102) / 99 * (1.0 - 1.26 + eps_1**2 + eps_2**2)
    assert eps_2 < 0.0
    assert bare == pytest.approx(0.1141, abs=5e-5)
    with pytest.raises(ValueError, match="pitch point lies"):
        ohlendorf_factor(path, 99)


@pytest.mark.parametrize(
    ("torque", "at_10_mpas", "at_20_mpas", "transmitted"),
    [
        (94.1, 188, 182, 21.4e3),
        (183.4, 419, 405, 41.7e3),
        (302.0, 762, 736, 68.6e3),
        (372.6, 980, 947, 84.7e3),
    ],
)
def test_fzg_c_losses(torque, at_10_mpas, at_20_mpas, transmitted):
    """Schlenk, Ra 0.4 um, X_L 1, 2170 rpm, loss per mesh in W (validation case V8)."""
    path = fzg((0.1817, 0.1715), 14e-3)
    speed = 2170 * math.pi / 30
    for viscosity, expected in ((0.010, at_10_mpas), (0.020, at_20_mpas)):
        contact = path.contact(
            torque, speed, reference_diameter_1=72e-3, roughness=0.4e-6, viscosity=viscosity
        )
        loss = mesh_loss("mesh", path, torque, speed, friction_coefficient(contact, Schlenk()))
        assert loss.power == pytest.approx(expected, abs=0.6)
        assert loss.details["transmitted_power"] == pytest.approx(transmitted, rel=3e-3)


@pytest.mark.parametrize(("shift", "power"), [(-0.714, 344), (-0.4805, 480), (0.0, 951)])
def test_prototype_loss_is_of_the_size_of_the_printed_500_w(shift, power):
    """180 Nm, 12,000 rpm, Ra 0.5 um, 5 mPa s: mu about 0.042 at the uncapped 62 m/s; P2 prints 500 W a mesh.

    Schlenk's cap of 50 m/s raises mu by (62/50)^0.2 = 4.3 %, the whole difference to the hand values.
    """
    path = prototype(shift)
    contact = path.contact(180.0, TEST_SPEED, reference_diameter_1=99e-3, roughness=0.5e-6, viscosity=5e-3)
    friction = friction_coefficient(contact, Schlenk())
    loss = mesh_loss("mesh", path, 180.0, TEST_SPEED, friction)
    assert contact.pitch_line_speed == pytest.approx(61.6, abs=0.1)
    assert len(friction.warnings) == 1
    assert "50 m/s" in friction.warnings[0]
    cap = (contact.pitch_line_speed / 50.0) ** 0.2
    assert friction.value / cap == pytest.approx(0.042, abs=4e-4)
    assert loss.power / cap == pytest.approx(power, rel=0.01)
