"""A held point of a modified rig starts from the fields of the stated one only where both have the same meshes."""

from types import SimpleNamespace
from typing import Any

import pytest

from rigdesign import load_case
from rigdesign.case.loader import changed_together
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.model import Rig, build_rig
from rigdesign.rig.reuse import same_housings, with_housings_of
from rigdesign.studies import modified_rig

FACE_WIDTHS = [f"gearboxes.test.gears.{gear}.face_width" for gear in ("pinion", "wheel")]
INLET = ["gearboxes.test.oil.inlet_temperature"]


@pytest.fixture(scope="module")
def stated() -> Any:
    """The prototype with the coupling state of its initial state in place of a converged point."""
    rig = build_rig(load_case("uhcf_prototype"), "quick")
    point = held_points(rig)[0]
    last = SimpleNamespace(coupling_state=initial_state(rig, point), fields=dict.fromkeys(rig.models))
    return SimpleNamespace(rig=rig, points=[SimpleNamespace(last=last, differences=None)])


def modified(stated: Rig, paths: list[str], value: str) -> Rig:
    rig = build_rig(changed_together(stated.case, dict.fromkeys(paths, value)), "quick")
    return with_housings_of(rig, stated) if same_housings(rig, stated) else rig


@pytest.mark.parametrize(
    ("paths", "value", "same"), [(INLET, "120 degC", True), (FACE_WIDTHS, "8.25 mm", False)]
)
def test_fields_of_another_mesh_are_no_first_guess(
    paths: list[str], value: str, same: bool, stated: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A wider gear of a housing is another mesh: 10007 nodes in place of 10081 of the test gearbox."""
    rig = modified(stated.rig, paths, value)
    sizes = [len(found.models["test"].mesh.points) for found in (rig, stated.rig)]
    assert (sizes[0] == sizes[1]) == same
    monkeypatch.setattr(modified_rig, "solve_point", lambda rig, point, **given: given["before"])
    before = modified_rig.coupled_again(rig, stated, 0)
    assert before is (stated.points[0].last if same else None)
