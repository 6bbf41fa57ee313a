"""Clearances of a small gearbox under temperature fields whose expansion is known by hand."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.builders.expansion import COLD, GAP, IRON, STEEL, geometry
from thermal.expansion.alignment import concentric_gap_change, free_expansion, length_mean
from thermal.expansion.elastic import ElasticError
from thermal.expansion.expansion import Expansion, ExpansionSetup, expand
from thermal.expansion.setup import Cylinder, CylinderSection
from thermal.housing.gearbox import build_gearbox
from thermal.housing.stations import GearboxModel


@pytest.fixture(scope="module")
def model() -> GearboxModel:
    return build_gearbox(geometry(), "quick")


@pytest.fixture(scope="module")
def materials(model: GearboxModel) -> dict[str, tuple[float, float, float]]:
    return {body: IRON if body in ("housing", "field") else STEEL for body in model.mesh.bodies}


@pytest.fixture(scope="module")
def setup(model: GearboxModel, materials) -> ExpansionSetup:
    return ExpansionSetup(model, materials)


def by_body(model: GearboxModel, housing: float, shafts: float) -> np.ndarray:
    """Nodal temperature [K]: one for housing and field, one for shafts and gears."""
    field = np.full(len(model.mesh.points), shafts)
    for body in ("housing", "field"):
        field[model.mesh.cells[model.mesh.bodies[body]]] = housing
    return field


def run(setup: ExpansionSetup, materials, temperature: np.ndarray) -> Expansion:
    return expand(setup, temperature, COLD, tolerance=1e-11)


def test_nothing_moves_when_nothing_is_heated(model, materials, setup) -> None:
    result = run(setup, materials, np.full(len(model.mesh.points), COLD))
    assert not result.displacement.any()
    assert result.iterations == 0
    assert [s.minimum for s in result.seals.values()] == [GAP] * 6


@pytest.fixture(scope="module")
def uniform(model, materials, setup) -> Expansion:
    """Housing 60 K, shafts 100 K above cold, each uniform."""
    return run(setup, materials, by_body(model, COLD + 60.0, COLD + 100.0))


HOUSING, SHAFT = IRON[2] * 60.0, STEEL[2] * 100.0


def test_uniform_heating_needs_no_support(uniform: Expansion) -> None:
    # a clamped housing would push with about E alpha dT A = 120e9 * 6.3e-4 * 0.36 m2 = 27 MN
    assert uniform.largest_reaction < 1e-2


def test_bearings_grow_with_their_bodies(model, uniform: Expansion) -> None:
    for station in model.bearings:
        growth = uniform.bearings[station.name]
        assert growth.bore_expansion == pytest.approx(HOUSING * (0.04 + 40e-6), rel=1e-6)
        assert growth.journal_expansion == pytest.approx(SHAFT * 0.04, rel=1e-6)
        assert growth.clearance_change == pytest.approx(growth.bore_expansion - growth.journal_expansion)
        assert growth.bore_ovality < 1e-10


def test_bores_move_away_from_the_middle_of_the_foot(model, uniform: Expansion) -> None:
    foot = model.mesh.surfaces[model.foot_surface]
    middle = model.mesh.points[np.unique(foot)].min(axis=0) + model.mesh.points[np.unique(foot)].max(axis=0)
    for station in model.bearings:
        expected = HOUSING * (np.array(station.centre) - 0.5 * middle)
        assert_allclose(uniform.bearings[station.name].bore_shift, expected, atol=1e-9)


def test_centre_distance_grows_with_the_housing_and_axes_stay_parallel(uniform: Expansion) -> None:
    (pair,) = uniform.centre_distances
    assert (pair.gear_a, pair.gear_b) == ("gear_pinion", "gear_wheel")
    assert pair.undeformed == pytest.approx(0.1)
    assert pair.change == pytest.approx(HOUSING * 0.1, rel=1e-6)
    assert pair.inclination == pytest.approx(0.0, abs=1e-9)
    assert pair.skew == pytest.approx(0.0, abs=1e-9)


def test_seal_gaps_follow_the_concentric_closed_form(model, uniform: Expansion) -> None:
    for station in model.seals:
        seal = uniform.seals[station.name]
        radius = 0.5 * station.shaft_diameter
        expected = GAP + HOUSING * (radius + GAP) - SHAFT * radius
        assert seal.gaps == pytest.approx(expected, abs=1e-9)
        assert seal.minimum == pytest.approx(expected, abs=1e-9)
        # the closed form of the sheet takes one radius for both sides
        assert seal.gap_by_hand == pytest.approx(expected - HOUSING * GAP, abs=1e-10)


def test_shafts_grow_from_their_locating_bearing(model, uniform: Expansion) -> None:
    for station in model.shafts:
        rear = next(b for b in model.bearings if b.shaft == station.name and b.locating)
        front = next(b for b in model.bearings if b.shaft == station.name and not b.locating)
        shaft = uniform.shafts[station.name]
        assert shaft.start == pytest.approx(SHAFT * (rear.centre[0] - station.start), rel=1e-5)
        assert shaft.end == pytest.approx(SHAFT * (station.end - rear.centre[0]), rel=1e-5)
        assert shaft.start_by_hand == pytest.approx(shaft.start, rel=1e-5)
        assert shaft.end_by_hand == pytest.approx(shaft.end, rel=1e-5)
        span = rear.centre[0] - front.centre[0]
        assert shaft.axial_play_change == pytest.approx((SHAFT - HOUSING) * span, rel=1e-5)
        seal = uniform.seals[f"{station.name}_front"]
        place = next(s for s in model.seals if s.name == seal.name).centre[0]
        assert seal.axial_shift == pytest.approx((SHAFT - HOUSING) * (place - rear.centre[0]), rel=1e-5)


def test_gears_report_bulk_temperature_and_rim(uniform: Expansion) -> None:
    for gear in uniform.gears.values():
        assert gear.bulk_temperature == pytest.approx(COLD + 100.0)
        assert gear.rim_expansion == pytest.approx(SHAFT * 0.0495, rel=1e-6)


def test_linear_temperatures_of_the_housing_move_the_axes_as_by_hand(model, materials, setup) -> None:
    # dT = g z: no stress, so lengths in the plane of the axes grow with its local temperature
    slope = 200.0
    field = by_body(model, COLD, COLD)
    housing = field == COLD
    for body in ("shaft_pinion", "gear_pinion", "shaft_wheel", "gear_wheel"):
        housing[model.mesh.cells[model.mesh.bodies[body]]] = False
    x, _, z = model.mesh.points.T
    field[housing] += slope * (z - z[housing].min())[housing]
    result = run(setup, materials, field)
    floor = z[housing].min()
    (pair,) = result.centre_distances
    centre = model.bearings[0].centre[2] - floor
    assert pair.change == pytest.approx(0.1 * IRON[2] * slope * centre, rel=1e-4)
    field = np.where(housing, COLD + slope * (x - x[housing].mean()), COLD)
    result = run(setup, materials, field)
    (pair,) = result.centre_distances
    # dT = g x: lateral strain alpha g x, so the axes open by alpha g a per metre along x
    assert pair.inclination == pytest.approx(IRON[2] * slope * 0.1, rel=5e-4)
    assert pair.skew == pytest.approx(0.0, abs=1e-7)


def test_shaft_axis_passes_through_the_hot_bores(model, materials, setup) -> None:
    x, y, z = model.mesh.points.T
    field = COLD + 40.0 + 60.0 * np.sin(9.0 * x) + 80.0 * z - 30.0 * np.cos(7.0 * y)
    result = run(setup, materials, field)
    for station in model.bearings:
        surface = setup.elements.surfaces[station.journal_surface]
        strain = setup.elastic.free_strain(field, COLD)
        cylinder = Cylinder.of(surface, model.mesh.points, station.centre)
        journal = cylinder.motion(result.displacement, strain)
        bore = result.bearings[station.name].bore_shift
        assert journal.shift[1:] == pytest.approx(bore[1:], abs=5e-8)
        if station.locating:
            assert journal.shift[0] == pytest.approx(bore[0], abs=1e-9)
            assert journal.turn == pytest.approx(0.0, abs=1e-9)
    for seal in result.seals.values():
        assert seal.minimum <= seal.gap.min() <= seal.mean
        at = np.argmin(np.abs(seal.angles - seal.angle_of_minimum))
        assert seal.gaps[:, at].min() == seal.minimum


def test_seal_gap_sees_the_side_of_an_eccentric_bore(model, materials, setup, uniform: Expansion) -> None:
    # the partition hotter than the end walls: its bores rise above the axes of the bearings
    field = by_body(model, COLD + 40.0, COLD + 40.0)
    x = model.mesh.points[:, 0]
    stations = sorted(s.centre[0] for s in model.seals)
    warm = (x > stations[0] - 0.01) & (x < stations[-1] + 0.01)
    housing = np.unique(model.mesh.cells[model.mesh.bodies["housing"]])
    field[housing] += 40.0 * warm[housing]
    seal = run(setup, materials, field).seals["pinion_front"]
    # smallest at the bottom, 270 degrees from +y towards +z
    assert seal.angle_of_minimum == pytest.approx(1.5 * np.pi, abs=0.3)
    assert seal.mean - seal.minimum > 5e-6


def test_setup_reuse_gives_the_same_bits(model, materials, setup) -> None:
    field = by_body(model, COLD + 60.0, COLD + 100.0)
    kept = field.copy()
    fresh = expand(ExpansionSetup(model, materials), field, COLD)
    again = expand(setup, field, COLD)
    assert fresh.displacement.tobytes() == again.displacement.tobytes()
    assert field.tobytes() == kept.tobytes()


def test_interpolated_displacement_is_exact_for_rigid_motion_and_swelling(model, setup) -> None:
    station = model.bearings[0]
    points = model.mesh.points
    angles = np.linspace(0.0, 2.0 * np.pi, 50, endpoint=False)
    moved = np.array([3e-6, -2e-6, 5e-6]) + 1e-3 * (points - np.array(station.centre))
    strain = np.full(len(points), 1e-3)
    surface = setup.elements.surfaces[station.bore_surface]
    section = CylinderSection.of(surface, points, station.centre, angles, station.centre[0])
    radial = section.radial(moved, strain)
    expected = -2e-6 * np.cos(angles) + 5e-6 * np.sin(angles) + 1e-3 * (0.02 + 20e-6)
    assert_allclose(radial, expected, atol=2e-8)
    fit = Cylinder.of(surface, points, station.centre).motion(moved, strain)
    assert fit.shift == pytest.approx((3e-6, -2e-6, 5e-6), abs=1e-8)
    assert fit.radius_expansion == pytest.approx(1e-3 * (0.02 + 20e-6), rel=1e-5)


def test_closed_forms_have_the_values_of_the_sheet() -> None:
    # R = 38 mm, shaft 60 K hotter: -26 um; R = 60 mm, 79 K: -54 um; 0.53 mm of shaft: L (Tm - 20) = 46.1 m K
    for radius, hotter, change in ((0.038, 60.0, -26e-6), (0.060, 79.0, -54e-6)):
        gap = concentric_gap_change(radius, (11.5e-6, 293.15), (11.5e-6, 293.15 + hotter), 293.15)
        assert gap == pytest.approx(change, abs=0.6e-6)
    assert free_expansion(11.5e-6, 1.0, 293.15 + 46.1, 293.15) == pytest.approx(0.53e-3, rel=1e-3)


def test_length_mean_counts_sections_not_volume(model, setup) -> None:
    start, end = model.shafts[0].start, model.shafts[0].end
    linear = 300.0 + 100.0 * model.mesh.points[:, 0]
    mean = length_mean(setup.elements, linear, "shaft_pinion", end, start)
    assert mean == pytest.approx(300.0 + 50.0 * (start + end), rel=1e-4)


def spoiled(model: GearboxModel, kind: str) -> GearboxModel:
    bearing, shaft = model.bearings[0], model.shafts[0]
    match kind:
        case "no locating bearing":
            return replace(model, bearings=tuple(replace(b, locating=False) for b in model.bearings))
        case "unknown surface":
            return replace(model, bearings=(replace(bearing, bore_surface="bore"), *model.bearings[1:]))
        case "unknown shaft":
            return replace(model, bearings=(replace(bearing, shaft="third"), *model.bearings[1:]))
        case "unknown body":
            return replace(model, shafts=(replace(shaft, body="axle"), *model.shafts[1:]))
    return replace(model, shafts=model.shafts[:1], bearings=model.bearings[:2], seals=(), gears=())


@pytest.mark.parametrize(
    ("kind", "message"),
    [
        ("no locating bearing", "shaft 'pinion' has 0 locating bearings"),
        ("unknown surface", "a station names surface 'bore'"),
        ("unknown shaft", "station 'pinion_front' names shaft 'third'"),
        ("unknown body", "a station names body 'axle'"),
        ("a shaft without station", "body 'shaft_wheel' shares no nodes"),
    ],
)
def test_bad_stations_are_refused(model, materials, kind: str, message: str) -> None:
    with pytest.raises(ElasticError, match=message):
        ExpansionSetup(spoiled(model, kind), materials)


def test_bad_fields_are_refused(model, materials, setup) -> None:
    with pytest.raises(ElasticError, match="need one finite value per node"):
        expand(setup, np.full(3, 300.0), COLD)
    with pytest.raises(ElasticError, match="need one finite value per node"):
        expand(setup, np.full(len(model.mesh.points), np.nan), COLD)
