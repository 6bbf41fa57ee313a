"""Places along the root fillet: the 30 deg tangent of ISO 6336-3, root circle and form circle."""

from math import degrees, isnan, radians

import numpy as np
import pytest

from dynamics.gear.pair import GearPair
from dynamics.gear.root_arc import POINTS, TANGENT_30, root_arc, tooth_outline
from tests.builders.loaded_mesh import fzg_c

HELICAL = GearPair.from_centre_distance(
    normal_module=6e-3, teeth=(18, 18), centre_distance=112.5e-3, face_widths=(25e-3, 25e-3), profile_shift_1=0.0,
    helix_angle=radians(16.26),
)  # fmt: skip


@pytest.mark.parametrize("pair", [fzg_c(), HELICAL])
def test_arc_zero_is_the_critical_section_of_iso_6336_3(pair: GearPair) -> None:
    gear = pair.gears[0]
    places, outline = root_arc(gear), tooth_outline(gear, n_fillet=POINTS)
    x, y = (values[: outline.n_fillet] for values in (outline.x, outline.y))
    assert 2.0 * np.interp(0.0, places.arc, x) == pytest.approx(outline.root_chord, rel=1e-6)
    assert np.interp(0.0, places.arc, y) == pytest.approx(outline.root_height, rel=1e-6)
    assert places.at_tangent(TANGENT_30) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("pair", [fzg_c(), HELICAL])
def test_fillet_reaches_from_root_to_form_circle_with_a_falling_tangent(pair: GearPair) -> None:
    gear = pair.gears[0]
    places = root_arc(gear)
    assert places.radius[0] == pytest.approx(gear.root_radius, rel=1e-9)
    assert places.radius[-1] == pytest.approx(gear.form_radius, rel=2e-4)
    assert np.all(np.diff(places.arc) > 0.0) and np.all(np.diff(places.tangent) <= 0.0)
    assert degrees(places.tangent[0]) > 70.0 and degrees(places.tangent[-1]) < 5.0


def test_places_off_the_fillet_are_not_found() -> None:
    places = root_arc(HELICAL.gears[0])
    assert isnan(places.at_tangent(radians(89.0)))
    assert isnan(places.at_radius(HELICAL.gears[0].tip_radius))
