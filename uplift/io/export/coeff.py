"""The table of rgb2spec: sigmoid spectra, which Mitsuba and colour-science read.

The file is little-endian: "SPEC", u32 res, f32 scale[res], f32 data[3][res][res][res][3]. The first axis of the data is
the largest component l. The second axis is its value, scale[k]. The last two are the other components as even fractions
of it, l + 2 before l + 1 (modulo 3). A spectrum is S(c₀λ² + c₁λ + c₂) with λ in nm and S(t) = ½ + t / (2√(1 + t²)).
The sensor follows, which Mitsuba 3.9 and later require and other programs ignore: u32 count, f32 wavelength[count] as
fractions of 360–830 nm, f32 rgb[3][count] of a reflectance there, f32 rgb_to_xyz[3][3], f32 white_xyz[3].

Three coefficients per spectrum determine a colour. The table therefore reproduces the cube's colours, but not the
spectra of its atlas.

References
----------
W. Jakob and J. Hanika, "A Low-Dimensional Function Space for Efficient Spectral Upsampling", CGF 38(2), 2019, and its
reference implementation ``rgb2spec``.
"""

import os

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.common.files import atomic_write
from uplift.cube import CubeData
from uplift.lattice import CORNERS
from uplift.lookup.interpolate import around
from uplift.models import Sigmoid
from uplift.models.minimum_norm import forward_map

MAGIC = b"SPEC"
RES = 64
"""Resolution of Mitsuba's own table."""
MIN_RES, MAX_RES = 2, 256
TOLERANCE, MAX_PASSES = 1e-6, 32
COLOURS, SEED = 20_000, 20200617
"""Random colours of which the error is stated."""
START, END = 360.0, 830.0
"""Wavelength range of rgb2spec in nm."""


def write_coeff(data: CubeData, path: str | os.PathLike[str], *, res: int = RES, force: bool = False) -> float:
    """Write a cube as an rgb2spec table of ``res`` points along each axis, 2 to 256.

    Readers interpret RGB in the cube's space under its illuminant. Mitsuba assumes sRGB under D65. Returns the largest
    difference of a component of linear RGB from the cube's answers, of `COLOURS` random colours that rgb2spec
    interpolates. A camera's cube is a `ColourError`.
    """
    data.sensor.require_xyz()
    if not MIN_RES <= res <= MAX_RES:
        raise OptionError(f"res must be from {MIN_RES} to {MAX_RES}, got {res}", hint=f"{RES} is the default")
    with atomic_write(path, force=force) as temporary:
        scale = _scale(res)
        coefficients = _fit(data, scale)
        with temporary.open("wb") as file:
            file.write(MAGIC + np.array(res, dtype="<u4").tobytes())
            file.write(scale.astype("<f4").tobytes())
            file.write(coefficients.astype("<f4").tobytes())
            file.write(_sensor_bytes(data.sensor))
    return _largest_error(data, scale, coefficients)


def _sensor_bytes(sensor: Sensor) -> bytes:
    """Return the sensor in the layout of Mitsuba."""
    numbers = (
        (sensor.wavelengths - START) / (END - START),
        sensor.matrix,
        np.linalg.inv(sensor.xyz_to_rgb),
        sensor.xyz(np.ones(3)),
    )
    count = np.array(len(sensor.wavelengths), dtype="<u4").tobytes()
    return count + b"".join(array.astype("<f4").tobytes() for array in numbers)


def _scale(res: int) -> Array:
    """Return values (res,) of the largest component, dense near 0 and 1, where spectra change most."""
    x = np.linspace(0, 1, res)
    for _ in range(2):
        x = x * x * (3 - 2 * x)
    return x


def _points(level: float, res: int) -> Array:
    """Return linear RGB (3·res·res, 3) of the table's points whose largest component is ``level``."""
    share = np.linspace(0, 1, res)
    second, first = np.meshgrid(share, share, indexing="ij")
    shares = np.stack([np.ones_like(first), first, second], axis=-1)
    return level * np.stack([np.roll(shares, largest, axis=-1) for largest in range(3)]).reshape(-1, 3)


def _fit(data: CubeData, scale: Array) -> NDArray[np.float32]:
    """Fit coefficients (3, res, res, res, 3).

    Levels are fitted upwards and downwards from a medium one. Each starts from the multipliers of the previous level,
    so that neighbours are similar and can be interpolated.
    """
    from uplift.fit.solver import solve

    sensor, res = data.sensor, len(scale)
    model = Sigmoid(*sensor.wavelengths[[0, -1]].tolist())
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    table = np.empty((3, res, res, res, 3), dtype=np.float32)
    middle = res // 5
    middle_multipliers = np.zeros((3 * res * res, model.count))
    for levels in (range(middle, res), range(middle - 1, -1, -1)):
        multipliers = middle_multipliers
        for level in levels:
            rgb = _points(scale[level], res)
            multipliers = solve(
                forward, multipliers, _targets(data, rgb), tolerance=TOLERANCE, max_passes=MAX_PASSES
            ).multipliers
            if level == middle:
                middle_multipliers = multipliers
            table[:, level] = _per_nanometre(model, multipliers).reshape(3, res, res, 3)
    return table


def _targets(data: CubeData, rgb: Array) -> Array:
    """Return linear RGB (n, 3) of the spectra that the cube answers."""
    return around(data, rgb).weighted_sum(data.points.rgb.astype(float), data.atlas.rgb)


def _per_nanometre(model: Sigmoid, multipliers: Array) -> Array:
    """Convert polynomials (n, 3) of [start, end] scaled to [−1, 1] to polynomials of λ in nm."""
    middle, half = (model.start + model.end) / 2, (model.end - model.start) / 2
    square, linear, constant = (multipliers / half ** np.array([2, 1, 0])).T
    return np.stack(
        [
            square,
            linear - 2 * middle * square,
            constant - middle * linear + middle * middle * square,
        ],
        axis=-1,
    )


def _largest_error(data: CubeData, scale: Array, table: NDArray[np.float32]) -> float:
    rgb = np.random.default_rng(SEED).random((COLOURS, 3))
    wavelengths = data.sensor.wavelengths
    powers = np.stack([wavelengths**2, wavelengths, np.ones_like(wavelengths)])
    spectra = Sigmoid(*wavelengths[[0, -1]].tolist()).to_reflectance(_interpolated(scale, table, rgb) @ powers)
    return float(np.abs(data.sensor.rgb(spectra) - _targets(data, rgb)).max())


def _interpolated(scale: Array, table: NDArray[np.float32], rgb: Array) -> Array:
    """Return coefficients (n, 3) as rgb2spec interpolates them: linearly between the eight points around a colour."""
    last, rows = len(scale) - 2, np.arange(len(rgb))
    largest = rgb.argmax(axis=1)
    level = rgb[rows, largest]
    shares = np.stack([rgb[rows, (largest + step) % 3] / level for step in (2, 1)], axis=1) * (last + 1)
    at = np.clip(np.searchsorted(scale, level, side="right") - 1, 0, last)
    low = np.minimum(shares.astype(int), last)
    part = np.column_stack([(level - scale[at]) / (scale[at + 1] - scale[at]), shares - low])
    found = np.zeros((len(rgb), 3))
    for corner in CORNERS:
        weight = np.where(corner, part, 1 - part).prod(axis=1)
        found += weight[:, None] * table[largest, at + corner[0], low[:, 0] + corner[1], low[:, 1] + corner[2]]
    return found
