"""A quiet, single-threaded gmsh that gives the same mesh every time.

gmsh is imported when a mesh is built; a machine that lacks one of its system libraries gets the loader's own OSError.
"""

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

    gmsh.initialize(argv=["gmsh"], readConfigFiles=False, interruptible=False)
    try:
        for option, value in OPTIONS.items():
            gmsh.option.setNumber(option, value)
        yield gmsh
    finally:
        gmsh.finalize()
