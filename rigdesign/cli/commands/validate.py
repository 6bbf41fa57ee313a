"""`rigdesign validate`: published numbers against ours."""

from rigdesign.cli.application import OptionalOutFolder, app, print_json
from rigdesign.cli.ending import NOTHING_KEPT, interrupted


@app.command
def validate(*, out: OptionalOutFolder = None, json: bool = False, quick: bool = False) -> int:
    """Print every published number against ours, with the assumption it depends on.

    Parameters
    ----------
    out
        Folder for validation.html, validation.json and validation.csv.
    json
        Print the rows as JSON on stdout.
    quick
        Leave out the rows that need a run of the prototype case.
    """
    from rigdesign.cli.terminal.progress import Progress
    from rigdesign.cli.terminal.validation import print_validation
    from rigdesign.report import prepare_output
    from rigdesign.report.pages.validation import write_validation
    from rigdesign.validation import validation_document, validation_rows

    if out is not None:
        prepare_output(out)
    with Progress() as progress, interrupted(NOTHING_KEPT):
        rows = validation_rows(with_run=not quick, progress=progress)
    if out is not None:
        write_validation(rows, out)
    if json:
        print_json(validation_document(rows))
    else:
        print_validation(rows)
        if out is not None:
            print(out / "validation.html")
    return 1 if any(row.verdict == "gate missed" for row in rows) else 0
