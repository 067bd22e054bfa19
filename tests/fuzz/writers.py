"""Writers that are killed, run concurrently, or have no space or permission: the old or a complete new file remains."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_info

import uplift
from tests.fuzz.campaign import Tally
from tests.fuzz.target import ROOT
from uplift.cube import digest

OLD, NEW = (ROOT / "cubes" / f"{name}.uplift" for name in ("moments-16-macbeth", "sigmoid-16-macbeth"))
SAVE_IN_TURN = """
import itertools, sys, uplift
cubes = [uplift.load(path) for path in sys.argv[2:]]
print(flush=True)
for cube in itertools.cycle(cubes):
    cube.save(sys.argv[1], force=True)
"""
SAVE_ONCE = """
import os, resource, sys, uplift
cube = uplift.load(sys.argv[2])
{setup}
try:
    cube.save(sys.argv[1], force=True)
except uplift.UpliftError as error:
    sys.exit(error.code)
"""
NOBODY = 65534
"""User without permissions."""
BUILDS = 6
"""Builds at once."""
DISK_BYTES = 100_000
"""Size of a disk that is too small for a cube."""


def kill_saves(count: int, random: np.random.Generator, folder: Path) -> Tally:
    """Kill a process that saves two cubes in turn: one of the two remains."""
    tally, path = Tally("SIGKILL while saving"), folder / "cube.uplift"
    complete = {OLD.read_bytes(), NEW.read_bytes()}
    for number in range(count):
        path.unlink(missing_ok=True)
        if number % 2:
            shutil.copy(OLD, path)
        with subprocess.Popen(
            [sys.executable, "-c", SAVE_IN_TURN, path, OLD, NEW], stdout=subprocess.PIPE, cwd=ROOT
        ) as process:
            assert process.stdout is not None
            process.stdout.readline()
            time.sleep(random.uniform(0, 0.05))
            process.send_signal(signal.SIGKILL)
        intact = path.read_bytes() in complete if path.exists() else not number % 2
        for temporary in folder.glob(".*.part"):
            os.utime(temporary, (0, 0))  # as if the process had been killed long ago
        uplift.load(NEW).save(path, force=True)
        clean = os.listdir(folder) == [path.name]
        tally.count(intact and clean, "temporary files that the next writer leaves" if intact else "a broken file")
    return tally


def kill_builds(count: int, random: np.random.Generator, folder: Path) -> Tally:
    """Kill `uplift build` at a random moment, with and without an old cube."""
    tally, path = Tally("SIGKILL while building"), folder / "cube.uplift"
    start = time.perf_counter()
    _build(path).wait()
    seconds, new = time.perf_counter() - start, path.read_bytes()
    for number in range(count):
        path.unlink(missing_ok=True)
        if number % 2:
            shutil.copy(OLD, path)
        build = _build(path)
        time.sleep(random.uniform(0, seconds))
        build.send_signal(signal.SIGKILL)
        build.wait()
        content = path.read_bytes() if path.exists() else b""
        tally.count(content in (new, OLD.read_bytes() if number % 2 else b""), "a broken file")
    return tally


def concurrent_builds(count: int, random: np.random.Generator, folder: Path) -> Tally:
    """Run two builds of different cubes to one path: both succeed, and one of the two cubes remains."""
    tally, path = Tally("two builds at once"), folder / "cube.uplift"
    complete = set()
    for model in ("moments", "sigmoid"):
        _build(path, model).wait()
        complete.add(path.read_bytes())
    for _ in range(count):
        builds = [_build(path, model) for model in ("moments", "sigmoid")]
        intact = [build.wait() for build in builds] == [0, 0] and path.read_bytes() in complete
        tally.count(intact and os.listdir(folder) == [path.name], "a broken or a temporary file")
    return tally


def builds_in_threads(count: int, random: np.random.Generator, folder: Path) -> Tally:
    """Build in several threads of one process: equal options give equal cubes, and BLAS gets its threads back."""
    tally, dims = Tally("builds in threads"), (3, 4, 5)
    alone = {dim: digest(_quiet_build(dim).data) for dim in dims}
    before = _blas_threads()
    for _ in range(count):
        chosen = random.choice(dims, size=BUILDS).tolist()
        with ThreadPoolExecutor(BUILDS) as pool:
            found = [digest(cube.data) for cube in pool.map(_quiet_build, chosen)]
        for dim, each in zip(chosen, found, strict=True):
            tally.count(each == alone[dim], "other bytes")
        tally.count(_blas_threads() == before, "another number of BLAS threads")
    return tally


def _quiet_build(dim: int) -> uplift.Cube:
    return uplift.build(dim=dim, coefficients=5)


def _blas_threads() -> list[int]:
    return sorted(each["num_threads"] for each in threadpool_info() if each["user_api"] == "blas")


def full_disk(count: int, random: np.random.Generator, folder: Path) -> Tally:
    """Save to disks without space, simulated by a limit of file sizes and, for root, a small tmpfs."""
    tally = Tally("disk full")
    limit = f"resource.setrlimit(resource.RLIMIT_FSIZE, ({DISK_BYTES}, {DISK_BYTES}))"
    with _small_disk(folder) as disk:
        for place, setup in ((folder, limit), (disk, "")):
            if place is not None:
                _save_without_space(tally, place / "cube.uplift", count, setup)
    return tally


def _save_without_space(tally: Tally, path: Path, count: int, setup: str) -> None:
    for number in range(count):
        old = b"old" * (number % 2)
        path.write_bytes(old)
        stderr = _save(path, OLD, setup)
        intact = path.read_bytes() == old
        temporary = [name for name in os.listdir(path.parent) if name.endswith(".part")]
        tally.count(
            stderr == "output\n" and intact and not temporary,
            f"no error, a broken file, or a temporary file: {stderr[-80:]}",
        )


@contextmanager
def _small_disk(folder: Path) -> Iterator[Path | None]:
    """Mount a tmpfs; None without the permission."""
    disk = folder / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", f"size={DISK_BYTES}", "tmpfs", str(disk)]
    mounted = shutil.which("mount") and not subprocess.run(mount, capture_output=True).returncode
    try:
        yield disk if mounted else None
    finally:
        if mounted:
            subprocess.run(["umount", str(disk)], check=True)


def no_permission(count: int, random: np.random.Generator, folder: Path) -> Tally:
    """Save to a folder without write permission."""
    tally, path = Tally("read-only folder"), folder / "closed" / "cube.uplift"
    path.parent.mkdir()
    path.write_bytes(b"old")
    path.parent.chmod(0o555)
    folder.chmod(0o755)
    drop_privileges = f"import safetensors.numpy; os.setuid({NOBODY})" if os.geteuid() == 0 else ""
    for _ in range(count):
        stderr = _save(path, OLD, drop_privileges)
        intact = path.read_bytes() == b"old"
        tally.count(stderr == "output\n" and intact, f"no error, or a broken file: {stderr[-80:]}")
    path.parent.chmod(0o755)
    return tally


def _save(path: Path, cube: Path, setup: str) -> str:
    """Save a cube in a process that runs ``setup`` first; return its standard error, the code of an `UpliftError`."""
    code = SAVE_ONCE.format(setup=setup)
    return subprocess.run(
        [sys.executable, "-c", code, path, cube], capture_output=True, text=True, cwd=ROOT, check=False
    ).stderr


def _build(path: Path, model: str = "moments") -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "uplift_cli", "build", "-q", "--force", "--dim", "16", "--model", model]
    return subprocess.Popen([*command, "-o", path])
