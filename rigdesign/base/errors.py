"""Errors a user can meet, with the exit status of the command that raised them.

    RigdesignError              1
    ├── FaultyInputError            a file of the user is wrong; carries every fault found
    │   ├── CaseError           2   the case file or a study path
    │   ├── MeasurementError    5   measured data cannot be used
    │   └── RexsError           2   a REXS file that cannot be read
    ├── UsageError              2   a wrong call
    │   └── OutputError         2   an output folder that cannot be written
    ├── NotConvergedError       3   an iteration did not converge, a speed was not reached
    │   └── NonFiniteResultError 3  a result is NaN or infinite
    └── MissingLibraryError     4   a system library is missing, or the memory to load it

A message states name, value, limit and remedy. The solvers have roots of their own, `thermal.errors` and
`dynamics.errors`; `rigdesign.run.solver_errors` turns them into this tree. Anything else is a defect: exit status 70.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from dynamics.errors import DynamicsError
from thermal.errors import ThermalError

WIDEST = 120
"""Characters of a text of the user that a message repeats."""
WIDEST_SENTENCE = 2000
"""Characters of a problem or remedy, which may list the names that are known."""


WIDEST_PLACE = 400
"""Characters of the path of a file."""
_MARKS = r"\u200e\u200f\u2028-\u202e\u2066-\u2069"
CONTROL = re.compile(rf"[\x00-\x08\x0b-\x1f\x7f-\x9f{_MARKS}\ufffe\uffff]")
"""What a terminal obeys, direction marks among it, and XML cannot hold; tabs and new lines are text."""
MOST_FAULTS = 50
"""Faults that a message lists."""


LAYOUT = re.compile(rf"[\u061c{_MARKS}]")
"""Marks that turn the direction of what follows or break a line, unseen themselves."""


def one_line(text: str) -> str:
    """A text of others for one line of an output: line breaks as blanks, control characters and marks as codes."""
    return without_layout(spelled_out(" ".join(text.splitlines())))


def without_layout(text: str) -> str:
    """A text of others in which no mark turns the direction of what stands beside it."""
    return LAYOUT.sub(_code, text)


def spelled_out(text: str) -> str:
    """A text with codes in place of its control characters."""
    return CONTROL.sub(_code, text)


def _code(character: re.Match[str]) -> str:
    return f"\\u{ord(character[0]):04x}"


def shortened(text: str, width: int = WIDEST) -> str:
    """``text`` cut to ``width`` characters, with its length where it is longer; control characters are spelled out."""
    cut = spelled_out(text[:width])
    return cut if len(text) <= width else f"{cut}… ({len(text)} characters)"


class RigdesignError(Exception):
    """Base of every error that is the user's or the machine's to mend."""

    exit_code: int = 1


@dataclass(frozen=True)
class Fault:
    """One thing wrong with a case or a measurement: where, what was given, what is accepted, what to do.

    path : dotted path of the key or place in a table, empty for the case as a whole
    given : the value as written, empty where a key is missing
    problem : what is wrong, with the limit
    remedy : what to write instead
    impossible : the place can never hold such a value, whatever else the case says: a choice that does not exist
    """

    path: str
    given: str
    problem: str
    remedy: str
    impossible: bool = False

    def __str__(self) -> str:
        place = shortened(self.path or "case")
        given = f" = {shortened(self.given)}" if self.given else ""
        problem, remedy = (shortened(text, WIDEST_SENTENCE) for text in (self.problem, self.remedy))
        return f"{place}{given}: {problem}; {remedy}"


class FaultyInputError(RigdesignError):
    """What is wrong with a file or operation: all its faults at once, or one sentence.

    Parameters
    ----------
    faults : what is wrong, or one sentence
    source : file or operation the faults belong to
    """

    def __init__(self, faults: str | Sequence[Fault], source: str = "") -> None:
        super().__init__(faults, source)
        self.faults: tuple[Fault, ...] = () if isinstance(faults, str) else tuple(faults)
        self.source = source
        self._sentence = faults if isinstance(faults, str) else ""

    def __str__(self) -> str:
        head = f"{shortened(self.source, WIDEST_PLACE)}: " if self.source else ""
        if self._sentence:
            return head + shortened(self._sentence, WIDEST_SENTENCE)
        if len(self.faults) == 1:
            return head + str(self.faults[0])
        more = [f"  and {len(self.faults) - MOST_FAULTS} more"] if len(self.faults) > MOST_FAULTS else []
        listed = (f"  {fault}" for fault in self.faults[:MOST_FAULTS])
        return "\n".join([f"{head}{len(self.faults)} faults", *listed, *more])


class CaseError(FaultyInputError):
    """A case that cannot be computed; lists all its faults at once."""

    exit_code = 2


class UsageError(RigdesignError):
    """A command or function called with something it cannot take."""

    exit_code = 2


class OutputError(UsageError):
    """An output folder that cannot be written."""


class NotConvergedError(RigdesignError):
    """An iteration that did not converge within its limit.

    Parameters
    ----------
    message : with the last residuals
    history : all there is to look at, by name: residuals, traces over time; numbers, lists and texts
    """

    exit_code = 3

    def __init__(self, message: str, history: Mapping[str, Any] | None = None) -> None:
        super().__init__(message)
        self.history: Mapping[str, Any] = history or {}


class NonFiniteResultError(NotConvergedError):
    """A result that is NaN or infinite: no number was reached, so that no check may depend on it."""


class MissingLibraryError(RigdesignError):
    """What the machine lacks: a system library, with the command that installs it, or memory to load the libraries."""

    exit_code = 4


class MeasurementError(FaultyInputError):
    """Measured data that cannot be used; lists all faults at once."""

    exit_code = 5


class RexsError(FaultyInputError):
    """A REXS file that cannot be read; lists what is wrong with file and place."""

    exit_code = 2


@contextmanager
def named(path: str) -> Iterator[None]:
    """Put the case path of a part before what a solver says of it; the kind of the error stays."""
    try:
        yield
    except (ThermalError, DynamicsError) as error:
        error.args = (f"{path}: {error}", *error.args[1:])
        raise
