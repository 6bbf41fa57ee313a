"""Whether the folder of a study holds the pages of another one, which those of this one will replace."""

import csv
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from rigdesign.studies.design import Plan

TABLE, STATUS = "results.csv", "status"
"""Table of a study, and its first column behind the varied values."""


def replaced_pages(out: Path, plan: Plan) -> Iterator[str]:
    """A sentence where ``out`` holds the table of a study with points that ``plan`` has not."""
    with suppress(OSError, UnicodeError, csv.Error, StopIteration):
        with (out / TABLE).open(encoding="utf-8", newline="") as file:
            rows = csv.reader(file)
            header = next(rows)
            paths = header[: header.index(STATUS)] if STATUS in header else []
            earlier = {tuple(zip(paths, row)) for row in rows} if paths else set()
        same_inputs = paths == [variation.path for variation in plan.variations]
        now = {tuple(point.values.items()) for point in plan.points}
        if not (earlier <= now or (plan.search is not None and same_inputs)):
            yield (
                f"{out} holds the pages of a study of {', '.join(paths)} with {len(earlier)} points: those of this "
                "study replace them; its points stay, and its command in this folder writes its pages again without "
                "computing; give another --out to keep both"
            )
