"""Files that are no REXS, or contradict themselves: the error names file, place and remedy."""

import pytest

from rigdesign.base.errors import RexsError
from rigdesign.rexs import model as consistency
from rigdesign.rexs import reader as xml_tree
from rigdesign.rexs.reader import parse_rexs
from tests.builders.rexs import changed, rexs_file

LAUGHS = (
    b'<?xml version="1.0"?><!DOCTYPE model [<!ENTITY a "ha">'
    + b"".join(b'<!ENTITY %c "&%c;&%c;&%c;&%c;&%c;&%c;&%c;&%c;">' % (b, *[b - 1] * 8) for b in range(98, 110))
    + b']><model version="2.0">&m;</model>'
)
OUTSIDE = b'<!DOCTYPE model [<!ENTITY x SYSTEM "file:///etc/passwd">]><model version="2.0">&x;</model>'


def refusal(content: bytes) -> str:
    with pytest.raises(RexsError) as caught:
        parse_rexs(content, "unit.rexs")
    assert caught.value.exit_code == 2
    text = str(caught.value)
    assert text.startswith("unit.rexs: ")
    assert "; " in text
    return text


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "an empty file"),
        (b"  \n", "an empty file"),
        (b"solid cube\n", "neither XML nor JSON"),
        (b"%PDF-1.7", "a PDF document"),
        (b"\x89PNG\r\n", "a PNG picture"),
        (b"\x00" * 100, "neither XML nor JSON"),
        (b"<html></html>", "<html>: a web page"),
        (b"<rexsSchema/>", "the REXS database, not a model"),
        (b"<model/>", "version: not one of REXS 1.0 to 1.7 and 2.0"),
        (b'<model version="3.1"/>', "version = 3.1: not one of"),
        (b'<model version="1.4"/>', "a model without components"),
        (b"[]", "no object with the key 'model'"),
        (b'{"model": []}', "no object with the key 'model'"),
        (b'{"model": {}}', "version: not one of"),
        (b'{"model": {"version": 2.0}}', "version: not one of"),
        (b'{"model": {"version": "2.0", "components": {}}}', "components: no list"),
        (b'{"model": {"version": "2.0", "components": [1]}}', "components[0] = 1: no object"),
        (b'{"model": NaN}', "NaN is no number of JSON"),
        (b"[" * 200_000, "nested too deep"),
        (b'{"a": ' + b"9" * 5000 + b"}", "a number that cannot be read"),
        (b'{"a": "\xff"}', "no UTF-8 text"),
        (b"<?xml version='1.0' encoding='utf-7'?><model/>", "an encoding that is not known"),
        (LAUGHS, "document type declaration"),
        (OUTSIDE, "document type declaration"),
        (b"<model>&nothing;</model>", "no well-formed XML"),
        (b"<a>" * 30, "nested deeper than 20"),
    ],
)
def test_what_is_no_rexs(content: bytes, words: str) -> None:
    assert words in refusal(content)


@pytest.mark.parametrize("suffix", ["rexs", "rexsj"])
@pytest.mark.parametrize("share", [0.01, 0.3, 0.77, 0.999])
def test_a_truncated_file_says_where_it_ends(suffix: str, share: float) -> None:
    content = rexs_file(suffix=suffix).read_bytes()
    text = refusal(content[: int(share * len(content))])
    assert "line " in text
    assert "the file ends too early" in text
    assert "export the model again" in text


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('<component id="12"', '<component id="11"', "component 11: the id occurs 2 times"),
        ('<component id="12"', '<component id="1.5"', "component, id = 1.5: no whole number"),
        ('<component id="12"', "<component", "component, id: missing"),
        ('id="12" type="cylindrical_gear"', 'id="12"', "component, type: missing"),
        ('<relation id="2"', '<relation id="1"', "relation 1: the id occurs 2 times"),
        ('<ref id="29"', '<ref id="99"', "role 'referenced' = 99: no component has this id"),
        ('role="gear_1"', "", "ref, role: missing"),
        ('<component id="27" type="external_load">', '<component id="77">', "load_case 1, component = 77"),
        ('<load_case id="2">', '<load_case id="1">', "load_case 1: the id occurs 2 times"),
        ('<attribute id="face_width"', "<attribute", "attribute, id: missing"),
    ],
)
def test_a_file_that_contradicts_itself(old: str, new: str, words: str) -> None:
    assert words in refusal(changed((old, new)))


def test_all_faults_at_once_up_to_a_limit() -> None:
    text = refusal(changed(('<component id="', '<component id="x')))
    assert "unit.rexs: 20 faults" in text


def test_names_of_a_file_cannot_steer_a_terminal() -> None:
    content = changed(
        ('"id": 1,\n    "type": "gear_unit"', '"id": "\\u001b[2J\\ud800", "type": "gear_unit"'),
        suffix="rexsj",
    )
    text = refusal(content)
    assert "\x1b" not in text
    text.encode()


def test_elements_without_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(xml_tree, "MOST_ELEMENTS", 1000)
    text = refusal(b'<model version="2.0"><components>' + b"<c/>" * 2000)
    assert "more than 1000 elements" in text


def test_load_cases_without_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(consistency, "MOST_STATES", 7)
    assert "2 load cases of 4 shafts and loads, above the limit of 7 states; export a cl" in refusal(
        changed()
    )


@pytest.mark.parametrize("text", [b"<model>a & b</model>", b"<\x8f\x01", b'<model a="<"/>'])
def test_text_that_is_no_xml_is_not_called_truncated(text: bytes) -> None:
    said = refusal(text)
    assert "no well-formed XML" in said and "too early" not in said
