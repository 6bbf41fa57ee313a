"""Stiffness of rolling bearings in five directions: derivatives, closed forms, an explicit sum in space, pairs."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from dynamics.rotor.rolling_catalogue import catalogue_bearing, tabled_designations
from dynamics.rotor.rolling_row import LAMINAE, RowOfElements, contact_law, ring_load
from dynamics.rotor.rolling_stiffness import bearing_stiffness, stiffness_at

LOADS = [
    ("6208", 2000.0, 800.0),
    ("7208 B", 2000.0, 4000.0),
    ("30208", 2000.0, 2000.0),
    ("NU 208", 2000.0, 0.0),
]


def row(designation: str, clearance: float = 0.0) -> RowOfElements:
    elements = catalogue_bearing(designation).elements
    return RowOfElements(elements=elements, law=contact_law(elements), clearance=clearance)


def stiffness_matrix(
    bearing: RowOfElements, radial: float, axial: float, azimuth: float = 0.0
) -> NDArray[np.float64]:
    """Tangent stiffness (5, 5) at a load that presses the row in its direction, untilted."""
    return stiffness_at(bearing, bearing_stiffness(replace(bearing, direction=1), radial, axial), azimuth)


def pressed(designation: str, radial: float, axial: float) -> NDArray[np.float64]:
    """Displacement at a load, untilted."""
    found = bearing_stiffness(row(designation), radial, axial)
    return np.array([found.radial_displacement, 0.0, found.axial_displacement, 0.0, 0.0])


@pytest.mark.parametrize(("designation", "radial", "axial"), LOADS)
def test_untilted_it_is_the_load_distribution_of_the_bearing(
    designation: str, radial: float, axial: float
) -> None:
    found = bearing_stiffness(row(designation), radial, axial)
    at = ring_load((row(designation),), pressed(designation, radial, axial))
    matrix = stiffness_matrix(row(designation), radial, axial)
    assert at.load[[0, 2]] == pytest.approx([radial, axial], rel=1e-6, abs=1e-3)
    assert at.load[[1, 3]] == pytest.approx(0.0, abs=1e-6 * radial)
    assert matrix[0, 0] == pytest.approx(found.radial, rel=1e-9)
    assert matrix[1, 1] == pytest.approx(found.lateral, rel=1e-9)
    assert matrix[2, 2] == pytest.approx(found.axial, rel=1e-9)
    assert matrix[0, 2] == pytest.approx(found.coupling, rel=1e-9)
    assert (matrix[4, 4], matrix[3, 3]) == pytest.approx((found.tilting, found.tilting_lateral), rel=1e-9)


@pytest.mark.parametrize(("designation", "radial", "axial"), LOADS)
def test_stiffness_is_the_derivative_of_the_load_in_every_direction(
    designation: str, radial: float, axial: float
) -> None:
    bearing = row(designation)
    tilt = np.array([0.0, 1e-6, 0.0, 1.5e-4, -2e-4])
    place = pressed(designation, radial, axial) + tilt
    steps = np.array([1e-9, 1e-9, 1e-9, 1e-8, 1e-8])
    columns = []
    for index, step in enumerate(steps):
        ahead, behind = (place + sign * step * np.eye(5)[index] for sign in (1.0, -1.0))
        columns.append(
            (ring_load((bearing,), ahead).load - ring_load((bearing,), behind).load) / (2.0 * step)
        )
    stiffness = ring_load((bearing,), place).stiffness
    scale = np.sqrt(np.outer(np.diag(stiffness), np.diag(stiffness))) + 1e-3
    assert np.abs((np.array(columns).T - stiffness) / scale).max() < 1e-4


def test_stiffness_of_every_tabled_bearing_is_symmetric_and_takes_no_energy_out() -> None:
    for designation in tabled_designations():
        data = catalogue_bearing(designation)
        load = 0.05 * data.dynamic_rating
        axial = 0.0 if data.kind == "cylindrical_roller" else 0.5 * load
        for clearance in (-5e-6, 0.0, 20e-6):
            matrix = stiffness_matrix(row(designation, clearance), load, axial)
            size = np.sqrt(np.diag(matrix))
            assert np.array_equal(matrix, matrix.T)
            scaled = matrix / np.outer(size + 1e-30, size + 1e-30)
            assert np.linalg.eigvalsh(scaled).min() > -1e-9, designation
            assert matrix[3, 3] > 0.0 and matrix[4, 4] > 0.0, designation


def test_a_deep_groove_ball_bearing_tilts_on_its_ring_of_springs() -> None:
    """Under thrust Z equal springs k_a stand on the radius of the grooves: Z k_a R^2 / 2."""
    bearing = row("6208")
    matrix = stiffness_matrix(bearing, 0.0, 3000.0)
    radius = 0.5 * bearing.elements.pitch_diameter + 0.02 * bearing.elements.diameter
    assert matrix[3, 3] == pytest.approx(0.5 * matrix[2, 2] * radius**2, rel=1e-9)
    assert matrix[4, 4] == pytest.approx(matrix[3, 3], rel=1e-9)


def test_a_deep_groove_ball_bearing_hardly_resists_tilting() -> None:
    """Under radial load its balls turn on the grooves, springs Q / A over the distance A of the groove centres; free
    to move axially, the ring tilts about its loaded zone: a tenth of what a roller bearing of its size resists."""
    ball, roller = (stiffness_matrix(row(name), 3000.0, 0.0) for name in ("6208", "NU 208"))
    free = ball[4, 4] - ball[2, 4] ** 2 / ball[2, 2]
    assert free < 0.1 * roller[4, 4]
    bearing = row("6208")
    radius = 0.5 * bearing.elements.pitch_diameter + 0.02 * bearing.elements.diameter
    found = bearing_stiffness(bearing, 3000.0, 0.0)
    azimuth = 2.0 * math.pi / bearing.elements.count * np.arange(bearing.elements.count)
    approach = np.maximum(found.radial_displacement * np.cos(azimuth), 0.0)
    load = bearing.law.stiffness * approach**1.5
    by_hand = np.sum(load / (bearing.law.groove_distance + approach) * (radius * np.cos(azimuth)) ** 2)
    assert ball[4, 4] == pytest.approx(by_hand, rel=1e-6)


def test_cylindrical_rollers_tilt_along_their_length() -> None:
    """Springs spread evenly over L: k_r L^2 / 12, less the (1 / n)^2 of n laminae."""
    bearing = row("NU 208")
    matrix = stiffness_matrix(bearing, 4000.0, 0.0)
    share = bearing.elements.length**2 / 12.0 * (1.0 - 1.0 / LAMINAE**2)
    assert matrix[4, 4] == pytest.approx(matrix[0, 0] * share, rel=1e-9)
    assert matrix[3, 3] == pytest.approx(matrix[1, 1] * share, rel=1e-9)
    assert not matrix[2].any()


def in_space(bearing: RowOfElements, place: NDArray[np.float64]) -> NDArray[np.float64]:
    """Load of a ball bearing from groove centres as points in space, its inner ring turned by a rotation matrix."""
    elements, law = bearing.elements, bearing.law
    turn = np.array(
        [[1.0, 0.0, place[4]], [0.0, 1.0, -place[3]], [-place[4], place[3], 1.0]]
    )  # of small angles
    total = np.zeros(5)
    for index in range(elements.count):
        phi = 2.0 * math.pi * index / elements.count
        outwards, axis = np.array([math.cos(phi), math.sin(phi), 0.0]), np.array([0.0, 0.0, 1.0])
        normal = math.cos(elements.contact_angle) * outwards + math.sin(elements.contact_angle) * axis
        ball = 0.5 * elements.pitch_diameter * outwards
        inner = ball + law.inner_groove_offset * normal
        outer = inner - law.groove_distance * normal
        moved = turn @ inner + np.array([*place[:3]])
        span = moved - outer
        span -= (span @ np.cross(axis, outwards)) * np.cross(
            axis, outwards
        )  # balls do not follow round the ring
        stretch = float(np.linalg.norm(span))
        force = law.stiffness * max(stretch - law.groove_distance, 0.0) ** 1.5 * span / stretch
        total[:3] += force
        total[3:] += np.cross(inner, force)[:2]
    return total


@pytest.mark.parametrize("designation", ["6208", "7208 B"])
def test_tilted_ball_bearing_against_a_sum_in_space(designation: str) -> None:
    place = pressed(designation, 2000.0, 2500.0) + np.array([0.0, 2e-6, 0.0, 3e-4, -5e-4])
    found = ring_load((row(designation),), place).load
    assert found == pytest.approx(in_space(row(designation), place), rel=1e-6)


def test_tilted_rollers_against_laminae_written_out() -> None:
    """A tilt by psi presses lamina x of the top roller by x psi more: sum of 2 c / n delta^(10/9) by hand."""
    bearing = row("NU 208")
    elements, law = bearing.elements, bearing.law
    depth, tilt = 12e-6, 8e-4
    force = moment = 0.0
    for index in range(elements.count):
        cosine = math.cos(2.0 * math.pi * index / elements.count)
        for lamina in range(LAMINAE):
            x = elements.length * ((lamina + 0.5) / LAMINAE - 0.5)
            load = law.stiffness / LAMINAE * max((depth + x * tilt) * cosine, 0.0) ** law.exponent
            force += load * cosine
            moment += load * cosine * x
    found = ring_load((bearing,), np.array([depth, 0.0, 0.0, 0.0, tilt])).load
    assert found[[0, 4]] == pytest.approx([force, moment], rel=1e-9)
    assert moment > 0.0


@pytest.mark.parametrize("designation", ["7208 B", "30208"])
def test_a_pair_tilts_on_the_distance_of_its_pressure_centres(designation: str) -> None:
    """Preloaded, at distance l: k_r (a / 2)^2 of either row, a = l + 2 R tan(alpha) back to back, l - 2 R tan(alpha)
    face to face; besides the rows' own turning about their pressure centres, which the two arrangements share."""
    single, distance = row(designation), 0.06
    offset = bearing_stiffness(single, 0.0, 2000.0).axial_displacement
    pairs = {
        sign: tuple(
            replace(
                single, axial_offset=offset, direction=direction, position=-sign * direction * distance / 2.0
            )
            for direction in (1, -1)
        )
        for sign in (1.0, -1.0)
    }
    back, face = (ring_load(pairs[sign], np.zeros(5)).stiffness for sign in (1.0, -1.0))
    assert back[:3, :3] == pytest.approx(face[:3, :3], rel=1e-9)
    reach = single.elements.pitch_diameter * math.tan(single.elements.contact_angle)
    by_hand = [0.5 * back[0, 0] * 0.5 * (distance + sign * reach) ** 2 for sign in (1.0, -1.0)]
    assert back[4, 4] - face[4, 4] == pytest.approx(by_hand[0] - by_hand[1], rel=0.05)
    assert back[4, 4] == pytest.approx(by_hand[0], rel=0.08)


def test_two_rows_of_cylindrical_rollers_tilt_on_their_distance() -> None:
    """k_r l^2 / 4 of both together, and k_r L^2 / 12 of their own; preloaded radially, so that all rollers carry."""
    single, distance = row("NU 208", -10e-6), 0.05
    rows = tuple(replace(single, position=place) for place in (-distance / 2.0, distance / 2.0))
    matrix = ring_load(rows, np.zeros(5)).stiffness
    own = single.elements.length**2 / 12.0 * (1.0 - 1.0 / LAMINAE**2)
    assert matrix[4, 4] == pytest.approx(matrix[0, 0] * (distance**2 / 4.0 + own), rel=1e-9)


def test_a_load_that_turns_turns_the_matrix() -> None:
    """A quarter turn puts the stiffness of x to y, and the coupling of x and ry to y and minus rx."""
    bearing = row("30208")
    here, there = (stiffness_matrix(bearing, 2000.0, 2000.0, azimuth) for azimuth in (0.0, math.pi / 2.0))
    assert np.diag(there) == pytest.approx(np.diag(here)[[1, 0, 2, 4, 3]], rel=1e-9)
    assert (there[1, 2], there[1, 3]) == pytest.approx((here[0, 2], -here[0, 4]), rel=1e-9)
    other = stiffness_matrix(replace(bearing, direction=-1), 2000.0, 2000.0)
    assert other[0, 2] == pytest.approx(-here[0, 2], rel=1e-9)
    assert np.diag(other) == pytest.approx(np.diag(here), rel=1e-9)
