"""What is wrong with a REXS file: collected while it is read, raised as one error with file, place and remedy."""

import re
from collections import Counter
from collections.abc import Iterable
from typing import NoReturn

from rigdesign.base.errors import Fault, RexsError, spelled_out
from rigdesign.rexs.model import Component, RexsModel
from rigdesign.rexs.versions import is_read

MOST_FAULTS = 20
"""Faults after which the rest of a file is not looked at."""
EXPORT_AGAIN = "export the model again from the program it comes from, as REXS 1.0 to 2.0"
_INTEGER = re.compile(r"\s*-?[0-9]{1,9}\s*")


def printable(text: str) -> str:
    """``text`` as a terminal and a file can take it: control characters spelled out, half characters replaced."""
    return spelled_out(text.encode("utf-8", "replace").decode("utf-8"))


class FaultList:
    """Faults of one file."""

    def __init__(self, source: str) -> None:
        self.source = source
        self._faults: list[Fault] = []

    def add(self, place: str, given: object, problem: str, remedy: str) -> None:
        """Note a fault; raises RexsError when there are too many to go on."""
        self._faults.append(_fault(place, given, problem, remedy))
        if len(self._faults) >= MOST_FAULTS:
            self.raise_if_any()

    def error(self, place: str, given: object, problem: str, remedy: str) -> RexsError:
        """The error of a fault after which nothing can be read, with all faults so far."""
        self._faults.append(_fault(place, given, problem, remedy))
        return RexsError(self._faults, self.source)

    def stop(self, place: str, given: object, problem: str, remedy: str) -> NoReturn:
        """Note a fault after which nothing can be read, and raise.

        Raises
        ------
        RexsError
            Always; with all faults so far.
        """
        raise self.error(place, given, problem, remedy)

    def raise_if_any(self) -> None:
        """Raise RexsError with all faults so far, if there are any."""
        if self._faults:
            raise RexsError(self._faults, self.source)

    def whole_number(self, place: str, key: str, given: object) -> int:
        """An id or order; a missing or wrong one is a fault and reads as -1."""
        if isinstance(given, int) and not isinstance(given, bool) and abs(given) < 10**9:
            return given
        if isinstance(given, str) and _INTEGER.fullmatch(given):
            return int(given)
        problem = "missing" if given is None else "no whole number of at most nine digits"
        self.add(f"{place}, {key}", given, problem, f"write {key} as a whole number, as REXS asks for")
        return -1

    def text(self, place: str, key: str, given: object, *, needed: bool = True) -> str:
        """A name or type; empty where it is missing, which is a fault where it is needed."""
        if isinstance(given, str) and (given.strip() or not needed):
            return printable(given.strip())
        if given is not None or needed:
            problem = "missing" if given is None or given == "" else "no text"
            self.add(f"{place}, {key}", given, problem, f"write {key} as a text, as REXS asks for")
        return ""


def _fault(place: str, given: object, problem: str, remedy: str) -> Fault:
    return Fault(place, "" if given is None else printable(str(given)[:1000]), problem, remedy)


# What holds for a REXS model in XML and JSON alike: a version that is read, unique ids, references to something.

MOST_STATES = 2_000_000
"""Load cases times shafts and loads, each of which has a state in each case."""


def check_version(version: str, place: str, faults: FaultList) -> None:
    """Stop at a version that is not read, before the rest of the file is misunderstood.

    Raises
    ------
    RexsError
        The version is none of 1.0 to 1.7 and 2.0.
    """
    if not is_read(version):
        faults.stop(f"{place}, version", version, "not one of REXS 1.0 to 1.7 and 2.0", EXPORT_AGAIN)


def check_model(model: RexsModel, faults: FaultList) -> RexsModel:
    """``model``, if it holds together.

    Raises
    ------
    RexsError
        No components, an id that occurs twice, or a relation or load case that names a component that is not there,
        load cases without end; with all faults collected before.
    """
    if not model.components:
        faults.add("model, components", None, "a model without components", EXPORT_AGAIN)
    _check_unique("component", (component.id for component in model.components), faults)
    _check_unique("relation", (relation.id for relation in model.relations), faults)
    for relation in model.relations:
        for item in relation.references:
            _check_known(model, f"relation {relation.id}, role {item.role!r}", item.component, faults)
    _check_unique("load_spectrum", (spectrum.id for spectrum in model.load_spectra), faults)
    for spectrum in model.load_spectra:
        _check_unique(
            f"load_spectrum {spectrum.id}: load_case", (case.id for case in spectrum.load_cases), faults
        )
        for case in spectrum.load_cases:
            _check_parts(model, f"load_case {case.id}", case.components, faults)
        _check_parts(model, "accumulation", spectrum.accumulation, faults)
    cases = sum(len(spectrum.load_cases) for spectrum in model.load_spectra)
    carriers = len(model.of_type("shaft", "external_load"))
    if cases * carriers > MOST_STATES:
        problem = (
            f"{cases} load cases of {carriers} shafts and loads, above the limit of {MOST_STATES} states"
        )
        faults.add("load_spectrum", None, problem, "export a classified load spectrum")
    faults.raise_if_any()
    return model


def _check_parts(model: RexsModel, place: str, components: tuple[Component, ...], faults: FaultList) -> None:
    _check_unique(f"{place}, component", (component.id for component in components), faults)
    for component in components:
        _check_known(model, f"{place}, component", component.id, faults)


def _check_unique(what: str, numbers: Iterable[int], faults: FaultList) -> None:
    for number, count in Counter(numbers).items():
        if count > 1:
            faults.add(f"{what} {number}", None, f"the id occurs {count} times", "give each an id of its own")


def _check_known(model: RexsModel, place: str, number: int, faults: FaultList) -> None:
    if not model.has(number):
        faults.add(place, number, "no component has this id", f"add the component, or {EXPORT_AGAIN}")
