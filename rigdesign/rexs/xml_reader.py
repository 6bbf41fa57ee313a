"""REXS in XML (.rexs): ``model`` with ``relations``, ``components`` and ``load_spectrum``, after the XSD of FVA."""

from rigdesign.rexs.coded_numbers import CodedNumbersError, coded_array, coded_matrix
from rigdesign.rexs.consistency import check_model, check_version
from rigdesign.rexs.faults import EXPORT_AGAIN, FaultList, printable
from rigdesign.rexs.model import (
    Attribute,
    Component,
    LoadCase,
    LoadSpectrum,
    Relation,
    RexsModel,
    RoleReference,
    Value,
)
from rigdesign.rexs.xml_tree import Element, read_tree

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
