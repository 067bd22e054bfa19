"""Writers that are killed, interrupted, run or at once: the old or a complete new file remains."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import uplift
from tests.fuzz.fuzzing import ROOT
from uplift.cube import digest
from uplift.io.texture import exr_file

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="needs SIGKILL and /proc")

OLD, NEW = (ROOT / "cubes" / f"{name}.uplift" for name in ("moments-16-macbeth", "sigmoid-16-macbeth"))
SAVE_IN_TURN = """
import itertools, sys, uplift
cubes = [uplift.load(path) for path in sys.argv[2:]]
print(flush=True)
for cube in itertools.cycle(cubes):
    cube.save(sys.argv[1], force=True)
"""
SECONDS = 10.0
"""Limit of the time from a signal to the end of all processes."""


def start(words: list[str], folder: Path) -> subprocess.Popen[str]:
    """Start a command that obeys Ctrl-C, as in a terminal."""
    previous = signal.signal(signal.SIGINT, signal.default_int_handler)  # inherited
    try:
        return subprocess.Popen(
            [sys.executable, "-m", "uplift_cli", *words], cwd=folder, stderr=subprocess.PIPE, text=True
        )
    finally:
        signal.signal(signal.SIGINT, previous)


def is_running(process: str) -> bool:
    try:
        return " Z " not in Path(f"/proc/{process}/stat").read_text()
    except OSError:
        return False


@pytest.mark.parametrize("exists", [False, True])
def test_a_killed_writer_leaves_a_complete_file_or_none(tmp_path, exists):
    path, complete = tmp_path / "cube.uplift", {OLD.read_bytes(), NEW.read_bytes()}
    for turn in range(3):
        path.unlink(missing_ok=True)
        if exists:
            shutil.copy(OLD, path)
        with subprocess.Popen([sys.executable, "-c", SAVE_IN_TURN, path, OLD, NEW], stdout=subprocess.PIPE) as process:
            process.stdout.readline()
            time.sleep(0.02 * turn)
            process.kill()
        assert path.read_bytes() in complete if path.exists() else not exists
        for temporary in tmp_path.glob(".*.part"):
            os.utime(temporary, (0, 0))  # as if the process had been killed long ago
        uplift.load(NEW).save(path, force=True)
        assert os.listdir(tmp_path) == [path.name]


def test_builds_in_threads_give_equal_cubes():
    def built(dim: int) -> str:
        return digest(uplift.build(dim=dim, coefficients=5).data)

    alone = {dim: built(dim) for dim in (3, 4, 5)}
    dims = [3, 4, 5, 5, 4, 3]
    with ThreadPoolExecutor(len(dims)) as pool:
        assert list(pool.map(built, dims)) == [alone[dim] for dim in dims]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL])
def test_signals_end_textures_and_their_workers(tmp_path, number):
    random = np.random.default_rng(int(number))
    for name in ("a.png", "b.png", "c.png"):
        Image.fromarray(random.integers(0, 256, (1024, 1024, 3), np.uint8)).save(tmp_path / name, compress_level=1)
    words = ["texture", "a.png", "b.png", "c.png", "-o", "out", "--processes", "2", "-q"]
    process = start(words, tmp_path)
    while not list(tmp_path.glob("out/.*.part")):
        assert process.poll() is None, process.stderr.read()
        time.sleep(0.02)
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    process.send_signal(number)
    _, text = process.communicate(timeout=SECONDS)
    end = time.monotonic() + SECONDS
    while any(map(is_running, children)):
        assert time.monotonic() < end, "its workers do not end"
        time.sleep(0.05)
    assert process.returncode in (-number, 128 + number, 130)
    assert number == signal.SIGKILL or len(text.splitlines()) <= 1
    assert all(exr_file.is_intact(path) for path in tmp_path.glob("out/*.exr"))
    assert number == signal.SIGKILL or not list(tmp_path.glob("out/.*.part"))
