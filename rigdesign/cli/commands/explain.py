"""`rigdesign explain`: what a case, one of its keys or one of its checks is."""

import sys
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from rigdesign.base.errors import UsageError
from rigdesign.cli.application import app, loaded_case, print_json


@app.command
def explain(
    case: Path,
    path: str | None = None,
    /,
    *,
    check: str | None = None,
    results: Path | None = None,
    json: Annotated[bool, Parameter(negative=())] = False,
) -> int:
    """Say what a case holds, what a key is and what it moves, or how a check is computed; nothing is solved.

    Parameters
    ----------
    case
        Case folder or its case.toml.
    path
        Key or part of the case, e.g. gearboxes.test.oil.inlet_temperature; * stands for any name. Left out: an
        overview of the case.
    check
        Id of a check, e.g. clearance.backlash: its rule, limit, procedure and inputs.
    results
        With --check: folder of a finished check; with its ranges the inputs are sorted by how far they move the margin.
    json
        Print the explanation as JSON on stdout.
    """
    if path is not None and check is not None:
        raise UsageError(f"a path ({path}) and --check {check} are two questions; leave one of them out")
    if results is not None and check is None:
        raise UsageError(f"--results {results} belongs to a check; add --check ID")
    loaded = loaded_case(case)
    from dataclasses import asdict

    from rigdesign.cli.terminal.explanation import print_check, print_overview, print_path

    if check is not None:
        from rigdesign.explanation.check import explain_check, finished_check

        finished = None if results is None else finished_check(results, check, loaded)
        found = explain_check(loaded, check, finished)
        print_json(asdict(found)) if json else print_check(found, case)
    elif path is not None:
        from rigdesign.explanation.keys import explain_path

        key = explain_path(loaded, path)
        print_json(asdict(key)) if json else print_path(key)
    else:
        from rigdesign.explanation.overview import overview

        seen = overview(loaded)
        print_json(asdict(seen)) if json else print_overview(seen, case)
    return 0


# `rigdesign schema`: the JSON Schema of the case file, and the reference of its keys.


@app.command
def schema(
    *,
    reference: Annotated[bool, Parameter(negative=())] = False,
    results: Annotated[bool, Parameter(negative=())] = False,
) -> int:
    """Print the JSON Schema of the case file, for editors.

    Parameters
    ----------
    reference
        Print the key reference instead: every key with kind, units, default and what it is, as Markdown.
    results
        Print the JSON Schema of results.json instead: every key with its unit.
    """
    if results:
        from rigdesign.report.results_json import results_schema

        print_json(results_schema())
        return 0
    if reference:
        from rigdesign.explanation.keys import key_reference

        sys.stdout.write(key_reference())
        return 0
    from rigdesign.case import json_schema

    print_json(json_schema())
    return 0


# `rigdesign list`: what the tool brings along.


@app.command(name="list")
def list_built_in(
    kind: Literal["bearings", "oils", "materials", "fluids", "limits"],
    words: tuple[str, ...] = (),
    /,
    *,
    json: Annotated[bool, Parameter(negative=())] = False,
) -> int:
    """List the built-in bearings, oils, materials and fluids, or the limits with their defaults, units and sources.

    Parameters
    ----------
    kind
        What to list.
    words
        Only what holds all these words, e.g. `rigdesign list bearings tapered 40`.
    json
        Print the list as JSON on stdout.
    """
    from dataclasses import asdict

    from rigdesign.cli.terminal.explanation import print_built_in
    from rigdesign.explanation.built_in import built_in

    found = built_in(kind, words)
    print_json(asdict(found)) if json else print_built_in(found)
    return 0
