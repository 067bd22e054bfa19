"""The charts under each environment: one row per sky, one column per method."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.render.chart import Layout
from benchmarks.render.picture import INSET, binned
from uplift.colorimetry.gamut import SRGB, conversion
from uplift.colorimetry.srgb import to_display_codes
from uplift.common.arrays import Array
from uplift.viz.figure import new_figure, write_png


@dataclass(frozen=True, eq=False)
class _White:
    """XYZ relative to a white, as a gamut: Bradford adaptation takes (1, 1, 1) to the white of the screen."""

    rgb_to_xyz: Array


def draw(
    images: Mapping[tuple[str, str], Array],
    whites: Mapping[str, Array],
    delta_e: Mapping[tuple[str, str], Array],
    methods: Sequence[str],
    layout: Layout,
    path: Path,
) -> None:
    """Draw XYZ images by sky and method; the first method is the truth, shown inside the patches of all."""
    figure = new_figure(12.5, 2.6 * len(whites))
    grid = figure.subplots(len(whites), len(methods), squeeze=False)
    for row, (sky, white) in enumerate(whites.items()):
        to_screen = conversion(_White(np.diag(white / white[1])), SRGB) / white
        for column, method in enumerate(methods):
            axes, image = grid[row, column], images[sky, method].copy()
            for place in layout.patches(round(INSET * layout.patch)):
                image[place] = images[sky, methods[0]][place]
            axes.imshow(to_display_codes(binned(image) @ to_screen.T, SRGB).astype(np.uint8), interpolation="nearest")
            axes.set_xticks([])
            axes.set_yticks([])
            axes.spines[:].set_visible(False)
            if column:
                errors = delta_e[sky, method]
                caption = f"mean ΔE00 {errors.mean():.2f}, worst {errors.max():.1f}"
                axes.set_xlabel(caption, fontsize=9, color="0.3")
            else:
                axes.set_ylabel(sky, fontsize=11, labelpad=8)
            if row == 0:
                axes.set_title(method, fontsize=11, pad=8)
    write_png(figure, path, force=True)
