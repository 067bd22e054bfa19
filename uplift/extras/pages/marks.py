"""Marks of a panel: lines with their uncertainty, references, distributions, densities,
pictures and maps of errors.

A mark is a function that draws on axes of matplotlib. Keyword arguments that a mark
does not name are properties of matplotlib's artists.
"""

from collections.abc import Callable, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from uplift.common.arrays import Array
from uplift.extras.pages.figure import (
    ACCENT,
    GREY,
    HIGHLIGHT,
    INK,
    PALE,
    colour_map,
    figure_text,
    style_axes,
)

Mark = Callable[[Any], None]
DASHED = (0, (3, 2))
BINS = 40
"""Bins of x for maximum and median."""


def line(
    x: ArrayLike,
    y: ArrayLike,
    label: str = "",
    colour: Any = INK,
    *,
    band: tuple[ArrayLike, ArrayLike] | None = None,
    **style: Any,
) -> Mark:
    """Draw y over x, with a band between the lower and upper ends of uncertainty."""

    def draw(axes: Any) -> None:
        style_axes(axes)
        if band is not None:
            axes.fill_between(x, *band, color=colour, alpha=0.2, linewidth=0)
        axes.plot(x, y, color=colour, label=figure_text(label), **style)

    return draw


def outline(
    corners: ArrayLike, label: str = "", colour: Any = INK, **style: Any
) -> Mark:
    """Draw the edge of the region with corners (n, 2)."""

    def draw(axes: Any) -> None:
        style_axes(axes)
        edge = {"facecolor": "none", "edgecolor": colour, "linewidth": 1.0, **style}
        axes.fill(*np.transpose(corners), label=figure_text(label), **edge)

    return draw


def whiskers(
    x: ArrayLike, y: ArrayLike, low: ArrayLike, high: ArrayLike, colour: Any = INK
) -> Mark:
    """Draw points with lines from their lower to their upper ends of uncertainty."""

    def draw(axes: Any) -> None:
        style_axes(axes)
        axes.vlines(x, low, high, color=colour, linewidth=1)
        axes.plot(x, y, "o", color=colour, markersize=4, zorder=1.5)

    return draw


def threshold(
    value: float,
    text: str = "",
    axis: Literal["x", "y"] = "y",
    colour: str = GREY,
) -> Mark:
    """Draw a dashed line across the panel at a value of y or x, with its meaning at the
    right end of that of y.
    """

    def draw(axes: Any) -> None:
        cross = axes.axhline if axis == "y" else axes.axvline
        cross(value, color=colour, linewidth=0.8, linestyle=DASHED, zorder=1)
        axes.annotate(
            figure_text(text),
            (0.99, value),
            xycoords=axes.get_yaxis_transform(),
            xytext=(0, -3),
            textcoords="offset points",
            ha="right",
            va="top",
            color=colour,
        )

    return draw


def shade(low: float, high: float) -> Mark:
    """Shade the values of y between two."""
    return lambda axes: axes.axhspan(
        low, high, color=PALE, alpha=0.45, linewidth=0, zorder=0
    )


def histogram(counts: ArrayLike, edges: ArrayLike, colour: str = ACCENT) -> Mark:
    """Draw counts (B,) as bars between edges (B + 1,)."""

    def draw(axes: Any) -> None:
        axes.stairs(counts, edges, fill=True, color=colour)
        axes.spines[["top", "right"]].set_visible(False)
        axes.set_axisbelow(True)

    return draw


def boxes(quantiles: Sequence[Sequence[float]], colours: Sequence[str]) -> Mark:
    """Draw distributions below one another at y = 0, 1, … by their lower ends,
    quartiles, medians, quartiles and upper ends (n, 5).
    """

    def draw(axes: Any) -> None:
        style_axes(axes)
        axes.yaxis.grid(visible=False)
        for row, (values, colour) in enumerate(zip(quantiles, colours, strict=True)):
            low, first, median, third, high = values
            axes.hlines(row, low, high, color=colour, linewidth=1)
            axes.barh(row, third - first, left=first, height=0.62, color=colour)
            axes.vlines(median, row - 0.31, row + 0.31, color="white", linewidth=1.4)

    return draw


def density(x: Array, y: Array, lowest: float, highest: float) -> list[Mark]:
    """Draw the density of points on a logarithmic axis of y, darker where there are
    more, and the maximum and the median of y over x. Points at ``lowest`` count, but
    are not drawn.
    """
    drawn = y > lowest
    right = x[drawn].max(initial=0.1)
    bins: dict[str, Any] = {"yscale": "log", "bins": "log", "gridsize": (60, 34)}
    bins["extent"] = (0, right, np.log10(lowest), np.log10(highest))

    def draw(axes: Any) -> None:
        style_axes(axes)
        style: dict[str, Any] = {"cmap": colour_map(), "linewidths": 0, "mincnt": 1}
        axes.hexbin(x[drawn], y[drawn], **bins, **style)

    edges = np.linspace(0, right, BINS + 1)
    bin_of = np.digitize(x, edges[1:-1])
    used = np.unique(bin_of)
    centres = (edges[1:] + edges[:-1])[used] / 2
    members = [y[bin_of == row] for row in used]
    largest = list(map(np.max, members))
    medians = list(map(np.median, members))
    return [
        draw,
        line(centres, largest, "maximum", HIGHLIGHT),
        line(centres, medians, "median"),
    ]


def picture(codes: NDArray[Any], **options: Any) -> Mark:
    """Draw a picture (H, W, 3) of 8-bit codes, or of codes in [0, 1], without a frame.

    ``aspect="auto"`` stretches it over the panel.
    """

    def draw(axes: Any) -> None:
        _remove_frame(axes)
        axes.imshow(codes, **{"interpolation": "nearest", **options})

    return draw


def patches(codes: NDArray[Any]) -> Mark:
    """Draw colours (H, W, 3) as even patches that fill the panel, with an edge, so that
    white is visible on white.
    """

    def draw(axes: Any) -> None:
        picture(codes, aspect="auto")(axes)
        axes.spines[:].set(visible=True, color=PALE, linewidth=0.6)

    return draw


def region(
    values: NDArray[Any],
    limits: Array,
    corners: ArrayLike,
    edge: str = "none",
    **style: Any,
) -> Mark:
    """Draw values (H, W) or colours (H, W, 3), the first row at the bottom, over limits
    (2, 2) of x and y, within corners (n, 2).
    """

    def draw(axes: Any) -> None:
        (border,) = axes.fill(*np.transpose(corners), facecolor="none", edgecolor=edge)
        place: dict[str, Any] = {"extent": limits.ravel(), "origin": "lower"}
        image = axes.imshow(values, zorder=0.6, **place, **style)
        image.set_clip_path(border)

    return draw


def error_map(
    values: Array,
    largest: float,
    *,
    lowest: float = 0.0,
    exponent: float = 1.0,
    over: str = "",
) -> Mark:
    """Draw a map (H, W) of ΔE00 or another error: white at ``lowest``, dark at
    ``largest``, and beyond it of the colour ``over``, if any.

    Scales from 0 have an exponent; below 1 it spreads small values. Others are
    logarithmic. NaN is grey.
    """

    def draw(axes: Any) -> None:
        from matplotlib.colors import LogNorm, PowerNorm

        _remove_frame(axes)
        norm = PowerNorm(exponent, 0, largest)
        if lowest:
            norm = LogNorm(lowest, largest)
        colours = colour_map()
        if over:
            colours = colours.with_extremes(over=over)
        axes.imshow(values, cmap=colours, norm=norm, interpolation="nearest")
        axes.set_facecolor(PALE)

    return draw


def _remove_frame(axes: Any) -> None:
    axes.set(xticks=(), yticks=())
    axes.spines[:].set_visible(False)
