"""Commands called as the entry point does, and a case that runs in a second."""

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from rigdesign.cli import exit_status as ending
from rigdesign.cli import main as cli
from tests.builders.paths import CASES
from tests.builders.shared_runs import run_cache

PROTOTYPE = CASES / "uhcf_prototype"


SMALL = f"""
extends = "{(PROTOTYPE / "given_losses.toml").as_posix()}"
name = "small"
title = "small"
test_plan.time = "1000 h"
[gearboxes.test]
remove = ["housing"]
[limits]
remove = ["clearances", "alignment", "dynamics", "specimen", "strength", "flanks", "bought_parts"]
[limits.temperatures]
remove = ["housing_maximum", "bearing_film_maximum", "oil_outlet_maximum", "tempering_distance_minimum"]
[limits.bearing]
remove = ["film_thickness_minimum"]
[limits.ramp]
remove = ["transition_speed"]
[limits.oil]
remove = ["cooler_power_maximum", "heater_power_maximum", "room_heat_maximum"]
"""


@dataclass(frozen=True)
class Ended:
    """What a command left behind."""

    status: int
    out: str
    err: str


Rigdesign = Callable[..., Ended]


Write = Callable[[str], Path]


@pytest.fixture
def rigdesign(
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> Rigdesign:
    """Call a command as the entry point does, but in this process and with a cache folder of the test run."""
    if "RIGDESIGN_CACHE_DIR" not in os.environ:
        monkeypatch.setenv("RIGDESIGN_CACHE_DIR", str(run_cache()))

    def call(*arguments: object) -> Ended:
        tokens = [str(argument) for argument in arguments]
        status = ending.exit_status(lambda: cli.run(tokens))
        return Ended(status, *capsys.readouterr())

    return call


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """A case file in a folder of its own."""

    def to_file(text: str) -> Path:
        folder = tmp_path / "case"
        folder.mkdir(exist_ok=True)
        (folder / "case.toml").write_text(text, encoding="utf-8")
        return folder

    return to_file
