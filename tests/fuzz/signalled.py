"""Commands that signals end at random moments: no worker and no unfinished file remains, and no signal is lost."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from tests.fuzz.campaign import Tally
from uplift.io.texture import exr_file

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL)
SECONDS = 10.0
"""Limit of the time from a signal to the end of all processes."""
HANDLERS: dict[int, Any] = {signal.SIGINT: signal.default_int_handler}
"""Handlers that commands inherit: as in a terminal, since a shell in the background ignores Ctrl-C. They are set
before the start, since JAX warns of a fork in which Python runs (`preexec_fn`)."""
IMAGES, PIXELS = 3, 1024


def end_textures(count: int, random: np.random.Generator, folder: Path) -> Tally:
    """End `uplift texture` on two workers; textures that have their name are complete."""
    tally = Tally("signals to 'texture' on two processes")
    for number in range(IMAGES):
        codes = random.integers(0, 256, (PIXELS, PIXELS, 3), dtype=np.uint8)
        Image.fromarray(codes).save(folder / f"{number}.png", compress_level=1)
    words = [
        "texture",
        *(f"{number}.png" for number in range(IMAGES)),
        "-o",
        "out",
        "--processes",
        "2",
        "-q",
        "--force",
    ]

    def problem() -> str:
        left = [path for path in (folder / "out").iterdir() if not exr_file.is_intact(path)]
        return "an unfinished file" if left else ""

    (folder / "out").mkdir()
    return _end(tally, words, count, random, folder, problem)


def end_builds(count: int, random: np.random.Generator, folder: Path) -> Tally:
    """End `uplift build`; a cube that has its name is complete."""
    tally, path = Tally("signals to 'build'"), folder / "cube.uplift"
    words = ["build", "-q", "--force", "--dim", "8", "-o", path.name]

    def problem() -> str:
        import uplift

        if path.exists():
            uplift.load(path)
            path.unlink()
        stale = list(folder.glob(".*.part"))
        return "an unfinished file" if stale else ""

    return _end(tally, words, count, random, folder, problem)


def _end(
    tally: Tally,
    words: list[str],
    count: int,
    random: np.random.Generator,
    folder: Path,
    problem: Callable[[], str],
) -> Tally:
    begin = time.monotonic()
    _start(words, folder).communicate()
    whole = time.monotonic() - begin
    problem()
    for turn in range(count):
        number = SIGNALS[turn % (3 if "build" in words else 4)]  # a killed build leaves its file to the next
        process = _start(words, folder)
        assert process.stderr is not None
        time.sleep(random.uniform(0.3, whole))
        children = _children(process.pid)
        process.send_signal(number)
        failure = _wait(process, children)
        lines = process.stderr.read().splitlines()
        process.stderr.close()
        if not failure and process.returncode not in (-number, 0):
            failure = f"exit code {process.returncode}"
        if not failure and number != signal.SIGKILL and len(lines) > 1:
            failure = f"{len(lines)} lines: {lines[-1][:80]}"
        failure = failure or problem()
        tally.count(not failure, failure)
    return tally


def _start(words: list[str], folder: Path) -> subprocess.Popen[str]:
    command = [sys.executable, "-m", "uplift_cli", *words]
    previous = {number: signal.signal(number, handler) for number, handler in HANDLERS.items()}
    try:
        return subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, text=True)
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)


def _children(process: int) -> list[Path]:
    """Workers of a process, as their folders in /proc."""
    with_pid = Path(f"/proc/{process}/task/{process}/children")
    numbers = with_pid.read_text().split() if with_pid.exists() else []
    return [Path(f"/proc/{number}") for number in numbers]


def _wait(process: subprocess.Popen[str], children: list[Path]) -> str:
    """Wait for the end of a process and its workers; return the failure, empty for none."""
    end = time.monotonic() + SECONDS
    try:
        process.wait(SECONDS)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
        return "it does not end"
    while any(map(_is_running, children)):
        if time.monotonic() > end:
            return "its workers do not end"
        time.sleep(0.05)
    return ""


def _is_running(process: Path) -> bool:
    try:
        return " Z " not in (process / "stat").read_text()
    except OSError:
        return False
