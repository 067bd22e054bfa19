"""Signals end a command and its workers, and leave no unfinished file."""

from __future__ import annotations

import gc
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from uplift_cli import signals
from uplift_cli.output.diagnostics import InterruptFailure

from uplift.common.progress import Progress

pytestmark = pytest.mark.skipif(os.name == "nt", reason="needs POSIX signals")
SECONDS = 60
"""Limit of waiting for what takes a second or two."""


@pytest.fixture(autouse=True)
def _no_signals_left():
    """Forget received signals: the next report of progress in this process would raise them."""
    yield
    signals._received.clear()


@pytest.fixture
def texture(tmp_path):
    """A process that converts two large images on two workers, and has begun with both."""
    for name in ("a.png", "b.png"):
        Image.fromarray(np.full((4096, 4096, 3), 100, np.uint8)).save(tmp_path / name, compress_level=1)
    command = [sys.executable, "-m", "uplift_cli", "texture", "a.png", "b.png", "-o", "out", "--processes", "2"]
    with subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True) as process:
        wait_until(lambda: len(unfinished(tmp_path)) == 2 or process.poll() is not None)
        yield process
        process.kill()


def unfinished(folder):
    return list((folder / "out").glob(".*.part"))


def wait_until(condition):
    end = time.monotonic() + SECONDS
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.05)


def workers_of(process):
    """Processes of Python that the process started, without the tracker of resources."""
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    return [int(child) for child in children if b"spawn_main" in Path(f"/proc/{child}/cmdline").read_bytes()]


def is_running(number):
    try:
        return " Z " not in Path(f"/proc/{number}/stat").read_text()
    except FileNotFoundError:
        return False


needs_proc = pytest.mark.skipif(not os.path.exists("/proc/self/task"), reason="needs /proc")


@needs_proc
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL])
def test_workers_end_with_the_command(texture, tmp_path, number):
    workers = workers_of(texture)
    assert len(workers) == 2
    texture.send_signal(number)
    assert texture.wait(SECONDS) == -number
    wait_until(lambda: not any(map(is_running, workers)))
    assert list((tmp_path / "out").iterdir()) == []
    if number == signal.SIGTERM:
        line = "error: ended by SIGTERM; 0 of 2 images are finished, continue with --resume\n"
        assert texture.stderr.read() == line


@needs_proc
def test_a_killed_worker_is_one_line(texture, tmp_path):
    os.kill(workers_of(texture)[0], signal.SIGKILL)
    assert texture.wait(SECONDS) == 2
    (line,) = texture.stderr.read().splitlines()
    assert line.startswith("error: the workers ended unexpectedly; 0 of 2 textures are finished; ")
    assert list((tmp_path / "out").iterdir()) == []


def run(code):
    with signals.ending_signals():
        code()


@pytest.mark.parametrize("number", signals.ENDING)
def test_signals_are_interrupts(number):
    before = signal.signal(number, signal.SIG_DFL)  # a test run in the background may ignore signals
    try:
        with pytest.raises(KeyboardInterrupt):
            run(lambda: signal.raise_signal(number))
        assert signal.getsignal(number) is signal.SIG_DFL
    finally:
        signal.signal(number, before)
    assert signals.received() == number
    assert InterruptFailure(KeyboardInterrupt(), number).exit_code == 128 + number


def test_ignored_signals_stay_ignored():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        run(lambda: signal.raise_signal(signal.SIGHUP))
    finally:
        signal.signal(signal.SIGHUP, before)


def dropped(*_):
    """A callback whose exceptions the interpreter drops."""
    gc.callbacks.remove(dropped)
    signal.raise_signal(signal.SIGTERM)


def test_an_interrupt_in_a_callback_is_raised_again():
    def wait():
        gc.callbacks.append(dropped)
        gc.collect()
        assert signals.received()
        time.sleep(SECONDS)

    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        run(wait)
    assert time.monotonic() - begin < SECONDS / 2


def test_an_interrupt_is_sent_until_it_is_raised(monkeypatch):
    """One that arrives just before a system call does not end it."""
    send, lost = signals._send, []

    def lose_two(number):
        if len(lost) < 2:
            lost.append(number)
        else:
            send(number)

    monkeypatch.setattr(signals, "_send", lose_two)
    test_an_interrupt_in_a_callback_is_raised_again()
    assert lost == [signal.SIGTERM] * 2


def test_an_interrupt_while_another_is_put_off_is_not_lost(monkeypatch):
    later, calls = signals._later, []

    def interrupted(number):
        calls.append(number)
        if len(calls) == 1:
            signal.raise_signal(signal.SIGTERM)
        later(number)

    monkeypatch.setattr(signals, "_later", interrupted)
    test_an_interrupt_in_a_callback_is_raised_again()
    assert len(calls) >= 2


def test_the_thread_that_sends_signals_ends_with_the_command():
    def names():
        return [thread.name for thread in threading.enumerate()]

    run(lambda: names().index(signals.SENDER))
    wait_until(lambda: signals.SENDER not in names())


def test_progress_raises_a_dropped_interrupt(monkeypatch):
    from uplift_cli.output.progress import build_progress

    monkeypatch.setattr(signals, "_send", lambda number: None)

    def report():
        gc.callbacks.append(dropped)
        gc.collect()
        with build_progress(quiet=True, verbose=False) as progress:
            progress(Progress("fit", 0, 1))
            pytest.fail("the interrupt was lost")

    with pytest.raises(KeyboardInterrupt):
        run(report)


def test_an_interrupt_during_an_import_is_raised_after_it(tmp_path, monkeypatch):
    (tmp_path / "slow_module.py").write_text("import signal\nsignal.raise_signal(signal.SIGTERM)\ndone = True\n")
    monkeypatch.syspath_prepend(tmp_path)
    imported = []

    def load():
        import slow_module

        imported.append(slow_module.done)
        time.sleep(SECONDS)

    with pytest.raises(KeyboardInterrupt):
        run(load)
    assert imported == [True]
