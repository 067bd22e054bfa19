"""``uplift`` as a process of its own."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest


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


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no such device")
@pytest.mark.parametrize("style", ["table", "json", "csv"])
def test_a_full_disk_under_standard_output_is_an_error_in_a_line(style):
    command = [sys.executable, "-m", "uplift_cli", "query", "0", "0", "0", "--format", style]
    with open("/dev/full", "w") as full:
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 2
    assert done.stderr == "error: standard output cannot be written: No space left on device; make room\n"
