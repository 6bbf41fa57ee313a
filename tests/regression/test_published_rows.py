"""The rows that `rigdesign validate` prints are those that are computed."""

import pytest

from rigdesign.validation import published_rows
from tests.builders.shared_runs import shipped_run
from tests.published.rows import moved
from tests.published.table import topics

TOPICS = topics(shipped_run)


@pytest.mark.parametrize("title", TOPICS)
def test_rows_of_a_topic_are_as_shipped(title: str) -> None:
    """Within half a per cent; after a change with a good reason: ``python -m tests.published``."""
    rows, shipped = list(TOPICS[title]()), published_rows()
    first = [row.id for row in shipped].index(rows[0].id)
    assert moved(shipped[first : first + len(rows)], rows) == []
