import math

import pytest

from rigdesign.rexs.attribute_log import UNITS, RexsUnitError, rexs_unit, to_si


@pytest.mark.parametrize(
    ("number", "unit", "si"),
    [
        (82.46, "mm", 0.08246),
        (0.35, "mum", 0.35e-6),
        (20.0, "deg", math.radians(20.0)),
        (20.0, "°", math.radians(20.0)),
        (90.0, "C", 363.15),
        (90.0, "K", 90.0),
        (11.5, "1e-6 / C", 11.5e-6),
        (2250.0, "1 / min", 235.61944901923448),
        (95.0, "mm^2 / s", 95e-6),
        (0.885, "kg / dm^3", 885.0),
        (206000.0, "N / mm^2", 206e9),
        (206000.0, "MPa", 206e9),
        (60.5, "kN", 60500.0),
        (4e8, "N mm / rad", 4e5),
        (60.0, "%", 0.6),
        (7.0, "none", 7.0),
        (20.0, "N / (mm mum)", 20e9),
        (8400.0, "h", 8400.0 * 3600.0),
        (6.0, "l / min", 1e-4),
        (1.0, "1e-6 mm^3 / (N m)", 1e-15),
        (1.0, "K (m / s)^0.75 mm^1.75 / W", 10.0 ** (-3 * 1.75)),
    ],
)
def test_a_number_in_si(number: float, unit: str, si: float) -> None:
    assert to_si(number, unit, unit if unit in UNITS else "deg") == pytest.approx(si, rel=2e-15)


@pytest.mark.parametrize(
    ("spelled", "unit"),
    [
        ("N/mm²", "N / mm^2"), ("µm", "mum"), ("μm", "mum"), ("°C", "C"), ("kg/dm³", "kg / dm^3"), ("-", "none"),
        ("1/min", "1 / min"), ("N·mm/rad", "N mm / rad"), ("W/(m*K)", "W / (m K)"), ("°", "deg"),
    ],
)  # fmt: skip
def test_spellings_that_differ_from_the_database(spelled: str, unit: str) -> None:
    assert rexs_unit(spelled) == UNITS[unit]


def test_letters_that_differ_by_case_stay_apart() -> None:
    assert rexs_unit("MPa") != rexs_unit("mPa s")
    with pytest.raises(RexsUnitError):
        rexs_unit("MM")


@pytest.mark.parametrize("unit", [None, ""])
def test_no_unit_is_that_of_the_database(unit: str | None) -> None:
    assert to_si(4.5, unit, "mm") == 0.0045
    assert to_si(60.0, unit, "%") == 0.6


@pytest.mark.parametrize("unit", ["none", "deg", "mum mum", "x" * 10_000, "K"])
def test_a_unit_of_another_quantity_is_refused(unit: str) -> None:
    with pytest.raises(RexsUnitError):
        to_si(4.5, unit, "mm")


def test_every_unit_turns_one_into_a_number_above_zero() -> None:
    assert all(to_si(1.0, name, name) > 0.0 for name in UNITS)
