"""Print every sourced or assumed input of a case as Markdown tables, as they stand in its README.md.

    python cases/uhcf_prototype/list_inputs.py [CASE]

Parts that share key, value and note share a row: ``gearboxes.test.gears.{pinion,wheel}.teeth``.
"""

import re
import sys
from collections.abc import Iterable, Iterator
from itertools import product, zip_longest
from pathlib import Path

from rigdesign.case import Case, load_case
from rigdesign.case.provenance import Mark

NAMED = re.compile(r"(?:(?<=gearboxes\.)|(?<=bearings\.)|(?<=gears\.)|(?<=seals\.)|(?<=shafts\.))[a-z0-9_]+")
"""Names of parts in a path."""
CASE = Path(__file__).parent / "case.toml"


def tables(case: Case) -> str:
    """Markdown: inputs printed in the paper, then those assumed."""
    printed = [mark for mark in case.origin.marks if mark.assumed is None]
    assumed = [mark for mark in case.origin.marks if mark.assumed is not None]
    return "\n".join(
        [
            "### Printed in P2",
            "",
            *_table(printed),
            "",
            "### Assumed",
            "",
            *_table(assumed),
            "",
        ]
    )


def _table(marks: list[Mark]) -> list[str]:
    groups: dict[tuple[str, str, str], list[str]] = {}
    for mark in marks:
        key = (NAMED.sub("*", mark.path), mark.shown, _note(mark))
        groups.setdefault(key, []).append(mark.path)
    rows = [
        f"| {_together(pattern, paths)} | {value} | {note} |"
        for (pattern, value, note), paths in groups.items()
    ]
    return ["| input | value | source or reason |", "|---|---|---|", *rows]


def _together(pattern: str, paths: list[str]) -> str:
    """One path with the names in braces where every combination of them is meant, else all paths."""
    names = [list(dict.fromkeys(column)) for column in zip(*(NAMED.findall(path) for path in paths))]
    filled = ["".join(_interleave(pattern.split("*"), choice)) for choice in product(*names)]
    if sorted(filled) != sorted(paths):
        return "<br>".join(f"`{path}`" for path in paths)
    braces = [found[0] if len(found) == 1 else "{" + ",".join(found) + "}" for found in names]
    return f"`{''.join(_interleave(pattern.split('*'), braces))}`"


def _interleave(parts: list[str], names: Iterable[str]) -> Iterator[str]:
    for part, name in zip_longest(parts, names, fillvalue=""):
        yield part
        yield name


def _note(mark: Mark) -> str:
    parts = [mark.source, mark.assumed]
    if mark.range is not None:
        parts.append(f"plausible {mark.range[0]} to {mark.range[1]}")
    return "; ".join(part for part in parts if part).replace("|", "\\|")


if __name__ == "__main__":
    print(tables(load_case(sys.argv[1] if len(sys.argv) > 1 else CASE)))
