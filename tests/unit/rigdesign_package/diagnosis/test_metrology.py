"""Inspections narrow the prior of the effects that they measure."""

import pytest

from rigdesign.base.errors import MeasurementError
from rigdesign.case import load_case
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.diagnosis.residual.metrology import inspected
from rigdesign.measurement import load_measurement
from tests.builders.paths import CASES

CASE = CASES / "strain_gauge_rig"
NAME = "misalignment:test.main"


@pytest.fixture(scope="module")
def effects():
    return effects_of(load_case(CASE))


def by_name(effects):
    return {effect.name: effect for effect in effects}


def test_spread_and_bounds_become_those_of_the_inspection(effects) -> None:
    before, after = by_name(effects)[NAME], by_name(inspected(effects, {NAME: 1e-6}, "set"))[NAME]
    assert before.healthy > 2e-6 and after.healthy == 1e-6
    assert after.parameters[0].bounds == pytest.approx((-3e-6, 3e-6))
    others = [one for one in inspected(effects, {NAME: 1e-6}, "set") if one.name != NAME]
    assert others == [one for one in effects if one.name != NAME]


def test_a_coarse_inspection_widens_nothing(effects) -> None:
    assert by_name(inspected(effects, {NAME: 1e-3}, "set"))[NAME].healthy == by_name(effects)[NAME].healthy
    assert by_name(inspected(effects, {NAME: 1e-3}, "set"))[NAME].parameters[0].bounds == pytest.approx(
        (-5e-5, 5e-5)
    )


def test_an_unknown_effect_is_a_fault_with_the_nearest(effects) -> None:
    with pytest.raises(MeasurementError, match=r"misalignment:test\.main"):
        inspected(effects, {"misalignment:test.mian": 1e-6}, "set")
    with pytest.raises(MeasurementError, match="inspections"):
        inspected(effects, {"mesh_loss:test": 1e-6}, "set")


def test_a_set_states_them(tmp_path) -> None:
    source = CASE / "measured" / "p1_printed"
    text = (source / "measurement.toml").read_text(encoding="utf-8")
    text += f'[inspections."{NAME}"]\nuncertainty = "2 um"\nsource = "contact pattern"\n'
    (tmp_path / "measurement.toml").write_text(text, encoding="utf-8")
    (tmp_path / "data.csv").write_text((source / "data.csv").read_text(encoding="utf-8"), encoding="utf-8")
    assert load_measurement(tmp_path, load_case(CASE)).inspections == {NAME: pytest.approx(2e-6)}
