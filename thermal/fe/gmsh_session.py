"""A quiet, single-threaded gmsh that gives the same mesh every time.

gmsh is imported when a mesh is built; a machine that lacks one of its system libraries gets the loader's own OSError.
"""

import ctypes
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType

OPTIONS = {
    "General.Terminal": 0,
    "General.NumThreads": 1,
    "Mesh.RandomSeed": 1,
    "Mesh.Algorithm": 6,
    "Mesh.Algorithm3D": 1,
    "Mesh.MeshSizeFromPoints": 1,
    "Mesh.MeshSizeExtendFromBoundary": 1,
    "Mesh.MeshSizeFromCurvature": 0,
    "Mesh.Optimize": 1,
}


@contextmanager
def gmsh_session() -> Iterator[ModuleType]:
    """gmsh, finalised in any case.

    Raises OSError or ImportError, unchanged, where gmsh or a shared library it needs is missing.
    """
    import gmsh

    with _pipe_signal_kept():
        gmsh.initialize(argv=["gmsh"], readConfigFiles=False, interruptible=False)
    try:
        for option, value in OPTIONS.items():
            gmsh.option.setNumber(option, value)
        yield gmsh
    finally:
        gmsh.finalize()


@contextmanager
def _pipe_signal_kept() -> Iterator[None]:
    """What the process does at a closed pipe stays what it was.

    gmsh sets SIGPIPE back to its default, which ends the whole process without a word when a worker has died or a
    reader has closed; Python ignores it and raises. Not with `signal.signal`, which other threads may not call.
    """
    if not hasattr(signal, "SIGPIPE"):
        yield
        return
    kept = ctypes.create_string_buffer(256)  # a struct sigaction, 152 bytes on Linux
    system = ctypes.CDLL(None)
    system.sigaction(signal.SIGPIPE, None, kept)
    try:
        yield
    finally:
        system.sigaction(signal.SIGPIPE, kept, None)
