"""What a finished check says of one of its checks: value, verdict, and what the ranges of the inputs do to it."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from rigdesign.base.errors import UsageError
from rigdesign.base.files import RefusedFileError, read_regular
from rigdesign.case.model import Case
from rigdesign.results.check import status

LARGEST = 500 * 1024 * 1024
"""Of a results.json that is read [bytes]."""


@dataclass(frozen=True, kw_only=True)
class FinishedCheck:
    """One check of a results.json.

    same_case : the results are those of the case as it stands now
    margins : input -> margin at the low and at the high end of its range; empty without ``check --ranges``
    ranged : the ranges were evaluated
    """

    folder: str
    value: float | None
    unit: str
    margin: float | None
    distance: float | None
    verdict: str
    reason: str
    same_case: bool
    ranged: bool
    margins: Mapping[str, tuple[float | None, float | None]]


def finished_check(folder: Path, identity: str, case: Case) -> FinishedCheck:
    """A check of the results in ``folder``.

    case : as it stands now

    Raises
    ------
    UsageError
        No results.json there, one that is damaged, of another case, or without this check.
    """
    document = _read(folder / "results.json")
    try:
        checks = {row["id"]: row for row in document["checks"]}
        ranges = document.get("ranges")
        if document["case"]["name"] != case.name:
            raise UsageError(
                f"{folder}: results of case {document['case']['name']}, not of {case.name}; name the folder of a check "
                "of this case"
            )
        if identity not in checks:
            near = get_close_matches(identity, list(checks), n=3, cutoff=0.4)
            raise UsageError(
                f"{identity}: no such check in {folder}; the nearest are {', '.join(near) or 'none'}"
            )
        row = checks[identity]
        return FinishedCheck(
            folder=str(folder),
            value=row["value"],
            unit=row["unit"],
            margin=row["margin"],
            distance=row["distance"],
            verdict=status(row["verdict"], row["flags"]),
            reason=row["reason"],
            same_case=document["case"]["hash"] == case.hash,
            ranged=ranges is not None,
            margins={
                entry["path"]: (entry["margin_low"], entry["margin_high"])
                for entry in (ranges or {}).get("margins", [])
                if entry["check"] == identity
            },
        )
    except (KeyError, TypeError, AttributeError) as error:
        raise UsageError(
            f"{folder / 'results.json'}: no results of this tool ({type(error).__name__}: {error}); name a folder "
            "that rigdesign check --out has written"
        ) from None


def _read(file: Path) -> Any:
    try:
        return json.loads(read_regular(file, LARGEST))
    except RefusedFileError as error:
        raise UsageError(f"{file}: {error.strerror}; name the folder of a finished check") from None
    except OSError as error:
        raise UsageError(
            f"{file}: {error.strerror or 'cannot be read'}; name a folder that rigdesign check --out has written"
        ) from None
    except ValueError as error:
        raise UsageError(f"{file}: no JSON document ({error}); run the check again") from None
