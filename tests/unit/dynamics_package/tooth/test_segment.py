"""Gear segment in space: volume, no folded brick, the web over its own width only."""

import numpy as np
import pytest

from dynamics.errors import DynamicsInputError
from dynamics.tooth.influence_numbers import GearBody
from dynamics.tooth.segment import GearSegment, gear_section
from tests.builders.influence import COARSE, small_model
from tests.unit.dynamics_package.tooth.test_section import area
from thermal.fe.reference_elements import HEXAHEDRON_20

WIDTH = 20e-3


def volumes(segment):
    """Least determinant of the Jacobian and volume of all bricks [m3]."""
    at, weight = np.polynomial.legendre.leggauss(4)
    at, weight = 0.5 * (at + 1.0), 0.5 * weight
    places = np.array([[x, y, z] for x in at for y in at for z in at])
    weights = np.einsum("i,j,k->ijk", weight, weight, weight).ravel()
    gradients = HEXAHEDRON_20.gradients(places)
    jacobian = np.linalg.det(np.einsum("nka,qkb->nqab", segment.points[segment.cells], gradients))
    return float(jacobian.min()), float((jacobian @ weights).sum())


@pytest.fixture(scope="module")
def section():
    model = small_model()
    return gear_section(model.form, model.body, COARSE)


@pytest.mark.parametrize("lead", [0.0, 5.0, -5.0])
def test_volume_is_area_times_width(section, lead):
    segment = GearSegment.of(section, np.linspace(-0.5, 0.5, 5) * WIDTH, lead)
    least, volume = volumes(segment)
    assert least > 0.0
    assert volume == pytest.approx(area(section.points, section.cells) * WIDTH, rel=1e-5 if lead else 1e-9)
    assert len(np.unique(segment.cells)) == len(segment.points)


def test_helical_segment_turns_clockwise_towards_positive_z(section):
    lead, heights = 5.0, np.array([-0.01, 0.01])
    segment = GearSegment.of(section, heights, lead)
    top = section.axes[0][-1]
    for plane, z in enumerate(heights):
        x, y, height = segment.points[segment.planes[plane, top]]
        assert np.arctan2(x, y) == pytest.approx(lead * z, abs=1e-12)
        assert height == z


def test_bore_nodes_are_those_on_the_bore(section):
    segment = GearSegment.of(section, np.linspace(-0.5, 0.5, 3) * WIDTH, 4.0)
    radii = np.hypot(segment.points[:, 0], segment.points[:, 1])
    assert np.array_equal(segment.bore, np.flatnonzero(radii < 15e-3 * (1.0 + 1e-9)))


def test_web_drops_cells_at_both_ends():
    model = small_model(body=GearBody(bore_radius=15e-3, rim_thickness=8e-3, web_thickness=9e-3))
    section = gear_section(model.form, model.body, COARSE)
    heights = np.linspace(-0.5, 0.5, 9) * WIDTH
    whole = GearSegment.of(section, heights)
    with_web = GearSegment.of(section, heights, body=model.body)
    # of eight layers of 2.5 mm the middle four lie within 9 mm, counted by their middles
    assert len(whole.cells) - len(with_web.cells) == 4 * len(section.web)
    web = area(section.points, section.cells[section.web])
    assert volumes(with_web)[1] == pytest.approx(volumes(whole)[1] - 4 * 2.5e-3 * web, rel=1e-9)
    assert np.abs(with_web.points[with_web.bore, 2]).max() == pytest.approx(5e-3)
    assert len(np.unique(with_web.cells)) == len(with_web.points)


def test_layers_at_planes_and_between(section):
    segment = GearSegment.of(section, np.array([-10e-3, -5e-3, 10e-3]))
    assert segment.layers_at(-10e-3) == [(0, 0.0)]
    assert segment.layers_at(-5e-3) == [(0, 1.0), (1, 0.0)]
    ((layer, across),) = segment.layers_at(1e-3)
    assert (layer, across) == (1, pytest.approx(0.4))
    assert segment.layers_at(11e-3) == []


def test_bad_input_is_named(section):
    for heights in (np.array([0.0]), np.array([1e-3, 0.0]), np.array([0.0, 0.0])):
        with pytest.raises(DynamicsInputError, match=r"heights = .* at least two growing"):
            GearSegment.of(section, heights)
    body = GearBody(bore_radius=15e-3, rim_thickness=8e-3, web_thickness=1e-3)
    with pytest.raises(
        DynamicsInputError, match=r"web_thickness = 1\.000 mm .* 5\.000 mm; divide the face finer"
    ):
        GearSegment.of(section, np.linspace(-0.5, 0.5, 5) * WIDTH, body=body)
