"""Catalogue numbers and the rolling elements derived from them."""

import math
import re
from dataclasses import replace
from pathlib import Path

import pytest

from dynamics.rotor import rolling_catalogue
from dynamics.rotor.bearing import BearingError
from dynamics.rotor.rolling_catalogue import catalogue_bearing, tabled_designations
from dynamics.rotor.rolling_elements import RollingElements
from dynamics.rotor.rolling_kinds import ROLLING_KINDS, CatalogueBearing, TwoLawKind
from dynamics.standards import iso76_2006, skf_friction_2006


@pytest.mark.parametrize("spelling", ["NU 208 ECP", "NU 208", "nu208", "NU-208", " nu 208 ecp "])
def test_designation_with_and_without_suffix(spelling: str) -> None:
    assert catalogue_bearing(spelling).designation == "NU 208 ECP"


def test_printed_numbers_of_a_6208() -> None:
    """SKF General Catalogue 6000 p. 308."""
    bearing = catalogue_bearing("6208")
    assert (bearing.bore, bearing.outside_diameter, bearing.width) == pytest.approx((0.04, 0.08, 0.018))
    assert (bearing.dynamic_rating, bearing.static_rating) == pytest.approx((32500.0, 19000.0))
    assert bearing.fatigue_load == pytest.approx(800.0)
    assert bearing.limiting_speed * 30.0 / math.pi == pytest.approx(11000.0)
    assert bearing.source == "SKF General Catalogue 6000 p. 308"


def test_unknown_designation_names_the_nearest_and_the_remedy() -> None:
    with pytest.raises(BearingError, match=r"designation = 'NU 2O8'.*NU 208 ECP.*catalogue numbers"):
        catalogue_bearing("NU 2O8")


def test_the_table_is_whole() -> None:
    text = (Path(rolling_catalogue.__file__).parent / rolling_catalogue.TABLE).read_text(encoding="utf-8")
    lines = text.splitlines()
    assert len(tabled_designations()) == len(lines) - 1 == 71
    columns = lines[0].split(",")
    for designation in tabled_designations():
        bearing = catalogue_bearing(designation)
        assert re.search(r"p\. \d+$", bearing.source)
        assert bearing.outside_diameter > bearing.bore
        assert bearing.fatigue_load < bearing.static_rating
        assert all(f"{name}" in columns for name in bearing.unconfirmed)
        assert bearing.locating == (not bearing.designation.startswith("NU"))


def test_numbers_from_memory_are_named() -> None:
    assert catalogue_bearing("NJ 406").unconfirmed == ("outer_raceway_mm",)
    assert catalogue_bearing("6208").unconfirmed == ()


@pytest.mark.parametrize("designation", tabled_designations())
def test_rolling_elements_give_the_printed_static_rating(designation: str) -> None:
    bearing = catalogue_bearing(designation)
    elements = bearing.elements
    millimetres = elements.diameter * 1e3
    if elements.roller:
        rating = iso76_2006.C_0r_roller(
            elements.count,
            millimetres,
            elements.length * 1e3,
            elements.pitch_diameter * 1e3,
            elements.contact_angle,
        )
        assert elements.length < bearing.width
    else:
        factor = bearing.f_0 or iso76_2006.f_0(elements.gamma)
        rating = iso76_2006.C_0r_ball(elements.count, millimetres, elements.contact_angle, factor)
    assert rating == pytest.approx(bearing.static_rating, rel=1e-5)
    assert bearing.bore < elements.inner_raceway < elements.outer_raceway < bearing.outside_diameter


@pytest.mark.parametrize(
    ("designation", "count", "diameter"),
    [
        ("6205", 9, 7.938e-3), ("6208", 9, 11.906e-3), ("6210", 10, 12.7e-3), ("6309", 8, 17.462e-3),
        ("6311", 8, 20.638e-3),
    ],
)  # fmt: skip
def test_derived_balls_against_known_ones(designation: str, count: int, diameter: float) -> None:
    """Ball numbers and inch sizes that vibration diagnosis tables for these bearings carry (from memory)."""
    elements = catalogue_bearing(designation).elements
    assert elements.count == count
    assert elements.diameter == pytest.approx(diameter, rel=0.035)


def test_every_described_series_has_both_friction_laws() -> None:
    skf = {
        "deep_groove_ball": skf_friction_2006.DEEP_GROOVE,
        "cylindrical_roller": skf_friction_2006.CYLINDRICAL,
        "tapered_roller": skf_friction_2006.TAPERED,
    }
    kinds = {name: kind for name, kind in ROLLING_KINDS.items() if isinstance(kind, TwoLawKind)}
    assert set(skf) <= set(kinds)
    for name, kind in kinds.items():
        assert set(kind.series) <= set(kind.palmgren_constants)
        assert name not in skf or set(kind.series) <= set(skf[name])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"bore": 0.0}, "bore = 0: must be above 0"),
        ({"bore": 0.09}, "outside_diameter = 0.08 m: must be above the bore"),
        ({"static_rating": math.nan}, "static_rating = nan: must be above 0"),
        ({"series": "72B"}, "series = '72B': no friction coefficients"),
        ({"kind": "spherical_roller"}, "kind = 'spherical_roller': must be one of deep_groove_ball"),
        ({"kind": "tapered_roller", "series": "302"}, "contact_angle = 0: must be above 0 for this kind"),
        (
            {"kind": "cylindrical_roller", "series": "2"},
            "inner_raceway, outer_raceway = 0, 0 m: must lie between",
        ),
    ],
)
def test_impossible_numbers_are_refused(change: dict[str, object], message: str) -> None:
    with pytest.raises(BearingError, match=re.escape(message)):
        replace(catalogue_bearing("6208"), **change)


@pytest.mark.parametrize("designation", ["6208", "7205 BEP", "30205 J2/Q", "NJ 406"])
@pytest.mark.parametrize("factor", [1e-6, 1e-3, 0.1, 3.0, 1e3])
def test_a_static_rating_that_does_not_belong_to_the_dimensions_is_refused(
    designation: str, factor: float
) -> None:
    """N in place of kN: balls of 0.2 mm, or rollers of a metre, would give that rating."""
    bearing = catalogue_bearing(designation)
    wrong = replace(bearing, static_rating=factor * bearing.static_rating)
    with pytest.raises(
        BearingError, match=r"static_rating = .* N: (would need|no number of balls).*; (give|correct) C_0"
    ):
        _ = wrong.elements


def test_bearing_by_its_numbers_with_known_elements() -> None:
    elements = RollingElements(count=9, diameter=11.906e-3, pitch_diameter=60e-3)
    bearing = CatalogueBearing(
        designation="6208 of another make", kind="deep_groove_ball", series="62", bore=0.04, outside_diameter=0.08,
        width=0.018, dynamic_rating=30e3, static_rating=17.8e3, limiting_speed=1000.0, reference_speed=900.0,
        rolling_elements=elements,
    )  # fmt: skip
    assert bearing.elements is elements
    assert bearing.fatigue_load == pytest.approx(17.8e3 / 22.0)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"count": 2}, "count = 2: must be at least 3"),
        ({"count": 20}, "count = 20 of 0.012 m: do not fit"),
        ({"diameter": 0.07}, "diameter = 0.07 m: must lie between 0 and the pitch diameter"),
        ({"contact_angle": 1.2}, "contact angle = 1.2 rad"),
        ({"length": -1.0}, "length = -1 m: must not be negative"),
    ],
)
def test_impossible_elements_are_refused(change: dict[str, float], message: str) -> None:
    with pytest.raises(BearingError, match=re.escape(message)):
        replace(RollingElements(count=9, diameter=0.012, pitch_diameter=0.06), **change)
