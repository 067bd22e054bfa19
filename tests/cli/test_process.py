"""``uplift`` as a process: what it imports, its streams, the signals that end it, and its cache folder."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from uplift_cli.startup import enable_jit_cache

from tests.helpers import warns

UPLIFT = f"{sys.executable} -m uplift_cli"
SECONDS = 60
"""Limit of waiting for what takes a second or two."""
COMMANDS = ("--help", "--version", "query --help", "query 0 0 0", "query 0 0 0 --format csv", "info")
needs_full = pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no such device")
needs_proc = pytest.mark.skipif(not os.path.exists("/proc/self/task"), reason="needs /proc")


def shell(command, **environment):
    """Run a command in a shell."""
    return subprocess.run(
        ["bash", "-o", "pipefail", "-c", command],
        capture_output=True,
        stdin=subprocess.DEVNULL,
        env={name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"} | environment,
        timeout=SECONDS,
    )


def test_a_query_imports_no_heavy_package():
    code = (
        "import sys; from uplift_cli.main import main\n"
        "try: main(['query', '0.2', '0.3', '0.4', '--format', 'json'])\n"
        "except SystemExit: pass\n"
        "print({'jax', 'scipy', 'colour', 'matplotlib', 'rich', 'logging'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "set()"


def test_closed_pipe_is_not_an_error():
    done = shell(f"{UPLIFT} query '#cc3319' --format json | head -c 5")
    assert (done.stdout, done.stderr) == (b'{"cub', b"")


@needs_full
@pytest.mark.parametrize("command", COMMANDS)
def test_output_that_cannot_be_written_is_one_line(command):
    done = shell(f"{UPLIFT} {command} >/dev/full")
    assert done.returncode == 2
    assert done.stderr.startswith(b"error: output cannot be written: No space left on device")
    assert done.stderr.count(b"\n") == 1


@pytest.mark.parametrize(
    ("arguments", "code"), [("0 0 0 >&-", "output"), ("0 0 0 >/dev/full", "output"), ("- <&-", "colour")]
)
def test_streams_that_cannot_be_used_are_errors_in_json_for_json_output(arguments, code):
    done = shell(f"{UPLIFT} query --format json {arguments}")
    assert done.returncode == 2
    assert json.loads(done.stderr)["error"]["code"] == code


def test_swatches_are_for_terminals_with_colours():
    for variables, coloured in (("TERM=xterm-256color COLORTERM=truecolor", True), ("TERM=xterm NO_COLOR=1", False)):
        for words in ("query 0.2 0.3 0.4", "atlas macbeth"):
            code = f"import pty; pty.spawn({f'{UPLIFT} {words}'.split()!r})"
            done = shell(f'{variables} {sys.executable} -c "{code}"')
            assert (b"\x1b[48;2;" in done.stdout) == coloured


@pytest.mark.parametrize("streams", ["2>&-", "2>/dev/full", "<&-"])
def test_closed_streams_that_are_not_needed_do_no_harm(streams):
    done = shell(f"{UPLIFT} query 0 0 0 --format json {streams}")
    assert (done.returncode, done.stderr) == (0, b"")
    assert json.loads(done.stdout)["rgb"] == [0, 0, 0]


def test_json_is_the_same_on_any_terminal(tmp_path):
    (tmp_path / "a.csv").write_text("name,400,500,600,700\n青 ΔE00,0.1,0.2,0.3,0.4\n", encoding="utf-8")
    command = f"{UPLIFT} atlas {tmp_path}/a.csv --format json"
    answers = [shell(command, PYTHONIOENCODING=code).stdout for code in ("ascii", "utf-8")]
    assert [answer.isascii() for answer in answers] == [True, False]
    assert json.loads(answers[0]) == json.loads(answers[1])


@pytest.fixture
def texture(tmp_path):
    """A process that converts two large images on two workers, and has begun with both."""
    for name in ("a.png", "b.png"):
        Image.fromarray(np.full((4096, 4096, 3), 100, np.uint8)).save(tmp_path / name, compress_level=1)
    command = [sys.executable, "-m", "uplift_cli", "texture", "a.png", "b.png", "-o", "out", "--processes", "2"]
    # A shell without job control starts what runs in its background with SIGINT ignored.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    with subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True) as process:
        signal.signal(signal.SIGINT, before)
        wait_until(lambda: len(list((tmp_path / "out").glob(".*.part"))) == 2 or process.poll() is not None)
        yield process
        process.kill()


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


@needs_proc
@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_signals_end_a_command_and_its_workers_and_leave_no_file(texture, tmp_path, number, code):
    workers = workers_of(texture)
    assert len(workers) == 2
    texture.send_signal(number)
    assert texture.wait(SECONDS) == code
    if number == signal.SIGINT:
        line = "error: interrupted; 0 of 2 images are finished, continue with --resume\n"
        assert texture.stderr.read() == line
    wait_until(lambda: not any(map(is_running, workers)))
    assert list((tmp_path / "out").iterdir()) == []


@needs_proc
def test_a_killed_worker_is_one_line(texture, tmp_path):
    os.kill(workers_of(texture)[0], signal.SIGKILL)
    assert texture.wait(SECONDS) == 2
    (line,) = texture.stderr.read().splitlines()
    assert line.startswith("error: the workers ended unexpectedly; 0 of 2 textures are finished; ")
    assert list((tmp_path / "out").iterdir()) == []


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """The user's cache folder, which does not exist yet."""
    monkeypatch.setenv("JAX_COMPILATION_CACHE_DIR", "")  # so that it is restored
    monkeypatch.delenv("JAX_COMPILATION_CACHE_DIR")
    monkeypatch.setattr("platformdirs.user_cache_dir", lambda name: str(tmp_path / "cache"))
    return tmp_path / "cache"


@pytest.mark.skipif(os.name == "nt", reason="permissions of POSIX")
@pytest.mark.parametrize("mode", [0o770, 0o702])
def test_compiled_code_is_kept_in_a_private_folder_only(cache, mode):
    enable_jit_cache()
    assert os.environ.pop("JAX_COMPILATION_CACHE_DIR") == str(cache)
    assert cache.stat().st_mode & 0o777 == 0o700
    cache.chmod(mode)
    with warns("warning"):
        enable_jit_cache()
    assert "JAX_COMPILATION_CACHE_DIR" not in os.environ
