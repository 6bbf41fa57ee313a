"""Parameter studies: what is varied, the ledger, resuming after SIGKILL, failed points."""

import csv
import os
import signal
import sqlite3
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from rigdesign.base.errors import CaseError, OutputError, UsageError
from rigdesign.base.parallel import stops_held
from rigdesign.studies import ledger as study_ledger
from rigdesign.studies.grid import Variation, combinations, parse_variation
from rigdesign.studies.ledger import Ledger, point_key
from tests.builders.paths import ROOT
from tests.builders.study import (
    DRIVER,
    POINTS,
    ExampleCase,
    InProcess,
    _events,
    _stored,
    run_example,
    run_study,
)

pytestmark = pytest.mark.whole_run


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("oil.inlet=90 degC:140 degC:10 K", [f"{t} degC" for t in (90, 100, 110, 120, 130, 140)]),
        ("a=90:140:25 degC", ["90 degC", "115 degC", "140 degC"]),
        ("a = 90 degC : 100 degC : 5 degC", ["90 degC", "95 degC", "100 degC"]),
        ("a=0.1:0.3:0.1", ["0.1", "0.2", "0.3"]),
        ("a=-2:-3:-0.5 mm", ["-2 mm", "-2.5 mm", "-3 mm"]),
        ("a=1e3:3e3:1e3 rpm", ["1000 rpm", "2000 rpm", "3000 rpm"]),
        ("a=5 mm:5 mm:1 mm", ["5 mm"]),
        ("a=60,75,90 degC", ["60 degC", "75 degC", "90 degC"]),
        ("a = 0, -1.5 mm", ["0 mm", "-1.5 mm"]),
        ("a=6208,22208 E", ["6208", "22208 E"]),
        ("a=0.1,0.3", ["0.1", "0.3"]),
        ("a=MIL-PRF-23699,FVA 3", ["MIL-PRF-23699", "FVA 3"]),
        ('a="x, y",z', ["x, y", "z"]),
        ("a=../b:c", ["../b:c"]),
    ],
)
def test_variation_forms(text, values):
    assert list(parse_variation(text).values) == values


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("oil.inlet", "a value is missing"),
        ("=1,2", "a path"),
        ("a=", "a value"),
        ("a=1,,2", "empty"),
        ("a=1,1", "twice"),
        ("a=90:140", "2 numbers"),
        ("a=90:140:0", "step of 0 .*give a step other than zero"),
        ("a=90:140:-10", "step of -10 .*change the sign"),
        ("a=90:145:10 degC", "140 or 150"),
        ("a=90 degC:140 K:10 K", "same unit"),
        ("a=90 degC:140:10 degC", "same unit"),
        ("a=1 mm:2 mm:0.1 K", "same unit"),
        ("a=0:1e9:1", "at most"),
    ],
)
def test_variation_faults_say_what_is_wrong(text, named):
    with pytest.raises(UsageError, match=named):
        parse_variation(text)


def test_grid_runs_the_last_variation_fastest():
    assert combinations([Variation("a", ("1", "2")), Variation("b", ("x", "y"))]) == [
        ("1", "x"), ("1", "y"), ("2", "x"), ("2", "y"),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("variations", "named"),
    [([], "nothing"), ([Variation("a", ("1",)), Variation("a", ("2",))], "twice"),
     ([Variation(p, tuple(map(str, range(400)))) for p in "ab"], "160000")],
)  # fmt: skip
def test_grid_faults(variations, named):
    with pytest.raises(UsageError, match=named):
        combinations(variations)


def test_numbers_of_a_variation_share_one_unit():
    assert parse_variation("a=90:100:10 degC").numbers() == ([90.0, 100.0], "degC")
    assert parse_variation("a=1 mm,2 cm").numbers() is None
    assert parse_variation("a=FVA 3,FVA 3A").numbers() is None


def test_key_separates_case_and_fidelity():
    keys = {
        point_key(case, fidelity, base)
        for case in "ab"
        for fidelity in ("quick", "standard")
        for base in "ac"
    }
    assert len(keys) == 8


def test_another_version_of_the_tool_computes_a_point_again(monkeypatch):
    before = point_key("a", "quick", "a")
    monkeypatch.setattr(study_ledger, "__version__", "0.0.0.other")
    assert point_key("a", "quick", "a") != before


def test_a_stored_point_is_on_the_disk_and_not_with_the_operating_system(tmp_path, monkeypatch):
    """Power that fails just after a point: with less than EXTRA (3) a journal already removed may come back with the
    folder of before, and takes the point with it."""
    opened = []

    def connect(*arguments, **options):
        opened.append(plain(*arguments, **options))
        return opened[-1]

    plain = sqlite3.connect
    monkeypatch.setattr(study_ledger.sqlite3, "connect", connect)
    with Ledger(tmp_path / "l.sqlite") as ledger:
        ledger.store("k", fidelity="quick", case_hash="h", inputs={}, failed=False, record={})
        (level,) = opened[-1].execute("PRAGMA synchronous").fetchone()
        assert level == 3


def test_ledger_keeps_points_and_replaces_a_retried_one(tmp_path):
    with Ledger(tmp_path / "l.sqlite") as ledger:
        ledger.store("k", fidelity="quick", case_hash="h", inputs={}, failed=True, record={"error": "no"})
        ledger.store(
            "k", fidelity="quick", case_hash="h", inputs={}, failed=False, record={"verdict": "pass"}
        )
    with Ledger(tmp_path / "l.sqlite") as ledger:
        assert ledger.stored() == {"k": (False, {"verdict": "pass"})}


def test_ledger_that_cannot_be_opened_is_refused_with_a_remedy(tmp_path):
    (tmp_path / "l.sqlite").mkdir()
    with pytest.raises(OutputError, match="see that the folder can be written"):
        Ledger(tmp_path / "l.sqlite")


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """One varied input with a point that does not converge and an invalid case."""
    out = tmp_path_factory.mktemp("study")
    variations = "oil.inlet=90 degC,110 degC,120 degC,-1 degC"
    case = ExampleCase(log=str(out / "log"))
    lines = []
    outcome = run_study(
        case, variations, out, fidelity="quick", workers=2, progress=lines.append, run=run_example
    )
    return out, case, variations, outcome, lines


def test_study_table(study):
    out, _, _, outcome, lines = study
    rows = list(csv.DictReader((out / "results.csv").read_text(encoding="utf-8").splitlines()))
    assert [row["status"] for row in rows] == ["done", "done", "failed", "failed"]
    assert [row["verdict"] for row in rows[:2]] == ["pass", "fail"]
    assert [row["first_failing_check"] for row in rows[:2]] == ["", "seal_gap"]
    assert float(rows[1]["seal_gap margin [mm]"]) == pytest.approx(0.34 - 0.35)
    assert rows[0]["oil_outlet verdict"] == "pass"
    assert rows[0]["max_temperature [degC]"] == "178.6"
    assert "3 K above" in rows[2]["error"]
    assert "below 0" in rows[3]["error"]
    assert outcome.completed == 3
    assert len(outcome.failed) == 2
    assert any("110 degC: fail" in line for line in lines)


def test_study_page_and_plot(study):
    out = study[0]
    page = (out / "study.html").read_text(encoding="utf-8")
    assert "Example &lt;rig&gt;" in page
    assert "Example <rig>" not in page
    assert "distance to the limit" in page
    assert (out / "study.svg").read_text(encoding="utf-8").startswith("<?xml")
    assert not list(out.glob(".rigdesign-*"))


def test_second_run_computes_nothing_and_writes_the_same(study):
    out, case, variations, first, _ = study
    before = {name: (out / name).read_bytes() for name in ("results.csv", "study.svg", "study.html", "log")}
    again = run_study(case, variations, out, fidelity="quick", run=run_example, executor=InProcess())
    assert (again.completed, again.reused) == (0, 3)
    assert again.points == first.points
    assert before == {name: (out / name).read_bytes() for name in before}


def test_retry_computes_failed_points_only(study, tmp_path):
    out, case, variations, _, _ = study
    before = (out / "log").read_text().count("begin")
    again = run_study(
        case, variations, out, fidelity="quick", retry=True, run=run_example, executor=InProcess()
    )
    assert (again.completed, again.reused) == (1, 2)
    assert (out / "log").read_text().count("begin") == before + 1


def test_a_point_that_kills_its_worker_costs_only_itself(tmp_path):
    """The study runs in a process of its own: it must survive, and say which point took a worker with it."""
    script = tmp_path / "driver.py"
    values = "oil.inlet=90 degC,666 degC,100 degC,105 degC,110 degC"
    script.write_text(DRIVER.format(root=str(ROOT), values=values))
    subprocess.run([sys.executable, str(script), str(tmp_path / "out")], check=True, timeout=120)
    lines = (tmp_path / "out" / "results.csv").read_text().splitlines()
    assert ["failed" in line.split(",")[1] for line in lines[1:]] == [False, True, False, False, False]
    assert "process died" in (tmp_path / "out" / "study.html").read_text()


def test_two_variations_make_a_grid_in_order(tmp_path):
    variations = ["oil.inlet=90:110:20 degC", "gear.width=7 mm,8 mm"]
    outcome = run_study(
        ExampleCase(log=str(tmp_path / "log")), variations, tmp_path, run=run_example, executor=InProcess()
    )
    assert [tuple(point.values.values()) for point in outcome.points] == [
        ("90 degC", "7 mm"), ("90 degC", "8 mm"), ("110 degC", "7 mm"), ("110 degC", "8 mm"),
    ]  # fmt: skip
    assert [point.record["verdict"] for point in outcome.points] == ["pass", "pass", "fail", "fail"]


def test_unknown_path_writes_nothing(tmp_path):
    out = tmp_path / "out"
    with pytest.raises(CaseError, match="no such key"):
        run_study(ExampleCase(log=""), "oil.inlett=1,2", out, run=run_example)
    assert not out.exists()


def test_bad_calls(tmp_path):
    variations = "oil.inlet=90 degC"
    with pytest.raises(UsageError, match="workers = 0"):
        run_study(ExampleCase(log=""), variations, tmp_path, workers=0, run=run_example)
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="is a file"):
        run_study(ExampleCase(log=""), variations, tmp_path / "file", run=run_example)


def test_killed_study_resumes_without_loss_or_repetition(tmp_path):
    """SIGKILL with points stored and others under way; the resumed study equals an undisturbed one."""
    script = tmp_path / "driver.py"
    values = "oil.inlet=90:118:2 degC"
    script.write_text(DRIVER.format(root=str(ROOT), values=values))
    killed, undisturbed = tmp_path / "killed", tmp_path / "undisturbed"

    process = subprocess.Popen([sys.executable, str(script), str(killed)])
    log = tmp_path / "killed.log"
    _wait(lambda: _stored(killed) >= 3 and _events(log, "begin") > _events(log, "end"))
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    done_before = _stored(killed)
    assert 3 <= done_before < POINTS
    assert not (killed / "results.csv").exists()
    workers = {int(line.split()[1]) for line in log.read_text().splitlines()}
    _wait(lambda: not any(_alive(pid) for pid in workers))

    begun_before = _events(log, "begin")
    subprocess.run([sys.executable, str(script), str(killed)], check=True)
    case = ExampleCase(log=str(tmp_path / "undisturbed.log"))
    run_study(case, values, undisturbed, run=run_example, executor=InProcess())
    assert _events(log, "begin") - begun_before == POINTS - done_before
    for name in ("results.csv", "study.svg", "study.html"):
        assert (killed / name).read_bytes() == (undisturbed / name).read_bytes()
    assert len((killed / "results.csv").read_text().splitlines()) == POINTS + 1


def _wait(condition, seconds=60.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.02)


def _alive(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def test_interrupt_ends_the_workers_at_once(tmp_path):
    script = tmp_path / "driver.py"
    script.write_text(DRIVER.format(root=str(ROOT), values="oil.inlet=90:118:2 degC"))
    process = subprocess.Popen(
        [sys.executable, str(script), str(tmp_path / "out")],
        stderr=subprocess.DEVNULL,
        # a test run in the background of a shell ignores the interrupt, and so would its children
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    log = tmp_path / "out.log"
    _wait(lambda: _stored(tmp_path / "out") >= 1)
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=20) != 0
    _wait(lambda: not any(_alive(int(line.split()[1])) for line in log.read_text().splitlines()))
    assert 1 <= _stored(tmp_path / "out") < POINTS


def _mapped(pid):
    """Libraries a process has loaded."""
    try:
        return Path(f"/proc/{pid}/maps").read_text()
    except OSError:
        return ""


def test_an_interrupt_that_another_thread_takes_waits_until_the_workers_have_started():
    starting, reached = threading.Event(), []

    def interrupted():
        starting.wait()
        signal.pthread_kill(threading.get_ident(), signal.SIGINT)

    thread = threading.Thread(target=interrupted)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        thread.start()
        with pytest.raises(KeyboardInterrupt), stops_held():
            starting.set()
            thread.join()
            reached.append("all started")
    finally:
        signal.signal(signal.SIGINT, before)
    assert reached == ["all started"]


def test_an_interrupt_of_all_processes_while_workers_start_prints_no_traceback(tmp_path):
    """Ctrl-C reaches every process of the terminal, also one that is still importing."""
    script = tmp_path / "driver.py"
    script.write_text(DRIVER.format(root=str(ROOT), values="oil.inlet=90:118:2 degC"))
    with subprocess.Popen(
        [sys.executable, str(script), str(tmp_path / "out")],
        stderr=subprocess.PIPE, text=True, start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    ) as process:  # fmt: skip
        children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
        _wait(lambda: any("numpy" in _mapped(pid) for pid in children.read_text().split()))
        os.killpg(process.pid, signal.SIGINT)
        reported = process.stderr.read()
    assert process.returncode != 0
    assert reported.count("KeyboardInterrupt") == 1 and "spawn_main" not in reported
