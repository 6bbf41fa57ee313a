"""Films and sources of the shipped housing as the case states them, without solving a field."""

from pathlib import Path

import pytest

from rigdesign import load_case
from rigdesign.base.errors import CaseError
from rigdesign.case import Case
from rigdesign.coupling.bearing_loads import solve_bearings
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.located_loss import PlacedLoss, PointLosses
from rigdesign.coupling.losses import rotating_losses
from rigdesign.coupling.mesh_models import mesh_models
from rigdesign.coupling.oil import oil_streams
from rigdesign.coupling.temperatures import boundary_conditions
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.model import build_rig
from tests.builders.paths import CASES
from thermal.conditions.boundary import Exchange, Film, SurfaceSource
from thermal.films.law import FilmCoefficient
from thermal.housing.stations import seal_stations

PROTOTYPE = CASES / "uhcf_prototype"
BOUNDARY = "gearboxes.test.housing.boundary"
WALL, FLUID = 440.0, 408.15


@pytest.fixture(scope="module")
def case() -> Case:
    return load_case(PROTOTYPE)


def films(case: Case) -> dict[str, FilmCoefficient]:
    """Coefficient of every film and exchange at one wall and fluid temperature."""
    conditions, _ = conditions_of(case)
    return {
        c.surface_a if isinstance(c, Exchange) else c.surface: c.law(WALL, FLUID)
        for c in conditions
        if isinstance(c, Film | Exchange)
    }


def conditions_of(case: Case) -> tuple[list[object], list[PlacedLoss]]:
    rig = build_rig(case, "quick")
    point = held_points(rig)[0]
    coupling_state = initial_state(rig, point)
    bearings = solve_bearings(rig, point, coupling_state)
    losses = rotating_losses(rig, point, coupling_state, mesh_models(rig, point, coupling_state), bearings)
    heated = PointLosses(point=point, coupling_state=coupling_state, bearings=bearings, losses=tuple(losses))
    return list(boundary_conditions(rig, "test", heated, radiation_included=True)), losses


def test_rotating_films_take_air_at_the_film_temperature(case: Case) -> None:
    found = films(case)
    assert found["gear_test_pinion_side_front"].formula == "rotating_disc"
    assert found["shaft_test_pinion_warm"].formula == "rotating_cylinder_becker"
    assert found["shaft_test_pinion_seal_front"].formula == "narrow_gap_taylor"
    assert not any(film.warnings for name, film in found.items() if "gear_" in name)


def test_room_air_constants_are_a_choice_that_warns(case: Case) -> None:
    with pytest.raises(CaseError, match='"jungnickel": is not used: medium = "mist"'):
        case.with_value(f"{BOUNDARY}.gear_sides.correlation", "jungnickel")
    in_air = case.with_value(f"{BOUNDARY}.gear_sides.medium", "air")
    chosen = in_air.with_value(f"{BOUNDARY}.gear_sides.correlation", "jungnickel")
    film = films(chosen)["gear_test_pinion_side_front"]
    assert film.formula == "rotating_disc_jungnickel"
    assert "film temperature" in film.warnings[0]


def test_gear_sides_turn_in_the_mist_of_the_windage(case: Case) -> None:
    dry = case.with_value(f"{BOUNDARY}.gear_sides.medium", "air")
    name = "gear_test_pinion_side_front"
    mist, air = films(case)[name], films(dry)[name]
    assert mist.inputs["density"] == case.losses.chamber_density == 5.0
    assert air.inputs["density"] < 0.9
    assert 3.5 * air.value < mist.value < 6.0 * air.value


def test_the_seal_gap_is_stated_once(case: Case) -> None:
    """A study of the gap reaches the film: Becker and Kaye with a smaller gap."""
    name = "shaft_test_pinion_seal_front"
    narrow = case.with_value("gearboxes.test.seals.pinion.radial_gap", "0.3 mm")
    assert films(case)[name].inputs["gap"] == pytest.approx(0.6e-3)
    assert films(narrow)[name].inputs["gap"] == pytest.approx(0.3e-3)
    with pytest.raises(CaseError, match=r"is not the radial gap of the seals of test_wheel, 0\.6 mm"):
        case.with_value(f"{BOUNDARY}.shaft_seal.gap", "0.5 mm")
    with pytest.raises(CaseError, match="is not the height of the housing, 280 mm"):
        case.with_value(f"{BOUNDARY}.housing_air.height", "400 mm")


def test_a_given_film_says_where_the_case_has_it_from(case: Case, tmp_path: Path) -> None:
    file = tmp_path / "case.toml"
    file.write_text(
        f'extends = "{(PROTOTYPE / "case.toml").as_posix()}"\n'
        f"[{BOUNDARY}.chamber_oil]\n"
        'heat_transfer_coefficient = { value = "900 W/(m2 K)", measured = "heat flux foil, run 12" }\n'
        f"[{BOUNDARY}.chamber_sump]\n"
        'heat_transfer_coefficient = "200 W/(m2 K)"\n'
    )
    measured = films(load_case(file))
    wall = measured["chamber_wall"]
    assert (wall.formula, wall.source) == ("constant", "measured: heat flux foil, run 12")
    assert "100 to 600" in wall.warnings[0]
    assert measured["chamber_floor"].source == "input of the case"
    printed = films(case)["chamber_wall"]
    assert printed.source == "assumed: as the main rig; P2, Figure 11"
    assert printed.warnings == ()


LIP = 7.69e-6 * 40.0**2
"""ISO/TR 14179-2: power of a lip on the 40 mm outside diameter per speed [W/(1/min)]."""


def test_seals_heat_their_own_places(case: Case) -> None:
    """Where the shaft leaves, a lip each: into its own bore and the oil of the bearings; gaps in the partitions."""
    lips = case.with_value("gearboxes.test.seals.pinion.kind", "radial_lip")
    conditions, losses = conditions_of(lips)
    (seal,) = (p for p in losses if p.name == "test.pinion" and p.loss.kind == "seal")
    heat = {c.surface: c.power for c in conditions if isinstance(c, SurfaceSource) and c.kind == "seal_loss"}
    own = {name: power for name, power in heat.items() if "pinion" in name}
    places = ("front", "rear", "front_end", "rear_end")
    assert set(own) == {
        f"{s}_{p}" for s in ("shaft_test_pinion_seal", "seal_bore_test_pinion") for p in places
    }
    # 25 % of each loss into either body, at 12,000 rpm; a gap loses a hundredth of a lip
    assert 0.0 < own["seal_bore_test_pinion_front"] < 0.01 * LIP * 12000
    assert own["seal_bore_test_pinion_rear_end"] == pytest.approx(0.25 * LIP * 12000, rel=1e-3)
    assert sum(own.values()) == pytest.approx(seal.into_body, rel=1e-12)
    assert seal.into_bearing_oil == pytest.approx(2 * 0.5 * LIP * 12000, rel=1e-3)


@pytest.mark.parametrize(
    ("shaft", "exits"),
    [("test.pinion", 2), ("test.wheel", 1), ("reference.pinion", 1), ("reference.wheel", 2)],
)
def test_a_shaft_has_one_lip_where_it_leaves_the_gearbox(case: Case, shaft: str, exits: int) -> None:
    """With a housing by its overhangs; without one towards couplings and motor (reference gearbox).

    Partitions have gaps: their 0.6 mm lose about a watt together.
    """
    box, name = shaft.split(".")
    lips = case.with_value(f"gearboxes.{box}.seals.{name}.kind", "radial_lip")
    _, losses = conditions_of(lips)
    (seal,) = (p for p in losses if p.name == shaft and p.loss.kind == "seal")
    speed = 12000.0 * (1.0 if name == "pinion" else 99 / 102)
    gaps = 0.0 if box == "reference" else 12.0
    assert seal.loss.power == pytest.approx(exits * LIP * speed, rel=1e-3, abs=gaps)
    assert seal.loss.details["seals"] == exits + (2 if box == "test" else 0)
    # of a gearbox without walls all of it ends in the oil of the bearings
    if box == "reference":
        assert seal.into_bearing_oil == pytest.approx(seal.loss.power, rel=1e-12)


def test_a_film_of_an_end_seal_has_the_outside_diameter(case: Case) -> None:
    """Its bore and its loss have it too: 40 mm for the 57.54 mm of the partition seals."""
    found = films(case)
    end, inner = (found[f"shaft_test_wheel_seal_{place}"] for place in ("rear_end", "rear"))
    stations = {s.name: s.shaft_diameter for s in seal_stations(build_rig(case, "quick").geometries["test"])}
    assert (
        2.0 * end.inputs["radius"] == pytest.approx(stations["test_wheel_rear_end"]) == pytest.approx(0.040)
    )
    assert (
        2.0 * inner.inputs["radius"] == pytest.approx(stations["test_wheel_rear"]) == pytest.approx(0.05754)
    )


def test_end_seals_warm_the_oil_of_the_bearings(case: Case) -> None:
    rig = build_rig(case.with_value("gearboxes.test.seals.*.kind", "radial_lip"), "quick")
    _, losses = conditions_of(rig.case)
    none = {
        "test.gear_oil": 0.0,
        "test.bearing_oil": 0.0,
        "reference.gear_oil": 0.0,
        "reference.bearing_oil": 0.0,
    }
    streams = {s.name: s.heat for s in oil_streams(rig, losses, {}, none, {})}
    own = [p for p in losses if p.gearbox == "test"]
    seals = [p for p in own if p.loss.kind == "seal"]
    ends = sum(p.end_share * p.into_oil for p in seals)
    bearings = sum(p.loss.power for p in own if p.loss.kind == "bearing")
    assert ends > 100.0
    assert streams["test.bearing_oil"] == pytest.approx(bearings + ends, rel=1e-12)
    assert sum(streams.values()) == pytest.approx(sum(p.into_oil for p in losses), rel=1e-12)


@pytest.mark.parametrize(
    ("path", "value", "words"),
    [
        (f"{BOUNDARY}.shaft_outside.medium", "mist", "the fluid is not its oil"),
        (f"{BOUNDARY}.shaft_cold.medium", "mist", "the fluid is not its oil"),
        (f"{BOUNDARY}.gear_sides.medium", "bath", "the gearbox has no sump"),
    ],
)
def test_the_medium_is_that_of_the_gears(case: Case, path: str, value: str, words: str) -> None:
    with pytest.raises(CaseError, match=words):
        case.with_value(path, value)
