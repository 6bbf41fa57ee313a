"""What gmsh leaves of the process it runs in."""

import signal
import subprocess
import sys

import pytest

from tests.builders.paths import ROOT

WRITES_TO_A_CLOSED_PIPE = """
import os, sys, threading
from thermal.fe.gmsh_session import gmsh_session

def mesh():
    with gmsh_session() as gmsh:
        gmsh.model.add("empty")

if sys.argv[1] == "thread":
    thread = threading.Thread(target=mesh)
    thread.start()
    thread.join()
else:
    mesh()
reading, writing = os.pipe()
os.close(reading)
try:
    os.write(writing, b"1")
except BrokenPipeError:
    print("raised")
"""


@pytest.mark.skipif(not hasattr(signal, "SIGPIPE"), reason="this system has no signal of a closed pipe")
@pytest.mark.parametrize("where", ["main", "thread"])
def test_a_closed_pipe_raises_after_a_mesh_and_does_not_end_the_process(where: str) -> None:
    """Before, a worker that died or a reader that closed ended the process without a word."""
    done = subprocess.run(
        [sys.executable, "-c", WRITES_TO_A_CLOSED_PIPE, where], cwd=ROOT, capture_output=True, text=True, check=False
    )  # fmt: skip
    assert (done.returncode, done.stdout) == (0, "raised\n"), done.stderr
