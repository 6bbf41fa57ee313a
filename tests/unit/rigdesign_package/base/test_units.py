"""Quantities: values against hand conversions, refusals that say what is accepted, display."""

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rigdesign.base import units
from rigdesign.base.units import KINDS

HAND = [
    ("7 mm", "length", 0.007),
    ("2 in", "length", 0.0508),
    ("5 um", "length", 5e-6),
    ("20 deg", "angle", math.pi / 9.0),
    ("140 degC", "temperature", 413.15),
    ("212 degF", "temperature", 373.15),
    ("20 K", "temperature_difference", 20.0),
    ("12000 rpm", "speed", 400.0 * math.pi),
    ("60 1/min", "speed", 2.0 * math.pi),
    ("180 N m", "torque", 180.0),
    ("0.2 kNm", "torque", 200.0),
    ("250 kW", "power", 250e3),
    ("206 GPa", "pressure", 206e9),
    ("1 N/mm2", "pressure", 1e6),
    ("733 l/min", "flow", 0.733 / 60.0),
    ("27.6 mm2/s", "kinematic_viscosity", 27.6e-6),
    ("5 mPa s", "dynamic_viscosity", 5e-3),
    ("1.9 kJ/(kg K)", "heat_capacity", 1900.0),
    ("300 W/(m2 K)", "heat_transfer_coefficient", 300.0),
    ("290e3 N m/rad", "torsional_stiffness", 290e3),
    ("0.0007 Nms/rad", "torsional_damping", 0.0007),
    ("100 N/um", "linear_stiffness", 1e8),
    ("11.5e-6 1/K", "expansion_coefficient", 11.5e-6),
    ("11.5 um/(m K)", "expansion_coefficient", 11.5e-6),
    ("191 kg cm2", "inertia", 0.0191),
    ("700 h", "time", 2.52e6),
    ("40 kHz", "frequency", 40e3),
]


@pytest.mark.parametrize(("text", "kind", "value"), HAND)
def test_value_equals_hand_conversion(text: str, kind: str, value: float) -> None:
    assert units.parse(text, kind) == pytest.approx(value, rel=1e-13)


@pytest.mark.parametrize(
    ("one", "other", "kind"),
    [
        ("5 µm", "5 um", "length"),
        ("20 °C", "20 degC", "temperature"),
        ("9 W/m²K", "9 W/(m2 K)", "heat_transfer_coefficient"),
        ("9 W/(m^2*K)", "9 W/(m2 K)", "heat_transfer_coefficient"),
        ("5 N·m", "5 N m", "torque"),
        ("5 N*m", "5Nm", "torque"),
        (" +1e1  mm ", "10 mm", "length"),
    ],
)
def test_spellings_mean_the_same(one: str, other: str, kind: str) -> None:
    assert units.parse(one, kind) == units.parse(other, kind)


@pytest.mark.parametrize("kind", KINDS)
def test_every_accepted_unit_matches_the_pattern_and_the_examples_parse(kind: str) -> None:
    expression = re.compile(units.pattern(kind))
    assert units.parse(KINDS[kind].example, kind) > 0.0
    for unit in KINDS[kind].units:
        assert expression.search(f"1.5 {unit}")
        assert units.parse(f"1.5 {unit}", kind) != 0.0
    assert not expression.search("1.5")
    assert not expression.search("1.5 furlong")


@pytest.mark.parametrize(
    ("given", "kind", "problem", "remedy"),
    [
        (7, "length", "bare number", '"7 mm"'),
        ("7", "length", "without a unit", '"7 mm"'),
        ("7 degC", "length", "one of temperature, not of length", "7 mm"),
        ("7 furlong", "length", "not known", "mm, um"),
        ("7,5 mm", "length", "decimal comma", "decimal point"),
        ("seven mm", "length", "not a number with a unit", "7 mm"),
        ("10 degC", "temperature_difference", "point on a scale", "20 K"),
        ("-300 degC", "temperature", "below absolute zero", "degC"),
        ("1e999 mm", "length", "too large", "mm"),
        (True, "length", "true/false", "mm"),
        (["7 mm"], "length", "a list", "mm"),
        ("200 kW", "torque", "one of power, not of torque", "180 N m"),
    ],
)
def test_refusal_says_what_is_wrong_and_what_is_accepted(
    given: object, kind: str, problem: str, remedy: str
) -> None:
    with pytest.raises(units.QuantityError) as caught:
        units.parse(given, kind)
    assert problem in caught.value.problem
    assert remedy in caught.value.remedy


def test_difference_and_absolute_temperature_are_different_kinds() -> None:
    assert units.parse("20 K", "temperature_difference") == 20.0
    assert units.parse("20 K", "temperature") == 20.0
    assert units.parse("20 degC", "temperature") == 293.15


def test_show_writes_number_and_unit() -> None:
    assert units.show(413.15, "temperature") == "140 degC"
    assert units.show(400.0 * math.pi, "speed") == "12000 rpm"
    assert units.show(0.007, "length") == "7 mm"
    assert units.show(0.007, "length", "um") == "7000 um"
    assert units.display(0.733 / 60.0, "flow") == pytest.approx(733.0)


@given(
    st.sampled_from(sorted(KINDS)),
    st.floats(min_value=1e-6, max_value=1e6, allow_nan=False),
    st.integers(min_value=0, max_value=10),
)
def test_display_undoes_parse(kind: str, number: float, choice: int) -> None:
    names = list(KINDS[kind].units)
    unit = names[choice % len(names)]
    assert units.display(units.parse(f"{number!r} {unit}", kind), kind, unit) == pytest.approx(
        number, rel=1e-9, abs=1e-9
    )


def test_kind_of_finds_the_kind_or_none() -> None:
    assert units.kind_of("300 N m") == "torque"
    assert units.kind_of("20 degC") == "temperature"
    assert units.kind_of("many") is None
    assert units.kind_of(7) is None
