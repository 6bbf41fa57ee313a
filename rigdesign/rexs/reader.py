"""A REXS file of any encoding, recognised by what is in it, whatever its name ends with."""

import io
import zlib
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from xml.parsers import expat
from zipfile import BadZipFile, ZipFile, ZipInfo

from rigdesign.base.errors import UsageError
from rigdesign.base.files import foreign, read_regular
from rigdesign.rexs.external_parts import with_external_parts
from rigdesign.rexs.json_reader import CodedNumbersError, coded_array, coded_matrix, parse_json
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
    Value,
    check_model,
    check_version,
    printable,
)

_WIDE_STARTS = (b"\xff\xfe", b"\xfe\xff")
"""Byte order marks of UTF-16, in which XML may be written."""


def read_rexs(path: str | Path) -> RexsModel:
    """Model of a REXS file: XML (.rexs), JSON (.rexsj) or zip (.rexsz), version 1.0 to 2.0.

    Components that stand in other files of its folder are put in; not so for an archive.

    Raises
    ------
    UsageError
        A file that is not there, must not be read, is no regular file or above 64 MB.
    RexsError
        A file that is no REXS, truncated, damaged, dangerous or contradicts itself; names file, place and remedy.
    """
    path = Path(path)
    return with_external_parts(_read_one(path), path.parent, _read_one)


def _read_one(path: Path) -> RexsModel:
    try:
        content = read_regular(path, MOST_BYTES)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise UsageError(f"{path}: {reason}; give a REXS file (.rexs, .rexsj, .rexsz)") from error
    return parse_rexs(content, str(path))


def parse_rexs(content: bytes, source: str) -> RexsModel:
    """Model of a REXS file that was read already.

    Parameters
    ----------
    content : the file
    source : its name, for messages

    Raises
    ------
    RexsError
        As ``read_rexs``.
    """
    if content.startswith(b"PK"):
        name, content = model_in_archive(content, source)
        return _parse_text(content, f"{source}:{name}")
    return _parse_text(content, source)


def _parse_text(content: bytes, source: str) -> RexsModel:
    start = content.removeprefix(b"\xef\xbb\xbf").lstrip()[:1]
    if start == b"<" or content.startswith(_WIDE_STARTS):
        return parse_xml(content.lstrip(), source)
    if start in (b"{", b"["):
        return parse_json(content, source)
    what = "an empty file" if not start else foreign(content) or "neither XML nor JSON"
    raise FaultList(source).error("file", None, what, "give a REXS file (.rexs, .rexsj, .rexsz)")


# REXS in a zip archive (.rexsz): one model, perhaps with files it refers to. Nothing is unpacked to the disk.

MODEL_SUFFIXES = (".rexs", ".rexsj")
ARCHIVE_SUFFIXES = (".zip", ".rexsz", ".7z", ".gz", ".bz2", ".xz", ".zst", ".tar", ".rar")
MOST_ENTRIES = 1000
MOST_BYTES = 64_000_000
"""Limit of all entries unpacked, and of a model file."""
HIGHEST_RATIO = 200.0
"""Limit of unpacked over packed; the archives of FVA have 17."""
SMALL = 1_000_000
"""Bytes unpacked up to which the ratio does not count."""
_PLAIN_ARCHIVE = "pack the model file and what it refers to again, as an ordinary zip archive"
_UNPACK = "unpack it and give the model it holds"
_BROKEN = (
    BadZipFile, zlib.error, EOFError, OSError, RuntimeError, NotImplementedError, ValueError, KeyError, IndexError,
    OverflowError, MemoryError,
)  # fmt: skip
"""What zipfile raises for archives that are damaged, encrypted or packed by a method it does not have."""


def model_in_archive(content: bytes, source: str) -> tuple[str, bytes]:
    """Name and content of the model file in an archive.

    Parameters
    ----------
    content : the archive
    source : its name, for messages

    Raises
    ------
    RexsError
        A damaged or encrypted archive, one with too many or too large entries or a ratio above the limits, entries
        that lead out of the archive (absolute, ``..``), archives in it, no model or several.
    """
    faults = FaultList(source)
    try:
        with ZipFile(io.BytesIO(content)) as archive:
            entries = archive.infolist()
            _check_sizes(entries, faults)
            for entry in entries:
                _check_entry(entry, faults)
            faults.raise_if_any()
            entry = _model_entry(entries, faults)
            with archive.open(entry) as file:
                model = file.read(MOST_BYTES + 1)
    except _BROKEN as error:
        problem = f"a damaged archive ({type(error).__name__}: {str(error)[:100]})"
        faults.stop("archive", None, problem, _PLAIN_ARCHIVE)
    if len(model) > MOST_BYTES:
        problem = f"above the limit of {MOST_BYTES / 1e6:.3g} MB unpacked"
        faults.stop(
            f"entry {entry.filename[:100]}", None, problem, "export the model without results of calculation"
        )
    if model.startswith(b"PK\x03\x04"):
        faults.stop(f"entry {entry.filename[:100]}", None, "an archive in the archive", _UNPACK)
    return entry.filename, model


def _check_sizes(entries: list[ZipInfo], faults: FaultList) -> None:
    unpacked, packed = sum(item.file_size for item in entries), sum(item.compress_size for item in entries)
    if len(entries) > MOST_ENTRIES:
        faults.stop(
            "archive", None, f"{len(entries)} entries, above the limit of {MOST_ENTRIES}", _PLAIN_ARCHIVE
        )
    if unpacked > MOST_BYTES:
        limit = f"{unpacked / 1e6:.3g} MB unpacked, above the limit of {MOST_BYTES / 1e6:.3g} MB"
        faults.stop("archive", None, limit, "export the model without results of calculation")
    for name, size, stored in [("archive", unpacked, packed), *_sizes(entries)]:
        if size > SMALL and size > HIGHEST_RATIO * stored:
            problem = (
                f"{size / max(stored, 1):.4g} times its packed size, above the limit of {HIGHEST_RATIO:g}"
            )
            faults.stop(name, None, problem, _PLAIN_ARCHIVE)


def _sizes(entries: list[ZipInfo]) -> list[tuple[str, int, int]]:
    return [(f"entry {item.filename[:100]}", item.file_size, item.compress_size) for item in entries]


def _check_entry(entry: ZipInfo, faults: FaultList) -> None:
    name = entry.filename.replace("\\", "/")
    place = f"entry {entry.filename[:100]}"
    if (
        name.startswith("/")
        or name[1:2] == ":"
        or ".." in PurePosixPath(name).parts
        or "\0" in entry.orig_filename
    ):
        faults.add(place, None, "a name that leads out of the archive", _PLAIN_ARCHIVE)
    if entry.flag_bits & 0x1:
        faults.add(place, None, "encrypted", "pack the archive without a password")
    if name.lower().endswith(ARCHIVE_SUFFIXES):
        faults.add(place, None, "an archive in the archive", _UNPACK)


def _model_entry(entries: list[ZipInfo], faults: FaultList) -> ZipInfo:
    """The only model in the archive."""
    models = [item for item in entries if _is_model(item.filename)]
    names = ", ".join(item.filename[:60] for item in (models or entries)[:8])
    if not models:
        remedy = "pack the .rexs or .rexsj file of the model with it"
        faults.stop("archive", None, f"no model among its entries ({names or 'none'})", remedy)
    if len(models) > 1:
        faults.stop("archive", None, f"{len(models)} models ({names})", "keep the one to import")
    return models[0]


def _is_model(name: str) -> bool:
    """Whether an entry is a model by its name, and none of the hidden ones that macOS adds."""
    return name.lower().endswith(MODEL_SUFFIXES) and not PurePosixPath(name).name.startswith(".")


# REXS in XML (.rexs): ``model`` with ``relations``, ``components`` and ``load_spectrum``, after the XSD of FVA.

# XML of a foreign program, read without trust: no document type and so no entities, bounded depth and size.

DEEPEST = 20
"""Levels of elements; REXS has seven."""
MOST_ELEMENTS = 1_000_000
_EMPTY_FILE_CODE = 3
_TRUNCATED = {_EMPTY_FILE_CODE, 5, 6, 20}
"""Expat error numbers of a file that ends too early or in the middle of something."""


@dataclass(slots=True)
class Element:
    """One element: tag without its name space, attributes, line of the file; text only without children."""

    tag: str
    attributes: dict[str, str]
    line: int
    text: str = ""
    children: list["Element"] = field(default_factory=list)

    def all(self, tag: str) -> list["Element"]:
        """Children of this tag."""
        return [child for child in self.children if child.tag == tag]

    def first(self, tag: str) -> "Element | None":
        """The first child of this tag."""
        return next((child for child in self.children if child.tag == tag), None)


def read_tree(content: bytes, faults: FaultList) -> Element:
    """Root element of an XML document.

    Raises
    ------
    RexsError
        No well-formed XML, a document type declaration, elements too many or too deep; names the line.
    """
    builder = _TreeBuilder(faults)
    try:
        builder.parser.Parse(content, True)
    except expat.ExpatError as error:
        what = "the file ends too early" if error.code in _TRUNCATED else "no well-formed XML"
        place = f"line {error.lineno}, column {error.offset + 1}"
        faults.stop(place, None, f"{what} ({expat.errors.messages.get(error.code, 'error')})", EXPORT_AGAIN)
    except (LookupError, UnicodeError, ValueError):
        faults.stop("line 1", None, "an encoding that is not known", "save the file as UTF-8")
    if builder.root is None:
        faults.stop("line 1", None, "no element", EXPORT_AGAIN)
    return builder.root


class _TreeBuilder:
    """Handlers of expat; ``root`` is the result."""

    def __init__(self, faults: FaultList) -> None:
        self.root: Element | None = None
        self._faults = faults
        self._open: list[Element] = []
        self._count = 0
        self._text: list[str] = []
        self.parser = expat.ParserCreate(namespace_separator="}")
        self.parser.buffer_text = True
        self.parser.StartDoctypeDeclHandler = self._refuse_doctype
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._characters

    def _refuse_doctype(self, name: str, *_rest: object) -> None:
        problem = "a document type declaration, which may define entities without end"
        self._faults.stop(self._place(), f"<!DOCTYPE {name}>", problem, "delete it; REXS needs none")

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._count += 1
        if self._count > MOST_ELEMENTS:
            remedy = "export the model without results of calculation and mode shapes"
            self._faults.stop(self._place(), None, f"more than {MOST_ELEMENTS} elements", remedy)
        if len(self._open) >= DEEPEST:
            self._faults.stop(self._place(), None, f"elements nested deeper than {DEEPEST}", EXPORT_AGAIN)
        plain = {_local(name): value for name, value in attributes.items()}
        element = Element(_local(tag), plain, self.parser.CurrentLineNumber)
        if self._open:
            self._open[-1].children.append(element)
        else:
            self.root = element
        self._open.append(element)
        self._text = []

    def _end(self, _tag: str) -> None:
        element = self._open.pop()
        if not element.children:
            element.text = "".join(self._text)
        self._text = []

    def _characters(self, text: str) -> None:
        self._text.append(text)

    def _place(self) -> str:
        return f"line {self.parser.CurrentLineNumber}"


def _local(name: str) -> str:
    return name.rpartition("}")[2]


_OTHER_ROOTS = {
    "rexsSchema": "the REXS database, not a model",
    "rexsChangelog": "a change log of REXS, not a model",
    "html": "a web page",
    "svg": "a drawing (SVG)",
    "GDE": "a GDE file of gear measurement (VDI/VDE 2610)",
}


def parse_xml(content: bytes, source: str) -> RexsModel:
    """Model of a REXS file in XML.

    Parameters
    ----------
    content : the file
    source : its name, for messages

    Raises
    ------
    RexsError
        Truncated or no XML, a document type declaration, another kind of document, a version that is not read, missing
        or doubled ids, references to nothing; every fault with its line or component.
    """
    faults = FaultList(source)
    root = read_tree(content, faults)
    if root.tag != "model":
        what = _OTHER_ROOTS.get(root.tag, "no REXS model")
        remedy = "give a file whose root is <model>, as REXS has it"
        faults.stop(f"line {root.line}", f"<{root.tag[:40]}>", what, remedy)
    check_version(root.attributes.get("version", ""), f"line {root.line}, model", faults)
    reader = _XmlReader(faults)
    application = [root.attributes.get(key, "") for key in ("applicationId", "applicationVersion")]
    model = RexsModel(
        source=source,
        version=root.attributes["version"],
        application=printable(" ".join(application).strip()[:200]),
        date=printable(root.attributes.get("date", "")[:60]),
        components=tuple(
            reader.component(item) for group in root.all("components") for item in group.all("component")
        ),
        relations=tuple(
            reader.relation(item) for group in root.all("relations") for item in group.all("relation")
        ),
        load_spectra=tuple(reader.load_spectrum(item) for item in root.all("load_spectrum")),
    )
    return check_model(model, faults)


class _XmlReader:
    """Elements -> parts of the model; faults go to the list."""

    def __init__(self, faults: FaultList) -> None:
        self._faults = faults

    def component(self, element: Element, *, typed: bool = True) -> Component:
        place = f"line {element.line}, component"
        return Component(
            id=self._faults.whole_number(place, "id", element.attributes.get("id")),
            type=self._faults.text(place, "type", element.attributes.get("type"), needed=typed),
            name=printable(element.attributes.get("name", "").strip()),
            attributes=tuple(self._attribute(item) for item in element.all("attribute")),
        )

    def relation(self, element: Element) -> Relation:
        place = f"line {element.line}, relation"
        order = element.attributes.get("order")
        return Relation(
            id=self._faults.whole_number(place, "id", element.attributes.get("id")),
            type=self._faults.text(place, "type", element.attributes.get("type")),
            references=tuple(self._reference(item) for item in element.all("ref")),
            order=None if order is None else self._faults.whole_number(place, "order", order),
        )

    def load_spectrum(self, element: Element) -> LoadSpectrum:
        place = f"line {element.line}, load_spectrum"
        accumulated = [item for group in element.all("accumulation") for item in group.all("component")]
        return LoadSpectrum(
            id=self._faults.whole_number(place, "id", element.attributes.get("id")),
            load_cases=tuple(self._load_case(item) for item in element.all("load_case")),
            accumulation=tuple(self.component(item, typed=False) for item in accumulated),
        )

    def _load_case(self, element: Element) -> LoadCase:
        number = self._faults.whole_number(
            f"line {element.line}, load_case", "id", element.attributes.get("id")
        )
        return LoadCase(number, tuple(self.component(item, typed=False) for item in element.all("component")))

    def _reference(self, element: Element) -> RoleReference:
        place = f"line {element.line}, ref"
        return RoleReference(
            component=self._faults.whole_number(place, "id", element.attributes.get("id")),
            role=self._faults.text(place, "role", element.attributes.get("role")),
        )

    def _attribute(self, element: Element) -> Attribute:
        name = self._faults.text(f"line {element.line}, attribute", "id", element.attributes.get("id"))
        try:
            value = _value(element)
        except (CodedNumbersError, ValueError) as error:
            self._faults.add(f"line {element.line}, attribute {name}", None, str(error), EXPORT_AGAIN)
            value = None
        return Attribute(name, element.attributes.get("unit"), value)


def _value(element: Element) -> Value:
    """Scalar text, array, matrix or array of arrays of an attribute element."""
    array, matrix = element.first("array"), element.first("matrix")
    arrays = element.first("array_of_arrays")
    if array is not None:
        return _array(array)
    if matrix is not None:
        return _matrix(matrix)
    if arrays is not None:
        return tuple(_array(item) for item in arrays.all("array"))
    return element.text.strip()


def _array(element: Element) -> tuple[str | float, ...]:
    code = element.attributes.get("code")
    if code is not None:
        return coded_array(code, element.text)
    return tuple(item.text.strip() for item in element.all("c"))


def _matrix(element: Element) -> tuple[tuple[str | float, ...], ...]:
    code = element.attributes.get("code")
    if code is None:
        return tuple(tuple(item.text.strip() for item in row.all("c")) for row in element.all("r"))
    shape = [element.attributes.get(key, "") for key in ("rows", "columns")]
    if not all(text.isascii() and text.isdigit() and len(text) < 10 for text in shape):
        raise CodedNumbersError("a coded matrix without rows and columns")
    return coded_matrix(code, element.text, int(shape[0]), int(shape[1]))
