"""The application that the commands join, and what all of them do: read the case, print a document."""

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from cyclopts import App

from rigdesign.base.version import __version__

if TYPE_CHECKING:
    from rigdesign.case import Case

app = App(
    name="rigdesign",
    help="Coupled thermal-dynamic design checker for back-to-back gear test rigs.",
    version=__version__,
    exit_on_error=False,
    print_error=False,
    suppress_keyboard_interrupt=False,
)


def loaded_case(path: Path) -> "Case":
    """The case, before anything else is imported: a fault in it is said at once."""
    from rigdesign.case import load_case

    return load_case(path)


def print_json(document: object) -> None:
    """One JSON document on stdout."""
    json.dump(document, sys.stdout, indent=2, ensure_ascii=False, allow_nan=False)
    sys.stdout.write("\n")
