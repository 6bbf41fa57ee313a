"""Checks on made-up results of the shipped rig: which value governs, where it stands, what does not apply."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from dynamics.rotor.journal import JournalBearing, transition_speed
from rigdesign.case import load_case
from rigdesign.checks import clearances, dwell_speeds, dynamics, films, oil, ramp, strength, temperatures
from rigdesign.checks.omissions import omissions
from rigdesign.checks.rules import with_omissions
from rigdesign.postprocessing.nearest_resonance import NearDwell, mesh_resonances
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.results.check import Check
from rigdesign.results.housing import CoolingBalance, HeatSource, RigHeat, StageBalance
from rigdesign.results.loads import ContactLoss, MeshResonance, StageLoad, UnsolvedSpeed
from rigdesign.results.vibration import AvoidedResonance, nearer
from rigdesign.results.warm_gearbox import SealClearance, WarmGearbox
from rigdesign.rig.model import Rig
from tests.builders.loads import StatedLoads, mesh_loads
from tests.builders.paths import CASES
from tests.builders.twisting import twisting_rig

RPM = np.pi / 30.0


@cache
def rig() -> Rig:
    return twisting_rig(load_case(CASES / "uhcf_prototype"))


def held(stage: str, factors: tuple[float, float], rpm: float = 12000.0, **last: Any) -> Any:
    """A held point at 180 N m with the K_V of both meshes."""
    response = SimpleNamespace(dynamic_factor=np.array(factors), mean=np.array([180.0, 186.9]))
    return SimpleNamespace(
        point=SimpleNamespace(stage=stage, speed=rpm * RPM, torque=180.0),
        last=SimpleNamespace(response=response, **({"system": None} | last)),
    )


def resonance(
    rpm: float, *, dangerous: bool = True, torque: str = "180 Nm", at_end: bool = False
) -> MeshResonance:
    return MeshResonance(
        torque=torque, mode="shaft", frequency=1e3, harmonic=1, speed=rpm * RPM, dynamic_factor=1.5,
        force_share=0.5, amplification=2.0, at_end=at_end, dangerous=dangerous,
    )  # fmt: skip


def load(stage: str, least: float, peak: float) -> StageLoad:
    return StageLoad(
        stage=stage, dynamic_factor=peak / 90.0, speed=2175.0 * RPM, mean=90.0, peak=peak, least=least,
        least_share=least / 90.0, least_share_speed=2175.0 * RPM, least_share_mean=90.0,
    )  # fmt: skip


def lost(stage: str, start: float, share: float) -> ContactLoss:
    return ContactLoss(stage=stage, start=start, end=start + 0.1, share=share, longest_gap=1e-3)


def solved(points: Any = None, **changes: Any) -> SolvedRig:
    """Both gearboxes with the same made-up loads; ``changes`` of the records of one mesh."""
    mesh = mesh_loads(**changes)
    bare = SimpleNamespace(points=())
    curves = SimpleNamespace(named={"180 Nm": (180.0, bare), "90 Nm": (90.0, bare)})
    run: Any = SimpleNamespace(curves=curves, ramp=SimpleNamespace(cut=""))
    held_points = points or [held("test", (1.1, 1.2))]
    loads = StatedLoads(meshes={"test": mesh, "reference": mesh})
    return SolvedRig(rig=rig(), points=held_points, run=run, loads=loads)


def named(checks: Any, identity: str) -> Check:
    (found,) = [check for check in checks if check.id == identity]
    assert isinstance(found, Check)
    return found


def test_the_slower_wheel_has_to_get_its_cycles_too() -> None:
    """720 h at 12,000 rpm of the pinion are 5.184e8 turns, 99/102 of them of the wheel."""
    check = named(strength.checks(solved()), "specimen.load_cycles")
    assert check.value == pytest.approx(720.0 * 60.0 * 12000.0 * 99.0 / 102.0)
    assert "test.wheel at 11647 rpm" in check.reason


def test_the_worst_held_stage_governs_the_dynamic_factor() -> None:
    both = solved([held("first", (1.1, 1.4)), held("second", (1.3, 1.2))])
    values = {check.id: (check.value, check.reason) for check in dynamics.checks(both)}
    assert values["dynamics.dynamic_factor.test"] == (1.3, "stage second")
    assert values["dynamics.dynamic_factor.reference"] == (1.4, "stage first")


def test_without_a_dangerous_resonance_the_distance_is_that_of_the_end_of_the_search() -> None:
    check = named(
        dynamics.checks(solved(resonances=(resonance(12100.0, dangerous=False),))),
        "dynamics.resonance_distance.test",
    )
    assert check.value == pytest.approx(0.125)
    assert "500 to 13500 rpm" in check.reason and "at least" in check.reason


@pytest.mark.parametrize(("rpm", "verdict"), [(11400.0, "fail"), (12600.0, "fail"), (10500.0, "pass")])
def test_a_resonance_above_the_held_speed_counts_as_one_below(rpm: float, verdict: str) -> None:
    check = named(dynamics.checks(solved(resonances=(resonance(rpm),))), "dynamics.resonance_distance.test")
    assert check.verdict == verdict
    assert check.value == pytest.approx(abs(rpm - 12000.0) / 12000.0)


def test_resonances_at_another_torque_do_not_count_and_unsolved_speeds_are_named() -> None:
    hole = UnsolvedSpeed(curve="180 Nm", speed=12100.0 * RPM, reason="not converged")
    found = (resonance(12100.0, torque="90 Nm"),)
    with_hole = solved([held("test", (1.1, 1.2), models=())], resonances=found, unsolved=(hole,))
    with_hole = replace(with_hole, rig=replace(rig(), fidelity="standard"))
    check = named(dynamics.checks(with_hole), "dynamics.resonance_distance.test")
    assert (check.value, check.verdict) == (pytest.approx(0.125), "pass")
    final = with_omissions(check, omissions(with_hole, check))
    assert (final.value, final.verdict) == (check.value, "open")
    assert final.left_out == ("resonances at speeds without solution (1)",)


def test_contact_and_peak_of_the_loaded_ramp() -> None:
    """The start at 10 N m may lose contact; the run-up at half torque may not, and its peak is held too."""
    loads = (load("to_transition_speed", 0.0, 400.0), load("run_up", 8.0, 205.0), load("test", 150.0, 210.0))
    losses = (lost("to_transition_speed", 1.1, 0.4), lost("run_up", 2.6, 0.02))
    checks = dynamics.checks(solved(stage_loads=loads, contact_losses=losses))
    margin = named(checks, "dynamics.contact_margin.test")
    assert (margin.value, margin.verdict) == (pytest.approx(8.0 / 90.0), "fail")
    assert "stage run_up, near 2175 rpm" in margin.reason
    assert named(checks, "dynamics.ramp_peak.test").value == pytest.approx(210.0 / 180.0)
    off = named(checks, "dynamics.lift_off.test")
    assert (off.value, off.verdict) == (0.02, "fail")


@pytest.mark.parametrize("stage", ["half_torque", "to_start_torque"])
def test_a_stage_that_comes_from_the_start_torque_is_not_loaded_yet(stage: str) -> None:
    """From 10 to 90 N m or back at 750 rpm: at its light end the teeth may part."""
    loads = (load(stage, 0.0, 400.0), load("full_torque", 60.0, 200.0))
    checks = dynamics.checks(solved(stage_loads=loads, contact_losses=(lost(stage, 1.1, 0.4),)))
    assert named(checks, "dynamics.contact_margin.test").value == pytest.approx(60.0 / 90.0)
    assert named(checks, "dynamics.ramp_peak.test").value == pytest.approx(200.0 / 180.0)
    assert named(checks, "dynamics.lift_off.test").value == 0.0


def without(path: tuple[str, str]) -> SolvedRig:
    """The shipped case with one limit left out."""
    case = rig().case
    group, key = path
    part = getattr(case.limits, group).model_copy(update={key: None})
    limits = case.limits.model_copy(update={group: part})
    return replace(solved(), rig=replace(rig(), case=case.model_copy(update={"limits": limits})))


@pytest.mark.parametrize(
    ("left_out", "missing"),
    [
        (("ramp", "standstill_torque"), {"ramp.standstill_torque"}),
        (("ramp", "run_up_torque_share_maximum"), {"ramp.run_up_torque"}),
        (("ramp", "transition_speed"), {"ramp.start_torque", "ramp.run_up_torque"}),
        (("bearing", "start_torque_limit"), {"ramp.start_torque"}),
    ],
)
def test_a_ramp_rule_without_its_limit_does_not_apply(left_out: tuple[str, str], missing: set[str]) -> None:
    found = list(ramp.ramp(without(left_out)))
    assert {check.id for check in found if check.verdict == "not applicable"} == missing
    assert all(check.limit is None for check in found if check.id in missing)
    assert len(found) == 4


def warm(stage: str, shifts: dict[str, tuple[str, float]]) -> WarmGearbox:
    """The test gearbox with seals by name: shaft and its axial shift [m]."""
    seals = tuple(
        SealClearance(
            name=seal, shaft=shaft, as_drawn=6e-4, minimum=5e-4, mean=5e-4, angle_of_minimum=0.0, by_hand=5e-4,
            axial_shift=shift, angles=(), gaps=(),
        )
        for seal, (shaft, shift) in shifts.items()
    )  # fmt: skip
    return WarmGearbox(gearbox="test", stage=stage, seals=seals)


def test_one_check_of_the_seal_travel_for_every_shaft_over_all_held_stages() -> None:
    """A shaft whose name begins like another's keeps to its own seals."""
    first = {"a": ("test_pinion", -2e-4), "b": ("test_wheel", 1e-4), "c": ("test_pinion_2", 9e-4)}
    second = {"a": ("test_pinion", 1e-4), "b": ("test_wheel", 3e-4), "c": ("test_pinion_2", 9e-4)}
    two = replace(solved(), warm=[warm("first", first), warm("second", second)])
    found = {check.id: (check.value, check.reason) for check in clearances.seal_travel(two)}
    assert found == {
        "clearance.seal_travel.test.pinion": (pytest.approx(0.2), "a, stage first"),
        "clearance.seal_travel.test.wheel": (pytest.approx(0.3), "b, stage second"),
    }


def test_cooler_heater_and_room_are_those_of_their_own_worst_stage() -> None:
    def balance(stage: str, cooler: float, heater: float, room: float) -> StageBalance:
        cooling = CoolingBalance(
            stage=stage, losses=0.0, pump=0.0, heater=heater, cooler=cooler, room=room, stored=None, not_heat=0.0,
            flow=26.0 / 6e4,
        )  # fmt: skip
        return StageBalance(cooling=cooling, heat=heat(stage, room))

    def heat(stage: str, room: float) -> RigHeat:
        box = HeatSource(name="test", kind="gearbox", power=room, sinks={"room": room})
        return RigHeat(stage=stage, sources=(box,), drive_power=room, mains_power=room, input_power=room)

    both = replace(solved(), balances=[balance("hot", 9e3, 0.5e3, 2e3), balance("fast", 12e3, 1.5e3, 1e3)])
    found = {check.id: (check.value, check.reason) for check in oil.checks(both)}
    assert found["oil.cooler"] == (pytest.approx(12.0), "stage fast")
    assert found["oil.heater"] == (pytest.approx(1.5), "stage fast")
    assert found["oil.room"] == (pytest.approx(2.0), "stage hot")


def test_teeth_hotter_than_their_gear_govern_the_tempering_distance() -> None:
    """180 degC of case-hardened steel less 150 degC of the wheel's teeth, 130 degC of the pinion, 60 degC of oil."""
    temperature = {
        "test.pinion": 403.15,
        "test.wheel": 393.15,
        "reference.pinion": 333.15,
        "reference.wheel": 333.15,
    }
    point = held("test", (1.1, 1.2), coupling_state=SimpleNamespace(gear_temperature=temperature))
    split = [
        SimpleNamespace(gear="test.pinion", tooth=None),
        SimpleNamespace(gear="test.wheel", tooth=423.15),
    ]
    housing: Any = SimpleNamespace(stage="test", heat_split=split)
    found = list(temperatures.tempering_distances(replace(solved([point]), temperatures=[housing])))
    assert [(round(value, 9), where) for value, where in found] == [
        (50.0, "test.pinion at 130.0 degC, stage test"),
        (30.0, "teeth of test.wheel at 150.0 degC, stage test"),
        (120.0, "reference.pinion at 60.0 degC, its oil outlet, stage test"),
        (120.0, "reference.wheel at 60.0 degC, its oil outlet, stage test"),
    ]


def with_films(*states: tuple[float, float, float]) -> SolvedRig:
    """Bearings with (film [um], specific load [MPa], transition speed [rpm]) at 180 N m."""
    bearings = {
        f"test.b{index}": SimpleNamespace(
            minimum_film=1e-6 * film, specific_load=1e6 * pressure, transition_speed=speed * RPM, star=None
        )
        for index, (film, pressure, speed) in enumerate(states)
    }
    return solved([held("test", (1.1, 1.2), bearings=bearings)])


@pytest.mark.parametrize(("film", "verdict"), [(6.0, "fail"), (8.0, "pass"), (60.0, "pass")])
def test_the_thinnest_film_is_held_from_below(film: float, verdict: str) -> None:
    """At least 7 um: a film of 60 um is no fault, and a thick one does not hide a thin one."""
    check = named(films.checks(with_films((film, 1.0, 0.0), (80.0, 1.0, 0.0))), "bearing.minimum_film")
    assert check.value == pytest.approx(film)
    assert (check.verdict, check.comparison) == (verdict, ">=")
    assert check.reason == "test.b0, stage test"


@pytest.mark.parametrize(("pressure", "verdict"), [(6.0, "fail"), (2.0, "pass")])
def test_the_largest_specific_load_is_held_from_above(pressure: float, verdict: str) -> None:
    check = named(films.checks(with_films((20.0, pressure, 0.0), (20.0, 0.5, 0.0))), "bearing.specific_load")
    assert (check.value, check.verdict) == (pytest.approx(pressure), verdict)


def test_transition_speed_is_vogelpohls_under_the_load_of_the_start_torque() -> None:
    """9 kN at 180 N m are 500 N at 10 N m: n = 1e-7 F / (C eta V) with 40 x 30 mm and 20 mPa s is 66.3 rpm then."""
    bearing = JournalBearing(diameter=0.04, width=0.03, diametral_clearance=60e-6)
    at_test = transition_speed(bearing, 9000.0, 0.02) / RPM
    two = with_films((20.0, 1.0, 0.5 * at_test), (20.0, 1.0, at_test))
    value, where = max(ramp.transition_speeds(two, 10.0))
    by_hand = 1e-7 * 500.0 / (0.02 * 0.25 * np.pi * 0.04**2 * 0.03)
    assert by_hand == pytest.approx(66.3, abs=0.05)
    assert value / RPM == pytest.approx(by_hand)
    assert where == "test.b1 at the viscosity of stage test, load of the start torque"


def test_a_hotter_room_uses_no_less_of_a_temperature_limit() -> None:
    """A bearing film of 100 degC (limit 120 degC) in rooms of 5 to 40 degC: 80/100 of it is used in each."""
    film = SimpleNamespace(film_temperature=373.15, minimum_film=2e-5, specific_load=1e6, star=None)
    points = [
        held("test", (1.1, 1.2), streams=[], bearings={"test.pinion_front": film},
             coupling_state=SimpleNamespace(gear_temperature={}, bearing_clearance={}))
    ]  # fmt: skip
    for room in ("5 degC", "20 degC", "40 degC"):
        warm = twisting_rig(rig().case.with_value("ambient.temperature", room))
        checks = temperatures.checks(replace(solved(points), rig=warm))
        assert named(checks, "temperature.bearing_film").distance == pytest.approx(0.2)


def test_the_rules_of_the_ramp_hold_the_case_against_itself() -> None:
    assert all(check.by_definition for check in ramp.ramp(solved()))


def avoided(rpm: float, kind: Any, where: str, margin: float = 0.1) -> AvoidedResonance:
    low, high = nearer(rpm * RPM, margin)
    return AvoidedResonance(kind=kind, where=where, speed=rpm * RPM, share=0.7, low=low, high=high)


SHAFT, MESH = ("shaft torque", "test_pinion"), ("dynamic factor", "test at 90 Nm")


@pytest.mark.parametrize(
    ("held", "passed", "verdict", "value", "words"),
    [
        ((11073.0, *SHAFT), (2000.0, *MESH), "fail", 0.0773, "stage test at 12000 rpm"),
        ((12100.0, *MESH), (2000.0, *MESH), "pass", 0.15, "none within 15 %"),
        (
            (10000.0, *SHAFT),
            (760.0, *MESH),
            "advisory",
            0.0133,
            "at 750 rpm: dynamic factor of test at 90 Nm",
        ),
    ],
)
def test_held_speeds_bind_and_those_of_other_stages_are_advice(
    monkeypatch: pytest.MonkeyPatch, held: Any, passed: Any, verdict: str, value: float, words: str
) -> None:
    """Resonances of meshes at a held speed are those of the other check."""
    near = {
        rpm * RPM: NearDwell(rpm * RPM, 0.1, (avoided(*one),))
        for rpm, one in ((12000.0, held), (750.0, passed))
    }
    monkeypatch.setattr(SolvedRig, "near_dwells", near)
    (check,) = dwell_speeds.checks(solved())
    assert (check.status, check.value) == (verdict, pytest.approx(value, abs=1e-3))
    assert words in check.reason


def test_checks_and_bands_have_the_same_dangerous_peaks() -> None:
    """By their amplification at 6100 and 11,000 rpm, one inside of what is above the share from 5000 to 6000 rpm, and
    what is above it without a peak from 12,900 rpm on."""
    rpm = np.array([4000.0, 5000.0, 5500.0, 6000.0, 11000.0, 12900.0, 13500.0])
    share = np.array([0.1, 0.2, 0.6, 0.2, 0.1, 0.2, 0.4])
    points = [
        SimpleNamespace(maximum=np.full(2, 1.0 + one), minimum=np.full(2, 1.0 - one), mean=np.ones(2))
        for one in share
    ]
    own = (resonance(11000.0), resonance(5400.0), resonance(8000.0, dangerous=False), resonance(6100.0))
    curve = SimpleNamespace(points=points, speeds=rpm * RPM)
    base = solved(resonances=own)
    curves = SimpleNamespace(named={"180 Nm": (180.0, curve)})
    run: Any = SimpleNamespace(curves=curves, ramp=SimpleNamespace(cut=""))
    assert base.loads is not None
    found = [one for one in mesh_resonances(rig(), run, base.loads) if one.where == "test at 180 Nm"]
    spans = {round(one.speed / RPM): (round(one.low / RPM), round(one.high / RPM)) for one in found}
    assert spans == {11000: (10000, 12222), 5400: (4909, 6000), 6100: (5545, 6778), 13500: (12273, 15000)}
    check = named(dynamics.checks(replace(base, run=run)), "dynamics.resonance_distance.test")
    assert check.value == pytest.approx(1.0 / 12.0)
