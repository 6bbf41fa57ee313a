"""Case files as a plain tree in SI units, read without the checker.

``{ value = "5 l/min", source = "..." }`` becomes 8.33e-5, ``"140 degC"`` 413.15, ``"12000 rpm"`` 1256.6 (rad/s).
What only says where a number comes from (source, assumed, range, title) is left out.
"""

import math
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

TURN = 2.0 * math.pi
UNITS: Mapping[str, float] = {
    "m": 1.0, "mm": 1e-3, "um": 1e-6, "kg": 1.0, "g": 1e-3, "s": 1.0, "ms": 1e-3, "min": 60.0, "h": 3600.0,
    "N": 1.0, "kN": 1e3, "W": 1.0, "kW": 1e3, "J": 1.0, "kJ": 1e3, "Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9,
    "bar": 1e5, "K": 1.0, "rad": 1.0, "mrad": 1e-3, "deg": math.pi / 180.0, "l": 1e-3, "Hz": 1.0, "kHz": 1e3,
    "cSt": 1e-6, "ppm": 1e-6, "%": 1e-2, "g_n": 9.80665, "1": 1.0,
}  # fmt: skip
REMARKS = frozenset({"source", "assumed", "range", "title"})
_QUANTITY = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s+(\S.*?)\s*\Z")
_FACTOR = re.compile(r"([A-Za-z_%]+|1)\^?(-?\d*)\Z")


class CaseError(ValueError):
    """A case file this reader cannot follow."""


def unit_value(unit: str) -> float:
    """Worth of a unit in SI: ``"l/min"``, ``"W/(m2 K)"``, ``"N m s/rad"``; rpm counts turns. KeyError: unknown."""
    plain = unit.strip().replace("·", " ").replace("*", " ").replace("°", "deg").replace("µ", "u")
    if plain in ("rpm", "1/min", "min-1"):
        return TURN / 60.0
    over, _, under = plain.partition("/")
    return _product(over) / _product(under.strip().removeprefix("(").removesuffix(")"))


def quantity(text: str) -> float:
    """SI value of ``"5 l/min"``; degC and degF are temperatures [K]. KeyError or ValueError: no quantity."""
    match = _QUANTITY.match(text)
    if match is None:
        raise ValueError(f"{text!r} is no number with a unit")
    number, unit = float(match.group(1)), match.group(2)
    if unit in ("degC", "°C"):
        return number + 273.15
    return number * unit_value(unit)


def read_case(path: str | Path) -> dict[str, Any]:
    """Tree of a case file (``extends`` and ``remove`` followed), leaves in SI units."""
    return plain_tree(_raw(Path(path)))


def plain_tree(node: Any) -> Any:
    """The same tree without remarks, quantities in SI units."""
    if isinstance(node, Mapping):
        if "value" in node and set(node) <= {"value", *REMARKS}:
            return plain_tree(node["value"])
        return {key: plain_tree(value) for key, value in node.items() if key not in REMARKS or key == "title"}
    if isinstance(node, list):
        return [plain_tree(item) for item in node]
    if isinstance(node, str):
        try:
            return quantity(node)
        except (KeyError, ValueError):
            return node
    return node


def value_at(tree: Mapping[str, Any], path: str, default: Any = None) -> Any:
    """Value by dotted path, ``"gearboxes.test.oil.flow"``; ``default`` where a step is missing."""
    node: Any = tree
    for step in path.split("."):
        if not isinstance(node, Mapping) or step not in node:
            return default
        node = node[step]
    return node


def _product(text: str) -> float:
    value = 1.0
    for factor in text.split():
        match = _FACTOR.match(factor)
        if match is None or match.group(1) not in UNITS:
            raise KeyError(factor)
        value *= UNITS[match.group(1)] ** int(match.group(2) or 1)
    return value


def _raw(path: Path, above: tuple[Path, ...] = ()) -> dict[str, Any]:
    if path in above:
        raise CaseError(f"{path}: extends itself")
    with path.open("rb") as file:
        tree = tomllib.load(file)
    if "extends" not in tree:
        return tree
    base = _raw((path.parent / tree.pop("extends")).resolve(), (*above, path))
    return _merged(base, tree)


def _merged(base: dict[str, Any], change: Mapping[str, Any]) -> dict[str, Any]:
    removed = change.get("remove", ())
    merged = {key: value for key, value in base.items() if key not in removed}
    for key, value in change.items():
        if key == "remove":
            continue
        both = isinstance(value, Mapping) and isinstance(merged.get(key), Mapping)
        if both and "value" not in value:
            merged[key] = _merged(merged[key], value)
        else:
            merged[key] = value
    return merged
