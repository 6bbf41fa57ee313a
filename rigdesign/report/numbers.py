"""How numbers, units and keys read: one style for report, junit.xml and terminal."""

import math
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from rigdesign.results.check import NOT_WITHIN, Check

if TYPE_CHECKING:
    from rigdesign.studies.difference import CheckChange
    from rigdesign.studies.stored_results import CheckValue

UNIT_SIGNS = {
    "degC": "°C", "deg": "°", "um": "µm", "N/mm2": "N/mm²", "MPa": "N/mm²", "m2": "m²", "m2/s": "m²/s",
    "l_min": "l/min", "W_m2K": "W/(m² K)", "W/m2K": "W/(m² K)", "W/(m2 K)": "W/(m² K)", "N_um": "N/µm",
    "mm2_s": "mm²/s", "mm2/s": "mm²/s", "kg_m3": "kg/m³", "kg/m3": "kg/m³", "m_s": "m/s", "Nm": "N m",
    "Nm_deg": "N m/°", "kgm2": "kg m²", "kg m2": "kg m²", "W_mK": "W/(m K)", "GPa": "GPa", "1/K": "1/K",
    "J_kgK": "J/(kg K)", "um_mK": "µm/(m K)", "kNm_rad": "kN m/rad", "m3_h": "m³/h", "m3/h": "m³/h",
}  # fmt: skip
"""Unit as stored -> as printed."""

KEY_UNITS = (
    "l_min", "W_m2K", "um_mK", "W_mK", "J_kgK", "N_um", "mm2_s", "m3_h", "kg_m3", "m_s", "kNm_rad", "Nm_deg", "kgm2",
    "degC", "deg", "mrad", "MPa", "GPa", "Nm", "rpm", "Hz", "mm", "um", "m2", "kW", "kN", "kg", "Pa", "W", "N", "s",
    "K", "m", "h",
)  # fmt: skip
"""Units that may end a key, longest first."""

NARROW_SPACE = "\u202f"
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
GREEK = {
    "alpha": "α",
    "beta": "β",
    "gamma": "γ",
    "epsilon": "ε",
    "sigma": "σ",
    "rho": "ρ",
    "mu": "µ",
    "phi": "φ",
}


UNIT_IN_TEXT = re.compile(r"(?<=\d )(?:degC|deg|um|N/mm2|MPa|W/\(m2 K\)|kg/m3|kg m2|mm2/s|m2|Nm)(?![\w/²])")
"""A unit as cases and reasons write it, behind a number."""
STATED_NUMBER = re.compile(r"[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?(?![\w.])")


def number_text(value: float | None, digits: int = 4) -> str:
    """``digits`` significant digits, powers of ten from 1e6; counts (int) stay whole up to 1e7, None is a dash."""
    if value is None:
        return "–"
    if value == 0:
        return "0"
    magnitude = abs(value)
    if magnitude < 1e7 and isinstance(value, int):
        text = str(value)
    elif 10.0 ** (digits - 1) <= magnitude < 1e4:
        text = f"{value:.0f}"
    elif 1e4 <= magnitude < 999_950:
        text = f"{float(f'{value:.{max(digits, 4)}g}'):.0f}"
    else:
        text = f"{value:.{digits}g}"
    if "e" in text:
        mantissa, exponent = text.split("e")
        power = str(int(exponent)).translate(SUPERSCRIPTS)
        return f"{mantissa} × 10{power}".replace("-", "\u2212")
    if abs(float(text)) >= 10000:
        text = f"{float(text):,.0f}".replace(",", NARROW_SPACE)
    return text.replace("-", "\u2212")


def text_with_units(text: str) -> str:
    """A sentence with its units as printed: ``140 degC`` -> ``140 °C``."""
    return re.sub(r"(?<=\d) °(?!C)", "°", UNIT_IN_TEXT.sub(lambda found: unit_text(found[0]), text))


def stated_text(text: str) -> str:
    """A value of the case as it reads: ``5.015539e-04 kg m2`` -> ``0.0005016 kg m²``, short ones as written."""
    return text_with_units(STATED_NUMBER.sub(_stated_number, text))


def _stated_number(found: re.Match[str]) -> str:
    written = found[0]
    plain = "e" not in written.lower() and len(written) <= 7
    return written.replace("-", "\u2212") if plain else number_text(float(written))


def percent_text(share: float) -> str:
    """A share in per cent: three digits above 1 %, one decimal below, nothing finer than 0.1 %."""
    percent = 100.0 * share
    if 0.0 < percent < 0.1:
        return "< 0.1 %"
    return f"{number_text(percent, 3 if abs(percent) >= 1.0 else 1)} %"


def counted(number: int, noun: str) -> str:
    """``1 point``, ``4 points``."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def power_text(value: float) -> str:
    """A power of ten on an axis: 10⁻³, 0.1, 1, 10."""
    power = round(math.log10(value))
    return f"{10.0**power:g}" if -2 < power < 3 else f"10{str(power).translate(SUPERSCRIPTS)}"


def unit_text(unit: str) -> str:
    """The printed form of a unit; a unit not in the table stays as it is."""
    return UNIT_SIGNS.get(unit, unit)


LEAST_KILOWATT = 1e4
"""Power from which it is printed in kilowatts [W]."""


def quantity_text(value: float | None, unit: str, digits: int = 4) -> str:
    """Number and unit; a dimensionless number has none, a large power stands in kilowatts."""
    return quantity_texts((value,), unit, digits)[0]


def quantity_texts(values: Sequence[float | None], unit: str, digits: int = 4) -> list[str]:
    """Numbers that are compared, all in the unit of the largest."""
    values, unit = _in_one_unit(values, unit)
    return ["–" if value is None else _with_unit(value, unit, digits) for value in values]


def change_text(before: float | None, after: float | None, unit: str) -> str:
    """Two numbers in one unit, in the least digits from three that show a difference."""
    (first, second), unit = _in_one_unit((before, after), unit)
    for digits in (3, 4, 5, 6):
        if number_text(first, digits) != number_text(second, digits):
            break
    return f"{number_text(first, digits)} → {quantity_texts((second,), unit, digits)[0]}"


def _in_one_unit(values: Sequence[float | None], unit: str) -> tuple[list[float | None], str]:
    """Powers in kilowatts where the largest is printed so."""
    largest = max((abs(value) for value in values if value is not None), default=0.0)
    if unit != "W" or largest < LEAST_KILOWATT:
        return list(values), unit
    return [None if value is None else 1e-3 * value for value in values], "kW"


def _with_unit(value: float, unit: str, digits: int) -> str:
    text = number_text(value, digits)
    if unit in ("", "1", "-"):
        return text
    return f"{text}°" if unit == "deg" else f"{text} {unit_text(unit)}"


def value_text(check: Check) -> str:
    """The value of a check, with as many digits as it takes to tell it from a limit that it is not."""
    if check.reason.startswith(NOT_WITHIN):
        return f"> {quantity_text(check.value, check.unit)}"
    limits = [limit for limit in (check.limit, check.upper_limit) if limit is not None]
    for digits in (4, 5, 6, 7):
        text = quantity_text(check.value, check.unit, digits)
        if all(text != quantity_text(limit, check.unit, digits) or limit == check.value for limit in limits):
            return text
    return text


def limit_text(check: "Check | CheckValue") -> str:
    """The limit with its comparison sign, or both ends of a window."""
    if check.limit is None:
        return "–"
    if check.comparison == "within" and check.upper_limit is not None:
        return f"{number_text(check.limit)} … {quantity_text(check.upper_limit, check.unit)}"
    sign = {"<=": "≤", ">=": "≥", "within": "within"}[check.comparison]
    return f"{sign} {quantity_text(check.limit, check.unit)}"


def limit_change_text(change: "CheckChange") -> str:
    """The limit of a check of two results, both where they differ."""
    sides = [
        limit_text(side)
        for side in (change.before, change.after)
        if side is not None and side.limit is not None
    ]
    return " → ".join(dict.fromkeys(sides)) or "–"


def margin_text(check: Check) -> str:
    """The distance to the limit; between two temperatures it is in kelvin."""
    text = quantity_text(check.margin, margin_unit(check.unit), digits=3)
    return f"< {text}" if check.reason.startswith(NOT_WITHIN) else text


def margin_unit(unit: str) -> str:
    """Unit of the difference of two values."""
    return "K" if unit == "degC" else unit


def symbol_parts(key: str) -> tuple[str, str]:
    """A printed symbol and its index: ``c_gamma_alpha`` -> (``c``, ``γα``), ``N`` -> (``N``, empty)."""
    head, *indices = (GREEK.get(part, part) for part in key.split("_"))
    return head, "".join(indices)


def split_key(key: str) -> tuple[str, str]:
    """Words and unit of a key: ``torque_cold_Nm`` -> (``torque cold``, ``Nm``), the unit may be empty."""
    for unit in KEY_UNITS:
        if key.endswith(f"_{unit}") and len(key) > len(unit) + 1:
            return key[: -len(unit) - 1].replace("_", " "), unit_text(unit)
    return key.replace("_", " "), ""


WORDS = {"growth": "expansion", "cold": "as drawn", "hot": "warm"}
"""Words of keys that read otherwise in a heading."""


def heading_text(key: str) -> str:
    """Column heading of a key, unit in square brackets."""
    words, unit = split_key(key)
    words = " ".join(WORDS.get(word, word) for word in words.split())
    return f"{words} [{unit}]" if unit else words


def cell_text(value: Any) -> str:
    """Any value of a record as it stands in a table cell."""
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int | float):
        return number_text(float(value))
    if isinstance(value, dict):
        return ", ".join(f"{heading_text(str(key))} {cell_text(item)}" for key, item in value.items())
    if isinstance(value, list | tuple):
        return ", ".join(cell_text(item) for item in value)
    return str(value)
