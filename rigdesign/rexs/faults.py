"""What is wrong with a REXS file: collected while it is read, raised as one error with file, place and remedy."""

import re
from typing import NoReturn

from rigdesign.base.errors import Fault, RexsError, spelled_out

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
