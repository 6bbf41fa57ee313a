"""Keys that messages, reasons and advice name: every one exists in the case, the measurement or the library."""

import ast
import re
import typing
from collections.abc import Iterator, Mapping
from functools import cache

import pytest
from pydantic import BaseModel

from rigdesign.case import load_case
from rigdesign.case.model import Case
from rigdesign.case.paths import Slot, slot_of
from rigdesign.checks.registry import REGISTRY
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.measurement.quantities import CHANNELS, SETTINGS
from rigdesign.measurement.reading.measurement_set import MeasurementFile
from tests.builders.paths import ROOT

NAME = re.compile(
    r"(?<![\w./%@{-])(?:[a-z][a-z0-9]*(?:_[a-z0-9]+)+|(?:\*|[a-z_0-9]+)(?:\.(?:\*|[a-z_0-9]+))+)(?![\w/(-])"
)
"""snake_case words and dotted paths, ``*`` for what an f-string fills in."""
SYMBOL = re.compile(r"(?:[a-z]|alpha|eps|epsilon|mu|omega)_[a-z0-9_]+")
"""Symbols of formulas such as ``h_f`` and ``eps_alpha``."""
OTHER_WORDS = ("rexs", "rexs_case", "validation", "diagnosis")
"""Folders whose words are attributes of REXS, rows of papers and effects."""
COLUMNS = {
    "user_version", "journal_mode", "sqlite_master", "case_hash", "tool_version", "wf_increment", "roll_length",
    "roll_angle", "max_temperature", "not_applicable", "not_evaluated", "operating_point", "sample_rate_unit",
    "wf_start_time",
}  # fmt: skip
"""SQLite, columns of ledger, tables and files, properties of TDMS, a function of the rules, a name in a table."""


def below(slot: Slot) -> Iterator[Slot]:
    """A place, what it lists and what it holds by name."""
    yield slot
    for kind, _ in slot.choices:
        if typing.get_origin(kind) is not typing.Literal:
            for part in typing.get_args(kind):
                if part is not Ellipsis:
                    yield from below(slot_of(part))


@cache
def vocabulary(root: type[BaseModel]) -> frozenset[str]:
    """Keys of a schema, and the choices of its values."""
    words: set[str] = set()
    waiting, seen = [root], {root}
    while waiting:
        for key, field in waiting.pop().model_fields.items():
            words.add(key)
            for slot in below(slot_of(field.annotation, field.metadata)):
                for kind, _ in slot.choices:
                    if typing.get_origin(kind) is typing.Literal:
                        words |= {str(choice) for choice in typing.get_args(kind)}
                new = set(slot.models()) - seen
                seen |= new
                waiting += new
    return frozenset(words)


@cache
def known() -> frozenset[str]:
    effects = {effect.name for name in ("uhcf_prototype", "fzg") for effect in effects_of(load_case(name))}
    parts = {
        "pinion_front",
        "pinion_rear",
        "test_pinion",
        "slave_pinion",
        "gear_oil",
        "bearing_oil",
        "bearing_film",
    }
    return (
        vocabulary(Case)
        | vocabulary(MeasurementFile)
        | set(CHANNELS)
        | set(SETTINGS)
        | effects
        | parts
        | identifiers()
    )


@cache
def identifiers() -> frozenset[str]:
    """Names of public functions and of modules: what the library calls itself."""
    files = list((ROOT / "rigdesign").rglob("*.py"))
    public = {
        node.name
        for file in (
            ROOT / "rigdesign/__init__.py",
            ROOT / "rigdesign/api.py",
            ROOT / "rigdesign/results/result.py",
        )
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(node, ast.FunctionDef)
    }
    return frozenset(public | {file.stem for file in files if file.stem != "__init__"})


def texts(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Line and text of every string but docstrings; what an f-string fills in is a star."""
    silent = {
        id(node.value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    }
    within: set[int] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            within |= {id(part) for part in node.values}
            yield (
                node.lineno,
                "".join(part.value if isinstance(part, ast.Constant) else "*" for part in node.values),
            )
        elif (
            isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in silent | within
        ):
            yield node.lineno, node.value


def is_path(root: type[BaseModel], path: str) -> bool:
    """Whether a path leads to a place of a schema, whatever the parts on its way are called."""
    slots = [slot_of(root)]
    for key in path.split("."):
        found = [
            place
            for slot in slots
            for kind, _ in slot.choices
            for place in (
                [slot_of(typing.get_args(kind)[1])]
                if typing.get_origin(kind) is Mapping
                else [slot_of(typing.get_args(kind)[0])]
                if typing.get_origin(kind) is tuple
                else []
            )
        ]
        for model in (model for slot in slots for model in slot.models()):
            fields = model.model_fields
            keys = fields if key == "*" else [key] if key in fields else []
            found += [slot_of(fields[name].annotation, fields[name].metadata) for name in keys]
        if not found:
            return False
        slots = found
    return True


def exists(name: str) -> bool:
    first, dot, _ = name.partition(".")
    roots = [root for root in (Case, MeasurementFile) if dot and first in root.model_fields]
    if roots:
        return any(is_path(root, name) for root in roots)
    if any(family.key.startswith(name) for family in REGISTRY.families()):
        return True
    return all("_" not in part or part in known() for part in name.split("."))


def unknown_names(text: str) -> list[str]:
    names = (found[0] for found in NAME.finditer(text) if not SYMBOL.fullmatch(found[0]))
    return [
        name
        for name in names
        if name not in COLUMNS and not name.startswith(("rigdesign.", "thermal.")) and not exists(name)
    ]


def test_every_key_that_a_text_of_the_product_names_exists():
    missing = [
        f"{file.relative_to(ROOT)}:{line}: {name}"
        for file in sorted((ROOT / "rigdesign").rglob("*.py"))
        if file.relative_to(ROOT / "rigdesign").parts[0] not in OTHER_WORDS
        for line, text in texts(ast.parse(file.read_text(encoding="utf-8")))
        if " " in text
        for name in unknown_names(text)
    ]
    assert not missing, "\n".join(missing)


def test_advice_of_the_solvers_names_no_key_that_a_case_lacks():
    """What follows the semicolon of an error of the solvers is what a user is to do."""
    missing = []
    for package in ("thermal", "dynamics"):
        for file in sorted((ROOT / package).rglob("*.py")):
            for error in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
                if isinstance(error, ast.Raise) and error.exc is not None:
                    for line, text in texts(error.exc):
                        _, _, advice = text.partition("; ")
                        missing += [
                            f"{file.relative_to(ROOT)}:{line}: {name}" for name in unknown_names(advice)
                        ]
    assert not missing, "\n".join(missing)


@pytest.mark.parametrize(
    "text", ["raise boss_wall", "write gearboxes.*.housing.boss_wall", "lower *.chamber_length"]
)
def test_a_key_that_does_not_exist_is_found(text):
    assert unknown_names(text)
    assert not unknown_names("write gearboxes.*.housing.warm_length and h_f of torque_controlled")
