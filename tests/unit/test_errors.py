"""The error tree: exit status of every class, messages, pickling across a process pool."""

import pickle

import pytest

from rigdesign import errors
from rigdesign.errors import CaseError, Fault, RigdesignError


@pytest.mark.parametrize(
    ("name", "status"),
    [
        ("RigdesignError", 1),
        ("CaseError", 2),
        ("UsageError", 2),
        ("OutputError", 2),
        ("NotConvergedError", 3),
        ("MissingLibraryError", 4),
        ("MeasurementError", 5),
    ],
)
def test_exit_status(name: str, status: int) -> None:
    kind = getattr(errors, name)
    assert issubclass(kind, RigdesignError)
    assert kind.exit_code == status
    assert f"{name} " in (errors.__doc__ or "")
    assert str(kind("why it stopped")) == "why it stopped"


def test_tree_is_drawn_completely() -> None:
    classes = {
        name for name, kind in vars(errors).items() if isinstance(kind, type) and issubclass(kind, Exception)
    }
    assert all(name in (errors.__doc__ or "") for name in classes)


def test_one_fault_is_one_line() -> None:
    error = CaseError(
        [Fault("oil.flow", '"-1 l/min"', "is not above 0 l/min", "write e.g. 5 l/min")], "case.toml"
    )
    assert str(error) == 'case.toml: oil.flow = "-1 l/min": is not above 0 l/min; write e.g. 5 l/min'


def test_several_faults_are_listed() -> None:
    faults = [Fault("a", "", "is missing", "add it"), Fault("", "", "is empty", "fill it")]
    error = pickle.loads(pickle.dumps(CaseError(faults, "case.toml")))
    assert str(error).splitlines() == [
        "case.toml: 2 faults",
        "  a: is missing; add it",
        "  case: is empty; fill it",
    ]
    assert error.faults == tuple(faults)
