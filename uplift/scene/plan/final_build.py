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
from uplift.scene.plan.context import PlanContext, quiet_warnings

WORTH = 1e6
"""Bytes that cells alone must save: they answer no other colours."""


@dataclass(frozen=True, eq=False)
class FinalBuild:
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


def build_final(context: PlanContext, options: Mapping[str, Any]) -> FinalBuild:
    """Warns of what a build warns of."""
    scene = context.scene
    cube, seconds = _timed(context, options, scene=Images(scene.textures, scene.encoding))
    size = _size(cube)
    whole = size * cube.data.lattice.size / int(cube.data.points.present.sum())
    if whole - size < WORTH:
        return _whole(context, options, size)
    return FinalBuild(cube, size, seconds, whole, size)


def _whole(context: PlanContext, options: Mapping[str, Any], sparse: int) -> FinalBuild:
    with quiet_warnings():  # all has been said by the build before
        cube, seconds = _timed(context, options)
    size = _size(cube)
    return FinalBuild(cube, size, seconds, size, sparse)


def _timed(
    context: PlanContext, options: Mapping[str, Any], scene: Images | None = None
) -> tuple[Cube, float]:
    begin = time.process_time()
    cube = build(context.atlas, scene=scene, **options)
    return cube, time.process_time() - begin


def _size(cube: Cube) -> int:
    """Bytes of its file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cube.uplift"
        cube.save(path)
        return path.stat().st_size
