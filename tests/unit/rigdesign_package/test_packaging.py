"""The three packages are one distribution, and their layers hold."""

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
