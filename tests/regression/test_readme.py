"""What the README says is true: its script runs, its package line is the one the doctor prints."""

import re
import runpy
from pathlib import Path

import pytest

from rigdesign.base.system import GMSH_LIBRARIES
from tests.builders.paths import ROOT

README = (ROOT / "README.md").read_text(encoding="utf-8")


def test_the_library_script_runs(capsys) -> None:
    script = re.search(r"```python\n(.*?)```", README, re.DOTALL)
    assert script is not None
    exec(compile(script[1], "README.md", "exec"), {})
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] in ("pass", "open", "fail")
    assert all(len(line.split()) > 2 for line in lines[1:])


def test_the_package_lines_hold_every_library_of_gmsh() -> None:
    lines = re.findall(r"^apt-get .*--no-install-recommends (.*?) && python3 -m venv", README, re.MULTILINE)
    assert len(lines) == 2
    assert all(set(GMSH_LIBRARIES.values()) <= set(line.split()) for line in lines)


def test_there_are_exactly_two_commands_for_a_fresh_machine() -> None:
    commands = re.findall(r"^apt-get .* && python3 -m venv .*$", README, re.MULTILINE)
    assert [("check" in command, "pytest" in command) for command in commands] == [
        (True, False),
        (False, True),
    ]


@pytest.mark.slow
def test_the_notebook_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(ROOT / "cases" / "loop_1to1" / "notebook.py"))
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("RunResult(loop_1to1, quick: ")
    assert sum(line.startswith("oil at ") for line in lines) == 2
    assert 'a number without a unit; give it a unit, e.g. "140 degC"' in lines[-1]
    assert {"dynamic_factor.png", "results.json", "report.html"} <= {
        path.name for path in (tmp_path / "out").iterdir()
    }
