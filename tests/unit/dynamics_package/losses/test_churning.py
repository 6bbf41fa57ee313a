"""Churning of dipped gears: hand values, limits, monotony, which law is recommended."""

from dataclasses import replace
from typing import Any

import pytest

from dynamics.losses.churning import (
    LAWS,
    BathNumbers,
    ChurningLaw,
    bath_numbers,
    churning_loss,
    coefficient_2007,
    coefficient_2011,
    compare_churning,
    side_friction,
    stage_churning,
)
from dynamics.losses.loss import LossError
from tests.builders.fzg_bath import LOW_VOLUME, bath, stage

PINION, WHEEL = stage()
NUMBERS = BathNumbers(depth=0.3, oil=1.0, width=0.15, froude=100.0, reynolds=3000.0, acceleration=500.0)


def total(level: float = 0.0, law: ChurningLaw = "changenet_2011", **changes: Any) -> float:
    return sum(loss.power for loss in stage_churning(stage(), replace(bath(level), **changes), law))


def test_slow_viscous_coefficient_by_hand() -> None:
    """1.366 x 0.3^0.45 x 100^-0.6 x 3000^-0.21 x 0.3^0.21 = 1.366 x 0.5818 x 0.06310 x 0.1861 x 0.7766."""
    by_hand = 1.366 * 0.58175 * 0.063096 * 0.18610 * 0.77660
    assert coefficient_2011(NUMBERS) == pytest.approx(by_hand, rel=2e-4)
    assert coefficient_2007(NUMBERS) == pytest.approx(by_hand, rel=2e-4)


def test_fast_coefficient_by_hand() -> None:
    """3.644 x 0.3^0.1 x 100^-0.88 x 0.15^0.85 = 3.644 x 0.8866 x 0.01738 x 0.1994, by both forms above Re_c 9000."""
    fast = NUMBERS._replace(reynolds=2e4, acceleration=2000.0)
    by_hand = 3.644 * 0.88657 * 0.017378 * 0.19938
    assert coefficient_2007(fast) == pytest.approx(by_hand, rel=2e-4)
    assert coefficient_2011(fast) == pytest.approx(by_hand, rel=1e-3)


def test_published_pairs_meet_at_one_reynolds_number() -> None:
    """What is remembered is consistent: both inviscid constants are the viscous ones times 4000^-0.21."""
    for viscous, inviscid in ((1.366, 0.239), (20.797, 3.644)):
        assert (viscous / inviscid) ** (1 / 0.21) == pytest.approx(4000.0, rel=0.01)


@pytest.mark.parametrize("edge", [("acceleration", 750.0), ("acceleration", 1250.0), ("reynolds", 4000.0)])
def test_2011_is_continuous(edge: tuple[str, float]) -> None:
    name, value = edge
    below, above = (coefficient_2011(NUMBERS._replace(**{name: value * f})) for f in (1 - 1e-7, 1 + 1e-7))
    assert below == pytest.approx(above, rel=1e-5)


def test_2007_is_continuous() -> None:
    for edge in (6000.0, 9000.0):
        below, above = (coefficient_2007(NUMBERS._replace(reynolds=edge * f)) for f in (1 - 1e-7, 1 + 1e-7))
        assert below == pytest.approx(above, rel=1e-5)


def test_power_is_torque_of_the_paper_times_speed() -> None:
    loss = churning_loss(WHEEL, bath())
    speed, radius = abs(WHEEL.speed), 54e-3
    torque = 0.5 * 842.0 * speed**2 * radius**3 * loss.details["wetted_area"] * loss.details["coefficient"]  # type: ignore[operator]
    assert loss.power == pytest.approx(torque * speed)
    assert (loss.place, loss.kind) == ("test/wheel", "churning")
    numbers = bath_numbers(WHEEL, bath())
    assert numbers.froude == pytest.approx(speed**2 * radius / 9.81)
    assert numbers.reynolds == pytest.approx(speed * radius * 14e-3 / 13.92e-6)
    assert numbers.depth == pytest.approx(0.5)


@pytest.mark.parametrize("law", LAWS)
def test_nothing_without_speed_or_immersion(law: ChurningLaw) -> None:
    assert churning_loss(replace(PINION, speed=0.0), bath(), law).power == 0.0
    assert churning_loss(PINION, bath(-60e-3), law).power == 0.0
    assert all(loss.power == 0.0 for loss in stage_churning(stage(), bath(-60e-3), law))


@pytest.mark.parametrize("law", LAWS)
def test_grows_with_speed_and_depth_and_knows_no_sense_of_rotation(law: ChurningLaw) -> None:
    powers = [
        churning_loss(replace(WHEEL, speed=n), bath(), law).power for n in (1e-3, 20.0, 80.0, 150.0, 400.0)
    ]
    assert powers == sorted(powers)
    assert powers[0] < 1e-3  # ISO keeps a torque of 0.7 N m at standstill
    depths = [total(level, law) for level in (-40e-3, -30e-3, -20e-3, -10e-3, 0.0)]
    assert depths == sorted(depths)
    assert churning_loss(replace(WHEEL, speed=-WHEEL.speed), bath(), law).power == pytest.approx(
        churning_loss(WHEEL, bath(), law).power
    )


def test_viscosity_counts_in_the_slow_viscous_regime_only() -> None:
    assert total(viscosity=842 * 100e-6) / total(viscosity=842 * 50e-6) == pytest.approx(2.0**0.21, rel=1e-6)
    assert total(viscosity=842 * 10e-6) == pytest.approx(total(viscosity=842 * 14e-6))
    assert total(law="iso_tr_14179_2", viscosity=1.0) == total(law="iso_tr_14179_2")


def test_iso_stage_by_hand() -> None:
    """h_e 41.23 + 59.18 mm, b 14, l_h 100, h_C 59.18: C_Sp 1.822, C_1 0.6677, C_2 0.3255, v_t 8.18 m/s.

    T_H = 1.822 x 0.6677 x exp(0.2663) = 1.588 N m at the wheel, 151.5 rad/s: 240.6 W, by immersion 98.8 and 141.8.
    """
    pinion, wheel = stage_churning(stage(), bath(), "iso_tr_14179_2")
    assert pinion.details["stage_torque"] == pytest.approx(1.588, abs=0.002)
    assert pinion.power + wheel.power == pytest.approx(240.6, abs=0.3)
    assert pinion.power / wheel.power == pytest.approx(41.23 / 59.18)


def test_gear_alone_by_iso_has_a_dry_neighbour() -> None:
    """Neighbour far above the oil: the stage is the gear alone."""
    high = replace(PINION, gear=replace(PINION.gear, axis_height=0.2))
    level = (high, WHEEL)
    _, wheel = stage_churning(level, bath(), "iso_tr_14179_2")
    alone = churning_loss(WHEEL, bath(), "iso_tr_14179_2")
    assert wheel.details["share_of_stage"] == 1.0
    assert wheel.power < alone.power  # the contact lies higher above the bottom: less oil reaches it


def test_iso_needs_the_hydraulic_length() -> None:
    with pytest.raises(LossError, match=r"hydraulic length is missing.*changenet_2011"):
        churning_loss(WHEEL, bath(hydraulic_length=None), "iso_tr_14179_2")
    assert "iso_tr_14179_2" not in compare_churning(stage(), bath(hydraulic_length=None)).losses


def test_unknown_law_is_refused() -> None:
    law: Any = "boness"
    with pytest.raises(LossError, match="churning law = 'boness': unknown; give one of changenet_2011"):
        churning_loss(WHEEL, bath(), law)


def test_no_law_falls_below_the_friction_of_the_faces() -> None:
    """Second way: skin friction of a free disc in oil on the immersed part of the faces alone."""
    for level, volume in ((0.0, 1.25e-3), (-20e-3, LOW_VOLUME)):
        for law in LAWS:
            for running, loss in zip(stage(), stage_churning(stage(), bath(level, volume), law), strict=True):
                assert loss.power > side_friction(running, bath(level))
    assert side_friction(WHEEL, bath()) == pytest.approx(4.7, rel=0.1)


def test_recommendation_follows_the_ranges() -> None:
    near = compare_churning(stage(), bath())
    assert near.recommended == "changenet_2011"
    assert near.powers["iso_tr_14179_2"] == max(near.powers.values())
    assert "changenet_2011 1.25" in near.reason
    assert any(
        "pitch diameter = 0.072 m: outside 0.09 to 0.16 m" in text
        for text in near.losses[LAWS[0]][0].warnings
    )

    def large(running: Any) -> Any:
        gear = running.gear
        sizes = {name: 4 * getattr(gear, name) for name in ("tip_radius", "pitch_radius", "root_radius")}
        return replace(running, gear=replace(gear, **sizes, shaft_radius=60e-3, face_width=50e-3))

    pinion, wheel = (large(running) for running in stage())
    far = compare_churning((pinion, wheel), bath(-100e-3, 20e-3, 0.4))
    assert far.recommended == "iso_tr_14179_2"
