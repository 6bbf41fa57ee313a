"""The rows that `rigdesign validate` prints are those that are computed."""

import pytest

from rigdesign import load_case
from rigdesign.results.result import RunResult
from rigdesign.run.main import run_case
from rigdesign.validation import published_rows
from tests.builders.paths import CASES
from tests.builders.shared_runs import shipped_run
from tests.published.rows import moved
from tests.published.table import topics


def run(name: str) -> RunResult:
    return run_case(load_case(CASES / name), "standard") if "/" in name else shipped_run(name)


TOPICS = topics(run)


@pytest.mark.parametrize("title", TOPICS)
def test_rows_of_a_topic_are_as_shipped(title: str) -> None:
    """Within half a per cent; after a change with a good reason: ``python -m tests.published``."""
    rows, shipped = list(TOPICS[title]()), published_rows()
    first = [row.id for row in shipped].index(rows[0].id)
    assert moved(shipped[first : first + len(rows)], rows) == []
