"""XML of a foreign program, read without trust: no document type and so no entities, bounded depth and size."""

from dataclasses import dataclass, field
from xml.parsers import expat

from rigdesign.rexs.faults import EXPORT_AGAIN, FaultList

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
