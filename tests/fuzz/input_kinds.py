"""Fuzz target: inputs that are not regular files, for every reader."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path

from tests.fuzz.mutate import Random
from tests.fuzz.target import ROOT, Target
from uplift.atlas import read_atlas
from uplift.design.palette.spec import read_palette
from uplift.lab.chart.table import read_chart
from uplift.lookup import load
from uplift.scene.plan import read_plan, read_scene_file

READERS: tuple[Callable[[Path], object], ...] = (
    read_atlas, load, read_plan, read_scene_file, read_chart, read_palette,
)  # fmt: skip
FILES = tuple(
    str(ROOT / name)
    for name in (
        "atlases/macbeth.txt",
        "cubes/moments-8.uplift",
        "uplift/lab/chart/measured.csv",
        "pyproject.toml",
    )
)
DEVICES = (
    "/dev/zero",
    "/dev/null",
    "/dev/full",
    "/dev/stdin",
    "/dev/tty",
    "/proc/kmsg",
    "/proc/self/mem",
    "/proc/self/environ",
)
NAMES = ("", ".", "..", "a\0b", "x" * 300, "x/" * 3000, "\udcff", "\n", "\x1b[2J", "\u202e")
KINDS = ("file", "link to a file", "device", "pipe", "folder", "name", "loop", "empty", "link to a device")


def _generate(random: Random, path: Path) -> None:
    reader, kind = random.integers(len(READERS)), KINDS[random.integers(len(KINDS))]
    path.write_text(f"{reader}\t{kind}\t{random.integers(100)}", encoding="utf-8")


def _make(folder: Path, kind: str, number: int) -> Path:
    path, device = folder / "case", DEVICES[number % len(DEVICES)]
    if kind in ("file", "link to a file"):
        source = FILES[number % len(FILES)]
        path.symlink_to(source) if kind != "file" else shutil.copy(source, path)
    elif kind == "device":
        return Path(device)
    elif kind == "link to a device":
        path.symlink_to(device)
    elif kind == "pipe":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
    elif kind == "loop":
        path.symlink_to(path)
    elif kind == "empty":
        path.touch()
    else:
        return Path(folder, NAMES[number % len(NAMES)])
    return path


def _use(path: Path) -> None:
    reader, kind, number = path.read_text(encoding="utf-8").split("\t")
    with tempfile.TemporaryDirectory(dir=path.parent) as folder:
        READERS[int(reader)](_make(Path(folder), kind, int(number)))


TARGET = Target("kinds of input files", _generate, _use)
