"""A needle roller bearing beside what its makers print, by hand, and in the 1:1 loop."""

import math
from dataclasses import replace
from pathlib import Path

import pytest

from dynamics.rotor.bearing import BearingError, BearingOperation, OilSupply
from dynamics.rotor.rolling import RollingBearing
from dynamics.rotor.rolling_clearance import class_clearance
from dynamics.rotor.rolling_kinds import CatalogueBearing, NeedleRoller
from dynamics.rotor.rolling_row import RowOfElements, contact_law
from dynamics.rotor.rolling_state import RollingState
from dynamics.rotor.rolling_stiffness import bearing_stiffness
from dynamics.standards import iso76_2006
from rigdesign import load_case
from rigdesign.base.errors import CaseError
from rigdesign.results.units import HOUR
from rigdesign.run.main import run_case
from tests.builders.paths import CASES

RPM = math.pi / 30.0
NA_4908 = CatalogueBearing(
    designation="NA 4908", kind="needle_roller", series="49", bore=0.04, outside_diameter=0.062, width=0.022,
    dynamic_rating=42.9e3, static_rating=71e3, fatigue_limit=8.8e3, limiting_speed=9500.0 * RPM,
    reference_speed=9500.0 * RPM, inner_raceway=0.048,
)  # fmt: skip
"""40 x 62 x 22 mm, F = 48 mm; ratings as public programs quote them from SKF's product tables, not read there."""
NUMBERS = """
[gearboxes.test.bearings.pinion_front]
type = "rolling"
shaft = "test_pinion"
side = "front"
position = "0 mm"
friction_law = "{law}"
locating = {locating}
[gearboxes.test.bearings.pinion_front.catalogue]
kind = "needle_roller"
series = "49"
bore = "40 mm"
outside_diameter = "62 mm"
width = "22 mm"
dynamic_rating = "42.9 kN"
static_rating = "71 kN"
limiting_speed = "9500 rpm"
reference_speed = "9500 rpm"
inner_raceway = "48 mm"
"""


def operation(load: float, axial: float = 0.0) -> BearingOperation:
    oil = OilSupply(
        inlet_temperature=343.15, flow=1.0, viscosity=lambda _: 0.02, density=860.0, heat_capacity=2e3
    )
    return BearingOperation(load=load, axial_load=axial, speed=3000.0 * RPM, oil=oil)


def state(load: float) -> RollingState:
    return RollingBearing(data=NA_4908).operating_state(operation(load))


def loop(folder: Path, *, law: str = "skf", locating: str = "false") -> Path:
    """The 1:1 loop with a needle roller bearing in place of the plain one at the front of the test pinion."""
    path = folder / "case.toml"
    text = f'extends = "{CASES / "loop_1to1" / "case.toml"}"\n'
    path.write_text(text + NUMBERS.format(law=law, locating=locating), encoding="utf-8")
    return path


def test_friction_at_a_tenth_of_its_rating_beside_two_makers() -> None:
    """M = mu P d / 2: SKF mu = 0.0020 for needle roller bearings with a cage, Koyo 0.0020 to 0.0030."""
    load = 0.1 * NA_4908.dynamic_rating
    torque = state(load).drag_torque
    assert torque == pytest.approx(0.5 * 0.0020 * load * 0.040)
    assert 0.0020 <= 2.0 * torque / (load * 0.040) * (1.0 + 1e-12) <= 0.0030
    assert state(load).warnings == () and "constant coefficient" in state(load).source
    for outside in (0.04, 0.25):
        assert any("constant coefficient of friction" in text for text in state(outside * 42.9e3).warnings)


def test_loads_life_and_clearance() -> None:
    """P = P_0 = F_r, F_rm = 0.02 C (SKF), (C / P)^(10/3) (ISO 281)."""
    found = state(4290.0)
    assert found.life.equivalent_load == found.life.static_equivalent_load == 4290.0
    assert found.life.basic_life == pytest.approx(10.0 ** (10.0 / 3.0) * 1e6 / (60.0 * 3000.0))
    assert found.life.static_safety == pytest.approx(71.0 / 4.29)
    assert found.minimum_load == pytest.approx(858.0)
    assert class_clearance(NA_4908, "CN") == pytest.approx((25e-6, 50e-6))


def test_needles_have_the_static_rating_and_the_stiffness_of_a_line_contact() -> None:
    """No clearance: the most loaded of Z rollers carries 4.08 F_r / Z (Harris), delta = (Q / K)^(9/10)."""
    elements = NA_4908.elements
    assert elements.inner_raceway == pytest.approx(0.048) and elements.length < NA_4908.width
    rating = iso76_2006.C_0r_roller(
        elements.count, elements.diameter * 1e3, elements.length * 1e3, elements.pitch_diameter * 1e3, 0.0
    )
    assert rating == pytest.approx(71e3)
    law = contact_law(elements)
    found = bearing_stiffness(RowOfElements(elements=elements, law=law), 4290.0, 0.0)
    most = 4.08 * 4290.0 / elements.count
    assert found.largest_element_load == pytest.approx(most, rel=0.01)
    assert found.radial_displacement == pytest.approx((most / law.stiffness) ** 0.9, rel=0.01)
    thick = replace(NA_4908, outer_raceway=0.0576).elements
    assert thick.diameter == pytest.approx(0.0048) and thick.length == pytest.approx(
        elements.length, rel=0.03
    )


def test_it_carries_no_axial_load_and_has_one_law() -> None:
    assert not NA_4908.carries_axial_load and not NeedleRoller.carries_axial_load
    with pytest.raises(
        BearingError, match="axial_load = 10 N: its rings move past each other and carry none"
    ):
        RollingBearing(data=NA_4908).operating_state(operation(4290.0, axial=10.0))
    with pytest.raises(BearingError, match="'iso_tr_14179_2': has no coefficients for its kind; take skf"):
        RollingBearing(data=NA_4908, law="iso_tr_14179_2")
    with pytest.raises(BearingError, match=r"inner_raceway, outer_raceway = 0\.07, 0 m: must lie between"):
        replace(NA_4908, inner_raceway=0.07)


def test_a_case_that_lets_it_guide_its_shaft_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CaseError) as caught:
        load_case(loop(tmp_path, law="iso_tr_14179_2", locating="true"))
    faults = {fault.path.rpartition(".")[2]: fault for fault in caught.value.faults}
    assert "carries no axial load: its rings move past each other" in faults["locating"].problem
    assert "no coefficients for a needle roller bearing" in faults["friction_law"].problem


@pytest.mark.whole_run
def test_the_loop_is_checked_with_it(tmp_path: Path) -> None:
    result = run_case(load_case(loop(tmp_path)), fidelity="quick")
    (row,) = (row for row in result.rolling_bearings if row.stage == "test")
    assert row.bearing == "test.pinion_front" and row.axial_load == 0.0
    assert row.rolling_torque == pytest.approx(0.5 * 0.0020 * row.radial_load * 0.040)
    assert row.sliding_torque == row.drag_torque == 0.0
    checks = {check.id: check for check in result.checks}
    assert checks["bearing.rating_life"].value == pytest.approx(
        min(row.modified_life for row in result.rolling_bearings) / HOUR
    )
    assert checks["bearing.static_safety"].value == pytest.approx(71e3 / row.radial_load, rel=0.2)
