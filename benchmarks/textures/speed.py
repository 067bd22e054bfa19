"""Whole processes on images of several sizes: pixels per second, and memory that does not grow."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.page import table
from benchmarks.processes import UPLIFT
from benchmarks.textures.pictures import pictures
from benchmarks.timing import process
from uplift.lab.timing import Spread

FEW = ("--wavelengths", "400:700:10")
JOBS: tuple[tuple[int, tuple[str, ...], int], ...] = (
    (2048, (), 3),
    (2048, ("--store", "moments"), 3),
    (2048, ("--store", "multipliers"), 1),
    (4096, FEW, 1),
    (8192, FEW, 1),
    (8192, ("--store", "moments"), 1),
)
"""Size, options, runs."""


@dataclass(frozen=True)
class TextureTiming:
    """Wall seconds and peak memory (MB) of a process that uplifts size² pixels, and the bytes that it writes."""

    size: int
    options: tuple[str, ...]
    wall: Spread
    megabytes: float
    written: int


def section(cube: str) -> str:
    return _table([_time(cube, *job) for job in JOBS])


def _time(cube: str, size: int, options: tuple[str, ...], runs: int) -> TextureTiming:
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder) / "in.png", Path(folder) / "out.exr"
        _write(source, size)
        command = [UPLIFT, "texture", str(source), str(target), "--cube", cube, "--force", *options]
        wall, megabytes = process(command, runs)
        return TextureTiming(size, options, wall, megabytes, target.stat().st_size)


def _write(path: Path, size: int) -> None:
    """A photograph tiled to size² pixels as 8-bit PNG, with noise, or compression would find the tiles."""
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


def _table(timings: list[TextureTiming]) -> str:
    return table(
        "Pixels per second, and memory",
        "`uplift texture` as a process, start and compilation included, on a photograph tiled and with noise added, "
        "8-bit PNG. An image is read, uplifted and written a band of rows at a time: memory is that of the program, "
        "of the cube's tables and of some bands, whatever the height. Machines differ and are shared: compare rows.",
        ["options", "image", "million pixels", "seconds", "million pixels/s", "written MB", "peak memory MB"],
        [
            [
                " ".join(timing.options) or "none: spectra at 81 wavelengths",
                f"{timing.size}²",
                f"{timing.size**2 / 1e6:.1f}",
                f"{timing.wall:.1f}",
                f"{timing.size**2 / timing.wall.median / 1e6:.2f}",
                f"{timing.written / 1e6:,.0f}",
                f"{timing.megabytes:,.0f}",
            ]
            for timing in timings
        ],
    )
