"""`rigdesign study` and `rigdesign.study` with their options, on a real case that runs in a second."""

from pathlib import Path

import pytest

from rigdesign import api, load_case
from rigdesign.studies.design import StudyDesign
from rigdesign.studies.run import Execution
from tests.builders.commands import PROTOTYPE, SMALL, Rigdesign, Write

INLET = "gearboxes.test.oil.inlet_temperature"


@pytest.mark.whole_run
@pytest.mark.slow
def test_two_shards_of_a_sampled_study_equal_one_run_to_the_byte(
    rigdesign: Rigdesign, write: Write, tmp_path: Path
) -> None:
    case = write(SMALL)
    design = (
        "--vary",
        f"{INLET}=90:120 degC",
        "--vary",
        "assumed",
        "--sample",
        "lhs:2",
        "--fidelity",
        "quick",
    )
    for number in (1, 2):
        ended = rigdesign(
            "study", case, *design, "--out", tmp_path / "shards", "--shard", f"{number}/2", "--workers", 1,
            "--table", "parquet", "--table", "xlsx",
        )  # fmt: skip
        assert ended.status == 0
        assert ("1 left to other shards" in ended.err) == (number == 1)
    one = api.study(
        load_case(case),
        StudyDesign(vary=(f"{INLET}=90:120 degC", "assumed"), sample="lhs:2"),
        tmp_path / "one",
        fidelity="quick",
        execution=Execution(workers=2),
        tables=["parquet"],
    )
    assert one.failed == [] and one.result.all_hold.samples == 2
    for name in ("results.csv", "study.html", "results.parquet"):
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "shards" / name).read_bytes()
    assert (tmp_path / "shards" / "results.xlsx").exists()


@pytest.mark.parametrize(
    ("options", "named"),
    [
        (("--vary", f"{INLET}=90:120 degC"), "a grid needs a step as well"),
        (("--vary", f"{INLET}=90:120 degC", "--sample", "sobol:100"), "sobol:64 or sobol:128"),
        (("--vary", "gearboxes.test.oil.oil=1:5", "--tornado"), "holds a name or a choice"),
        (("--vary", f"{INLET}=90:120 degC", "--boundary", "--shard", "1/2"), "chooses its points as it goes"),
        (("--vary", f"{INLET}=90,100", "--shard", "3/2"), "write --shard 1/4"),
        (
            ("--vary", f"{INLET}=90 degC", "--workers", "four"),
            "write --workers 4 or --workers tcp://host:8786",
        ),
        (("--vary", f"{INLET}=90 degC", "--workers", "0"), "at least 1 is needed"),
        (("--vary", f"{INLET}=90:120 degC", "--tornado", "--boundary"), "a study has one design"),
        (("--vary", f"{INLET}=90 degC", "--checks", "a,,b"), "the pattern is empty"),
        (("--vary", f"{INLET}=90 degC", "--table", "ods"), "parquet"),
    ],
)
def test_options_that_cannot_be_leave_nothing(
    options: tuple[str, ...], named: str, rigdesign: Rigdesign, tmp_path: Path
) -> None:
    ended = rigdesign("study", PROTOTYPE, *options, "--out", tmp_path / "out")
    assert ended.status == 2 and named in ended.err
    assert not (tmp_path / "out").exists()


def test_a_scheduler_that_is_not_there_ends_with_2(rigdesign: Rigdesign, tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    ended = rigdesign(
        "study",
        PROTOTYPE,
        "--vary",
        f"{INLET}=90 degC",
        "--workers",
        "tcp://127.0.0.1:9",
        "--out",
        tmp_path / "out",
    )
    assert ended.status == 2 and "no dask scheduler answers at tcp://127.0.0.1:9" in ended.err
