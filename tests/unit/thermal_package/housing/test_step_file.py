"""A housing from a STEP file: names of faces in the file or by rules, its mesh, and what is refused."""

import math
from pathlib import Path

import numpy as np
import pytest

from tests.builders import step_housing
from tests.builders.housing import area
from thermal.fe.mesh import MeshError
from thermal.housing import step_file
from thermal.housing.face_rules import Box, Cylinder, FaceRule, FaceRuleError, Plane
from thermal.housing.stations import fit_cylinder
from thermal.housing.step_file import listed_faces, named_faces, read_part, read_step

SIZE, CIRCLE = 0.03, 10


@pytest.fixture(scope="module")
def part(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The housing without names."""
    return step_housing.draw(tmp_path_factory.mktemp("step"))


@pytest.fixture(scope="module")
def named_part(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The housing with all names in the file."""
    return step_housing.named(step_housing.draw(tmp_path_factory.mktemp("named")))


def message(path: Path, rules: dict[str, tuple[FaceRule, ...]] | None = None) -> str:
    """What is said of a file that is refused."""
    with pytest.raises(MeshError) as error:
        read_step(path, rules or {}, SIZE, CIRCLE)
    return str(error.value)


def test_names_of_the_file_and_rules_make_the_same_mesh(part: Path, named_part: Path) -> None:
    by_name, by_rule = (
        read_step(named_part, {}, SIZE, CIRCLE),
        read_step(part, step_housing.rules(), SIZE, CIRCLE),
    )
    assert by_name.bodies.keys() == {"housing"}
    assert np.array_equal(by_name.points, by_rule.points)
    assert by_name.surfaces.keys() == by_rule.surfaces.keys() == step_housing.rules().keys()
    for surface, nodes in by_name.surfaces.items():
        assert np.array_equal(nodes, by_rule.surfaces[surface])


def test_the_mesh_is_the_drawing_in_metres(named_part: Path) -> None:
    mesh = read_step(named_part, {}, SIZE, CIRCLE)
    assert np.ptp(mesh.points, axis=0) == pytest.approx([0.176, 0.320, 0.220], abs=1e-9)
    assert area(mesh, "chamber_floor") == pytest.approx(0.116 * 0.256, rel=1e-9)
    assert area(mesh, "housing_foot") == pytest.approx(0.176 * 0.320, rel=1e-9)
    # some arcs of elements flat against the wall are straightened; each such edge loses 1.6 % of its own arc
    assert area(mesh, "bearing_bore_test_wheel_rear") == pytest.approx(math.tau * 0.015025 * 0.023, rel=5e-3)
    bore = fit_cylinder(mesh.points[np.unique(mesh.surfaces["bearing_bore_test_pinion_front"][:, :3])])
    assert (bore.radius, bore.length) == pytest.approx((0.015025, 0.023), rel=1e-6)
    assert bore.centre == pytest.approx((0.0185, -0.04575, 0.110), abs=1e-7)


def test_faces_are_told_by_number_kind_place_and_size(part: Path) -> None:
    rules = step_housing.rules()
    del rules["chamber_floor"], rules["bearing_bore_test_wheel_front"]
    text = message(part, rules)
    assert "2 faces without a name" in text
    assert "plane about (88, 0, 15) mm, 297 cm2, normal (0, 0, 1)" in text
    assert "cylinder about (18.5, 45.75, 110) mm, 21.71 cm2, radius 15.03 mm" in text
    assert text.endswith("draws the part with these numbers")


def test_a_face_with_two_names_and_a_rule_without_a_face_are_told_at_once(named_part: Path) -> None:
    top = FaceRule((Plane((0.0, 0.0, 0.22), (0.0, 0.0, 2.0)),))
    nowhere = FaceRule((Cylinder((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), 0.5),))
    text = message(named_part, {"lid": (top, nowhere)})
    assert "rule 2 of faces.lid picks no face" in text
    assert "1 faces with two names" in text and "is outer_warm and lid" in text


def test_a_name_stays_with_its_face_in_any_order(named_part: Path, tmp_path: Path) -> None:
    """Two faces swapped in the shell, and a comment that looks like another solid."""
    text = named_part.read_text(encoding="latin-1")
    start = text.index("CLOSED_SHELL('',(") + len("CLOSED_SHELL('',(")
    end = text.index("))", start)
    order = text[start:end].split(",")
    swapped = tmp_path / "swapped.step"
    changed = text[:start] + ",".join([order[1], order[0], *order[2:]]) + text[end:]
    swapped.write_text(changed.replace("DATA;", "DATA;\n/* #99999 = MANIFOLD_SOLID_BREP('',#16); */", 1))
    found = {face.name: face for face in read_part(swapped, {}, 0.1).faces}
    assert found["outer_end_front"].centre[0] == pytest.approx(0.0, abs=1e-9)
    assert found["outer_end_front"].number == 2


def test_names_that_do_not_fit_their_faces_are_refused(
    named_part: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(step_file, "listed_faces", lambda text: listed_faces(text)[::-1])
    assert "its 30 listed faces are not the 30 of the part" in message(named_part)
    monkeypatch.setattr(step_file, "listed_faces", lambda text: listed_faces(text)[:-1])
    assert "its 29 listed faces are not the 30 of the part" in message(named_part)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("solid ascii stl", ("no STEP file", "export the part as STEP")),
        ("ISO-10303-21;\nHEADER;\nENDSEC;\n", ("END-ISO-10303-21 is missing", "cut short")),
    ],
)
def test_files_that_are_no_step_or_cut_short(content: str, words: tuple[str, ...], tmp_path: Path) -> None:
    file = tmp_path / "part.step"
    file.write_text(content)
    text = message(file)
    for word in words:
        assert word in text


def test_parts_that_are_not_one_closed_solid(tmp_path: Path) -> None:
    assert "no such file" in message(tmp_path / "gone.step").lower()
    two = message(step_housing.draw(tmp_path, "two.step", solids=2))
    assert (
        "holds 2 solids" in two and "1 cm3 about (357, 5, 5) mm" in two and "export the housing alone" in two
    )
    opened = message(step_housing.draw(tmp_path, "open.step", opened=True))
    assert "29 faces that enclose no solid" in opened and "close the part" in opened


def test_a_drawing_in_inches_comes_out_in_metres(tmp_path: Path) -> None:
    """Numbers of millimetres drawn as inches: 25.4 times as large, whatever the file is written in."""
    part = read_part(step_housing.draw(tmp_path, unit="INCH"), {}, 2.0)
    assert max(face.points[:, 2].max() for face in part.faces) == pytest.approx(0.220 * 25.4, rel=1e-6)


def test_rules_that_pick_nothing_by_themselves_are_refused() -> None:
    with pytest.raises(FaceRuleError, match="normal of a plane"):
        Plane((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    with pytest.raises(FaceRuleError, match="radius of a cylinder"):
        Cylinder((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), 0.0)
    with pytest.raises(FaceRuleError, match="swap the corners"):
        Box((1.0, 0.0, 0.0), (0.0, 1.0, 1.0))


def test_a_round_face_is_no_cylinder_by_its_edge(part: Path) -> None:
    """The cover of a blind bore ends on the circle of the bore, and its middle does not."""
    faces = read_part(part, {}, 0.1).faces
    wide = FaceRule((Cylinder((0.0, 0.04575, 0.110), (1.0, 0.0, 0.0), 0.015025),))
    (numbers,) = named_faces(faces, {"bore": (wide,)}).surfaces.values()
    assert {faces[number - 1].kind for number in numbers} == {"Cylinder"} and len(numbers) == 2
