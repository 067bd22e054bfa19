"""The ColorChecker: measured spectra, painted RGB, and the layout of the patches."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from benchmarks.record import ROOT
from uplift.atlas import on_grid, read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array

MACBETH = ROOT / "atlases" / "macbeth.txt"
COLUMNS, ROWS = 6, 4
BACKGROUND = 0.03
"""Reflectance between the patches."""


@dataclass(frozen=True, eq=False)
class Chart:
    """24 patches: ``measured`` (24, N) reflectances at ``wavelengths`` (N,) nm, ``painted`` (24, 3) linear sRGB.

    ``outside`` (24,) marks the colours outside sRGB, which are painted clipped.
    """

    names: tuple[str, ...]
    wavelengths: Array
    measured: Array
    painted: Array
    outside: Array


def chart() -> Chart:
    """Read the shipped ColorChecker."""
    sensor: Sensor = observer.sensor()
    spectra = read_atlas(MACBETH)
    measured = on_grid(spectra, sensor.wavelengths)
    rgb = sensor.rgb(measured)
    return Chart(spectra.names, sensor.wavelengths, measured, np.clip(rgb, 0, 1), ~sensor.contains(rgb))


@dataclass(frozen=True)
class Layout:
    """Patches of ``patch`` pixels with ``gap`` between and around them, in reading order."""

    patch: int
    gap: int

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture."""
        pitch = self.patch + self.gap
        return COLUMNS * pitch + self.gap, ROWS * pitch + self.gap

    def corners(self) -> Iterator[tuple[int, int]]:
        """Yield the top left pixel (x, y) of each patch."""
        pitch = self.patch + self.gap
        for row in range(ROWS):
            for column in range(COLUMNS):
                yield self.gap + column * pitch, self.gap + row * pitch

    def patches(self, inset: int = 0) -> Iterator[tuple[slice, slice]]:
        """Yield the rows and columns of each patch, without ``inset`` pixels along its edges."""
        for x, y in self.corners():
            yield (
                slice(y + inset, y + self.patch - inset),
                slice(x + inset, x + self.patch - inset),
            )

    def means(self, image: Array) -> Array:
        """(24, K) mean of each patch in an image (height, width, K)."""
        return np.array([image[place].mean(axis=(0, 1)) for place in self.patches()])
