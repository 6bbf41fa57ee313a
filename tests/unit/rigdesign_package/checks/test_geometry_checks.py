"""Limits of the toothing as drawn: each from the geometry alone, with its margin and the cause."""

import math
from dataclasses import replace
from functools import cache
from typing import Any

import pytest

from dynamics.gear.cylindrical_gear import Rack
from dynamics.gear.flank import require_whole_flanks
from dynamics.gear.involute import GearGeometryError
from dynamics.gear.pair import GearPair
from dynamics.gear.pair_geometry import TipShortening
from rigdesign.case import load_case
from rigdesign.checks import geometry
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.results.check import Check
from rigdesign.rig.model import Rig
from rigdesign.run import main
from tests.builders.paths import CASES
from tests.builders.twisting import twisting_rig

TYPE_C = {
    "normal_module": 4.5e-3, "teeth": (16, 24), "centre_distance": 91.5e-3, "face_widths": (14e-3, 14e-3),
    "profile_shift_1": 0.182,
}  # fmt: skip
EDRIVE = {
    "normal_module": 1.75e-3, "teeth": (23, 67), "helix_angle": math.radians(22.0), "centre_distance": 88e-3,
    "face_widths": (30e-3, 30e-3),
}  # fmt: skip
TYPE_A = {**TYPE_C, "profile_shift_1": 0.8532}
"""A thin tip on the pinion by intent, and a wheel with undercut outside of its path of contact."""


@cache
def fzg() -> Rig:
    """Built, not solved."""
    return twisting_rig(load_case(CASES / "fzg"))


def checks(toothing: dict[str, Any]) -> dict[str, Check]:
    """Geometry checks of a rig with this toothing in its test gearbox."""
    pairs = {**fzg().pairs, "test.main": GearPair.from_centre_distance(**toothing)}
    found = geometry.checks(SolvedRig(rig=replace(fzg(), pairs=pairs), points=()))
    return {check.id.removeprefix("geometry."): check for check in found}


def test_a_usual_pair_keeps_all_limits_without_being_solved() -> None:
    found = checks(TYPE_C)
    assert {check.verdict for check in found.values()} == {"pass"}
    assert {name: check.limit for name, check in found.items()} == {
        "tip_thickness": 0.2, "root_clearance": 0.1, "fillet_distance": 0.0, "undercut": -0.17, "contact_ratio": 1.1,
        "profile_shift_sum": 1.5,
    }  # fmt: skip
    assert found["profile_shift_sum"].value == pytest.approx(0.353, abs=2e-3)


@pytest.mark.parametrize(
    ("changes", "name", "value", "reason"),
    [
        (TYPE_A, "tip_thickness", 0.144, "test pinion: 0."),
        ({"racks": 2 * (Rack(dedendum=1.1, tip_radius=0.2),)}, "root_clearance", 0.08, "root of its mate"),
        (
            {**EDRIVE, "profile_shift_1": "equal"},
            "fillet_distance",
            -0.264,
            "test pinion: its fillet ends 0.462",
        ),
        ({**EDRIVE, "profile_shift_1": "equal"}, "profile_shift_sum", 1.937, "0.968 and 0.968"),
        ({"profile_shift_1": 0.95}, "undercut", -0.193, "x_min = -0.404"),
        ({"tips": TipShortening(shortening=(1.5e-3, 1.5e-3))}, "contact_ratio", None, "eps_beta 0.000"),
    ],
)
def test_each_limit_fails_with_its_number_and_place(
    changes: dict[str, Any], name: str, value: float | None, reason: str
) -> None:
    check = checks({**TYPE_C, **changes})[name]
    assert check.verdict == "fail"
    assert reason in check.reason
    if value is not None:
        assert check.value == pytest.approx(value, abs=0.02)


def test_the_wheel_of_type_a_may_have_its_undercut() -> None:
    """x = -0.5 of 24 teeth: x_min = 1 - 12 sin^2(20 deg) = -0.404, within the practical limit of 14 teeth."""
    check = checks(TYPE_A)["undercut"]
    assert check.verdict != "fail"
    assert check.value == pytest.approx(-0.5 + 0.404, abs=2e-3)
    assert f"x_min = {1.0 - 12.0 * math.sin(math.radians(20.0)) ** 2:.3f}" in check.reason


def test_undercut_of_the_path_of_contact_names_the_least_profile_shift() -> None:
    """Pinion of 11 teeth, beta 14 deg: x_min = 1 - z sin^2(alpha_t) / (2 cos beta) = 0.301, sum of shifts -0.702."""
    pair = GearPair.from_centre_distance(
        normal_module=2.5e-3, teeth=(11, 41), helix_angle=math.radians(14.0), centre_distance=65e-3,
        face_widths=(18e-3, 18e-3), profile_shift_1=0.0,
    )  # fmt: skip
    with pytest.raises(
        GearGeometryError, match=r"below x_min = 0.301; raise its .* 0.301, .* mate then has -1.00"
    ):
        require_whole_flanks(pair)


def test_what_is_missed_is_said_before_the_rig_is_solved(monkeypatch: pytest.MonkeyPatch) -> None:
    pairs = {**fzg().pairs, "test.main": GearPair.from_centre_distance(**TYPE_A)}
    (text,) = geometry.missed(SolvedRig(rig=replace(fzg(), pairs=pairs), points=()))
    assert text.startswith("missed before anything is solved: least tooth thickness at a tip circle")
    said: list[str] = []

    def stop(rig: Rig) -> None:
        raise RuntimeError("solving begins")

    monkeypatch.setattr(main, "build_rig", lambda case, fidelity: replace(fzg(), pairs=pairs))
    monkeypatch.setattr(main, "looping_rig", stop)
    with pytest.raises(RuntimeError, match="solving begins"):
        main.solve_case(fzg().case, "quick", said.append)
    assert said == ["building the rig", text]
