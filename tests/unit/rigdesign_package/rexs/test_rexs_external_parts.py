"""A wheel shaft that stands in another file of the folder of the model."""

from pathlib import Path

import pytest

from rigdesign.base.errors import RexsError
from rigdesign.rexs import external_parts
from rigdesign.rexs.gear_unit_import import import_gear_unit
from rigdesign.rexs.reader import read_rexs
from tests.builders.rexs import changed

SHAFT = """<?xml version="1.0"?>
<model version="1.5">
  <relations>
    <relation id="1" type="assembly"><ref id="30" role="assembly"/><ref id="31" role="part"/></relation>
    <relation id="2" type="reference"><ref id="30" role="origin"/><ref id="32" role="referenced"/></relation>
    <relation id="3" type="reference"><ref id="40" role="origin"/><ref id="32" role="referenced"/></relation>
  </relations>
  <components>
    <component id="30" type="shaft" name="of the catalogue">
      <attribute id="mean_operating_temperature" unit="C">70</attribute>
      <attribute id="support_vector" unit="mm"><array><c>9</c><c>9</c><c>9</c></array></attribute>
    </component>
    <component id="31" type="shaft_section" name="">
      <attribute id="u_coordinate_on_shaft" unit="mm">135</attribute><attribute id="length" unit="mm">20</attribute>
      <attribute id="outer_diameter_begin" unit="mm">28</attribute>
    </component>
    <component id="32" type="material" name="42CrMo4"/>
    <component id="40" type="shaft" name="another"/>
  </components>
</model>
"""


def write(folder: Path, shaft: str = SHAFT, source: str = "./shaft.rexs", number: str = "30") -> Path:
    """Model and shaft file in a folder."""
    inserted = (
        '<component id="4" type="shaft" name="wheel shaft">',
        f'<component id="4" type="shaft" name="wheel shaft"><attribute id="data_source">{source}</attribute>'
        f'<attribute id="referenced_component_id">{number}</attribute>',
    )
    path = folder / "unit.rexs"
    path.write_bytes(changed(inserted))
    (folder / "shaft.rexs").write_text(shaft)
    return path


def test_the_shaft_and_what_belongs_to_it(tmp_path: Path) -> None:
    model = read_rexs(write(tmp_path))
    result = import_gear_unit(model)
    shaft = result.unit.shaft(4)
    assert len(model.components) == 31
    assert [section.outer_end for section in shaft.sections] == [0.03, 0.036, 0.03, 0.028]
    assert shaft.origin == (0.0, 0.0, -0.0915)
    assert [material.name for material in result.unit.materials] == ["16MnCr5", "42CrMo4"]
    assert not any(item.attribute == "data_source" for item in result.listed)
    assert not any(item.reason.startswith("stated twice") for item in result.listed)


@pytest.mark.parametrize("source", ["./none.rexs", "x" * 5000, "."])
def test_a_file_that_is_not_there_is_listed(tmp_path: Path, source: str) -> None:
    result = import_gear_unit(read_rexs(write(tmp_path, source=source)))
    listed = {item.attribute: item.reason for item in result.listed if item.component == 4}
    assert (
        listed["data_source"]
        == "the component stands in another file, which is not in the folder of the model"
    )
    assert len(result.unit.shaft(4).sections) == 3


@pytest.mark.parametrize("source", ["../shaft.rexs", "/etc/passwd", "inner/../../shaft.rexs"])
def test_a_file_outside_the_folder(tmp_path: Path, source: str) -> None:
    with pytest.raises(
        RexsError, match=r"component 4, data_source = .*: a file outside the folder; put the file"
    ):
        read_rexs(write(tmp_path, source=source))


def test_a_link_that_leads_out(tmp_path: Path) -> None:
    inner = tmp_path / "inner"
    inner.mkdir()
    path = write(inner, source="link.rexs")
    (tmp_path / "shaft.rexs").write_text(SHAFT)
    (inner / "link.rexs").symlink_to(tmp_path / "shaft.rexs")
    with pytest.raises(RexsError, match="a file outside the folder"):
        read_rexs(path)


@pytest.mark.parametrize(
    ("number", "words"),
    [
        ("99", "99: no such component in"),
        ("32", "32: a material there in"),
        ("x", "x where a number belongs"),
    ],
)
def test_a_component_that_does_not_fit(tmp_path: Path, number: str, words: str) -> None:
    with pytest.raises(RexsError, match=words):
        read_rexs(write(tmp_path, number=number))


def test_a_broken_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(RexsError, match=r"shaft\.rexs: line 5.*the file ends too early"):
        read_rexs(write(tmp_path, shaft=SHAFT[:200]))


def test_files_that_refer_to_each_other(tmp_path: Path) -> None:
    itself = SHAFT.replace(
        'name="of the catalogue">',
        'name=""><attribute id="data_source">shaft.rexs</attribute>'
        '<attribute id="referenced_component_id">30</attribute>',
    )
    with pytest.raises(RexsError, match="files that refer to each other over more than 5 levels"):
        read_rexs(write(tmp_path, shaft=itself))


@pytest.mark.parametrize(("limit", "most"), [("MOST_COMPONENTS", 30), ("MOST_PARTS", 0)])
def test_more_than_a_model_has(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, limit: str, most: int
) -> None:
    monkeypatch.setattr(external_parts, limit, most)
    with pytest.raises(RexsError, match=f"more than .*{most} "):
        read_rexs(write(tmp_path))
