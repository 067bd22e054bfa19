"""``uplift`` as a process: what it imports, its streams, the signals that end it, and
its cache folder.
"""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from uplift_cli.startup import enable_jit_cache

from tests.conftest import ROOT
from tests.helpers import output_of, warns

UPLIFT = f"{sys.executable} -m uplift_cli"
TEXTURE = "texture a.png b.png -o out --processes 2"
PLOT = "query 0.1 0.2 0.3 --plot plot.png"
SECONDS = 60
"""Limit of waiting for what takes a second or two."""
needs_modes = pytest.mark.skipif(os.name == "nt", reason="permissions of POSIX")
needs_full = pytest.mark.skipif(
    not os.path.exists("/dev/full"), reason="no such device"
)
needs_proc = pytest.mark.skipif(
    not os.path.exists("/proc/self/task"), reason="needs /proc"
)


def shell(command, **environment):
    """Run a command in a shell."""
    return subprocess.run(
        ["bash", "-o", "pipefail", "-c", command],
        capture_output=True,
        stdin=subprocess.DEVNULL,
        env=os.environ | environment,
        timeout=SECONDS,
    )


def test_the_package_runs_as_the_command_does():
    assert output_of(sys.executable, "-m", "uplift").startswith("Usage: uplift ")


def test_closed_pipe_is_not_an_error():
    done = shell(f"{UPLIFT} query '#cc3319' --format json | head -c 5")
    assert (done.stdout, done.stderr) == (b'{"cub', b"")


@needs_full
def test_output_that_cannot_be_written_is_one_line():
    done = shell(f"{UPLIFT} query 0 0 0 --format csv >/dev/full")
    assert done.returncode == 2
    line = b"error: output cannot be written: No space left on device; "
    assert done.stderr.startswith(line)
    assert done.stderr.count(b"\n") == 1


@pytest.mark.parametrize(
    ("arguments", "code"), [("0 0 0 >&-", "output"), ("- <&-", "colour")]
)
def test_streams_that_cannot_be_used_are_errors_in_json_for_json_output(
    arguments, code
):
    done = shell(f"{UPLIFT} query --format json {arguments}")
    assert done.returncode == 2
    assert json.loads(done.stderr)["error"]["code"] == code


def test_swatches_are_for_terminals_with_colours():
    code = f"import pty; pty.spawn({f'{UPLIFT} query 0.2 0.3 0.4'.split()!r})"
    variables = "TERM=xterm-256color COLORTERM=truecolor"
    done = shell(f'{variables} {sys.executable} -c "{code}"')
    assert b"\x1b[48;2;" in done.stdout


def test_closed_streams_that_are_not_needed_do_no_harm():
    done = shell(f"{UPLIFT} query 0 0 0 --format json 2>&- <&-")
    assert (done.returncode, done.stderr) == (0, b"")
    assert json.loads(done.stdout)["rgb"] == [0, 0, 0]


def test_json_is_ascii_where_the_terminal_is(tmp_path):
    (tmp_path / "a.csv").write_text("name,400,700\n青 ΔE00,0.1,0.4\n", encoding="utf-8")
    command = f"{UPLIFT} atlas {tmp_path}/a.csv --format json"
    answer = json.loads(shell(command, PYTHONIOENCODING="ascii").stdout.decode("ascii"))
    assert answer["entries"][0]["name"] == "青 ΔE00"


@pytest.fixture(scope="module")
def large_image(tmp_path_factory):
    path = tmp_path_factory.mktemp("images") / "large.png"
    pixels = np.full((4096, 4096, 3), 100, np.uint8)
    Image.fromarray(pixels).save(path, compress_level=1)
    return path


@pytest.fixture
def texture(tmp_path, large_image):
    """A process that converts two large images on two workers, and has
    begun with both.
    """
    for name in ("a.png", "b.png"):
        shutil.copy(large_image, tmp_path / name)
    command = f"{UPLIFT} {TEXTURE}".split()
    # A shell without job control starts what runs in its background with SIGINT
    # ignored.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    with subprocess.Popen(
        command, cwd=tmp_path, stderr=subprocess.PIPE, text=True
    ) as process:
        signal.signal(signal.SIGINT, before)
        wait_until(
            lambda: (
                len(list((tmp_path / "out").glob(".*.part"))) == 2
                or process.poll() is not None
            )
        )
        yield process
        process.kill()


def wait_until(condition):
    end = time.monotonic() + SECONDS
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.05)


def workers_of(process):
    """Processes of Python that the process started, without the tracker of
    resources.
    """
    children = (
        Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    )
    return [
        int(child)
        for child in children
        if b"spawn_main" in Path(f"/proc/{child}/cmdline").read_bytes()
    ]


def is_running(number):
    try:
        return " Z " not in Path(f"/proc/{number}/stat").read_text()
    except FileNotFoundError:
        return False


@needs_proc
@pytest.mark.parametrize(
    ("number", "code", "message"),
    [
        (signal.SIGINT, 130, "0 of 2 images finished, continue with --resume"),
        (signal.SIGTERM, 143, ""),
    ],
)
def test_signals_end_a_command_and_its_workers_and_leave_no_file(
    texture, tmp_path, number, code, message
):
    workers = workers_of(texture)
    assert len(workers) == 2
    texture.send_signal(number)
    assert texture.wait(SECONDS) == code
    assert message in texture.stderr.read()
    wait_until(lambda: not any(map(is_running, workers)))
    assert list((tmp_path / "out").iterdir()) == []


@needs_proc
def test_a_killed_worker_is_one_line(texture, tmp_path):
    os.kill(workers_of(texture)[0], signal.SIGKILL)
    assert texture.wait(SECONDS) == 2
    (line,) = texture.stderr.read().splitlines()
    assert line.startswith(
        "error: the workers ended unexpectedly; finished: 0 of 2 textures; "
    )
    assert list((tmp_path / "out").iterdir()) == []


MARK = (
    "open({path!r}, 'a').write(__name__ + ' ')\nraise ImportError('a module of the "
    "working folder')\n"
)


@pytest.fixture
def strange_folder(tmp_path):
    """A working folder with a module for each one of Python, and some others, that
    leave a trace in a file.
    """
    folder = tmp_path / "strange"
    folder.mkdir()
    for name in {
        *sys.stdlib_module_names,
        "click",
        "numpy",
        "jax",
        "PIL",
        "matplotlib",
        "uplift",
    } - {"__main__"}:
        (folder / f"{name}.py").write_text(MARK.format(path=str(tmp_path / "trace")))
    for name in ("a.png", "b.png"):
        Image.fromarray(np.full((2, 2, 3), 100, np.uint8)).save(folder / name)
    yield folder
    assert not (tmp_path / "trace").exists()


def test_no_module_of_the_working_folder_is_loaded(strange_folder, tmp_path):
    script = tmp_path / "uplift"  # as pip installs it
    script.write_text(
        "from uplift_cli.__main__ import run\nif __name__ == '__main__':\n    run()\n"
    )
    options = {"cwd": strange_folder, "timeout": SECONDS}
    output_of(sys.executable, script, *TEXTURE.split(), **options)
    assert len(list(strange_folder.glob("out/*"))) == 2
    # Python itself loads these for -m.
    for name in ("runpy", "importlib", "contextlib", "types", "warnings", "functools"):
        (strange_folder / f"{name}.py").unlink(missing_ok=True)
    output_of(*f"{UPLIFT} {PLOT}".split(), **options)


def test_settings_of_matplotlib_are_neither_obeyed_nor_remarked_on(tmp_path):
    (tmp_path / "matplotlibrc").write_text("figure.facecolor: red\nno colon")
    # The folder of the user, and the working folder.
    done = shell(f"cd {tmp_path}; {UPLIFT} {PLOT}", MPLCONFIGDIR=str(tmp_path))
    assert (done.returncode, done.stderr) == (0, b"plot.png: 1 colour\n")
    with Image.open(tmp_path / "plot.png") as image:
        assert image.convert("RGB").getpixel((0, 0)) != (255, 0, 0)


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """The user's cache folder, which does not exist yet; the folders above it are the
    user's alone.
    """
    monkeypatch.setenv("JAX_COMPILATION_CACHE_DIR", "")  # so that it is restored
    monkeypatch.delenv("JAX_COMPILATION_CACHE_DIR")
    monkeypatch.setattr(
        "platformdirs.user_cache_dir", lambda name: str(tmp_path / "a" / "cache")
    )
    return tmp_path / "a" / "cache"


def used_cache():
    enable_jit_cache()
    return os.environ.pop("JAX_COMPILATION_CACHE_DIR", None)


@needs_modes
def test_compiled_code_is_kept_in_a_private_folder_only(cache):
    assert used_cache() == str(cache)
    assert cache.stat().st_mode & 0o777 == 0o700
    # Others can write to the folder, or put another one in its place.
    for path, mode in ((cache, 0o770), (cache, 0o702), (cache.parent, 0o777)):
        before = path.stat().st_mode
        path.chmod(mode)
        with warns("warning"):
            assert used_cache() is None
        path.chmod(before)
    # As /tmp, where users can replace their own folders only.
    cache.parent.chmod(0o1777)
    assert used_cache() == str(cache)


@needs_modes
def test_jax_uses_the_folder_that_was_checked_not_a_link_to_it(cache, tmp_path):
    (tmp_path / "kept").mkdir(0o700)
    cache.parent.mkdir()
    cache.symlink_to(tmp_path / "kept")
    assert used_cache() == str(tmp_path / "kept")


def test_a_cache_folder_that_cannot_be_used_is_a_warning(cache, tmp_path, monkeypatch):
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    for folder in (tmp_path / "loop" / "uplift", f"{tmp_path}/\udcff/uplift"):
        monkeypatch.setattr(
            "platformdirs.user_cache_dir", lambda name, folder=folder: str(folder)
        )
        with warns("warning"):
            assert used_cache() is None


CACHED = "cache/uplift/*-cache"
BUILD = (
    f"env -u JAX_COMPILATION_CACHE_DIR {UPLIFT} build --dim 2 --prior smooth "
    "--coefficients 3 --force -o"
)


def test_compiled_code_is_kept_and_removed_if_it_cannot_be_used(tmp_path):
    """Also that of users whose files their group can write."""

    def build():
        command = f"umask 0002; {BUILD} {tmp_path}/cube.uplift"
        places = {"XDG_CACHE_HOME": f"{tmp_path}/cache", "UPLIFT_TRACEBACK": ""}
        code = shell(command, **places).returncode
        return code, {path: path.read_bytes() for path in tmp_path.glob(CACHED)}

    code, entries = build()
    assert code == 0
    assert entries
    inodes = [path.stat().st_ino for path in entries]
    assert build() == (0, entries)
    assert inodes == [path.stat().st_ino for path in entries]
    first, *_, last = entries
    first.write_bytes(entries[last])
    last.write_bytes(entries[first])
    assert build() == (70, {})
    for path in entries:
        path.write_bytes(b"damaged")
    code, after = build()
    assert code == 0
    assert b"damaged" not in after.values()


def test_a_missing_device_of_jax_is_no_internal_error(tmp_path):
    done = shell(
        f"{UPLIFT} build --dim 2 -o {tmp_path}/cube.uplift", JAX_PLATFORMS="cuda"
    )
    assert (done.returncode, b"JAX_PLATFORMS=cuda" in done.stderr) == (2, True)


@needs_proc
@pytest.mark.parametrize(
    ("limit", "command"),
    [
        (300_000, "build -o out"),
        (1_500_000, f"check {ROOT}/cubes/sigmoid-8.uplift"),
    ],
)
def test_too_little_memory_is_an_error_not_an_abort(tmp_path, limit, command):
    done = shell(f"cd {tmp_path}; ulimit -v {limit}; {UPLIFT} {command}")
    assert done.returncode in (1, 2)
    assert done.stderr.count(b"\n") == 1
    assert b"memory" in done.stderr
    assert b"version" not in done.stderr  # of a cube's options


DEAF = """
import hashlib
from uplift_cli import startup
startup.GRACE = 0.1
startup.prepare_process()
print(flush=True)
hashlib.pbkdf2_hmac("sha256", b"", b"", 2**31 - 1)
"""
"""Ten minutes in one call of compiled code, in which no handler of Python runs."""


@needs_modes
@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)]
)
def test_signals_end_compiled_code(number, code):
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    with subprocess.Popen(
        [sys.executable, "-c", DEAF], stdout=subprocess.PIPE
    ) as process:
        signal.signal(signal.SIGINT, before)
        process.stdout.readline()
        time.sleep(0.5)  # until the call has begun
        process.send_signal(number)
        try:
            assert process.wait(SECONDS) == code
        finally:
            process.kill()
