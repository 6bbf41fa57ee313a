"""A check knows what its value leaves out: at best a warning that names it, for every check there is."""

import math
from dataclasses import replace
from fnmatch import fnmatchcase
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rigdesign import load_case
from rigdesign.case.shipped import shipped_cases
from rigdesign.checks import held_checks
from rigdesign.checks.component_limits import RESULTS
from rigdesign.checks.events import FAMILIES as EVENTS
from rigdesign.checks.omissions import omissions
from rigdesign.checks.registry import REGISTRY, RuleFamily
from rigdesign.checks.rules import Omission, Rule, hold, with_omissions
from rigdesign.checks.transient import EXTREMES
from rigdesign.coupling.loop import PointResult
from rigdesign.postprocessing.housing import housing_temperatures
from rigdesign.postprocessing.solved_rig import SolvedRig, housing_fields, solved_rig
from rigdesign.results.check import Check
from rigdesign.results.result import RunResult
from rigdesign.rig.model import Rig
from rigdesign.run.main import run_case
from tests.builders.checks import rule_ids
from tests.builders.paths import CASES
from tests.builders.shaft_weight import weight_on_bearing
from tests.builders.warm_prototype import base, settled

pytestmark = pytest.mark.whole_run

COMPLETE = (
    "dynamics.ramp_peak.*",  # the time run holds whole turns and all swinging torques
    "dynamics.lift_off.*",
    "dynamics.contact_margin.*",
    "lateral.*",  # linear about the load of the stage, as they say
    "geometry.*",  # of the drawing
    "specimen.load_cycles",  # commanded
    "ramp.*",
    "bearing.speed",  # commanded
    "bearing.minimum_load",  # loads of the teeth with thrust and tilt, and weight
    "bearing.static_safety",
    "oil.flow",
    "bought_part.torque_peak",
    "bought_part.torque_mean",
    "bought_part.speed",
    "bought_part.circulating_power",
    "bought_part.actuator_force",
    "bought_part.shift_travel",
    "bought_part.oil_flow",
    "bought_part.seal_surface_velocity",
    "bought_part.given",
    "bought_part_event.*",
)
"""Checks whose value leaves out nothing that the case or the run knows of."""
TIMES = {family.key for family in EXTREMES}


def held(value: float, comparison: Any = "<=", **more: Any) -> Check:
    rule = Rule(
        id="x", title="x", unit="kW", source="test", group="oil", limit=3.0, comparison=comparison, **more
    )
    return hold(rule, value)


def known_ids() -> set[str]:
    """Checks of all shipped cases by the keys of the table, and those over time."""
    found = set(TIMES)
    for name in shipped_cases():
        case = load_case(CASES / name)
        parts = case.limits.bought_parts
        for identity in rule_ids(case):
            group, _, own = identity.partition(".")
            found.add(f"bought_part.{parts[own].quantity}" if group == "bought_part" else identity)
    return found


def test_a_held_check_that_leaves_something_out_warns_and_names_it() -> None:
    check = with_omissions(held(1.0), [Omission("heat of the reference gearbox")])
    assert (check.verdict, check.left_out) == ("open", ("heat of the reference gearbox",))
    assert check.reason.endswith("leaves out heat of the reference gearbox")
    assert with_omissions(held(1.0), []).verdict == "pass"


def test_a_broken_check_stays_broken() -> None:
    assert with_omissions(held(4.0), [Omission("more", 0.1)]).verdict == "fail"


@pytest.mark.parametrize(
    ("sizes", "verdict"),
    [((1.9,), "pass"), ((2.0,), "open"), ((1.0, 0.9), "pass"), ((1.0, 1.1), "open"), ((0.1, None), "open")],
)
def test_what_is_known_to_be_less_than_the_margin_decides_nothing(
    sizes: tuple[float | None, ...], verdict: str
) -> None:
    """A margin of 2 kW."""
    check = with_omissions(held(1.0), [Omission(f"part {i}", size) for i, size in enumerate(sizes)])
    assert check.verdict == verdict
    assert len(check.left_out) == len(sizes)


@pytest.mark.parametrize("identity", sorted(known_ids()))
def test_every_check_names_what_it_leaves_out_or_is_known_to_be_complete(identity: str) -> None:
    listed = bool(family_of(identity).leaves_out)
    assert listed != any(fnmatchcase(identity, pattern) for pattern in COMPLETE)


def family_of(identity: str) -> RuleFamily:
    """The family of a check by the key of its family or by its id."""
    keys = [f for f in REGISTRY.families() if f"{identity}.".startswith(f"{f.key}.")]
    return max(keys, key=lambda family: len(family.key))


SEATS = ("shaft_shear", "press_fit_slip", "spline_pressure", "spline_shear", "spline_hub")
LATERAL = ("orbit", "separation", "stability", "stability_without_torque", "torsional_separation")


def test_every_family_of_rules_means_a_check() -> None:
    known = (
        known_ids()
        | {f"bought_part.{quantity}" for quantity in (*RESULTS, "given")}
        | {"transient.soak.test", "oil.supply.warm.lines.mesh", "transient.oil_supply.warm.lines.mesh"}
        | {"oil.room_temperature", "flank.edge_pressure.test"}
        | {f"strength.{key}" for key in SEATS}
        | {f"lateral.{key}" for key in LATERAL}
        | {f"{family.key}.broken" for family in EVENTS}
        | {"bought_part_event.torque_flange"}
    )
    meant = {family_of(identity).key for identity in known}
    assert [family.key for family in REGISTRY.families() if family.key not in meant] == []


def as_solved_rig(rig: Rig, point: PointResult) -> SolvedRig:
    """A settled point without its dynamic results."""
    temperatures = [housing_temperatures(rig, *found) for found in housing_fields([point])]
    return solved_rig(rig, [point], temperatures)


@cache
def shipped() -> dict[str, Check]:
    """Thermal checks of the prototype: the test gearbox has a housing, the reference gearbox none."""
    rig, point = base()
    return {check.id: check for check in held_checks(as_solved_rig(rig, point))}


@pytest.mark.parametrize(
    ("identity", "named"),
    [
        ("oil.room", "heat that gearbox reference gives to the room"),
        ("oil.heater", "walls of gearbox reference"),
        ("temperature.gear_bulk", "gears of gearbox reference above their oil outlet"),
        ("temperature.housing", "walls of gearbox reference"),
        ("temperature.bearing_film", "films of gearbox reference"),
        ("clearance.backlash", "thermal expansion of gearbox reference"),
        ("clearance.bearing_clearance", "thermal expansion of gearbox reference"),
        ("alignment.coupling_offset.pinion_side", "shaft reference_pinion"),
    ],
)
def test_a_gearbox_without_a_housing_is_named_by_what_it_would_add(identity: str, named: str) -> None:
    check = shipped()[identity]
    assert check.verdict == "open" and (check.distance or 0.0) > 0.05
    assert any(named in text for text in check.left_out)


def test_a_share_of_friction_heat_leaves_the_teeth_at_the_mean_of_their_gear() -> None:
    """The prototype gives mesh_into_gears and no rule: the share decides, and the teeth have no temperature."""
    assert base()[0].case.gearboxes["test"].heat_split.mesh is None
    text = "teeth of gearbox test above the mean of their gear: heat_split.mesh = assumed"
    assert text in shipped()["temperature.gear_bulk"].left_out


def test_what_leaves_nothing_out_still_passes() -> None:
    for identity in ("oil.flow", "oil.cooler", "temperature.oil_outlet"):
        assert (shipped()[identity].verdict, shipped()[identity].left_out) == ("pass", ())


def test_the_tilting_moment_of_helical_gears_is_a_load_of_their_bearings() -> None:
    """F_a r_w = T r_w/r tan(beta) over the 245.9 mm between the bearings adds to the separating force of the wheel."""
    rig, last = settled(("gearboxes.reference.meshes.main.double_helical", False))
    state, pair = last.coupling_state, rig.pairs["reference.main"]
    torque = abs(state.mesh_torque["reference.main"])
    tilting = torque / pair.gears[0].reference_radius * 0.3249197 * pair.working_radii[1] / 0.2459
    tangential, separating = (
        0.4797 * torque / pair.base_radii[0] * part(pair.working_pressure_angle)
        for part in (math.cos, math.sin)
    )
    assert rig.drivetrain is not None
    weight = weight_on_bearing(rig, "reference.wheel_front", rig.drivetrain.gear("reference.wheel").mass)
    expected = math.hypot(tangential + weight, separating + tilting)
    assert last.bearings["reference.wheel_front"].load == pytest.approx(expected, rel=2e-3)
    assert last.bearings["reference.wheel_front"].load > 1.04 * math.hypot(tangential + weight, separating)
    solved = as_solved_rig(rig, replace(base()[1], last=last))
    check = next(check for check in held_checks(solved) if check.id == "bearing.specific_load")
    assert not any("tilting" in text for text in check.left_out)


def test_with_one_temperature_of_oil_nothing_is_exchanged_with_two_it_is() -> None:
    rig, last = settled(("gearboxes.reference.oil.inlet_temperature", "60 degC"))
    point = replace(base()[1], last=last)
    found = {check.id: check for check in held_checks(as_solved_rig(rig, point))}
    for identity in ("oil.cooler", "temperature.oil_outlet"):
        assert any("warmer oil of gearbox reference" in text for text in found[identity].left_out)
        assert found[identity].verdict == "open"


def test_a_rig_that_still_warms_up_is_at_best_a_warning() -> None:
    rig, last = settled(("ambient.warming_time", "2 h"))
    found = {check.id: check for check in held_checks(as_solved_rig(rig, replace(base()[1], last=last)))}
    for identity in ("temperature.oil_outlet", "oil.cooler"):
        assert found[identity].verdict == "open"
        assert any("rest of the warm-up" in text for text in found[identity].left_out)


def bare(folder: Path, limits: str) -> RunResult:
    """The prototype with given losses and no housing anywhere."""
    file = folder / "case.toml"
    file.write_text(
        f'extends = "{(CASES / "uhcf_prototype" / "given_losses.toml").as_posix()}"\nname = "bare"\ntitle = "bare"\n'
        f'[gearboxes.test]\nremove = ["housing"]\n{limits}',
        encoding="utf-8",
    )
    return run_case(load_case(file), fidelity="quick")


def test_given_losses_without_those_of_the_jets_name_them(tmp_path: Path) -> None:
    """Oil thrown at the pitch line takes 0.3 kW at 12,000 rpm, and the pump gives its kinetic energy."""
    found = {check.id: check for check in bare(tmp_path, "").checks}
    assert any("oil_acceleration losses of gearbox test" in text for text in found["oil.cooler"].left_out)
    given = "".join(
        f'[losses.given.{box}_jet]\ngearbox = "{box}"\nkind = "oil_acceleration"\npart = "main"\npower = "300 W"\n'
        for box in ("test", "reference")
    )
    found = {check.id: check for check in bare(tmp_path, given).checks}
    assert not any("oil_acceleration" in text for text in found["oil.cooler"].left_out)


def test_backlash_and_tip_clearance_are_known_without_a_housing(tmp_path: Path) -> None:
    """Gears and axes at their oil: the mesh that carries the load has both. By hand the backlash moves by
    2 tan(20 deg) alpha (a dT_axes - (r1 + r2) dT_gears) from the cold one; the least is that of the hotter gears."""
    result = bare(tmp_path, "")
    found = {check.id: check for check in result.checks}
    backlash, tip = found["clearance.backlash"], found["clearance.tip_clearance"]
    assert backlash.verdict == tip.verdict == "open"
    assert all("thermal expansion of gearbox test" in check.left_out[0] for check in (backlash, tip))
    assert "at the temperature of their oil" in backlash.reason and "test.main" in backlash.reason
    outlet = {row.consumer: row.outlet - 273.15 for row in result.oil if row.stage == "test"}
    gears, axes = outlet["test.gear_oil"] - 20.0, outlet["test.bearing_oil"] - 20.0
    change = 2.0 * 0.36397 * 11.5e-6 * 99.5 * (axes - gears)
    thinning = 2.0 * 0.060
    assert change < -0.05
    assert backlash.value == pytest.approx(thinning + change, abs=0.02)


def test_limits_without_a_housing_fail_where_they_must(tmp_path: Path) -> None:
    """Backlash and tip clearance were not applicable here, whatever limit the case stated."""
    limits = {"backlash": "0.5 mm", "tip_clearance": "2 mm", "axial_play": "0.6 mm"}
    stated = "".join(f'{key}_minimum = "{value}"\n' for key, value in limits.items())
    result = bare(tmp_path, f"[limits.clearances]\n{stated}")
    found = {check.id: check.verdict for check in result.checks}
    assert {found[f"clearance.{key}"] for key in limits} == {"fail"}
    housing = result.checks["temperature.housing"]
    assert (housing.verdict, housing.limit) == (
        "open",
        180.0,
    ) and "no gearbox has a housing" in housing.reason


def test_a_motor_at_its_limit_says_so_of_torque_and_power() -> None:
    """Half of a run at 20 N m, the limit of the prototype: the power is as little known as the torque."""
    rig, point = base()
    time = np.linspace(2.0, 8.0, 101)
    torque = np.where(np.arange(101) < 50, 20.0, 10.0)
    run: Any = SimpleNamespace(ramp=SimpleNamespace(time=time, drive_torque=torque, cut=""))
    solved = replace(as_solved_rig(rig, point), run=run)
    motor = rig.case.limits.bought_parts["motor"]
    for quantity in ("drive_torque", "drive_power"):
        parts = {"motor": motor.model_copy(update={"quantity": quantity})}
        limits = rig.case.limits.model_copy(update={"bought_parts": parts})
        here = replace(solved, rig=replace(rig, case=rig.case.model_copy(update={"limits": limits})))
        check = replace(held(1.0), id="bought_part.motor")
        (omission,) = omissions(here, check)
        assert "49.5 % of the run" in omission.text
        assert with_omissions(check, [omission]).verdict == "open"
