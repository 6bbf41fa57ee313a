"""failure.json: what a run without convergence leaves to look at."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rigdesign.base.errors import NotConvergedError
from rigdesign.base.json_text import to_plain, to_text
from rigdesign.base.output_folder import write_whole
from rigdesign.base.version import __version__

FAILURE = "failure.json"
"""Written next to the files of an earlier run, which stay; a run that ends well removes it."""


def write_failure(error: NotConvergedError, out: Path) -> Path | None:
    """Write what an iteration went through to ``out``/failure.json; its path, None where the error holds nothing.

    Raises
    ------
    OutputError
        If the folder cannot be written.
    """
    if not error.history:
        return None
    document = {"tool_version": __version__, "error": str(error), "history": _finite(error.history)}
    write_whole(out / FAILURE, to_text(to_plain(document)))
    return out / FAILURE


def _finite(value: Any) -> Any:
    """The same with texts for numbers that JSON has no form for: a run that diverges may end in them."""
    if isinstance(value, Mapping):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value
