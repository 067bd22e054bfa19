"""Writers killed at random, several at once, on a full disk, without permission: the old file or a whole new one."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

import uplift
from tests.fuzz.attack import Tally
from tests.fuzz.target import ROOT

OLD, NEW = (ROOT / "cubes" / f"{name}.uplift" for name in ("moments-16-macbeth", "sigmoid-16-macbeth"))
SAVER = """
import itertools, sys, uplift
cubes = [uplift.load(path) for path in sys.argv[2:]]
print(flush=True)
for cube in itertools.cycle(cubes):
    cube.save(sys.argv[1], force=True)
"""
NOBODY = 65534
ROOM = 100_000
"""Bytes of a disk that is too small for a cube."""


def killed_savers(count: int, random: np.random.Generator, folder: Path) -> Tally:
    """SIGKILL to a process that does nothing but save two cubes in turn: afterwards there is one of the two."""
    tally, path = Tally("SIGKILL while saving"), folder / "cube.uplift"
    whole = {OLD.read_bytes(), NEW.read_bytes()}
    for number in range(count):
        path.unlink(missing_ok=True)
        if number % 2:
            shutil.copy(OLD, path)
        with subprocess.Popen(
            [sys.executable, "-c", SAVER, path, OLD, NEW], stdout=subprocess.PIPE, cwd=ROOT
        ) as saver:
            assert saver.stdout is not None
            saver.stdout.readline()
            time.sleep(random.uniform(0, 0.05))
            saver.send_signal(signal.SIGKILL)
        fine = path.read_bytes() in whole if path.exists() else not number % 2
        uplift.load(NEW).save(path, force=True)
        tidy = os.listdir(folder) == [path.name]
        _count(tally, fine and tidy, "litter that the next writer leaves" if fine else "a broken file")
    return tally


def killed_builds(count: int, random: np.random.Generator, folder: Path) -> Tally:
    """SIGKILL to `uplift build` at any moment of its run, with and without an old cube."""
    tally, path = Tally("SIGKILL while building"), folder / "cube.uplift"
    begin = time.perf_counter()
    _build(path).wait()
    seconds, new = time.perf_counter() - begin, path.read_bytes()
    for number in range(count):
        path.unlink(missing_ok=True)
        if number % 2:
            shutil.copy(OLD, path)
        build = _build(path)
        time.sleep(random.uniform(0, seconds))
        build.send_signal(signal.SIGKILL)
        build.wait()
        there = path.read_bytes() if path.exists() else b""
        _count(tally, there in (new, OLD.read_bytes() if number % 2 else b""), "a broken file")
    return tally


def builds_at_once(count: int, random: np.random.Generator, folder: Path) -> Tally:
    """Two builds of different cubes to one path: both end well, and one of the two is there."""
    tally, path = Tally("two builds at once"), folder / "cube.uplift"
    whole = set()
    for model in ("moments", "sigmoid"):
        _build(path, model).wait()
        whole.add(path.read_bytes())
    for _ in range(count):
        builds = [_build(path, model) for model in ("moments", "sigmoid")]
        fine = [build.wait() for build in builds] == [0, 0] and path.read_bytes() in whole
        _count(tally, fine and os.listdir(folder) == [path.name], "a broken file, or litter")
    return tally


def full_disks(count: int, random: np.random.Generator, folder: Path) -> Tally:
    """Disks without room for a cube, simulated by a limit on files and, for root, a small tmpfs."""
    tally = Tally("disk full")
    with _small_disk(folder) as disk:
        for place, limit in ((folder, True), (disk, False)):
            if place is not None:
                _full_disk(tally, place / "cube.uplift", count, limit=limit)
    return tally


def _full_disk(tally: Tally, path: Path, count: int, *, limit: bool) -> None:
    room = f"resource.setrlimit(resource.RLIMIT_FSIZE, ({ROOM}, {ROOM}))" if limit else ""
    for number in range(count):
        path.write_bytes(b"old" * (number % 2))
        done = _save(path, OLD, room)
        told = (
            done.returncode == 1
            and "cannot be written" in done.stderr
            and "an existing file is unchanged" in done.stderr
        )
        intact = path.read_bytes() == b"old" * (number % 2) and os.listdir(path.parent).count(path.name) == 1
        litter = [name for name in os.listdir(path.parent) if name.endswith(".part")]
        _count(tally, told and intact and not litter, f"not told, not intact, or litter: {done.stderr[-80:]}")


@contextmanager
def _small_disk(folder: Path) -> Iterator[Path | None]:
    """A tmpfs; None where it cannot be had."""
    disk = folder / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", f"size={ROOM}", "tmpfs", str(disk)]
    mounted = shutil.which("mount") and not subprocess.run(mount, capture_output=True).returncode
    try:
        yield disk if mounted else None
    finally:
        if mounted:
            subprocess.run(["umount", str(disk)], check=True)


def no_permission(count: int, random: np.random.Generator, folder: Path) -> Tally:
    """A folder that only others may write to."""
    tally, path = Tally("read-only folder"), folder / "closed" / "cube.uplift"
    path.parent.mkdir()
    path.write_bytes(b"old")
    path.parent.chmod(0o555)
    folder.chmod(0o755)
    become = f"import safetensors.numpy; os.setuid({NOBODY})" if os.geteuid() == 0 else ""
    for _ in range(count):
        done = _save(path, OLD, become)
        told = done.returncode == 1 and "no permission to write in" in done.stderr
        _count(tally, told and path.read_bytes() == b"old", f"not told, or not intact: {done.stderr[-80:]}")
    path.parent.chmod(0o755)
    return tally


def _save(path: Path, cube: Path, before: str = "") -> subprocess.CompletedProcess[str]:
    """Save a cube in a process of its own, which runs ``before`` first."""
    code = f"import os, resource, sys, uplift\ncube = uplift.load(sys.argv[2])\n{before}\n"
    code += "cube.save(sys.argv[1], force=True)"
    return subprocess.run(
        [sys.executable, "-c", code, path, cube], capture_output=True, text=True, cwd=ROOT, check=False
    )


def _build(path: Path, model: str = "moments") -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "uplift_cli", "build", "-q", "--force", "--dim", "16", "--model", model]
    return subprocess.Popen([*command, "-o", path])


def _count(tally: Tally, fine: bool, failure: str) -> None:
    tally.inputs += 1
    if not fine:
        tally.failures += Counter([failure])
