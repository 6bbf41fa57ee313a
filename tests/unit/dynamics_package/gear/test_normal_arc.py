"""Places along the fillet in the normal section from points of the transverse outline."""

import numpy as np
import pytest

from dynamics.gear.root_arc import normal_arc, root_arc
from dynamics.gear.tooth_form import ToothForm
from tests.builders.influence import drawn_gear


def fillet(gear, n=400):
    """Fillet of the transverse outline from the root circle up, and its length."""
    points = ToothForm(gear=gear).fillet(n)
    return points, np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])


@pytest.mark.parametrize(("helix", "within"), [(0.0, 0.2e-6), (16.26, 3e-6), (30.0, 12e-6)])
def test_agrees_with_the_virtual_spur_gear(helix, within):
    """At equal radius; the virtual spur gear of ISO 6336-3 is an approximation of the normal section."""
    gear = drawn_gear(18, module=6e-3, helix=helix)
    points, arc = fillet(gear)
    normal = root_arc(gear)
    radius = np.hypot(*points.T)
    inside = (radius > normal.radius[20]) & (radius < normal.radius[-1])
    found = normal_arc(gear, points, arc)[inside]
    assert np.abs(found - np.interp(radius[inside], normal.radius, normal.arc)).max() < within


def test_length_in_the_transverse_section_is_another():
    """From the 30 deg tangent to the root circle a helical fillet is shorter across its trace than in the section."""
    gear = drawn_gear(18, module=6e-3, helix=30.0)
    points, arc = fillet(gear)
    found = normal_arc(gear, points, arc)
    low = found < 0.0
    assert np.ptp(found[low]) < 0.97 * np.ptp(arc[low])
    assert np.all(np.diff(found) > 0.0)


def test_flat_strip_on_a_circle_shrinks_by_the_cosine_of_its_helix_angle():
    """Along a circle about the axis helix lines lie cos(beta_y) of their transverse distance apart."""
    gear = drawn_gear(18, module=6e-3, helix=20.0)
    angle = np.linspace(0.2, 0.0, 50)
    radius = 0.95 * gear.reference_radius
    points = radius * np.column_stack([np.sin(angle), np.cos(angle)])
    arc = radius * (angle[0] - angle)
    slant = np.arctan(np.tan(np.radians(20.0)) * 0.95)
    assert np.ptp(normal_arc(gear, points, arc)) == pytest.approx(np.cos(slant) * np.ptp(arc), rel=1e-6)
