"""The table of rgb2spec: sigmoid spectra, as Mitsuba and colour-science read them.

Jakob & Hanika 2019, "A low-dimensional function space for efficient spectral upsampling", CGF 38(2), and its
`rgb2spec`. "SPEC", u32 res, f32 scale[res], f32 data[3][res][res][res][3], little-endian. The first axis tells the
largest component, l; then come its value, scale[k], and the others as even shares of it, l + 2 before l + 1 (modulo
3). A spectrum is S(c₀λ² + c₁λ + c₂), λ in nm, S(t) = ½ + t / (2√(1 + t²)). After it comes what Mitsuba since 3.9 wants
and others do not read, the sensor: u32 count, f32 wavelength[count] as shares of 360–830 nm, f32 rgb[3][count] of a
reflectance there, f32 rgb_to_xyz[3][3], f32 white_xyz[3].

Three numbers a spectrum are what three components of a colour take: the colours are the cube's, exactly, and nothing
is left to tell what it knows of its atlas.
"""

from __future__ import annotations

import os

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.common.files import atomic_write
from uplift.cube import CubeData
from uplift.lookup.nodes import around
from uplift.models import Sigmoid
from uplift.models.minimum_norm import ForwardMap, forward_map

MAGIC = b"SPEC"
RES = 64
"""As Mitsuba's own table has it."""
FEWEST, MOST = 2, 256
TOLERANCE, PASSES = 1e-6, 32
FIRST, LAST = 360.0, 830.0
"""nm, of rgb2spec's own wavelengths."""


def write_coeff(
    data: CubeData, path: str | os.PathLike[str], *, res: int = RES, force: bool = False
) -> float:
    """Write the table and say how far, max |linear RGB|, its colours are from the cube's, as a reader sees them.

    Readers take the components for those of the cube's space under its illuminant. Mitsuba means sRGB under D65.
    Raises `OutputError`, or `OptionError` for a ``res`` outside 2 to 256.
    """
    if not FEWEST <= res <= MOST:
        raise OptionError(f"a table of res {res} makes no sense", hint=f"use {FEWEST} to {MOST}")
    with atomic_write(path, force=force) as temporary:
        scale = _scale(res)
        coefficients, worst = _fit(data, scale)
        with temporary.open("wb") as file:
            file.write(MAGIC + np.array(res, dtype="<u4").tobytes())
            file.write(scale.astype("<f4").tobytes())
            file.write(coefficients.astype("<f4").tobytes())
            file.write(_sensor_bytes(data.sensor))
    return worst


def _sensor_bytes(sensor: Sensor) -> bytes:
    """How spectra were turned into RGB."""
    numbers = (
        (sensor.wavelengths - FIRST) / (LAST - FIRST),
        sensor.matrix,
        np.linalg.inv(sensor.xyz_to_rgb),
        sensor.xyz(np.ones(3)),
    )
    count = np.array(len(sensor.wavelengths), dtype="<u4").tobytes()
    return count + b"".join(array.astype("<f4").tobytes() for array in numbers)


def _scale(res: int) -> Array:
    """(res,) values of the largest component, close together near 0 and 1, where spectra change most."""
    return _smoothstep(_smoothstep(np.linspace(0, 1, res)))


def _smoothstep(x: Array) -> Array:
    return x * x * (3 - 2 * x)


def _points(level: float, res: int) -> Array:
    """(3·res·res, 3) linear RGB of the entries whose largest component is ``level``."""
    share = np.linspace(0, 1, res)
    second, first = np.meshgrid(share, share, indexing="ij")
    shares = np.stack([np.ones_like(first), first, second], axis=-1)
    return level * np.stack([np.roll(shares, largest, axis=-1) for largest in range(3)]).reshape(-1, 3)


def _fit(data: CubeData, scale: Array) -> tuple[NDArray[np.float32], float]:
    """Coefficients (3, res, res, res, 3), and how far their colours are from the cube's.

    Level by level, upwards and downwards from a medium one, each from its neighbour's multipliers: neighbours then
    are alike, as a reader that interpolates between them needs it.
    """
    from uplift.fit.solve import solve

    sensor, res = data.sensor, len(scale)
    model = Sigmoid(*sensor.wavelengths[[0, -1]].tolist())
    ahead = forward_map(model, sensor.wavelengths, sensor.matrix)
    table = np.empty((3, res, res, res, 3), dtype=np.float32)
    middle, worst = res // 5, 0.0
    grey = np.zeros((3 * res * res, model.count))
    for levels in (range(middle, res), range(middle - 1, -1, -1)):
        start = grey
        for level in levels:
            rgb = _points(scale[level], res)
            goal = around(data, rgb).weighted_sum(data.points.rgb.astype(float), data.atlas.rgb)
            start = solve(model, ahead, start, goal, tolerance=TOLERANCE, max_passes=PASSES).multipliers
            if level == middle:
                grey = start
            stored = _per_nanometre(model, start).astype(np.float32)
            worst = max(worst, float(np.abs(_colours(model, ahead, sensor.wavelengths, stored) - goal).max()))
            table[:, level] = stored.reshape(3, res, res, 3)
    return table, worst


def _per_nanometre(model: Sigmoid, multipliers: Array) -> Array:
    """The same polynomials (n, 3), of λ in nm rather than of [start, end] as [−1, 1]."""
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


def _colours(
    model: Sigmoid, ahead: ForwardMap, wavelengths: Array, coefficients: NDArray[np.float32]
) -> Array:
    """Linear RGB (n, 3) of coefficients (n, 3) as they are stored."""
    powers = np.stack([wavelengths**2, wavelengths, np.ones_like(wavelengths)])
    return np.asarray(model.squash(coefficients.astype(float) @ powers) @ ahead.sensor.T)
