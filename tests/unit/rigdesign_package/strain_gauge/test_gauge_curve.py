"""Stress at a gauge from the stress of the whole fillet: uniform field, gradients, place outside of the root."""

import numpy as np
import pytest

from dynamics.tooth.root_field import RootCourse
from rigdesign.base.errors import CaseError
from rigdesign.report.figures.teeth import strain_gauge_figure
from rigdesign.results.serialisation.teeth import gauge_stress_row
from rigdesign.results.teeth import GaugeStress
from rigdesign.strain_gauge.measuring_point import GaugePlacement, gauge_curve, grid_average
from tests.builders.strain_gauge import measuring_point

PLACES = np.linspace(-2.6e-3, 2.9e-3, 24)
FACE = np.linspace(-12.5e-3, 12.5e-3, 11)
PATH = np.linspace(-20e-3, 30e-3, 101)


def course(field):
    """Stress of a fillet by a field of path, place along the fillet and face position."""
    path, place, face = np.meshgrid(PATH, PLACES, FACE, indexing="ij")
    return RootCourse(path=PATH, face=FACE, stress=np.asarray(field(path, place, face), dtype=float))


def over_path(path):
    return 1e8 * np.exp(-(((path - 10e-3) / 8e-3) ** 2))


@pytest.mark.parametrize("z", [-8e-3, 0.0, 11.9e-3])
@pytest.mark.parametrize("s", [-1e-3, 0.0, 1e-3])
def test_uniform_field_reads_itself_anywhere(z, s):
    point = measuring_point(placement=GaugePlacement(face_position=z, fillet_position=s, misalignment=0.2))
    found = gauge_curve(course(lambda p, s, z: over_path(p) + 0.0 * s * z), PLACES, point, 20.0)
    assert found.stress == pytest.approx(over_path(PATH), rel=1e-12)
    assert found.peak == pytest.approx(1e8)
    assert found.peak_angle == pytest.approx(0.2)


def test_stress_that_changes_over_fillet_and_face_as_by_quadrature():
    """Spacing of standard influence numbers: 0.24 mm along the fillet, 2.5 mm over the face."""

    def field(s, z):
        return (1.0 - (s / 3e-3) ** 2) * np.exp(-(((z + 4e-3) / 9e-3) ** 2))

    for z in (-8e-3, -4e-3, 0.0, 4e-3, 8e-3):
        placed = GaugePlacement(face_position=z)
        point = measuring_point(placement=placed)
        found = gauge_curve(course(lambda p, s, z: over_path(p) * field(s, z)), PLACES, point, 20.0)
        exact = 1e8 * float(grid_average(field, point.bridge.gauge, placed))
        assert found.peak == pytest.approx(exact, abs=2e-4 * 1e8)  # lines between nodes: 1e-2


def test_a_wheel_rolls_the_other_way():
    found = gauge_curve(course(lambda p, s, z: over_path(p)), PLACES, measuring_point(), -20.0)
    assert np.all(np.diff(found.angle) > 0.0)
    assert found.peak_angle == pytest.approx(-0.2)


def test_fillet_that_ends_before_the_grid():
    with pytest.raises(CaseError, match=r"fillet positions .* do not cover the grid"):
        gauge_curve(course(lambda p, s, z: p), PLACES + 3e-3, measuring_point(), 20.0)


def test_gauge_beyond_the_face_is_refused_with_its_limit():
    with pytest.raises(CaseError, match=r"the face ends at 12.5 mm.*within \+-12 mm"):
        measuring_point(placement=GaugePlacement(face_position=-12.3e-3))


def test_record_has_the_output_of_the_bridge_at_the_peak():
    """Half bridge with a passive resistor: U/U_E = k eps / 4 to first order, eps = sigma / E."""
    point = measuring_point()
    curve = gauge_curve(course(lambda p, s, z: over_path(p)), PLACES, point, 20.0)
    found = GaugeStress(name="ii", gear="pinion", tooth=0, front=True, point=point, curve=curve)
    row = gauge_stress_row(found)
    strain = 1e8 / 206e9
    assert row["peak_MPa"] == pytest.approx(100.0)
    assert row["strain_um_m"] == pytest.approx(1e6 * strain)
    assert row["bridge"]["output_mV_V"] == pytest.approx(1e3 * 2.0 * strain / 4.0, rel=1e-3)
    assert row["bridge"]["output_mV"] == pytest.approx(5.0 * row["bridge"]["output_mV_V"])
    back = point.stress(found.output, zero=0.0)
    assert back == pytest.approx(curve.stress, abs=1e-3)


def test_picture_shows_every_gauge_where_it_is_strained():
    point = measuring_point()
    curve = gauge_curve(course(lambda p, s, z: over_path(p)), PLACES, point, 20.0)
    rows = [
        gauge_stress_row(GaugeStress(name=name, gear=gear, tooth=0, front=True, point=point, curve=curve))
        for name, gear in (("ii", "pinion"), ("near_end", "pinion"), ("i", "wheel"))
    ]
    figure = strain_gauge_figure({"stage": "test", "strain_gauges": rows})
    first, second = figure.axes
    assert [line.get_label() for line in first.get_lines()[:2]] == ["II, z = −5 mm", "near end, z = −5 mm"]
    assert len(second.get_lines()) == 2
    low, high = first.get_xlim()
    peak = float(np.degrees(curve.peak_angle))
    assert low < peak < high
    assert high - low < np.ptp(np.degrees(curve.angle))
