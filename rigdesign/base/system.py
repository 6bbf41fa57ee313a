"""What the tool needs from the machine: system libraries, memory, compiled kernels, a place for the cache."""

import ctypes
import importlib
import os
import sys
from dataclasses import dataclass
from pathlib import Path

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
    libraries = ", ".join(missing) if missing else "a shared library"
    return f"gmsh cannot be loaded: {libraries} is missing; on Debian or Ubuntu run: {APT_LINE}"


LOADED, ROOM = 0.6e9, 0.2e9
"""Address space that the libraries take when they are loaded, and that some library or matrix takes [bytes]."""


def memory_shortage(error: Exception | None = None) -> str:
    """That the process may use too little memory to load the libraries, or to go on after an error; else empty."""
    limit = _address_space()
    allowed = f"of {limit / 1e9:.2g} GB (ulimit -v) " if limit else ""
    if error is None:
        return (
            f"an address space {allowed}is too small: the libraries take {LOADED / 1e9:g} GB, a check 1.2 GB or more; "
            "raise the limit"
            if limit is not None and limit < LOADED
            else ""
        )
    if not isinstance(error, MemoryError) and (limit is None or limit - _used() > ROOM):
        return ""
    why = f"{type(error).__name__}: {error}"
    return f"the memory {allowed}is used up ({why}); give the process more, or a lower --fidelity"


def _address_space() -> int | None:
    """Limit of this process [bytes]; None where there is none."""
    if sys.platform == "win32":
        return None
    import resource

    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    return None if limit == resource.RLIM_INFINITY else limit


def _used() -> int:
    """Address space in use [bytes], where the system says it."""
    try:
        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
    except OSError:
        return 0
    return pages * os.sysconf("SC_PAGE_SIZE")


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
