"""The charts side by side: a row a light, a column a way to uplift."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from benchmarks.render.chart import Layout
from uplift.colorimetry.gamut import SRGB
from uplift.colorimetry.observer import sensor
from uplift.colorimetry.srgb import to_display_codes
from uplift.common.arrays import Array
from uplift.viz.figure import new_figure, write_png

INSET = 0.3
"""Share of a patch's width to each side of the truth in its middle."""
WIDTH, HEIGHT = 10.5, 7.6


def draw(
    images: Mapping[tuple[str, str], Array],
    captions: Mapping[tuple[str, str], str],
    lights: Sequence[str],
    ways: Sequence[str],
    layout: Layout,
    path: Path,
) -> None:
    """Write XYZ ``images`` by light and way, the first way being the truth, which each other shows in its patches.

    Every light's white is taken to the screen's by Bradford adaptation.
    """
    figure = new_figure(WIDTH, HEIGHT)
    grid = figure.subplots(len(lights), len(ways), squeeze=False)
    truth = ways[0]
    for row, light in enumerate(lights):
        to_screen = sensor(illuminant=light).xyz_to_rgb.T
        for column, way in enumerate(ways):
            axes, image = grid[row, column], images[light, way].copy()
            for place in layout.patches(round(INSET * layout.patch)):
                image[place] = images[light, truth][place]
            axes.imshow(
                to_display_codes(_binned(image) @ to_screen, SRGB).astype(np.uint8), interpolation="nearest"
            )
            axes.set_xticks([])
            axes.set_yticks([])
            axes.spines[:].set_visible(False)
            axes.set_xlabel(captions[light, way], fontsize=9, color="0.3")
            if row == 0:
                axes.set_title(way, fontsize=11, pad=8)
            if column == 0:
                axes.set_ylabel(light, fontsize=11, labelpad=8)
    write_png(figure, path, force=True)


def _binned(image: Array) -> Array:
    """Four pixels as one, for half the noise."""
    height, width, count = image.shape
    return np.asarray(image.reshape(height // 2, 2, width // 2, 2, count).mean(axis=(1, 3)))
