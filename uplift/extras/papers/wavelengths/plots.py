"""Figure of a choice of wavelengths: each light with its powers, and the weights."""

from collections.abc import Callable

import numpy as np

from uplift.colorimetry.gamut import SRGB, map_to_gamut
from uplift.common.arrays import Array, StrPath
from uplift.common.text import pluralise
from uplift.extras.colour.srgb import hex_codes
from uplift.extras.pages.figure import GREY, write_figure
from uplift.extras.pages.marks import line, whiskers
from uplift.extras.pages.panels import Axis, Dot, Panel, draw
from uplift.extras.papers.wavelengths.choice import Choice
from uplift.extras.papers.wavelengths.sampling import (
    RenderSetup,
    Sampling,
    interp_curves,
)
from uplift.extras.report.comparison import mean_p95_max

SIZE = (7.2, 1.7)
"""Inches of a panel."""
_X = Axis("wavelength / nm")
CHANNEL_COLOURS = {"X": "#c0392b", "Y": "#2e8b57", "Z": "#2f5fb3"}


def plot_choice(
    setup: RenderSetup, choice: Choice, path: StrPath, *, force: bool = False
) -> None:
    """Write a figure with a panel per light, showing its powers, and a panel of the
    weights. Raises `OutputError`.
    """
    sampling = choice.sampling
    nm = setup.wavelengths
    chosen = sampling.wavelengths

    def area(values: Array) -> Array:
        """Sum of the interpolated values of samples: per wavelength and per sample,
        units differ.
        """
        return np.interp(nm, chosen, values).sum()

    panels = []
    tints = _display_colours(setup, chosen)
    for name, power, powers in zip(
        sampling.lights, setup.powers, sampling.powers, strict=True
    ):
        curve = power * (area(powers) / power.sum())
        marks = [
            line(nm, curve, "", GREY, linewidth=0.7),
            whiskers(chosen, powers, np.zeros_like(powers), powers),
        ]
        dots = [
            Dot(x, y, colour=tint)
            for x, y, tint in zip(chosen, powers, tints, strict=True)
        ]
        highest = 1.3 * max(powers.max(), np.quantile(curve, 0.97))
        panels.append(Panel(marks, name, _X, Axis("power", limits=(0, highest)), dots))
    panels.append(_weights_panel(setup, sampling, area))
    mean, p95, largest = mean_p95_max(choice.errors).values()
    measures = f"mean {mean:.2f}, 95th percentile {p95:.2f}, max {largest:.2f}"
    chosen_text = pluralise(len(sampling), "wavelength")
    title = f"{chosen_text}, {choice.method}: ΔE00 {measures}"
    write_figure(draw(panels, size=SIZE, title=title, share="x"), path, force=force)


def _weights_panel(
    setup: RenderSetup, sampling: Sampling, area: Callable[[Array], Array]
) -> Panel:
    """Return the weights of the samples, and the colour-matching functions."""
    cmfs = setup.cmfs * (area(sampling.to_xyz[:, 1]) / setup.cmfs[:, 1].sum())
    marks = []
    for cmf, weights, (name, colour) in zip(
        cmfs.T, sampling.to_xyz.T, CHANNEL_COLOURS.items(), strict=True
    ):
        marks += [
            line(setup.wavelengths, cmf, "", colour, linewidth=0.7, alpha=0.5),
            line(
                sampling.wavelengths,
                weights,
                f"to {name}",
                colour,
                marker="o",
                markersize=4,
                linestyle="",
            ),
        ]
    title = "weights and colour-matching functions"
    return Panel(marks, title, _X, Axis("weight"), legend="upper right")


def _display_colours(setup: RenderSetup, wavelengths: Array) -> list[str]:
    """Codes ``#rrggbb`` (n,) of monochromatic light, mapped to the gamut of sRGB."""
    xyz = interp_curves(wavelengths, setup.wavelengths, setup.cmfs.T).T
    rgb = map_to_gamut(xyz @ np.linalg.inv(SRGB.rgb_to_xyz).T, SRGB, "scale").rgb + 1e-3
    return hex_codes(rgb / rgb.max(axis=1, keepdims=True))
