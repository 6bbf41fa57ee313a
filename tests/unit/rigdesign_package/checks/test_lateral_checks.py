"""Checks of lateral vibration on made-up modes and orbits."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from dynamics.rotor.damped_modes import RigMode
from rigdesign.case.loader import load_case
from rigdesign.checks.clearances import checks as clearance_checks
from rigdesign.checks.lateral import checks
from rigdesign.results.check import Check
from rigdesign.results.lateral import BearingWhirl, LateralVibration, Separation, StageLateral
from rigdesign.results.warm_gearbox import SealClearance, WarmGearbox
from tests.builders.paths import CASES

CASE = load_case(CASES / "uhcf_prototype")


def mode(decrement: float, frequency: float = 100.0, family: str = "lateral") -> RigMode:
    return RigMode(
        name=f"shaft {family}", family=family, shaft="test_pinion", frequency=frequency,
        logarithmic_decrement=decrement, whirl=1.0,
    )  # fmt: skip


def whirl(amplitude: float, clearance: float | None) -> BearingWhirl:
    return BearingWhirl(
        bearing="test.pinion_rear", shaft="test_pinion", orbits={"one": 0.75 * amplitude, "two": 0.25 * amplitude},
        minor=0.0, clearance=clearance, force=100.0, static_load=1000.0,
    )  # fmt: skip


def found(
    held: tuple[RigMode, ...] = (),
    lost: tuple[RigMode, ...] = (),
    **more: Any,
) -> dict[str, Check]:
    common: Any = {"stage": "test", "speed": 1256.6, "highest_turn": 200.0}
    vibration = LateralVibration(
        stages=(
            StageLateral(torque="held", modes=held, **common, **more),
            StageLateral(torque="lost", modes=lost, **common),
        ),
    )
    solved: Any = SimpleNamespace(case=CASE, lateral=vibration, no_clearances="")
    return {check.id: check for check in checks(solved)}


def test_shafts_that_only_twist_have_none() -> None:
    solved: Any = SimpleNamespace(case=CASE, lateral=None)
    for check in checks(solved):
        assert check.verdict == "open" and "only twist" in check.reason


@pytest.mark.parametrize(("amplitude", "verdict"), [(28e-6, "pass"), (31e-6, "fail")])
def test_an_orbit_may_take_three_quarters_of_the_clearance(amplitude: float, verdict: str) -> None:
    """Peak to peak over the diametral clearance, all lines added; a rolling bearing has none."""
    check = found(bearings=(whirl(amplitude, 80e-6), whirl(1e-3, None)))["lateral.orbit"]
    assert check.value == pytest.approx(2.0 * amplitude / 80e-6)
    assert (check.limit, check.verdict) == (0.75, verdict)


def test_slow_lateral_modes_and_all_that_grow_count_for_stability() -> None:
    calm = found(held=(mode(0.3), mode(0.05, 900.0), mode(0.02, 100.0, "torsion")))
    assert (calm["lateral.stability"].value, calm["lateral.stability"].verdict) == (0.3, "pass")
    grown = found(held=(mode(0.3),), lost=(mode(0.05), mode(-0.01, 900.0)))
    assert grown["lateral.stability"].verdict == "pass"
    check = grown["lateral.stability_without_torque"]
    assert (check.value, check.verdict) == (-0.01, "fail")
    assert found()["lateral.stability"].verdict == "not applicable"


def test_rigid_bodies_that_sway_in_unloaded_bearings_are_no_decrement_and_no_critical_speed() -> None:
    """Shafts in the play of rolling bearings at 1.2 Hz; a whirl at half the speed counts, though as rigid."""
    swaying = replace(mode(0.0003, 1.2), elastic_share=1e-5)
    whirling = replace(mode(0.2, 95.0), elastic_share=0.003)
    near = Separation(mode=0, speed=7.6, harmonic=1, margin=0.01, required=0.16)
    calm = found(held=(swaying, whirling), separations=(near,))
    check = calm["lateral.stability"]
    assert (check.value, check.verdict) == (0.2, "pass")
    assert "1 rigid-body modes from 1.2 Hz do not grow" in check.reason
    assert calm["lateral.separation"].verdict == "pass"
    assert (
        found(held=(replace(swaying, logarithmic_decrement=-0.001),))["lateral.stability"].verdict == "fail"
    )


def test_a_critical_speed_keeps_the_distance_that_its_amplification_asks_for() -> None:
    modes = (mode(0.1), mode(3.0))
    near = Separation(mode=0, speed=1256.6, harmonic=1, margin=-0.10, required=0.16)
    damped = Separation(mode=1, speed=1256.6, harmonic=1, margin=0.01, required=0.0)
    check = found(held=modes, separations=(near, damped))["lateral.separation"]
    assert (check.value, check.verdict) == (pytest.approx(0.10 / 0.16), "fail")
    assert "10 % below 1 x 12000 rpm, needs 16 %" in check.reason
    calm = found(held=modes, separations=(damped,))["lateral.separation"]
    assert calm.verdict == "pass" and "no lateral mode with AF >= 2.5" in calm.reason


@pytest.mark.parametrize(("margin", "verdict"), [(-0.09, "fail"), (0.12, "pass")])
def test_torsional_modes_stay_a_tenth_off_once_and_twice_a_turn(margin: float, verdict: str) -> None:
    one = Separation(mode=0, speed=1256.6, harmonic=2, margin=margin, required=0.1)
    check = found(held=(mode(0.01, 400.0, "torsion"),), torsional=(one,))["lateral.torsional_separation"]
    assert (check.value, check.verdict) == (pytest.approx(abs(margin)), verdict)


def test_a_shaft_that_whirls_takes_from_the_gap_of_its_seal() -> None:
    seal = SealClearance(
        name="test_pinion_front", shaft="test_pinion", as_drawn=6e-4, minimum=4e-4, mean=5e-4, angle_of_minimum=0.0,
        by_hand=5e-4, axial_shift=0.0, angles=(0.0,), gaps=(4e-4,),
    )  # fmt: skip
    warm = WarmGearbox(gearbox="test", stage="test", seals=(seal,))
    amplitudes = {("test", "test_pinion_front"): 5e-5}
    solved: Any = SimpleNamespace(
        case=CASE, warm=[warm], points=(), unexpanded=(), seal_amplitudes=amplitudes, no_clearances=""
    )
    check = next(one for one in clearance_checks(solved) if one.id == "clearance.seal_gap")
    assert check.value == pytest.approx(0.35)
    assert "less 50 um of whirl" in check.reason
