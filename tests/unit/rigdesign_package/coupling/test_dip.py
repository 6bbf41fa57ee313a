"""Gears that dip: a sump that is held or finds its own temperature, what it takes up, what it churns."""

import math
import re
from dataclasses import replace
from pathlib import Path

import pytest

from dynamics.losses.loss import RIVAL_POWER
from rigdesign.base.errors import CaseError
from rigdesign.case import load_case
from rigdesign.checks import mesh_checks, of_other_law
from rigdesign.coupling.flank_heat import churning
from rigdesign.coupling.housing_context import GEAR_OIL
from rigdesign.coupling.loop import PointResult, solve_point
from rigdesign.coupling.time_run import held_points
from rigdesign.postprocessing.solved_rig import solved_rig
from rigdesign.rig.model import Rig, build_rig
from rigdesign.run.mesh_convergence import law_spreads
from tests.builders.fzg_case import HELD, fzg_case

FREE = {"test": "", "slave": HELD}


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Rig:
    path = fzg_case(tmp_path_factory.mktemp("free"), sumps=FREE)
    return build_rig(load_case(path), "quick")


@pytest.fixture(scope="module")
def free(rig: Rig) -> PointResult:
    return solve_point(rig, held_points(rig)[-1])


def sump_of(result: PointResult) -> float:
    return result.last.coupling_state.oil_outlet["test.gear_oil"]


def test_a_free_sump_gives_the_walls_what_the_losses_give_it(free: PointResult) -> None:
    """The volume of the field, against the losses summed by hand."""
    field = free.last.fields["test"]
    into = math.fsum(p.into_oil - p.into_bearing_oil for p in free.last.losses if p.gearbox == "test")
    taken = -math.fsum(r.power for r in field.solution.balance.rows if r.kind == GEAR_OIL and r.area > 0.0)
    assert into == pytest.approx(-taken, rel=1e-6)
    assert field.solution.balance.closure < 1e-8
    assert field.solution.volumes[GEAR_OIL] == pytest.approx(sump_of(free), abs=0.1)


def test_a_sump_held_where_a_free_one_ends_needs_no_cooler(rig: Rig, free: PointResult) -> None:
    """The second way: a fixed temperature in place of the unknown."""
    held = rig.case.with_value("gearboxes.test.oil.sump_temperature", f"{sump_of(free):.6f} K")
    result = solve_point(build_rig(held, "quick").with_models(rig.models), free.point)
    stream = next(s for s in result.last.streams if s.name == "test.gear_oil")
    turned_over = math.fsum(p.loss.power for p in result.last.losses if p.gearbox == "test")
    assert abs(stream.heat) < 0.005 * turned_over
    for gear in ("test.pinion", "test.wheel"):
        there, here = (r.last.coupling_state.gear_temperature[gear] for r in (free, result))
        assert here == pytest.approx(there, abs=0.1)


def test_churning_brakes_its_shaft_and_heats_the_oil(rig: Rig, free: PointResult) -> None:
    own = {p.part: p for p in free.last.losses if p.loss.kind == "churning" and p.gearbox == "test"}
    assert set(own) == {"pinion", "wheel"}
    speed = rig.shaft_speed("test_wheel", free.point.speed)
    assert own["wheel"].into_oil == own["wheel"].loss.power > own["pinion"].loss.power > 5.0
    assert free.last.drags["test.wheel"] >= own["wheel"].loss.power / speed
    details = own["wheel"].loss.details
    assert "iso_tr_14179_2" in str(details["powers_of_all_laws"]) and details["reason"]
    assert not any(p.loss.kind in ("windage", "oil_acceleration") for p in free.last.losses)


def test_the_law_of_the_case_decides(rig: Rig) -> None:
    point = held_points(rig)[-1]
    power = {}
    for law in ("recommended", "changenet_2007", "iso_tr_14179_2"):
        case = rig.case.with_value("gearboxes.test.oil.churning", law)
        changed = build_rig(case, "quick")
        power[law] = sum(loss.power for _, loss in churning(changed, "test", point, 363.15, changed.pairs))
    assert power["iso_tr_14179_2"] > 3.0 * power["changenet_2007"]
    assert 0.5 < power["recommended"] / power["changenet_2007"] < 2.0


def test_what_another_law_of_churning_moves_is_an_error_of_the_checks(rig: Rig, free: PointResult) -> None:
    """The free sump with the losses of ISO/TR 14179-2 against the whole loop by that law."""
    (spread,) = law_spreads(rig, [free])
    assert re.search(
        r"churning at stage test \(test 41.* W by changenet_2011, 2.* W by iso_tr_14179_2; slave",
        spread.cause,
    )
    other = rig.case.with_value("gearboxes.test.oil.churning", "iso_tr_14179_2")
    whole = solve_point(build_rig(other, "quick").with_models(rig.models), free.point)
    rise = sump_of(whole) - sump_of(free)
    assert rise > 5.0
    assert spread.changes["temperature.oil_outlet"] == pytest.approx(rise, rel=0.15)
    assert spread.changes["temperature.gear_bulk"] > 0.5 * rise
    solved = replace(solved_rig(rig, [free], []), law_spreads=(spread,))
    (check,) = [one for one in mesh_checks(solved) if one.id == "temperature.oil_outlet"]
    near = replace(check, margin=0.5 * spread.changes[check.id])
    undecided = of_other_law(near, spread)
    assert (undecided.verdict, undecided.error) == ("open", spread.changes[check.id])
    assert spread.cause in undecided.reason
    far = of_other_law(replace(check, margin=100.0, verdict="pass"), spread)
    assert (far.verdict, far.error) == ("pass", spread.changes[check.id])


def test_laws_that_agree_and_losses_that_are_given_have_no_rival(free: PointResult) -> None:
    wheel = next(p for p in free.last.losses if p.name == "test.wheel" and p.loss.kind == "churning")
    assert wheel.rival is not None
    assert replace(wheel, given=True).rival is None
    details = wheel.loss.details | {RIVAL_POWER: 1.2 * wheel.loss.power}
    close = replace(free.last, losses=[replace(wheel, loss=replace(wheel.loss, details=details))])
    assert not list(law_spreads(None, [replace(free, last=close)]))  # type: ignore[arg-type]


def test_gears_above_the_oil_have_windage(rig: Rig) -> None:
    """Level between the tips of pinion and wheel: the wheel dips alone."""
    case = rig.case.with_value("gearboxes.test.oil.level", "-50 mm")
    low = build_rig(case, "quick")
    found = dict(churning(low, "test", held_points(low)[-1], 363.15, low.pairs))
    assert set(found) == {"wheel"} and found["wheel"].power > 0.0


def test_thicker_oil_and_a_higher_level_churn_more(rig: Rig) -> None:
    point = held_points(rig)[-1]

    def power(level: str, temperature: float) -> float:
        changed = build_rig(rig.case.with_value("gearboxes.test.oil.level", level), "quick")
        return sum(loss.power for _, loss in churning(changed, "test", point, temperature, changed.pairs))

    assert power("-20 mm", 363.15) < power("0 mm", 363.15)
    still = replace(point, speed=0.0)
    assert sum(loss.power for _, loss in churning(rig, "test", still, 363.15, rig.pairs)) == 0.0


@pytest.mark.parametrize(
    ("path", "value", "words"),
    [
        ("gearboxes.test.oil.level", "20 mm", "reaches the top of a shaft, 15 mm above its axis"),
        ("gearboxes.test.oil.level", "-70 mm", "no gear reaches the oil"),
        ("gearboxes.test.oil_paths.bypass", 0.1, "the gears dip"),
        ("drivetrain.bracing.temperature_drift", 0.001, "sump_temperature"),
        ("gearboxes.test.oil.lubrication", "bath", "write .*dip"),
    ],
)
def test_what_a_sump_cannot_be(rig: Rig, path: str, value: object, words: str) -> None:
    with pytest.raises(CaseError, match=words):
        rig.case.with_value(path, value)


def test_a_sump_without_walls_needs_its_temperature(tmp_path: Path) -> None:
    with pytest.raises(
        CaseError, match=r"gearboxes\.slave\.oil\.sump_temperature.*nothing says what cools"
    ) as said:
        load_case(fzg_case(tmp_path, sumps={"test": "", "slave": ""}))
    assert "[housing]" in str(said.value)


def test_plain_bearings_need_oil_that_is_fed(tmp_path: Path) -> None:
    path = fzg_case(tmp_path, sumps=FREE)
    fed = 'bearing_oil = { oil = "FVA 3", inlet_temperature = "90 degC", flow = "0.5 l/min" }'
    path.write_text(path.read_text().replace(fed, 'bearing_oil = { lubrication = "splash" }', 1))
    with pytest.raises(CaseError, match="plain bearing, which needs oil that is fed"):
        load_case(path)
