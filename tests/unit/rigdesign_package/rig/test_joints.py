"""Foot on its field and shells in their bores: conductance of the case, series with the film, free sliding."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rigdesign.base.errors import CaseError
from rigdesign.case import load_case
from rigdesign.case.model import Case
from rigdesign.rig.joints import FOOT_CONTACT, behind_shell, foot_joint, shell_temperature
from rigdesign.rig.model import build_rig
from tests.builders.housing import PROTOTYPE, area
from tests.builders.paths import CASES
from thermal.conditions.boundary import Adiabatic, Film
from thermal.conditions.contact import Contact
from thermal.conduction.setup import ConductionSetup
from thermal.conduction.steady import solve_steady
from thermal.expansion.expansion import expand
from thermal.expansion.setup import ExpansionSetup
from thermal.fe.elements import FiniteElements
from thermal.films.convection import constant
from thermal.housing.gearbox import build_gearbox, exact_areas, surface_names
from thermal.housing.housing_surfaces import FOOT, SEAT

BASE = (CASES / "uhcf_prototype" / "case.toml").as_posix()
JOINED = replace(PROTOTYPE, foot_joint=True)
STEEL = (210e9, 0.3, 12e-6)


def case_with(tmp_path: Path, text: str) -> Case:
    file = tmp_path / "case.toml"
    file.write_text(f'extends = "{BASE}"\nname = "joined"\n{text}')
    return load_case(file)


@pytest.fixture(scope="module")
def model():
    return build_gearbox(JOINED, "quick")


def test_both_sides_of_the_joint_are_surfaces_of_their_own(model) -> None:
    mesh, exact = model.mesh, exact_areas(JOINED)
    assert set(mesh.surfaces) == set(exact) == {*surface_names(JOINED), FOOT, SEAT}
    for name in (FOOT, SEAT, "field_top", "field_bottom"):
        assert area(mesh, name) == pytest.approx(exact[name], rel=1e-12)
    foot, seat = (set(np.unique(mesh.surfaces[name]).tolist()) for name in (FOOT, SEAT))
    assert not foot & seat


def conditions(model, conductance: float) -> list:
    """Heat in at the top of the box, out at the bottom of the field, everything else insulated."""
    source = constant(20.0, "test")
    films = {"outer_warm": 400.0, "field_bottom": 300.0}
    rest = [Adiabatic(surface=s) for s in model.mesh.surfaces if s not in {*films, FOOT, SEAT}]
    hot = [Film(surface=s, kind="air", fluid_temperature=t, law=source) for s, t in films.items()]
    for body in ("shaft_pinion", "shaft_wheel"):
        name = f"{body}_warm"
        rest = [c for c in rest if c.surface != name]
        hot.append(Film(surface=name, kind="oil", fluid_temperature=350.0, law=source))
    return [
        *rest, *hot,
        Contact(surface_a=FOOT, surface_b=SEAT, kind="joint", law=constant(conductance, "test")),
    ]  # fmt: skip


def test_the_joint_passes_the_heat_of_its_mean_jump(model) -> None:
    steel = dict.fromkeys(model.mesh.bodies, 50.0)
    solution = solve_steady(ConductionSetup(model.mesh, steel), conditions(model, 100.0))
    rows = {row.surface: row for row in solution.balance.rows if row.kind == "joint"}
    assert rows[FOOT].power == pytest.approx(-rows[SEAT].power, rel=1e-12)
    jump = rows[FOOT].mean_temperature - rows[SEAT].mean_temperature
    assert rows[SEAT].power == pytest.approx(100.0 * exact_areas(JOINED)[FOOT] * jump, rel=1e-9)
    assert jump > 1.0
    sums = solution.balance.by_surface()
    assert rows[SEAT].power == pytest.approx(-sums["field_bottom"], rel=1e-6)


def test_a_very_good_joint_is_no_joint(model) -> None:
    """1e6 W/(m2 K) against shared nodes: mean temperatures within a fiftieth of a kelvin of 100 K."""
    bonded = build_gearbox(PROTOTYPE, "quick")
    steel = dict.fromkeys(model.mesh.bodies, 50.0)
    joined = solve_steady(ConductionSetup(model.mesh, steel), conditions(model, 1e6))
    without = [c for c in conditions(bonded, 1.0) if not isinstance(c, Contact)]
    shared = solve_steady(ConductionSetup(bonded.mesh, steel), without)
    for surface in ("outer_warm", "field_bottom"):
        means = [
            next(r.mean_temperature for r in s.balance.rows if r.surface == surface) for s in (joined, shared)
        ]
        assert means[0] == pytest.approx(means[1], abs=0.02)


def test_a_hot_box_slides_on_a_cold_field(model) -> None:
    """Box at +100 K, field cold: every length of the box grows freely, the field stays as it is."""
    field = np.unique(model.mesh.cells[model.mesh.bodies["field"]])
    temperature = np.full(len(model.mesh.points), 393.15)
    temperature[field] = 293.15
    shape = expand(
        ExpansionSetup(model, dict.fromkeys(model.mesh.bodies, STEEL)), temperature, 293.15, tolerance=1e-10
    )
    assert np.abs(shape.displacement[field]).max() < 1e-12
    assert shape.largest_reaction < 1e-2
    grown = 0.0995 * 12e-6 * 100.0
    assert shape.centre_distances[0].change == pytest.approx(grown, rel=1e-6)
    foot = FiniteElements(model.mesh).surfaces[FOOT]
    mean = [foot.mean(np.ascontiguousarray(shape.displacement[:, axis])) for axis in range(3)]
    assert mean == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)


def test_the_foot_follows_a_field_that_bends(model) -> None:
    """A field hotter above than below bows up; the box on it tilts with the mean of its seat."""
    z = model.mesh.points[:, 2]
    temperature = np.where(z < 0.0, 293.15 + 100.0 * (1.0 + z / 0.15), 393.15)
    box = np.unique(model.mesh.cells[model.mesh.bodies["housing"]])
    temperature[box] = 293.15
    shape = expand(
        ExpansionSetup(model, dict.fromkeys(model.mesh.bodies, STEEL)), temperature, 293.15, tolerance=1e-10
    )
    foot, seat = (np.unique(model.mesh.surfaces[name]) for name in (FOOT, SEAT))
    assert shape.displacement[seat, 2].mean() > 1e-5
    assert shape.displacement[foot, 2].mean() == pytest.approx(shape.displacement[seat, 2].mean(), rel=0.03)
    assert shape.centre_distances[0].change == pytest.approx(0.0, abs=1e-9)


def test_a_case_states_conductance_or_joint(tmp_path: Path) -> None:
    case = case_with(
        tmp_path,
        "[gearboxes.test.housing.foot_contact]\n"
        'conductance = { value = "100 W/(m2 K)", assumed = "box on shims", range = ["50 W/(m2 K)", "1000 W/(m2 K)"] }\n'
        "[gearboxes.test.bearings.pinion_front]\nshell_conductance = "
        '{ value = "28 W/(m2 K)", assumed = "loose shell" }\n',
    )
    rig = build_rig(case, "quick")
    (contact,) = foot_joint(rig, "test")
    assert (contact.surface_a, contact.surface_b, contact.kind) == (FOOT, SEAT, FOOT_CONTACT)
    coefficient = contact.law(350.0, 300.0)
    assert coefficient.value == pytest.approx(100.0) and coefficient.source == "assumed: box on shims"
    film = constant(1240.41, "P2, Formula 4")
    series = behind_shell(rig, "test", "bearing_bore_test_pinion_front", film)(300.0, 300.0)
    assert series.value == pytest.approx(1.0 / (1.0 / 1240.41 + 1.0 / 28.0))
    assert "assumed: loose shell" in series.source
    for other in ("bearing_bore_test_pinion_rear", "shaft_test_pinion_journal_front"):
        assert behind_shell(rig, "test", other, film) is film


def test_a_sensor_in_the_shell_reads_beyond_the_joint(tmp_path: Path) -> None:
    """One heat through film and joint: T_shell = T_wall + q / conductance, nearer to the film than the bore is."""
    case = case_with(tmp_path, "[gearboxes.test.bearings.pinion_front]\nshell_conductance = '500 W/(m2 K)'\n")
    rig = build_rig(case, "quick")
    bore, film, wall = "bearing_bore_test_pinion_front", 310.0, 330.0
    law = behind_shell(rig, "test", bore, constant(1000.0, "hand"))
    conditions = [Film(surface=bore, kind="bearing_film:pinion_front", fluid_temperature=film, law=law)]
    heat = (film - wall) / (1.0 / 1000.0 + 1.0 / 500.0)
    assert shell_temperature(bore, wall, conditions) == pytest.approx(wall + heat / 500.0)
    free = [Film(surface=bore, kind="x", fluid_temperature=film, law=constant(1000.0, "hand"))]
    assert shell_temperature(bore, wall, free) == wall
    assert shell_temperature("outer_top", wall, conditions) == wall


def test_a_pressed_joint_follows_its_pressure(tmp_path: Path) -> None:
    joint = (
        '[gearboxes.test.housing.foot_contact]\nremove = ["conductance"]\n'
        "[gearboxes.test.housing.foot_contact.joint]\n"
        'pressure = "1 MPa"\nroughness = "3 um"\nslope = 0.15\nhardness = "2 GPa"\n'
    )
    (dry,) = foot_joint(build_rig(case_with(tmp_path, joint), "quick"), "test")
    greased = case_with(tmp_path, joint + 'filling_conductivity = "0.15 W/(m K)"\n')
    (filled,) = foot_joint(build_rig(greased, "quick"), "test")
    spots = 1.25 * 50.0 * 0.15 / 3e-6 * (1e6 / 2e9) ** 0.95
    thickness = 1.53 * 3e-6 * (1e6 / 2e9) ** -0.097
    assert filled.law(300.0, 300.0).value == pytest.approx(spots + 0.15 / thickness, rel=1e-9)
    assert dry.law(300.0, 300.0).value == pytest.approx(spots + 0.0257 / (thickness + 0.37e-6), rel=0.01)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            '[gearboxes.test.housing.foot_contact]\nremove = ["conductance"]\n',
            "neither of conductance and joint",
        ),
        (
            '[gearboxes.test.housing.foot_contact]\nconductance = "100 W/(m2 K)"\n'
            '[gearboxes.test.housing.foot_contact.joint]\npressure = "1 MPa"\nroughness = "3 um"\nslope = 0.1\n'
            'hardness = "2 GPa"\n',
            "both of conductance and joint",
        ),
        (
            '[gearboxes.test.housing.foot_contact]\nremove = ["conductance"]\n'
            '[gearboxes.test.housing.foot_contact.joint]\npressure = "1 MPa"\nroughness = "0 um"\nslope = 0.1\n'
            'hardness = "2 GPa"\n',
            "roughness is zero",
        ),
        (
            '[gearboxes.test.housing.foot_contact]\nconductance = "100 W/(m2 K)"\n'
            '[gearboxes.test.housing.boundary.field_foot]\nsurfaces = ["field_bottom", "field_seat"]\n',
            "field_seat",
        ),
        ('[gearboxes.test.bearings.pinion_front]\nshell_conductance = "0 W/(m2 K)"\n', "shell_conductance"),
    ],
)  # fmt: skip
def test_bad_joints_are_refused_by_path(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(CaseError, match=said):
        case_with(tmp_path, text)
