"""How samples of spectra of one colour spread, compared with materials that were left
out, for docs/guides/gradients.md.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

import uplift
from benchmarks import ATLASES, DOCS, Row, record
from uplift.atlas import read_atlas, resample
from uplift.colorimetry import delta_e_spectra, in_unit_cube, observer
from uplift.colorimetry.gamut import SRGB
from uplift.common.arrays import Array
from uplift.extras.colour.srgb import to_display_codes
from uplift.extras.pages.figure import (
    INK,
    new_figure,
    show_image,
    style_spectrum_axes,
    styled,
    write_png,
)
from uplift.extras.photographs import SpectrumSampler, photograph, prepare_samples
from uplift.lab.timing import time_calls
from uplift.lookup import Cube
from uplift.lookup.errors_under_lights import evidence

LIGHTS = ("A", "FL2", "FL11", "LED-B3", "HP1")
LEVELS = (0.68, 0.95)
SETS = ("rawtoaces", "cie2017", "pmc")
DIM = 16
COUNT = 400
"""Samples of each material."""
SEED = 1
DRAWN = {"brown": (0.30, 0.14, 0.07), "green": (0.12, 0.27, 0.09)}
"""Colours of the picture, linear sRGB."""
SHOWN = 24
"""Samples of each in the picture."""
TIMED = 10_000
RUNS = 3


@dataclass(frozen=True, eq=False)
class Spread:
    """Materials, the answers to their colours, and samples of these."""

    around: Array
    """(M, N)."""
    samples: Array
    """(M, n, N)."""
    measured: Array
    """(M, N)."""

    def under(self, name: str) -> Row:
        """Return mean ΔE00 of materials and samples from the answers under a light, and
        the percentage of materials within that of samples.
        """
        light = observer.light(name)
        count = self.samples.shape[1]
        means = np.repeat(self.around, count, axis=0)
        spread = delta_e_spectra(light, self.samples.reshape(means.shape), means)
        spread = spread.reshape(-1, count)
        radii = np.quantile(spread, LEVELS, axis=1).T
        error = delta_e_spectra(light, self.around, self.measured)
        within = 100 * (error[:, None] <= radii).mean(axis=0)
        return {
            "light": name,
            "materials": error.mean(),
            "samples": spread.mean(),
            "within_68": within[0],
            "within_95": within[1],
        }

    def overall(self) -> Row:
        """Return the means over all lights."""
        rows = [self.under(name) for name in LIGHTS]
        means = {}
        for name in ("materials", "samples", "within_68", "within_95"):
            means[name] = np.mean([row[name] for row in rows])
        return means


def left_out(cube: Cube) -> Spread:
    """The materials from which a cube learns, each without its family."""
    known = evidence(cube.data)
    sampler = prepare_samples(cube)
    measured = np.asarray(known.measured, dtype=float)
    rgb = np.clip(cube.data.sensor.rgb(measured), 0, 1)
    around = np.clip(np.asarray(known.left_out, dtype=float), 0, 1)
    covariance = sampler.metamers.left_out_covariance(known.family)
    random = np.random.default_rng(SEED)
    at = cube.wavelengths
    samples = sampler.draw(around, rgb, covariance, COUNT, random, at)
    return Spread(around, samples, measured)


def other_half(name: str) -> Spread:
    """Every second entry of a set, answered by a cube of the others."""
    atlas = read_atlas(ATLASES / f"{name}.txt")
    cube = uplift.build(atlas[::2], dim=DIM, leave_out=[name])
    sensor = cube.data.sensor
    measured = resample(atlas[1::2], sensor.wavelengths).values
    rgb = sensor.rgb(measured)
    inside = in_unit_cube(rgb)
    rgb = np.clip(rgb[inside], 0, 1)
    samples = prepare_samples(cube)(rgb, COUNT, SEED)
    return Spread(cube.reflectance(rgb), samples, measured[inside])


def draw(sampler: SpectrumSampler) -> None:
    """Draw spectra of two colours, and their colours under lights."""
    sensor = sampler.cube.data.sensor
    matrices = [sensor.matrix]
    matrices += [photograph(sensor, name).matrix for name in LIGHTS]
    with styled():
        figure = new_figure(9.6, 4.4)
        for row, (name, rgb) in zip(
            figure.subplots(len(DRAWN), 2), DRAWN.items(), strict=True
        ):
            spectra = sampler(rgb, SHOWN, SEED)
            draw_spectra(row[0], name, sampler.cube, rgb, spectra)
            colours = np.stack([spectra @ matrix.T for matrix in matrices])
            codes = to_display_codes(np.clip(colours, 0, 1), SRGB).astype(np.uint8)
            show_image(row[1], codes, interpolation="nearest", aspect="auto")
            lights = (sensor.illuminant, *LIGHTS)
            row[1].set_yticks(range(len(lights)), lights)
            row[1].tick_params(length=0)
        figure.set_dpi(150)
        write_png(figure, DOCS / "samples" / "samples.png", force=True)


def draw_spectra(axes: Any, name: str, cube: Cube, rgb: Any, spectra: Array) -> None:
    """Draw samples in the colour that they have, and the answer of the cube."""
    colour = to_display_codes(rgb, SRGB) / 255
    at = cube.wavelengths
    axes.plot(at, spectra.T, color=colour, linewidth=0.7, alpha=0.6)
    axes.plot(at, cube.reflectance(rgb), color=INK, linewidth=1.6)
    style_spectrum_axes(axes)
    axes.set_title(f"one {name}", loc="left", fontsize=9, color=INK)


def main() -> None:
    """Draw, measure and store."""
    cube = uplift.load()
    sampler = prepare_samples(cube)
    draw(sampler)
    rgb = np.random.default_rng(SEED).random((TIMED, 3))
    wall, _ = time_calls(lambda: sampler(rgb, 1, SEED), RUNS)
    packaged = left_out(cube)
    rows = [{"cube": "packaged", "count": len(packaged.measured)} | packaged.overall()]
    for name in SETS:
        spread = other_half(name)
        rows.append({"cube": name, "count": len(spread.measured)} | spread.overall())
    record(
        "samples",
        lights=LIGHTS,
        samples=COUNT,
        sets=rows,
        by_light=[packaged.under(name) for name in LIGHTS],
        spectra_s=wall.scaled(1 / TIMED),
    )
