"""`rigdesign list`: what the tool brings along."""

from typing import Annotated, Literal

from cyclopts import Parameter

from rigdesign.cli.application import app, print_json


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
