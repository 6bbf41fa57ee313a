"""`rigdesign report`: a finished check printed again; nothing is solved."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from rigdesign.base.errors import UsageError
from rigdesign.cli.application import OptionalOutFolder, app


@app.command
def report(
    result: Path,
    /,
    *,
    html: Annotated[bool, Parameter(negative=())] = False,
    pdf: Annotated[bool, Parameter(negative=())] = False,
    out: OptionalOutFolder = None,
    author: str | None = None,
    everything: Annotated[bool, Parameter(name="--all", negative=())] = False,
) -> int:
    """Print a finished check again and write its report; nothing is solved, the verdict is that of the run.

    The report is made from results.json, with pictures of temperatures as far as its fields/*.vtu stand beside it. The
    exit status is 0 whatever the verdict.

    Parameters
    ----------
    result
        Folder of `rigdesign check --out`, or its results.json.
    html
        Write report.html.
    pdf
        Write report.pdf (extra pdf: WeasyPrint).
    out
        Folder for them, that of the result where left out.
    author
        Who prepares the report, in place of document.author of the case.
    everything
        Print every check and every note, not only what decides.
    """
    from rigdesign.cli.terminal.checks import print_checks
    from rigdesign.report import Issue, write_report
    from rigdesign.report.results_json import read_result

    if not (html or pdf) and (out is not None or author is not None):
        option = "--out" if out is not None else "--author"
        raise UsageError(f"{option} says nothing without a report to write; add --html or --pdf")
    if pdf:
        from rigdesign.report.pdf import require_pdf

        require_pdf()
    found, file = read_result(result)
    print_checks(found, None, everything=everything)
    if html or pdf:
        for path in write_report(found, out or file.parent, Issue(author=author or ""), html=html, pdf=pdf):
            print(f"report: {path}")
    return 0
