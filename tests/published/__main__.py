"""Renew the rows that the package ships: ``python -m tests.published`` from the root of the project.

Prints every row that is new, gone or has moved; read them, and say in the commit why. Some minutes.
"""

import time

from threadpoolctl import threadpool_limits

from rigdesign import load_case
from rigdesign.run.main import run_case
from rigdesign.validation import published_rows, validation_json
from tests.builders.paths import CASES
from tests.published.rows import moved
from tests.published.table import topics


def main() -> None:
    """Compute every topic, print what differs from the file, write the file."""
    rows = []
    for title, compute in topics(lambda name: run_case(load_case(CASES / name), "standard")).items():
        started = time.perf_counter()
        with threadpool_limits(limits=1):
            rows += compute()
        print(f"{title}: {time.perf_counter() - started:.0f} s", flush=True)
    for line in moved(published_rows(), rows):
        print(line)
    file = CASES.parent / "rigdesign" / "published_rows.json"
    file.write_text(validation_json(rows), encoding="utf-8")


if __name__ == "__main__":
    main()
