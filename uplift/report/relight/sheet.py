"""Relit images as one figure: a row per light, a column per method, and a map of the differences."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from uplift.common.arrays import StrPath
from uplift.report.relight.relight import RGB_PRODUCT, Difference, Relit, Rendering
from uplift.viz.figure import GREY, INK, colour_map, figure_text, new_figure, write_figure

PANEL = 3.4
"""Width of a panel in inches."""
DPI = 140
LABELS = 0.3
"""Height in inches of the texts of a row."""


def write_relit_sheet(relit: Sequence[Relit], path: StrPath, *, force: bool = False) -> None:
    """Write relit images as one figure: PNG, SVG or PDF, by the suffix of its file."""
    rows = [(image, rendering) for image in relit for rendering in image.renderings]
    columns = len(relit[0].methods) + 1
    heights = [_aspect(rendering) * PANEL + LABELS for _, rendering in rows]
    figure = new_figure(columns * (PANEL + 0.06) + 0.5, sum(heights) + 0.35)
    figure.set_dpi(DPI)
    figure.get_layout_engine().set(w_pad=0.03, h_pad=0.03, wspace=0, hspace=0)
    grid = figure.subplots(len(rows), columns, squeeze=False, height_ratios=heights)
    for axes, (image, rendering) in zip(grid, rows, strict=True):
        _draw_row(figure, axes, image, rendering)
    for axes, title in zip(grid[0], (*relit[0].methods, "ΔE00, first to last"), strict=True):
        axes.set_title(figure_text(title), fontsize=11, color=INK, pad=6)
    write_figure(figure, path, force=force)


def _aspect(rendering: Rendering) -> float:
    height, width, _ = rendering.colours[RGB_PRODUCT].shape
    return height / width


def _draw_row(figure: Any, axes: Sequence[Any], image: Relit, rendering: Rendering) -> None:
    from matplotlib.ticker import MaxNLocator

    for each, method in zip(axes, image.methods, strict=False):
        each.imshow(rendering.screen_codes(method), interpolation="antialiased")
        if method != RGB_PRODUCT:
            each.set_xlabel(_caption(rendering.difference(RGB_PRODUCT, method)), fontsize=9, color=GREY)
    difference = rendering.difference(RGB_PRODUCT, image.methods[-1])
    drawn = axes[-1].imshow(difference.delta_e, cmap=colour_map(), vmin=0, vmax=rendering.map_limit)
    bar = figure.colorbar(drawn, ax=axes[-1], fraction=0.04, pad=0.02, extend="max")
    bar.outline.set_visible(False)
    bar.locator = MaxNLocator(4, integer=True)
    axes[0].set_ylabel(rendering.light_label, fontsize=11, color=INK, labelpad=6)
    axes[0].set_xlabel(figure_text(image.name), fontsize=9, color=GREY)
    for each in axes:
        each.set(xticks=(), yticks=())
        each.spines[:].set_visible(False)


def _caption(difference: Difference) -> str:
    return f"ΔE00 from RGB × light: mean {difference.mean:.1f}, 95 % {difference.p95:.1f}"
