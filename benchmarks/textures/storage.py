"""Storage of moments in renderers: precision, block compression, filters → docs/data/textures-storage.json.

All is emulated in numpy, texels as float64. The reference has no rounding: the spectra of the moments that the cube
gives, and for filters the mean of these spectra.
"""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

import uplift
from benchmarks.record import ROOT, write
from benchmarks.textures.pictures import pictures
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.common.arrays import Array
from uplift.io.mitsuba import texture_file
from uplift.lookup import Cube, bulk
from uplift.models import Moments, evaluate

LIGHTS = ("D65", "A", "FL11")
SIZE = 128
"""Rows and columns of the detail that is taken from the middle of each image."""
IMAGES = 5
BLOCK = 4
"""Rows and columns of a compressed block."""
INDEX_LEVELS = 16
GREY_SHARES = (*texture_file.GREY_SHARES, 0.03, 0.1, 0.3, 1)
"""Shares of grey, of which the least that gives valid moments is mixed in."""
Texture = Array
"""Numbers (h, w, C)."""


@dataclass(frozen=True)
class Storage:
    """A way to store moments: ``encode`` gives the stored numbers of a texture, ``decode`` moments of filtered numbers.

    ``bytes`` are those of a texel with nine moments in three RGBA fetches.
    """

    name: str
    bytes: float
    encode: Callable[[Texture], Texture]
    decode: Callable[[Texture], Texture]


def same(values: Texture) -> Texture:
    """Return the numbers as they are."""
    return values


def half(values: Texture) -> Texture:
    """Round to half precision."""
    return np.asarray(values.astype(np.float16), dtype=float)


def steps(values: Texture, low: Array, high: Array, bits: int) -> Texture:
    """Round to equal steps from ``low`` to ``high``, as integer textures do."""
    codes = np.rint(np.clip((values - low) / (high - low), 0, 1) * (2**bits - 1))
    return np.asarray(low + codes / (2**bits - 1) * (high - low))


def all_moments(bits: int) -> Callable[[Texture], Texture]:
    """Return equal steps over all moments that reflectances have: [0, 1] for the zeroth, ± 1/π for the others."""

    def encode(values: Texture) -> Texture:
        high = np.where(np.arange(values.shape[-1]), 1 / np.pi, 1.0)
        return steps(values, np.where(high == 1, 0, -high), high, bits)

    return encode


def moments_of_texture(bits: int) -> Callable[[Texture], Texture]:
    """Return equal steps between the smallest and the largest number of each channel in the texture."""
    return lambda values: steps(values, *_range(values), bits)


def _range(values: Texture) -> tuple[Array, Array]:
    low, high = values.min(axis=(0, 1)), values.max(axis=(0, 1))
    return low, np.maximum(high, low + 1e-6)


def warp(moments: Texture) -> Texture:
    """Map moments to [0, 1] and [−1, 1]: roots of the zeroth, of the others relative to sin(π c₀) / π, their bound."""
    zeroth = np.clip(moments[..., :1], 1e-6, 1 - 1e-6)
    relative = moments[..., 1:] * np.pi / np.sin(np.pi * zeroth)
    return np.concatenate([np.sqrt(zeroth), np.sign(relative) * np.sqrt(np.abs(relative))], axis=-1)


def warped(moments: Texture) -> Texture:
    """Round warped moments to 8 bits."""
    values = warp(moments)
    return steps(values, np.where(np.arange(values.shape[-1]), -1.0, 0.0), np.ones(1), 8)


def unwarp(values: Texture) -> Texture:
    """Invert `warp`."""
    zeroth = values[..., :1] ** 2
    relative = np.sign(values[..., 1:]) * values[..., 1:] ** 2
    return np.concatenate([zeroth, relative * np.sin(np.pi * zeroth) / np.pi], axis=-1)


def blocks(channels: int, bits: int) -> Callable[[Texture], Texture]:
    """Return the rounding of block compression with one line per 4 × 4 texels and group of ``channels``.

    A block has two end points of ``bits`` per channel, and 4 bits per texel that choose a point on the line between
    them, as modes 6 of BC7 (four channels, 8 bits with the shared bit) and 11 of BC6H (three, 10 bits) have. The ranges
    of the channels are those of the texture; BC6H has steps of half floats instead, which are finer near 0.
    """

    def encode(values: Texture) -> Texture:
        low, high = _range(values)
        unit, found = (values - low) / (high - low), np.empty_like(values)
        for first in range(0, values.shape[-1], channels):
            group = slice(first, first + channels)
            found[..., group] = _lines(unit[..., group], bits)
        return low + found * (high - low)

    return encode


def _lines(unit: Texture, bits: int) -> Texture:
    """Replace each block by points on a line through [0, 1]^C: along its first principal axis, then refitted once."""
    height, width, count = unit.shape
    tiles = unit.reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK, count).swapaxes(1, 2)
    texels = tiles.reshape(-1, BLOCK * BLOCK, count)
    middle = texels.mean(axis=1, keepdims=True)
    axis = np.linalg.svd(texels - middle, full_matrices=False)[2][:, :1]
    along = ((texels - middle) * axis).sum(axis=2, keepdims=True)
    ends = [middle + extreme * axis for extreme in (along.min(1, keepdims=True), along.max(1, keepdims=True))]
    for _ in range(2):
        start, end = (steps(each, np.zeros(count), np.ones(count), bits) for each in ends)
        direction = end - start
        length = np.maximum((direction**2).sum(axis=2, keepdims=True), 1e-12)
        share = ((texels - start) * direction).sum(axis=2, keepdims=True) / length
        share = np.rint(np.clip(share, 0, 1) * (INDEX_LEVELS - 1)) / (INDEX_LEVELS - 1)
        found = start + share * direction
        ends = _refit(texels, share, start, end)
    return np.asarray(
        found.reshape(height // BLOCK, width // BLOCK, BLOCK, BLOCK, count).swapaxes(1, 2).reshape(height, width, count)
    )


def _refit(texels: Array, share: Array, start: Array, end: Array) -> list[Array]:
    """Return the end points that suit the chosen shares best, by least squares; as they are where all are equal."""
    other = 1 - share
    aa, ab, bb = ((x * y).sum(axis=1, keepdims=True) for x, y in ((other, other), (other, share), (share, share)))
    first, second = ((weight * texels).sum(axis=1, keepdims=True) for weight in (other, share))
    determinant = aa * bb - ab * ab
    solvable = determinant > 1e-6
    safe = np.where(solvable, determinant, 1)
    return [
        np.where(solvable, (bb * first - ab * second) / safe, start),
        np.where(solvable, (aa * second - ab * first) / safe, end),
    ]


STORAGES = (
    Storage("float", 48, same, same),
    Storage("half", 24, half, same),
    Storage("16-bit, range of all moments", 24, all_moments(16), same),
    Storage("8-bit, range of all moments", 12, all_moments(8), same),
    Storage("8-bit, range of the texture", 12, moments_of_texture(8), same),
    Storage("8-bit, warped", 12, warped, unwarp),
    Storage("BC6H, range of the texture", 3, blocks(3, 10), same),
    Storage("BC7, range of the texture", 3, blocks(4, 8), same),
)


def texel(values: Texture) -> Texture:
    """Return the texels alone."""
    return values


def bilinear(values: Texture) -> Texture:
    """Return the means of each texel and three neighbours: the place where a bilinear filter mixes most."""
    return mip(values, 1)


def mip(values: Texture, step: int = 2) -> Texture:
    """Return the means of 2 × 2 texels, ``step`` apart."""
    rows, columns = (slice(None, size - 1, step) for size in values.shape[:2])
    lower, right = (slice(1, None, step) for _ in range(2))
    return np.asarray((values[rows, columns] + values[lower, columns] + values[rows, right] + values[lower, right]) / 4)


FILTERS: dict[str, Callable[[Texture], Texture]] = {"texel": texel, "bilinear": bilinear, "mip": mip}


def main() -> None:
    """Measure and write."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    cube = uplift.load(ROOT / "cubes" / "moments-16-macbeth.uplift")
    sample = bulk.coefficients(cube)
    textures = [np.asarray(sample(rgb.astype(np.float32)), dtype=float) for rgb in _details()]
    textures.append(np.asarray(sample(_saturated()), dtype=float))
    exact = [_spectra(cube, each)[0] for each in textures]
    rows = []
    for storage in STORAGES:
        begin = time.perf_counter()
        stored = [storage.encode(each) for each in textures]
        for name, function in FILTERS.items():
            found = [_spectra(cube, storage.decode(function(each))) for each in stored]
            spectra = np.concatenate([_flat(each) for each, _ in found])
            errors = _errors(spectra, np.concatenate([_flat(function(each)) for each in exact]))
            mixed = float(np.concatenate([outside.ravel() for _, outside in found]).mean())
            row = {"storage": storage.name, "bytes": storage.bytes, "filter": name}
            rows.append({**row, "mixed": mixed, "errors": errors})
        print(f"{storage.name}: {time.perf_counter() - begin:.0f} s", file=sys.stderr)
    write(
        "textures-storage",
        "python -m benchmarks.textures.storage",
        size=SIZE,
        images=IMAGES,
        coefficients=cube.data.model.count,
        rows=rows,
    )


def _details() -> list[Array]:
    """Return the middle of some photographs, linear sRGB (SIZE, SIZE, 3)."""
    found = []
    for picture in list(pictures())[:IMAGES]:
        linear = np.clip(picture.linear(), 0, 1)
        top, left = ((size - SIZE) // 2 for size in linear.shape[:2])
        found.append(linear[top : top + SIZE, left : left + SIZE])
    return found


def _saturated() -> Any:
    """Return ramps (SIZE, SIZE, 3), float32, between random colours, of which a third are corners of the cube."""
    rng = np.random.default_rng(5)
    colours = rng.random((9, 9, 3))
    corners = rng.integers(0, 2, colours.shape).astype(float)
    colours = np.where(rng.random((9, 9, 1)) < 1 / 3, corners, colours)
    place = np.linspace(0, 8, SIZE, endpoint=False)
    cell, share = place.astype(int), (place % 1)[:, None]
    rows = (1 - share[..., None]) * colours[cell] + share[..., None] * colours[cell + 1]
    ramps = (1 - share) * rows[:, cell] + share * rows[:, cell + 1]
    return ramps.astype(np.float32)


def _spectra(cube: Cube, moments: Texture) -> tuple[Texture, Array]:
    """Return spectra (h, w, N), and which texels (h, w) had to be mixed with grey."""
    model, rows = cube.data.model, _flat(moments)
    assert isinstance(model, Moments)
    outside = ~model.try_from_storage(rows)[1]
    multipliers, _ = texture_file.multipliers_of_rounded(model, rows, GREY_SHARES)
    shape = moments.shape[:2]
    return evaluate(model, multipliers, cube.data.sensor.wavelengths).reshape(*shape, -1), outside.reshape(shape)


def _flat(values: Texture) -> Array:
    return values.reshape(-1, values.shape[-1])


def _errors(found: Array, exact: Array) -> dict[str, dict[str, float]]:
    """Return mean, 95 % and worst ΔE00 of spectra (n, N), by light."""
    errors = {}
    for name in LIGHTS:
        light = observer.light(name)
        first, second = (lab(spectra @ light.xyz.T, light.white) for spectra in (found, exact))
        delta = delta_e_2000(first, second)
        errors[name] = {
            "mean": float(delta.mean()),
            "p95": float(np.quantile(delta, 0.95)),
            "max": float(delta.max()),
        }
    return errors


if __name__ == "__main__":
    main()
