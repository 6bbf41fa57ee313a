"""The error tree: exit status of every class, messages, pickling across a process pool."""

import pickle

import pytest

from rigdesign.base import errors
from rigdesign.base.errors import CaseError, Fault, RigdesignError
from rigdesign.case import load_case
from rigdesign.coupling.bearing_loads import solve_bearings
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.model import build_rig
from tests.builders.paths import CASES

PROTOTYPE = CASES / "uhcf_prototype"


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
        name
        for name, kind in vars(errors).items()
        if isinstance(kind, type) and issubclass(kind, Exception) and kind.__module__ == errors.__name__
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


def test_a_part_is_named_before_what_its_solver_says() -> None:
    with pytest.raises(ZeroDivisionError), errors.named("a.b"):
        raise ZeroDivisionError("a defect stays as it is")
    with pytest.raises(CaseError, match=r"^no$"), errors.named("a.b"):
        raise CaseError("no")
    thin = load_case(PROTOTYPE).with_value("gearboxes.reference.bearings.wheel_rear.width", "3 mm")
    rig = build_rig(thin, "quick")
    point = held_points(rig)[-1]
    with pytest.raises(ValueError, match=r"^gearboxes\.reference\.bearings\.wheel_rear: .*B/D = 0\.075"):
        solve_bearings(rig, point, initial_state(rig, point))
    with pytest.raises(ValueError, match=r"^gearboxes\.reference\.meshes\.main: rack: "):
        build_rig(load_case(PROTOTYPE).with_value("gearboxes.reference.meshes.main.rack.dedendum", "6.1"))
