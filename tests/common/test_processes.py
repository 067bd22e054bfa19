"""Workers of a killed process leave nothing behind, and no warning."""

from __future__ import annotations

import subprocess
import sys

import pytest

KILLED = """
import os, signal
from uplift.common.processes import tied_processes
if __name__ == "__main__":
    {tracker}
    with tied_processes(1) as pool:
        pool.submit(abs, -1).result()
        os.kill(os.getpid(), signal.SIGKILL)
"""
LOUD = "from multiprocessing import resource_tracker; resource_tracker.ensure_running()"


@pytest.mark.skipif(sys.platform != "linux", reason="the resource tracker of Linux")
@pytest.mark.parametrize(("tracker", "silent"), [("pass", True), (LOUD, False)])
def test_a_killed_process_leaves_no_warning(tmp_path, tracker, silent):
    """A tracker that runs already shows that the warning would be noticed."""
    script = tmp_path / "killed.py"
    script.write_text(KILLED.format(tracker=tracker), encoding="utf-8")
    run = subprocess.run([sys.executable, script], stderr=subprocess.PIPE, check=False)
    assert run.returncode < 0
    assert (not run.stderr) == silent
