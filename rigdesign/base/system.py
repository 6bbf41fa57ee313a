"""What the tool needs from the machine: system libraries, compiled kernels, a place for the cache."""

import ctypes
import importlib
import sys
from dataclasses import dataclass

GMSH_LIBRARIES = {
    "libGL.so.1": "libgl1",
    "libGLU.so.1": "libglu1-mesa",
    "libXcursor.so.1": "libxcursor1",
    "libXft.so.2": "libxft2",
    "libXinerama.so.1": "libxinerama1",
    "libgomp.so.1": "libgomp1",
}
"""Shared libraries the gmsh wheel loads, and the Debian package of each."""

APT_LINE = "apt-get install -y --no-install-recommends " + " ".join(GMSH_LIBRARIES.values())

PYTHON_LIBRARIES = (
    "numpy", "scipy", "numba", "skfem", "meshio", "CoolProp", "ht", "pydantic", "pint", "cyclopts", "rich",
    "jinja2", "matplotlib", "junitparser",
)  # fmt: skip


@dataclass(frozen=True)
class MachineFinding:
    """One line of `rigdesign doctor`."""

    subject: str
    ok: bool
    text: str


def missing_gmsh_libraries() -> list[str]:
    """Names of the shared libraries gmsh needs and the dynamic loader does not find."""
    missing = []
    for name in GMSH_LIBRARIES:
        try:
            ctypes.CDLL(name)
        except OSError:
            missing.append(name)
    return missing


def gmsh_remedy(missing: list[str]) -> str:
    """The sentence that tells a user how to get gmsh to load."""
    what = ", ".join(missing) if missing else "a shared library"
    return f"gmsh cannot be loaded: {what} is missing; on Debian or Ubuntu run: {APT_LINE}"


def diagnose() -> list[MachineFinding]:
    """Look at the interpreter, the Python libraries, gmsh's system libraries and the kernel cache."""
    return [_python(), *(_library(name) for name in PYTHON_LIBRARIES), _gmsh(), _kernels()]


def _python() -> MachineFinding:
    version = ".".join(map(str, sys.version_info[:3]))
    return MachineFinding("python", sys.version_info >= (3, 11), f"{version} (3.11 or newer is needed)")


def _library(name: str) -> MachineFinding:
    try:
        module = importlib.import_module(name)
    except (ImportError, OSError) as error:
        return MachineFinding(
            name, False, f"{error}; reinstall with: pip install --force-reinstall rigdesign"
        )
    return MachineFinding(name, True, str(getattr(module, "__version__", "present")))


def _gmsh() -> MachineFinding:
    missing = missing_gmsh_libraries()
    if missing:
        return MachineFinding("gmsh", False, gmsh_remedy(missing))
    try:
        module = importlib.import_module("gmsh")
    except (ImportError, OSError) as error:
        return MachineFinding("gmsh", False, f"{error}; {gmsh_remedy([])}")
    return MachineFinding("gmsh", True, str(module.__version__))


def _kernels() -> MachineFinding:
    """Compile (or load) the kernels once, so that the first check does not pay for it."""
    try:
        importlib.import_module("dynamics.kernels")
        importlib.import_module("thermal.fe.assembly")
    except (ImportError, OSError, RuntimeError) as error:
        return MachineFinding("kernels", False, f"{error}; set NUMBA_CACHE_DIR to a writable folder")
    return MachineFinding("kernels", True, "compiled kernels load")
