"""All fuzz targets by name."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from tests.fuzz import commands, cubes, images, texts
from tests.fuzz.campaign import ROOT, Tally, fuzz

READERS = {target.name: target for module in (texts, cubes, images) for target in module.TARGETS}
COMMANDS = {target.name: target for target in commands.TARGETS}
KEPT = ROOT / "out" / "fuzz"
"""Folder of inputs that failed."""


def fuzz_target(seed: int, name: str, inputs: range) -> Tally:
    """Run a target with numbered inputs, in a folder in memory if there is one."""
    memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    with tempfile.TemporaryDirectory(dir=memory) as folder:
        return fuzz((READERS | COMMANDS)[name], seed, inputs, Path(folder), KEPT)
