"""What stops a run: every kind of failure below comes out as the error, and exit status, it is."""

from pathlib import Path

import numpy as np
import pytest

from rigdesign import load_case
from rigdesign.base import system
from rigdesign.base.errors import (
    CaseError,
    MissingLibraryError,
    NotConvergedError,
    RigdesignError,
    UsageError,
)
from rigdesign.run import main as run

PROTOTYPE = Path(__file__).parents[2] / "cases" / "uhcf_prototype"


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
        (ValueError("width = 0: too thin; widen it"), CaseError, ("case.toml", "too thin")),
        (RuntimeError("residual 1, limit 0"), NotConvergedError, ("residual 1",)),
    ],
)
def test_failures_keep_their_kind(
    raised: Exception, kind: type[RigdesignError], words: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise raised

    monkeypatch.setattr(run, "solve_case", fail)
    monkeypatch.setattr(run, "missing_gmsh_libraries", list)
    with pytest.raises(RigdesignError) as caught:
        run.run_case(load_case(PROTOTYPE), "quick")
    assert type(caught.value) is kind
    assert all(word in str(caught.value) for word in words)


def test_a_missing_shared_library_names_the_packages(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise OSError("libGLU.so.1: cannot open shared object file")

    monkeypatch.setattr(run, "solve_case", fail)
    monkeypatch.setattr(run, "missing_gmsh_libraries", lambda: ["libGLU.so.1"])
    with pytest.raises(MissingLibraryError, match=system.APT_LINE):
        run.run_case(load_case(PROTOTYPE), "quick")
