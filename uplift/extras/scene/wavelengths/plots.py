"""Figure of a choice of wavelengths: each light with its powers, and the weights."""

import numpy as np

from uplift.colorimetry.gamut import SRGB, map_to_gamut
from uplift.common.arrays import Array, StrPath
from uplift.common.text import pluralise
from uplift.extras.colour.srgb import encode
from uplift.extras.pages.figure import (
    GREY,
    INK,
    new_figure,
    style_axes,
    styled,
    write_figure,
)
from uplift.extras.scene.wavelengths import Choice
from uplift.extras.scene.wavelengths.sampling import (
    RenderSetup,
    interp_curves,
    statistics,
)

WIDTH = 7.2
"""Width of the figure in inches."""
PANEL_HEIGHT = 1.55
"""Height of a panel in inches."""
MARGIN_HEIGHT = 0.9
"""Height above and below all panels in inches."""
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

    with styled():
        count = len(sampling.lights) + 1
        figure = new_figure(WIDTH, MARGIN_HEIGHT + PANEL_HEIGHT * count)
        *panels, last = figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]
        tints = _display_colours(setup, chosen)
        for axes, name, power, powers in zip(
            panels, sampling.lights, setup.powers, sampling.powers, strict=True
        ):
            curve = power * (area(powers) / power.sum())
            axes.plot(nm, curve, color=GREY, linewidth=0.7)
            axes.vlines(chosen, 0, powers, color=INK, linewidth=1)
            axes.scatter(
                chosen, powers, s=26, c=tints, edgecolors=INK, zorder=3, clip_on=False
            )
            axes.set(
                ylim=(0, 1.3 * max(powers.max(), np.quantile(curve, 0.97))),
                ylabel="power",
            )
            axes.set_title(name, loc="left", fontsize=9, color=INK)
        cmfs = setup.cmfs * (area(sampling.to_xyz[:, 1]) / setup.cmfs[:, 1].sum())
        for cmf, weights, (name, colour) in zip(
            cmfs.T, sampling.to_xyz.T, CHANNEL_COLOURS.items(), strict=True
        ):
            last.plot(nm, cmf, color=colour, linewidth=0.7, alpha=0.5)
            last.plot(
                chosen, weights, "o", color=colour, markersize=4, label=f"to {name}"
            )
        last.set(xlabel="wavelength / nm", ylabel="weight", xlim=(nm[0], nm[-1]))
        last.set_title(
            "weights and colour-matching functions", loc="left", fontsize=9, color=INK
        )
        last.legend(frameon=False, ncols=3, loc="upper right")
        for axes in (*panels, last):
            style_axes(axes)
        figure.align_ylabels()
        mean, p95, largest = statistics(choice.errors).values()
        measures = f"mean {mean:.2f}, 95th percentile {p95:.2f}, max {largest:.2f}"
        chosen_text = pluralise(len(sampling), "wavelength")
        title = f"{chosen_text}, {choice.method}: ΔE00 {measures}"
        figure.suptitle(title, x=0.02, ha="left", fontsize=10, color=INK)
        write_figure(figure, path, force=force)


def _display_colours(setup: RenderSetup, wavelengths: Array) -> Array:
    """sRGB (n, 3) of monochromatic light, mapped to the gamut."""
    xyz = interp_curves(wavelengths, setup.wavelengths, setup.cmfs.T).T
    rgb = map_to_gamut(xyz @ np.linalg.inv(SRGB.rgb_to_xyz).T, SRGB, "scale").rgb + 1e-3
    return encode(rgb / rgb.max(axis=1, keepdims=True))
