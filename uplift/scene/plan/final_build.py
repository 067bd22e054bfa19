"""Build of the planned cube: all cells, or only those of the textures if that saves enough."""

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

MIN_SAVING = 1e6
"""Bytes that a sparse cube must save, as it cannot answer other colours."""


@dataclass(frozen=True, eq=False)
class FinalBuild:
    """The planned cube and its cost.

    Parameters
    ----------
    cube : Cube
        The cube.
    size : int
        Bytes of its file.
    seconds : float
        CPU time of the build.
    full_size, sparse_size : float
        Bytes with all cells, and with those of the textures alone.
    """

    cube: Cube
    size: int
    seconds: float
    full_size: float
    sparse_size: float

    @property
    def is_sparse(self) -> bool:
        """Whether the cube has only the cells of the textures."""
        return self.cube.data.complete_cells is not None

    @property
    def points(self) -> int:
        """Number of lattice points."""
        return int(self.cube.data.points.present.sum())


def build_final(context: PlanContext, options: Mapping[str, Any]) -> FinalBuild:
    """Build the cube with the warnings of `uplift.build`."""
    scene = context.scene
    cube, seconds = _timed_build(context, options, Images(scene.textures, scene.encoding))
    sparse_size = _file_size(cube)
    full_size = sparse_size * cube.data.lattice.size / int(cube.data.points.present.sum())
    if full_size - sparse_size >= MIN_SAVING:
        return FinalBuild(cube, sparse_size, seconds, full_size, sparse_size)
    with quiet_warnings():  # the sparse build has issued all of them
        cube, seconds = _timed_build(context, options)
    size = _file_size(cube)
    return FinalBuild(cube, size, seconds, size, sparse_size)


def _timed_build(context: PlanContext, options: Mapping[str, Any], scene: Images | None = None) -> tuple[Cube, float]:
    begin = time.process_time()
    cube = build(context.atlas, scene=scene, **options)
    return cube, time.process_time() - begin


def _file_size(cube: Cube) -> int:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cube.uplift"
        cube.save(path)
        return path.stat().st_size
