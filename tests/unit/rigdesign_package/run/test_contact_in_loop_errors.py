"""What the contact in the loop adds to the errors of the loads, and what the run says where it could not."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from rigdesign.results.teeth import ContactInLoop, LoopedContact
from rigdesign.run import load_convergence
from rigdesign.run.warnings import _contact_in_loop

HELD = LoopedContact(
    mesh="test", stage="test", peak=False, stated=(1256.6, 180.0), speed=1256.6, torque=180.5, dynamic_factor=1.07,
    dynamic_factor_by_table=1.08, least_share=0.9, least_share_by_table=0.87, other_flank=0.0, apart=0.0, tilt=5e-6,
    still_changing=4e-4, settled=True, time=0.09, unconverged=0,
)  # fmt: skip
PEAK = replace(
    HELD, stage="", peak=True, stated=(191.0, 180.0), dynamic_factor=1.41, dynamic_factor_by_table=1.45
)
LIGHT = replace(HELD, stage="light", stated=(1256.6, 20.0), dynamic_factor=1.5)


def solved(*found: LoopedContact) -> Any:
    return SimpleNamespace(
        contact_in_loop=ContactInLoop(meshes=found), label=lambda mesh: ("test", "reference")[mesh]
    )


def wanted(key: str, speed: float, torque: float = 180.0, mesh: int = 0) -> Any:
    point = SimpleNamespace(speed=speed, torque=torque)
    return SimpleNamespace(key=key, mesh=mesh, loaded=SimpleNamespace(point=point))


@pytest.mark.parametrize(
    ("speed", "torque", "expected"), [(1250.0, 180.0, HELD), (200.0, 175.0, PEAK), (1100.0, 25.0, LIGHT)]
)
def test_a_check_takes_the_place_at_the_nearest_speed_and_torque(
    speed: float, torque: float, expected: LoopedContact
) -> None:
    assert load_convergence._looped(solved(HELD, PEAK, LIGHT), wanted("ramp_peak", speed, torque)) is expected


def test_without_a_comparison_of_its_mesh_a_check_takes_none() -> None:
    assert load_convergence._looped(solved(HELD), wanted("ramp_peak", 1250.0, mesh=1)) is None


def test_the_whole_difference_is_left_out_and_what_had_not_settled_with_it() -> None:
    assert load_convergence._left_out(wanted("dynamic_factor", 1.0), HELD) == pytest.approx(0.01)
    assert load_convergence._left_out(wanted("contact_margin", 1.0), HELD) == pytest.approx(0.03)
    moving = replace(HELD, settled=False, still_changing=0.02)
    assert load_convergence._left_out(wanted("dynamic_factor", 1.0), moving) == pytest.approx(0.03)


def test_the_run_names_places_without_a_comparison_and_poor_ones() -> None:
    poor = replace(HELD, settled=False, still_changing=0.02, time=0.6, unconverged=11)
    missing, moving, open_ = _contact_in_loop(
        ContactInLoop(
            meshes=(HELD, poor), missing=("stage dwell, 500 rpm: no response on contact tables: why",)
        )
    )
    assert missing == (
        "contact in the loop: not solved at stage dwell, 500 rpm: no response on contact tables: why; the errors of "
        "the loads there do not include it"
    )
    assert moving == (
        "contact in the loop: gearbox test, 12000 rpm: K_V still changes by 0.02 after 0.6 s; added to the error of "
        "the loads"
    )
    assert "in 11 steps the contact was not solved to its tolerance, limit 10" in open_
    assert not list(_contact_in_loop(ContactInLoop(meshes=(HELD,))))
