"""`rigdesign validate`: published numbers against ours."""

from rigdesign.cli.application import OptionalOutFolder, app, print_json


@app.command
def validate(*, out: OptionalOutFolder = None, json: bool = False) -> int:
    """Print every published number against ours, with the assumption it depends on.

    The rows ship with the tool; the tests of its source compute them again.

    Parameters
    ----------
    out
        Folder for validation.html, validation.json and validation.csv.
    json
        Print the rows as JSON on stdout.
    """
    from rigdesign.cli.terminal.validation import print_validation
    from rigdesign.validation import published_rows, validation_document

    rows = published_rows()
    if out is not None:
        from rigdesign.base.output_folder import prepare_output
        from rigdesign.report.pages.validation import write_validation

        prepare_output(out)
        write_validation(rows, out)
    if json:
        print_json(validation_document(rows))
    else:
        print_validation(rows)
        if out is not None:
            print(out / "validation.html")
    return 1 if any(row.verdict == "gate missed" for row in rows) else 0
