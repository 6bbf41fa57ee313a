"""Compiled kernels on disk that are older than their sources are removed before numba reads them.

numba drops an outdated index by the stamp it holds, but it unpickles the argument types first: an index whose types
name a class that has moved or gone since ends in an AttributeError instead of a compilation.
"""

from contextlib import suppress
from pathlib import Path


def remove_outdated(folder: Path) -> None:
    """Remove the indices of compiled kernels in ``folder``'s ``__pycache__`` that are older than a source there.

    A folder that cannot be read or written is left as it is.
    """
    with suppress(OSError):
        newest = max((path.stat().st_mtime for path in folder.glob("*.py")), default=0.0)
        for index in (folder / "__pycache__").glob("*.nbi"):
            with suppress(OSError):
                if index.stat().st_mtime < newest:
                    index.unlink()
