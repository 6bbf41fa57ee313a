"""Geometry of gears in an oil bath."""

import math
from dataclasses import replace

import numpy as np
import pytest

from dynamics.losses.immersion import (
    DippedGear,
    OilBath,
    immersion,
    level_warnings,
    splash_flow,
    tooth_space_flow,
    wetted_area,
)
from dynamics.losses.loss import LossError
from tests.builders.fzg_bath import bath, stage
from tests.builders.p2_gears import helical_pair

PINION, WHEEL = (running.gear for running in stage())


def test_half_a_disc() -> None:
    """Level at the shaft centre: half the disc, half a turn, chord the diameter."""
    half = immersion(WHEEL, bath())
    area = math.pi * WHEEL.tip_radius**2
    assert half.depth == pytest.approx(WHEEL.tip_radius)
    assert half.share_of_turn == pytest.approx(0.5)
    assert half.chord == pytest.approx(2.0 * WHEEL.tip_radius)
    assert half.side_area == pytest.approx(area)
    assert half.rim_area == pytest.approx(math.pi * WHEEL.tip_radius * WHEEL.face_width)
    assert half.volume == pytest.approx(0.5 * area * WHEEL.face_width)


@pytest.mark.parametrize("level", [-50e-3, -20e-3, 0.0, 10e-3])
def test_segment_against_strips(level: float) -> None:
    """Second way: horizontal strips of the disc below the surface."""
    found = immersion(WHEEL, bath(level))
    radius = WHEEL.tip_radius
    edges = np.linspace(-radius, level, 20001)
    middle = 0.5 * (edges[1:] + edges[:-1])
    area = float(np.sum(2.0 * np.sqrt(radius**2 - middle**2) * np.diff(edges)))
    assert 0.5 * found.side_area == pytest.approx(area, rel=1e-5)
    assert found.volume == pytest.approx(area * WHEEL.face_width, rel=1e-5)
    assert found.chord == pytest.approx(2.0 * math.sqrt(radius**2 - level**2))


def test_smaller_gear_of_the_sump_may_hang_dry() -> None:
    """45 mm below the centres only the wheel dips."""
    low = bath(-45e-3)
    assert immersion(PINION, low).depth == 0.0
    assert immersion(PINION, low).volume == 0.0
    assert wetted_area(PINION, low) == 0.0
    assert tooth_space_flow(PINION, low, 200.0) == 0.0
    assert immersion(WHEEL, low).depth == pytest.approx(14.18e-3)


def test_wetted_area_by_hand() -> None:
    """Half a wheel: pi R^2 + pi R b + z H b/(cos 20) = 91.6 + 23.8 + 35.9 cm2."""
    height = WHEEL.tip_radius - WHEEL.root_radius
    flanks = 24 * height * 14e-3 / math.cos(math.radians(20.0))
    whole = math.pi * 54e-3**2 + math.pi * 54e-3 * 14e-3 + flanks
    assert wetted_area(WHEEL, bath()) == pytest.approx(whole)
    assert whole == pytest.approx(151.3e-4, abs=0.2e-4)


def test_oil_held_elsewhere_lowers_the_level() -> None:
    assert immersion(WHEEL, replace(bath(), lowering=20e-3)) == immersion(WHEEL, bath(-20e-3))


def test_level_above_the_shaft_is_refused_with_key_value_limit_and_remedy() -> None:
    immersion(PINION, bath(14.9e-3))
    with pytest.raises(LossError, match=r"level = 15\.0 mm.*below the top of the shaft at 15\.0 mm; lower"):
        immersion(PINION, bath(15e-3))


def test_level_at_the_shaft_and_tips_only_are_said() -> None:
    assert "reaches the shaft at -15.0 mm" in level_warnings("box/pinion", PINION, bath(-15e-3))[0]
    assert level_warnings("box/pinion", PINION, bath(-20e-3)) == ()
    assert "less than the tooth height" in level_warnings("box/pinion", PINION, bath(-38e-3))[0]
    assert level_warnings("box/pinion", PINION, bath(-50e-3)) == ()


def test_tooth_spaces_lift_half_a_ring_a_turn() -> None:
    speed = 2.0 * math.pi
    ring = math.pi * (WHEEL.tip_radius**2 - WHEEL.root_radius**2) * WHEEL.face_width
    assert tooth_space_flow(WHEEL, bath(), speed) == pytest.approx(0.5 * ring)
    assert tooth_space_flow(WHEEL, bath(), -speed) == tooth_space_flow(WHEEL, bath(), speed)
    tips = bath(-WHEEL.tip_radius + 1e-3)
    assert tooth_space_flow(WHEEL, tips, speed) == pytest.approx(
        0.5 * math.pi * (WHEEL.tip_radius**2 - (WHEEL.tip_radius - 1e-3) ** 2) * WHEEL.face_width
    )


def test_splash_is_a_bounded_share_and_starts_at_three_metres_a_second() -> None:
    slow, fast = 2.99 / WHEEL.tip_radius, 3.01 / WHEEL.tip_radius
    assert splash_flow(WHEEL, bath(), slow) == 0.0
    assert splash_flow(WHEEL, bath(), fast) == pytest.approx(0.01 * tooth_space_flow(WHEEL, bath(), fast))
    with pytest.raises(LossError, match=r"splash share = 0\.5: must lie within 0\.001 to 0\.1"):
        splash_flow(WHEEL, bath(), fast, 0.5)


def test_gear_of_a_pair() -> None:
    pair = helical_pair()
    dipped = DippedGear.of_pair(pair, 1, axis_height=0.1, shaft_radius=20e-3)
    assert (dipped.teeth, dipped.face_width) == (102, 40e-3)
    assert dipped.tip_radius == pair.gears[1].tip_radius
    assert dipped.helix_angle == pytest.approx(math.radians(18.0))
    assert dipped.lowest_point == pytest.approx(0.1 - dipped.tip_radius)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"volume": 0.0}, "volume = 0 m3"),
        ({"density": -1.0}, "density = -1 kg/m3"),
        ({"viscosity": math.nan}, "viscosity = nan Pa s"),
        ({"lowering": -1e-3}, "lowering = -0.001 m"),
        ({"level": math.inf}, "level = inf m"),
        ({"hydraulic_length": 0.0}, "hydraulic_length = 0.0 m"),
    ],
)
def test_impossible_baths(change: dict[str, float], told: str) -> None:
    with pytest.raises(LossError, match=told.replace(".", r"\.")):
        replace(bath(), **change)


def test_impossible_gears() -> None:
    with pytest.raises(LossError, match="teeth = 0"):
        replace(WHEEL, teeth=0)
    with pytest.raises(LossError, match="must fall in this order"):
        replace(WHEEL, shaft_radius=WHEEL.root_radius)
    assert isinstance(bath(), OilBath)


@pytest.mark.parametrize("name", ["axis_height", "face_width", "pressure_angle", "helix_angle"])
@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_gear_of_no_finite_size_is_refused(name: str, value: float) -> None:
    """An axis at no height would be a dry gear without a loss."""
    with pytest.raises(LossError, match=f"dipped gear: {name} = "):
        replace(PINION, **{name: value})
