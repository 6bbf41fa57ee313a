"""Output folders of runs that were stopped."""

import json
import subprocess
import sys
from pathlib import Path

from rigdesign.report.writing import write_results
from tests.builders.paths import ROOT
from tests.builders.report import small_result


def attempts(mode: str, folder: Path, steps: tuple[int, ...]) -> list[int]:
    """How each child ended."""
    ended = subprocess.run(
        [sys.executable, "-m", "tests.builders.killed_writer", mode, str(folder), *map(str, steps)],
        cwd=ROOT, capture_output=True, text=True, check=True, timeout=900,
    )  # fmt: skip
    found: list[int] = json.loads(ended.stdout)
    return found


def published(out: Path) -> dict[str, bytes]:
    """Files of an output folder outside of staging folders."""
    files = {path.relative_to(out).as_posix(): path for path in out.rglob("*") if path.is_file()}
    return {name: path.read_bytes() for name, path in files.items() if not name.startswith(".rigdesign-")}


def held_against(out: Path, whole: dict[str, bytes]) -> None:
    """Only whole files, all of them where results.json is; the next run completes and clears the folder."""
    found = published(out)
    assert all(whole[name] == content for name, content in found.items())
    assert "results.json" not in found or found.keys() == whole.keys()
    write_results(small_result(), out)
    assert published(out) == whole
    assert not list(out.glob(".rigdesign-*"))
