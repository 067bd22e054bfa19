"""Fuzz target: commands in odd places, with closed or full streams, odd encodings and little memory.

Each case runs in a child process, whose streams are those of the case. The interpreter's own writing of the streams at
its end is done as well.
"""

from __future__ import annotations

import codecs
import contextlib
import functools
import gc
import io
import json
import os
import resource
import shutil
import signal
import sys
import tempfile
import warnings
from importlib import import_module
from pathlib import Path
from typing import Any

from click.testing import CliRunner
from uplift_cli.main import main

from tests.fuzz.command_line import Outcome, check_outcome, choose
from tests.fuzz.mutate import Random
from tests.fuzz.target import ROOT, Target

CUBE, ATLAS = ROOT / "cubes" / "moments-8-macbeth.uplift", ROOT / "atlases" / "macbeth.txt"
COMMANDS: tuple[tuple[str, ...], ...] = (
    ("--help",), ("--version",), ("query", "--help"), ("texture", "-h"), ("--nosuch",), ("query",),
    ("query", "0.1", "0.2", "0.3"), ("query", "0.1", "0.2", "0.3", "--format", "json"),
    ("query", "0.1", "0.2", "0.3", "--format", "csv"), ("query", "-"), ("query", "--input", "-", "--format", "csv"),
    ("query", "--cube", "{}", "0", "0", "0"), ("query", "--input", "{}"), ("query", "0", "0", "0", "--plot", "{}"),
    ("info", str(CUBE)), ("info", "{}"), ("info",), ("atlas",), ("atlas", str(ATLAS)), ("atlas", "{}"),
    ("atlas", str(ATLAS), "-o", "{}"), ("export", str(CUBE), "-o", "{}"), ("export", "{}", "-o", "x.csv"),
    ("mix", "1:#ff0000", "2:#00ff00"), ("mix", "1:dark skin", "--cube", str(CUBE)),
    ("chart", "--recommend", "--tolerance", "1"), ("wavelengths", "--count", "3", "--atlas", str(ATLAS)),
    ("palette", "{}"), ("plan", "{}"), ("texture", "{}", "-o", "x.exr"), ("report", "{}"),
    ("slices", "{}", "-o", "x.exr"), ("build", "--plan", "{}"),
)  # fmt: skip
NAMES = (
    "x", "folder/x.csv", "shut/x.uplift", "x.uplift", "x.txt", "nosuch/x.csv", "folder", "a" * 255, "a" * 256,
    "a/" * 2050 + "a", "\udcff\udcfe.csv", "\udcff", "", ".", "/", "/dev/null", "/dev/full", "/dev/stdin",
    "/proc/self/mem", "/dev/zero", "loop", "dangling.csv", "x.csv", "x.npz", "x.png", "x.h", "-", "~",
    "~nosuch/x.csv", "*", "[", "a\nb.csv", "con.csv",
)  # fmt: skip
"""Names of files: odd, impossible, or of devices, links, pipes and folders."""
ENCODINGS = ("utf-8", "ascii", "latin-1", "cp1252", "cp437", "koi8-r", "shift_jis", "utf-16")
STREAMS = ("file", "file", "closed", "full", "pipe")
NATIVE = ("texture",)
"""Commands that have all their memory: a library of theirs ends the process if it gets none."""
INPUTS = (b"", b"0.1,0.2,0.3\n", b"#fff\n\xff\xfe", b"\0" * 99, b"nan nan nan\n", b"1,1,1\n" * 2000)
WORKING_FOLDERS = ("plain", "plain", "deleted", "shut")
ENVIRONMENTS: tuple[dict[str, str | None], ...] = (
    {}, {}, {"HOME": None}, {"HOME": "/nosuch"}, {"MPLBACKEND": "nonsense"}, {"MPLBACKEND": "module://x"},
    {"COLUMNS": "1"}, {"COLUMNS": "nonsense"}, {"TERM": "dumb"}, {"NO_COLOR": "1"}, {"PYTHONWARNINGS": "nonsense"},
    {"TMPDIR": "/nosuch"}, {"LC_ALL": "C"}, {"MPLCONFIGDIR": "/dev/null"}, {"XDG_CACHE_HOME": "relative"},
)  # fmt: skip
SECONDS = 10
"""Time after which a child hangs, and is ended by a signal."""
NOBODY = 65534
"""User without permissions."""


def _generate(random: Random, path: Path) -> None:
    _load_modules()
    name, command = choose(random, NAMES), choose(random, COMMANDS)
    memory = choose(random, (None, None, None, 4, 16, 64))
    case = {
        "args": [word.replace("{}", name) for word in command],
        "encoding": choose(random, ENCODINGS),
        "stdin": choose(random, ("file", "closed")),
        "stdout": choose(random, STREAMS),
        "stderr": choose(random, STREAMS),
        "input": int(random.integers(len(INPUTS))),
        "folder": choose(random, WORKING_FOLDERS),
        "environment": choose(random, ENVIRONMENTS),
        "memory": None if command[0] in NATIVE else memory,
        "user": choose(random, (0, 0, NOBODY)),
    }
    path.write_text(json.dumps(case), encoding="ascii")


def _use(path: Path) -> None:
    case = json.loads(path.read_text(encoding="ascii"))
    with tempfile.TemporaryDirectory(dir=path.parent, ignore_cleanup_errors=True) as folder:
        check_outcome(_run(case, Path(folder)))


def _run(case: dict[str, Any], folder: Path) -> Outcome:
    """Run a case in a child process, with its files in a folder."""
    place = _make_place(case, folder)
    crash = os.open(folder / "crash", os.O_WRONLY)
    with warnings.catch_warnings(action="ignore"):  # JAX warns of its threads, which the commands do not use
        child = os.fork()
    if not child:
        try:
            code = _child(case, folder, place)
        except BaseException as error:
            os.write(crash, f"{type(error).__name__}: {error}".encode(errors="replace"))
            code = 99
        os._exit(code)
    os.close(crash)
    status = os.waitpid(child, 0)[1]
    if os.WIFSIGNALED(status):
        raise ValueError(f"killed by signal {os.WTERMSIG(status)}")
    code = os.WEXITSTATUS(status)
    if crash := (folder / "crash").read_text(encoding="utf-8"):
        raise ValueError(f"a traceback: {crash[:100]}")
    stdout, stderr = (_text(folder / name, case["encoding"]) for name in ("stdout", "stderr"))
    if code == 1 and case["stdout"] == "pipe":
        return Outcome(0, stdout, stderr)
    if code == 2 and case["stderr"] != "file":
        stderr = "error: not recorded"
    return Outcome(code, stdout, stderr)


@functools.cache
def _load_modules() -> None:
    """Load what the commands import when they run: a child may lack the memory or the permission."""
    import_module("OpenEXR")  # a case above may stop before its import
    for encoding in (*ENCODINGS, "latin-1", "utf-8-sig", "cp65001"):
        with contextlib.suppress(LookupError):
            codecs.lookup(encoding)
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        shutil.copy(CUBE, "y.uplift")
        for command in COMMANDS:
            for name in ("x.png", "y.uplift"):
                CliRunner().invoke(main, [word.replace("{}", name) for word in command], input="1,1,1")


def _make_place(case: dict[str, Any], folder: Path) -> Path:
    place = folder / "place"
    place.mkdir()
    for name in ("folder", "shut"):
        (place / name).mkdir()
    shutil.copy(CUBE, place / "x.uplift")
    shutil.copy(ATLAS, place / "x.txt")
    (place / "loop").symlink_to("loop")
    (place / "dangling.csv").symlink_to("nosuch/y")
    (place / "shut").chmod(0)
    folder.chmod(0o755)
    place.chmod(0o777)
    (folder / "input").write_bytes(INPUTS[case["input"]])
    for name in ("stdout", "stderr", "crash"):
        (folder / name).touch()
        (folder / name).chmod(0o666)
    return place


def _child(case: dict[str, Any], folder: Path, place: Path) -> int:
    gc.disable()
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.alarm(SECONDS)
    descriptors = [
        _open_input(case, folder),
        *(_open_output(case, folder, name) for name in ("stdout", "stderr")),
    ]
    os.chdir(place)
    for name, value in case["environment"].items():
        if value is None:
            os.environ.pop(name, None)
        else:
            os.environ[name] = value
    os.environ["UPLIFT_TRACEBACK"] = "1"
    for number, descriptor in enumerate(descriptors):
        os.close(number) if descriptor is None else os.dup2(descriptor, number)
    if case["folder"] == "deleted":
        os.mkdir("gone")
        os.chdir("gone")
        os.rmdir("../gone")
    elif case["folder"] == "shut":
        os.chdir("shut")
    if case["user"]:
        os.setuid(case["user"])
    sys.stdin, sys.stdout, sys.stderr = (
        None if descriptor is None else open(number, mode, encoding=case["encoding"], errors=errors, closefd=False)  # noqa: SIM115
        for number, (descriptor, mode, errors) in enumerate(
            zip(descriptors, "rww", ("strict", "strict", "backslashreplace"), strict=True)
        )
    )
    if case["memory"] is not None:
        pages = int(Path("/proc/self/statm").read_text().split()[0])
        limit = pages * resource.getpagesize() + (case["memory"] << 20)
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    warnings.simplefilter("ignore")
    try:
        main(case["args"], prog_name="uplift")
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else 1
    try:
        sys.stdout.flush()
    except OSError:
        code = 120  # as the interpreter ends if it cannot write it
    return code


def _open_input(case: dict[str, Any], folder: Path) -> int | None:
    return None if case["stdin"] == "closed" else os.open(folder / "input", os.O_RDONLY)


def _open_output(case: dict[str, Any], folder: Path, name: str) -> int | None:
    kind = case[name]
    if kind == "closed":
        return None
    if kind == "pipe":
        reader, writer = os.pipe()
        os.close(reader)
        return writer
    return os.open("/dev/full" if kind == "full" else folder / name, os.O_WRONLY)


def _text(path: Path, encoding: str) -> str:
    return io.TextIOWrapper(io.BytesIO(path.read_bytes()), encoding=encoding, newline="").read().replace("\ufeff", "")


TARGET = Target("streams and places", _generate, _use)
