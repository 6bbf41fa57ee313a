"""Files and texts that no engineer means: devices, pipes, workbooks, brackets, a page in one word."""

import os
import signal
import subprocess
import sys
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path

import pytest

from rigdesign.base.errors import CaseError, OutputError, UsageError
from rigdesign.base.files import RefusedFileError, foreign, read_regular
from rigdesign.base.output_folder import prepare_output
from rigdesign.case import load_case
from rigdesign.case.loader import changed_together
from rigdesign.cli import exit_status as ending
from rigdesign.studies.grid import parse_variation
from tests.builders.commands import PROTOTYPE, SMALL, Rigdesign, Write

LONG = 200_000
GIVEN = PROTOTYPE / "given_losses.toml"


@pytest.fixture(autouse=True)
def no_hang() -> object:
    """A reader that waits for a pipe is ended after a minute."""
    before = signal.signal(signal.SIGALRM, lambda *_: (_ for _ in ()).throw(TimeoutError("it hangs")))
    signal.alarm(60)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


# ---------------------------------------------------------------------------- files


@pytest.fixture
def device(tmp_path: Path) -> Path:
    path = tmp_path / "device"
    path.symlink_to("/dev/zero")
    return path


@pytest.fixture
def pipe(tmp_path: Path) -> Path:
    path = tmp_path / "pipe"
    os.mkfifo(path)
    return path


def message(load: Callable[[], object]) -> str:
    with pytest.raises(CaseError) as caught:
        load()
    assert caught.value.exit_code == 2
    return str(caught.value)


@pytest.mark.parametrize("what", ["device", "pipe"])
def test_a_case_that_is_a_device_or_a_pipe_is_named_as_such(
    what: str, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    target = request.getfixturevalue(what)
    assert f"is a {what}, not a regular file" in message(lambda: load_case(target))
    (tmp_path / "case.toml").symlink_to(target)
    assert f"is a {what}, not a regular file" in message(lambda: load_case(tmp_path))
    (tmp_path / "v.toml").write_text(f'extends = "{what}"\n')
    assert f"is a {what}, not a regular file" in message(lambda: load_case(tmp_path / "v.toml"))


@pytest.mark.parametrize("what", ["device", "pipe"])
def test_a_mesh_that_is_a_device_or_a_pipe_is_not_read(
    what: str, tmp_path: Path, rigdesign: Rigdesign, request: pytest.FixtureRequest
) -> None:
    request.getfixturevalue(what)
    case = tmp_path / "case.toml"
    case.write_text(f'extends = "{GIVEN}"\n[gearboxes.test.housing]\nmesh_file = "{what}"\n')
    ended = rigdesign("check", case, "--fidelity", "quick")
    assert ended.status == 2
    assert f'mesh_file = "{what}": a {what}, not a regular file' in ended.err


def test_a_case_above_the_limit_of_size_is_not_read(tmp_path: Path) -> None:
    case = tmp_path / "case.toml"
    with case.open("wb") as file:
        file.truncate(1 << 40)
    assert "above the limit of 5 MB" in message(lambda: load_case(case))
    with pytest.raises(RefusedFileError, match="a folder"):
        read_regular(tmp_path, 10)


@pytest.mark.parametrize("extends", ["a\\u0000b", "a" * 300, "loop.toml"])
def test_extends_of_an_impossible_name(extends: str, tmp_path: Path) -> None:
    (tmp_path / "loop.toml").symlink_to("loop.toml")
    (tmp_path / "case.toml").write_text(f'extends = "{extends}"\n')
    assert "extends = " in message(lambda: load_case(tmp_path))


@pytest.mark.parametrize(
    ("content", "named"),
    [
        (b"PK\x03\x04\x14\x00[Content_Types].xml xl/workbook.xml", "an Excel workbook (.xlsx)"),
        (b"PK\x03\x04\x14\x00mimetypeapplication/vnd.oasis.opendocument.spreadsheet", "spreadsheet (.ods)"),
        (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "(.xls, .doc)"),
        (b"%PDF-1.7", "a PDF document"),
    ],
)
def test_a_case_of_another_format_is_named_as_such(content: bytes, named: str, tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_bytes(content)
    reported = message(lambda: load_case(tmp_path))
    assert named in reported and "a case is a TOML text" in reported
    assert foreign(b"name = 1") is None


def test_an_output_folder_of_an_impossible_name(tmp_path: Path) -> None:
    for name in ("a" * 300, "a" * 100_000, "a\0b"):
        with pytest.raises(OutputError) as caught:
            prepare_output(tmp_path / name)
        assert len(str(caught.value)) < 1000


# ---------------------------------------------------------------------------- texts

TEXTS = {
    "a unit": '[gearboxes.test.oil]\nflow = "5 {0}"\n',
    "a key": "[gearboxes.test.oil]\n{0} = 1\n",
    "a table": "[{0}]\na = 1\n",
    "a part": "[gearboxes.test.gears.{0}]\nteeth = 3\n",
    "removed keys": 'remove = ["{0}"]\n',
    "a mark": '[gearboxes.test.oil]\nflow = {{ value = "5 l/min", assumed = "{0}" }}\n',
    "an unknown mark": '[gearboxes.test.oil]\nflow = {{ value = "5 l/min", {0} = "{0}" }}\n',
    "ends of a range": '[gearboxes.test.oil]\nflow = {{ value = "5 l/min", assumed = "a", range = ["{0}", "{0}"] }}\n',
    "a choice": '[gearboxes.test.oil]\njet_direction = "{0}"\n',
    "a reference": '[gearboxes.test.oil]\noil = "{0}"\n',
    "a law": '[gearboxes.test.housing.boundary.chamber_oil]\nlaw = "{0}"\n',
    "a surface": '[gearboxes.test.housing.boundary.chamber_oil]\nsurfaces = ["{0}"]\n',
    "a title": 'title = "{0}"\n',
}


@pytest.mark.parametrize("what", TEXTS)
def test_a_text_of_200_kB_is_not_repeated_whole(what: str, tmp_path: Path) -> None:
    case = tmp_path / "case.toml"
    case.write_text(f'extends = "{GIVEN}"\n' + TEXTS[what].format("x" * LONG))
    reported = message(lambda: load_case(case))
    assert max(map(len, reported.splitlines())) < 4000 and str(LONG)[:3] in reported


def test_blanks_of_200_kB_take_no_time(tmp_path: Path) -> None:
    """The expressions of a quantity backtrack over blanks: a square of their number."""
    case = tmp_path / "case.toml"
    blanks = " " * LONG
    case.write_text(f'extends = "{GIVEN}"\n[gearboxes.test.oil]\nflow = "5{blanks}x"\n')
    assert "too long for a number with a unit" in message(lambda: load_case(case))
    assert parse_variation(f"a=1:{blanks[:100_000]}x:3").numbers() is None
    with pytest.raises(UsageError, match="larger than field limit"):
        parse_variation(f"a=1:{blanks}x:3")


def test_long_arguments_are_not_repeated_whole(rigdesign: Rigdesign) -> None:
    word = "x" * 100_000
    for arguments in (
        ("check", word), (word,), ("check", GIVEN, f"--{word}"), ("check", GIVEN, "--fidelity", word),
        ("study", GIVEN, "--vary", f"{word}=1,2", "--out", "z"), ("study", GIVEN, "--vary", word, "--out", "z"),
        ("study", GIVEN, "--vary", f"a=1,{word},{word}", "--out", "z"), ("check", GIVEN, "--out", word),
    ):  # fmt: skip
        ended = rigdesign(*arguments)
        assert ended.status == 2
        assert len(ended.err) < 1500
    with pytest.raises(UsageError) as caught:
        parse_variation(f"{word}=1:2:0")
    assert len(str(caught.value)) < 500


TITLES = ["rig [/bold] of ours", "rig [A1] of [red]ours[/red]", "[link=x]a[/link]", "a :warning: b", "\\[a]"]


@pytest.mark.parametrize("title", TITLES)
def test_brackets_of_a_title_are_printed_as_they_are(
    title: str, rigdesign: Rigdesign, write: Write, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "400")
    case = write(SMALL.replace('title = "small"', f"title = '{title}'"))
    out = tmp_path / "[b]out[/c]"
    ended = rigdesign("check", case, "--fidelity", "quick", "--out", out)
    assert ended.status == 0
    assert f"{title}  (quick)" in ended.out
    assert f"report: {out}" in ended.out
    assert ET.parse(out / "junit.xml").getroot() is not None
    import html

    assert title in html.unescape((out / "report.html").read_text(encoding="utf-8"))


def test_control_characters_are_refused_and_spelled_out(tmp_path: Path) -> None:
    """XML holds none of them, and a terminal obeys them."""
    case = tmp_path / "case.toml"
    for text in (
        'title = "a\\u001b[31mb"\n',
        '[ambient]\ntemperature = { value = "20 degC", assumed = "\\u0007" }\n',
    ):
        case.write_text(f'extends = "{GIVEN}"\n' + text)
        reported = message(lambda: load_case(case))
        assert "holds the control character" in reported
        assert all(sign >= " " or sign == "\n" for sign in reported)


# ---------------------------------------------------------------------------- study paths and profile shifts


@pytest.mark.parametrize(
    ("vary", "named"),
    [
        ("losses.friction.law=schlenk,doleshel", 'did you mean "doleschel"?'),
        ("gearboxes.test.oil.oil=MIL-PRF-23699,MIL-PRF-2369", "no such oil"),
        ("gearboxes.test.bearings.pinion_front.locating=false,maybe", "true or false"),
        ("gearboxes.test.gears.pinion.teeth=99,many", "a whole number"),
    ],
)
def test_a_choice_that_does_not_exist_is_refused_before_the_start(
    vary: str, named: str, rigdesign: Rigdesign, tmp_path: Path
) -> None:
    ended = rigdesign("study", PROTOTYPE, "--vary", vary, "--out", tmp_path / "out")
    assert ended.status == 2
    assert vary.partition("=")[0] in ended.err and named in ended.err
    assert not (tmp_path / "out").exists()


def test_both_profile_shifts_are_accepted_where_they_agree_with_the_centre_distance() -> None:
    from rigdesign.properties.materials import MATERIALS
    from rigdesign.rig.gears import build_pairs

    case = load_case(PROTOTYPE)
    at = "gearboxes.test.gears.wheel.profile_shift"
    one = build_pairs(case, MATERIALS)["test.main"].profile_shifts
    assert one[1] == pytest.approx(-0.96105, abs=1e-5)
    for said in (round(one[1], 3), one[1] + 0.0019):
        both = build_pairs(changed_together(case, {at: said}), MATERIALS)["test.main"].profile_shifts
        assert both == one
    reported = message(lambda: changed_together(case, {at: one[1] + 0.0021}))
    assert (
        "fixes the sum of the profile shifts at -0.9610, the gears state 0 + -0.958946 = -0.9589" in reported
    )
    assert "leave wheel.profile_shift out" in reported


# ---------------------------------------------------------------------------- interrupt

STOPPED = """
import sys, signal
signal.signal(signal.SIGINT, signal.default_int_handler)
from rigdesign.cli import main as cli
sys.argv = ["rigdesign", *sys.argv[1:]]
cli.main()
"""


def test_an_interrupted_check_leaves_nothing_and_says_so(tmp_path: Path, write: Write) -> None:
    with subprocess.Popen(
        [sys.executable, "-c", STOPPED, "check", str(PROTOTYPE), "--out", str(tmp_path / "out")],
        stderr=subprocess.PIPE, text=True,
    ) as process:  # fmt: skip
        assert process.stderr is not None
        assert "building the rig" in process.stderr.readline()
        process.send_signal(signal.SIGINT)
        reported = process.stderr.read()
    assert process.returncode == 130
    assert "rigdesign: interrupted; nothing was written; the same command starts again" in reported
    assert "Traceback" not in reported
    assert not (tmp_path / "out").exists()


def test_what_an_interrupt_leaves_is_told_by_every_long_command(capsys: pytest.CaptureFixture[str]) -> None:
    def stopped() -> object:
        with ending.interrupted(ending.SIMULATIONS_KEPT):
            raise KeyboardInterrupt

    assert ending.exit_status(stopped) == 130
    assert "finished simulations are stored, the same command goes on from there" in capsys.readouterr().err
