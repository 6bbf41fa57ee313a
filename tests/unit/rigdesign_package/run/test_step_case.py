"""A case whose housing is a STEP file, end to end: faces by name and rule, field, clearances, picture, refusals."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from rigdesign import load_case
from rigdesign.base.errors import CaseError
from rigdesign.case.model import Case
from rigdesign.cli import exit_status as ending
from rigdesign.cli import main as cli
from rigdesign.coupling.loop import solve_point
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.model import build_rig
from rigdesign.run.main import run_case
from tests.builders import step_housing
from tests.builders.msh_file import write_msh
from tests.builders.paths import CASES
from thermal.fe.mesh import NamedMesh
from thermal.housing.mesh_file import read_mesh
from thermal.housing.step_file import read_step

STEP_CASE = CASES.parent / "tests" / "step_housing" / "case.toml"
AT = "gearboxes.test.housing"
FLOOR = (
    "[gearboxes.test.housing.faces]\n"
    'chamber_floor = [{{ plane = {{ point = ["0 mm", "0 mm", "{0} mm"], normal = [0, 0, 1] }}{1} }}]\n'
)
INSIDE = ', box = { low = ["30 mm", "-128 mm", "0 mm"], high = ["146 mm", "128 mm", "100 mm"] }'


def variant(folder: Path, step: Path | str, body: str = "") -> Case:
    """The shipped case with another STEP file."""
    file = folder / "case.toml"
    file.write_text(
        f'extends = "{STEP_CASE.as_posix()}"\n[gearboxes.test.housing]\nstep_file = "{Path(step).as_posix()}"\n{body}'
    )
    return load_case(file)


def refused(case: Case, *words: str) -> None:
    with pytest.raises(CaseError) as error:
        _ = build_rig(case, "quick").models
    for word in words:
        assert word in str(error.value)


NARROW_CURVE = {
    "numerics.curve_speed_start": "1700 rpm",
    "numerics.curve_speed_end": "1750 rpm",
    "limits.bearing.start_torque_limit": "400 N m",
}
"""Off the resonances, errors of the checks at the held stage alone: nothing here reads either."""


@pytest.mark.whole_run
def test_a_rig_with_a_step_housing_is_solved_with_its_clearances() -> None:
    """Gears near those of the parametric box with partitions (126 degC), bearings and end seals read from the part."""
    result = run_case(load_case(STEP_CASE).with_values(NARROW_CURVE), "quick")
    (thermal,) = result.thermal
    assert abs(thermal.closure_relative) < 1e-6
    assert thermal.bodies.keys() == {
        "housing", "shaft_test_pinion", "shaft_test_wheel", "gear_test_pinion", "gear_test_wheel",
    }  # fmt: skip
    assert thermal.bodies["gear_test_pinion"].mean - 273.15 == pytest.approx(126.0, abs=8.0)
    assert {row.surface for row in thermal.heat} >= step_housing.rules().keys()
    (expansion,) = result.expansion
    assert [gap["seal"] for gap in expansion.seal_gaps] == ["test_pinion_rear_end", "test_wheel_rear_end"]
    assert all(0.0 < row["diametral_clearance_hot_um"] < 80.0 for row in expansion.bearings)


def test_the_shipped_part_has_the_names_of_the_rules(tmp_path: Path) -> None:
    mesh = build_rig(load_case(STEP_CASE), "quick").models["test"].mesh
    names = {name for name in mesh.surfaces if not name.startswith(("shaft_", "gear_"))}
    assert names == step_housing.rules().keys()


def test_faces_without_a_name_get_one_by_rule(tmp_path: Path) -> None:
    rules = step_housing.rules()
    del rules["chamber_floor"]
    file = step_housing.named(step_housing.draw(tmp_path), rules)
    bare = variant(tmp_path, "housing.step")
    refused(bare, f'{AT}.step_file = "housing.step"', "1 faces without a name", "(88, 0, 15) mm", "numbers")
    refused(
        variant(tmp_path, file, FLOOR.format(20, "")),
        "2 faces with two names",
        "is outer_warm and chamber_floor",
    )
    refused(variant(tmp_path, file, FLOOR.format(16, "")), "rule 1 of faces.chamber_floor picks no face")
    found = build_rig(variant(tmp_path, file, FLOOR.format(15, INSIDE)), "quick").models["test"].mesh
    assert "chamber_floor" in found.surfaces


def test_the_picture_is_drawn_before_all_faces_have_names(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rules = step_housing.rules()
    del rules["chamber_floor"]
    step_housing.named(step_housing.draw(tmp_path), rules)
    variant(tmp_path, "housing.step")
    for case, written in ((tmp_path, ["test_faces.png"]), (STEP_CASE, ["test.msh", "test_faces.png"])):
        out = tmp_path / f"out_{len(written)}"
        tokens = ["mesh", str(case), "--fidelity", "quick", "--out", str(out)]
        assert ending.exit_status(lambda tokens=tokens: cli.app(tokens, result_action="return_value")) == 0
        assert sorted(path.name for path in out.iterdir()) == written
    told = capsys.readouterr().out
    assert "30 faces, no name: 24" in told and "30 faces, all named" in told
    assert (tmp_path / "out_1" / "test_faces.png").stat().st_size > 50_000
    assert "shaft_test_wheel" in read_mesh(tmp_path / "out_2" / "test.msh").bodies


def test_parts_of_another_size_or_kind_are_faults_of_the_key(tmp_path: Path) -> None:
    refused(variant(tmp_path, "gone.step"), f'{AT}.step_file = "gone.step"', "correct the path of the file")
    step_housing.draw(tmp_path, "inch.step", unit="INCH")
    inch = ("height is 5588 mm, housing.height 220 mm", "scale the part by 0.03", "check its unit")
    refused(variant(tmp_path, "inch.step"), *inch)
    step_housing.draw(tmp_path, "two.step", solids=2)
    refused(variant(tmp_path, "two.step"), "holds 2 solids", "export the housing alone")


@pytest.mark.parametrize(
    ("scale", "words"),
    [
        (10.0, ("width is 3200 mm, housing.width 280 mm", "scale the part by 0.1:")),
        (2.54, ("height is 558.8 mm, housing.height 220 mm", "scale the part by 0.3937:")),
        (
            1 / 2.54,
            ("bearing_bore_test_pinion_front is 11.83 mm, its bearing 30.05 mm", "scale the part by 2.54:"),
        ),
        (
            1.2,
            (
                "bearing_bore_test_wheel_front is 109.8 mm, that of their axes 91.5 mm",
                "scale the part by 0.8333:",
            ),
        ),
        ((1.0, 1.0, 2.5), ("height is 550 mm, housing.height 220 mm", "check its unit, its axes")),
    ],
)
def test_a_mesh_of_another_size_is_refused_with_both_sizes_and_the_factor(
    scale: float | tuple[float, float, float], words: tuple[str, ...], tmp_path: Path
) -> None:
    """The same measures as of a STEP file: decimetres, inches, and every axis by itself."""
    part = read_part_mesh()
    scaled = replace(part, points=part.points * np.asarray(scale))
    write_msh(scaled, tmp_path / "housing.msh")
    text = STEP_CASE.read_text().replace('step_file = "housing.step"', 'mesh_file = "housing.msh"')
    (tmp_path / "case.toml").write_text(text)
    refused(load_case(tmp_path / "case.toml"), f'{AT}.mesh_file = "housing.msh"', *words)


@cache
def read_part_mesh() -> NamedMesh:
    """The shipped part as a coarse mesh."""
    return read_step(STEP_CASE.parent / "housing.step", {}, 0.1, 8)


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ('mesh_file = "box.msh"\n', ("mesh_file and step_file both stand for the box", "remove one")),
        ('mesh = { seals = "5 mm" }\n', ("element sizes of seal do nothing to a STEP file", "walls")),
        (
            "[gearboxes.test.housing.faces]\nlid = [{}]\n",
            ("says nothing of its faces", "add plane, cylinder or box"),
        ),
        (
            '[gearboxes.test.housing.faces]\nlid = [{ cylinder = { point = ["0 mm", "0 mm", "0 mm"], '
            'direction = [0, 0, 0], radius = "5 mm" } }]\n',
            ("direction = [0.0, 0.0, 0.0] has no length",),
        ),
    ],
)
def test_keys_that_do_not_go_together(body: str, words: tuple[str, ...], tmp_path: Path) -> None:
    with pytest.raises(CaseError) as error:
        variant(tmp_path, "housing.step", body)
    for word in words:
        assert word in str(error.value)


def test_shafts_beside_their_bores_leave_the_heat_and_take_the_clearances(tmp_path: Path) -> None:
    """The part is drawn 110 mm above its foot, the case says 115 mm."""
    file = STEP_CASE.parent / "housing.step"
    model = build_rig(variant(tmp_path, file, 'shaft_height = "115 mm"\n'), "quick").models["test"]
    assert "clearances need bores round their journals: bearing_bore_test_pinion_front" in model.no_expansion
    assert "110) mm" in model.no_expansion and "115) mm" in model.no_expansion
    assert not model.bearings


def test_a_foot_contact_draws_the_field_under_the_part(tmp_path: Path) -> None:
    """The field takes heat through the whole foot, flange included, and carries the housing."""
    file = STEP_CASE.parent / "housing.step"
    body = (
        'foot_contact = { conductance = "2000 W/(m2 K)" }\n'
        '[gearboxes.test.housing.boundary]\nremove = ["foot"]\n'
        'field = { surfaces = ["field_top", "field_sides"], law = "recknagel_plate" }\n'
        'bottom = { surfaces = ["field_bottom"], law = "insulated" }\n'
    )
    rig = build_rig(variant(tmp_path, file, body), "quick")
    model = rig.models["test"]
    assert (model.no_expansion, model.fixed_body, model.foot_surface) == ("", "field", "field_bottom")
    seat = model.mesh.points[model.mesh.surfaces["field_seat"]].reshape(-1, 3)
    assert (seat.min(axis=0), seat.max(axis=0)) == (
        pytest.approx([0.0, -0.16, 0.0], abs=1e-9), pytest.approx([0.176, 0.16, 0.0], abs=1e-9),
    )  # fmt: skip
    last = solve_point(rig, held_points(rig)[-1]).last
    heat = last.fields["test"].solution.balance
    through = [row.power for row in heat.rows if row.surface == "field_seat"]
    assert sum(through) == pytest.approx(
        -heat.by_surface()["field_top"] - heat.by_surface()["field_sides"], rel=1e-4
    )
    assert 5.0 < sum(through) < 500.0
    assert not any("foot_contact" in record.path for record in rig.case.assumptions)
