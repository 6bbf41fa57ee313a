"""What a diagnosis changes in the case: a JSON Patch with provenance, and the patched case as a variant file.

The user's case is never written to: the variant extends it. Fitted values are marked as assumed, with the evidence as
the reason and the interval as the range, so that a check lists what decides on them.
"""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rigdesign.case.marks import take_off
from rigdesign.case.model import Case
from rigdesign.diagnosis.effects import Changes, Effect
from rigdesign.prediction.changes import changed_case, written


@dataclass(frozen=True, kw_only=True)
class Fitted:
    """A named effect of the catalogue at its fitted size.

    coordinates : of its parameters, and the number of the tooth for one of any tooth
    """

    effect: Effect
    coordinates: tuple[float, ...]
    tooth: int | None = None

    def changes(self, case: Case) -> Changes:
        """What it changes in the case."""
        values = tuple(
            parameter.value(u) for parameter, u in zip(self.effect.parameters, self.coordinates, strict=True)
        )
        return self.effect.change(case, values if self.tooth is None else (*values, float(self.tooth)))


def case_patch(case: Case, fitted: Sequence[Fitted], reason: str) -> list[dict[str, Any]]:
    """JSON Patch (RFC 6902) on the case as a tree, one operation a value, tests of the old value left out.

    reason : provenance, kept with every value
    """
    operations = []
    plain, _, _ = take_off(dict(case.origin.tree))
    for path, value in patched_values(case, fitted).items():
        pointer = "/" + "/".join(path.split("."))
        known = _exists(plain, path.split("."))
        operations.append(
            {
                "op": "replace" if known else "add",
                "path": pointer,
                "value": value,
                "provenance": "fitted",
                "evidence": reason,
            }
        )
    return operations


def patched_values(case: Case, fitted: Sequence[Fitted]) -> dict[str, object]:
    """Path -> value as the file would hold it, all effects together; later ones build on earlier ones."""
    values: dict[str, object] = {}
    current = case
    for one in fitted:
        changes = one.changes(current)
        values |= {path: written(current, path, value) for path, value in changes.items()}
        current = changed_case(current, changes)
    return values


def _exists(tree: Mapping[str, Any], keys: Sequence[str]) -> bool:
    node: Any = tree
    for key in keys:
        if not isinstance(node, Mapping) or key not in node:
            return False
        node = node[key]
    return True


def variant_text(case: Case, values: Mapping[str, object], folder: Path, reason: str) -> str:
    """A case file for ``folder`` that extends the case and holds the patched values, each with its reason."""
    base = os.path.relpath(case.path.resolve(), folder.resolve())
    lines = [
        "# Written by rigdesign diagnose. The case it extends is as it was.",
        "",
        f"extends = {_text(Path(base).as_posix())}",
        "",
    ]
    by_table: dict[str, list[str]] = {}
    for path, value in values.items():
        table, _, key = path.rpartition(".")
        marked = f"{{ value = {_toml(value)}, assumed = {_text(reason)} }}"
        by_table.setdefault(table, []).append(f"{key} = {marked}")
    for table, entries in by_table.items():
        lines += [f"[{table}]", *entries, ""]
    return "\n".join(lines)


def _toml(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_toml(item)}" for key, item in value.items()) + " }"
    if isinstance(value, Sequence) and not isinstance(value, str):
        return "[" + ", ".join(_toml(item) for item in value) + "]"
    return _text(str(value))


def _text(value: str) -> str:
    return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
