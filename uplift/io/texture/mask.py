"""Masks: images of which cube a pixel belongs to (docs/look-cubes.md).

A grey mask holds the numbers of the cubes, 0 for the first; or, for two cubes, weights: black is the first, white the
second, and grey mixes. A coloured mask holds the weights of three cubes in R, G and B.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uplift.common.errors import TextureError
from uplift.io.texture.channels import colour_channels
from uplift.io.texture.colours import Floats
from uplift.io.texture.image import Image, Part, Values, open_image

MIN_WHITE = 0.5
"""Share of white that the largest weight of an integer mask has; smaller ones may be numbers of too many cubes."""
HINT = "paint a grey mask with the numbers of the cubes, or with weights of the second of two cubes up to white"

ToWeights = Callable[[Values], Floats]
"""From the numbers (…, 3) of a mask to the weights (…, n) of n cubes."""


@dataclass(frozen=True, eq=False)
class Mask:
    """An open mask: its first part, the channels that hold R, G and B, and the meaning of their numbers."""

    image: Image
    part: Part
    channels: tuple[int, int, int]
    to_weights: ToWeights

    def rows(self, first: int, count: int) -> Floats:
        """Read weights (count, width, n) of the n cubes, whose sum is 1, from row ``first`` on, counted from 0."""
        band = self.image.rows(self.part, first, count)
        return self.to_weights(band[..., self.channels])


@contextlib.contextmanager
def open_mask(path: str | os.PathLike[str], cubes: int, window: tuple[int, int]) -> Iterator[Mask]:
    """Open a mask of at least two cubes, for an image of this width and height.

    Its rows are read once to find out what its numbers are. Raises `TextureError` for a file that cannot be read or has
    another size, and for numbers that are neither numbers of the cubes nor weights.
    """
    with open_image(path) as image:
        part = image.parts[0]
        size = part.window.width, part.window.height
        if size != window:
            raise TextureError(
                f"a mask must have the size of its image, {window[0]} × {window[1]}, got {size[0]} × {size[1]}",
                path=path,
                hint="scale the mask",
            )
        found = colour_channels(part)
        channels = (0, 0, 0) if found is None and len(part.channels) == 1 else found and found.rgb
        if not channels:
            raise TextureError(f"no mask among the channels {', '.join(part.channels)}", path=path, hint=HINT)
        summary = _summarise(image, part, channels)
        yield Mask(image, part, channels, _to_weights(Path(path), part.max_code, cubes, summary))


@dataclass(frozen=True)
class _Summary:
    """Range of all numbers of a mask, whether its channels are equal, and whether a pixel is black."""

    low: float
    high: float
    is_grey: bool
    has_black: bool


def _summarise(image: Image, part: Part, channels: tuple[int, int, int]) -> _Summary:
    low, high, is_grey, has_black = np.inf, -np.inf, True, False
    for _, band in image.bands(part):
        colours = band[..., channels]
        low, high = min(low, np.min(colours)), max(high, np.max(colours))  # NaN remains NaN
        is_grey &= bool((colours == colours[..., :1]).all())
        has_black |= bool((colours == 0).all(axis=-1).any())
    return _Summary(float(low), float(high), is_grey, has_black)


def _to_weights(path: Path, max_code: int, cubes: int, found: _Summary) -> ToWeights:
    """Choose the meaning of a mask. Raises `TextureError` if it has none."""
    if max_code and found.is_grey and found.high < cubes:
        return lambda numbers: _one_hot(numbers[..., 0], cubes)
    scale = max_code or 1
    is_in_range = found.low >= 0 and found.high <= scale
    if found.is_grey and cubes == 2 and is_in_range and (not max_code or found.high >= MIN_WHITE * scale):
        return lambda numbers: _two_weights(numbers[..., 0] / np.float32(scale))
    if not found.is_grey and cubes == 3 and is_in_range and not found.has_black:
        return _normalised
    kind = "grey" if found.is_grey else "coloured"
    black = " with black pixels" if not found.is_grey and found.has_black else ""
    meanings = {2: "0 and 1, or weights up to white", 3: "0 to 2, or weights in R, G and B that are not all 0"}
    raise TextureError(
        f"a mask of {cubes} cubes must hold {meanings.get(cubes, f'0 to {cubes - 1}')}, got {kind} values "
        f"from {found.low:g} to {found.high:g}{f' of {max_code}' if max_code else ''}{black}",
        path=path,
        hint=HINT,
    )


def _one_hot(numbers: NDArray[np.generic], cubes: int) -> Floats:
    return np.asarray(numbers[..., None] == np.arange(cubes), dtype=np.float32)


def _two_weights(second: NDArray[np.generic]) -> Floats:
    second = np.asarray(second, dtype=np.float32)
    return np.stack([1 - second, second], axis=-1)


def _normalised(numbers: Values) -> Floats:
    weights = np.asarray(numbers, dtype=np.float32)
    return weights / weights.sum(axis=-1, keepdims=True)
