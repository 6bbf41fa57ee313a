"""Strain gauges of a case: where they sit in the root, what their bridge is, and gauges that do not fit."""

import math

import numpy as np
import pytest

from dynamics.gear.root_arc import root_arc
from rigdesign import load_case
from rigdesign.base.errors import CaseError
from rigdesign.case.shipped import case_folder
from rigdesign.checks.assumptions import influences_of
from rigdesign.rig.model import build_rig

CASE = load_case(case_folder("strain_gauge_rig"))
AT = "gearboxes.test.gears.pinion.strain_gauges"


def faults(**changes: object) -> list[str]:
    values = {f"{AT}.{key.replace('__', '.')}": value for key, value in changes.items()}
    with pytest.raises(CaseError) as refused:
        build_rig(CASE.with_values(values), "quick")
    return [str(fault).removeprefix(f"{AT}.") for fault in refused.value.faults]


def test_gauges_of_the_shipped_rig_sit_on_the_30_deg_tangent_over_the_face() -> None:
    gauges = build_rig(CASE, "quick").strain_gauges
    assert list(gauges) == [f"test.pinion.{name}" for name in ("i", "ii", "iii", "iv", "v")]
    points = [gauge.point for gauge in gauges.values()]
    assert [1e3 * point.placement.face_position for point in points] == pytest.approx([-8, -4, 0, 4, 8])
    assert all(point.placement.fillet_position == 0.0 for point in points)
    assert sum(point.bridge.lines for point in points) == 15  # P1: channels of the slip ring
    assert points[0].region.face_width == pytest.approx(25e-3)
    # 125 N/mm2 are 607 um/m or 0.30 mV/V at k = 2, from the bridge's zero
    assert 1e3 * float(points[1].ratio(125e6) - points[1].ratio(0.0)) == pytest.approx(0.3034, abs=2e-3)


@pytest.mark.parametrize("angle", [20.0, 30.0, 45.0])
def test_place_by_tangent_and_by_diameter_is_the_place_along_the_fillet(angle: float) -> None:
    rig = build_rig(CASE.with_values({f"{AT}.ii": _gauge(tangent_angle=f"{angle} deg")}), "quick")
    fillet = root_arc(rig.pairs["test.main"].gears[0])
    place = rig.strain_gauges["test.pinion.ii"].point.placement.fillet_position
    assert place == pytest.approx(np.interp(-math.radians(angle), -fillet.tangent, fillet.arc), abs=1e-9)
    assert (place > 0.0) == (angle < 30.0) or angle == 30.0
    diameter = 2e3 * float(np.interp(place, fillet.arc, fillet.radius))
    by_diameter = CASE.with_values({f"{AT}.ii": _gauge(root_diameter=f"{diameter:.9f} mm")})
    found = build_rig(by_diameter, "quick").strain_gauges["test.pinion.ii"].point.placement.fillet_position
    assert found == pytest.approx(place, abs=1e-9)


def _gauge(**place: object) -> dict[str, object]:
    bridge = {"kind": "quarter", "supply_voltage": "5 V"}
    return {
        "face_position": "-4 mm", "grid_length": "0.6 mm", "grid_width": "1 mm", "bridge": bridge, **place,
    }  # fmt: skip


def test_a_gauge_that_does_not_fit_its_root_is_named() -> None:
    assert faults(v__face_position="12.3 mm") == [
        "v.face_position = 12.3 mm: the grid reaches 12.8 mm from mid-face, the face ends at 12.5 mm; "
        "state the position from mid-face, within +-12 mm"
    ]
    (over,) = faults(i__fillet_position="3 mm")
    assert over.startswith(
        "i.fillet_position = 3 mm: the grid reaches from 2.7 to 3.3 mm, the fillet from -2.6"
    )
    (off,) = faults(ii=_gauge(tangent_angle="88 deg"))
    assert off.startswith("ii.tangent_angle = 88 deg: the fillet reaches from ")
    (wide,) = faults(ii=_gauge(tangent_angle="75 deg", grid_length="2 mm"))
    assert wide.startswith("ii.tangent_angle = 75 deg: the grid reaches from ")
    assert faults(iii__tooth=18) == ["iii.tooth = 18: the gear has 18 teeth, counted from 0; write 0 to 17"]
    (twice,) = faults(ii=_gauge(tangent_angle="30 deg", fillet_position="0 mm"))
    assert "fillet_position and tangent_angle are given; keep one of them" in twice


def test_an_impossible_bridge_is_named_with_the_faults_of_all_gauges() -> None:
    assert faults(
        i__bridge__wires=7, iv__face_position="-14 mm", v__bridge__completion_resistance="350 ohm"
    ) == [
        "i.bridge.wires = 7: a half_passive bridge has 3 or 5; count those to the amplifier",
        "iv.face_position = -14 mm: the grid reaches 14.5 mm from mid-face, the face ends at 12.5 mm; "
        "state the position from mid-face, within +-12 mm",
        "v.bridge.completion_resistance = 350 ohm: must match the 120 ohm of the gauge within 2%; "
        "use a resistor of the gauge's nominal resistance",
    ]
    (kind,) = faults(i__bridge__kind="third")
    assert kind.startswith("i.bridge.kind = ")
    (arms,) = faults(i__bridge={"kind": "half", "supply_voltage": "5 V", "arms": (1.0, 1.0)})
    assert arms.startswith("i.bridge.arms = ") and "the arms cancel" in arms


def test_gauges_move_no_check() -> None:
    assert influences_of(CASE, "gearboxes.test.gears.pinion.strain_gauges.ii.face_position") == ()
    assert influences_of(CASE, "gearboxes.test.gears.pinion.teeth") is None
