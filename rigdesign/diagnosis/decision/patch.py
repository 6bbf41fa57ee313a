"""What a diagnosis changes in the case: a JSON Patch with provenance, and the patched case as a variant file.

The user's case is never written to: the variant extends it. Fitted values are marked as assumed, with the evidence as
the reason and the interval as the range, so that a check lists what decides on them. The patch applied to the tree of
the case (what it extends merged in, provenance included) is the tree of the variant.
"""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from rigdesign.case.model import Case
from rigdesign.case.provenance import is_marked
from rigdesign.diagnosis.catalogue.effects import Changes, Effect
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.covariance import Whitened
from rigdesign.diagnosis.statistics.evidence import NORMAL_95
from rigdesign.prediction.model import changed_case, written


@dataclass(frozen=True, kw_only=True)
class Fitted:
    """A named effect of the catalogue at its fitted size.

    values : of its parameters; ends : their intervals; tooth : for an effect of any tooth; reason : the evidence
    """

    effect: Effect
    values: tuple[float, ...]
    ends: tuple[tuple[float, float], ...] = ()
    tooth: int | None = None
    reason: str = field(default="fitted")

    def changes(self, case: Case) -> Changes:
        """What it changes in the case."""
        return self._at(case, self.values)

    def ranges(self, case: Case) -> Mapping[str, tuple[float, float]]:
        """Path -> value at both ends of the interval, for effects of one parameter and paths that hold a number."""
        if len(self.values) != 1 or len(self.ends) != 1:
            return {}
        low, middle, high = (
            self._at(case, (value,)) for value in (self.ends[0][0], self.values[0], self.ends[0][1])
        )
        ranges = {}
        for path, value in middle.items():
            trio = (low.get(path), value, high.get(path))
            if not all(isinstance(number, int | float) and not isinstance(number, bool) for number in trio):
                continue
            first, second = sorted(float(number) for number in (trio[0], trio[2]))  # type: ignore[arg-type]
            if first <= float(value) <= second and first < second:  # type: ignore[arg-type]
                ranges[path] = (first, second)
        return ranges

    def _at(self, case: Case, values: tuple[float, ...]) -> Changes:
        return self.effect.change(case, values if self.tooth is None else (*values, float(self.tooth)))


def patched_values(case: Case, fitted: Sequence[Fitted]) -> dict[str, dict[str, Any]]:
    """Path -> marked value as the file would hold it, all effects together; later ones build on earlier ones.

    Raises
    ------
    CaseError
        The case does not admit a value.
    """
    values: dict[str, dict[str, Any]] = {}
    current = case
    for estimate in fitted:
        changes, ranges = estimate.changes(current), estimate.ranges(current)
        for path, value in changes.items():
            values[path] = {"value": written(current, path, value), "assumed": estimate.reason}
            if path in ranges:
                values[path]["range"] = [written(current, path, end) for end in ranges[path]]
        current = changed_case(current, changes)
    return values


def patched_case(case: Case, fitted: Sequence[Fitted]) -> Case:
    """The case with all effects together.

    Raises
    ------
    CaseError
        The case does not admit a value.
    """
    for estimate in fitted:
        case = changed_case(case, estimate.changes(case))
    return case


def patched_title(case: Case, fitted: Sequence[Fitted]) -> str:
    """Title of the variant: that of the case with what was added."""
    return f"{case.title}, with {' and '.join(estimate.effect.title for estimate in fitted)} as diagnosed"


def case_patch(case: Case, title: str, values: Mapping[str, Mapping[str, Any]]) -> list[dict[str, Any]]:
    """JSON Patch (RFC 6902) on the tree of the case.

    Every operation says where its value comes from (``provenance``) and what stood there before (``was``, absent
    where nothing did), so that it can be taken back; a reader of JSON Patch ignores both.
    """
    tree = case.origin.tree
    operations: list[dict[str, Any]] = [
        {
            "op": "replace",
            "path": "/title",
            "value": title,
            "was": case.title,
            "provenance": "written by rigdesign",
        }
    ]
    made: set[tuple[str, ...]] = set()
    for path, value in values.items():
        keys = tuple(path.split("."))
        for depth in range(1, len(keys)):
            if keys[:depth] not in made and not _exists(tree, keys[:depth]):
                made.add(keys[:depth])
                operations.append({"op": "add", "path": _pointer(keys[:depth]), "value": {}})
        known = _exists(tree, keys)
        operation: dict[str, Any] = {
            "op": "replace" if known else "add",
            "path": _pointer(keys),
            "value": dict(value),
        }
        if known:
            operation["was"] = _at(tree, keys)
        operations.append({**operation, "provenance": "fitted"})
    return operations


def _pointer(keys: Sequence[str]) -> str:
    """JSON Pointer (RFC 6901)."""
    return "".join("/" + key.replace("~", "~0").replace("/", "~1") for key in keys)


def _at(tree: Mapping[str, Any], keys: Sequence[str]) -> Any:
    node: Any = tree
    for key in keys:
        node = node[key]
    return node


def _exists(tree: Mapping[str, Any], keys: Sequence[str]) -> bool:
    node: Any = tree
    for key in keys:
        if not isinstance(node, Mapping) or key not in node or is_marked(node):
            return False
        node = node[key]
    return True


def variant_text(case: Case, title: str, values: Mapping[str, Mapping[str, Any]], folder: Path) -> str:
    """A case file for ``folder`` that extends the case and holds the patched values, each with its reason."""
    base = os.path.relpath(case.path.resolve(), folder.resolve())
    lines = [
        "# Written by rigdesign. The case it extends is as it was.",
        "",
        f"extends = {_text(Path(base).as_posix())}",
        f"title = {_text(title)}",
        "",
    ]
    by_table: dict[str, list[str]] = {}
    for path, value in (*_mesh_files(case, folder).items(), *values.items()):
        table, _, key = path.rpartition(".")
        by_table.setdefault(table, []).append(f"{key} = {_toml(value)}")
    for table, entries in by_table.items():
        lines += [f"[{table}]", *entries, ""]
    return "\n".join(lines)


def _mesh_files(case: Case, folder: Path) -> dict[str, str]:
    """Paths of mesh and STEP files as seen from the folder of the variant: a case file counts them from its own."""
    return {
        f"gearboxes.{name}.housing.{key}": Path(
            os.path.relpath(case.path.resolve().parent / file, folder.resolve())
        ).as_posix()
        for name, box in case.gearboxes.items()
        if box.housing is not None
        for key, file in (("mesh_file", box.housing.mesh_file), ("step_file", box.housing.step_file))
        if file is not None
    }


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


CONTROL = {code: f"\\u{code:04x}" for code in (*range(0x20), 0x7F)}
"""Characters that TOML wants escaped."""


def _text(value: str) -> str:
    return '"' + value.replace("\\", "\\\\").replace('"', '\\"').translate(CONTROL) + '"'


# Constants of a case fitted to a healthy set: what the data know better than the case does.
#
# The healthy covariance says how far each constant may be off; given the residual its mean and spread follow by linear
# algebra (posterior of the linear Gaussian model). Constants that the data hardly narrow are left as they are.

NARROWED = 0.7
"""Spread after over spread before from which on a constant is left alone."""


@dataclass(frozen=True, kw_only=True)
class Constant:
    """One constant as a healthy set has it.

    coordinate, deviation : of the parameter of its effect, after; before : its healthy spread
    """

    effect: Effect
    coordinate: float
    deviation: float
    before: float

    def fitted(self, reason: str) -> Fitted:
        """As a change of the case."""
        parameter = self.effect.parameters[0]
        low, high = parameter.bounds
        half = NORMAL_95 * self.deviation
        ends = (max(self.coordinate - half, low), min(self.coordinate + half, high))
        return Fitted(
            effect=self.effect,
            values=(parameter.value(self.coordinate),),
            ends=((parameter.value(ends[0]), parameter.value(ends[1])),),
            reason=reason,
        )


@dataclass(frozen=True, kw_only=True)
class Constants:
    """Constants of a rig with their covariance (m, m) in the coordinates of their parameters."""

    entries: tuple[Constant, ...]
    covariance: Array


def constants(space: Whitened, effects: Sequence[Effect]) -> Constants:
    """Constants of one parameter that the residual of a healthy set narrows, clipped to their bounds."""
    entries: list[Constant] = []
    kept: list[Array] = []
    for effect in effects:
        places = space.covariance.own(effect.name)
        if not places or len(effect.parameters) != 1:
            continue
        spreads = np.array([space.covariance.spread(place) for place in places])
        spread = float(np.linalg.norm(spreads))
        white = space.columns[:, places] @ spreads
        deviation = float(np.sqrt(max(spread**2 - float(white @ white), 0.0)))
        if deviation >= NARROWED * spread:
            continue
        mean = float(white @ space.residual)
        entries.append(
            Constant(
                effect=effect,
                coordinate=float(np.clip(mean, *effect.parameters[0].bounds)),
                deviation=deviation,
                before=spread,
            )
        )
        kept.append(white)
    seen = np.array(kept).reshape(len(kept), -1)
    before = np.diag([entry.before**2 for entry in entries])
    return Constants(entries=tuple(entries), covariance=np.asarray(before - seen @ seen.T))
