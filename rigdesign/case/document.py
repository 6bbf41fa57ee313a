"""Who answers for a report: nothing of it enters a result."""

from rigdesign.case.fields import Part, Text


class Document(Part):
    """What the first page of the report prints above the lines for the signatures."""

    project: Text | None = None
    """Project or customer the check belongs to."""
    number: Text | None = None
    """Number of the document in the reader's own filing."""
    author: Text | None = None
    """Who prepared the check."""
    checked_by: Text | None = None
    """Who checks it."""
    approved_by: Text | None = None
    """Who releases the rig on it."""
