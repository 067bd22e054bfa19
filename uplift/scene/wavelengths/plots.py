"""Figure of a choice of wavelengths: each light with its powers, and the weights."""

from typing import Any

import numpy as np

from uplift.colorimetry.gamut import SRGB, map_to_gamut
from uplift.colorimetry.srgb import encode
from uplift.common.arrays import Array, StrPath
from uplift.scene.wavelengths import Choice
from uplift.scene.wavelengths.sampling import RenderSetup, interp_curves
from uplift.viz.figure import GREY, INK, new_figure, style_axes, styled, write_figure

WIDTH, PANEL_HEIGHT, MARGIN_HEIGHT = 7.2, 1.55, 0.9
"""Inches: width of the figure, height of a panel, height above and below all panels."""
CHANNEL_COLOURS = {"X": "#c0392b", "Y": "#2e8b57", "Z": "#2f5fb3"}


def plot_choice(setup: RenderSetup, choice: Choice, path: StrPath, *, force: bool = False) -> None:
    """Write a figure with a panel per light, showing its powers, and a panel of the weights. Raises `OutputError`."""
    sampling, errors = choice.sampling, choice.errors
    with styled():
        figure = new_figure(WIDTH, MARGIN_HEIGHT + PANEL_HEIGHT * (len(sampling.lights) + 1))
        panels = figure.subplots(len(sampling.lights) + 1, 1, sharex=True, squeeze=False)[:, 0]
        for light, axes in enumerate(panels[:-1]):
            _draw_light(axes, setup, choice, light)
        _draw_weights(panels[-1], setup, choice)
        figure.align_ylabels()
        figure.suptitle(
            f"{len(sampling)} wavelengths, {choice.method}: ΔE00 mean {errors.mean:.2f}, "
            f"95th percentile {errors.p95:.2f}, max {errors.max:.2f}",
            x=0.02,
            ha="left",
            fontsize=10,
            color=INK,
        )
        write_figure(figure, path, force=force)


def _draw_light(axes: Any, setup: RenderSetup, choice: Choice, light: int) -> None:
    sampling = choice.sampling
    power, powers = setup.powers[light], sampling.powers[light]
    # Powers per wavelength and per sample have different units: scale to equal means.
    interpolated = np.interp(setup.wavelengths, sampling.wavelengths, powers)
    scale = interpolated.sum() / power.sum()
    axes.plot(setup.wavelengths, power * scale, color=GREY, linewidth=0.7)
    axes.vlines(sampling.wavelengths, 0, powers, color=INK, linewidth=1)
    tints = _display_colours(setup, sampling.wavelengths)
    axes.scatter(sampling.wavelengths, powers, s=26, c=tints, edgecolors=INK, zorder=3, clip_on=False)
    axes.set(ylim=(0, 1.3 * max(powers.max(), np.quantile(power * scale, 0.97))), ylabel="power")
    axes.set_title(sampling.lights[light], loc="left", fontsize=9, color=INK)
    style_axes(axes)


def _draw_weights(axes: Any, setup: RenderSetup, choice: Choice) -> None:
    sampling = choice.sampling
    total = np.interp(setup.wavelengths, sampling.wavelengths, sampling.to_xyz[:, 1]).sum()
    cmfs = setup.cmfs * (total / setup.cmfs[:, 1].sum())
    for cmf, weights, (name, colour) in zip(cmfs.T, sampling.to_xyz.T, CHANNEL_COLOURS.items(), strict=True):
        axes.plot(setup.wavelengths, cmf, color=colour, linewidth=0.7, alpha=0.5)
        axes.plot(sampling.wavelengths, weights, "o", color=colour, markersize=4, label=f"to {name}")
    axes.set(xlabel="wavelength / nm", ylabel="weight", xlim=(setup.wavelengths[0], setup.wavelengths[-1]))
    axes.set_title("weights and colour-matching functions", loc="left", fontsize=9, color=INK)
    axes.legend(frameon=False, ncols=3, loc="upper right")
    style_axes(axes)


def _display_colours(setup: RenderSetup, wavelengths: Array) -> Array:
    """sRGB (n, 3) of monochromatic light, mapped to the gamut."""
    xyz = interp_curves(wavelengths, setup.wavelengths, setup.cmfs.T).T
    rgb = map_to_gamut(xyz @ np.linalg.inv(SRGB.rgb_to_xyz).T, SRGB, "scale").rgb + 1e-3
    return encode(rgb / rgb.max(axis=1, keepdims=True))
