"""``uplift`` as a separate process."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest


def test_closed_pipe_is_not_an_error():
    command = f"{sys.executable} -m uplift_cli query '#cc3319' --format json | head -c 5"
    out = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=True)
    assert out.stdout == '{"rgb'
    assert out.stderr == ""


def test_package_runs_as_a_module():
    out = subprocess.run(
        [sys.executable, "-m", "uplift_cli", "query", "0", "0", "0", "--format", "json"],
        capture_output=True,
        check=True,
    )
    assert json.loads(out.stdout)["rgb"] == [0, 0, 0]


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no such device")
@pytest.mark.parametrize("style", ["table", "json", "csv"])
def test_full_disk_is_reported_on_one_line(style):
    command = [sys.executable, "-m", "uplift_cli", "query", "0", "0", "0", "--format", style]
    with open("/dev/full", "w") as full:
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 2
    if style == "json":
        assert json.loads(done.stderr)["error"]["code"] == "disk-full"
    else:
        assert done.stderr.startswith("error: standard output cannot be written: No space left on device; ")
    assert done.stderr.count("\n") == 1
