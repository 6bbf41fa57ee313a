"""Contact between meshes that do not match against series resistances and linear fields."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.builders.curved_blocks import cylinder_sector
from tests.builders.two_blocks import law, renamed
from thermal.conditions.boundary import Adiabatic, Film, PrescribedTemperature
from thermal.conditions.contact import Contact
from thermal.conduction.setup import Condition, ConductionSetup
from thermal.conduction.steady import solve_steady
from thermal.fe.mesh import CellName, NamedMesh, box_mesh, disjoint_union

SIDES = [f"{axis}_{end}" for axis in "yz" for end in ("min", "max")]


def bars(cell: CellName) -> NamedMesh:
    left = renamed(box_mesh((0.1, 0.02, 0.03), (3, 2, 3), name="left", cell=cell), "left")
    right = box_mesh((0.2, 0.02, 0.03), (4, 3, 2), origin=(0.1, 0.0, 0.0), name="right", cell=cell)
    return disjoint_union(left, renamed(right, "right"))


def bar_conditions(joint: Contact) -> list[Condition]:
    return [
        PrescribedTemperature(surface="left_x_min", temperature=400.0),
        PrescribedTemperature(surface="right_x_max", temperature=300.0),
        joint,
        *(Adiabatic(surface=f"{body}_{side}") for body in ("left", "right") for side in SIDES),
    ]


@pytest.mark.parametrize("cell", ["tetra10", "hexahedron20", "hexahedron27"])
def test_uniform_flux_through_a_joint_is_exact_at_every_node(cell: CellName) -> None:
    mesh = bars(cell)
    joint = Contact(surface_a="left_x_max", surface_b="right_x_min", kind="joint", law=law(2500.0))
    solution = solve_steady(
        ConductionSetup(mesh, {"left": 40.0, "right": 160.0}), bar_conditions(joint), tolerance=1e-12
    )
    flux = 100.0 / (0.1 / 40.0 + 1.0 / 2500.0 + 0.2 / 160.0)
    x = mesh.points[:, 0]
    left = np.unique(mesh.cells[mesh.bodies["left"]])
    right = np.unique(mesh.cells[mesh.bodies["right"]])
    assert_allclose(solution.temperature[left], 400.0 - flux * x[left] / 40.0, rtol=0.0, atol=1e-7)
    assert_allclose(solution.temperature[right], 300.0 + flux * (0.3 - x[right]) / 160.0, rtol=0.0, atol=1e-7)
    rows = {row.surface: row.power for row in solution.balance.rows}
    heat = flux * 6e-4
    expected = {"left_x_min": heat, "left_x_max": -heat, "right_x_min": heat, "right_x_max": -heat}
    assert rows == pytest.approx(expected, rel=1e-8)


def test_sides_may_be_swapped() -> None:
    mesh = bars("tetra10")
    joint = Contact(surface_a="left_x_max", surface_b="right_x_min", kind="joint", law=law(2500.0))
    swapped = replace(joint, surface_a=joint.surface_b, surface_b=joint.surface_a)
    conductivity = {"left": 40.0, "right": 160.0}
    one = solve_steady(ConductionSetup(mesh, conductivity), bar_conditions(joint), tolerance=1e-12)
    other = solve_steady(ConductionSetup(mesh, conductivity), bar_conditions(swapped), tolerance=1e-12)
    assert_allclose(other.temperature, one.temperature, rtol=0.0, atol=1e-8)


@pytest.mark.parametrize("cell", ["tetra10", "hexahedron20"])
def test_shrink_fit_has_the_resistances_of_a_hollow_cylinder(cell: CellName) -> None:
    shaft = cylinder_sector((0.02, 0.04), (2, 5, 2), "shaft", cell=cell)
    gear = cylinder_sector((0.04, 0.10), (5, 8, 3), "gear", cell=cell)
    conductance = 6000.0
    ends = ("start", "end", "z_min", "z_max")
    conditions: list[Condition] = [
        PrescribedTemperature(surface="shaft_inner", temperature=360.0),
        PrescribedTemperature(surface="gear_outer", temperature=420.0),
        Contact(surface_a="gear_inner", surface_b="shaft_outer", kind="fit", law=law(conductance)),
        *(Adiabatic(surface=f"{body}_{end}") for body in ("shaft", "gear") for end in ends),
    ]
    solution = solve_steady(
        ConductionSetup(disjoint_union(shaft, gear), {"shaft": 42.0, "gear": 48.0}), conditions
    )
    resistance = np.log(2.0) / 42.0 + 1.0 / (conductance * 0.04) + np.log(2.5) / 48.0
    heat = 0.5 * np.pi * 0.1 * 60.0 / resistance
    rows = {row.surface: row.power for row in solution.balance.rows}
    assert rows["gear_outer"] == pytest.approx(heat, rel=1e-3)
    assert rows["shaft_outer"] == pytest.approx(rows["gear_outer"], rel=1e-8)
    area = next(row.area for row in solution.balance.rows if row.surface == "gear_inner")
    assert area == pytest.approx(0.5 * np.pi * 0.04 * 0.1, rel=1e-3)


def test_a_foot_on_a_field_spreads_its_heat() -> None:
    """A joint of no resistance gives the field of the same bodies sharing their nodes."""
    field = renamed(box_mesh((0.3, 0.3, 0.1), (6, 6, 2), name="field"), "field")
    foot = box_mesh((0.1, 0.1, 0.1), (3, 3, 3), origin=(0.1, 0.1, 0.1), name="foot")
    fine = box_mesh((0.1, 0.1, 0.1), (2, 2, 2), origin=(0.1, 0.1, 0.1), name="foot")
    heats = {}
    for name, part in (("other mesh", foot), ("same mesh", fine)):
        sides = [f"{body}_{a}_{e}" for body in ("field", "foot") for a in "xy" for e in ("min", "max")]
        conditions: list[Condition] = [
            PrescribedTemperature(surface="field_z_min", temperature=300.0),
            PrescribedTemperature(surface="foot_z_max", temperature=400.0),
            Contact(surface_a="field_z_max", surface_b="foot_z_min", kind="foot", law=law(1e7)),
            *(Adiabatic(surface=side) for side in sides),
        ]
        mesh = disjoint_union(field, renamed(part, "foot"))
        solution = solve_steady(ConductionSetup(mesh, {"field": 50.0, "foot": 50.0}), conditions)
        heats[name] = next(r.power for r in solution.balance.rows if r.surface == "foot_z_max")
    assert heats["other mesh"] == pytest.approx(heats["same mesh"], rel=5e-3)


def test_a_film_on_a_surface_that_touches_is_said() -> None:
    field = renamed(box_mesh((0.3, 0.3, 0.1), (6, 6, 2), name="field"), "field")
    foot = renamed(box_mesh((0.1, 0.1, 0.1), (3, 3, 3), (0.1, 0.1, 0.1), "foot"), "foot")
    sides = [f"{body}_{a}_{e}" for body in ("field", "foot") for a in "xy" for e in ("min", "max")]
    conditions: list[Condition] = [
        PrescribedTemperature(surface="field_z_min", temperature=300.0),
        PrescribedTemperature(surface="foot_z_max", temperature=400.0),
        Contact(surface_a="foot_z_min", surface_b="field_z_max", kind="foot", law=law(2e3)),
        Film(surface="field_z_max", kind="air", fluid_temperature=293.0, law=law(5.0)),
        *(Adiabatic(surface=side) for side in sides),
    ]
    solution = solve_steady(
        ConductionSetup(disjoint_union(field, foot), {"field": 50.0, "foot": 50.0}), conditions
    )
    assert len(solution.warnings) == 1
    assert solution.warnings[0].startswith("field_z_max: 11.1 % touches (foot), above 2 %")
