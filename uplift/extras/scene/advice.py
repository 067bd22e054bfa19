"""Swatches whose measurement would lower the errors of a scene most, by the standard
errors of a cube.

The square of a standard error is a part that the measurement of a material lowers and a
rest (docs/mathematics.md, 7). The first is supposed to fall as the posterior variance
of the kriging does. Swatches are chosen one after the other, each of the largest gain.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from uplift.colorimetry.delta_e import rgb_to_lab
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array, Values, blocks, distances
from uplift.common.errors import OptionError
from uplift.common.machine import single_threaded_blas
from uplift.extras.colour.srgb import to_display_codes
from uplift.extras.pages.figure import ACCENT
from uplift.extras.pages.marks import Mark, error_map, picture
from uplift.extras.pages.panels import Axis, Panel, draw
from uplift.extras.texture.scene_colours import (
    BINS,
    Images,
    PixelSample,
    bin_index,
    no_pixels,
)
from uplift.fit.kriging import DEFAULT, Kernel, posterior
from uplift.lookup.cube import Cube
from uplift.lookup.errors_under_lights import light_errors

STEPS = (1, 2, 4, 8)
"""Bins along each channel that are joined; the first that leave few colours are taken.
"""
MAX_COLOURS = 2048
BLOCK_ROWS = 256
"""Swatches whose gains are computed at a time."""
MAX_SWATCHES = 100
ALIKE = 1.0
"""Distance in L*a*b* of pixels that have the colour of a swatch, for a plot."""
TINY = 1e-9
"""Variance, relative to that of an unknown material, below which nothing is left to
measure.
"""


def colour_areas(images: Images, sensor: Sensor) -> PixelSample:
    """Average the visible pixels of images in bins of encoded RGB. Raises
    `TextureError`, `ColourError` and `OptionError`.
    """
    sums = np.zeros((4, BINS**3))
    for path in images.paths:
        for rgb, _ in images.blocks(path, sensor):
            index = bin_index(sensor, rgb)
            sums += [np.bincount(index, values, BINS**3) for values in (*rgb.T, None)]
    if not sums.any():
        raise no_pixels()
    for step in STEPS:
        size = BINS // step
        totals = (
            sums.reshape(4, size, step, size, step, size, step)
            .sum(axis=(2, 4, 6))
            .reshape(4, -1)
        )
        occupied = totals[:, totals[3] > 0]
        if occupied.shape[1] <= MAX_COLOURS:
            break
    return PixelSample(
        np.clip(occupied[:3] / occupied[3], 0, 1).T, occupied[3] / occupied[3].sum()
    )


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """Standard errors of n colours of some area (n,) under L lights, √(c ``unknown`` +
    ``floor``).

    c is the diagonal of the posterior ``covariance`` (n, n) of kriging, the others are
    squares of ΔE00 (n, L).
    """

    area: Array
    covariance: Array
    unknown: Array
    floor: Array

    @property
    def errors(self) -> Array:
        """Standard errors (n, L)."""
        return self._errors(np.diag(self.covariance))

    @property
    def mean(self) -> float:
        """Mean error over the area and the lights."""
        return float(self.errors.mean(axis=-1) @ self.area)

    def by_light(self) -> list[dict[str, float]]:
        """Return the mean error under each light, and the error that 95 % of the area
        stays within.
        """
        p95 = np.quantile(
            self.errors, 0.95, axis=0, weights=self.area, method="inverted_cdf"
        )
        pairs = zip((self.area @ self.errors).tolist(), p95.tolist(), strict=True)
        return [{"mean": mean, "p95": bound} for mean, bound in pairs]

    def gains(self) -> Array:
        """Return by how much the measurement of each colour (n,) lowers the
        mean error.
        """
        variance = np.diag(self.covariance)
        errors = np.empty(len(variance))
        for rows in blocks(len(errors), BLOCK_ROWS):
            # c(x) − c(x, s)² / c(s)
            known = (
                self.covariance[rows] ** 2 / np.maximum(variance[rows], TINY)[:, None]
            )
            errors[rows] = self._errors(variance - known).mean(axis=-1) @ self.area
        return np.maximum(self.mean - errors, 0)

    def measured(self, colour: int) -> "Uncertainty":
        """Return what remains once a colour, by its number, is measured."""
        row = self.covariance[colour]
        return replace(
            self,
            covariance=self.covariance - np.outer(row, row / max(row[colour], TINY)),
        )

    def _errors(self, variance: Array) -> Array:
        return np.sqrt(np.maximum(variance, 0)[..., None] * self.unknown + self.floor)


@single_threaded_blas()
def uncertainty(
    cube: Cube, colours: PixelSample, lights: Sequence[Light]
) -> Uncertainty:
    """Return the errors of a cube at the colours of a scene. Raises `OptionError` if it
    has no left-out entries.
    """
    data = cube.data
    prior = cube.data.provenance.get("prior", {})
    known = {name: prior[name] for name in Kernel._fields if name in prior}
    kernel = DEFAULT._replace(**known)
    errors = [light_errors(data, light) for light in lights]
    squares = np.stack(
        [estimate(colours.rgb)[:, 0] ** 2 for estimate in errors], axis=1
    )
    floors = np.concatenate(
        [
            estimate.expected.radii[0] ** 2 * estimate.expected.floor
            for estimate in errors
        ]
    )
    floor = np.minimum(floors, squares)
    covariance = posterior(kernel, data.entry_lab, rgb_to_lab(data.sensor, colours.rgb))
    variance = np.maximum(np.diag(covariance), TINY)
    return Uncertainty(
        colours.share, covariance, (squares - floor) / variance[:, None], floor
    )


@dataclass(frozen=True)
class Swatch:
    """A colour to measure, by its number in the scene.

    ``area`` is the share of the pixels that have the colour, and ``share`` of those
    that are like it: the measurement halves what is unknown of them, or more. ``error``
    is the mean standard error of the colour before anything is measured, ``gain`` the
    amount by which the mean error of the scene falls, and ``mean_after`` what remains.
    """

    colour: int
    area: float
    share: float
    error: float
    gain: float
    mean_after: float


@single_threaded_blas()
def advise(scene: Uncertainty, count: int) -> tuple[list[Swatch], Uncertainty]:
    """Choose up to ``count`` swatches, the best first, and return what remains. Those
    without a gain are left out.
    """
    if not 1 <= count <= MAX_SWATCHES:
        raise OptionError(f"count must be in [1, {MAX_SWATCHES}], got {count}")
    chosen = list[Swatch]()
    errors = scene.errors.mean(axis=1)
    for _ in range(count):
        gains = scene.gains()
        best = int(gains.argmax())
        if not gains[best] > 0:
            break
        unknown = np.diag(scene.covariance)
        scene = scene.measured(best)
        is_like = np.diag(scene.covariance) <= unknown / 2
        chosen.append(
            Swatch(
                best,
                float(scene.area[best]),
                float(scene.area[is_like].sum()),
                float(errors[best]),
                float(gains[best]),
                scene.mean,
            )
        )
    return chosen, scene


def _mean_errors(
    cube: Cube, colours: Mapping[str, Array], lights: Sequence[Light]
) -> dict[str, Array]:
    """Standard errors (n,) of linear RGB (n, 3) by name, averaged over the lights."""
    estimates = [light_errors(cube.data, light) for light in lights]
    means = {}
    for name, rgb in colours.items():
        errors = [estimate(rgb)[:, 0] for estimate in estimates]
        means[name] = np.mean(errors, axis=0)
    return means


def draw_advice(
    cube: Cube,
    pictures: Mapping[str, Values],
    lights: Sequence[Light],
    swatches: Sequence[tuple[str, Array]],
) -> Any:
    """Draw images, linear RGB (height, width, 3) by path, their mean standard errors,
    and numbered swatches.

    The swatches are linear RGB (3,) and the text below each. Their numbers stand at the
    pixels of the nearest colours.
    """
    sensor = cube.data.sensor
    flat = {name: rgb.reshape(-1, 3).astype(float) for name, rgb in pictures.items()}
    maps = _mean_errors(cube, flat, lights)
    largest = max(float(np.quantile(errors, 0.99)) for errors in maps.values())
    names = ", ".join(light.name for light in lights)
    title = f"expected ΔE00 to the measurement\naveraged over {names}"
    numbers = _numbers(sensor, pictures, [rgb for _, rgb in swatches])
    panels: list[Panel | None] = []
    for name, rgb in pictures.items():
        shown = [picture(to_display_codes(rgb, sensor) / 255), *numbers[name]]
        errors = error_map(maps[name].reshape(rgb.shape[:2]), largest)
        panels += [
            Panel(shown, Path(name).name),
            Panel([errors], title),
            None,
        ]
    if swatches:
        panels[2] = _swatches_panel(sensor, swatches)
    return draw(panels, 3, 3.2)


def _swatches_panel(sensor: Sensor, swatches: Sequence[tuple[str, Array]]) -> Panel:
    """Return the numbered swatches below one another, with their texts."""
    texts = [f"{row}   {text}" for row, (text, _) in enumerate(swatches, start=1)]
    rgb = np.array([[rgb] for _, rgb in swatches])
    codes = to_display_codes(rgb, sensor) / 255
    return Panel(
        [picture(codes, aspect="auto")],
        "swatches lower the mean by",
        y=Axis(names=texts),
    )


def _numbers(
    sensor: Sensor, pictures: Mapping[str, Values], swatches: Sequence[Array]
) -> dict[str, list[Mark]]:
    """Return the numbers of swatches by image, at pixels of the nearest colours."""
    labs = {}
    for name, rgb in pictures.items():
        labs[name] = rgb_to_lab(sensor, rgb.reshape(-1, 3).astype(float))
    numbers: dict[str, list[Mark]] = {name: [] for name in pictures}
    for number, rgb in enumerate(swatches, start=1):
        away = {}
        for name, lab in labs.items():
            away[name] = distances(lab, rgb_to_lab(sensor, rgb[None]))[:, 0]
        name = min(away, key=lambda name: away[name].min())
        like = np.flatnonzero(away[name] <= away[name].min() + ALIKE)
        y, x = divmod(int(like[len(like) // 2]), pictures[name].shape[1])
        numbers[name].append(_number(x, y, number))
    return numbers


def _number(x: int, y: int, number: int) -> Mark:
    box = {"boxstyle": "circle", "facecolor": "white", "edgecolor": ACCENT}
    middle: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 7}
    return lambda axes: axes.text(x, y, str(number), bbox=box, **middle)
