"""``uplift`` as a process of its own."""

from __future__ import annotations

import json
import subprocess
import sys


def test_a_closed_pipe_is_no_error():
    command = f"{sys.executable} -m uplift_cli query '#cc3319' --format json | head -c 5"
    out = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=True)
    assert out.stdout == '{"rgb'
    assert out.stderr == ""


def test_it_runs_as_a_module():
    out = subprocess.run(
        [sys.executable, "-m", "uplift_cli", "query", "0", "0", "0", "--format", "json"],
        capture_output=True,
        check=True,
    )
    assert json.loads(out.stdout)["rgb"] == [0, 0, 0]
