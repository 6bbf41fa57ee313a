"""The page of constants, made from the package: name, value, meaning, source, and what a user's rig replaces.

Name and value are those of the modules, the meaning is the text below a constant or a field, units and sources are in
`tests.builders.constant_sources`.
"""

import pkgutil
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from rigdesign.diagnosis.decision.defaults import Thresholds
from rigdesign.diagnosis.residual.baseline import Drift
from rigdesign.diagnosis.rig_calibration.meanings import assigned_texts, field_texts, module_tree
from rigdesign.diagnosis.statistics.amplitudes import Amplitudes
from tests.builders.constant_sources import SOURCES, Source

PACKAGE = "rigdesign.diagnosis"

RECORDS = (Amplitudes, Drift, Thresholds)
"""Records whose fields are constants of their own; numbers of the catalogue's effects are on the page of effects."""

HEAD = """# Constants of the diagnosis

Written by `python -m tests.builders.constants_page`; do not edit by hand.

Every number that a diagnosis depends on, apart from the bounds and healthy spreads of the effects
([effects.md](effects.md)) and from what a measurement states. Kinds of source: *fit* to sets of the virtual rig
(`tests/virtual_rig`, `tests/blind/README.md`), *literature*, *choice* of the method, *definition* of units and formats.
"Own rig: yes" is replaced by `rigdesign calibrate CASE HEALTHY_SET ...`, with the value here as prior; all other
numbers stay. `rigdesign calibrate` adds a shift of single channels from set to set (`channels.NAME`), zero as shipped.
"""


@dataclass(frozen=True, kw_only=True)
class Constant:
    """A row of the table; name : ``decision.defaults.DRIFT.shaft``."""

    name: str
    value: Any
    meaning: str
    source: Source | None


def constants() -> list[Constant]:
    """All constants of the package in the order of its modules, those fitted to sets first."""
    rows = [row for module in _modules() for row in _of_module(module)]
    fitted = [row for row in rows if row.source is not None and row.source.kind == "fit"]
    return [*fitted, *(row for row in rows if row not in fitted)]


def constants_page() -> str:
    """The page in Markdown.

    Raises KeyError for a constant without an entry in `tests.builders.constant_sources`.
    """
    rows = constants()
    lines = [
        HEAD,
        "| name | value | unit | meaning | source | own rig |",
        "|---|---|---|---|---|---|",
    ]
    for row in rows:
        if row.source is None:
            raise KeyError(row.name)
        cells = (
            f"`{row.name}`",
            _shown(row.value),
            row.source.unit,
            row.meaning,
            f"{row.source.kind}: {row.source.text}",
            "yes" if row.source.replaced else "no",
        )
        lines.append(f"| {' | '.join(cells)} |")
    replaced = sum(row.source is not None and row.source.replaced for row in rows)
    lines.append(f"\n{len(rows)} constants, of which healthy sets of an own rig replace {replaced}.")
    return "\n".join(lines) + "\n"


def _modules() -> Iterator[str]:
    """Names of all modules below the package."""
    package = import_module(PACKAGE)
    for found in pkgutil.walk_packages(package.__path__, f"{PACKAGE}."):
        if not found.ispkg:
            yield found.name


def _of_module(name: str) -> Iterator[Constant]:
    module, short = import_module(name), name.removeprefix(f"{PACKAGE}.")
    for constant, text in assigned_texts(module_tree(name).body).items():
        value = getattr(module, constant)
        if constant.isupper() and _numeric(value):
            yield from _rows(f"{short}.{constant}", value, text)


def _rows(name: str, value: Any, text: str) -> Iterator[Constant]:
    """One row, or one for each field of a record and each entry of a table of numbers."""
    if isinstance(value, RECORDS):
        for part, meaning in field_texts(type(value)).items():
            yield from _rows(f"{name}.{part}", getattr(value, part), meaning)
    elif isinstance(value, Mapping) and all(isinstance(one, int | float) for one in value.values()):
        for key, one in value.items():
            yield Constant(
                name=f"{name}[{key}]",
                value=one,
                meaning=f"{text} Here: {key or 'all others'}.",
                source=_source(name),
            )
    elif not isinstance(value, Mapping) or value:
        yield Constant(name=name, value=value, meaning=text, source=_source(name))


def _source(name: str) -> Source | None:
    """Of a constant, or of what it is part of."""
    while name:
        if name in SOURCES:
            return SOURCES[name]
        name = name.rpartition(".")[0]
    return None


def _numeric(value: Any) -> bool:
    """Whether a value is or holds a number; numbers of other records are those of effects."""
    if isinstance(value, bool | str):
        return False
    if isinstance(value, (int, float, *RECORDS)):
        return True
    parts = (
        value.values()
        if isinstance(value, Mapping)
        else value
        if isinstance(value, tuple | frozenset)
        else ()
    )
    return any(_numeric(part) for part in parts)


def _shown(value: Any) -> str:
    if isinstance(value, bool | str):
        return str(value)
    if isinstance(value, int | float):
        return f"{value:.6g}"
    if isinstance(value, Mapping):
        return "; ".join(f"{key}: {_shown(one)}" for key, one in value.items())
    return ", ".join(_shown(one) for one in value)


if __name__ == "__main__":
    sys.stdout.write(constants_page())
