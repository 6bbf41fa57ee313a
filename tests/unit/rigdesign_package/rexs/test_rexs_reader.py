from pathlib import Path

import pytest

from rigdesign.base.errors import RexsError, UsageError
from rigdesign.rexs.model import AttributeValueError, RexsModel
from rigdesign.rexs.reader import parse_rexs, read_rexs
from tests.builders.rexs import SUFFIXES, archive_of, changed, rexs_file


def values(model: RexsModel) -> list[object]:
    """Ids, types and values of all components, whatever the encoding."""
    return [
        (part.id, part.type, item.id, item.written()) for part in model.components for item in part.attributes
    ]


@pytest.mark.parametrize("version", ["1.0", "2.0"])
def test_three_encodings_hold_the_same_model(version: str) -> None:
    first, *others = (read_rexs(rexs_file(version, suffix)) for suffix in SUFFIXES)
    for other in others:
        assert values(other) == values(first)
        assert other.relations == first.relations
        assert [case.id for case in other.load_spectra[0].load_cases] == [1, 2]
        assert other.version == version


def test_relations_roles_and_load_cases() -> None:
    model = read_rexs(rexs_file())
    assert [part.id for part in model.related("assembly", "assembly", 3, "part")] == [5, 6, 7, 11, 27]
    assert [part.id for part in model.related("flank", "gear", 11, "left")] == [16]
    assert model.related("flank", "gear", 3, "left") == ()
    case = model.load_spectra[0].load_cases[1]
    assert [(part.id, len(part.attributes)) for part in case.components] == [(1, 1), (3, 1), (27, 1), (2, 1)]
    assert [part.id for part in model.load_spectra[0].accumulation] == [20]


def test_the_content_decides_not_the_name(tmp_path: Path) -> None:
    path = tmp_path / "unit.txt"
    for suffix in SUFFIXES:
        path.write_bytes(rexs_file(suffix=suffix).read_bytes())
        assert len(read_rexs(path).components) == 29


def test_byte_order_mark_name_space_and_utf_16() -> None:
    plain = read_rexs(rexs_file())
    spaced = changed(("<model ", '<model xmlns="https://www.rexs.info/rexs-file" '))
    wide = changed(('encoding="UTF-8"', 'encoding="UTF-16"')).decode().encode("utf-16")
    for content in (b"\xef\xbb\xbf" + changed(), b"\n  " + changed(), spaced, wide):
        assert values(parse_rexs(content, "unit")) == values(plain)


def attribute_of(xml: str) -> object:
    content = changed(('<attribute id="kind">oil', f'{xml}<attribute id="kind">oil'), version="1.0")
    return parse_rexs(content, "unit").component(28).attribute("probe")


def test_arrays_and_matrices_plain_and_coded() -> None:
    def value(inner: str) -> object:
        probe = attribute_of(f'<attribute id="probe" unit="mm">{inner}</attribute>')
        return probe.value  # type: ignore[attr-defined]

    assert value("<array><c>1</c><c>2.5</c></array>") == ("1", "2.5")
    assert value('<array code="float64">AAAAAAAAHEAAAAAAAAAgQA==</array>') == (7.0, 8.0)
    assert value('<array code="int32">AQAA\n AAIAAAA=</array>') == (1, 2)
    assert value('<array code="float32">AACAPw==</array>') == (1.0,)
    assert value("<matrix><r><c>1</c><c>2</c></r><r><c>3</c><c>4</c></r></matrix>") == (
        ("1", "2"),
        ("3", "4"),
    )
    assert value('<matrix code="float64" rows="2" columns="1">AAAAAAAAHEAAAAAAAAAgQA==</matrix>') == (
        (7.0,),
        (8.0,),
    )
    assert value("<array_of_arrays><array><c>1</c></array><array/></array_of_arrays>") == (("1",), ())
    assert value(" <!-- a remark --> text ") == "text"


@pytest.mark.parametrize(
    "inner",
    [
        '<array code="float64">AAAA</array>',
        '<array code="float64">no base64!</array>',
        '<array code="float16">AAAA</array>',
        '<matrix code="float64" rows="2" columns="2">AAAAAAAAHEA=</matrix>',
        '<matrix code="float64">AAAAAAAAHEA=</matrix>',
        '<matrix code="float64" rows="99999999999" columns="1">AAAAAAAAHEA=</matrix>',
    ],
)
def test_coded_numbers_that_do_not_fit(inner: str) -> None:
    with pytest.raises(RexsError, match=r"line \d+, attribute probe: .*; export"):
        attribute_of(f'<attribute id="probe">{inner}</attribute>')


def test_coded_numbers_in_json() -> None:
    def probe(value: str) -> object:
        content = changed(('"id": "kind",', f'"id": "probe", {value} }}, {{ "id": "kind",'), suffix="rexsj")
        return parse_rexs(content, "unit").component(28).attribute("probe").value  # type: ignore[union-attr]

    assert probe('"floating_point_array_coded": {"code": "float64", "value": "AAAAAAAAHEA="}') == (7.0,)
    matrix = '{"code": "float32", "value": "AACAPwAAgD8=", "rows": 1, "columns": 2}'
    assert probe(f'"floating_point_matrix_coded": {matrix}') == ((1.0, 1.0),)
    assert probe('"floating_point_array": null') is None
    assert probe('"kind_of_the_future": [1]') is None
    with pytest.raises(RexsError, match="no object with code and value"):
        probe('"floating_point_array_coded": [1.0]')


@pytest.mark.parametrize("text", ["4,5", "nan", "inf", "1_000", "", "true", "٣", "4.5 mm", "1e9999"])
def test_what_is_no_number(text: str) -> None:
    probe = attribute_of(f'<attribute id="probe">{text}</attribute>')
    with pytest.raises(AttributeValueError, match="where a"):
        probe.number()  # type: ignore[attr-defined]


def test_files_that_cannot_be_opened(tmp_path: Path) -> None:
    for path in (tmp_path, tmp_path / "none.rexs", Path("/dev/zero")):
        with pytest.raises(UsageError, match="give a REXS file"):
            read_rexs(path)


def test_a_broken_file_is_named_with_its_entry(tmp_path: Path) -> None:
    path = tmp_path / "unit.rexsz"
    path.write_bytes(archive_of({"inner/model.rexs": b"<model"}))
    with pytest.raises(RexsError, match=r"unit\.rexsz:inner/model\.rexs: line 1"):
        read_rexs(path)
