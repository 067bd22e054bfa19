"""A ColorChecker in photographs, which states exposure, balance and noise."""

from dataclasses import dataclass
from itertools import product

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000, delta_e_spectra, rgb_to_lab
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.extras.photographs.answers import Photographs
from uplift.extras.photographs.fit import DARKEST, fit_noise
from uplift.extras.photographs.photograph import Noise

COLUMNS, ROWS = 6, 4
"""Patches of a ColorChecker, from dark skin at the top left to black at the bottom
right.
"""
MIDDLE = 0.25
"""Half the width of the part of a patch that is sampled, in patches."""
POINTS = 15
"""Points that are sampled along each side of it."""
MAX_MISMATCH = 16.0
"""Mean ΔE00 of patches, at their exposure and balance, up to which corners are those of
the chart. Right ones of cameras that mix channels strongly have 10, and the most alike
of turned and mirrored ones 22.
"""
CORNERS_HINT = "give the corners clockwise from dark skin: X,Y,X,Y,X,Y,X,Y in pixels"
REPORTED = ("A", "FL11", "HP1")
"""Lights under which answers to patches are compared with their measurements."""


@dataclass(frozen=True, eq=False)
class Patches:
    """Linear RGB (24, 3) of the patches in a photograph, and their variances (24, 3),
    NaN where unknown.
    """

    mean: Array
    variance: Array


@dataclass(frozen=True, eq=False)
class Calibration:
    """What a chart states of L further photographs and the first one.

    ``gains`` (L, 3) are their values relative to those that are expected on the scale
    of the first photograph, whose ``exposure`` is relative to reflectance.
    """

    exposure: float
    gains: Array
    noise: Noise


def patch_points(corners: Array) -> Array:
    """Pixel coordinates x, y (24, n, 2) of points in the patches of a chart whose
    corners (4, 2) are clockwise from dark skin.
    """
    x = np.arange(COLUMNS) + 0.5
    y = np.arange(ROWS) + 0.5
    centres = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 1, 2)
    steps = np.linspace(-MIDDLE, MIDDLE, POINTS)
    offsets = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(1, -1, 2)
    places = (centres + offsets) / (COLUMNS, ROWS)
    homogeneous = np.append(places, np.ones((*places.shape[:-1], 1)), axis=-1)
    projected = homogeneous @ homography(corners).T
    return projected[..., :2] / projected[..., 2:]


def corner_orders(corners: Array) -> list[Array]:
    """Return corners (4, 2) in all orders: as given, turned, and mirrored."""
    mirrored = corners[::-1]
    pairs = product((corners, mirrored), range(4))
    return [np.roll(order, -first, axis=0) for order, first in pairs]


def homography(corners: Array) -> Array:
    """Matrix (3, 3) of the perspective that takes the unit square to corners (4, 2),
    clockwise from (0, 0).

    Hartley & Zisserman 2004, "Multiple view geometry in computer vision", 4.1. Raises
    `OptionError` for corners on a line.
    """
    rows = []
    for (u, v), (x, y) in zip(((0, 0), (1, 0), (1, 1), (0, 1)), corners, strict=True):
        rows.append([u, v, 1, 0, 0, 0, -x * u, -x * v])
        rows.append([0, 0, 0, u, v, 1, -y * u, -y * v])
    matrix = np.array(rows)
    if np.linalg.cond(matrix) > 1e12:
        raise OptionError(
            "the corners of a chart must not lie on a line",
            hint=CORNERS_HINT,
        )
    values = np.linalg.solve(matrix, np.asarray(corners).ravel())
    return np.append(values, 1.0).reshape(3, 3)


def calibrate(
    photographs: Photographs, first: Patches, further: list[Patches], measured: Array
) -> Calibration:
    """Compare the patches of photographs with their measured reflectances (24, N)."""
    expected = measured @ photographs.cube.data.sensor.matrix.T
    exposure = float(np.mean(_gains(first, expected)))
    gains = [
        _gains(patches, measured @ photograph.matrix.T) / exposure
        for patches, photograph in zip(further, photographs.further, strict=True)
    ]
    level = np.concatenate([patches.mean.ravel() for patches in (first, *further)])
    variance = np.concatenate(
        [patches.variance.ravel() for patches in (first, *further)]
    )
    return Calibration(exposure, np.array(gains), fit_noise(level, variance))


def _gains(patches: Patches, expected: Array) -> Array:
    """Values (3,) of patches relative to expected ones (24, 3)."""
    usable = np.isfinite(patches.mean) & (expected > DARKEST)
    if not usable.any(axis=0).all():
        raise OptionError(
            "no patch of the chart is usable: all are clipped or black",
            hint="check the corners and the exposure",
        )
    ratio = np.where(usable, patches.mean / expected, np.nan)
    return np.nanmedian(ratio, axis=0)


def check_corners(
    sensor: Sensor, orders: list[Array], patches: list[Patches], measured: Array
) -> None:
    """Raise `OptionError` unless the patches by the first order of corners are those of
    the chart, whose reflectances are measured (24, N).
    """
    expected = measured @ sensor.matrix.T
    error, *others = (_mismatch(sensor, sampled, expected) for sampled in patches)
    if error <= MAX_MISMATCH:
        return
    best = int(np.argmin(others))
    hint = CORNERS_HINT
    if others[best] <= MAX_MISMATCH:
        numbers = ",".join(f"{number:g}" for number in orders[1 + best].ravel())
        hint = f"clockwise from dark skin they are {numbers}"
    raise OptionError(
        f"patches between the corners must be those of the chart, got a mean ΔE00 of "
        f"{error:.0f}",
        code="chart-differs",
        hint=hint,
    )


def _mismatch(sensor: Sensor, patches: Patches, expected: Array) -> float:
    """Mean ΔE00 of patches, at their exposure and balance, to linear RGB (24, 3)."""
    known = np.isfinite(patches.mean).all(axis=1)
    colours = patches.mean[known] / _gains(patches, expected)
    pair = (rgb_to_lab(sensor, rgb) for rgb in (colours, expected[known]))
    return float(delta_e_2000(*pair).mean())


def compare_patches(
    photographs: Photographs,
    calibration: Calibration,
    first: Patches,
    further: list[Patches],
    measured: Array,
    lights: list[Light],
) -> Array:
    """ΔE00 (24, L) between the answers to patches and their measurements, under
    lights; NaN for patches that the first photograph clips.
    """
    rgb = np.clip(np.nan_to_num(first.mean), 0, 1)
    others = [
        patches.mean / gain
        for patches, gain in zip(further, calibration.gains, strict=True)
    ]
    answers = photographs.answer(rgb, np.concatenate(others, axis=1)).spectra
    spectra = np.clip(answers / calibration.exposure, 0, 1)
    columns = [delta_e_spectra(light, spectra, measured) for light in lights]
    errors = np.stack(columns, axis=1)
    errors[~np.isfinite(first.mean).all(axis=1)] = np.nan
    return errors
