"""Compiled loops on disk are never older than the sources they were made from.

numba keeps a compiled function by the content of its own file, with what other files gave to it compiled in. A mark
of all sources in every file that takes from another makes it new whenever one of them is.
"""

import re
from hashlib import sha256
from pathlib import Path

import pytest

import dynamics.kernels

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
