"""Which gearboxes can be built, what they are made of, and how refusals read; no mesh, no gmsh."""

import math
import re
import subprocess
import sys
from dataclasses import replace
from itertools import pairwise
from typing import Any

import pytest

from thermal.housing.geometry import ClampingField, HousingGeometry
from thermal.housing.housing_surfaces import body_names, exact_areas, exact_volumes, surface_names
from thermal.housing.shaft_geometry import EndBearing, GearDisc, GeometryError, ShaftGeometry
from thermal.housing.shaft_surfaces import shaft_zones


def bearing(width: float = 0.024, diameter: float = 0.040) -> EndBearing:
    return EndBearing(journal_diameter=diameter, width=width)


def ends(width: float) -> dict[str, EndBearing]:
    """Bearings of one width at both ends."""
    return {"front": bearing(width), "rear": bearing(width)}


def shaft(**changes: Any) -> ShaftGeometry:
    data: dict[str, Any] = {
        "name": "pinion", "y": -0.04975, "front": bearing(), "rear": bearing(), "seal_diameter": 0.045,
        "seat_diameter": 0.050, "overhang_diameter": 0.036, "seal_gap": 0.6e-3,
        "locating": "front", "overhang_rear": 0.06, "gear": GearDisc(outer_diameter=0.101, width=0.007),
    }  # fmt: skip
    return ShaftGeometry(**(data | changes))


def gearbox(**changes: Any) -> HousingGeometry:
    data: dict[str, Any] = {
        "chamber_length": 0.1, "cold_length_front": 0.09, "cold_length_rear": 0.08, "height": 0.28,
        "width": 0.32, "wall_thickness": 0.013, "floor_thickness": 0.015, "top_thickness": 0.012,
        "partition_thickness": 0.015, "end_wall_thickness": 0.03, "shaft_height": 0.14,
        "shafts": (shaft(), shaft(name="wheel", y=0.04975, overhang_front=0.05)),
        "field": ClampingField(length=0.8, width=1.2, thickness=0.15),
    }  # fmt: skip
    return HousingGeometry(**(data | changes))


def test_stations_along_the_shafts() -> None:
    g = gearbox()
    assert g.partition_front == pytest.approx((0.12, 0.135))
    assert g.partition_rear == pytest.approx((0.235, 0.25))
    assert g.length == pytest.approx(0.36)
    assert g.warm_limits == pytest.approx((0.1275, 0.2425))
    assert g.bearing_depths(g.shafts[0].front) == pytest.approx((0.006, 0.03))
    assert g.gear_limits(g.shafts[0]) == pytest.approx((0.1815, 0.1885))


def test_wide_bearing_gets_a_boss() -> None:
    g = gearbox(shafts=(shaft(**ends(0.04)),))
    assert g.protrusion(g.shafts[0].front) == pytest.approx(0.016)
    assert g.bearing_depths(g.shafts[0].front) == pytest.approx((0.006, 0.046))


def test_bearing_that_just_fills_its_wall_is_flush() -> None:
    """0.018 + 0.072 exceeds 0.09 by a rounding error, which must not become a boss."""
    g = gearbox(end_wall_thickness=0.09, end_seal_width=0.018, shafts=(shaft(**ends(0.072)),), field=None)
    assert g.protrusion(g.shafts[0].front) == 0.0


def test_zones_of_a_shaft_touch_and_fill_its_length() -> None:
    g = gearbox()
    for s in g.shafts:
        zones = shaft_zones(g, s)
        for first, second in pairwise(zones):
            assert first.end == pytest.approx(second.start, abs=1e-15)
        assert zones[0].start == pytest.approx(-s.overhang_front if s.overhang_front else 0.006)
        assert zones[-1].end == pytest.approx(g.length + s.overhang_rear)


def test_surfaces_of_parts_that_are_not_there_do_not_exist() -> None:
    names = set(surface_names(gearbox()))
    assert {"shaft_wheel_outside_front", "seal_bore_wheel_front_end", "gear_pinion_rim"} <= names
    assert not {"shaft_pinion_outside_front", "seal_bore_pinion_front_end", "shaft_pinion_bore"} & names
    bare = gearbox(field=None, shafts=(shaft(gear=None, bore_diameter=0.02),))
    names = set(surface_names(bare))
    assert {"housing_foot", "shaft_pinion_bore"} <= names
    assert not any(name.startswith(("field", "gear")) for name in names)
    assert body_names(bare) == ("housing", "shaft_pinion")


def test_surface_names_are_unique_and_need_no_gmsh() -> None:
    code = (
        "import sys; from thermal.housing.gearbox import surface_names; "
        "assert 'gmsh' not in sys.modules and 'CoolProp' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
    names = surface_names(gearbox())
    assert len(names) == len(set(names))


def test_closed_forms_agree_with_a_body_whose_surface_is_counted_otherwise() -> None:
    """The outside of the housing is a box less the holes of the shafts that leave it."""
    g = gearbox()
    areas = exact_areas(g)
    holes = 3 * math.pi * (0.018 + 0.6e-3) ** 2
    outside = 2 * (g.length * g.height + g.width * g.height) + g.length * g.width - holes
    assert sum(areas[f"outer_{part}"] for part in ("warm", "cold_front", "cold_rear")) == pytest.approx(
        outside
    )
    assert areas["field_top"] == pytest.approx(0.8 * 1.2 - g.length * g.width)
    assert exact_volumes(g)["gear_pinion"] == pytest.approx(math.pi / 4 * (0.101**2 - 0.05**2) * 0.007)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"width": -0.3}, ("width", "-0.3", "greater than 0")),
        ({"height": math.nan}, ("height", "nan")),
        ({"wall_thickness": 0.16}, ("width", "0.32", "walls")),
        ({"shaft_height": 0.05}, ("pinion", "gear", "floor", "enlarge")),
        ({"chamber_length": 0.008}, ("gear", "clear length 0.008 m", "lengthen")),
        ({"field": ClampingField(length=0.36, width=1.2, thickness=0.1)}, ("field length", "enlarge")),
        ({"shafts": ()}, ("shafts is empty",)),
        ({"shafts": (shaft(), shaft())}, ("'pinion'", "2 times")),
        ({"shafts": (shaft(), shaft(name="b", y=0.0))}, ("pinion and b", "0.04975", "move the axes")),
        ({"shafts": (shaft(**ends(0.12)),)}, ("front bearing of width 0.12", "cold_length_front", "narrow")),
        (
            {"shafts": (shaft(rear=bearing(0.12)),)},
            ("rear bearing of width 0.12", "cold_length_rear", "narrow"),
        ),
        ({"shafts": (shaft(overhang_rear=1e-5),)}, ("overhang_rear = 1e-05", "give 0")),
    ],
)
def test_refused_housings_name_value_limit_and_remedy(change: dict[str, Any], words: tuple[str, ...]) -> None:
    with pytest.raises(GeometryError) as error:
        gearbox(**change)
    for word in words:
        assert word in str(error.value)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"name": "Pinion 1"}, ("'Pinion 1'", "lower-case")),
        ({"seal_gap": 0.0}, ("shaft pinion", "seal_gap", "greater than 0")),
        ({"bore_diameter": 0.035}, ("bore_diameter = 0.035", "overhang_diameter", "thicker")),
        (
            {"bore_diameter": 0.033, "rear": bearing(diameter=0.034)},
            ("journal_diameter of its rear bearing", "thicker"),
        ),
        ({"bore_diameter": 1e-4}, ("bore_diameter = 0.0001", "give 0")),
        ({"gear": GearDisc(outer_diameter=0.05, width=0.01)}, ("gear = 0.05 m", "its seat")),
        ({"locating": "middle"}, ("'middle'", "front")),
        ({"overhang_front": -0.1}, ("overhang_front", "must not be negative")),
    ],
)
def test_refused_shafts(change: dict[str, Any], words: tuple[str, ...]) -> None:
    with pytest.raises(GeometryError) as error:
        shaft(**change)
    for word in words:
        assert word in str(error.value)


def chamber(**changes: Any) -> HousingGeometry:
    """The gearbox without partitions: bearings that protrude 16 mm into the chamber."""
    bare = {"seal_diameter": 0.0, **ends(0.04)}
    shafts = (shaft(**bare), shaft(name="wheel", y=0.04975, overhang_front=0.05, **bare))
    none = {"cold_length_front": 0.0, "cold_length_rear": 0.0, "partition_thickness": 0.0}
    return gearbox(**(none | {"shafts": shafts} | changes))


def test_one_chamber_is_a_hollow_box_with_bosses() -> None:
    """Volume and surfaces written down by hand: box less clearance, bores and end seals, plus bosses."""
    g = chamber()
    inner, half = (0.28 - 0.027), 0.32 / 2 - 0.013
    bore, boss, seal = 0.02, 0.032, 0.018 + 0.6e-3
    assert g.length == pytest.approx(0.16)
    rings = -4 * bore**2 * 0.04 + 4 * boss**2 * 0.016 - 3 * seal**2 * 0.006
    box = 0.16 * 0.32 * 0.28 - 0.1 * 2 * half * inner
    assert exact_volumes(g)["housing"] == pytest.approx(box + math.pi * rings)
    areas = exact_areas(g)
    assert areas["outer_warm"] == pytest.approx((2 * 0.28 + 0.32) * 0.16)
    assert areas["outer_end_front"] == pytest.approx(0.32 * 0.28 - math.pi * seal**2)
    assert areas["outer_end_rear"] == pytest.approx(0.32 * 0.28 - 2 * math.pi * seal**2)
    cover, shoulder = bore**2, bore**2 - seal**2
    mantles = 2 * 2 * boss * 0.016
    assert areas["end_wall_front"] == pytest.approx(
        2 * half * inner + math.pi * (-2 * bore**2 + mantles + cover + shoulder)
    )
    assert not any("cold" in name or "partition" in name for name in areas)


def test_shafts_of_one_chamber_reach_from_bearing_to_bearing() -> None:
    g = chamber()
    zones = shaft_zones(g, g.shafts[1])
    assert [zone.surface.removeprefix("shaft_wheel_") for zone in zones] == [
        "outside_front", "seal_front_end", "journal_front", "warm", "warm", "warm", "journal_rear", "seal_rear_end",
        "outside_rear",
    ]  # fmt: skip
    for first, second in pairwise(zones):
        assert first.end == pytest.approx(second.start, abs=1e-15)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"cold_length_front": 0.05}, ("cold_length_rear = 0.0", "greater than 0")),
        ({"shafts": (shaft(),)}, ("seal_diameter = 0.045", "must be 0", "without partitions")),
        ({"chamber_length": 0.038}, ("gear of width 0.007", "0.006 m are free", "lengthen")),
        ({"chamber_length": 0.03}, ("width 0.04 m and 0.04 m", "no room between", "thicken")),
    ],
)
def test_refused_housings_of_one_chamber(change: dict[str, Any], words: tuple[str, ...]) -> None:
    with pytest.raises(GeometryError) as error:
        chamber(**change)
    for word in words:
        assert word in str(error.value)


def test_geometry_is_a_key() -> None:
    assert hash(gearbox()) == hash(gearbox())
    assert gearbox() != replace(gearbox(), height=0.29)


def refusal(**changes: Any) -> str:
    """What is said of a gearbox; empty if it can be built."""
    try:
        gearbox(**changes)
    except GeometryError as error:
        return str(error)
    return ""


@pytest.mark.parametrize(
    ("part", "said", "change"),
    [
        ("width", r"less than (.*) m; widen", lambda room: {"width": 2 * 0.013 + room}),
        ("height", r"less than (.*) m; raise", lambda room: {"height": 0.015 + 0.012 + room}),
        (
            "field", r"0.36 m by (.*) m; enlarge",
            lambda room: {"field": ClampingField(length=0.36 + room, width=1.2, thickness=0.1)},
        ),
    ],
)  # fmt: skip
def test_the_limit_that_is_said_is_the_one_that_holds(part: str, said: str, change: Any) -> None:
    found = re.search(said, refusal(**change(1e-3)))
    assert found is not None
    limit = float(found[1])
    assert re.search(said, refusal(**change(0.999 * limit)))
    assert not re.search(said, refusal(**change(1.001 * limit)))
