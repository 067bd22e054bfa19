"""A choice of wavelengths as a picture: each light with its powers, and the weights."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import SRGB, map_to_gamut
from uplift.colorimetry.srgb import encode
from uplift.common.arrays import Array
from uplift.scene.wavelengths import Choice, RenderSetup
from uplift.scene.wavelengths.setup import interp_curves
from uplift.viz.figure import GREY, INK, STYLE, new_figure, style_axes, write_png

WIDTH, PANEL, HEAD = 7.2, 1.55, 0.9
"""Inches: of the picture, of a panel's height, of what is above and below."""
CHANNELS = {"X": "#c0392b", "Y": "#2e8b57", "Z": "#2f5fb3"}


def plot_choice(
    setting: RenderSetup, choice: Choice, path: str | os.PathLike[str], *, force: bool = False
) -> None:
    """Draw every light with its powers at the wavelengths, and the weights to XYZ, as PNG. Raises `OutputError`."""
    import matplotlib

    sampling = choice.sampling
    with matplotlib.rc_context(STYLE):
        figure = new_figure(WIDTH, HEAD + PANEL * (len(sampling.lights) + 1))
        panels = figure.subplots(len(sampling.lights) + 1, 1, sharex=True, squeeze=False)[:, 0]
        for light, axes in enumerate(panels[:-1]):
            _draw_light(axes, setting, choice, light)
        _draw_weights(panels[-1], setting, choice)
        figure.align_ylabels()
        errors = choice.errors
        figure.suptitle(
            f"{len(sampling)} wavelengths, {choice.method}: ΔE00 mean {errors.mean:.2f}, "
            f"95 % under {errors.p95:.2f}, max {errors.max:.2f}",
            x=0.02,
            ha="left",
            fontsize=10,
            color=INK,
        )
        write_png(figure, path, force=force)


def _draw_light(axes: Any, setting: RenderSetup, choice: Choice, light: int) -> None:
    sampling = choice.sampling
    power, powers = setting.powers[light], sampling.powers[light]
    # Both as shares of their mean over the wavelengths, for the two are in different units.
    inside = np.interp(setting.wavelengths, sampling.wavelengths, powers)
    scale = inside.sum() / power.sum()
    axes.plot(setting.wavelengths, power * scale, color=GREY, linewidth=0.7)
    axes.vlines(sampling.wavelengths, 0, powers, color=INK, linewidth=1)
    tints = _tints(setting, sampling.wavelengths)
    axes.scatter(sampling.wavelengths, powers, s=26, c=tints, edgecolors=INK, zorder=3, clip_on=False)
    axes.set(ylim=(0, 1.3 * max(powers.max(), np.quantile(power * scale, 0.97))), ylabel="power")
    axes.set_title(sampling.lights[light], loc="left", fontsize=9, color=INK)
    style_axes(axes)


def _draw_weights(axes: Any, setting: RenderSetup, choice: Choice) -> None:
    sampling = choice.sampling
    spread = np.interp(setting.wavelengths, sampling.wavelengths, sampling.to_xyz[:, 1]).sum()
    curves = setting.cmfs * (spread / setting.cmfs[:, 1].sum())
    for curve, weights, (name, colour) in zip(curves.T, sampling.to_xyz.T, CHANNELS.items(), strict=True):
        axes.plot(setting.wavelengths, curve, color=colour, linewidth=0.7, alpha=0.5)
        axes.plot(sampling.wavelengths, weights, "o", color=colour, markersize=4, label=f"to {name}")
    axes.set(
        xlabel="wavelength / nm", ylabel="weight", xlim=(setting.wavelengths[0], setting.wavelengths[-1])
    )
    axes.set_title("weights, on the matching functions", loc="left", fontsize=9, color=INK)
    axes.legend(frameon=False, ncols=3, loc="upper right")
    style_axes(axes)


def _tints(setting: RenderSetup, wavelengths: Array) -> Array:
    """(n, 3) how the wavelengths look, as far as sRGB can show."""
    xyz = interp_curves(wavelengths, setting.wavelengths, setting.cmfs.T).T
    rgb = map_to_gamut(xyz @ np.linalg.inv(SRGB.rgb_to_xyz).T, SRGB, "scale").rgb + 1e-3
    return encode(rgb / rgb.max(axis=1, keepdims=True))
