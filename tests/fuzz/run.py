"""Registry of all targets, and functions that run them in temporary folders."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from tests.fuzz import (
    atlas_instruments,
    atlas_table,
    atlas_text,
    build_options,
    chart_table,
    colour_table,
    cube_bytes,
    cube_metadata,
    cube_valid_digest,
    hostile_text,
    image,
    input_kinds,
    last_net,
    option_numbers,
    palette_spec,
    places,
    same_file,
    scene_spec,
    signalled,
    writers,
)
from tests.fuzz.campaign import Tally, fuzz
from tests.fuzz.target import ROOT

MODULES = (
    atlas_text,
    atlas_table,
    atlas_instruments,
    cube_bytes,
    cube_valid_digest,
    cube_metadata,
    palette_spec,
    chart_table,
    colour_table,
    build_options,
    option_numbers,
    input_kinds,
    image,
)
TARGETS = {
    target.name: target
    for target in (
        *(module.TARGET for module in MODULES),
        scene_spec.SCENE_FILES,
        scene_spec.PLANS,
    )
}
"""Readers by name."""
COMMANDS = {module.TARGET.name: module.TARGET for module in (hostile_text, places, same_file, last_net)}
"""Targets that run the command line, by name."""
WriterTest = Callable[[int, np.random.Generator, Path], Tally]
WRITERS: dict[str, tuple[WriterTest, int]] = {
    "SIGKILL while saving": (writers.kill_saves, 2),
    "SIGKILL while building": (writers.kill_builds, 1),
    "two builds at once": (writers.concurrent_builds, 4),
    "builds in threads": (writers.builds_in_threads, 1),
    "disk full": (writers.full_disk, 6),
    "read-only folder": (writers.no_permission, 6),
    "signals to 'texture' on two processes": (signalled.end_textures, 1),
    "signals to 'build'": (signalled.end_builds, 1),
}
"""Tests of writers by name, each with a divisor of the number of runs."""
KEPT = ROOT / "out" / "fuzz"
"""Folder of inputs that failed."""


def fuzz_target(seed: int, name: str, inputs: range) -> Tally:
    """Fuzz a reader or the command line."""
    with tempfile.TemporaryDirectory(dir=_memory_folder()) as folder:
        return fuzz((TARGETS | COMMANDS)[name], seed, inputs, Path(folder), KEPT)


def stress_writer(test: WriterTest, count: int, seed: int) -> Tally:
    """Run the test of a writer ``count`` times."""
    with tempfile.TemporaryDirectory() as folder:
        return test(count, np.random.default_rng(seed), Path(folder))


def _memory_folder() -> str | None:
    """Folder in memory, if there is one, as the test of readers does not need a disk."""
    return "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
