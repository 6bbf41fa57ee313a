"""Where compiled kernels and other caches lie, all of which only save time.

A folder that the user names is taken as it is, also a read-only one; otherwise that of the user, or one of this user in
the folder for temporary files where there is none that can be written: a container without a home, a read-only disk.
numba keeps a compiled function by the content of its own file, with what other files gave to it compiled in, and reads
the types of an index before it looks at its stamp. The folder of the kernels is therefore named after all sources that
are compiled: beside them, or among the caches where that cannot be written.
"""

import os
import shutil
import stat
import sys
from contextlib import suppress
from functools import cache
from hashlib import sha256
from pathlib import Path
from time import time

GIVEN = "RIGDESIGN_CACHE_DIR"
"""Environment variable that names the folder."""
COMPILED = (
    "dynamics/kernels/*.py",
    "thermal/fe/kernels.py",
    "thermal/fe/assembly.py",
    "thermal/conditions/ray_kernel.py",
)
"""Files with compiled code, below the folder of the packages."""
KEPT = 30 * 86400.0
"""Seconds after which kernels of other sources go."""


def cache_folder() -> Path:
    """The folder; deleting it loses time only."""
    given = os.environ.get(GIVEN)
    if given:
        return Path(given)
    folder = user_folder()
    return folder if folder is not None and _writable(folder) else _temporary_folder()


def user_folder() -> Path | None:
    """The user's cache folder by the XDG rules; None for a user without a home."""
    stated = Path(os.environ.get("XDG_CACHE_HOME", ""))
    if stated.is_absolute():
        return stated / "rigdesign"
    with suppress(RuntimeError):
        home = Path.home()
        return home / ".cache" / "rigdesign" if home.is_absolute() else None
    return None


def place_kernels() -> None:
    """Give numba the folder of these sources; before the first kernel is decorated."""
    beside = Path(__file__).parent / "__pycache__"
    given = os.environ.get("NUMBA_CACHE_DIR")
    if given:
        folder = Path(given)
    elif _writable(beside):
        folder = beside
    else:
        folder = cache_folder() if _writable(cache_folder()) else _temporary_folder()
    name = f"kernels-{sources_hash()}"
    if folder.name == name:  # that of the process which started this one
        return
    _remove_unused(folder)
    os.environ["NUMBA_CACHE_DIR"] = str(folder / name)
    if "numba" in sys.modules:
        sys.modules["numba"].config.reload_config()


def sources_hash() -> str:
    """Of all files that hold compiled code."""
    root = Path(__file__).parents[2]
    texts = (path.read_bytes() for pattern in COMPILED for path in sorted(root.glob(pattern)))
    return sha256(b"\0".join(texts)).hexdigest()[:12]


def _remove_unused(folder: Path) -> None:
    """Remove the kernels of other sources that were last added to before `KEPT`."""
    with suppress(OSError):
        for old in folder.glob("kernels-*"):
            if time() - old.stat().st_mtime > KEPT:
                shutil.rmtree(old, ignore_errors=True)


def _writable(folder: Path) -> bool:
    """Whether files can be made in a folder, or the folder itself where it is absent."""
    try:
        while not folder.exists() and folder != folder.parent:
            folder = folder.parent
        return folder.is_dir() and os.access(folder, os.W_OK | os.X_OK)
    except OSError:
        return False


@cache
def _temporary_folder() -> Path:
    """Of this user alone: numba runs the code that lies in it."""
    import tempfile  # 20 ms that no other command needs

    owner = os.getuid() if hasattr(os, "getuid") else 0
    folder = Path(tempfile.gettempdir()) / f"rigdesign-{owner}"
    with suppress(OSError):
        folder.mkdir(mode=0o700)
    with suppress(OSError):
        made = folder.lstat()
        private = stat.S_ISDIR(made.st_mode) and made.st_uid == owner and not made.st_mode & 0o077
        if private or sys.platform == "win32":
            return folder
    return Path(tempfile.mkdtemp(prefix="rigdesign-"))
