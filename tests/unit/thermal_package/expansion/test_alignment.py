"""Alignment of the hot gearbox against closed forms: free swelling, a gradient through the height, an ellipse."""

from dataclasses import replace

import numpy as np
import pytest

from tests.builders.expansion import COLD, IRON, STEEL, geometry
from thermal.expansion.alignment import (
    ShaftAxis,
    axis_tolerances,
    misalignment,
    roundness,
    shaft_axis,
    shaft_pair,
)
from thermal.expansion.expansion import DeformedGeometry, Expansion, ExpansionSetup, expand
from thermal.expansion.setup import ROUND
from thermal.housing.gearbox import build_gearbox
from thermal.housing.stations import GearboxModel

GRADIENT = 300.0
"""Of the temperature through the height [K/m]."""


@pytest.fixture(scope="module")
def model() -> GearboxModel:
    return build_gearbox(geometry(), "quick")


@pytest.fixture(scope="module")
def setup(model: GearboxModel) -> ExpansionSetup:
    return ExpansionSetup(
        model, {body: IRON if body in ("housing", "field") else STEEL for body in model.mesh.bodies}
    )


def hot(setup: ExpansionSetup, temperature: np.ndarray) -> Expansion:
    return expand(setup, temperature, COLD, tolerance=1e-11)


@pytest.fixture(scope="module")
def uniform(model: GearboxModel, setup: ExpansionSetup) -> Expansion:
    return hot(setup, np.full(len(model.mesh.points), COLD + 80.0))


def test_uniform_heat_leaves_bores_round_and_shafts_straight_in_them(uniform: Expansion) -> None:
    for bearing in uniform.bearings.values():
        assert bearing.bore_expansion > 3e-5
        # facets lie beside the circle: 1e-5 of the 0.2 mm the bore moves
        assert bearing.bore_roundness.peak_to_valley < 2e-9
        assert bearing.bore_roundness.second_harmonic < 2e-10
        assert bearing.tilt < 1e-8
    for axis in uniform.axes.values():
        assert axis.slope == pytest.approx((0.0, 0.0), abs=1e-9)


def test_uniform_heat_lifts_an_axis_by_its_height(model: GearboxModel, uniform: Expansion) -> None:
    """Coupling to a machine that stays cold: the box rises by alpha dT h, and moves out from the middle of the foot."""
    foot = model.mesh.points[np.unique(model.mesh.surfaces[model.foot_surface])]
    middle = 0.5 * (foot.min(axis=0) + foot.max(axis=0))
    for shaft in model.shafts:
        for x in (shaft.start, shaft.end):
            pair = shaft_pair((uniform.axes[shaft.name].shift(x), uniform.axes[shaft.name].slope), COLD_END)
            expected = IRON[2] * 80.0 * (np.array(shaft.axis) - middle)[1:]
            assert pair.offset == pytest.approx(tuple(expected), abs=1e-9)
            assert pair.bend < 1e-8


COLD_END = ((0.0, 0.0), (0.0, 0.0))


def test_gradient_through_the_height_bends_the_box_as_by_hand(
    model: GearboxModel, setup: ExpansionSetup
) -> None:
    """dT = g (z - z0) is free of stress: u_z = alpha g (z^2 - x^2 - y^2)/2, u_x = alpha g x z, u_y = alpha g y z.

    Every section turns by -alpha g x: bores stay round, tilt with it, and the axis through two of them has the
    mean of their slopes. Coordinates from the middle of the foot, whose mean height is taken out.
    """
    points = model.mesh.points
    foot = points[np.unique(model.mesh.surfaces[model.foot_surface])]
    middle = 0.5 * (foot.min(axis=0) + foot.max(axis=0))
    field = COLD + GRADIENT * (points[:, 2] - middle[2])
    result = hot(setup, field)
    bow = IRON[2] * GRADIENT
    size = np.ptp(foot, axis=0)
    mean_foot = -bow * (size[0] ** 2 + size[1] ** 2) / 24.0
    for shaft in model.shafts:
        stations = [b for b in model.bearings if b.shaft == shaft.name]
        x = np.array([b.centre[0] - middle[0] for b in stations])
        axis = result.axes[shaft.name]
        assert axis.slope[1] == pytest.approx(-bow * x.mean(), abs=1e-7)
        assert axis.slope[0] == pytest.approx(0.0, abs=1e-7)
        for station, place in zip(stations, x, strict=True):
            found = result.bearings[station.name]
            assert found.bore_tilt[1] == pytest.approx(-bow * place, rel=2e-3)
            assert found.misalignment[1] == pytest.approx(bow * (place - x.mean()), rel=2e-3)
            assert found.misalignment[0] == pytest.approx(0.0, abs=2e-3 * bow * abs(place))
            # curved cells of the quick mesh carry the 0.16 mm of the quadratic field to a thousandth
            assert found.bore_roundness.peak_to_valley < 2e-7
        y, z = np.array(shaft.axis)[1:] - middle[1:]
        radius = 0.5 * stations[0].diameter
        along = x**2 + stations[0].width ** 2 / 12.0  # a bore counts by its mean over its width
        height = 0.5 * bow * (z**2 - y**2 + radius**2 - along) - mean_foot
        end = shaft.end - middle[0]
        by_hand = height[0] + (height[1] - height[0]) / (x[1] - x[0]) * (end - x[0])
        assert axis.shift(shaft.end)[1] == pytest.approx(by_hand, abs=2e-8)
        assert axis.shift(shaft.end)[0] == pytest.approx(bow * y * z, abs=2e-8)


def test_a_bore_squeezed_to_an_ellipse_is_read_as_one(model: GearboxModel, setup: ExpansionSetup) -> None:
    """u = e (y cos 2p + z sin 2p, y sin 2p - z cos 2p): radius r + e r cos 2(angle - p); moved bodily beside it."""
    station, other = model.bearings[0], model.bearings[1]
    turn, share = np.radians(25.0), 1e-3
    arm = model.mesh.points - np.array(station.centre)
    nodes = np.unique(model.mesh.surfaces[station.bore_surface])
    moved = np.zeros_like(model.mesh.points)
    cos, sin = np.cos(2.0 * turn), np.sin(2.0 * turn)
    moved[nodes, 1] = share * (cos * arm[nodes, 1] + sin * arm[nodes, 2]) + 3e-5
    moved[nodes, 2] = share * (sin * arm[nodes, 1] - cos * arm[nodes, 2]) - 2e-5
    shape = DeformedGeometry(setup, np.full(len(moved), COLD), COLD, moved)
    found, left_alone = shape.bearing(station), shape.bearing(other)
    radius = 0.5 * station.diameter + 20e-6 / 2.0
    assert found.bore_roundness.peak_to_valley == pytest.approx(2.0 * share * radius, rel=5e-3)
    assert found.bore_roundness.second_harmonic == pytest.approx(share * radius, rel=5e-3)
    assert found.bore_roundness.long_axis == pytest.approx(turn, abs=2e-3)
    assert found.bore_ovality == pytest.approx(4.0 * share * radius, rel=5e-3)
    assert left_alone.bore_roundness.peak_to_valley < 1e-12


def test_roundness_takes_growth_and_shift_out_and_the_worst_section_in() -> None:
    even = 5e-6 + 3e-6 * np.cos(ROUND) - 7e-6 * np.sin(ROUND)
    lobes = even + 2e-6 * np.cos(3.0 * ROUND)
    oval = even + 1e-6 * np.cos(2.0 * (ROUND - 2.5))
    found = roundness(ROUND, np.array([even, lobes, oval]))
    assert found.peak_to_valley == pytest.approx(4e-6)
    assert found.second_harmonic == pytest.approx(1e-6)
    assert found.long_axis == pytest.approx(2.5)
    assert roundness(ROUND, np.array([even])).peak_to_valley < 1e-18


def test_axis_of_three_bearings_is_the_line_of_least_squares() -> None:
    axis = shaft_axis("s", [0.0, 0.1, 0.2], [(0.0, 1e-5), (3e-6, 2e-5), (0.0, 3e-5)])
    assert axis.shift(0.1) == pytest.approx((1e-6, 2e-5))
    assert axis.slope == pytest.approx((0.0, 1e-4))
    alone = shaft_axis("s", [0.3], [(1e-6, 2e-6)])
    assert alone.slope == (0.0, 0.0)
    assert alone.shift(9.0) == pytest.approx((1e-6, 2e-6))


def test_tilt_is_the_shaft_less_its_bore() -> None:
    axis = ShaftAxis(name="s", at=0.0, offset=(0.0, 0.0), slope=(2e-4, -1e-4))
    assert misalignment(axis, (5e-5, -3e-4)) == pytest.approx((1.5e-4, 2e-4))
    assert misalignment(replace(axis, slope=(5e-5, -3e-4)), (5e-5, -3e-4)) == (0.0, 0.0)


def test_cold_offset_against_the_hot_one_makes_it_zero() -> None:
    first, second = ((3e-4, 4e-4), (1e-4, 0.0)), ((0.0, 1e-4), (0.0, 2e-4))
    pair = shaft_pair(first, second)
    assert pair.radial_offset == pytest.approx(np.hypot(3e-4, 3e-4))
    assert pair.bend == pytest.approx(np.hypot(1e-4, 2e-4))
    reset = shaft_pair(first, second, as_set=(-pair.offset[0], -pair.offset[1]))
    assert reset.radial_offset == pytest.approx(0.0, abs=1e-18)


def test_recommended_deviation_of_axes() -> None:
    # F_beta 10 um, bearings 300 mm apart, face 20 mm: 75 um across over the bearings are 5 um over the face
    assert axis_tolerances(10e-6) == pytest.approx((10e-6, 75e-6 * 20.0 / 300.0))
