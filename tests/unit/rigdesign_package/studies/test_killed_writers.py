"""A run that is killed or meets a full disk: no file is half written, and the next run puts all in order."""

import resource
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from rigdesign.base.errors import OutputError
from rigdesign.report.writing import write_results
from rigdesign.studies.ledger import LEDGER_NAME
from tests.builders.killed_writer import REFUSED, WRITTEN
from tests.builders.output import attempts, held_against, published
from tests.builders.report import small_result
from tests.builders.study import VARIED, ExampleCase, InProcess, run_example, run_study

pytestmark = pytest.mark.whole_run

STEPS = (1, 2, 4, 7, 11, 14, 16, 18, 20, 21, 22, 23, 24, 26, 28, 30, 60)


@pytest.mark.parametrize("mode", ["kill", "full"])
def test_no_file_is_half_written_at_any_step(mode: str, tmp_path: Path) -> None:
    ended = attempts(mode, tmp_path, STEPS)
    whole = published(tmp_path / "whole")
    assert "results.json" in whole and "report.html" in whole
    stopped = -signal.SIGKILL if mode == "kill" else REFUSED
    assert set(ended) == {stopped, WRITTEN} and ended[-1] == WRITTEN and ended.count(stopped) >= 10
    for step, status in zip(STEPS, ended, strict=True):
        out = tmp_path / str(step)
        if mode == "full" and status == REFUSED:
            assert not list(out.glob(".rigdesign-*"))
        held_against(out, whole)


@contextmanager
def files_of_at_most(size: int) -> Iterator[None]:
    """Every write beyond ``size`` bytes of a file fails, as on a full disk."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def test_a_disk_that_fills_up_amid_a_file_leaves_nothing(tmp_path: Path) -> None:
    write_results(small_result(), tmp_path / "whole")
    whole = published(tmp_path / "whole")
    largest = max(map(len, whole.values()))
    for size in (0, 10, 1000, 4096, 20_000, largest - 1):
        out = tmp_path / str(size)
        with files_of_at_most(size), pytest.raises(OutputError, match="File too large"):
            write_results(small_result(), out)
        assert published(out) == {} and not list(out.glob(".rigdesign-*"))
    held_against(out, whole)


def test_a_study_whose_disk_fills_up_says_so_and_resumes(tmp_path: Path) -> None:
    case = ExampleCase(log=str(tmp_path / "log"))
    run_study(case, VARIED, tmp_path / "whole", run=run_example, executor=InProcess())
    largest = max(path.stat().st_size for path in (tmp_path / "whole").iterdir())
    for size in (0, 100, 5000, 13_000, largest - 1):
        out = tmp_path / str(size)
        with files_of_at_most(size), pytest.raises(OutputError):
            run_study(case, VARIED, out, run=run_example, executor=InProcess())
        assert not {"results.csv", "study.svg", "study.html"} & {path.name for path in out.iterdir()}
        run_study(case, VARIED, out, run=run_example, executor=InProcess())
        for name in ("results.csv", "study.svg", "study.html"):
            assert (out / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()
        assert {path.name for path in out.iterdir()} == {
            LEDGER_NAME,
            "results.csv",
            "study.svg",
            "study.html",
        }
