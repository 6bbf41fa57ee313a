"""What stops a run: every kind of failure below comes out as the error, and exit status, it is."""

import pkgutil
from importlib import import_module
from types import ModuleType

import numpy as np
import pytest

import dynamics.errors
import thermal.errors
from dynamics.rotor.journal import BearingNotConvergedError
from dynamics.rotor.shaft import DrivetrainError
from dynamics.vibration.time_integration import MarchDiverged
from rigdesign import load_case
from rigdesign.base import system
from rigdesign.base.errors import (
    CaseError,
    MissingLibraryError,
    NotConvergedError,
    RigdesignError,
    UsageError,
)
from rigdesign.properties.oil import OilError
from rigdesign.run import main as run
from rigdesign.run import solver_errors
from tests.builders.paths import CASES
from thermal.fe.mesh import MeshError

PROTOTYPE = CASES / "uhcf_prototype"


@pytest.mark.parametrize(
    ("raised", "kind", "words"),
    [
        (OSError(28, "No space left on device"), UsageError, ("No space left", "free space")),
        (PermissionError(13, "Permission denied", "/x"), UsageError, ("Permission denied", "rights")),
        (
            ModuleNotFoundError("No module named 'CoolProp'", name="CoolProp"),
            MissingLibraryError,
            ("CoolProp cannot be loaded", "rigdesign doctor"),
        ),
        (
            ModuleNotFoundError("No module named 'gmsh'", name="gmsh"),
            MissingLibraryError,
            ("apt-get install",),
        ),
        (np.linalg.LinAlgError("Singular matrix"), NotConvergedError, ("Singular matrix", "stiffness")),
        (MeshError("width = 0: too thin; widen it"), CaseError, ("case.toml", "too thin")),
        (DrivetrainError("length = 0: too short"), CaseError, ("case.toml", "too short")),
        (OilError("viscosity = 0: too thin"), CaseError, ("case.toml", "too thin")),
        (MarchDiverged("residual 1, limit 0"), NotConvergedError, ("residual 1",)),
        (BearingNotConvergedError("residual 2, limit 0"), NotConvergedError, ("residual 2",)),
    ],
)
def test_failures_keep_their_kind(
    raised: Exception, kind: type[RigdesignError], words: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise raised

    monkeypatch.setattr(run, "solve_case", fail)
    monkeypatch.setattr(solver_errors, "missing_gmsh_libraries", list)
    with pytest.raises(RigdesignError) as caught:
        run.run_case(load_case(PROTOTYPE), "quick")
    assert type(caught.value) is kind
    assert all(word in str(caught.value) for word in words)


@pytest.mark.parametrize(
    "raised",
    [
        ValueError("operands could not be broadcast together with shapes (3,) (4,)"),
        RuntimeError("dictionary changed size during iteration"),
        NotImplementedError("not yet"),
        RecursionError("maximum recursion depth exceeded"),
        KeyError("growth"),
    ],
)
def test_a_defect_is_neither_the_case_s_fault_nor_lack_of_convergence(
    raised: Exception, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise raised

    monkeypatch.setattr(run, "solve_case", fail)
    with pytest.raises(type(raised)) as caught:
        run.run_case(load_case(PROTOTYPE), "quick")
    assert caught.value is raised


@pytest.mark.parametrize("package", [thermal, dynamics])
def test_what_a_solver_raises_on_purpose_has_its_root(package: ModuleType) -> None:
    """Every exception that a solver defines is below the root of its package, and is an input or no convergence."""
    root = next(
        value for name, value in vars(package.errors).items() if name in ("ThermalError", "DynamicsError")
    )
    defined = [
        value
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}.")
        for value in vars(import_module(module.name)).values()
        if isinstance(value, type)
        and issubclass(value, Exception)
        and value.__module__.startswith(package.__name__)
    ]
    kinds = tuple(
        value for value in vars(package.errors).values() if isinstance(value, type) and value is not root
    )
    assert len(set(defined)) > 6
    assert all(issubclass(value, kinds) for value in defined if value is not root)


def test_no_convergence_keeps_its_residuals(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise thermal.errors.ThermalNotConverged("stalled at 1e-3, limit 1e-9", (1.0, 0.1, 1e-3))

    monkeypatch.setattr(run, "solve_case", fail)
    with pytest.raises(NotConvergedError) as caught:
        run.run_case(load_case(PROTOTYPE), "quick")
    assert caught.value.history == {"residuals": [1.0, 0.1, 1e-3]}


def test_a_missing_shared_library_names_the_packages(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise OSError("libGLU.so.1: cannot open shared object file")

    monkeypatch.setattr(run, "solve_case", fail)
    monkeypatch.setattr(solver_errors, "missing_gmsh_libraries", lambda: ["libGLU.so.1"])
    with pytest.raises(MissingLibraryError, match=system.APT_LINE):
        run.run_case(load_case(PROTOTYPE), "quick")
