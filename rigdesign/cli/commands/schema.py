"""`rigdesign schema`: the JSON Schema of the case file, and the reference of its keys."""

import sys
from typing import Annotated

from cyclopts import Parameter

from rigdesign.cli.application import app, print_json


@app.command
def schema(*, reference: Annotated[bool, Parameter(negative=())] = False) -> int:
    """Print the JSON Schema of the case file, for editors.

    Parameters
    ----------
    reference
        Print the key reference instead: every key with kind, units, default and what it is, as Markdown.
    """
    if reference:
        from rigdesign.explanation.reference import key_reference

        sys.stdout.write(key_reference())
        return 0
    from rigdesign.case import json_schema

    print_json(json_schema())
    return 0
