"""Compiled loops on disk are never older than the sources they were made from.

numba keeps a compiled function by the content of its own file, with what other files gave to it compiled in: the
folder of the kernels is named after all of them.
"""

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.builders.paths import ROOT
from thermal.fe import kernel_cache
from thermal.fe.kernel_cache import COMPILED, cache_folder, place_kernels, sources_hash


def test_the_folder_of_the_kernels_is_named_after_every_file_with_compiled_code() -> None:
    compiled = {
        path
        for package in ("dynamics", "thermal", "rigdesign")
        for path in (ROOT / package).rglob("*.py")
        if "import njit" in path.read_text() or "numba.njit" in path.read_text()
    }
    assert compiled <= {path for pattern in COMPILED for path in ROOT.glob(pattern)}
    assert Path(os.environ["NUMBA_CACHE_DIR"]).name == f"kernels-{sources_hash()}"


def test_other_sources_have_another_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = sources_hash()
    for pattern in COMPILED:
        for path in ROOT.glob(pattern):
            copy = tmp_path / path.relative_to(ROOT)
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(path.read_bytes())
    monkeypatch.setattr(kernel_cache, "__file__", str(tmp_path / "thermal" / "fe" / "kernel_cache.py"))
    assert sources_hash() == before
    (tmp_path / "dynamics" / "kernels" / "drag.py").write_text("")
    assert sources_hash() != before


def test_processes_that_a_process_starts_share_its_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Kernels of other sources go when nothing was added to them for a month."""
    old, new = tmp_path / "kernels-old", tmp_path / "kernels-new"
    for folder in (old, new):
        folder.mkdir()
    os.utime(old, (0.0, 0.0))
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    for _ in range(2):
        place_kernels()
        assert os.environ["NUMBA_CACHE_DIR"] == str(tmp_path / f"kernels-{sources_hash()}")
    assert new.is_dir() and not old.exists()


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
