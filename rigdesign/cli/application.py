"""The application that the commands join, and what all of them do: read the case, print a document."""

import json
import sys
from collections.abc import Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import App, Group, Parameter, Token

from rigdesign.base.errors import MissingLibraryError, UsageError
from rigdesign.base.system import memory_shortage
from rigdesign.base.version import __version__
from rigdesign.cli.terminal.console import verbosity

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
app.meta.suppress_keyboard_interrupt = False
app.meta.group_parameters = Group("Options of every command", sort_key=100)


def run(tokens: Sequence[str]) -> object:
    """Run a command line; the value that its command returns.

    Raises
    ------
    CycloptsError
        A line that is no command.
    RigdesignError
        What the command raises.
    """
    return app.meta(list(tokens), result_action="return_value")


@app.meta.default
def _launch(
    *tokens: Annotated[str, Parameter(show=False, allow_leading_hyphen=True)],
    verbose: Annotated[bool, Parameter(negative=(), show_default=False)] = False,
    quiet: Annotated[bool, Parameter(negative=(), show_default=False)] = False,
) -> object:
    """Take the options of every command off and run the rest.

    Parameters
    ----------
    tokens
        Command with its own options.
    verbose
        Say every step with its time, the iterations of the solvers, and what the caches gave.
    quiet
        Print errors and the line of the verdict only.
    """
    if verbose and quiet:
        raise UsageError("--verbose and --quiet exclude each other; leave one of them out")
    before = verbosity.set("verbose" if verbose else "quiet" if quiet else "normal")
    try:
        from rigdesign.cli.terminal.console import cache_use

        asked = tokens[:1] and not tokens[0].startswith("-")
        if asked and (shortage := memory_shortage()):
            raise MissingLibraryError(shortage)
        with cache_use() if asked else nullcontext():
            return app(tokens, result_action="return_value")
    finally:
        verbosity.reset(before)


def _out_folder(_: Any, tokens: Sequence[Token]) -> Path:
    """The folder of ``--out``; an empty text would mean the current one without saying so."""
    [token] = tokens
    if not token.value.strip():
        raise UsageError(
            f"{token.keyword} is empty; name a folder, e.g. {token.keyword} results "
            f"({token.keyword} . is the current one)"
        )
    return Path(token.value)


Several = Parameter(negative=())
"""An option that may stand several times."""
OutFolder = Annotated[Path, Parameter(converter=_out_folder)]
"""Folder that a command writes to."""
OptionalOutFolder = Annotated[Path | None, Parameter(converter=_out_folder)]
"""The same of a command that can do without."""


def loaded_case(path: Path) -> "Case":
    """The case, before anything else is imported: a fault in it is said at once."""
    from rigdesign.case import load_case

    return load_case(path)


def print_json(document: object) -> None:
    """One JSON document on stdout; escaped where the stream is not in UTF."""
    plain = not (sys.stdout.encoding or "").lower().startswith("utf")
    json.dump(document, sys.stdout, indent=2, ensure_ascii=plain, allow_nan=False)
    sys.stdout.write("\n")
