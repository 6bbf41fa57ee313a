"""A dask scheduler and workers on loopback, started as a user starts them."""

import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from tests.builders.paths import ROOT

STARTED_WITHIN = 90.0
OTHER_VERSION = {
    "rigdesign/__init__.py": "",
    "rigdesign/base/__init__.py": "",
    "rigdesign/base/version.py": "__version__ = '0.0.9'\n",
}
NO_RIGDESIGN = {"sitecustomize.py": "import sys\nsys.modules['rigdesign'] = None\n"}
"""Files of a folder that stands before all others where a process looks for modules."""


@dataclass
class Cluster:
    """Address of the scheduler and its processes; a worker is a process of its own, without a nanny."""

    address: str
    folder: Path
    scheduler: subprocess.Popen
    workers: list[subprocess.Popen] = field(default_factory=list)

    def add_worker(self, *options: str, before: dict[str, str] | None = None) -> subprocess.Popen:
        worker = _start(
            self.folder, f"worker-{len(self.workers)}", before, "worker", self.address, "--nthreads", "1",
            "--local-directory", str(self.folder), *options,
        )  # fmt: skip
        self.workers.append(worker)
        return worker

    def await_workers(self) -> None:
        """Until all have reached the scheduler."""
        from distributed import Client

        with Client(self.address, set_as_default=False) as client:
            client.wait_for_workers(len(self.workers), timeout=STARTED_WITHIN)

    def stop_workers(self) -> None:
        for worker in self.workers:
            worker.terminate()
        for worker in self.workers:
            worker.wait(timeout=STARTED_WITHIN)
        self.workers.clear()


@contextmanager
def cluster(folder: Path, *, before: dict[str, str] | None = None) -> Iterator[Cluster]:
    """A scheduler without workers; a point may cost one worker before it is given up."""
    file = folder / "scheduler.json"
    scheduler = _start(
        folder,
        "scheduler",
        before,
        "scheduler",
        "--host",
        "127.0.0.1",
        "--port",
        "0",
        "--scheduler-file",
        str(file),
    )
    running = None
    try:
        until = time.monotonic() + STARTED_WITHIN
        while not (file.exists() and file.read_text().endswith("}")):
            assert scheduler.poll() is None and time.monotonic() < until, (
                folder / "scheduler.log"
            ).read_text()
            time.sleep(0.05)
        running = Cluster(json.loads(file.read_text())["address"], folder, scheduler)
        yield running
    finally:
        if running is not None:
            running.stop_workers()
        scheduler.terminate()
        scheduler.wait(timeout=STARTED_WITHIN)


def _start(folder: Path, name: str, before: dict[str, str] | None, *arguments: str) -> subprocess.Popen:
    path = [str(ROOT)]
    if before is not None:
        for file, text in before.items():
            (folder / f"{name}-modules" / file).parent.mkdir(parents=True, exist_ok=True)
            (folder / f"{name}-modules" / file).write_text(text)
        path.insert(0, str(folder / f"{name}-modules"))
    environment = {
        **os.environ, "PYTHONPATH": os.pathsep.join(path), "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "1",
    }  # fmt: skip
    with (folder / f"{name}.log").open("w") as log:
        return subprocess.Popen(
            [sys.executable, "-m", "dask", *arguments, "--no-dashboard"],
            cwd=folder, env=environment, stdout=log, stderr=subprocess.STDOUT,
        )  # fmt: skip
