"""Mesh damping in the losses: what the damper takes, who pays it, and that it heats nothing unless the case says so."""

import math

import numpy as np
import pytest

from rigdesign.case import load_case
from rigdesign.case.shipped import case_folder
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.located_loss import PlacedLoss
from rigdesign.postprocessing.housing import losses_of, stage_balance
from rigdesign.prediction.memoisation import Memoisation
from rigdesign.run.main import losses_by_stage
from tests.builders.warm_prototype import base, drive_power, lost, lost_in_all, open_share, outlet, settled
from tests.published.prototype import Prototype
from tests.published.speed_sweeps import closing, simulation_laws, speed_sweep

pytestmark = pytest.mark.whole_run

CLOSING = tuple(
    (f"gearboxes.{box}.meshes.main.damping_acts_on", "contact_closing_rate") for box in ("test", "reference")
)
HEATS = ("losses.mesh_damping_heats_oil", True)


def damper(last: IterationResult) -> PlacedLoss:
    return next(p for p in last.losses if p.loss.kind == "mesh_damping" and p.gearbox == "test")


def test_damper_on_the_relative_rotation_takes_next_to_nothing_from_steady_rolling() -> None:
    _, last = settled()
    assert 0.0 < lost(last, "mesh_damping") < 1e-3 * lost(last, "mesh")
    assert damper(last).loss.warnings == ()


def test_damper_on_the_closing_rate_takes_as_much_as_friction_and_warns() -> None:
    _, last = settled(*CLOSING)
    assert lost(last, "mesh_damping") == pytest.approx(531.0, rel=0.03)
    assert lost(last, "mesh") == pytest.approx(651.0, rel=0.03)
    (text,) = damper(last).loss.warnings
    assert "limit 10% of the tooth friction" in text
    assert 'damping_acts_on = "relative_rotation"' in text


def test_supercritical_factor_of_p2_simulation_under_both_laws() -> None:
    # an independent integrator found 1.140 with the tip corners damped, 1.054 without
    prototype = Prototype(case_folder())
    laws = simulation_laws(prototype)
    factors = [speed_sweep(prototype, law, np.array([12000.0])).factor[0, 0] for law in (laws, closing(laws))]
    assert factors == pytest.approx([1.054, 1.140], abs=0.002)


def test_variant_of_the_prototype_is_that_reading() -> None:
    case = load_case("cases/uhcf_prototype/closing_rate_damping.toml")
    boxes = case.gearboxes.values()
    assert {mesh.damping_acts_on for box in boxes for mesh in box.meshes.values()} == {"contact_closing_rate"}


def test_motor_pays_the_damper_and_no_part_is_warmed_by_it() -> None:
    rig, last = settled(*CLOSING)
    assert drive_power(rig, last) == pytest.approx(lost_in_all(last), rel=2e-3)
    assert damper(last).into_oil == damper(last).into_body == 0.0
    row = next(row for row in losses_of("test", last.losses) if row.kind == "mesh_damping")
    assert row.not_heat == row.power == damper(last).loss.power
    parts = stage_balance(rig, last).cooling
    assert parts.not_heat == pytest.approx(
        lost(last, "mesh_damping") + lost(last, "mesh_damping", "reference")
    )
    assert parts.losses == pytest.approx(lost_in_all(last) - parts.not_heat)
    assert open_share(rig, last) < 2e-3


def test_case_may_give_the_work_of_the_damper_to_the_oil() -> None:
    _, without = settled(*CLOSING)
    rig, last = settled(*CLOSING, HEATS)
    assert damper(last).into_oil == pytest.approx(damper(last).loss.power)
    assert stage_balance(rig, last).cooling.not_heat == 0.0
    assert open_share(rig, last) < 2e-3
    box = rig.case.gearboxes["test"].oil
    oil = rig.oils[box.oil]
    rise = damper(last).loss.power / (
        oil.density(box.inlet_temperature) * oil.heat_capacity(box.inlet_temperature) * box.flow
    )
    warmer = outlet(last, "test.gear_oil") - outlet(without, "test.gear_oil")
    assert 0.5 * rise < warmer < rise


def test_every_stage_that_turns_books_friction_and_damping_alike() -> None:
    rig, test = base()
    found = losses_by_stage(rig, [test])
    rows = [row for stage, losses in found.items() for row in losses_of(stage, losses)]
    turning = {stage.name for stage in rig.case.schedule.resolved() if stage.speed_end > 0.0}
    for kind in ("mesh", "mesh_damping"):
        assert {row.stage for row in rows if row.kind == kind and row.place == "test.main"} == turning
    # the end of the load ramp is the operating point of the test: nothing jumps between them
    ends = {
        stage: math.fsum(
            row.power for row in rows if row.stage == stage and row.kind in ("mesh", "mesh_damping")
        )
        for stage in ("full_torque", "test")
    }
    assert ends["full_torque"] == pytest.approx(ends["test"], rel=1e-3)


def test_a_remembered_mesh_takes_the_damper_of_the_case() -> None:
    memory = Memoisation()
    rig, test = base()
    shipped = memory.models(rig, test.point, test.last.coupling_state)
    changed, _ = settled(*CLOSING)
    other = memory.models(changed, test.point, test.last.coupling_state)
    assert [model.law.damping_acts_on for model in shipped] == ["relative_rotation"] * 2
    assert [model.law.damping_acts_on for model in other] == ["contact_closing_rate"] * 2
    assert all(a.law.gap is b.law.gap for a, b in zip(shipped, other))
