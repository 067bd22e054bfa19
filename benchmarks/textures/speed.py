"""Processes on images of several sizes: pixels per second and peak memory."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.processes import UPLIFT
from benchmarks.textures.pictures import pictures
from benchmarks.timing import process

FEW = ("--wavelengths", "400:700:10")
JOBS: tuple[tuple[int, tuple[str, ...], int], ...] = (
    (2048, (), 3),
    (2048, ("--representation", "moments"), 3),
    (2048, ("--representation", "multipliers"), 1),
    (4096, FEW, 1),
    (8192, FEW, 1),
    (8192, ("--representation", "moments"), 1),
)
"""Size, options, runs."""


def measure(cube: str) -> list[dict[str, Any]]:
    """Time the processes, one after the other."""
    return [_time(cube, *job) for job in JOBS]


def _time(cube: str, size: int, options: tuple[str, ...], runs: int) -> dict[str, Any]:
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder) / "in.png", Path(folder) / "out.exr"
        _write(source, size)
        command = [UPLIFT, "texture", str(source), "-o", str(target), "--cube", cube, "--force", *options]
        wall, megabytes = process(command, runs)
        return {
            "options": " ".join(options) or "none: spectra at 81 wavelengths",
            "size": size,
            "megapixels": size**2 / 1e6,
            "seconds": wall,
            "rate": size**2 / wall.median / 1e6,
            "written_mb": target.stat().st_size / 1e6,
            "peak_mb": megabytes,
        }


def _write(path: Path, size: int) -> None:
    """Write a photograph tiled to size² pixels as 8-bit PNG, with noise so that the tiles do not compress."""
    import OpenImageIO
    from PIL import Image

    photo = np.asarray(Image.open(next(iter(pictures())).path).convert("RGB"), dtype=int)
    rng, height = np.random.default_rng(0), photo.shape[0]
    tiled = np.tile(photo, (1, size // photo.shape[1], 1))
    image = OpenImageIO.ImageOutput.create("png")
    if image is None or not image.open(str(path), OpenImageIO.ImageSpec(size, size, 3, "uint8")):
        raise RuntimeError(OpenImageIO.geterror())
    for first in range(0, size, height):
        noisy = np.clip(tiled + rng.integers(-3, 4, tiled.shape), 0, 255).astype(np.uint8)
        image.write_scanlines(first, first + height, 0, noisy)
    image.close()
