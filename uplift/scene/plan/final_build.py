"""The cube of a plan built in earnest: whole, or the textures' cells alone where that saves notably."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from uplift.io.scene_colours import Images
from uplift.lookup import Cube
from uplift.pipeline import build
from uplift.scene.plan.context import Bench, silent

WORTH = 1e6
"""Bytes that cells alone must save: they answer no other colours."""


@dataclass(frozen=True, eq=False)
class Built:
    """A cube, bytes of its file, CPU seconds it took; ``whole`` and ``sparse`` are the bytes of either choice."""

    cube: Cube
    size: int
    seconds: float
    whole: float
    sparse: float

    @property
    def is_sparse(self) -> bool:
        return self.cube.data.complete_cells is not None

    @property
    def points(self) -> int:
        return int(self.cube.data.points.present.sum())


def built(bench: Bench, options: Mapping[str, Any]) -> Built:
    """Warns of what a build warns of."""
    brief = bench.brief
    cube, seconds = _timed(bench, options, scene=Images(brief.textures, brief.encoding))
    size = _size(cube)
    whole = size * cube.data.lattice.size / int(cube.data.points.present.sum())
    if whole - size < WORTH:
        return _whole(bench, options, size)
    return Built(cube, size, seconds, whole, size)


def _whole(bench: Bench, options: Mapping[str, Any], sparse: int) -> Built:
    with silent():  # all has been said by the build before
        cube, seconds = _timed(bench, options)
    size = _size(cube)
    return Built(cube, size, seconds, size, sparse)


def _timed(bench: Bench, options: Mapping[str, Any], scene: Images | None = None) -> tuple[Cube, float]:
    begin = time.process_time()
    cube = build(bench.atlas, scene=scene, **options)
    return cube, time.process_time() - begin


def _size(cube: Cube) -> int:
    """Bytes of its file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cube.uplift"
        cube.save(path)
        return path.stat().st_size
