"""results.json: every result but the nodal fields, the same bytes for the same case; and read again."""

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from rigdesign.base.errors import WIDEST_PLACE, NotConvergedError, UsageError, shortened
from rigdesign.base.json_text import to_plain, to_text
from rigdesign.base.output_folder import write_whole
from rigdesign.base.version import RESULTS_SCHEMA_VERSION, __version__
from rigdesign.results.curve_files import PLACE, with_references, without_references
from rigdesign.results.document import as_shown, record_of, schema_of
from rigdesign.results.quantity import shown
from rigdesign.results.result import RunResult
from rigdesign.studies.stored_results import AGAIN, read_document


def results_document(result: RunResult, *, beside_files: bool = False) -> dict[str, Any]:
    """Content of results.json as plain dicts, lists, strings and finite numbers.

    Units stand in the key (``_Nm``, ``_degC``) or in the field ``unit`` next to the value. A check names its
    assumptions by their numbers in ``assumptions``.

    beside_files : curves that stand in the files of curves are named (`rigdesign.results.curve_files`)

    Raises
    ------
    NonFiniteResultError
        If a number is NaN or infinite; names the key.
    """
    items = [item for item in shown(RunResult).values() if item.name != "fields"]
    document = {item.key: as_shown(item.of(result)) for item in items}
    numbers = {record.path: number for number, record in enumerate(result.assumptions)}
    for check in document["checks"]:
        check["assumptions"] = [numbers.get(path, path) for path in check["assumptions"]]
    for record in document["assumptions"]:
        del record["decides"]
    if beside_files:
        document = with_references(document, result.columns)
    plain: dict[str, Any] = to_plain(
        {"schema_version": RESULTS_SCHEMA_VERSION, "tool_version": __version__, **document}
    )
    return plain


def results_schema() -> dict[str, Any]:
    """JSON Schema of results.json, from the classes of the result."""
    texts = {"type": "array", "items": {"type": "string"}}
    field = {"type": "object", "properties": {"file": {"type": "string"}}, "required": ["file"]}
    schema: dict[str, Any] = schema_of(
        RunResult, {"fields": {"type": "array", "items": field}}, {"$ref": "#/$defs/Place"}
    )
    schema["properties"] = {
        "schema_version": {"const": RESULTS_SCHEMA_VERSION},
        "tool_version": {"type": "string"},
        **schema["properties"],
        "files": texts,
    }
    schema["required"] = [key for key in schema["properties"] if key not in ("fields", "files")]
    records = schema["$defs"]
    numbers = {"description": "Numbers of the rows in assumptions.", "type": "array", "items": {}}
    records["Check"]["properties"]["assumptions"] = numbers
    del records["AssumptionRecord"]["properties"]["decides"]
    records["AssumptionRecord"]["required"].remove("decides")
    records["Place"] = PLACE
    return schema


def read_result(path: Path) -> tuple[RunResult, Path]:
    """The result that a folder of `rigdesign check --out`, or its results.json, holds; and that file.

    Numbers have the ten digits of the files. ``fields`` holds those whose .vtu files stand beside it.

    Raises
    ------
    UsageError
        If there is none, it is damaged or of another schema version, or files of its curves are missing; says what to
        do.
    """
    from rigdesign.report.fields import read_fields

    file, stored = read_document(
        path, "report takes a folder that `rigdesign check --out` wrote, or its results.json"
    )
    try:
        document = without_references(stored, file.parent)
        paths = [record["path"] for record in document["assumptions"]]
        for check in document["checks"]:
            check["assumptions"] = [
                paths[path] if isinstance(path, int) else path for path in check["assumptions"]
            ]
        for record in document["assumptions"]:
            record["decides"] = [
                check["id"] for check in document["checks"] if record["path"] in check["assumptions"]
            ]
        result: RunResult = record_of(RunResult, {**document, "fields": []})
        return replace(result, fields=read_fields(document["fields"], file.parent)), file
    except (KeyError, IndexError, TypeError, ValueError) as error:
        what = shortened(f"{type(error).__name__}: {error}".replace("\n", " "))
        raise UsageError(f"{shortened(str(file), WIDEST_PLACE)}: is damaged ({what}); {AGAIN}") from None


# failure.json: what a run without convergence leaves to look at.

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
