"""A number that is none fails the run: in the loop, in the records, in a run without any output."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rigdesign import load_case
from rigdesign.base.errors import NonFiniteResultError
from rigdesign.base.json_text import require_finite
from rigdesign.cli import exit_status as ending
from rigdesign.cli import main as cli
from rigdesign.coupling import iteration as passes
from rigdesign.results.result import RunResult
from rigdesign.run import main as run_module
from rigdesign.run.main import run_case
from tests.builders.paths import CASES
from tests.builders.report import make_result

PROTOTYPE = CASES / "uhcf_prototype"
GIVEN = (
    f'extends = "{(PROTOTYPE / "given_losses.toml").as_posix()}"\nname = "small"\ntitle = "small"\n'
    '[gearboxes.test]\nremove = ["housing"]\n'
)


@pytest.fixture
def case_file(tmp_path: Path) -> Path:
    """Losses given, no housing: a run of a tenth of a second."""
    file = tmp_path / "case.toml"
    file.write_text(GIVEN, encoding="utf-8")
    return file


@pytest.mark.parametrize(
    ("record", "place"),
    [
        (make_result(losses=[replace(make_result().losses[0], power=float("nan"))]), r"losses\[0\].power = nan"),
        ({"a": [1.0, {"b": (2.0, float("-inf"))}]}, r"a\[1\].b\[1\] = -inf"),
        ({"field": np.array([[1.0, 2.0], [np.inf, 0.0]])}, r"field\[1, 0\] = inf"),
        ({"scalar": np.float32("nan")}, "scalar = nan"),
        ({"order": [complex(1.0, float("nan"))]}, r"order\[0\] = \(1\+nanj\)"),
        ({"orders": np.array([1.0 + 0.0j, complex(1.0, float("inf"))])}, r"orders\[1\] = \(1\+infj\)"),
    ],
)  # fmt: skip
def test_every_number_of_a_record_is_looked_at(record: Any, place: str) -> None:
    with pytest.raises(NonFiniteResultError, match=place):
        require_finite(record)


def test_a_sound_result_passes() -> None:
    require_finite(make_result())
    require_finite(
        {"text": "nan", "none": None, "names": ("inf",), "count": 3, "flags": np.array([True, False])}
    )


def test_a_loss_that_is_no_number_ends_the_run_at_its_place(
    case_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The fault is not the case's: it was reported as its flow or heat, with the exit status of a wrong case."""
    lost = passes.rotating_losses

    def broken(*args: Any) -> list[Any]:
        found = list(lost(*args))
        found[-1] = replace(found[-1], loss=replace(found[-1].loss, power=float("nan")))
        return found

    monkeypatch.setattr(passes, "rotating_losses", broken)
    with pytest.raises(NonFiniteResultError, match=r"stage test: [a-z_]+ loss of [a-z_.]+ = nan"):
        run_case(load_case(case_file), fidelity="quick")


def test_a_run_without_output_folder_refuses_it_too(
    case_file: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Only the writer of results.json looked at the numbers: a run that wrote nothing passed."""
    assembled = run_module._assemble

    def broken(*args: Any) -> RunResult:
        result = assembled(*args)
        return replace(result, oil=[replace(result.oil[0], outlet=float("nan")), *result.oil[1:]])

    monkeypatch.setattr(run_module, "_assemble", broken)
    command = ["check", str(case_file), "--fidelity", "quick"]
    assert ending.exit_status(lambda: cli.app(command, result_action="return_value")) == 3
    assert "oil[0].outlet = nan" in " ".join(capsys.readouterr().err.split())
