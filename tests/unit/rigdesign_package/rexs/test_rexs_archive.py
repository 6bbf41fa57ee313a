import io
import zipfile

import pytest

from rigdesign.base.errors import RexsError
from rigdesign.rexs import reader as archive_module
from rigdesign.rexs.reader import model_in_archive, parse_rexs
from tests.builders.rexs import archive_of, changed


def refusal(content: bytes) -> str:
    with pytest.raises(RexsError) as caught:
        model_in_archive(content, "unit.rexsz")
    return str(caught.value)


def test_the_model_among_other_files() -> None:
    entries = {"a/b/unit.REXS": changed(), "gear.gde": b"", "__MACOSX/._unit.rexs": b"\x00", "._x.rexs": b""}
    name, content = model_in_archive(archive_of(entries), "unit.rexsz")
    assert (name, content) == ("a/b/unit.REXS", changed())


@pytest.mark.parametrize(
    "name", ["/etc/unit.rexs", "../unit.rexs", "a/../../unit.rexs", "C:\\x.rexs", "a\\..\\u.rexs"]
)
def test_names_that_lead_out(name: str) -> None:
    assert "leads out of the archive" in refusal(archive_of({name: b"<model/>"}))


@pytest.mark.parametrize("name", ["inner.zip", "inner.REXSZ", "data.tar.gz"])
def test_archives_in_it(name: str) -> None:
    assert "an archive in the archive" in refusal(archive_of({"unit.rexs": b"<model/>", name: b""}))


def test_an_archive_that_calls_itself_a_model() -> None:
    inner = archive_of({"unit.rexs": b"<model/>"})
    assert "an archive in the archive" in refusal(archive_of({"unit.rexs": inner}))


def test_a_bomb_by_ratio_and_by_size() -> None:
    assert "its packed size, above the limit of 200" in refusal(archive_of({"unit.rexs": b" " * 20_000_000}))
    many = archive_of({f"{index}.txt": b" " * 8_000_000 for index in range(9)})
    assert "72 MB unpacked, above the limit of 64 MB" in refusal(many)


def test_a_header_that_understates_the_size(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(archive_module, "MOST_BYTES", 100_000)
    content = bytearray(archive_of({"unit.rexs": b"<!-- -->" * 100_000}))
    entry = content.index(b"PK\x01\x02")
    content[entry + 24 : entry + 28] = (500).to_bytes(4, "little")
    assert "a damaged archive" in refusal(bytes(content))


def test_too_many_entries(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(archive_module, "MOST_ENTRIES", 5)
    assert "6 entries, above the limit of 5" in refusal(
        archive_of({f"{index}.gde": b"" for index in range(6)})
    )


def test_no_model_and_several() -> None:
    assert "no model among its entries (gear.gde); pack" in refusal(archive_of({"gear.gde": b""}))
    assert "2 models (a.rexs, b.rexsj); keep the one" in refusal(archive_of({"a.rexs": b"", "b.rexsj": b""}))
    assert "no model among its entries (none)" in refusal(archive_of({}))


def test_an_encrypted_entry() -> None:
    content = bytearray(archive_of({"unit.rexs": b"<model/>"}))
    content[content.index(b"PK\x01\x02") + 8] |= 1
    assert "encrypted; pack the archive without a password" in refusal(bytes(content))


def test_a_method_that_is_not_known_and_a_cut_archive() -> None:
    content = bytearray(archive_of({"unit.rexs": changed()}))
    assert "a damaged archive (BadZipFile" in refusal(bytes(content[: len(content) // 2]))
    content[content.index(b"PK\x01\x02") + 10] = 77
    assert "a damaged archive" in refusal(bytes(content))


def test_a_stored_archive_is_read() -> None:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as file:
        file.writestr("unit.rexs", changed())
    assert len(parse_rexs(buffer.getvalue(), "unit.rexsz").components) == 29
