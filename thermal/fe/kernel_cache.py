"""Where compiled kernels and other caches lie, all of which only save time.

A folder that the user names is taken as it is, also a read-only one; otherwise that of the user, or one of this user in
the folder for temporary files where there is none that can be written: a container without a home, a read-only disk.
numba keeps compiled kernels beside their sources and, where it cannot, there.

numba drops an outdated index by the stamp it holds, but it unpickles the argument types first: an index whose types
name a class that has moved or gone since ends in an AttributeError instead of a compilation. Indices older than their
sources are removed before it reads them.
"""

import os
import stat
import sys
from contextlib import suppress
from functools import cache
from pathlib import Path

GIVEN = "RIGDESIGN_CACHE_DIR"
"""Environment variable that names the folder."""


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
    """Give numba a folder where it has none; before the first kernel is decorated."""
    beside = Path(__file__).parent / "__pycache__"
    if os.environ.get("NUMBA_CACHE_DIR") or _writable(beside):
        return
    folder = cache_folder() if _writable(cache_folder()) else _temporary_folder()
    os.environ["NUMBA_CACHE_DIR"] = str(folder / "kernels")
    if "numba" in sys.modules:
        sys.modules["numba"].config.reload_config()


def remove_outdated(folder: Path) -> None:
    """Remove the indices of compiled kernels of ``folder`` that are older than a source there, wherever they lie.

    A folder that cannot be read or written is left as it is.
    """
    placed = os.environ.get("NUMBA_CACHE_DIR")  # there numba adds a hash to the name of the folder
    with suppress(OSError):
        newest = max((path.stat().st_mtime for path in folder.glob("*.py")), default=0.0)
        elsewhere = Path(placed).glob(f"{folder.name}_*/*.nbi") if placed else ()
        for index in (*(folder / "__pycache__").glob("*.nbi"), *elsewhere):
            with suppress(OSError):
                if index.stat().st_mtime < newest:
                    index.unlink()


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
