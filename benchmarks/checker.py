"""The ColorChecker: measured spectra and painted RGB, and pictures of it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks import MACBETH
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.gamut import SRGB
from uplift.colorimetry.sensor import in_unit_cube
from uplift.common.arrays import Array
from uplift.extras.colour.srgb import to_display_codes
from uplift.extras.pages.marks import Mark, picture
from uplift.extras.pages.panels import Panel

COLUMNS = 6
ROWS = 4
BACKGROUND = 0.03
"""Reflectance between the patches."""
Place = tuple[slice, slice]
"""Rows and columns of a part of a picture."""


@dataclass(frozen=True, eq=False)
class Chart:
    """24 patches: ``measured`` (24, N) reflectances at ``wavelengths`` (N,) nm,
    ``painted`` (24, 3) linear sRGB.

    ``outside`` (24,) marks the colours outside sRGB, which are painted clipped.
    """

    wavelengths: Array
    measured: Array
    painted: Array
    outside: Array


def chart() -> Chart:
    """Read the shipped ColorChecker."""
    sensor = observer.sensor()
    measured = on_grid(read_atlas(MACBETH), sensor.wavelengths)
    rgb = sensor.rgb(measured)
    painted = np.clip(rgb, 0, 1)
    outside = ~in_unit_cube(rgb)
    return Chart(sensor.wavelengths, measured, painted, outside)


@dataclass(frozen=True)
class Layout:
    """Patches of ``patch`` pixels in reading order, ``gap`` between and around them."""

    patch: int
    gap: int

    @property
    def pitch(self) -> int:
        """Distance from a patch to the next."""
        return self.patch + self.gap

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture."""
        return COLUMNS * self.pitch + self.gap, ROWS * self.pitch + self.gap

    def corners(self) -> Iterator[tuple[int, int]]:
        """Yield the top left pixel (x, y) of each patch."""
        for row, column in np.ndindex(ROWS, COLUMNS):
            yield self.gap + column * self.pitch, self.gap + row * self.pitch

    def patches(self, inset: int = 0) -> Iterator[Place]:
        """Yield the rows and columns of each patch, ``inset`` pixels from its edges."""
        for corner in self.corners():
            columns, rows = (
                slice(start + inset, start + self.patch - inset) for start in corner
            )
            yield rows, columns

    def middles(self) -> list[Place]:
        """Return the rows and columns of a square in the middle of each patch."""
        return list(self.patches(round(0.3 * self.patch)))

    def halves(self) -> list[Place]:
        """Return the rows and columns of the left half of each patch."""
        width = self.patch // 2
        return [
            (rows, slice(columns.start, columns.start + width))
            for rows, columns in self.patches()
        ]

    def paint(self, colours: Array, background: Array) -> Array:
        """Return an image (height, width, 3) of patches (24, 3) on a background."""
        width, height = self.size
        image = np.tile(background, (height, width, 1))
        for place, colour in zip(self.patches(), colours, strict=True):
            image[place] = colour
        return image


LAYOUT = Layout(patch=32, gap=4)
"""Of pictures of the chart."""


def chart_panel(rgb: Array, title: str, marks: Sequence[Mark] = ()) -> Panel:
    """Show patches (24, 3) in linear sRGB on the background, below marks."""
    image = LAYOUT.paint(np.clip(rgb, 0, 1), np.full(3, BACKGROUND))
    return Panel([photo(image), *marks], title)


def photo(rgb: Array) -> Mark:
    """Draw linear sRGB (height, width, 3), a pixel a sample, white to white."""
    return picture(to_display_codes(rgb, SRGB).astype(np.uint8))
