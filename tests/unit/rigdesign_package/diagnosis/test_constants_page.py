"""The table of constants: all of them, none without meaning and source, and as the modules have them."""

import ast
from pathlib import Path

import rigdesign.diagnosis
from rigdesign.diagnosis.decision.defaults import AMPLITUDES, DEFAULT, DRIFT
from rigdesign.diagnosis.rig_calibration.estimate import with_values
from tests.builders.constant_sources import SOURCES
from tests.builders.constants_page import constants, constants_page
from tests.builders.paths import CASES

PACKAGE = Path(rigdesign.diagnosis.__file__).parent

NUMBERS_OF_EFFECTS = {"LOSSES"}
"""Tables of the catalogue: on the page of effects."""


def test_the_page_is_that_of_the_modules() -> None:
    written = (CASES / "diagnosis_constants.md").read_text(encoding="utf-8")
    assert written == constants_page(), (
        "python -m tests.builders.constants_page > cases/diagnosis_constants.md"
    )


def numeric(value: ast.expr) -> bool:
    """Whether a constant is written with numbers alone, in a tuple or as the values of a table."""
    match value:
        case ast.Constant(value=number):
            return isinstance(number, int | float) and not isinstance(number, bool)
        case ast.UnaryOp(operand=operand):
            return numeric(operand)
        case ast.BinOp(left=left, right=right):
            return numeric(left) or numeric(right)
        case ast.Tuple(elts=parts) | ast.List(elts=parts):
            return any(numeric(part) for part in parts)
        case ast.Dict(values=parts):
            return any(numeric(part) for part in parts)
    return False


def written_constants() -> set[str]:
    """Upper-case constants with numbers in the text of all modules, found without importing them."""
    found = set()
    for file in PACKAGE.rglob("*.py"):
        module = ".".join(file.relative_to(PACKAGE).with_suffix("").parts)
        for statement in ast.parse(file.read_text(encoding="utf-8")).body:
            match statement:
                case ast.Assign(targets=[ast.Name(id=name)], value=value):
                    pass
                case ast.AnnAssign(target=ast.Name(id=name), value=ast.expr() as value):
                    pass
                case ast.Assign(targets=[ast.Tuple(elts=names)]):
                    assert not any(isinstance(one, ast.Name) and one.id.isupper() for one in names), (
                        f"{module}: one constant a line, with its meaning below"
                    )
                    continue
                case _:
                    continue
            if name.isupper() and numeric(value):
                found.add(f"{module}.{name}")
    return found


def test_every_numeric_constant_of_the_package_is_listed() -> None:
    listed = {row.name.partition("[")[0] for row in constants()}
    missing = {
        name for name in written_constants() if name.rpartition(".")[2] not in NUMBERS_OF_EFFECTS
    } - listed
    assert not missing, f"add {sorted(missing)} to tests.builders.constant_sources and write the page anew"
    assert len(written_constants()) > 70


def test_every_constant_has_a_meaning_and_a_source_and_no_source_is_left_over() -> None:
    rows = constants()
    assert [row.name for row in rows if not row.meaning.strip()] == []
    assert [row.name for row in rows if row.source is None] == []
    names = {row.name.partition("[")[0] for row in rows}
    unused = {
        name for name in SOURCES if name not in names and not any(one.startswith(f"{name}.") for one in names)
    }
    assert unused == set()


def test_what_a_rig_replaces_is_what_its_file_may_hold() -> None:
    """Each constant marked so, and no other, can be changed by a value of calibration.json."""
    marked = {
        row.name.removeprefix("decision.defaults.")
        for row in constants()
        if row.source and row.source.replaced
    }
    amplitudes = {f"AMPLITUDES.{name}" for name in AMPLITUDES.as_dict() if name not in ("sensor", "input")}
    assert marked == amplitudes | {f"DRIFT.{name}" for name in DRIFT.scales}
    for name in marked:
        group, _, key = name.lower().partition(".")
        group = "amplitudes" if group == "amplitudes" else "drift"
        assert with_values(DEFAULT, {f"{group}.{key}": 0.7654}) != with_values(DEFAULT, {})
