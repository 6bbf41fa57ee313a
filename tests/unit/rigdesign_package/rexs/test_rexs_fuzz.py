"""Whatever is done to a REXS file: our error, or a gear unit that accounts for every attribute."""

import json
from copy import deepcopy
from typing import Any

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rigdesign.base.errors import RexsError
from rigdesign.rexs.gear_unit_import import import_gear_unit
from rigdesign.rexs.reader import parse_rexs
from tests.builders.rexs import SUFFIXES, rexs_file

FUZZ = settings(
    max_examples=100, deadline=2000, suppress_health_check=[HealthCheck.too_slow], derandomize=True
)
FILES = [rexs_file(version, suffix).read_bytes() for version in ("1.0", "2.0") for suffix in SUFFIXES]
JSON = [json.loads(rexs_file(version, "rexsj").read_bytes()) for version in ("1.0", "2.0")]
PIECES = st.one_of(
    st.binary(max_size=8),
    st.sampled_from(
        [b"<", b">", b'"', b"</component>", b"<c/>", b"&#x1b;", b"]]>", b"1e400", b"-1", b"null", b"{", b"PK"]
    ),
)
VALUES: st.SearchStrategy[Any] = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(allow_nan=False, allow_infinity=False), st.text(max_size=5),
    st.sampled_from([0, -1, 10**400, 1e308, "mm", "none", "°", "cylindrical_gear", [], {}, [[]], [1], {"a": 1}]),
)  # fmt: skip


def import_or_refuse(content: bytes) -> None:
    try:
        model = parse_rexs(content, "unit")
    except RexsError as error:
        str(error).encode()
        return
    result = import_gear_unit(model)
    spectra = [part for item in model.load_spectra for case in item.load_cases for part in case.components]
    sums = [part for item in model.load_spectra for part in item.accumulation]
    written = sum(len(part.attributes) for part in (*model.components, *spectra, *sums))
    assert len(result.mapped) + len(result.listed) == written
    repr(result).encode()


@FUZZ
@given(st.data())
def test_bytes_changed_cut_and_put_in(data: st.DataObject) -> None:
    content = data.draw(st.sampled_from(FILES))
    for _ in range(data.draw(st.integers(1, 4))):
        start = data.draw(st.integers(0, len(content)))
        end = min(len(content), start + data.draw(st.sampled_from([0, 0, 1, 2, 40, 4000])))
        content = content[:start] + data.draw(PIECES) + content[end:]
    import_or_refuse(content)


@FUZZ
@given(st.data())
def test_values_and_keys_of_json_changed(data: st.DataObject) -> None:
    document = json.loads(json.dumps(data.draw(st.sampled_from(JSON))))
    for _ in range(data.draw(st.integers(1, 6))):
        change_somewhere(document, data)
    import_or_refuse(json.dumps(document).encode())


@FUZZ
@given(st.data())
def test_values_of_xml_changed(data: st.DataObject) -> None:
    text = FILES[data.draw(st.sampled_from([0, 3]))].decode()
    for _ in range(data.draw(st.integers(1, 6))):
        quotes = [index for index, letter in enumerate(text) if letter in '">']
        start = data.draw(st.sampled_from(quotes)) + 1
        end = min((at for at in (text.find(mark, start) for mark in '"<') if at >= 0), default=len(text))
        new = data.draw(
            st.sampled_from(["", "0", "-5", "1e300", "99999999999", "deg", "none", "shaft", "true", "4,5"])
        )
        text = text[:start] + new + text[end:]
    import_or_refuse(text.encode())


def change_somewhere(document: Any, data: st.DataObject) -> None:
    """Replace, remove or double one item of a nested document."""
    place = document
    while True:
        keys = list(place) if isinstance(place, dict) else list(range(len(place)))
        if not keys:
            return
        key = data.draw(st.sampled_from(keys))
        if not isinstance(place[key], dict | list) or data.draw(st.integers(0, 9)) == 0:
            break
        place = place[key]
    action = data.draw(st.sampled_from(["replace", "replace", "remove", "double"]))
    if action == "remove":
        del place[key]
    elif action == "double" and isinstance(place, list):
        place.append(deepcopy(place[key]))
    else:
        place[key] = deepcopy(data.draw(VALUES))
