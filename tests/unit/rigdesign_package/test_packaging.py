"""The three packages are one distribution, and their layers hold."""

import ast
import importlib
from pathlib import Path

import dynamics
import rigdesign
import thermal
from tests.builders.paths import ROOT


def test_three_packages_share_one_parent_folder() -> None:
    parents = {Path(package.__file__ or "").parent.parent for package in (rigdesign, thermal, dynamics)}
    assert len(parents) == 1


def test_no_test_folder_shadows_a_package() -> None:
    tests = ROOT / "tests"
    names = {path.name for path in tests.rglob("*") if path.is_dir()}
    assert not names & {"rigdesign", "thermal", "dynamics"}


def test_every_package_ships_its_types() -> None:
    for package in (rigdesign, thermal, dynamics):
        assert (Path(package.__file__ or "").parent / "py.typed").exists()


def test_scripts_beside_the_cases_import_what_there_is() -> None:
    """They are run by hand: a module that has moved would be missed when somebody needs them."""
    for script in sorted((ROOT / "cases").glob("*/*.py")):
        for node in ast.walk(ast.parse(script.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module:
                module = importlib.import_module(node.module)
                missing = [alias.name for alias in node.names if not hasattr(module, alias.name)]
                assert missing == [], (script, node.module)
