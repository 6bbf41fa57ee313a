"""Oils are judged where they are coldest and where they are hottest: fed, drained, and at the start in the cold."""

from fnmatch import fnmatchcase
from functools import cache
from types import SimpleNamespace
from typing import Any

import pytest

from dynamics.losses.loss import Loss
from rigdesign.base.part_name import OilStreamName
from rigdesign.case import load_case
from rigdesign.checks.law_ranges import loss_findings, oil_findings
from rigdesign.coupling.located_loss import PlacedLoss
from rigdesign.properties.oil import FVA_3, FVA_3A
from rigdesign.results.check import Finding
from rigdesign.rig.model import Rig, build_rig
from rigdesign.run.warnings import oil_at_room_temperature

ZERO = 273.15


@cache
def rig(room: str = "20 degC") -> Rig:
    """FVA 3A in all circuits."""
    return build_rig(load_case("cases/loop_1to1").with_value("ambient.temperature", room), "quick")


def findings(inlet: float, outlet: float) -> list[Finding]:
    """Findings of the gear oil of the test gearbox between two temperatures [degC]."""
    stream = SimpleNamespace(
        name=OilStreamName("test", "gear_oil"),
        inlet=inlet + ZERO,
        outlet=outlet + ZERO,
        chamber=outlet + ZERO,
    )
    point = SimpleNamespace(point=SimpleNamespace(stage="test"), last=SimpleNamespace(streams=[stream]))
    subject: Any = SimpleNamespace(points=[point], rig=rig(), case=rig().case)
    return list(oil_findings(subject))


def found(inlet: float, outlet: float) -> list[str]:
    """Their texts."""
    return [finding.text for finding in findings(inlet, outlet)]


def test_oil_fed_at_minus_60_degc_is_found() -> None:
    viscosity = FVA_3A.kinematic_viscosity(213.15) * 1e6
    assert viscosity > 5e5
    texts = found(-60.0, 60.0)
    assert len(texts) == 2
    assert all(f"-60 degC = {viscosity:.3g} mm2/s" in text for text in texts)
    assert "viscosity line" in texts[0] and "pumps" in texts[1]


def test_oil_outside_of_its_line_names_the_checks_that_rest_on_it() -> None:
    """Its temperatures and its films are open, no root stress is; those of the other gearbox keep theirs."""
    (named,) = {finding.checks for finding in findings(-60.0, 60.0)}
    resting = (
        "temperature.oil_outlet",
        "oil.cooler",
        "bought_part.motor",
        "flank.film_ratio.test",
        "clearance.backlash",
    )
    for check in resting:
        assert any(fnmatchcase(check, pattern) for pattern in named), check
    for check in (
        "flank.film_ratio.reference",
        "specimen.root_stress_iso.test.pinion",
        "flank.pitting_safety.test.pinion",
    ):
        assert not any(fnmatchcase(check, pattern) for pattern in named), check


@pytest.mark.parametrize(("power", "rests"), [(40.0, True), (1.0, False)])
def test_a_loss_outside_of_its_law_leaves_open_what_it_heats(power: float, rests: bool) -> None:
    """From a tenth of the heat on; a small one moves no temperature."""
    outside = ("outside of its tests",)
    losses = [
        PlacedLoss(
            gearbox="test",
            part=part,
            loss=Loss(place=f"test.{part}", kind=kind, power=lost, warnings=texts),
            into_body=0.0,
        )
        for part, kind, lost, texts in (("pinion", "windage", power, outside), ("main", "mesh", 60.0, ()))
    ]
    (finding,) = loss_findings({"dwell": losses})
    assert any(fnmatchcase("temperature.gear_bulk", pattern) for pattern in finding.checks) is rests


def test_usual_oil_says_nothing_and_hot_oil_is_still_found() -> None:
    assert found(60.0, 70.0) == []
    (text,) = found(60.0, 140.0)
    assert "above 110 degC" in text


@pytest.mark.parametrize(("room", "thick"), [("20 degC", 0), ("-10 degC", 4)])
def test_a_cold_start_is_judged_at_the_temperature_of_the_room(room: str, thick: int) -> None:
    """ISO VG 100 at 20 degC has about 300 mm2/s, at -10 degC more than any pump takes: all four circuits."""
    assert FVA_3.kinematic_viscosity(293.15) * 1e6 == pytest.approx(320.0, rel=0.1)
    texts = list(oil_at_room_temperature(rig(room)))
    assert len(texts) == thick
    assert all("start at the temperature of the room" in text and "-10 degC" in text for text in texts)
