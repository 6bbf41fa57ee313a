"""Coupled thermal-dynamic design checker for back-to-back gear test rigs.

from rigdesign import load_case, run_case
result = run_case(load_case("cases/uhcf_prototype"))
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rigdesign.case import load_case
    from rigdesign.run.main import run_case

__version__ = "0.1.0"
__all__ = ["__version__", "load_case", "run_case"]

_HOMES = {"load_case": "rigdesign.case", "run_case": "rigdesign.run.main"}


def __getattr__(name: str) -> object:
    """Import the two entry points on first use, so that `import rigdesign` stays light."""
    if name in _HOMES:
        return getattr(import_module(_HOMES[name]), name)
    raise AttributeError(f"module 'rigdesign' has no attribute {name!r}")
