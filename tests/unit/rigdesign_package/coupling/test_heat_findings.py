"""Audits of the heat as warnings of a run: films printed for another temperature difference, radiation twice.

The case is the shipped one with given losses and P2's way with films: coefficients read once at an assumed
difference, 19.5 W/(m2 K) at 100 K and 15.09 at 45 K from Niemann/Winter with h = 0.4 m, 6.3 at 100 K for the field.
"""

from pathlib import Path

import pytest

from rigdesign import load_case
from rigdesign.base.errors import CaseError
from rigdesign.case import Case
from rigdesign.coupling.bearing_loads import solve_bearings
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.located_loss import PointLosses
from rigdesign.coupling.temperatures import boundary_conditions
from rigdesign.coupling.time_run import held_points
from rigdesign.report.results_json import results_document
from rigdesign.results.result import RunResult
from rigdesign.rig.model import build_rig
from rigdesign.run.main import run_case
from tests.builders.paths import CASES
from thermal.conditions.boundary import Radiation

pytestmark = pytest.mark.whole_run

PROTOTYPE = CASES / "uhcf_prototype"
NIEMANN = 'law = "niemann_winter", height = "400 mm"'
PUBLISHED = f"""
extends = "{(PROTOTYPE / "given_losses.toml").as_posix()}"
name = "published_films"
title = "films as P2 prints them"
[numerics]
temperature_tolerance = "0.5 K"
growth_tolerance = "5 um"
[gearboxes.test.housing]
radiation_included = false
[gearboxes.test.housing.boundary]
remove = ["housing_air", "field_air"]
[gearboxes.test.housing.boundary.warm_air]
surfaces = ["outer_warm"]
law = "constant_film"
heat_transfer_coefficient = "19.5 W/(m2 K)"
fluid = "ambient"
taken_from = {{ temperature_difference = "100 K", {NIEMANN} }}
[gearboxes.test.housing.boundary.cold_air]
surfaces = ["outer_cold_*"]
law = "constant_film"
heat_transfer_coefficient = "15.09 W/(m2 K)"
fluid = "ambient"
taken_from = {{ temperature_difference = "45 K", {NIEMANN} }}
[gearboxes.test.housing.boundary.field]
surfaces = ["field_top", "field_sides"]
law = "constant_film"
heat_transfer_coefficient = "6.3 W/(m2 K)"
fluid = "ambient"
taken_from = {{ temperature_difference = "100 K", law = "recknagel_plate" }}
"""


def load(folder: Path, text: str) -> Case:
    file = folder / "published.toml"
    file.write_text(text, encoding="utf-8")
    return load_case(file)


@pytest.fixture(scope="module")
def published(tmp_path_factory: pytest.TempPathFactory) -> RunResult:
    return run_case(load(tmp_path_factory.mktemp("films"), PUBLISHED), fidelity="quick")


def audits(result: RunResult) -> list[str]:
    return [finding.text for finding in result.warnings if finding.id == "heat_audit"]


def test_printed_film_is_held_against_the_solved_difference(published: RunResult) -> None:
    """The field was taken at 100 K; h = 2 dT^(1/4) gives less at the difference that came out."""
    (row,) = (row for row in published.thermal[0].heat if row.surface == "field_top" and row.kind == "air")
    solved = row.mean_temperature - 293.15
    assert 5.0 < solved < 60.0
    (text,) = (text for text in audits(published) if text.startswith("test: field_top") and "assumed" in text)
    change = 100.0 * ((solved / 100.0) ** 0.25 - 1.0)
    for words in (
        "= 100 K",
        f"solved {solved:.4g} K",
        f"{2.0 * solved**0.25:.4g} instead of 6.325",
        f"({change:+.0f} %)",
    ):
        assert words in text


def test_film_that_came_out_as_assumed_is_not_named(published: RunResult) -> None:
    """Only differences off by more than a tenth of what was assumed."""
    rows = {row.surface: row for row in published.thermal[0].heat if row.kind == "air"}
    assumed = {"outer_warm": 100.0, "field_top": 100.0, "field_sides": 100.0}
    assumed |= {f"outer_cold_{side}": 45.0 for side in ("front", "rear")}
    off = {
        name for name, value in assumed.items()
        if abs(rows[name].mean_temperature - 293.15 - value) > 0.1 * value
    }  # fmt: skip
    named = {text.split(": ")[1] for text in audits(published) if "assumed temperature difference" in text}
    assert named == off


def test_printed_niemann_film_counts_radiation_twice(published: RunResult) -> None:
    twice = {text.split(": ")[1] for text in audits(published) if "radiates as well" in text}
    assert twice == {"outer_warm", "outer_cold_front", "outer_cold_rear"}


def test_reading_with_radiation_included_drops_what_the_print_holds(published: RunResult) -> None:
    """The box then gives the room less by about its radiation; the field keeps its own."""
    (thermal,) = published.thermal
    box = -sum(
        row.power for row in thermal.heat if row.kind == "radiation" and row.surface.startswith("outer")
    )
    field = -sum(
        row.power for row in thermal.heat if row.kind == "radiation" and row.surface.startswith("field")
    )
    less = thermal.room_heat - thermal.alternatives.heat_to_the_room_under_the_other_reading
    assert 0.3 * box < less < box
    assert field > 0.1 * box


def test_audits_reach_the_document(published: RunResult) -> None:
    rows = results_document(published)["warnings"]
    assert ("heat_audit", audits(published)[0]) in {(row["id"], row["text"]) for row in rows}


@pytest.mark.parametrize(("law", "kept"), [("niemann_winter", False), ("iso_tr_14179_2", True)])
def test_only_a_film_that_holds_radiation_takes_it_off(tmp_path: Path, law: str, kept: bool) -> None:
    """ISO/TR 14179-2 has a term of its own for radiation: its free convection must not swallow the box's."""
    text = PUBLISHED.replace('law = "niemann_winter"', f'law = "{law}"')
    rig = build_rig(load(tmp_path, text), "quick")
    point = held_points(rig)[-1]
    initial = initial_state(rig, point)
    heated = PointLosses(
        point=point, coupling_state=initial, bearings=solve_bearings(rig, point, initial), losses=()
    )
    conditions = boundary_conditions(rig, "test", heated, radiation_included=True)
    radiating = {condition.surface for condition in conditions if isinstance(condition, Radiation)}
    assert ("outer_warm" in radiating) is kept
    assert "field_top" in radiating


@pytest.mark.parametrize(
    ("old", "new", "path"),
    [
        (', height = "400 mm"', "", "warm_air.taken_from.height"),
        ('fluid = "ambient"', 'fluid = "gear_oil_mean"', "warm_air.taken_from"),
        ('"100 K"', '"0 K"', "warm_air.taken_from.temperature_difference"),
        ('"niemann_winter"', '"niemann"', "warm_air.taken_from.law"),
    ],
)
def test_bad_print(tmp_path: Path, old: str, new: str, path: str) -> None:
    with pytest.raises(CaseError) as raised:
        load(tmp_path, PUBLISHED.replace(old, new, 1))
    assert f"gearboxes.test.housing.boundary.{path}" in [fault.path for fault in raised.value.faults]
