"""Films of a housing chosen by name in the case: what each becomes, with its range and source."""

import math
from functools import cache
from pathlib import Path

import pytest

from dynamics.rotor.bearing import BearingState
from rigdesign import load_case
from rigdesign.base.errors import CaseError
from rigdesign.case import Case
from rigdesign.coupling.bearing_loads import solve_bearings
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.located_loss import PointLosses
from rigdesign.coupling.temperatures import boundary_conditions
from rigdesign.coupling.time_run import held_points
from rigdesign.properties.materials import MATERIALS
from rigdesign.rig.model import build_rig
from tests.builders.paths import CASES
from thermal.conditions.boundary import Exchange, Film
from thermal.films import convection
from thermal.films.convection import RibArray
from thermal.films.law import FilmCoefficient, FilmLaw

PROTOTYPE = CASES / "uhcf_prototype" / "case.toml"
BOUNDARY = "gearboxes.test.housing.boundary"
WALL, ROOM = 340.0, 293.15
SPEED = 12000.0 * math.pi / 30.0
HEIGHT = 0.280
SHAFT = 0.040


def with_film(folder: Path, entry: str, table: str) -> Case:
    """The shipped case with one boundary condition changed."""
    file = folder / "case.toml"
    file.write_text(f'extends = "{PROTOTYPE.as_posix()}"\n[{BOUNDARY}.{entry}]\n{table}', encoding="utf-8")
    return load_case(file)


@cache
def shipped_bearings() -> dict[str, BearingState]:
    """Journal bearings of the shipped case; no film but theirs depends on them."""
    rig = build_rig(load_case(PROTOTYPE), "quick")
    point = held_points(rig)[0]
    return dict(solve_bearings(rig, point, initial_state(rig, point)))


def film_at(case: Case, surface: str) -> FilmCoefficient:
    """Coefficient of the one film or exchange of a surface, wall at 340 K, air at 20 degC."""
    rig = build_rig(case, "quick")
    point = held_points(rig)[0]
    coupling_state = initial_state(rig, point)
    heated = PointLosses(point=point, coupling_state=coupling_state, bearings=shipped_bearings(), losses=())
    rows = boundary_conditions(rig, "test", heated, radiation_included=True)
    films = [c for c in rows if isinstance(c, Film) and c.surface == surface]
    gaps = [c for c in rows if isinstance(c, Exchange) and c.surface_a == surface]
    (own,) = [*films, *gaps]
    return own.law(WALL, ROOM)


WALLS = {
    'law = "niemann_winter"': convection.niemann_winter(HEIGHT),
    'law = "iso_tr_14179_2"': convection.iso_tr_14179_2_free(HEIGHT),
    'law = "vertical_plate"': convection.vertical_plate_churchill(HEIGHT),
    'law = "recknagel_plate"': convection.recknagel_plate("dimensional"),
    'law = "horizontal_plate"\nlength = "80 mm"': convection.horizontal_plate_mcadams(0.08),
    'law = "horizontal_plate"\ncorrelation = "vdi"\nlength = "80 mm"\nfacing = "down"': (
        convection.horizontal_plate_vdi(0.08, "down")
    ),
    'law = "horizontal_plate"\ncorrelation = "rohsenow"\nlength = "80 mm"': (
        convection.horizontal_plate_rohsenow(0.08)
    ),
    'law = "forced_air"\nlength = "300 mm"\nvelocity = "4 m/s"': convection.forced_air_plate(
        4.0, 0.3, HEIGHT
    ),
    'law = "forced_air"\nlength = "300 mm"': convection.forced_air_plate(3.0, 0.3, HEIGHT),
    'law = "vertical_plate"\nribs = { height = "20 mm", thickness = "5 mm", pitch = "25 mm" }': (
        convection.ribbed(
            convection.vertical_plate_churchill(HEIGHT),
            RibArray(height=0.02, thickness=0.005, pitch=0.025),
            MATERIALS["structural_steel"].conductivity,
        )
    ),
}
SHAFTS = {
    'law = "rotating_cylinder"\nfluid = "ambient"': convection.rotating_cylinder_becker(SPEED, SHAFT),
    **{
        f'law = "rotating_cylinder"\nfluid = "ambient"\ncorrelation = "{name}"': law(SPEED, SHAFT)
        for name, law in {
            "jungnickel": convection.rotating_cylinder_jungnickel,
            "kays_bjorklund": convection.rotating_cylinder_kays_bjorklund,
            "etemad": convection.rotating_cylinder_etemad,
            "dropkin_carmi": convection.rotating_cylinder_dropkin_carmi,
        }.items()
    },
    'law = "horizontal_cylinder"': convection.horizontal_cylinder_churchill_chu(SHAFT, SPEED),
}


@pytest.mark.parametrize("table", WALLS)
def test_a_wall_takes_the_law_it_names(tmp_path: Path, table: str) -> None:
    surfaces = 'surfaces = ["outer_warm", "outer_cold_front", "outer_cold_rear"]\n'
    check_film(film_at(with_film(tmp_path, "housing_air", surfaces + table), "outer_warm"), WALLS[table])


@pytest.mark.parametrize("table", SHAFTS)
def test_a_shaft_takes_the_law_it_names(tmp_path: Path, table: str) -> None:
    surfaces = 'surfaces = ["shaft_*_outside_*"]\n'
    case = with_film(tmp_path, "shaft_outside", surfaces + table)
    check_film(film_at(case, "shaft_test_pinion_outside_front"), SHAFTS[table])


def check_film(found: FilmCoefficient, law: FilmLaw) -> None:
    wanted = law(WALL, ROOM)
    assert found.value == pytest.approx(wanted.value, rel=1e-12)
    assert (found.formula, found.source, found.valid_range) == (
        wanted.formula,
        wanted.source,
        wanted.valid_range,
    )
    assert found.warnings == wanted.warnings
    assert found.source and found.valid_range


def test_a_factor_scales_film_and_gap_and_stands_among_their_inputs(tmp_path: Path) -> None:
    shipped = load_case(PROTOTYPE)
    factor = '{ value = 0.7, assumed = "scatter of the correlation", range = [0.7, 1.3] }'
    for entry, surface in (("field_air", "field_top"), ("shaft_seal", "shaft_test_pinion_seal_front")):
        scaled = film_at(with_film(tmp_path, entry, f"film_factor = {factor}\n"), surface)
        plain = film_at(shipped, surface)
        assert scaled.value == pytest.approx(0.7 * plain.value, rel=1e-12)
        assert scaled.inputs["film_factor"] == 0.7
        assert "film_factor" not in plain.inputs


def test_a_film_of_a_shaft_belongs_on_a_shaft(tmp_path: Path) -> None:
    table = 'surfaces = ["outer_*"]\nlaw = "rotating_cylinder"\nfluid = "ambient"\n'
    with pytest.raises(CaseError, match=r'"outer_warm": is no surface of a shaft or gear.*still walls'):
        with_film(tmp_path, "housing_air", table)


def test_an_air_stream_of_unknown_velocity_is_an_assumption_with_its_range(tmp_path: Path) -> None:
    table = 'surfaces = ["outer_*"]\nlaw = "forced_air"\nlength = "300 mm"\n'
    case = with_film(tmp_path, "housing_air", table)
    (found,) = [record for record in case.assumptions if record.path == f"{BOUNDARY}.housing_air.velocity"]
    assert (found.value, found.range) == ("3 m/s", ("1.5 m/s", "6 m/s"))
    stated = with_film(tmp_path, "housing_air", table + 'velocity = "2 m/s"\n')
    assert not any(record.path == f"{BOUNDARY}.housing_air.velocity" for record in stated.assumptions)


def test_ribs_without_a_gap_are_refused(tmp_path: Path) -> None:
    table = 'ribs = { height = "20 mm", thickness = "5 mm", pitch = "5 mm" }\n'
    with pytest.raises(CaseError, match="leave no gap"):
        with_film(tmp_path, "housing_air", table)


def test_a_plate_repeats_the_height_of_the_housing_or_none(tmp_path: Path) -> None:
    table = 'surfaces = ["outer_*"]\nlaw = "vertical_plate"\nheight = "400 mm"\n'
    with pytest.raises(CaseError, match="is not the height of the housing, 280 mm"):
        with_film(tmp_path, "housing_air", table)
