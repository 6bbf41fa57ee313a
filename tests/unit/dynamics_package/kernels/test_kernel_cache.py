"""Compiled loops on disk are never older than the sources they were made from.

numba keeps a compiled function by the content of its own file, with what other files gave to it compiled in. A mark
of all sources in every file that takes from another makes it new whenever one of them is.
"""

import os
import re
from hashlib import sha256
from pathlib import Path

import pytest

import dynamics.kernels
from thermal.fe.kernel_cache import remove_outdated

FOLDER = Path(dynamics.kernels.__file__).parent
MARK = re.compile(r"^# compiled from sources ([0-9a-f]{8})$", re.MULTILINE)
SOURCES = {path.stem: path.read_text() for path in sorted(FOLDER.glob("*.py")) if path.stem != "__init__"}


@pytest.mark.parametrize("name", [name for name, text in SOURCES.items() if "from dynamics.kernels" in text])
def test_compiled_loops_are_made_anew_with_their_sources(name: str) -> None:
    whole = "\n".join(MARK.sub("# compiled from sources", text) for text in SOURCES.values())
    now = sha256(whole.encode()).hexdigest()[:8]
    assert MARK.findall(SOURCES[name]) == [now], (
        f"write '# compiled from sources {now}' into kernels/{name}.py"
    )


def test_indices_older_than_a_source_are_removed_and_newer_ones_stay(tmp_path: Path) -> None:
    """numba unpickles the types of an index before it looks at its stamp: a class that has gone ends the run."""
    (tmp_path / "__pycache__").mkdir()
    files = {
        "a.py": 100.0,
        "b.py": 200.0,
        "__pycache__/a.f-1.py311.nbi": 150.0,
        "__pycache__/b.g-1.py311.nbi": 300.0,
    }
    for name, time in files.items():
        (tmp_path / name).write_text("")
        os.utime(tmp_path / name, (time, time))
    remove_outdated(tmp_path)
    assert [path.name for path in tmp_path.glob("__pycache__/*")] == ["b.g-1.py311.nbi"]


def test_a_folder_without_sources_is_left_alone(tmp_path: Path) -> None:
    remove_outdated(tmp_path / "nothing")
