"""The rendered charts: one row per light, one column per method."""

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
"""Margin around the reference square in the middle of a patch, as a share of its width."""
WIDTH, HEIGHT = 10.5, 7.6


def draw(
    images: Mapping[tuple[str, str], Array],
    captions: Mapping[tuple[str, str], str],
    lights: Sequence[str],
    methods: Sequence[str],
    layout: Layout,
    path: Path,
    size: tuple[float, float] = (WIDTH, HEIGHT),
) -> None:
    """Draw XYZ ``images`` by light and method; the first method is the reference, shown inside the patches of all.

    The white of each light is adapted to the white of the screen (Bradford).
    """
    figure = new_figure(*size)
    grid = figure.subplots(len(lights), len(methods), squeeze=False)
    reference = methods[0]
    for row, light in enumerate(lights):
        to_screen = sensor(illuminant=light).xyz_to_rgb.T
        for column, method in enumerate(methods):
            axes, image = grid[row, column], images[light, method].copy()
            for place in layout.patches(round(INSET * layout.patch)):
                image[place] = images[light, reference][place]
            axes.imshow(to_display_codes(binned(image) @ to_screen, SRGB).astype(np.uint8), interpolation="nearest")
            axes.set_xticks([])
            axes.set_yticks([])
            axes.spines[:].set_visible(False)
            axes.set_xlabel(captions[light, method], fontsize=9, color="0.3")
            if row == 0:
                axes.set_title(method, fontsize=11, pad=8)
            if column == 0:
                axes.set_ylabel(light, fontsize=11, labelpad=8)
    write_png(figure, path, force=True)


def binned(image: Array) -> Array:
    """Average blocks of 2 × 2 pixels, which halves the noise."""
    height, width, count = image.shape
    return np.asarray(image.reshape(height // 2, 2, width // 2, 2, count).mean(axis=(1, 3)))
