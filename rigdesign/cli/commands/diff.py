"""`rigdesign diff`: two results of `rigdesign check` against each other."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from rigdesign.cli.application import OptionalOutFolder, app, print_json


@app.command
def diff(
    a: Path,
    b: Path,
    /,
    *,
    out: OptionalOutFolder = None,
    json: bool = False,
    everything: Annotated[bool, Parameter(name="--all")] = False,
) -> int:
    """Say what differs between two results: inputs that changed, results that moved, verdicts that flipped.

    Differences are no failure: the exit status is 0 when both can be read.

    Parameters
    ----------
    a
        Folder of `rigdesign check --out`, or its results.json.
    b
        The other one, read as the later.
    out
        Folder for diff.json and diff.html.
    json
        Print diff.json on stdout.
    everything
        List everything that differs in the terminal, not the largest differences alone.
    """
    from rigdesign.cli.terminal.difference import print_difference
    from rigdesign.report.pages.difference import write_difference
    from rigdesign.studies.difference import difference_document, results_difference

    difference = results_difference(a, b)
    if out is not None:
        write_difference(difference, out)
    if json:
        print_json(difference_document(difference))
    else:
        print_difference(difference, out, everything=everything)
    return 0
