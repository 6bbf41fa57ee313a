"""How numbers, units and keys read in a report."""

import math
from typing import Any

from rigdesign.results.check import Check

UNIT_SIGNS = {
    "degC": "°C", "deg": "°", "um": "µm", "N/mm2": "N/mm²", "MPa": "N/mm²", "m2": "m²",
    "l_min": "l/min", "W_m2K": "W/(m²K)", "W/m2K": "W/(m²K)", "W/(m2 K)": "W/(m²K)", "N_um": "N/µm",
    "mm2_s": "mm²/s", "kg_m3": "kg/m³", "m_s": "m/s", "Nm_deg": "Nm/°", "kgm2": "kg m²",
}  # fmt: skip
"""Unit as stored -> as printed."""

KEY_UNITS = (
    "l_min", "W_m2K", "N_um", "mm2_s", "kg_m3", "m_s", "Nm_deg", "kgm2", "degC", "deg", "mrad", "MPa", "Nm", "rpm",
    "Hz", "mm", "um", "m2", "kW", "kN", "kg", "Pa", "W", "N", "s", "K", "m",
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


def number_text(value: float | None, digits: int = 4) -> str:
    """A number with ``digits`` significant digits, large ones whole, powers of ten from 1e7; None: a dash."""
    if value is None:
        return "–"
    magnitude = abs(value)
    text = f"{value:.0f}" if 10.0 ** (digits - 1) <= magnitude < 1e7 else f"{value:.{digits}g}"
    if "e" in text:
        mantissa, exponent = text.split("e")
        power = str(int(exponent)).translate(SUPERSCRIPTS)
        return f"{mantissa} × 10{power}".replace("-", "\u2212")
    if magnitude >= 10000:
        text = f"{float(text):,.10g}".replace(",", NARROW_SPACE)
    return text.replace("-", "\u2212")


def power_text(value: float) -> str:
    """A power of ten on an axis: 10⁻³, 0.1, 1, 10."""
    power = round(math.log10(value))
    return f"{10.0**power:g}" if -2 < power < 3 else f"10{str(power).translate(SUPERSCRIPTS)}"


def unit_text(unit: str) -> str:
    """The printed form of a unit; a unit not in the table stays as it is."""
    return UNIT_SIGNS.get(unit, unit)


def quantity_text(value: float | None, unit: str) -> str:
    """Number and unit; a dimensionless number has none."""
    if value is None:
        return "–"
    return number_text(value) if unit in ("", "1", "-") else f"{number_text(value)} {unit_text(unit)}"


def limit_text(check: Check) -> str:
    """The limit with its comparison sign, or both ends of a window."""
    if check.limit is None:
        return "–"
    if check.comparison == "within" and check.upper_limit is not None:
        return f"{number_text(check.limit)} … {quantity_text(check.upper_limit, check.unit)}"
    sign = {"<=": "≤", ">=": "≥", "within": "within"}[check.comparison]
    return f"{sign} {quantity_text(check.limit, check.unit)}"


def margin_text(check: Check) -> str:
    """The distance to the limit; between two temperatures it is in kelvin."""
    return quantity_text(check.margin, margin_unit(check.unit))


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


HEADINGS = {"open": "imbalance"}
"""Keys that read otherwise in a heading."""
WORDS = {"growth": "expansion", "cold": "as drawn", "hot": "warm"}
"""Words of keys that read otherwise in a heading."""


def heading_text(key: str) -> str:
    """Column heading of a key, unit in square brackets."""
    words, unit = split_key(key)
    words = HEADINGS.get(words, " ".join(WORDS.get(word, word) for word in words.split()))
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
