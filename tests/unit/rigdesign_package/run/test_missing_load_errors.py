"""A check on dynamic loads whose discretisation error is not known is named."""

from types import SimpleNamespace
from typing import Any

import pytest

from rigdesign.run import mesh_convergence as load_errors
from rigdesign.run.warnings import _load_errors


def solved(known: tuple[str, ...], *, run: object = object()) -> Any:
    return SimpleNamespace(
        run=run,
        rig=SimpleNamespace(mesh_names=("test.main", "reference.main")),
        label=("test", "reference").__getitem__,
        discretisation=tuple(SimpleNamespace(quantity=name) for name in known),
    )


@pytest.fixture(autouse=True)
def _loaded(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only the test gearbox has loaded stages."""
    monkeypatch.setattr(load_errors, "loaded_stages", lambda solved, mesh: [{}] if mesh == 0 else [])


KNOWN = (
    "dynamics.dynamic_factor.test", "dynamics.ramp_peak.test", "dynamics.contact_margin.test",
    "dynamics.dynamic_factor.reference",
)  # fmt: skip


def test_nothing_is_said_where_every_error_is_known() -> None:
    assert list(_load_errors(solved(KNOWN))) == []
    assert list(_load_errors(solved((), run=None))) == []


@pytest.mark.parametrize("lost", KNOWN)
def test_a_check_without_its_error_is_named(lost: str) -> None:
    (text,) = _load_errors(solved(tuple(name for name in KNOWN if name != lost)))
    assert text.startswith(f"{lost}: the error of slices and shaft elements is not known")
