"""The command line: commands, files and exit status are a contract.

The small case of these tests is the shipped one with given losses and without a housing: a check of it takes
less than a second and still goes through loader, oil, bearings, checks and report. Limits of what a rig without a
housing leaves out are removed: they would warn.
"""

import builtins
import csv
import ctypes
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from threadpoolctl import threadpool_info

from rigdesign.base.parallel import BLAS_THREADS
from rigdesign.base.system import APT_LINE
from rigdesign.cli import main as cli
from rigdesign.cli.exit_status import exit_status
from tests.builders.commands import PROTOTYPE, SMALL, Rigdesign, Write
from tests.builders.schema import complaints

WARNING = SMALL.replace("[limits.oil]", '[limits.oil]\nflow_maximum = "27 l/min"')
FAILING = SMALL.replace('remove = ["cooler_power_maximum", ', 'cooler_power_maximum = "1 kW"\nremove = [')
SHORT_RAMP = f"""
extends = "{(PROTOTYPE / "case.toml").as_posix()}"
name = "weak"
title = "weak motor"
[drivetrain.motor]
torque_limit = "4 N m"
[numerics]
curve_speeds = 2
curve_speed_start = "11000 rpm"
[schedule]
remove = ["stages"]
[[schedule.stages]]
name = "bracing"
kind = "load"
torque = "10 N m"
duration = "20 ms"
[[schedule.stages]]
name = "slow"
kind = "run_up"
speed = "750 rpm"
duration = "40 ms"
[[schedule.stages]]
name = "half"
kind = "load"
torque_share = 0.5
duration = "20 ms"
[[schedule.stages]]
name = "run_up"
kind = "run_up"
speed = "12000 rpm"
duration = "100 ms"
[[schedule.stages]]
name = "full"
kind = "load"
torque_share = 1.0
duration = "20 ms"
[[schedule.stages]]
name = "test"
kind = "dwell"
duration = "20 ms"
held = true
[gearboxes.test]
remove = ["housing"]
"""


# ---------------------------------------------------------------------------- help


COMMANDS = (
    "check", "report", "study", "compare", "diagnose", "calibrate", "diff", "validate", "explain", "list", "new",
    "import", "mesh", "schema", "doctor", "completion",
)  # fmt: skip


def help_text(*command: str) -> str:
    called = "from rigdesign.cli.main import main; main()"
    result = subprocess.run(
        [sys.executable, "-c", called, *command, "--help"],
        capture_output=True, text=True, check=True, env=os.environ | {"COLUMNS": "100", "NO_COLOR": "1"},
    )  # fmt: skip
    return result.stdout


def test_help_lists_the_commands_that_exist() -> None:
    words = [line.strip("│ ").split(" ")[0] for line in help_text().splitlines() if line.startswith("│")]
    commands = [word for word in words if word and word[0] != "-" and word.islower()]
    listed = {name for name in cli.app if not name.startswith("-")}
    assert listed == set(COMMANDS) <= set(commands)
    assert all(f" {name}" in cli.__doc__ for name in COMMANDS)


needs_posix = pytest.mark.skipif(sys.platform == "win32", reason="signals and limits of POSIX")


def test_help_of_check_lists_its_options() -> None:
    text = help_text("check")
    options = ("--out", "--fidelity", "--transient", "--ranges", "--checks", "--all", "--json", "--fail-on")
    assert all(option in text for option in (*options, "--verbose", "--quiet"))


def test_help_of_study_says_how_all_gearboxes_are_varied() -> None:
    assert "gearboxes.*." in help_text("study") and "any name" in " ".join(
        help_text("study").replace("│", "").split()
    )


HELP = (
    "import sys, time, contextlib, io\n"
    "from rigdesign.cli import main as cli\n"
    "sys.argv = ['rigdesign', '--help']\n"
    "with contextlib.redirect_stdout(io.StringIO()), contextlib.suppress(SystemExit):\n"
    "    cli.main()\n"
    "heavy = ('numpy', 'scipy', 'numba', 'gmsh', 'CoolProp', 'matplotlib', 'pint', 'pydantic', 'ht', 'meshio')\n"
    "print(time.process_time(), *[name for name in heavy if name in sys.modules])\n"
)


def help_run() -> list[str]:
    """Seconds of processor time of `rigdesign --help`, then the heavy libraries it imported."""
    return subprocess.run(
        [sys.executable, "-c", HELP], capture_output=True, text=True, check=True
    ).stdout.split()


def test_help_loads_nothing_heavy() -> None:
    assert help_run()[1:] == []


def test_a_case_error_loads_no_solver(write: Write) -> None:
    """A fault is said within a second and a half: before solvers, mesher and compiled kernels are imported."""
    case = write(SMALL.replace('"1000 h"', '"1000 kg"'))
    code = (
        "import sys\nfrom rigdesign.cli import main as cli\n"
        f"sys.argv = ['rigdesign', 'check', {str(case)!r}]\n"
        "try:\n    cli.main()\nexcept SystemExit as end:\n    print(end.code)\n"
        "print(*[name for name in ('numba', 'skfem', 'gmsh', 'CoolProp', 'matplotlib') if name in sys.modules])\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["2"], done.stderr


@pytest.mark.parametrize("command", [("explain", str(PROTOTYPE)), ("list", "limits")])
def test_what_is_said_without_solving_loads_no_solver(command: tuple[str, ...]) -> None:
    """The list of checks is declared apart from the solved rig that their values are read from."""
    code = (
        "import sys\nfrom rigdesign.cli import main as cli\n"
        f"sys.argv = ['rigdesign', *{command!r}]\n"
        "try:\n    cli.main()\nexcept SystemExit as end:\n    assert not end.code\n"
        "print(*[name for name in ('numba', 'skfem', 'scipy.sparse', 'scipy.optimize', 'gmsh') if name in sys.modules],"
        " file=sys.stderr)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout and not done.stderr.strip()


THREADS = (
    "import os\nfrom rigdesign.cli import main as cli\nfrom rigdesign.base.parallel import BLAS_THREADS\n"
    "cli.run = lambda _: print(*[os.environ.get(name) for name in BLAS_THREADS])\ncli.main()\n"
)


@pytest.mark.parametrize(
    ("stated", "threads"), [({}, "1 1 1 1"), ({"OMP_NUM_THREADS": "3"}, "3 None None None")]
)
def test_a_command_sets_the_threads_of_linear_algebra_itself(stated: dict[str, str], threads: str) -> None:
    others = {name: value for name, value in os.environ.items() if name not in BLAS_THREADS}
    done = subprocess.run(
        [sys.executable, "-c", THREADS], env=others | stated, capture_output=True, text=True
    )
    assert done.stdout.strip() == threads, done.stderr


MUCH = (
    "from rigdesign.cli import main as cli\nfrom rigdesign.cli.application import print_json\n"
    "from rigdesign.cli.terminal.console import new_console\n"
    "def much(_):\n    {}\n    return 1\n"
    "cli.run = much\ncli.main()\n"
)


@pytest.mark.parametrize(
    "statement", ["print_json([0] * 100_000)", "[new_console().print('x' * 1000) for _ in range(1000)]"]
)
def test_a_reader_that_closes_the_output_is_no_pass(statement: str) -> None:
    """Before, a failing check was 0 as JSON and, by rich, a passing one 1 as a table."""
    code = [sys.executable, "-c", MUCH.format(statement)]
    with subprocess.Popen(code, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None and process.stderr is not None
        process.stdout.read(1)
        process.stdout.close()
        assert process.stderr.read() == ""
    assert process.returncode == 141


@needs_posix
def test_a_command_waits_for_its_processes_where_its_parent_does_not() -> None:
    code = (
        "import signal\nfrom rigdesign.cli import main as cli\n"
        "cli.run = lambda _: print(signal.getsignal(signal.SIGCHLD) == signal.SIG_DFL)\ncli.main()\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True,
        preexec_fn=lambda: signal.signal(signal.SIGCHLD, signal.SIG_IGN),
    )  # fmt: skip
    assert done.stdout.strip() == "True"


@needs_posix
def test_too_little_memory_is_said_before_a_library_ends_the_process() -> None:
    """As `ulimit -v`: scipy, OpenBLAS and numba end in ways of their own, one of them with status 1."""
    import resource

    done = subprocess.run(
        [sys.executable, "-m", "rigdesign", "explain", "loop_1to1"], capture_output=True, text=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (280_000_000, 280_000_000)),
    )  # fmt: skip
    assert done.returncode == 4 and done.stderr.count("\n") == 1
    assert "address space of 0.28 GB (ulimit -v) is too small: the libraries take 0.6 GB" in done.stderr


def test_memory_that_is_used_up_is_no_defect_of_the_tool(capsys: pytest.CaptureFixture[str]) -> None:
    def large() -> None:
        raise MemoryError("Unable to allocate 16.1 MiB")

    assert exit_status(large) == 4
    assert (
        "is used up (MemoryError: Unable to allocate 16.1 MiB); give the process more"
        in capsys.readouterr().err
    )


def test_tests_run_with_the_threads_of_a_command() -> None:
    """The command that the README prints sets none."""
    stated = {os.environ[name] for name in BLAS_THREADS if name in os.environ}
    algebra = [library for library in threadpool_info() if library["user_api"] == "blas"]
    assert {str(library["num_threads"]) for library in algebra} <= stated


@pytest.mark.performance
def test_help_answers_at_once() -> None:
    """Printed, not failed: a busy machine says nothing about the tool."""
    print(
        f"\n--help: {min(float(help_run()[0]) for _ in range(3)):.3f} s of processor time (wanted below 0.3)"
    )


def test_wrong_call_is_a_usage_error(rigdesign: Rigdesign) -> None:
    for arguments in (
        ["check"],
        ["check", PROTOTYPE, "--fidelity", "fine"],
        ["chekc"],
        ["check", "a", "--no"],
    ):
        ended = rigdesign(*arguments)
        assert ended.status == 2
        assert ended.err.startswith("rigdesign: ") and ended.out == ""


# ---------------------------------------------------------------------------- check


def test_status_0_where_all_checks_pass(rigdesign: Rigdesign, write: Write, tmp_path: Path) -> None:
    ended = rigdesign("check", write(SMALL), "--fidelity", "quick", "--out", tmp_path / "out")
    assert ended.status == 0
    assert "verdict: pass" in ended.out
    files = {path.relative_to(tmp_path / "out").as_posix() for path in (tmp_path / "out").rglob("*.*")}
    assert {"results.json", "report.html", "junit.xml"} <= files
    assert not any(name.startswith(".rigdesign") for name in files)


def test_status_1_where_a_check_fails(rigdesign: Rigdesign, write: Write) -> None:
    ended = rigdesign("check", write(FAILING), "--fidelity", "quick")
    assert ended.status == 1
    assert "fail: power the cooler carries" in ended.out
    assert "verdict: fail" in ended.out


def test_a_check_close_to_its_limit_fails_only_on_demand(rigdesign: Rigdesign, write: Write) -> None:
    case = write(WARNING)
    assert rigdesign("check", case, "--fidelity", "quick").status == 0
    ended = rigdesign("check", case, "--fidelity", "quick", "--fail-on", "close")
    assert ended.status == 1
    assert "verdict: pass" in ended.out and "close: " in ended.out


def test_quiet_says_the_verdict_and_nothing_else(rigdesign: Rigdesign, write: Write) -> None:
    for arguments in (("check", write(FAILING), "--quiet"), ("--quiet", "check", write(FAILING))):
        ended = rigdesign(*arguments, "--fidelity", "quick")
        assert ended.status == 1 and ended.err == ""
        assert re.fullmatch(r"verdict: fail \(1 fail.*\)\n", ended.out)


def test_quiet_leaves_errors(rigdesign: Rigdesign, write: Write) -> None:
    ended = rigdesign("check", write(SMALL.replace('"1000 h"', '"1000 kg"')), "--quiet")
    assert ended.status == 2 and "test_plan.time" in ended.err and ended.out == ""


def test_verbose_says_steps_iterations_and_caches(rigdesign: Rigdesign, write: Write) -> None:
    ended = rigdesign("check", write(SMALL), "--fidelity", "quick", "--verbose")
    assert ended.status == 0
    assert re.search(r"^ +\d+\.\d\d s  building the rig$", ended.err, re.MULTILINE)
    assert re.search(r"stage test: \d+ iterations, last residuals temperature_K ", ended.err)
    assert "parts of the run: rig_and_mesh " in ended.err
    assert re.search(r"^cache .*: \d+ files before, 1 written by this command$", ended.err, re.MULTILINE)


def test_all_prints_every_note(rigdesign: Rigdesign, write: Write) -> None:
    case = write(SMALL)
    short, whole = (rigdesign("check", case, "--fidelity", "quick", *more) for more in ((), ("--all",)))
    assert "--all prints them and every" in " ".join(short.out.split()) and "note " not in short.out
    assert whole.out.count("note ") >= 1 and len(whole.out) > len(short.out)


@pytest.mark.parametrize(
    ("options", "said"),
    [(("--all", "--quiet"), "--all prints every check"), (("--verbose", "--quiet"), "exclude each other")],
)
def test_options_that_contradict_each_other(
    options: tuple[str, ...], said: str, rigdesign: Rigdesign, write: Write
) -> None:
    ended = rigdesign("check", write(SMALL), *options)
    assert (
        ended.status == 2 and said in ended.err and "leave one of them out" in ended.err and ended.out == ""
    )


def test_json_is_one_document_and_nothing_else(rigdesign: Rigdesign, write: Write, tmp_path: Path) -> None:
    ended = rigdesign("check", write(SMALL), "--fidelity", "quick", "--json", "--out", tmp_path / "out")
    document = json.loads(ended.out)
    stored = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))
    assert document["schema_version"] == stored["schema_version"]
    assert document["verdict"] == "pass" and document["case"]["name"] == "small"
    assert document["checks"] == stored["checks"]
    assert {"tool_version", "losses", "coupling", "assumptions", "warnings", "timings_s"} <= set(document)
    assert "building the rig" in ended.err


def test_status_3_where_the_loop_does_not_settle(rigdesign: Rigdesign, write: Write, tmp_path: Path) -> None:
    case = write(SMALL + "[numerics]\ncoupling_passes = 1\n")
    ended = rigdesign("check", case, "--fidelity", "quick", "--out", tmp_path / "out")
    assert ended.status == 3
    assert "did not converge in 1 iterations" in ended.err and "limits 0.05 K" in ended.err
    failure = json.loads((tmp_path / "out" / "failure.json").read_text(encoding="utf-8"))
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["failure.json"]
    assert str(tmp_path / "out" / "failure.json") in ended.err
    assert failure["history"]["stage"] == "test"
    assert [set(row) for row in failure["history"]["residuals"]] == [
        {"temperature_K", "growth_um", "torque_relative"}
    ]


def test_a_run_that_ends_well_removes_what_a_failed_one_left(
    rigdesign: Rigdesign, write: Write, tmp_path: Path
) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "failure.json").write_text("{}", encoding="utf-8")
    assert rigdesign("check", write(SMALL), "--fidelity", "quick", "--out", tmp_path / "out").status == 0
    assert not (tmp_path / "out" / "failure.json").exists()


def test_a_defect_ends_with_70_in_one_line(
    rigdesign: Rigdesign, write: Write, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Never 1, which says that a check fails; the traceback is in a file that the line names."""

    def broken(*_: object, **__: object) -> None:
        raise ValueError("operands could not be broadcast together\nwith shapes (3,) (4,)")

    monkeypatch.setattr("rigdesign.run.main.run_case", broken)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    ended = rigdesign("check", write(SMALL), "--fidelity", "quick")
    assert ended.status == 70 and ended.out == ""
    (line,) = (line for line in ended.err.splitlines() if "internal error" in line)
    (file,) = tmp_path.glob("rigdesign-defect-*.txt")
    assert str(file) in line and "could not be broadcast together with shapes" in line
    text = file.read_text(encoding="utf-8")
    assert "Traceback" in text and "in broken" in text


def test_a_weak_motor_leaves_open_what_needs_the_missed_stages(
    rigdesign: Rigdesign, write: Write, tmp_path: Path
) -> None:
    """Temperatures, ratings and responses at the held speed do not ask how the rig came there."""
    ended = rigdesign("check", write(SHORT_RAMP), "--fidelity", "quick", "--out", tmp_path / "out")
    assert ended.status == 1
    result = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))
    checks = {check["id"]: check for check in result["checks"]}
    missed = checks["dynamics.lift_off.test"]
    assert missed["verdict"] != "pass" and "stage 'slow' does not reach its speed" in missed["reason"]
    assert (
        "Torque balance: motor 4.00 N m (drivetrain.motor.torque_limit 4.00 N m), drag of" in missed["reason"]
    )
    assert "raise the limit or give the stage more time" in missed["reason"]
    assert checks["bought_part.motor"]["verdict"] != "pass"
    for judged in ("dynamics.dynamic_factor.test", "bearing.specific_load"):
        assert checks[judged]["value"] is not None


@pytest.fixture
def no_glu(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A machine without libGLU: neither the library nor gmsh can be loaded."""
    load, load_module = ctypes.CDLL, builtins.__import__

    def refuse(name: Any, *rest: Any, **more: Any) -> Any:
        if name == "libGLU.so.1":
            raise OSError("libGLU.so.1: cannot open shared object file")
        return load(name, *rest, **more)

    def without_gmsh(name: str, *rest: Any, **more: Any) -> Any:
        if name == "gmsh":
            raise OSError("libGLU.so.1: cannot open shared object file")
        return load_module(name, *rest, **more)

    monkeypatch.setattr(ctypes, "CDLL", refuse)
    monkeypatch.setattr(builtins, "__import__", without_gmsh)
    monkeypatch.delitem(sys.modules, "gmsh", raising=False)
    yield


@pytest.mark.usefixtures("no_glu")
def test_status_4_names_the_missing_library_and_the_apt_line(
    rigdesign: Rigdesign, write: Write, tmp_path: Path
) -> None:
    """A housing that no other test meshes: a mesh kept in memory would need no gmsh."""
    base = (PROTOTYPE / "case.toml").as_posix()
    case = write(f'extends = "{base}"\nname = "own"\n[gearboxes.test.housing]\nheight = "283 mm"\n')
    ended = rigdesign("check", case, "--fidelity", "quick", "--out", tmp_path / "out")
    assert ended.status == 4
    assert "libGLU.so.1 is missing" in ended.err and APT_LINE in ended.err
    assert not (tmp_path / "out").exists()


# ---------------------------------------------------------------------------- schema and doctor


def test_schema_accepts_the_shipped_case(rigdesign: Rigdesign) -> None:
    import tomllib

    ended = rigdesign("schema")
    document = json.loads(ended.out)
    assert ended.status == 0 and ended.err == ""
    assert document["$schema"].startswith("https://json-schema.org/")
    assert document["type"] == "object" and "gearboxes" in document["properties"]
    tree = tomllib.loads((PROTOTYPE / "case.toml").read_text(encoding="utf-8"))
    assert list(complaints(tree, document)) == []
    assert list(complaints(tree | {"gearbox": {}}, document)) != []


def test_doctor_finds_a_healthy_machine(rigdesign: Rigdesign) -> None:
    ended = rigdesign("doctor")
    assert ended.status == 0
    assert "missing" not in ended.out and "gmsh" in ended.out


@pytest.mark.usefixtures("no_glu")
def test_doctor_finds_what_is_missing_beforehand(rigdesign: Rigdesign) -> None:
    ended = rigdesign("doctor")
    assert ended.status == 4
    assert "libGLU.so.1 is missing" in ended.out and APT_LINE in ended.out


# ---------------------------------------------------------------------------- bad input

TEST = "[gearboxes.test]\n"
BAD_INPUT = {
    "unknown key": (
        '[gearboxes.test.oil]\ninlet_temprature = "100 degC"\n',
        ["gearboxes.test.oil.inlet_temprature", "100 degC", "unknown key", "inlet_temperature"],
    ),
    "missing unit": (
        "[gearboxes.test.gears.pinion]\nface_width = 7\n",
        ["gearboxes.test.gears.pinion.face_width = 7", "without a unit", "mm"],
    ),
    "wrong dimension": (
        '[gearboxes.test.gears.pinion]\nface_width = "7 N"\n',
        ["gearboxes.test.gears.pinion.face_width", "7 N", "length", "mm"],
    ),
    "negative width": (
        '[gearboxes.test.gears.pinion]\nface_width = "-7 mm"\n',
        ["gearboxes.test.gears.pinion.face_width", "-7 mm", "above 0"],
    ),
    "gears that cannot mesh": (
        '[gearboxes.test.meshes.main]\ncentre_distance = "90 mm"\n',
        ["gearboxes.test.meshes.main.centre_distance = 90 mm", "cannot mesh", "94.4", "near 100.5 mm"],
    ),
    "speed that rises where it should fall": (
        '[[schedule.stages]]\nname = "run_down"\nspeed = "13000 rpm"\n',
        ["schedule.stages.run_down.speed = 13000 rpm", "does not fall", "12000 rpm", "correct the value"],
    ),
    "check on a part that is not there": (
        '[limits.bought_parts.motor]\npart = "drivetrain.moter"\n',
        ["limits.bought_parts.motor.part", "drivetrain.moter", "no such part", "drivetrain.motor"],
    ),
}


@pytest.mark.parametrize("kind", list(BAD_INPUT))
def test_bad_input_names_key_value_limit_and_remedy(
    kind: str, rigdesign: Rigdesign, write: Write, tmp_path: Path
) -> None:
    text, named = BAD_INPUT[kind]
    base = f'extends = "{(PROTOTYPE / "case.toml").as_posix()}"\nname = "bad"\n'
    ended = rigdesign("check", write(base + text), "--out", tmp_path / "out")
    assert ended.status == 2
    assert ended.out == ""
    assert [words for words in named if words not in ended.err] == []
    assert not (tmp_path / "out").exists()


def test_truncated_file_leaves_nothing(rigdesign: Rigdesign, write: Write, tmp_path: Path) -> None:
    whole = (PROTOTYPE / "case.toml").read_text(encoding="utf-8")
    case = write(whole[: whole.index("[gearboxes.test.oil]") + 12])
    ended = rigdesign("check", case, "--out", tmp_path / "out")
    assert ended.status == 2
    assert "case.toml" in ended.err and "cut off" in ended.err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("below", ["", "results"])
def test_output_folder_that_cannot_be_written(
    below: str, rigdesign: Rigdesign, write: Write, tmp_path: Path
) -> None:
    """A file stands where the folder should be; it is found before anything is computed."""
    place = tmp_path / "out"
    place.write_text("mine", encoding="utf-8")
    ended = rigdesign("check", write(SMALL), "--out", place / below if below else place)
    assert ended.status == 2
    assert f"output folder {place}" in ended.err and "is a file" in ended.err and "--out" in ended.err
    assert "building the rig" not in ended.err
    assert place.read_text(encoding="utf-8") == "mine"


@pytest.mark.parametrize(
    ("vary", "named"),
    [
        (
            "gearboxes.test.oil.inlet_temprature=90 degC:140 degC:10 K",
            ["gearboxes.test.oil.inlet_temprature", "no such path", "gearboxes.test.oil.inlet_temperature"],
        ),
        ("gearboxes.test.oil.inlet_temperature", ["gearboxes.test.oil.inlet_temperature", "PATH="]),
        ("gearboxes.test.oil.inlet_temperature=90 mm,100 mm", ["inlet_temperature", "90 mm", "temperature"]),
    ],
)
def test_study_that_cannot_run_leaves_nothing(
    vary: str, named: list[str], rigdesign: Rigdesign, tmp_path: Path
) -> None:
    ended = rigdesign("study", PROTOTYPE, "--vary", vary, "--out", tmp_path / "study")
    assert ended.status == 2
    assert [words for words in named if words not in ended.err] == []
    assert not (tmp_path / "study").exists()


def test_case_that_is_not_there(rigdesign: Rigdesign, tmp_path: Path) -> None:
    ended = rigdesign("check", tmp_path / "nowhere", "--out", tmp_path / "out")
    assert ended.status == 2
    assert "nowhere" in ended.err and "no such file or folder" in ended.err
    assert not (tmp_path / "out").exists()


def test_study_of_a_small_case(rigdesign: Rigdesign, write: Write, tmp_path: Path) -> None:
    """Two points and one that cannot be: complete with status 0, the failed point kept with its error."""
    ended = rigdesign(
        "study", write(SMALL), "--fidelity", "quick", "--workers", 1, "--out", tmp_path / "study",
        "--vary", "gearboxes.test.oil.inlet_temperature=90 degC,100 degC,-400 degC",
    )  # fmt: skip
    assert ended.status == 0
    assert "2 points computed" in ended.out and "-400 degC" in ended.out
    with (tmp_path / "study" / "results.csv").open(encoding="utf-8", newline="") as table:
        rows = list(csv.DictReader(table))
    assert [bool(row["error"]) for row in rows] == [False, False, True]
    assert [row["verdict"] for row in rows[:2]] == ["pass", "pass"]


@pytest.mark.parametrize(("options", "named"), [(("--pdf",), "--pdf"), (("--author", "A. B."), "--author")])
def test_a_report_needs_a_folder(
    rigdesign: Rigdesign, write: Write, options: tuple[str, ...], named: str
) -> None:
    ended = rigdesign("check", write(SMALL), *options)
    assert ended.status == 2
    assert f"{named} needs the folder of the report; add --out DIR" in ended.err


def test_pdf_without_its_library_is_said_before_anything_is_computed(
    rigdesign: Rigdesign, write: Write, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "weasyprint", None)
    ended = rigdesign("check", write(SMALL), "--pdf", "--out", tmp_path / "out")
    assert ended.status == 4
    assert "pip install 'rigdesign[pdf]'" in ended.err
    assert not (tmp_path / "out" / "results.json").exists()


@pytest.mark.whole_run
def test_check_writes_the_report_as_pdf_with_its_author(
    rigdesign: Rigdesign, write: Write, tmp_path: Path
) -> None:
    from pypdf import PdfReader

    out = tmp_path / "out"
    ended = rigdesign(
        "check", write(SMALL), "--fidelity", "quick", "--pdf", "--author", "A. Engineer", "--out", out
    )
    assert ended.status == 0, ended.err
    assert "A. Engineer" in PdfReader(out / "report.pdf").pages[0].extract_text()
    assert "report.pdf" in json.loads((out / "results.json").read_text())["files"]


EMPTY_OUT: dict[str, tuple[str, ...]] = {
    "check": ("x",), "compare": ("x", "y"), "diagnose": ("x", "y"), "diff": ("a", "b"), "mesh": ("x",),
    "calibrate": ("x", "y", "z"),
    "new measurement": ("x",), "study": ("x", "--vary", "a=1,2"), "validate": (),
    "import": ("unit.rexs",), "report": ("x",),
}  # fmt: skip
"""Commands with ``--out``, and what else they need."""


@pytest.mark.parametrize("command", EMPTY_OUT)
@pytest.mark.parametrize("given", ["", " "])
def test_an_empty_out_is_refused_and_writes_nothing(
    command: str, given: str, rigdesign: Rigdesign, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    ended = rigdesign(*command.split(), *EMPTY_OUT[command], "--out", given)
    assert ended.status == 2 and ended.out == ""
    assert ended.err.startswith("rigdesign: --out is empty; name a folder, e.g. --out results")
    assert list(tmp_path.iterdir()) == []


def test_every_command_with_out_refuses_an_empty_one() -> None:
    names = {name for name in cli.app if not name.startswith("-")} - {"new"}
    found = {
        name
        for name in names
        if any("--out" in one.names for one in cli.app[name].assemble_argument_collection())
    }
    assert found | {"new measurement"} == set(EMPTY_OUT)
