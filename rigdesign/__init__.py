"""Coupled thermal-dynamic design checker for back-to-back gear test rigs.

from rigdesign import load_case, run_case
result = run_case(load_case("cases/uhcf_prototype"))
"""

from importlib import import_module
from typing import TYPE_CHECKING

from rigdesign.base.errors import (
    CaseError,
    MeasurementError,
    MissingLibraryError,
    NotConvergedError,
    OutputError,
    RigdesignError,
    UsageError,
)
from rigdesign.base.version import __version__

if TYPE_CHECKING:
    from rigdesign.api import compare, diagnose, run_case, save, study
    from rigdesign.case import Case, load_case
    from rigdesign.prediction.predict import predict
    from rigdesign.results.result import RunResult
    from rigdesign.studies.design import StudyDesign
    from rigdesign.studies.run import Execution

__all__ = [
    "Case",
    "CaseError",
    "Execution",
    "MeasurementError",
    "MissingLibraryError",
    "NotConvergedError",
    "OutputError",
    "RigdesignError",
    "RunResult",
    "StudyDesign",
    "UsageError",
    "__version__",
    "compare",
    "diagnose",
    "load_case",
    "predict",
    "run_case",
    "save",
    "study",
]

_HOMES = {
    "Case": "rigdesign.case",
    "Execution": "rigdesign.studies.run",
    "RunResult": "rigdesign.results.result",
    "StudyDesign": "rigdesign.studies.design",
    "compare": "rigdesign.api",
    "diagnose": "rigdesign.api",
    "load_case": "rigdesign.case",
    "predict": "rigdesign.prediction.predict",
    "run_case": "rigdesign.api",
    "save": "rigdesign.api",
    "study": "rigdesign.api",
}


def __getattr__(name: str) -> object:
    """Import an entry point on first use, so that `import rigdesign` stays light."""
    if name in _HOMES:
        return getattr(import_module(_HOMES[name]), name)
    raise AttributeError(f"module 'rigdesign' has no attribute {name!r}")


def __dir__() -> list[str]:
    return list(__all__)
