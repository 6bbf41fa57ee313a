"""Three tasks of which one kills its process after another has finished; a program of its own for a test."""

import json
import os
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from rigdesign.base.worker_pool import ProcessWorkers


@dataclass(frozen=True)
class Marked:
    """A task that leaves a file each time it is computed."""

    folder: str
    number: int


def mark_or_die(task: Marked) -> int:
    """The number of the task; number 1 ends its process as soon as number 2 is done."""
    (Path(task.folder) / f"{task.number}-{time.monotonic_ns()}").touch()
    if task.number == 1:
        while not (Path(task.folder) / "done-2").exists():
            time.sleep(0.01)
        time.sleep(0.5)  # until the outcome of 2 is with the pool
        os._exit(9)
    (Path(task.folder) / f"done-{task.number}").touch()
    return task.number


def main(folder: Path) -> None:
    """Compute the tasks and write what was found to found.json."""
    with ProcessWorkers(2) as workers:
        outcomes = workers.compute(mark_or_die, [Marked(str(folder), number) for number in range(3)])
        found = [next(outcomes)]
        end = time.monotonic() + 60.0
        while not (folder / "done-2").exists() and time.monotonic() < end:
            time.sleep(0.05)
        time.sleep(1.5)  # 1 dies after it, before anybody asks
        found += outcomes
    (folder / "found.json").write_text(json.dumps(found), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
