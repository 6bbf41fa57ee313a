"""REXS in JSON (.rexsj): the model of the XML with the value type as key, after the JSON schema of FVA."""

import binascii
import json
import struct
from base64 import b64decode
from collections.abc import Mapping
from typing import Any, NoReturn, get_args

from rigdesign.rexs.model import (
    EXPORT_AGAIN,
    Attribute,
    Component,
    FaultList,
    LoadCase,
    LoadSpectrum,
    Relation,
    RexsModel,
    RoleReference,
    Scalar,
    Value,
    ValueKind,
    check_model,
    check_version,
    printable,
)

_KINDS: Mapping[str, ValueKind] = {
    kind: kind for kind in get_args(ValueKind) if kind not in ("untyped", "unknown")
}
_CODED = "_coded"


def parse_json(content: bytes, source: str) -> RexsModel:
    """Model of a REXS file in JSON.

    Parameters
    ----------
    content : the file, UTF-8 with or without byte order mark
    source : its name, for messages

    Raises
    ------
    RexsError
        Truncated or no JSON, another kind of document, a version that is not read, missing or doubled ids, references
        to nothing; every fault with its place.
    """
    faults = FaultList(source)
    document = _document(content, faults)
    root = document.get("model") if isinstance(document, dict) else None
    if not isinstance(root, dict):
        faults.stop("root", None, "no object with the key 'model'", "give a JSON file of REXS (.rexsj)")
    version = root.get("version")
    check_version(version if isinstance(version, str) else "", "model", faults)
    reader = _JsonReader(faults)
    application = [str(root.get(key) or "") for key in ("applicationId", "applicationVersion")]
    spectra = root.get("load_spectrum")
    model = RexsModel(
        source=source,
        version=root["version"],
        application=printable(" ".join(application).strip()[:200]),
        date=printable(str(root.get("date") or "")[:60]),
        components=reader.components("components", root.get("components")),
        relations=tuple(
            reader.relation(place, item) for place, item in reader.items("relations", root.get("relations"))
        ),
        load_spectra=tuple(
            reader.load_spectrum(place, item)
            for place, item in reader.items(
                "load_spectrum", [spectra] if isinstance(spectra, dict) else spectra
            )
        ),
    )
    return check_model(model, faults)


def _document(content: bytes, faults: FaultList) -> Any:
    try:
        return json.loads(content.decode("utf-8-sig"), parse_constant=_refuse_constant)
    except UnicodeDecodeError as error:
        faults.stop(f"byte {error.start}", None, "no UTF-8 text", "save the file as UTF-8")
    except json.JSONDecodeError as error:
        ended = error.pos >= len(error.doc.rstrip()) or error.msg.startswith("Unterminated")
        what = "the file ends too early" if ended else "no well-formed JSON"
        faults.stop(f"line {error.lineno}, column {error.colno}", None, f"{what} ({error.msg})", EXPORT_AGAIN)
    except RecursionError:
        faults.stop("root", None, "objects nested too deep", EXPORT_AGAIN)
    except ValueError as error:
        faults.stop("root", None, f"a number that cannot be read ({str(error)[:80]})", EXPORT_AGAIN)


def _refuse_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is no number of JSON")


class _JsonReader:
    """Objects -> parts of the model; faults go to the list."""

    def __init__(self, faults: FaultList) -> None:
        self._faults = faults

    def items(self, place: str, given: object) -> list[tuple[str, dict[str, Any]]]:
        """Place and object of each entry of a list; None is an empty one, anything else a fault."""
        if given is None:
            return []
        if not isinstance(given, list):
            self._faults.add(place, None, "no list", EXPORT_AGAIN)
            return []
        found = []
        for index, item in enumerate(given):
            if isinstance(item, dict):
                found.append((f"{place}[{index}]", item))
            else:
                self._faults.add(f"{place}[{index}]", item, "no object", EXPORT_AGAIN)
        return found

    def components(self, place: str, given: object, *, typed: bool = True) -> tuple[Component, ...]:
        return tuple(self._component(where, item, typed) for where, item in self.items(place, given))

    def relation(self, place: str, item: dict[str, Any]) -> Relation:
        order = item.get("order")
        references = [
            RoleReference(
                self._faults.whole_number(where, "id", reference.get("id")),
                self._faults.text(where, "role", reference.get("role")),
            )
            for where, reference in self.items(f"{place}.refs", item.get("refs"))
        ]
        return Relation(
            id=self._faults.whole_number(place, "id", item.get("id")),
            type=self._faults.text(place, "type", item.get("type")),
            references=tuple(references),
            order=None if order is None else self._faults.whole_number(place, "order", order),
        )

    def load_spectrum(self, place: str, item: dict[str, Any]) -> LoadSpectrum:
        accumulation = item.get("accumulation")
        accumulated = accumulation.get("components") if isinstance(accumulation, dict) else None
        cases = [
            LoadCase(
                self._faults.whole_number(where, "id", case.get("id")),
                self.components(f"{where}.components", case.get("components"), typed=False),
            )
            for where, case in self.items(f"{place}.load_cases", item.get("load_cases"))
        ]
        return LoadSpectrum(
            id=self._faults.whole_number(place, "id", item.get("id")),
            load_cases=tuple(cases),
            accumulation=self.components(f"{place}.accumulation.components", accumulated, typed=False),
        )

    def _component(self, place: str, item: dict[str, Any], typed: bool) -> Component:
        return Component(
            id=self._faults.whole_number(place, "id", item.get("id")),
            type=self._faults.text(place, "type", item.get("type"), needed=typed),
            name=self._faults.text(place, "name", item.get("name"), needed=False),
            attributes=tuple(
                self._attribute(where, attribute)
                for where, attribute in self.items(f"{place}.attributes", item.get("attributes"))
            ),
        )

    def _attribute(self, place: str, item: dict[str, Any]) -> Attribute:
        name = self._faults.text(place, "id", item.get("id"))
        unit = self._faults.text(place, "unit", item.get("unit"), needed=False) or None
        key = next((key for key in item if key not in ("id", "unit")), "")
        kind = _KINDS.get(key.removesuffix(_CODED), "unknown")
        if kind == "unknown":
            return Attribute(name, unit, None, kind)
        try:
            value = _coded(kind, item[key]) if key.endswith(_CODED) else _plain(item[key])
        except (CodedNumbersError, ValueError) as error:
            self._faults.add(f"{place} ({name}), {key}", None, str(error), EXPORT_AGAIN)
            value = None
        return Attribute(name, unit, value, kind)


def _plain(given: Any) -> Value:
    """Scalar, list of scalars or list of such lists."""
    if not isinstance(given, list):
        return _scalar(given)
    if any(isinstance(row, list) for row in given):
        return tuple(tuple(_scalar(item) for item in row) for row in given if isinstance(row, list))
    return tuple(_scalar(item) for item in given)


def _scalar(given: Any) -> Scalar:
    if isinstance(given, str):
        return printable(given)
    if given is None or isinstance(given, bool | int | float):
        return given
    raise ValueError("an object or list where a value belongs")


def _coded(kind: ValueKind, given: Any) -> Value:
    if not isinstance(given, dict) or not all(isinstance(given.get(key), str) for key in ("code", "value")):
        raise ValueError("no object with code and value")
    if not kind.endswith("matrix"):
        return coded_array(given["code"], given["value"])
    rows, columns = given.get("rows"), given.get("columns")
    if not isinstance(rows, int) or not isinstance(columns, int):
        raise ValueError("a coded matrix without rows and columns")
    return coded_matrix(given["code"], given["value"], rows, columns)


# Arrays that REXS stores as base64 of little-endian numbers (``code`` int32, float32, float64).

_FORMATS = {"int32": ("i", 4), "float32": ("f", 4), "float64": ("d", 8)}


class CodedNumbersError(ValueError):
    """Text that is no base64 of numbers of this code."""


def coded_array(code: str, text: str) -> tuple[float, ...]:
    """Numbers of a coded array.

    Parameters
    ----------
    code : int32, float32 or float64
    text : base64; blanks and line ends are skipped

    Raises
    ------
    CodedNumbersError
        Another code, text that is no base64, or bytes that do not divide into numbers.
    """
    if code not in _FORMATS:
        raise CodedNumbersError(f"code {code[:20]!r} is none of {', '.join(_FORMATS)}")
    letter, size = _FORMATS[code]
    try:
        content = b64decode("".join(text.split()), validate=True)
    except (binascii.Error, ValueError):
        raise CodedNumbersError("no base64 text") from None
    if len(content) % size:
        raise CodedNumbersError(f"{len(content)} bytes do not divide into numbers of {size}")
    return struct.unpack(f"<{len(content) // size}{letter}", content)


def coded_matrix(code: str, text: str, rows: int, columns: int) -> tuple[tuple[float, ...], ...]:
    """Numbers of a coded matrix, shape (rows, columns).

    Raises
    ------
    CodedNumbersError
        As ``coded_array``, or a shape that does not fit the numbers.
    """
    numbers = coded_array(code, text)
    if rows < 0 or columns < 0 or rows * columns != len(numbers):
        raise CodedNumbersError(f"{rows} rows of {columns} do not hold {len(numbers)} numbers")
    return tuple(numbers[row * columns : (row + 1) * columns] for row in range(rows))
