"""Chamber radiation, plug flow and volume links as a case states them, against hand figures from the solved field."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rigdesign.coupling.housing_context import heat_carried_off
from rigdesign.coupling.temperatures import HousingField, heat_into_oil, heat_to_room
from rigdesign.postprocessing.housing import fluid_temperatures
from rigdesign.rig.model import Rig
from rigdesign.transient.heating import blended
from rigdesign.transient.oil import oil_conditions
from tests.builders.fzg_case import HELD
from tests.builders.warm_chambers import solved_chambers, stated_conditions
from thermal.conditions.enclosure import Enclosure
from thermal.conditions.streams import StreamNetwork
from thermal.conduction.reduced import ReducedConduction, shapes_of
from thermal.conduction.setup import check_conditions
from thermal.conduction.steady import solve_steady
from thermal.films.law import STEFAN_BOLTZMANN

WATER = 997.05 * 4181.3 * 1.5e-3 / 60.0
"""Heat capacity rate of 1.5 l/min of water of 25 degC (IAPWS-95) [W/K]."""
BREATHER = 1.2047 * 1006.1 * 0.120 / 60.0
"""The same of 120 l/min of air of 20 degC, here at 25 degC 2 % less [W/K]."""


@pytest.fixture(scope="module")
def solved(tmp_path_factory: pytest.TempPathFactory) -> tuple[Rig, object, HousingField]:
    return solved_chambers(tmp_path_factory.mktemp("chambers"))


def rows(field: HousingField, kind: str) -> dict[str, float]:
    return {row.surface: row.power for row in field.solution.balance.rows if row.kind == kind}


def mean(rig: Rig, field: HousingField, surface: str) -> float:
    return rig.conduction["test"].elements.surfaces[surface].mean(field.temperature)


def area(rig: Rig, surface: str) -> float:
    return rig.conduction["test"].elements.surfaces[surface].area


def emission(rig: Rig, field: HousingField, surface: str) -> float:
    found = rig.conduction["test"].elements.surfaces[surface]
    return STEFAN_BOLTZMANN * found.integral(found.at_points(field.temperature) ** 4) / found.area


def enclosure(field: HousingField, name: str) -> Enclosure:
    return next(c for c in field.conditions if isinstance(c, Enclosure) and c.name == name)


def test_heat_in_is_heat_out(solved) -> None:
    _, _, field = solved
    assert field.solution.balance.closure < 1e-8
    warm = [rows(field, "chamber_radiation")[name] for name in enclosure(field, "warm").surfaces]
    assert sum(warm) == pytest.approx(0.0, abs=1e-9 * max(map(abs, warm)))
    assert sum(map(abs, warm)) > 5.0


def test_two_grey_surfaces_with_an_opening(solved) -> None:
    """Network of resistances by hand: floor and wall of the rear cold section and the room behind the opening."""
    rig, _, field = solved
    floor, wall, room, e = "cold_floor_rear", "cold_wall_rear", 298.15, 0.6
    a = {name: area(rig, name) for name in (floor, wall)}
    between = 0.5 * a[floor]
    to_room = {floor: 0.5 * a[floor], wall: a[wall] - between}
    black = STEFAN_BOLTZMANN * room**4
    grey = {name: a[name] * e / (1.0 - e) for name in a}
    matrix = np.array(
        [
            [grey[floor] + between + to_room[floor], -between],
            [-between, grey[wall] + between + to_room[wall]],
        ]
    )
    given = [grey[name] * emission(rig, field, name) + to_room[name] * black for name in (floor, wall)]
    radiosity = dict(zip((floor, wall), np.linalg.solve(matrix, given), strict=True))
    found = rows(field, "chamber_radiation")
    for name in (floor, wall):
        by_hand = grey[name] * (radiosity[name] - emission(rig, field, name))
        assert found[name] == pytest.approx(by_hand, rel=1e-6)
    # what leaves through the opening is heat to the room
    plain = sum(sum(rows(field, kind).values()) for kind in ("air", "radiation"))
    assert heat_to_room(field) == pytest.approx(-plain - found[floor] - found[wall], rel=1e-9)


def test_a_floor_that_gives_back_all_it_gets_keeps_no_heat(solved) -> None:
    _, _, field = solved
    assert rows(field, "chamber_radiation")["chamber_floor"] == pytest.approx(0.0, abs=1e-9)
    warm = enclosure(field, "warm")
    emissivities = dict(zip(warm.surfaces, warm.emissivities, strict=True))
    assert emissivities["chamber_floor"] == 0.0
    assert emissivities["gear_test_pinion_rim"] == emissivities["gear_test_wheel_side_rear"] == 0.3
    assert emissivities["chamber_top"] == emissivities["shaft_test_wheel_warm"] == 0.82


def test_the_view_factors_of_the_box_are_those_of_its_plates(solved) -> None:
    """Floor and top of the warm chamber, in part hidden by gears and shafts: below the free pair (Howell, C-11)."""
    rig, _, field = solved
    warm = enclosure(field, "warm")
    factors = dict(zip(warm.surfaces, (dict(zip(warm.surfaces, row)) for row in warm.view_factors)))
    sums = [sum(row.values()) for row in factors.values()]
    assert np.allclose(sums, 1.0, atol=1e-10)
    for one in warm.surfaces:
        for other in warm.surfaces:
            assert factors[one][other] * area(rig, one) == pytest.approx(
                factors[other][one] * area(rig, other), rel=1e-6, abs=1e-12
            )
    x, y = 0.256 / 0.193, 0.060 / 0.193  # width and length of the chamber over its height
    assert 0.2 * _parallel(x, y) < factors["chamber_floor"]["chamber_top"] < _parallel(x, y)
    # a gear side faces its partition 23 mm away
    assert factors["gear_test_wheel_side_front"]["partition_warm_front"] > 0.6
    assert factors["gear_test_wheel_side_front"]["partition_warm_rear"] == 0.0


def _parallel(x: float, y: float) -> float:
    one_x, one_y = 1.0 + x * x, 1.0 + y * y
    total = 0.5 * math.log(one_x * one_y / (1.0 + x * x + y * y))
    total += x * math.sqrt(one_y) * math.atan(x / math.sqrt(one_y)) - x * math.atan(x)
    total += y * math.sqrt(one_x) * math.atan(y / math.sqrt(one_x)) - y * math.atan(y)
    return 2.0 * total / (math.pi * x * y)


def test_a_jacket_warms_up_exponentially_from_surface_to_surface(solved) -> None:
    rig, losses, field = solved
    inlet = temperature = 298.15
    for surface in ("outer_cold_front", "outer_warm"):
        wall, units = mean(rig, field, surface), 400.0 * area(rig, surface) / WATER
        temperature = wall + (temperature - wall) * math.exp(-units)
    found = {fluid.name: fluid for fluid in fluid_temperatures(rig, field, losses.coupling_state.oil_outlet)}
    jacket = found["jacket"]
    assert jacket.temperature == pytest.approx(temperature, abs=0.01)
    assert (jacket.kind, jacket.inlet, jacket.links) == ("stream", inlet, {})
    assert jacket.heat == pytest.approx(WATER * (temperature - inlet), rel=2e-3)
    assert jacket.heat == pytest.approx(
        -sum(row.power for row in field.solution.balance.rows if row.kind == "jacket" and row.area > 0.0),
        rel=1e-9,
    )
    assert heat_carried_off(field.solution) == pytest.approx(jacket.heat, rel=1e-9)


def test_the_air_of_a_chamber_by_hand(solved) -> None:
    """Stirred: films + power + links = 0 gives the temperature as a mean weighted by conductances."""
    rig, losses, field = solved
    oil = losses.coupling_state.oil_outlet["test.gear_oil"]
    weights = {oil: 3.0, 298.15: BREATHER * 293.15 / 298.15}
    for surface in ("cold_wall_front", "partition_cold_front"):
        weights[mean(rig, field, surface)] = 15.0 * area(rig, surface)
    by_hand = (20.0 + sum(g * t for t, g in weights.items())) / sum(weights.values())
    found = next(
        fluid
        for fluid in fluid_temperatures(rig, field, losses.coupling_state.oil_outlet)
        if fluid.name == "cold_air"
    )
    assert found.temperature == pytest.approx(by_hand, abs=0.05)
    assert found.links["drain"] == pytest.approx(3.0 * (oil - found.temperature), rel=1e-9)
    assert found.heat + found.power + sum(found.links.values()) == pytest.approx(0.0, abs=1e-6)
    # what the oil gives through the drain is heat it loses besides that to its walls
    walls = sum(row.power for row in field.solution.balance.rows if row.kind == "gear_oil" and row.area > 0.0)
    assert heat_into_oil(field)["test.gear_oil"] == pytest.approx(-walls - found.links["drain"], rel=1e-9)


def test_over_time_links_end_in_the_oil_that_is_an_unknown_there(solved) -> None:
    rig, losses, _ = solved
    fed, cut = (oil_conditions(rig, "test", losses, oil=oil) for oil in (True, False))
    for conditions in (fed, cut, blended(fed, fed, 0.3)):
        check_conditions(rig.conduction["test"].elements, conditions)
        own = next(c for c in conditions if isinstance(c, StreamNetwork) and c.volumes[0].name == "cold_air")
        assert [supply.name for supply in own.supplies] == ["ambient"]
        assert sum(isinstance(c, Enclosure) for c in conditions) == 2
    # with its oil fed the housing has the steady state of the coupled description, oil temperature set apart
    steady = solve_steady(rig.conduction["test"], fed, 360.0)
    assert steady.balance.closure < 1e-8
    drain = [row for row in steady.balance.rows if row.kind == "gear_oil" and row.surface == "cold_air"]
    outlet, air = steady.volumes["gear_oil"], steady.volumes["cold_air"]
    assert [row.power for row in drain] == pytest.approx([3.0 * (outlet - air)], rel=1e-9)


def test_a_link_ends_in_a_sump_that_finds_its_own_temperature(tmp_path: Path) -> None:
    _, _, field = solved_chambers(tmp_path, {"test": "", "slave": HELD})
    assert field.solution.balance.closure < 1e-8
    oil, air = field.solution.volumes["gear_oil"], field.solution.volumes["cold_air"]
    rows = field.solution.balance.rows
    drained = [row.power for row in rows if row.surface == "cold_air" and row.kind == "gear_oil"]
    assert drained == pytest.approx([3.0 * (oil - air)], rel=1e-9)
    # what is churned in the sump leaves through the walls it wets and the drain
    given = sum(row.power for row in rows if row.surface == "gear_oil" and row.kind == "power")
    walls = sum(row.power for row in rows if row.area > 0.0 and row.kind == "gear_oil")
    assert given > 0.0
    assert given == pytest.approx(walls + drained[0], abs=1e-4)


def test_the_reduced_model_takes_enclosures(solved) -> None:
    """Projected on fields that hold the answer, the reduced model gives it."""
    rig, losses, field = solved
    setup = rig.conduction["test"]
    plain = [c for c in stated_conditions(rig, losses) if not isinstance(c, StreamNetwork)]
    covered = {"outer_warm", "outer_cold_front", "cold_wall_front", "partition_cold_front"}
    template = next(c for c in plain if getattr(c, "kind", "") == "air")
    conditions = [*plain, *(replace(template, surface=name) for name in sorted(covered))]
    full = solve_steady(setup, conditions, near=field.solution)
    bare = solve_steady(setup, [c for c in conditions if not isinstance(c, Enclosure)], near=field.solution)
    shapes, _ = shapes_of(np.column_stack([full.temperature, bare.temperature]), 1e-6)
    reduced = ReducedConduction(setup, shapes)
    start = np.zeros(reduced.size)
    start[0] = float(bare.temperature.mean())
    found = reduced.solve(conditions, start)
    assert np.abs(reduced.field(found.coefficients) - full.temperature).max() < 0.02
    powers = {row.surface: row.power for row in full.balance.rows if row.kind == "chamber_radiation"}
    for row in found.balance.rows:
        if row.kind == "chamber_radiation":
            assert row.power == pytest.approx(powers[row.surface], abs=0.02)
