"""`rigdesign schema`: the JSON Schema of the case file."""

from rigdesign.cli.application import app, print_json


@app.command
def schema() -> int:
    """Print the JSON Schema of the case file, for editors."""
    from rigdesign.case import json_schema

    print_json(json_schema())
    return 0
