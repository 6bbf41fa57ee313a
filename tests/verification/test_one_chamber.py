"""A housing without partitions: its temperatures against a network by hand, its clearances, a rig that has one."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rigdesign.base.errors import CaseError
from rigdesign.case import load_case
from rigdesign.coupling.expansion import hot_clearances
from rigdesign.coupling.loop import PointResult, solve_point
from rigdesign.coupling.temperatures import body_mean
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.model import Rig, build_rig
from tests.builders.fzg_case import fzg_case
from tests.builders.housing import ONE_CHAMBER
from thermal.conditions.boundary import Adiabatic, BoundaryCondition, Film
from thermal.conduction.steady import CLOSURE, ConductionSetup, solve_steady
from thermal.expansion.expansion import ExpansionSetup, expand
from thermal.films.convection import constant
from thermal.housing.gearbox import build_gearbox, exact_areas

OIL, ROOM, INSIDE, OUTSIDE, CONDUCTIVITY = 363.15, 293.15, 300.0, 15.0, 45.0
STEEL, COLD, WARMER = (210e9, 0.3, 11.5e-6), 293.15, 60.0


def test_heat_through_the_walls_is_that_of_plates_side_by_side() -> None:
    """Oil, wall and room in series for each plate; corners and the foot are left out of the hand calculation."""
    g = replace(ONE_CHAMBER, field=None)
    model = build_gearbox(g, "quick")
    wet = ("chamber_wall", "chamber_floor", "chamber_top", "end_wall_front", "end_wall_rear")
    conditions: list[BoundaryCondition] = []
    for surface in model.mesh.surfaces:
        if surface.startswith("outer"):
            conditions.append(
                Film(surface=surface, kind="air", fluid_temperature=ROOM, law=constant(OUTSIDE, "test"))
            )
        elif surface in wet or surface.endswith("_warm"):
            conditions.append(
                Film(surface=surface, kind="oil", fluid_temperature=OIL, law=constant(INSIDE, "test"))
            )
        else:
            conditions.append(Adiabatic(surface=surface))
    solution = solve_steady(
        ConductionSetup(model.mesh, dict.fromkeys(model.mesh.bodies, CONDUCTIVITY)), conditions
    )
    assert solution.balance.closure <= CLOSURE

    areas = exact_areas(g)
    plates = {
        g.wall_thickness: (areas["chamber_wall"], 2.0 * g.length * g.height),
        g.top_thickness: (areas["chamber_top"], g.length * g.width),
        g.end_wall_thickness: (
            areas["end_wall_front"] + areas["end_wall_rear"], areas["outer_end_front"] + areas["outer_end_rear"],
        ),
    }  # fmt: skip
    by_hand = math.fsum(
        (OIL - ROOM)
        / (
            1 / (INSIDE * inner)
            + thickness / (CONDUCTIVITY * math.sqrt(inner * outer))
            + 1 / (OUTSIDE * outer)
        )
        for thickness, (inner, outer) in plates.items()
    )
    assert -solution.balance.by_kind()["air"] == pytest.approx(by_hand, rel=0.02)


def test_clearances_of_a_uniformly_heated_box_are_its_strain() -> None:
    model = build_gearbox(ONE_CHAMBER, "quick")
    setup = ExpansionSetup(model, dict.fromkeys(model.mesh.bodies, STEEL))
    hot = expand(setup, np.full(len(model.mesh.points), COLD + WARMER), COLD, tolerance=1e-8)
    strain = STEEL[2] * WARMER
    (axes,) = hot.centre_distances
    assert axes.change == pytest.approx(strain * 0.0995, rel=1e-5)
    assert hot.bearings["wheel_rear"].clearance_change == pytest.approx(strain * 1e-4, rel=1e-3)
    assert hot.bearings["wheel_front"].clearance_change == pytest.approx(
        0.0, abs=1e-11
    )  # drawn without clearance
    assert set(hot.seals) == {"pinion_rear_end", "wheel_front_end", "wheel_rear_end"}
    assert hot.seals["wheel_rear_end"].mean == pytest.approx(0.6e-3 * (1.0 + strain), rel=1e-4)


@pytest.fixture(scope="module")
def settled(tmp_path_factory: pytest.TempPathFactory) -> tuple[Rig, PointResult]:
    """FZG rig whose test gearbox has one chamber, at its held stage."""
    rig = build_rig(load_case(fzg_case(tmp_path_factory.mktemp("fzg"), one_chamber=True)), "quick")
    return rig, solve_point(rig, held_points(rig)[-1])


def test_a_rig_with_one_chamber_settles(settled: tuple[Rig, PointResult]) -> None:
    """Two seals, one a shaft, each where it leaves; gears near those of the box with partitions (126 degC)."""
    rig, result = settled
    balance = result.last.fields["test"].solution.balance
    assert balance.closure < 1e-3
    seals = [row.surface for row in balance.rows if row.kind == "seal_loss"]
    assert sorted(seals) == [
        f"{stem}_rear_end"
        for stem in (
            "seal_bore_test_pinion", "seal_bore_test_wheel", "shaft_test_pinion_seal", "shaft_test_wheel_seal",
        )
    ]  # fmt: skip
    bulk = result.last.coupling_state.gear_temperature
    assert [bulk[f"test.{gear}"] - 273.15 for gear in ("pinion", "wheel")] == pytest.approx(
        [126.0] * 2, abs=8.0
    )
    hot = hot_clearances(rig, result.point.speed, result.last.expansion)
    assert all(0.0 < hot[name] < 80e-6 for name in hot if name.startswith("test."))


def test_gear_and_shaft_as_two_nodes_by_hand(settled: tuple[Rig, PointResult]) -> None:
    """One node a gear and one a shaft: films on their exact areas, sources, and the shaft between gear and bearings.

    The node of the shaft stands half-way between the gear and the bearings, on both sides; it has no mean of the body
    to be compared with, whose part in the gear is as hot as that.
    """
    rig, result = settled
    field, geometry = result.last.fields["test"], rig.geometries["test"]
    areas = exact_areas(geometry)
    for shaft in geometry.shafts:
        matrix, heat = np.zeros((2, 2)), np.zeros(2)
        for row in field.solution.balance.rows:
            if f"_{shaft.name}" not in row.surface or not row.surface.startswith(("gear_", "shaft_")):
                continue
            node = 0 if row.surface.startswith("gear_") else 1
            if row.coefficient is None:
                heat[node] += row.power
                continue
            conductance = row.coefficient.value * areas[row.surface]
            fluid = row.mean_temperature + row.power / (row.coefficient.value * row.area)
            matrix[node, node] += conductance
            heat[node] += conductance * fluid
        steel = rig.materials[rig.case.gearboxes["test"].housing.shafts[shaft.name].material]
        reach = 0.5 * (geometry.length - 2.0 * geometry.end_wall_thickness + shaft.front.width)
        along = 2.0 * steel.conductivity * math.pi * shaft.seat_diameter**2 / 4.0 / (0.5 * reach)
        matrix += along * np.array([[1.0, -1.0], [-1.0, 1.0]])
        gear, _ = np.linalg.solve(matrix, heat)
        assert body_mean(rig, field, f"gear_{shaft.name}") == pytest.approx(gear, abs=1.0)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (
            {'warm_length = "116 mm"': 'warm_length = "116 mm"\ncold_length_front = "20 mm"'},
            ("cold_length_rear, partition_thickness missing beside cold_length_front", "none of them"),
        ),
        (
            {'outside_diameter = "30 mm"': 'outside_diameter = "30 mm"\nseal_diameter = "30 mm"'},
            ("shafts.test_pinion.seal_diameter", "30 mm", "does nothing", "remove it"),
        ),
        (
            {
                'overhang_rear = "40 mm"': 'overhang_rear = "0 mm"',
                'radial_gap = "0.3 mm"': 'radial_gap = "0.3 mm"\nrubbing_torque = "1 N m"',
            },
            ("gearboxes.test.seals.pinion.rubbing_torque", "no seal to rub in", "overhang_front"),
        ),
    ],
)
def test_refused_cases(changes: dict[str, str], words: tuple[str, ...], tmp_path: Path) -> None:
    path = fzg_case(tmp_path, one_chamber=True)
    text = path.read_text()
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    path.write_text(text)
    with pytest.raises(CaseError) as error:
        load_case(path)
    for word in words:
        assert word in str(error.value)
