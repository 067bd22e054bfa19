"""Readers attacked block by block, writers one by one, in processes of their own and folders that go with them."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from tests.fuzz import atlas_table, atlas_text, cube_bytes, cube_forged, palette_spec, scene_spec, writers
from tests.fuzz.attack import Tally, attack
from tests.fuzz.target import ROOT

TARGETS = {
    target.name: target
    for target in (
        *(module.TARGET for module in (atlas_text, atlas_table, cube_bytes, cube_forged, palette_spec)),
        scene_spec.SCENE_FILES,
        scene_spec.PLANS,
    )
}
Writers = Callable[[int, np.random.Generator, Path], Tally]
WRITERS: tuple[tuple[Writers, int], ...] = (
    (writers.killed_savers, 2),
    (writers.killed_builds, 1),
    (writers.builds_at_once, 4),
    (writers.full_disks, 6),
    (writers.no_permission, 6),
)
"""And of how many inputs of ``--writers`` each gets one."""
KEPT = ROOT / "out" / "hostile"


def read(seed: int, name: str, inputs: range) -> Tally:
    """Attack a reader."""
    with tempfile.TemporaryDirectory(dir=_memory()) as folder:
        return attack(TARGETS[name], seed, inputs, Path(folder), KEPT)


def write(target: Writers, count: int, seed: int) -> Tally:
    """Attack a writer."""
    with tempfile.TemporaryDirectory() as folder:
        return target(count, np.random.default_rng(seed), Path(folder))


def add(total: Tally, part: Tally) -> None:
    """Count what came of some inputs with the others."""
    total.inputs += part.inputs
    total.taken += part.taken
    total.refused += part.refused
    total.failures += part.failures


def _memory() -> str | None:
    """A disk in memory, where there is one: readers are tried, not disks."""
    return "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
