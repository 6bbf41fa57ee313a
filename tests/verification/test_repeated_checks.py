"""A process that checks one case after the other does not grow without end."""

import subprocess
import sys

import pytest

from tests.builders.paths import CASES, ROOT

CHECKS = """
import ctypes, gc, os, sys
os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})  # no copies, whose memory goes with them
from rigdesign import load_case, run_case

def resident():
    gc.collect()
    ctypes.CDLL(None).malloc_trim(0)
    [line] = [line for line in open("/proc/self/status") if line.startswith("VmRSS")]
    return int(line.split()[1]) / 1024

case = load_case(sys.argv[1])
for number in range(4):
    changed = {"gearboxes.test.gears.pinion.flank.profile_crowning": f"{8 + number} um", "numerics.curve_speeds": 10}
    run_case(case.with_values(changed), "quick")
    print(resident())
"""


@pytest.mark.whole_run
@pytest.mark.skipif(sys.platform != "linux", reason="memory as Linux tells it")
def test_memory_of_checks_in_one_process_comes_to_a_stop() -> None:
    """Before, contact tables were kept by their number: 105 MB more with every check, up to 1.3 GB."""
    done = subprocess.run(
        [sys.executable, "-c", CHECKS, str(CASES / "loop_1to1")], cwd=ROOT, capture_output=True, text=True, check=True
    )  # fmt: skip
    _, second, _, fourth = map(float, done.stdout.split())
    assert fourth < 700.0 and fourth - second < 40.0
