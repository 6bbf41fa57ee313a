"""Compiled loops on disk are never older than the sources they were made from.

numba keeps a compiled function by the content of its own file, with what other files gave to it compiled in. A mark
of all sources in every file that takes from another makes it new whenever one of them is.
"""

import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from hashlib import sha256
from pathlib import Path

import pytest

import dynamics.kernels
from tests.builders.paths import ROOT
from thermal.fe import kernel_cache
from thermal.fe.kernel_cache import cache_folder, remove_outdated

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


def test_indices_older_than_a_source_are_removed_and_newer_ones_stay(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """numba unpickles the types of an index before it looks at its stamp: a class that has gone ends the run."""
    (tmp_path / "__pycache__").mkdir()
    placed = tmp_path / "placed" / f"{tmp_path.name}_0f1e"
    placed.mkdir(parents=True)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(placed.parent))
    files = {
        "a.py": 100.0,
        "b.py": 200.0,
        "__pycache__/a.f-1.py311.nbi": 150.0,
        "__pycache__/b.g-1.py311.nbi": 300.0,
        f"placed/{placed.name}/a.f-1.py311.nbi": 150.0,
        f"placed/{placed.name}/b.g-1.py311.nbi": 300.0,
    }
    for name, time in files.items():
        (tmp_path / name).write_text("")
        os.utime(tmp_path / name, (time, time))
    remove_outdated(tmp_path)
    for folder in (tmp_path / "__pycache__", placed):
        assert [path.name for path in folder.iterdir()] == ["b.g-1.py311.nbi"]


def test_a_folder_without_sources_is_left_alone(tmp_path: Path) -> None:
    remove_outdated(tmp_path / "nothing")


@pytest.fixture
def user(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A home, a folder for temporary files beside it, and nothing stated."""
    for name in ("RIGDESIGN_CACHE_DIR", "XDG_CACHE_HOME", "NUMBA_CACHE_DIR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    for name in ("home", "temporary", "read_only"):
        (tmp_path / name).mkdir()
    monkeypatch.setattr(os, "access", lambda folder, mode: "read_only" not in str(folder))
    kernel_cache._temporary_folder.cache_clear()
    yield tmp_path
    kernel_cache._temporary_folder.cache_clear()


@pytest.mark.parametrize(
    ("stated", "folder"),
    [
        ({}, "home/.cache/rigdesign"),
        ({"XDG_CACHE_HOME": ""}, "home/.cache/rigdesign"),
        ({"XDG_CACHE_HOME": "relative"}, "home/.cache/rigdesign"),
        ({"XDG_CACHE_HOME": "{}/read_only"}, "temporary/rigdesign-{}"),
        ({"HOME": "{}/read_only"}, "temporary/rigdesign-{}"),
        ({"HOME": None}, "temporary/rigdesign-{}"),
        ({"RIGDESIGN_CACHE_DIR": "{}/read_only"}, "read_only"),
    ],
)
def test_caches_have_a_folder_whatever_the_user_has(
    stated: dict[str, str | None], folder: str, user: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "getuid", lambda: 54321)  # without a passwd entry
    monkeypatch.setattr(Path, "lstat", lambda path: os.stat_result((0o40700, 0, 0, 1, 54321, *[0] * 5)))
    for name, value in stated.items():
        monkeypatch.delenv(name, raising=False) if value is None else monkeypatch.setenv(
            name, value.format(user)
        )
    assert cache_folder() == user / folder.format(54321)


def test_a_folder_of_somebody_else_is_not_used(user: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """numba would run the code in it."""
    monkeypatch.setenv("HOME", str(user / "read_only"))
    planted = user / "temporary" / f"rigdesign-{os.getuid()}"
    planted.mkdir()
    planted.chmod(0o777)
    assert cache_folder() != planted and cache_folder().is_dir()
    assert cache_folder().stat().st_mode & 0o077 == 0


READ_ONLY = """
for folder in "$ROOT" "$HOME"; do
    mount --bind "$folder" "$folder" && mount -o remount,ro,bind "$folder" || exit 77
done
exec "$PYTHON" -m rigdesign explain loop_1to1 gearboxes.test.gears.pinion.face_width
"""


@pytest.mark.skipif(sys.platform != "linux", reason="needs mount namespaces")
def test_it_runs_from_a_read_only_installation_without_a_home(tmp_path: Path) -> None:
    (tmp_path / "home").mkdir()
    unset = ("RIGDESIGN_CACHE_DIR", "XDG_CACHE_HOME", "NUMBA_CACHE_DIR")
    environment = {name: value for name, value in os.environ.items() if name not in unset}
    environment |= {"ROOT": str(ROOT), "PYTHON": sys.executable, "PYTHONPATH": str(ROOT)}
    environment |= {"HOME": str(tmp_path / "home"), "TMPDIR": str(tmp_path)}
    done = subprocess.run(
        ["unshare", "--mount", "sh", "-c", READ_ONLY],
        env=environment,
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    if done.returncode == 77 or "unshare" in done.stderr:
        pytest.skip("no right to mount")
    assert done.returncode == 0, done.stderr
    assert done.stderr.count("\n") == 1 and f"caches are in {tmp_path}/rigdesign-" in done.stderr
    assert "Width of the toothing" in done.stdout and not list((tmp_path / "home").iterdir())
